//! A model as one binary glTF file without scratches: meshes, materials and their textures.

use std::collections::HashMap;

use hairline_model::gltf_file::GltfFile;
use hairline_scene::{Material, Mesh, Object, Texture, Wrap};
use serde_json::{Value, json};

use super::model::PlainModel;
use super::parts::{Part, parts};
use super::pictures::png;
use crate::error::Error;
use crate::gltf_scene::Exported;
use crate::gltf_scene::writing::looks;
use crate::gltf_scene::writing::objects::GENERATOR;

const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;
const LINEAR_MIPS: u32 = 9987;

impl PlainModel {
    /// The binary glTF file.
    pub(crate) fn to_glb(&self) -> Result<Exported, Error> {
        let mut notes = self.notes();
        let bytes = file(self, &mut notes)?;
        Ok(Exported { bytes, notes })
    }
}

/// The file. `notes` get what other programs do not show.
fn file(model: &PlainModel, notes: &mut Vec<String>) -> Result<Vec<u8>, Error> {
    let mut file = GltfFile::new(GENERATOR);
    file.pushes_own = true;
    let mut writer = Writer {
        model,
        file,
        notes,
        looks: HashMap::new(),
        textures: HashMap::new(),
    };
    let nodes = model.objects().map(|object| writer.object(object));
    let nodes = nodes.collect();
    writer.file.set_root_nodes(nodes);
    let bytes = writer.file.to_glb();
    bytes.map_err(|flaw| Error::new("", flaw.found, flaw.right))
}

struct Writer<'a> {
    model: &'a PlainModel,
    file: GltfFile,
    notes: &'a mut Vec<String>,
    /// Numbers in the file of the scene's materials.
    looks: HashMap<usize, usize>,
    /// Numbers in the file of the scene's textures.
    textures: HashMap<usize, usize>,
}

impl Writer<'_> {
    /// The node of an object.
    fn object(&mut self, object: &Object) -> usize {
        let parts = parts(&object.mesh);
        let primitives: Vec<Value> = parts
            .map(|part| self.primitive(&object.mesh, &part))
            .collect();
        let name = &object.name;
        let mesh = json!({ "name": name, "primitives": primitives });
        let mesh = self.file.push("meshes", mesh);
        self.file
            .push("nodes", json!({ "name": name, "mesh": mesh }))
    }

    fn primitive(&mut self, mesh: &Mesh, part: &Part) -> Value {
        let model = self.model;
        let vertices = || part.vertices.iter().copied();
        let places = vertices().flat_map(|v| model.turned(mesh.positions_m[v]).to_array());
        let normals = vertices().flat_map(|v| model.turned(mesh.normals[v]).to_array());
        let mut attributes = json!({
            "POSITION": self.file.push_floats(&places.collect::<Vec<_>>(), 3, true),
            "NORMAL": self.file.push_floats(&normals.collect::<Vec<_>>(), 3, false),
        });
        for (name, uvs) in [("TEXCOORD_0", &mesh.uvs), ("TEXCOORD_1", &mesh.other_uvs)] {
            if uvs.len() == mesh.positions_m.len() {
                let uvs: Vec<f32> = vertices().flat_map(|v| uvs[v].to_array()).collect();
                attributes[name] = json!(self.file.push_floats(&uvs, 2, false));
            }
        }
        if mesh.colors.len() == mesh.positions_m.len() {
            let colors = vertices().flat_map(|v| mesh.colors[v].to_array());
            let colors = self.file.push_floats(&colors.collect::<Vec<_>>(), 4, false);
            attributes["COLOR_0"] = json!(colors);
        }
        json!({
            "attributes": attributes,
            "indices": self.file.push_wholes(&part.corners),
            "material": self.look(part.material),
        })
    }

    /// Number of a material in the file.
    fn look(&mut self, number: usize) -> usize {
        if let Some(known) = self.looks.get(&number) {
            return *known;
        }
        let model = self.model;
        let material = &model.scene.materials[number];
        let look = looks::write(material, &mut self.file, self.notes);
        self.looks.insert(number, look);
        let maps: Vec<_> = maps(material)
            .into_iter()
            .filter_map(|(json_path, texture, factor)| {
                Some((json_path, self.texture(texture?), factor))
            })
            .collect();
        let Some(written) = self.file.element_mut("materials", look) else {
            return look;
        };
        // Triangles are seen from both sides.
        written["doubleSided"] = json!(true);
        for (json_path, (texture, set), factor) in maps {
            let mut info = json!({ "index": texture, "texCoord": set });
            if let Some((name, factor)) = factor {
                info[name] = json!(factor);
            }
            *json_path
                .iter()
                .fold(&mut *written, |at, key| &mut at[*key]) = info;
        }
        look
    }

    /// Number of a texture in the file, and of its texture coordinates.
    fn texture(&mut self, (number, are_normals): (usize, bool)) -> (usize, usize) {
        let texture = &self.model.scene.textures[number];
        let set = usize::from(texture.sampling.by_other_uvs);
        if let Some(known) = self.textures.get(&number) {
            return (*known, set);
        }
        let view = self.file.push_view(&png(texture, are_normals));
        let image = json!({ "bufferView": view, "mimeType": "image/png" });
        let image = self.file.push("images", image);
        let sampler = self.file.push("samplers", sampler(texture));
        let written = json!({ "source": image, "sampler": sampler });
        let written = self.file.push("textures", written);
        self.textures.insert(number, written);
        (written, set)
    }
}

