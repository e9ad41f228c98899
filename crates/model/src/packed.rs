//! Paths into a glTF file that holds several things: `worn.glb/pan.glb` is the model `pan.glb` in the file `worn.glb`, and `worn.glb/mask.png` a
//! picture there. A file on a disk of that path goes before it.

use std::path::Path;

use hairline_image::FilePath;
use serde_json::{Value, json};

use crate::flaw::Flaw;

/// Name of the extension by which a glTF file tells what it holds.
pub const EXTENSION: &str = "HAIRLINE_scratches";
/// Extensions of a file that are of no part of it.
const OF_THE_WHOLE: [&str; 2] = [EXTENSION, "EXT_lights_area"];

/// Endings of models' files.
pub const MODELS: [&str; 4] = ["glb", "gltf", "obj", "stl"];

/// Endings of models that are not read.
const OTHER_MODELS: [&str; 13] = [
    "3ds", "3mf", "blend", "dae", "fbx", "iges", "igs", "ply", "step", "stp", "usd", "usdc", "usdz",
];

/// Refuses a model of a format that is not read, by its name.
///
/// # Errors
/// What to do with it.
pub fn refuse_other_model(path: &Path) -> Result<(), Flaw> {
    let ending = path.extension().unwrap_or_default();
    match (OTHER_MODELS.iter()).any(|it| ending.eq_ignore_ascii_case(it)) {
        true => Err(Flaw::new(
            "it is a model of another format",
            "export it as .glb, .gltf, .obj or .stl",
        )),
        false => Ok(()),
    }
}

/// Whether a file is a model by its name: .glb, .gltf, .obj or .stl.
pub fn is_model(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    MODELS.iter().any(|it| ending.eq_ignore_ascii_case(it))
}

/// The file that a path leads into, and the name there; none of a path of a file of its own.
pub fn split(path: &FilePath) -> Option<(FilePath, String)> {
    let mut models = path
        .ancestors()
        .skip(1)
        .filter(|it| is_model(it))
        .peekable();
    models.peek()?;
    if path.is_file() {
        return None;
    }
    let file = models
        .map(|it| path.with_path(it))
        .find(FilePath::is_file)?;
    let name = path.strip_prefix(&file).ok()?.to_owned();
    Some((file, name.to_string_lossy().replace('\\', "/")))
}

/// The file whose bytes say what is at a path.
pub fn file_of(path: impl Into<FilePath>) -> FilePath {
    let path = path.into();
    match split(&path) {
        Some((file, _)) => file,
        None => path,
    }
}

/// Member of `extras` by which elements tell that they were added to a model, so that the model comes out again as it was.
pub(crate) const ADDED: &str = EXTENSION;
/// Lists of a file that elements are added to.
const LISTS: [&str; 6] = [
    "accessors",
    "bufferViews",
    "cameras",
    "materials",
    "meshes",
    "nodes",
];

/// The root of a file with a part of it alone: the model of this name, with its numbers of elements. None where there is no such model.
pub(crate) fn alone(mut root: Value, name: &str) -> Option<Value> {
    let objects = root.get("extensions")?.get(EXTENSION)?.get("object")?;
    let is_it = |it: &Value| it.get("mesh").and_then(Value::as_str) == Some(name);
    let object = objects.as_array()?.iter().position(is_it)?;
    let nodes = root.get("nodes")?.as_array()?;
    let number = |node: &Value| {
        node.get("extensions")?
            .get(EXTENSION)?
            .get("object")?
            .as_u64()
    };
    let of_object = nodes.iter().find(|it| number(it) == Some(object as u64))?;
    // Below the object's node is that of its file, below that the file's own.
    let of_file = *children(of_object).first()?;
    let roots = children(nodes.get(of_file)?);
    let mut is_below = vec![false; nodes.len()];
    let mut open = roots.clone();
    while let Some(node) = open.pop() {
        // A node that is met twice is an error of the file, told where it is read.
        if is_below.get(node).is_some_and(|is_below| !is_below) {
            is_below[node] = true;
            open.extend(children(&nodes[node]));
        }
    }
    let nodes = root.get_mut("nodes")?.as_array_mut()?;
    for (node, is_below) in nodes.iter_mut().zip(is_below) {
        match (is_below, is_added(node)) {
            (true, _) => {}
            (false, true) => *node = json!({ "extras": { (ADDED): true } }),
            (false, false) => *node = json!({}),
        }
    }
    for name in LISTS {
        forget_added(root.get_mut(name));
    }
    let extensions = root.get_mut("extensions")?.as_object_mut()?;
    for name in OF_THE_WHOLE {
        extensions.remove(name);
    }
    let punctual = extensions.get_mut("KHR_lights_punctual");
    forget_added(punctual.and_then(|it| it.get_mut("lights")));
    for list in ["extensionsUsed", "extensionsRequired"] {
        if let Some(names) = root.get_mut(list).and_then(Value::as_array_mut) {
            names.retain(|it| !OF_THE_WHOLE.iter().any(|of_whole| it == of_whole));
        }
    }
    let shown = root.get("scene").and_then(Value::as_u64).unwrap_or(0) as usize;
    let scene = root.get_mut("scenes").and_then(|it| it.get_mut(shown));
    scene?
        .as_object_mut()?
        .insert("nodes".to_owned(), json!(roots));
    Some(root)
}

/// Removes what was added behind a list's own elements.
fn forget_added(list: Option<&mut Value>) {
    let Some(list) = list.and_then(Value::as_array_mut) else {
        return;
    };
    while list.last().is_some_and(is_added) {
        list.pop();
    }
}

fn is_added(element: &Value) -> bool {
    let added = element.get("extras").and_then(|it| it.get(ADDED));
    added.and_then(Value::as_bool) == Some(true)
}

fn children(node: &Value) -> Vec<usize> {
    let children = node.get("children").and_then(Value::as_array);
    let numbers = children.into_iter().flatten().filter_map(Value::as_u64);
    numbers.map(|child| child as usize).collect()
}
