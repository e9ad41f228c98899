//! Writes a scene as one glTF file: what glTF has words for, for all programs, and the whole scene as an extension.

mod grooves;
mod laid;
mod lamps;
pub(crate) mod looks;
mod nodes;
pub(crate) mod objects;

use std::cell::LazyCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::{DMat4, DVec3};
use hairline_image::FilePath;
use hairline_model::gltf_file::GltfFile;
use hairline_model::mesh_file::{self, quarter_turn};
use hairline_model::reading::{self, FileKind};
use hairline_scene::{Scene, ScratchTables};
use serde_json::{Map, Value, json};

use super::extension::{EXTENSION, LAID, Named, VERSION, named};
use super::packed_files::with_packed;
use super::scratch_lists;
use crate::description::Description;
use crate::error::Error;
use crate::loader::Loader;
use objects::Objects;

/// The share of the free memory that a file in a scene may take.
const FILE_SHARE: f64 = 0.25;

/// A file for other programs.
#[derive(Clone, Debug)]
pub struct Exported {
    /// The file.
    pub bytes: Vec<u8>,
    /// Notes on what other programs do not show, a line each.
    pub notes: Vec<String>,
}

impl Loader<'_> {
    /// Makes one binary glTF file of a scene and all that it names, with the scratches as they lie if `is_laid`.
    pub(crate) fn export_scene(
        &self,
        description: &Description,
        base_dir: impl Into<FilePath>,
        is_laid: bool,
    ) -> Result<Exported, Error> {
        let base_dir = &with_packed(base_dir);
        let described = description.with_its_camera(base_dir)?.into_owned();
        // Whatever is wrong is told here.
        let scene = self.build(&described, base_dir)?;
        let up = described.camera.world_up();
        let gltf_from_world = DMat4::from_mat3(quarter_turn(up, DVec3::Y));
        let mut objects = Objects::new(self, &described, base_dir, gltf_from_world)?;
        objects.write()?;
        let Objects {
            mut file,
            nodes: mut roots,
            mut notes,
            names,
            ..
        } = objects;
        roots.push(lamps::camera(&described, &gltf_from_world, &mut file));
        if has_own_lights(&described, base_dir) {
            notes.push("other programs show the lights of the model's own file".to_owned());
        } else {
            lamps::write(
                &described,
                &gltf_from_world,
                &mut file,
                &mut roots,
                &mut notes,
            );
        }
        file.set_root_nodes(roots);

        let mut tables = described.to_json()?;
        let mut packed = Packed {
            loader: self,
            base_dir,
            file: &mut file,
            files: Vec::new(),
            known: HashMap::new(),
        };
        packed.name(&mut tables, &names)?;
        let files = packed.files;
        write_laid(&described, &scene, is_laid, &mut tables, &mut file);
        tables.insert("version".to_owned(), json!(VERSION));
        if !files.is_empty() {
            tables.insert("files".to_owned(), Value::Array(files));
        }
        file.set_extension(EXTENSION, Value::Object(tables));
        let bytes = file.to_glb();
        let bytes = bytes.map_err(|flaw| Error::new("", flaw.found, flaw.right))?;
        Ok(Exported { bytes, notes })
    }
}

/// Adds scratches as they lie, if `is_laid`, and what gratings send.
fn write_laid(
    described: &Description,
    scene: &Scene,
    is_laid: bool,
    tables: &mut Map<String, Value>,
    file: &mut GltfFile,
) {
    let layers = tables.get_mut("scratches").and_then(Value::as_array_mut);
    let layers = layers.filter(|_| is_laid);
    for (i, layer) in layers.into_iter().flatten().enumerate() {
        if let Some(laid) = laid::write(described, scene, i, file) {
            layer[LAID] = laid;
        }
    }
    let gratings = tables.get_mut("grating").and_then(Value::as_array_mut);
    let mut known = grooves::Known::new();
    let spectra = LazyCell::new(|| ScratchTables::new(scene));
    for (i, grating) in gratings.into_iter().flatten().enumerate() {
        let known = &mut known;
        if let Some(laid) = grooves::write(described, scene, &spectra, i, is_laid, known, file) {
            grating[LAID] = laid;
        }
    }
}

/// Whether the lights of the scene were made of those of its model, which are in the file.
fn has_own_lights(described: &Description, base_dir: &FilePath) -> bool {
    let model = described.lights_of.as_ref();
    let lights = model.map(|model| mesh_file::lights(&base_dir.join(model)));
    lights.is_some_and(|lights| lights.is_ok_and(|lights| !lights.is_empty()))
}

/// Files of the scene, taken into the glTF file.
struct Packed<'a> {
    loader: &'a Loader<'a>,
    base_dir: &'a FilePath,
    file: &'a mut GltfFile,
    /// The extension's `files`.
    files: Vec<Value>,
    known: HashMap<PathBuf, usize>,
}

impl Packed<'_> {
    /// Puts what is in the file in the place of paths. `models` are the names of the objects' models.
    fn name(
        &mut self,
        tables: &mut Map<String, Value>,
        models: &[Option<String>],
    ) -> Result<(), Error> {
        let mut models = models.iter().flatten();
        for (key_path, kind, value) in named(tables) {
            let path = PathBuf::from(value.as_str().unwrap_or_default());
            *value = match kind {
                Named::Model => json!(models.next()),
                Named::File => json!(self.picture(&path, &key_path)?),
                Named::Scratches => match self.loader.arrays.scratches(&path) {
                    Some(arrays) => scratch_lists::write_arrays(self.file, arrays),
                    None => {
                        let table = key_path.trim_end_matches(".file");
                        let path = self.base_dir.join(&path);
                        scratch_lists::write_file(self.file, &path, table)?
                    }
                },
            };
        }
        debug_assert_eq!(models.next(), None);
        Ok(())
    }

    /// Number of a file among the extension's.
    fn picture(&mut self, path: &Path, key_path: &str) -> Result<usize, Error> {
        if let Some(number) = self.known.get(path) {
            return Ok(*number);
        }
        let bytes = reading::read(&self.base_dir.join(path), FileKind::File, FILE_SHARE);
        let bytes = bytes.map_err(|why| {
            let found = format!("\"{}\" cannot be read ({why})", path.display());
            Error::new(
                key_path,
                found,
                "must be a file, relative to the scene file",
            )
        })?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_taken = |name: &str| self.files.iter().any(|it| it["name"] == name);
        let numbered = |i: usize| match i {
            0 => name.to_string(),
            i => format!("{i}-{name}"),
        };
        let name = (0..).map(numbered).find(|name| !is_taken(name));
        let resource = self.file.push_resource(&name.unwrap_or_default(), &bytes);
        self.files.push(resource);
        self.known.insert(path.to_owned(), self.files.len() - 1);
        Ok(self.files.len() - 1)
    }
}