fn sampler(texture: &Texture) -> Value {
    let [s, t] = texture.sampling.wrap.map(|wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    });
    let seen_large = match texture.sampling.is_sharp {
        true => NEAREST,
        false => LINEAR,
    };
    json!({ "wrapS": s, "wrapT": t, "magFilter": seen_large, "minFilter": LINEAR_MIPS })
}

/// The path of a texture in the JSON of a material.
type JsonPath = &'static [&'static str];
/// A texture, and whether it is a normal map.
type Map = Option<(usize, bool)>;
/// What its values are multiplied with, by its name.
type Factor = Option<(&'static str, f64)>;

/// The textures of a material: where each goes, its number, and what its values are multiplied with.
fn maps(material: &Material) -> Vec<(JsonPath, Map, Factor)> {
    const COAT: &str = "KHR_materials_clearcoat";
    const SPECULAR: &str = "KHR_materials_specular";
    let plain = |json_path: JsonPath, texture: Option<usize>| {
        (json_path, texture.map(|it| (it, false)), None)
    };
    let scaled = |json_path: JsonPath, texture: Option<(usize, f64)>, name: &'static str| {
        let are_normals = name == "scale";
        let map = texture.map(|(it, _)| (it, are_normals));
        (json_path, map, texture.map(|(_, factor)| (name, factor)))
    };
    let [coat, coat_roughness] = material.coat_textures;
    let [specular, specular_color] = material.specular_textures;
    let mut maps = vec![
        plain(
            &["pbrMetallicRoughness", "baseColorTexture"],
            material.base_color_texture,
        ),
        plain(
            &["pbrMetallicRoughness", "metallicRoughnessTexture"],
            material.metallic_roughness_texture,
        ),
        scaled(&["normalTexture"], material.normal_texture, "scale"),
        scaled(
            &["occlusionTexture"],
            material.occlusion_texture,
            "strength",
        ),
        plain(&["emissiveTexture"], material.emission_texture),
        plain(&["extensions", SPECULAR, "specularTexture"], specular),
        plain(
            &["extensions", SPECULAR, "specularColorTexture"],
            specular_color,
        ),
    ];
    if material.coat.is_some() {
        maps.extend([
            plain(&["extensions", COAT, "clearcoatTexture"], coat),
            plain(
                &["extensions", COAT, "clearcoatRoughnessTexture"],
                coat_roughness,
            ),
            scaled(
                &["extensions", COAT, "clearcoatNormalTexture"],
                material.coat_normal_texture,
                "scale",
            ),
        ]);
    }
    if material.anisotropy.is_some() {
        let json_path: JsonPath = &[
            "extensions",
            "KHR_materials_anisotropy",
            "anisotropyTexture",
        ];
        maps.push(plain(json_path, material.anisotropy_texture));
    }
    maps
}
