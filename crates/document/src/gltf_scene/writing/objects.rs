//! The objects of a scene as nodes: a model's file as it is, shapes as meshes.

use std::collections::HashMap;
use std::path::Path;

use glam::{DMat3, DMat4};
use hairline_image::FilePath;
use hairline_model::gltf_file::GltfFile;
use hairline_model::mesh_file;
use hairline_model::surface::Surface as Triangles;
use hairline_model::text::shown;
use serde_json::{Value, json};

use super::looks;
use super::nodes::{children, node};
use crate::convert;
use crate::description::{Description, FileUse, Grating, GroovePattern, Object, Surface};
use crate::error::Error;
use crate::gltf_scene::extension::EXTENSION;
use crate::loader::Loader;
use crate::shape;

/// Name of the program in its files.
pub(crate) const GENERATOR: &str = concat!("Hairline ", env!("CARGO_PKG_VERSION"));

/// Objects that are being written.
pub(super) struct Objects<'a> {
    loader: &'a Loader<'a>,
    described: &'a Description,
    base_dir: &'a FilePath,
    gltf_from_world: DMat4,
    pub file: GltfFile,
    /// Nodes of the objects that are not hidden.
    pub nodes: Vec<usize>,
    /// Notes on what other programs do not show.
    pub notes: Vec<String>,
    /// Names of the objects' models; none of shapes.
    pub names: Vec<Option<String>>,
    /// Nodes of the model's file that have no parent, until an object has them.
    model_roots: Option<Vec<usize>>,
    /// Numbers of the scene's materials in the file.
    looks: HashMap<String, usize>,
}

impl<'a> Objects<'a> {
    /// Begins with the file of the scene's model.
    pub(super) fn new(
        loader: &'a Loader<'a>,
        described: &'a Description,
        base_dir: &'a FilePath,
        gltf_from_world: DMat4,
    ) -> Result<Self, Error> {
        let models = models(described, loader);
        if let [_, (object, second), ..] = models[..] {
            let found = format!(
                "found a second model, \"{}\"",
                shown(&second.to_string_lossy())
            );
            let right = "must be one model and any number of shapes: join the models to one file";
            return Err(Error::new(format!("object[{object}].mesh"), found, right));
        }
        let file = match models[..] {
            [(object, model), ..] => GltfFile::read(&base_dir.join(model)).map_err(|flaw| {
                let found = format!("\"{}\": {}", model.display(), flaw.found);
                Error::new(format!("object[{object}].mesh"), found, flaw.right)
            })?,
            [] => GltfFile::new(GENERATOR),
        };
        Ok(Self {
            loader,
            described,
            base_dir,
            gltf_from_world,
            nodes: Vec::new(),
            notes: Vec::new(),
            names: Vec::new(),
            model_roots: Some(file.root_nodes()),
            looks: HashMap::new(),
            file,
        })
    }

    /// Writes all objects.
    pub(super) fn write(&mut self) -> Result<(), Error> {
        let (described, loader) = (self.described, self.loader);
        for (i, object) in described.objects.iter().enumerate() {
            let world_from_object = object.world_from_object();
            let gltf_from_object = self.gltf_from_world * world_from_object;
            let mut outer = node(&object.name, &gltf_from_object);
            outer["extensions"][EXTENSION]["object"] = json!(i);
            let name = match &object.surface {
                Surface::Shape(shape) => {
                    let material = self.look(object);
                    let surface = shape::surface(shape);
                    let mut attributes = self.attributes(&surface);
                    if self.has_grooves_by_uv(&object.name) {
                        attributes["TANGENT"] = json!(self.tangents(&surface));
                    }
                    let mesh = self.mesh(&object.name, attributes, &surface, material);
                    outer["mesh"] = json!(mesh);
                    None
                }
                Surface::Mesh(path) => {
                    let (name, child) = match loader.arrays.mesh(path) {
                        Some(arrays) => {
                            let name = format!("mesh-{i}.glb");
                            let inner = self.array(object, &name, &arrays.surface());
                            (name, inner)
                        }
                        None => self.model(object, path, &world_from_object)?,
                    };
                    outer["children"] = json!([child]);
                    Some(name)
                }
            };
            self.names.push(name);
            self.file.use_extension(EXTENSION);
            let outer = self.file.push("nodes", outer);
            if !object.hidden {
                self.nodes.push(outer);
            }
        }
        Ok(())
    }

    /// The node of a model's own frame, below which its file's nodes are, and the model's name.
    fn model(
        &mut self,
        object: &Object,
        path: &Path,
        world_from_object: &DMat4,
    ) -> Result<(String, usize), Error> {
        let placing = object.placing(self.described.camera.world_up());
        let file = self.base_dir.join(path);
        let start = mesh_file::object_from_file(&file, world_from_object, &placing);
        let start = start.map_err(|flaw| Error::new("object", flaw.found, flaw.right))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let mut inner = node(&name, &start);
        let children = match self.model_roots.take() {
            Some(roots) => roots,
            None => {
                let first = self.first_copy();
                first.into_iter().map(|node| self.copy(node)).collect()
            }
        };
        inner["children"] = json!(children);
        let mut note = |what: &str| {
            let name = shown(&object.name);
            (self.notes).push(format!("object \"{name}\": other programs show {what}"));
        };
        if object.material.is_some() || !object.overrides.is_empty() {
            note("the materials of its file");
        }
        if object.time_s.is_some() {
            note("its animation as it runs, and its scratches at rest");
        }
        Ok((name.into_owned(), self.file.push("nodes", inner)))
    }

