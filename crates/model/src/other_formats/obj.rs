//! OBJ files with their materials (Wavefront, appendices B1 and B2 of its Advanced Visualizer). They name no unit.

use std::cell::RefCell;
use std::io::{self, BufRead, Cursor, Read};
use std::path::{Path, PathBuf};

use hairline_image::FilePath;
use serde_json::{Value, json};
use tobj::LoadOptions;

use super::creased::add_normals;
use super::statements::{self, SilentContents};
use super::translated::{Part, Translated, bare_metal, begun, finished, push_part};
use crate::flaw::Flaw;
use crate::gltf_file::GltfFile;
use crate::mesh_file::resource;
use crate::text::shown;

const RIGHT: &str = "must be a whole OBJ file";
/// The images of a material that are read: of its colour, and its normals.
const IMAGES: [&str; 2] = ["map_Kd", "norm"];
const OPTIONS: LoadOptions = LoadOptions {
    single_index: true,
    triangulate: true,
    ignore_points: true,
    ignore_lines: true,
};

pub(super) fn translated(bytes: &[u8], folder: &FilePath) -> Result<Translated, Flaw> {
    let library = Library::in_folder(folder);
    // Comments may be in any encoding.
    let text = String::from_utf8_lossy(bytes);
    let found = statements::check_obj(&text).map_err(|found| Flaw::new(found, RIGHT))?;
    let mut lines = Counted::new(&text);
    let read = tobj::load_obj_buf(&mut lines, &OPTIONS, |name| library.with_images(name));
    let (models, materials) = read.map_err(|error| {
        let found = format!(
            "it is no valid OBJ ({error} in line {} or before)",
            lines.line
        );
        Flaw::new(found, RIGHT)
    })?;
    let Library {
        files, notes, flaw, ..
    } = library;
    let materials = materials.map_err(|error| {
        let found = format!("its .mtl file is not valid ({error})");
        let other = || Flaw::new(found, "must be a whole .mtl file");
        flaw.into_inner().unwrap_or_else(other)
    })?;
    let mut notes = notes.into_inner();
    let tells_materials = notes.is_empty() || !materials.is_empty();
    notes.extend(taken_in_silence(&found, &materials, tells_materials));
    let mut file = begun();
    let mut translation = Materials {
        file: &mut file,
        notes,
    };
    for material in &materials {
        translation.push(material);
    }
    let mut notes = translation.notes;
    let bare = models.iter().any(|it| it.mesh.material_id.is_none());
    let bare = bare.then(|| file.push("materials", bare_metal()));
    let mut nodes = Vec::new();
    for model in &models {
        let material = model.mesh.material_id.or(bare).unwrap_or(0);
        let part = part(model, material);
        if !part.triangles.is_empty() {
            nodes.push(push_part(&mut file, &part));
        }
    }
    if nodes.is_empty() {
        return Err(Flaw::new("it has no triangles", RIGHT));
    }
    notes.insert(
        0,
        "it names no unit; taken for metres (`scale = 0.001` where it is in millimetres)"
            .to_owned(),
    );
    Ok(Translated {
        bytes: finished(file, nodes)?,
        files: files.into_inner(),
        notes,
    })
}

/// The .mtl files of an OBJ file, and their images; none where it cannot be read.
pub(super) fn names(path: &FilePath) -> Option<Vec<(String, PathBuf)>> {
    let folder = &path.folder();
    let mut bytes = Vec::new();
    path.open().ok()?.read_to_end(&mut bytes).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let libraries = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("mtllib "));
    let mut names = Vec::new();
    for name in libraries {
        let library = Library::in_folder(folder);
        let materials = library.read(Path::new(name.trim()));
        let named = library.files.into_inner().into_iter();
        names.extend(named.map(|file| ("materials".to_owned(), file.to_path_buf())));
        for material in materials.into_iter().flat_map(|(materials, _)| materials) {
            let images = images(&material).into_iter().flatten();
            names.extend(images.map(|uri| {
                (
                    format!("image of {}", shown(&material.name)),
                    folder.join(uri).to_path_buf(),
                )
            }));
        }
    }
    Some(names)
}

