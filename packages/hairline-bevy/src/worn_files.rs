//! Files with HAIRLINE_scratches (docs/HAIRLINE_scratches.md), as Bevy's glTF loader opens them: meshes get scratched materials, and lights their sizes.

use std::collections::{HashMap, HashSet};
use std::f32::consts::PI;
use std::sync::Arc;

use bevy::asset::LoadContext;
use bevy::gltf::extensions::{ErasedGltfExtensionHandler, GltfExtensionHandler};
use bevy::gltf::{GltfAssetLabel, GltfLoaderSettings, GltfMaterial};
use bevy::light::RectLight;
use bevy::mesh::morph::MeshMorphWeights;
use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use hairline_document::gltf_scene::VERSION;
use serde_json::{Value, json};

use crate::textures::of_metal;
use crate::worn_object::{NAME, WornObject, number, numbers, rows};
use crate::{Scratched, ScratchedTextures};

const AREA: &str = "EXT_lights_area";

/// What one file brings; the loader makes a copy of the first for each.
#[derive(Clone)]
pub(crate) struct WornFiles {
    textures: ScratchedTextures,
    file: Option<Arc<WornFile>>,
    /// Standard materials by their labels.
    bases: HashMap<String, StandardMaterial>,
    /// Meshes of the scene with the labels of their materials, and nodes that stand for objects.
    meshes: Vec<(Entity, String)>,
    objects: HashMap<Entity, usize>,
    told: HashSet<String>,
}

struct WornFile {
    extension: Value,
    /// Lights of [`AREA`].
    area: Value,
    objects: Vec<Option<WornObject>>,
}

impl WornFiles {
    pub(crate) fn new(textures: ScratchedTextures) -> Self {
        Self {
            textures,
            file: None,
            bases: HashMap::new(),
            meshes: Vec::new(),
            objects: HashMap::new(),
            told: HashSet::new(),
        }
    }

    /// Warns once of each thing that is not drawn.
    fn tell(&mut self, what: String) {
        if !self.told.contains(&what) {
            warn!("{NAME}: {what}");
            self.told.insert(what);
        }
    }

    fn remember_base(&mut self, load_context: &LoadContext, label: &str) {
        let made = load_context.get_labeled(format!("{label}/std"));
        if let Some(base) = made.and_then(|it| it.get::<StandardMaterial>()) {
            self.bases.insert(label.to_owned(), base.clone());
        }
    }

    /// The numbers in the extras of a light that stands in the scene's tables, and its colour, which Bevy takes for sRGB.
    fn own_light(&self, node: &gltf::Node) -> Option<(Value, Color)> {
        self.file.as_ref()?;
        node.extension_value(NAME)?.get("light")?;
        let light = node.light()?;
        let extras = light.extras().as_ref();
        let extras = extras.and_then(|it| serde_json::from_str(it.get()).ok());
        let [red, green, blue] = light.color();
        Some((
            extras.unwrap_or_default(),
            Color::linear_rgb(red, green, blue),
        ))
    }
}

impl GltfExtensionHandler for WornFiles {
    fn dyn_clone(&self) -> Box<dyn ErasedGltfExtensionHandler> {
        Box::new(self.clone())
    }

    fn on_root(
        &mut self,
        load_context: &mut LoadContext<'_>,
        gltf: &gltf::Gltf,
        _settings: &GltfLoaderSettings,
    ) {
        let Some(extension) = gltf.document.extension_value(NAME) else {
            return;
        };
        match WornFile::read(gltf, extension) {
            Ok(file) => {
                self.file = Some(Arc::new(file));
                self.remember_base(load_context, &GltfAssetLabel::DefaultMaterial.to_string());
                for key in ["environment", "studio", "ground"] {
                    let table = extension.get(key);
                    if table.is_some_and(|it| it.get("hidden") != Some(&Value::Bool(true))) {
                        self.tell(format!("not drawn: the {key}"));
                    }
                }
            }
            Err(why) => {
                let path = load_context.path();
                warn!("{path}: {NAME}: {why}: the model is shown plain");
            }
        }
    }

    fn on_material(
        &mut self,
        load_context: &mut LoadContext<'_>,
        _gltf_material: &gltf::Material,
        _material: Handle<GltfMaterial>,
        _material_asset: &GltfMaterial,
        material_label: &str,
    ) {
        if self.file.is_some() {
            self.remember_base(load_context, material_label);
        }
    }

