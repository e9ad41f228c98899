//! Builds scenes one after the other and keeps unchanged parts, as an editor needs it.

mod gratings;
mod kept;
mod parts;
mod scratch_layers;
mod textures;

use std::fmt;
use std::sync::{Arc, LazyLock};

use glam::DVec3;
use hairline_image::FilePath;
use hairline_model::texture::texture_bytes;
use hairline_scene::{GrooveShapes, MOST_SHAPES, Mesh, Object, Scene};

use crate::convert;
use crate::description::{self, Description};
use crate::error::Error;
use crate::estimate::Estimate;
use crate::gltf_scene::packed_files::with_packed;
use crate::lamp_shape;
use crate::light_picture::LightPicture;
use crate::loader::{Loader, Stage};
use crate::stamp::Stamp;
use crate::studio::PhotoSet;
use kept::{BuildCache, KeptPicture, KeptSurface, MapKey, SurfaceKey};
use textures::NewTextures;

/// Builds scenes one after the other. What of a scene is as it was in the one before is not made again, but shared with it:
///
/// * surfaces, by their shape or file and their transform;
/// * the environment map, by its file, whatever its rotation and intensity;
/// * scratches, layer by layer, by all that the layer's table says but its name. Hidden layers stay at hand;
/// * tables that renderers compute for the scene's grooves.
///
/// Files are known by their path, their length and the time of their last change. A scene that was built so equals one that
/// was built from nothing. A clone shares what is kept, and costs next to nothing.
#[derive(Clone, Default)]
pub struct SceneBuilder {
    kept: BuildCache,
}

impl fmt::Debug for SceneBuilder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SceneBuilder").finish_non_exhaustive()
    }
}

impl SceneBuilder {
    /// A builder that has built nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Builds the scene of a description. Files are looked for in `base_dir`.
    ///
    /// Where it fails, the builder keeps what it had before.
    ///
    /// # Errors
    /// What is wrong with the scene, by its key, or that [`Loader::cancelled`] said so; see [`Error::is_cancelled`].
    pub fn build(
        &mut self,
        loader: &Loader,
        description: &Description,
        base_dir: impl Into<FilePath>,
    ) -> Result<Scene, Error> {
        let base_dir = &with_packed(base_dir);
        description.check()?;
        description.check_gratings()?;
        let description = &*description.with_its_camera(base_dir)?;
        let mut work = Work {
            loader,
            description,
            base_dir,
            old: &self.kept,
            new: BuildCache {
                tables: self.kept.tables.clone(),
                ..BuildCache::default()
            },
            estimate: Estimate::default(),
        };
        let scene = work.scene()?;
        self.kept = work.new;
        Ok(scene)
    }
}

/// One build.
struct Work<'a> {
    loader: &'a Loader<'a>,
    description: &'a Description,
    base_dir: &'a FilePath,
    old: &'a BuildCache,
    /// Results that the next build can reuse.
    new: BuildCache,
    /// Memory of the parts to be built, without textures and scratches.
    estimate: Estimate,
}

impl<'a> Work<'a> {
    fn scene(&mut self) -> Result<Scene, Error> {
        self.estimate = self.check_memory()?;
        let mut scene = convert::without_surfaces(self.description);
        scene.tables = self.new.tables.clone();
        let mut surfaces = self.surfaces(&mut scene)?;
        self.photo_set(&mut surfaces, &mut scene)?;
        self.lamps(&mut scene);
        self.loader.go_on()?;
        scene.environment = self.environment(&mut scene)?;
        self.scratches(&surfaces, &mut scene)?;
        check_shapes(&scene)?;
        self.new.surfaces = surfaces;
        Ok(scene)
    }

    /// Refuses a scene that would not fit into memory, before it is built.
    fn check_memory(&self) -> Result<Estimate, Error> {
        let mut estimate = Estimate::default();
        estimate.add_lights(self.description);
        let up = self.description.camera.world_up();
        for (i, object) in self.description.objects.iter().enumerate() {
            let key = self.surface_key(object, up);
            if self.old.surface(&key).is_none() {
                estimate.add_object(self.description, i, self.base_dir);
            }
        }
        if let Some(described) = &self.description.environment
            && self
                .old
                .map(&MapKey::new(&described.map, self.base_dir))
                .is_none()
        {
            estimate.add_environment(self.description, self.base_dir);
        }
        estimate.check(self.loader.memory_budget_bytes as f64)?;
        Ok(estimate)
    }