/// Notes on what is read in silence. Without a .mtl file that cannot be read there are none on materials.
fn taken_in_silence(
    found: &SilentContents<'_>,
    materials: &[tobj::Material],
    tells_materials: bool,
) -> Vec<String> {
    let mut notes = Vec::new();
    let (count, line) = found.short_faces;
    if count > 0 {
        notes.push(format!(
            "line {line}: a face of fewer than 3 corners left out ({count} in all)"
        ));
    }
    let is_known = |name: &str| materials.iter().any(|it| it.name == name);
    let unknown = found.used.iter().find(|(_, name)| !is_known(name));
    if let Some((line, name)) = unknown.filter(|_| tells_materials) {
        let name = shown(name);
        notes.push(format!(
            "line {line}: usemtl {name}: no .mtl file has it; what uses it is shown as a metal"
        ));
    }
    notes
}

/// The .mtl files of an OBJ file, as they are read.
struct Library<'a> {
    folder: &'a FilePath,
    files: RefCell<Vec<FilePath>>,
    notes: RefCell<Vec<String>>,
    flaw: RefCell<Option<Flaw>>,
}

impl<'a> Library<'a> {
    fn in_folder(folder: &'a FilePath) -> Self {
        Self {
            folder,
            files: RefCell::default(),
            notes: RefCell::default(),
            flaw: RefCell::default(),
        }
    }

    /// Reads a .mtl file. One that is not there leaves the materials out, with a note.
    fn read(&self, name: &Path) -> tobj::MTLLoadResult {
        match self.text(name) {
            Some(text) => self.parsed(name, &text),
            None => Ok(Default::default()),
        }
    }

    /// Reads a .mtl file. Images that are not there are left out, with a note.
    fn with_images(&self, name: &Path) -> tobj::MTLLoadResult {
        let Some(text) = self.text(name) else {
            return Ok(Default::default());
        };
        let (mut materials, numbers) = self.parsed(name, &text)?;
        let name = shown(&name.to_string_lossy());
        for (line, key, rest) in statements::split_statements(&text) {
            let uri = image(rest).filter(|_| IMAGES.contains(&key));
            let flaw = uri.as_deref().and_then(|uri| self.lacks(uri, key));
            let Some(flaw) = flaw else {
                continue;
            };
            let note = format!("{name}:{line}: {}; left out", flaw.found);
            self.notes.borrow_mut().push(note);
            for material in &mut materials {
                (material.diffuse_texture).take_if(|it| image(it) == uri && key == IMAGES[0]);
                let normals = material.unknown_param.get(key).and_then(|it| image(it));
                if normals == uri {
                    material.unknown_param.remove(key);
                }
            }
        }
        Ok((materials, numbers))
    }

    /// Why an image cannot be read, if so.
    fn lacks(&self, uri: &str, key: &str) -> Option<Flaw> {
        let mut files = Vec::new();
        let flaw = resource(uri, self.folder, key, &mut files).err();
        if flaw.is_some() {
            // Whoever watches the model's files sees that it comes.
            self.files.borrow_mut().extend(files);
        }
        flaw
    }

    fn text(&self, name: &Path) -> Option<String> {
        let path = (self.folder).join(name.to_string_lossy().replace('\\', "/"));
        let mut bytes = Vec::new();
        let read = path
            .open()
            .and_then(|mut file| file.read_to_end(&mut bytes));
        self.files.borrow_mut().push(path);
        if let Err(error) = read {
            let name = shown(&name.to_string_lossy());
            self.notes.borrow_mut().push(format!(
                "its materials, \"{name}\", cannot be read ({error}); it is shown as a metal"
            ));
            return None;
        }
        Some(String::from_utf8_lossy(&bytes).into_owned())
    }

    fn parsed(&self, name: &Path, text: &str) -> tobj::MTLLoadResult {
        if let Err(flaw) = statements::check_mtl(name, text) {
            self.flaw.replace(Some(flaw));
            return Err(tobj::LoadError::MaterialParseError);
        }
        tobj::load_mtl_buf(&mut Cursor::new(text.as_bytes()))
    }
}