    /// Roots of the model's file where it was written first.
    fn first_copy(&self) -> Vec<usize> {
        let nodes = self.file.list("nodes");
        let is_object = |it: &&Value| it["extensions"][EXTENSION]["object"].is_u64();
        let with_model = nodes
            .iter()
            .filter(is_object)
            .find(|it| !children(it).is_empty());
        let inner = with_model.map(|it| children(it)[0]);
        inner.map_or_else(Vec::new, |inner| children(&nodes[inner]))
    }

    /// Copies a node with those below it; they share its mesh. A skin moves the first one alone.
    fn copy(&mut self, number: usize) -> usize {
        let mut copied = self.file.list("nodes")[number].clone();
        if let Some(members) = copied.as_object_mut() {
            members.remove("skin");
        }
        let below = children(&copied);
        if !below.is_empty() {
            let copies: Vec<usize> = below.into_iter().map(|it| self.copy(it)).collect();
            copied["children"] = json!(copies);
        }
        self.file.push("nodes", copied)
    }

    /// The node of a mesh in memory, as of a model of this name.
    fn array(&mut self, object: &Object, name: &str, surface: &Triangles) -> usize {
        let placing = object.placing(self.described.camera.world_up());
        let object_from_file = mesh_file::quarter_turn(placing.up, placing.world_up);
        let material = self.look(object);
        let turned = turned(surface, &object_from_file.transpose());
        self.file.pushes_own = true;
        let attributes = self.attributes(&turned);
        let mesh = self.mesh(name, attributes, &turned, material);
        let leaf = self.file.push("nodes", json!({ "mesh": mesh }));
        self.file.pushes_own = false;
        let mut inner = node(name, &DMat4::from_mat3(object_from_file));
        inner["children"] = json!([leaf]);
        self.file.push("nodes", inner)
    }

    /// The material of an object in the file.
    fn look(&mut self, object: &Object) -> Option<usize> {
        let name = object.material.as_ref()?;
        if let Some(known) = self.looks.get(name) {
            return Some(*known);
        }
        let material = self
            .described
            .materials
            .iter()
            .find(|it| it.name == *name)?;
        // What a mesh in memory is of comes out of the file with it.
        let mut all = self.described.objects.iter();
        self.file.pushes_own = all.any(|other| match &other.surface {
            Surface::Mesh(path) => other.material == object.material && self.is_array(path),
            Surface::Shape(_) => false,
        });
        let material = convert::material(material);
        let number = looks::write(&material, &mut self.file, &mut self.notes);
        self.file.pushes_own = false;
        self.looks.insert(name.clone(), number);
        Some(number)
    }

    fn is_array(&self, path: &Path) -> bool {
        self.loader.arrays.mesh(path).is_some()
    }

    /// Whether a grating of the object follows its texture coordinates, as its tangents say.
    fn has_grooves_by_uv(&self, object: &str) -> bool {
        let is_by_uv = |it: &Grating| matches!(it.pattern, GroovePattern::Uv { .. });
        let mut gratings = self.described.gratings.iter();
        gratings.any(|it| it.object == object && is_by_uv(it))
    }

    fn tangents(&mut self, surface: &Triangles) -> usize {
        let vertices = surface.vertices.iter();
        let all = vertices.flat_map(|vertex| {
            let sign = vertex.handedness as f32;
            vertex.tangent.as_vec3().extend(sign).to_array()
        });
        self.file.push_floats(&all.collect::<Vec<f32>>(), 4, false)
    }

    fn attributes(&mut self, surface: &Triangles) -> Value {
        let vertices = surface.vertices.iter();
        let flat = |of: fn(&hairline_model::surface::Vertex) -> [f32; 3]| -> Vec<f32> {
            vertices.clone().flat_map(of).collect()
        };
        let positions = flat(|it| it.position_m.as_vec3().to_array());
        let normals = flat(|it| it.normal.as_vec3().to_array());
        let uvs: Vec<f32> = vertices.clone().flat_map(|it| it.uv.to_array()).collect();
        json!({
            "POSITION": self.file.push_floats(&positions, 3, true),
            "NORMAL": self.file.push_floats(&normals, 3, false),
            "TEXCOORD_0": self.file.push_floats(&uvs, 2, false),
        })
    }

    fn mesh(
        &mut self,
        name: &str,
        attributes: Value,
        surface: &Triangles,
        material: Option<usize>,
    ) -> usize {
        let mut primitive = json!({
            "attributes": attributes,
            "indices": self.file.push_wholes(surface.triangles.as_flattened()),
        });
        if let Some(material) = material {
            primitive["material"] = json!(material);
        }
        self.file
            .push("meshes", json!({ "name": name, "primitives": [primitive] }))
    }
}

fn turned(surface: &Triangles, by: &DMat3) -> Triangles {
    let mut turned = surface.clone();
    for vertex in &mut turned.vertices {
        vertex.position_m = *by * vertex.position_m;
        vertex.normal = *by * vertex.normal;
    }
    turned
}

/// The models' files that a scene names, each once, with the number of the first object of each.
fn models<'d>(described: &'d Description, loader: &Loader) -> Vec<(usize, &'d Path)> {
    let mut models: Vec<(usize, &Path)> = Vec::new();
    for (used_for, path) in described.files() {
        if let FileUse::Mesh(object) = used_for
            && loader.arrays.mesh(path).is_none()
            && !models.iter().any(|(_, known)| known == path)
        {
            models.push((object, path));
        }
    }
    models
}