    fn surface_key(&self, object: &description::Object, up: DVec3) -> SurfaceKey {
        let lights_of = self.description.lights_of.as_deref();
        SurfaceKey::new(object, lights_of, self.base_dir, up)
    }

    /// The objects' surfaces, which are added to the scene with the materials and textures that they bring.
    fn surfaces(&mut self, scene: &mut Scene) -> Result<Vec<Arc<KeptSurface>>, Error> {
        let objects = &self.description.objects;
        let total = objects.len() as u64;
        let mut surfaces = Vec::new();
        let mut textures = NewTextures {
            parts: Vec::new(),
            count: 0,
            free_bytes: self.loader.memory_budget_bytes as f64 - self.estimate.bytes(),
        };
        let up = self.description.camera.world_up();
        for (i, object) in objects.iter().enumerate() {
            self.loader.go_on()?;
            self.loader.report(Stage::Meshes, i as u64, total);
            let key = format!("object[{i}]");
            let material = convert::object_material(object, &key, &self.description.materials)?;
            let surface_key = self.surface_key(object, up);
            let first_material = material.unwrap_or(scene.materials.len() as u32);
            let surface = match self.old.surface(&surface_key) {
                Some(kept) => kept,
                None => {
                    let free_bytes = textures.free_bytes;
                    let read =
                        KeptSurface::read(self.loader, surface_key, object, &key, free_bytes)?;
                    let sizes = read.textures.iter().map(|texture| texture.size_px);
                    textures.free_bytes -= sizes.map(texture_bytes).sum::<f64>();
                    Arc::new(read)
                }
            };
            let surface = surface.with_materials_from(first_material);
            let mut own = surface.materials.to_vec();
            parts::override_materials(&object.overrides, &mut own, &key)?;
            let own = own.into_iter();
            let first_texture = textures.add(surface.textures.clone());
            scene
                .materials
                .extend(own.map(|own| convert::with_textures_from(own, first_texture)));
            for note in surface.notes.iter() {
                // Objects may share a file.
                if !scene.notes.contains(note) {
                    scene.notes.push(note.clone());
                }
            }
            scene.objects.push(bare_object(object, &surface));
            surfaces.push(surface);
        }
        self.gratings(scene, &surfaces, &mut textures)?;
        self.pictures(scene, &mut textures)?;
        self.loader.report(Stage::Meshes, total, total);
        self.new.textures = self.old.textures(textures.parts);
        scene.textures = self.new.textures.together.clone();
        Ok(surfaces)
    }

    /// The pictures on lights.
    fn pictures(&mut self, scene: &mut Scene, textures: &mut NewTextures) -> Result<(), Error> {
        let lights = self.description.lights.iter().enumerate();
        let shining = lights.filter(|(_, light)| !light.hidden);
        for ((i, described), light) in shining.zip(&mut scene.lights) {
            let Some(file) = &described.picture else {
                continue;
            };
            let stamp = Stamp::read(&self.base_dir.join(file));
            let known = self
                .new
                .picture(&stamp)
                .or_else(|| self.old.picture(&stamp));
            let picture = match known {
                Some(picture) => picture,
                None => {
                    let read = LightPicture::read(&self.base_dir.join(file), textures.free_bytes);
                    let read = read.map_err(|found| {
                        let right =
                            "must be a .png, .jpg, .webp, .hdr or .exr, relative to the scene file";
                        Error::new(format!("light[{i}].picture"), found, right)
                    })?;
                    textures.free_bytes -= texture_bytes(read.texture.size_px);
                    KeptPicture {
                        file: stamp,
                        brightest: read.brightest,
                        texture: Arc::new(vec![read.texture]),
                    }
                }
            };
            light.radiance = light.radiance.map(|c| c * picture.brightest);
            light.picture = Some(textures.add(picture.texture.clone()));
            self.new.pictures.push(picture);
        }
        Ok(())
    }