/// A part with its triangles, normals made where it has none.
fn part(model: &tobj::Model, material: usize) -> Part {
    let mesh = &model.mesh;
    let (uvs, _) = mesh.texcoords.as_chunks::<2>();
    let mut part = Part {
        name: model.name.clone(),
        positions: mesh.positions.as_chunks().0.to_vec(),
        normals: mesh.normals.as_chunks().0.to_vec(),
        // Theirs begin at the lower left corner.
        uvs: uvs.iter().map(|[u, v]| [*u, 1.0 - v]).collect(),
        colors: mesh.vertex_color.as_chunks().0.to_vec(),
        triangles: mesh.indices.as_chunks().0.to_vec(),
        material,
    };
    let count = part.positions.len();
    if part.uvs.len() != count {
        part.uvs.clear();
    }
    if part.colors.len() != count {
        part.colors.clear();
    }
    if part.normals.len() != count {
        part.normals.clear();
        add_normals(&mut part);
    }
    part
}

/// The images of a material that are used: of its colour, and its normals.
fn images(material: &tobj::Material) -> [Option<String>; 2] {
    let normals = material.unknown_param.get(IMAGES[1]);
    [&material.diffuse_texture, &normals.cloned()].map(|it| it.as_deref().and_then(image))
}

/// The file of a map's statement, behind its options.
fn image(statement: &str) -> Option<String> {
    let statement = statement.trim();
    let name = match statement.starts_with('-') {
        true => statement.rsplit(char::is_whitespace).next()?,
        false => statement,
    };
    Some(name.replace('\\', "/")).filter(|name| !name.is_empty())
}

/// Materials on their way into a file.
struct Materials<'a> {
    file: &'a mut GltfFile,
    notes: Vec<String>,
}

impl Materials<'_> {
    fn push(&mut self, material: &tobj::Material) {
        let number =
            |name: &str| -> Option<f32> { material.unknown_param.get(name)?.trim().parse().ok() };
        let [r, g, b] = material
            .diffuse
            .unwrap_or([0.8; 3])
            .map(|it| it.clamp(0.0, 1.0));
        // The width of GGX that is like a power of the cosine: alpha, the square of glTF's roughness, is the root of 2 over the power plus 2.
        let of_shininess = material
            .shininess
            .map(|power| (2.0 / (power.max(0.0) + 2.0)).powf(0.25));
        let roughness = number("Pr").or(of_shininess).unwrap_or(0.5).clamp(0.0, 1.0);
        let mut surface = json!({
            "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": number("Pm").unwrap_or(0.0).clamp(0.0, 1.0),
            "roughnessFactor": roughness,
        });
        let [color, normals] = images(material);
        if let Some(uri) = color {
            surface["baseColorTexture"] = self.texture(&uri);
        }
        let mut made = json!({ "name": material.name, "pbrMetallicRoughness": surface });
        if let Some(uri) = normals {
            made["normalTexture"] = self.texture(&uri);
        }
        if let Some(light) = material.emissive.filter(|it| it.iter().any(|x| *x > 0.0)) {
            made["emissiveFactor"] = json!(light.map(|it| it.clamp(0.0, 1.0)));
        }
        self.file.push("materials", made);
        let left_out = [
            (
                "d",
                material.dissolve.is_some_and(|it| it < 1.0) || material.dissolve_texture.is_some(),
            ),
            ("map_Bump", material.normal_texture.is_some()),
            (
                "map_Ks, map_Ns",
                material.specular_texture.is_some() || material.shininess_texture.is_some(),
            ),
            (
                "map_Pr, map_Pm",
                ["map_Pr", "map_Pm"]
                    .iter()
                    .any(|it| material.unknown_param.contains_key(*it)),
            ),
        ];
        for (keys, _) in left_out.iter().filter(|(_, is_there)| *is_there) {
            self.notes.push(format!(
                "{keys} of its material {} left out",
                shown(&material.name)
            ));
        }
    }

    fn texture(&mut self, uri: &str) -> Value {
        let image = self.file.push("images", json!({ "uri": uri }));
        json!({ "index": self.file.push("textures", json!({ "source": image })) })
    }
}

/// A text whose lines are counted while they are read.
struct Counted<'a> {
    rest: &'a [u8],
    /// The line that was read last, from 1.
    line: usize,
}

impl<'a> Counted<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            rest: text.as_bytes(),
            line: 0,
        }
    }
}

impl Read for Counted<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.rest.read(into)
    }
}

impl BufRead for Counted<'_> {
    /// A line at a time.
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        let end = self.rest.iter().position(|it| *it == b'\n');
        Ok(&self.rest[..end.map_or(self.rest.len(), |end| end + 1)])
    }

    fn consume(&mut self, amount: usize) {
        self.line += usize::from(amount > 0);
        self.rest = &self.rest[amount..];
    }
}
