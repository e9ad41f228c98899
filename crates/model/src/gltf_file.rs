//! A glTF 2.0 file as text and bytes, to be added to and written as one binary file. What nobody touches stays as it was: numbers of elements,
//! their members, the bytes of their buffers.

mod embed;
mod numbers;
mod reading;

use serde_json::{Map, Value, json};

use crate::flaw::Flaw;
use crate::packed;
pub use reading::extension;

/// A glTF file with all of its bytes in one buffer.
#[derive(Clone, Debug)]
pub struct GltfFile {
    root: Map<String, Value>,
    bin: Vec<u8>,
    /// Whether what is pushed belongs to the model, and is not marked as added to it.
    pub pushes_own: bool,
}

impl GltfFile {
    /// A file with nothing in its scene.
    pub fn new(generator: &str) -> Self {
        let mut root = Map::new();
        root.insert(
            "asset".to_owned(),
            json!({ "version": "2.0", "generator": generator }),
        );
        Self {
            root,
            bin: Vec::new(),
            pushes_own: false,
        }
    }

    /// The elements of a list of the root, such as `nodes`.
    pub fn list(&self, name: &str) -> &[Value] {
        let list = self.root.get(name).and_then(Value::as_array);
        list.map_or(&[], Vec::as_slice)
    }

    /// An element of a list of the root.
    pub fn element_mut(&mut self, list: &str, number: usize) -> Option<&mut Value> {
        self.root.get_mut(list)?.get_mut(number)
    }

    /// Adds an element to a list of the root, and returns its number.
    pub fn push(&mut self, list: &str, mut element: Value) -> usize {
        self.mark(&mut element);
        let list = self.root.entry(list).or_insert_with(|| json!([]));
        push(list, element)
    }

    /// Adds an element to a list of an extension of the root, and returns its number.
    pub fn push_in_extension(&mut self, name: &str, list: &str, mut element: Value) -> usize {
        self.mark(&mut element);
        self.use_extension(name);
        let extensions = self.root.entry("extensions").or_insert_with(|| json!({}));
        if !extensions[name].is_object() {
            extensions[name] = json!({});
        }
        push(&mut extensions[name][list], element)
    }

    fn mark(&self, element: &mut Value) {
        if !self.pushes_own {
            // An application's own may be of any form.
            if !element["extras"].is_object() {
                element["extras"] = json!({});
            }
            element["extras"][packed::ADDED] = json!(true);
        }
    }

    /// Nodes of the scene that is shown: of a file without scenes those that are nobody's child.
    pub fn root_nodes(&self) -> Vec<usize> {
        let scenes = self.list("scenes");
        if let Some(scene) = scenes.get(self.scene()).or(scenes.first()) {
            return numbers_of(scene, "nodes");
        }
        let nodes = self.list("nodes");
        let children: Vec<usize> = (nodes.iter())
            .flat_map(|node| numbers_of(node, "children"))
            .collect();
        let free = (0..nodes.len()).filter(|node| !children.contains(node));
        free.collect()
    }

    /// Sets the nodes of the scene that is shown.
    pub fn set_root_nodes(&mut self, nodes: Vec<usize>) {
        let scene = self.scene();
        match self.element_mut("scenes", scene) {
            Some(scene) => scene["nodes"] = json!(nodes),
            None => {
                self.root
                    .insert("scenes".to_owned(), json!([{ "nodes": nodes }]));
            }
        }
        self.root.insert("scene".to_owned(), json!(scene));
    }

    fn scene(&self) -> usize {
        let scene = self.root.get("scene").and_then(Value::as_u64);
        let scene = scene.map_or(0, |scene| scene as usize);
        if scene < self.list("scenes").len() {
            scene
        } else {
            0
        }
    }

    /// The value of an extension of the root.
    pub fn extension(&self, name: &str) -> Option<&Value> {
        self.root.get("extensions")?.get(name)
    }

    /// Sets an extension of the root, which the file then uses.
    pub fn set_extension(&mut self, name: &str, value: Value) {
        let extensions = self.root.entry("extensions").or_insert_with(|| json!({}));
        extensions[name] = value;
        self.use_extension(name);
    }