    fn on_spawn_mesh_and_material(
        &mut self,
        _load_context: &mut LoadContext<'_>,
        _primitive: &gltf::Primitive,
        _mesh: &gltf::Mesh,
        _material: &gltf::Material,
        entity: &mut EntityWorldMut,
        material_label: &str,
    ) {
        self.meshes.push((entity.id(), material_label.to_owned()));
    }

    fn on_spawn_light_point(
        &mut self,
        _load_context: &mut LoadContext<'_>,
        node: &gltf::Node,
        entity: &mut EntityWorldMut,
    ) {
        if let Some((extras, color)) = self.own_light(node)
            && let Some(mut light) = entity.get_mut::<PointLight>()
        {
            light.color = color;
            light.radius = number(&extras, "radius").unwrap_or_default() as f32;
        }
    }

    fn on_spawn_light_spot(
        &mut self,
        _load_context: &mut LoadContext<'_>,
        node: &gltf::Node,
        entity: &mut EntityWorldMut,
    ) {
        if let Some((extras, color)) = self.own_light(node)
            && let Some(mut light) = entity.get_mut::<SpotLight>()
        {
            light.color = color;
            light.radius = number(&extras, "radius").unwrap_or_default() as f32;
        }
    }

    fn on_spawn_light_directional(
        &mut self,
        _load_context: &mut LoadContext<'_>,
        node: &gltf::Node,
        entity: &mut EntityWorldMut,
    ) {
        if let Some((_, color)) = self.own_light(node)
            && let Some(mut light) = entity.get_mut::<DirectionalLight>()
        {
            light.color = color;
        }
    }

    fn on_gltf_node(
        &mut self,
        _load_context: &mut LoadContext<'_>,
        node: &gltf::Node,
        entity: &mut EntityWorldMut,
    ) {
        let Some(file) = self.file.clone() else {
            return;
        };
        let own = node.extension_value(NAME);
        let index = |key: &str| Some(own?.get(key)?.as_u64()? as usize);
        if let Some(object) = index("object") {
            self.objects.insert(entity.id(), object);
        }
        let name = node.name().unwrap_or_default();
        if let Some(light) = index("light") {
            let table = file.extension.get("light").and_then(|it| it.get(light));
            let flat = node.extension_value(AREA).is_some();
            for key in ["picture", "barn_doors_deg", "cone_deg"] {
                let is_there = table.is_some_and(|it| it.get(key).is_some());
                if is_there && (flat || key != "cone_deg") {
                    self.tell(format!("not drawn: {key} of the light \"{name}\""));
                }
            }
            if own.is_some_and(|it| it.get("intensity").is_some()) {
                self.tell(format!(
                    "not drawn: the light \"{name}\", a polygon or a tube"
                ));
            }
        }
        let light = node.extension_value(AREA).and_then(|it| it.get("light"));
        let Some(light) = light.and_then(|it| file.area.get("lights")?.get(it.as_u64()? as usize))
        else {
            return;
        };
        let height = number(light, "size").unwrap_or(1.0) as f32;
        let rect = light.get("rect").unwrap_or(&Value::Null);
        let [mut width, mut height] = [
            height * number(rect, "aspect").unwrap_or(1.0) as f32,
            height,
        ];
        if light.get("type") == Some(&json!("disk")) {
            self.tell(format!(
                "drawn as a square of its area: the disk \"{name}\""
            ));
            let side = 0.5 * PI.sqrt();
            (width, height) = (side * width, side * height);
        }
        let [red, green, blue] = numbers(light, "color")
            .unwrap_or([1.0; 3])
            .map(|c| c as f32);
        entity.insert(RectLight {
            color: Color::linear_rgb(red, green, blue),
            // Lumens of a surface of that luminance.
            intensity: PI * width * height * number(light, "intensity").unwrap_or(1000.0) as f32,
            width,
            height,
            ..default()
        });
    }