    /// The studio's lights, and the ground behind all other objects.
    fn photo_set(
        &mut self,
        surfaces: &mut Vec<Arc<KeptSurface>>,
        scene: &mut Scene,
    ) -> Result<(), Error> {
        let described = self.description;
        // Hidden ones have no triangles.
        let meshes = scene.objects.iter().map(|object| &object.mesh);
        let shown = meshes.filter(|mesh| !mesh.triangles.is_empty());
        let bounds = shown.map(|mesh| mesh.bounds_m());
        let bounds = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let bounds_m = match bounds {
            Some((least, most)) => (least.as_dvec3(), most.as_dvec3()),
            None if described.objects.is_empty() => crate::probe::empty_bounds_m(described),
            None => return Ok(()),
        };
        let set = PhotoSet::new(&described.camera, bounds_m);
        if !described.studio.hidden {
            let lights = set.lights(&described.studio);
            scene
                .lights
                .extend(lights.iter().map(description::Light::in_scene));
        }
        let Some(ground) = described.ground.as_ref().filter(|ground| !ground.hidden) else {
            return Ok(());
        };
        let (object, material) = set.ground(ground);
        let key = self.surface_key(&object, DVec3::Z);
        let surface = match self.old.surface(&key) {
            Some(kept) => kept,
            None => Arc::new(KeptSurface::read(self.loader, key, &object, "ground", 0.0)?),
        };
        let surface = surface.with_materials_from(scene.materials.len() as u32);
        scene.materials.push(convert::material(&material));
        let object = Object {
            name: object.name,
            mesh: surface.mesh.clone(),
            scratches: Arc::default(),
            segments: Arc::default(),
            parts: Arc::default(),
            gratings: Vec::new(),
            is_lamp: false,
        };
        match ground.shadows_only {
            true => scene.shadow_catcher = Some(object),
            false => scene.objects.push(object),
        }
        surfaces.push(surface);
        Ok(())
    }

    /// The shapes of the lights that the camera sees, behind all other objects.
    fn lamps(&mut self, scene: &mut Scene) {
        let eye_m = scene.camera.position_m;
        let lights = self.description.lights.iter();
        let shining = lights.filter(|light| !light.hidden).zip(&scene.lights);
        for (light, shining) in shining.filter(|(light, _)| light.visible) {
            let material = scene.materials.len() as u32;
            let mesh = match self.old.lamp(&light.kind, material) {
                Some(mesh) => mesh,
                None => Arc::new(lamp_shape::mesh(&light.kind, material)),
            };
            self.new
                .lamps
                .push((light.kind.clone(), material, mesh.clone()));
            scene
                .materials
                .push(lamp_shape::material(light, shining, eye_m));
            scene.objects.push(Object {
                name: light.name.clone().unwrap_or(light.kind.title().to_owned()),
                mesh,
                scratches: Arc::default(),
                segments: Arc::default(),
                parts: Arc::default(),
                gratings: Vec::new(),
                is_lamp: true,
            });
        }
    }

    fn environment(
        &mut self,
        scene: &mut Scene,
    ) -> Result<Option<hairline_scene::Environment>, Error> {
        let studio = &self.description.studio;
        let room = (!studio.hidden).then(|| studio.room());
        let Some(described) = self.description.environment.as_ref().or(room.as_ref()) else {
            return Ok(None);
        };
        self.loader.report(Stage::Environment, 0, 1);
        let key = MapKey::new(&described.map, self.base_dir);
        let map = match self.old.map(&key) {
            Some(map) => map,
            None => convert::environment_map(&described.map, self.base_dir)?,
        };
        self.new.map = Some((key, map.clone()));
        scene.notes.extend_from_slice(map.notes());
        self.loader.report(Stage::Environment, 1, 1);
        let up = self.description.camera.world_up();
        Ok(Some(convert::environment(described, map, up)))
    }
}

/// An object before anything is laid on it.
fn bare_object(object: &description::Object, surface: &KeptSurface) -> Object {
    Object {
        name: object.name.clone(),
        // A hidden object keeps its place in the list, without triangles.
        mesh: match object.hidden {
            true => no_mesh(),
            false => surface.mesh.clone(),
        },
        scratches: Arc::default(),
        segments: Arc::default(),
        parts: surface.parts.clone(),
        gratings: Vec::new(),
        is_lamp: false,
    }
}

/// A mesh without triangles: one for all, so that a scene that is built anew has the same.
fn no_mesh() -> Arc<Mesh> {
    static NONE: LazyLock<Arc<Mesh>> = LazyLock::new(Arc::default);
    NONE.clone()
}

/// Refuses scratches of more shapes than renderers have tables for.
fn check_shapes(scene: &Scene) -> Result<(), Error> {
    let count = GrooveShapes::new(scene).count();
    match count <= MOST_SHAPES {
        true => Ok(()),
        false => Err(Error::new(
            "scratches",
            format!(
                "found grooves of {count} shapes: profiles, each as narrow ones and in up to five classes of wide ones"
            ),
            format!(
                "must be at most {MOST_SHAPES}: fewer profiles, or widths below 0.4 of the materials' `coherence_um`"
            ),
        )),
    }
}