    /// Lists an extension among those that the file uses.
    pub fn use_extension(&mut self, name: &str) {
        if !self.list("extensionsUsed").iter().any(|it| it == name) {
            let names = self
                .root
                .entry("extensionsUsed")
                .or_insert_with(|| json!([]));
            push(names, json!(name));
            // In an order of their own, whoever came first.
            if let Some(names) = names.as_array_mut() {
                names.sort_by(|a, b| a.as_str().cmp(&b.as_str()));
            }
        }
    }

    /// The file as a binary one.
    ///
    /// # Errors
    /// It would be larger than 4 GiB.
    pub fn to_glb(&self) -> Result<Vec<u8>, Flaw> {
        let mut root = self.root.clone();
        // Exporters write such, which are no valid glTF.
        root.retain(|_, it| it.as_array().is_none_or(|list| !list.is_empty()));
        if !self.bin.is_empty() {
            if self.list("buffers").is_empty() {
                root.insert("buffers".to_owned(), json!([{}]));
            }
            root["buffers"][0]["byteLength"] = json!(self.bin.len());
        }
        let padded = |mut bytes: Vec<u8>, with: u8| {
            bytes.resize(bytes.len().next_multiple_of(4), with);
            bytes
        };
        let text = padded(Value::Object(root).to_string().into_bytes(), b' ');
        let mut chunks = vec![(*b"JSON", text)];
        if !self.bin.is_empty() {
            chunks.push((*b"BIN\0", padded(self.bin.clone(), 0)));
        }
        let length: usize = 12 + chunks.iter().map(|(_, it)| 8 + it.len()).sum::<usize>();
        let number = |number: usize| {
            let number = u32::try_from(number).map_err(|_| {
                let found = "it would be larger than 4 GiB, which a .glb cannot be";
                Flaw::new(found, "must have fewer scratches or smaller pictures")
            });
            number.map(u32::to_le_bytes)
        };
        let mut glb = Vec::with_capacity(length);
        glb.extend(b"glTF");
        glb.extend(number(2)?);
        glb.extend(number(length)?);
        for (kind, bytes) in chunks {
            glb.extend(number(bytes.len())?);
            glb.extend(kind);
            glb.extend(bytes);
        }
        Ok(glb)
    }
}

/// Adds an element to a list, which is made where there is none, and returns its number.
fn push(list: &mut Value, element: Value) -> usize {
    if !list.is_array() {
        *list = json!([]);
    }
    let list = list.as_array_mut();
    list.map_or(0, |list| {
        list.push(element);
        list.len() - 1
    })
}

/// A list of numbers of elements.
fn numbers_of(value: &Value, name: &str) -> Vec<usize> {
    let list = value.get(name).and_then(Value::as_array);
    let numbers = list.into_iter().flatten().filter_map(Value::as_u64);
    numbers.map(|number| number as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_image::FilePath;

    #[test]
    fn what_is_written_reads_back_and_what_nobody_touched_stays() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.bin"), [1, 2, 3, 4, 5]).unwrap();
        let text = json!({
            "asset": { "version": "2.0" },
            "buffers": [
                { "uri": "data:application/octet-stream;base64,CQgH", "byteLength": 3 },
                { "uri": "a.bin", "byteLength": 5 },
            ],
            "bufferViews": [
                { "buffer": 1, "byteOffset": 1, "byteLength": 4 },
                { "buffer": 0, "byteLength": 3 },
            ],
            "materials": [{ "pbrMetallicRoughness": { "roughnessFactor": 0.123_456_789_012_345_68 } }],
            "nodes": [{ "children": [1] }, {}],
        });
        let path = FilePath::from(folder.path()).join("a.gltf");
        std::fs::write(&path, text.to_string()).unwrap();
        let mut file = GltfFile::read(&path).unwrap();
        assert_eq!(file.root_nodes(), [0]);
        let floats = file.push_floats(&[0.1, -2.5, 3.0], 3, true);
        let path = path.folder().join("b.glb");
        std::fs::write(&path, file.to_glb().unwrap()).unwrap();

        let again = GltfFile::read(&path).unwrap();
        assert_eq!(again.view(0).unwrap(), [2, 3, 4, 5]);
        assert_eq!(again.view(1).unwrap(), [9, 8, 7]);
        assert_eq!(again.floats(floats, 3).unwrap(), [0.1, -2.5, 3.0]);
        assert_eq!(
            again.list("materials"),
            text["materials"].as_array().unwrap()
        );
        assert!(again.floats(floats, 1).is_err());
        assert!(again.view(9).is_err());
    }
}