    fn on_scene_completed(
        &mut self,
        _load_context: &mut LoadContext<'_>,
        _scene: &gltf::Scene,
        _world_root_id: Entity,
        world: &mut World,
    ) {
        let meshes = std::mem::take(&mut self.meshes);
        let objects = std::mem::take(&mut self.objects);
        let Some(file) = self.file.clone() else {
            return;
        };
        // Parts of an object share its textures.
        let mut known: HashMap<(usize, bool), Scratched> = HashMap::new();
        for (mesh, label) in meshes {
            let Some(node) = ancestors(world, mesh).find(|it| objects.contains_key(it)) else {
                continue;
            };
            let number = objects[&node];
            let Some(object) = file.objects.get(number).and_then(Option::as_ref) else {
                continue;
            };
            let of = &object.name;
            if world.get::<SkinnedMesh>(mesh).is_some()
                || world.get::<MeshMorphWeights>(mesh).is_some()
            {
                self.tell(format!(
                    "not drawn: scratches on skins and morphs, of \"{of}\""
                ));
                continue;
            }
            let (from_mesh, from_object) = (to_root(world, mesh), to_root(world, node));
            let (Some(_), Some(scale)) = (scale_of(&from_mesh), scale_of(&from_object)) else {
                self.tell(format!(
                    "not drawn: scratches on parts that are scaled unevenly, of \"{of}\""
                ));
                continue;
            };
            let Some(base) = self.bases.get(&label) else {
                continue;
            };
            let is_coated = base.clearcoat > 0.0;
            let mut extension = match known.get(&(number, is_coated)) {
                Some(known) => known.clone(),
                None => match object.scratches(scale) {
                    Ok(scratches) => self.textures.extension(object.metal, is_coated, &scratches),
                    Err(why) => {
                        self.tell(format!("not drawn: scratches on \"{of}\": {why}"));
                        continue;
                    }
                },
            };
            known.insert((number, is_coated), extension.clone());
            let from_metres = from_object * Mat4::from_scale(Vec3::splat(1.0 / scale));
            extension.settings.metres_from_mesh = from_metres.inverse() * from_mesh;
            let material = of_metal(object.metal, base.clone(), extension);
            let material = self.textures.add(material);
            let mut mesh = world.entity_mut(mesh);
            mesh.remove::<MeshMaterial3d<StandardMaterial>>();
            mesh.insert(MeshMaterial3d(material));
        }
    }
}

/// An entity and what it lies in, up to the root.
fn ancestors(world: &World, entity: Entity) -> impl Iterator<Item = Entity> {
    std::iter::successors(Some(entity), |it| Some(world.get::<ChildOf>(*it)?.parent()))
}

fn to_root(world: &World, entity: Entity) -> Mat4 {
    ancestors(world, entity).fold(Mat4::IDENTITY, |so_far, ancestor| {
        let transform = world
            .get::<Transform>(ancestor)
            .copied()
            .unwrap_or_default();
        transform.to_matrix() * so_far
    })
}

/// The scale of a matrix, where it is one.
fn scale_of(matrix: &Mat4) -> Option<f32> {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|it| it.length());
    let is_even = x > 0.0 && (y / x - 1.0).abs().max((z / x - 1.0).abs()) < 0.01;
    is_even.then_some(x)
}

impl WornFile {
    fn read(gltf: &gltf::Gltf, extension: &Value) -> Result<Self, String> {
        match extension.get("version") {
            Some(version) if *version == VERSION => {}
            Some(version) => return Err(format!("found version {version}; must be {VERSION}")),
            None => return Err(format!("`version` is missing; must have one, {VERSION}")),
        }
        if gltf.blob.is_none() {
            return Err("found no binary chunk; must be a .glb file".to_owned());
        }
        let mut objects = Vec::new();
        for (i, object) in rows(extension, "object") {
            let read = WornObject::read(gltf, extension, i as u64, object);
            // Hidden ones have numbers too.
            objects.resize(i, None);
            objects.push(read.map_err(|why| format!("on object {}: {why}", object["name"]))?);
        }
        Ok(Self {
            extension: extension.clone(),
            area: gltf
                .document
                .extension_value(AREA)
                .cloned()
                .unwrap_or_default(),
            objects,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_told_by_its_key() {
        let laid = json!({ "start_m": 7 });
        let cases = [
            (json!({ "version": 2 }), "found version 2; must be 1"),
            (json!({}), "`version` is missing; must have one, 1"),
            (
                json!({ "version": 1, "object": [{ "name": "pan" }], "scratches": [{ "object": "pan", "laid": laid }] }),
                "on object \"pan\": scratches[0].laid.start_m: found 7; must be the number of an accessor, Vec3 of F32",
            ),
            (
                json!({ "version": 1, "object": [{ "name": "pan" }], "grating": [{ "object": "pan", "laid": {} }] }),
                "on object \"pan\": grating[0].laid.texels: found null; must be the number of an accessor, Scalar of U32",
            ),
        ];
        let file = json!({ "asset": { "version": "2.0" } }).to_string();
        let mut gltf = gltf::Gltf::from_slice(file.as_bytes()).expect("a file");
        gltf.blob = Some(Vec::new());
        for (extension, wanted) in cases {
            let told = WornFile::read(&gltf, &extension).err();
            assert_eq!(told.as_deref(), Some(wanted));
        }
    }
}
