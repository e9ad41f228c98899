//! Results that a build stores for the next build, and their keys.

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::{DMat4, DVec3};
use hairline_image::FilePath;
use hairline_laying::Ground;
use hairline_model::mesh_file::{self, FileContents, Placing, UsedContents};
use hairline_model::text::shown;
use hairline_optics::section::Section;
use hairline_scene::{
    Environment, KeptTables, Material, Mesh, NodeTriangles, Scratch, Segment, Texture,
};
use hairline_sky::BuiltInMap;

use super::parts::{OnPart, PartGround, Surroundings};
use crate::description::{self, Layer, LayerPlaces, LightKind, Map, Stroke, Surface};
use crate::error::Error;
use crate::grey_map::GreyMap;
use crate::loader::Loader;
use crate::scratches::{self, Laid};
use crate::stamp::Stamp;
use crate::{model_notes, shape};

/// Results of the last build.
#[derive(Clone, Default)]
pub(super) struct BuildCache {
    pub surfaces: Vec<Arc<KeptSurface>>,
    pub tables: Arc<KeptTables>,
    pub textures: Textures,
    pub pictures: Vec<KeptPicture>,
    pub groove_pictures: Vec<KeptGroovePicture>,
    /// Grey maps of layers' places.
    pub grey_maps: Vec<(Stamp, Arc<GreyMap>)>,
    /// The map with no rotation, intensity 1.
    pub map: Option<(MapKey, Environment)>,
    pub layers: Vec<Arc<KeptLayer>>,
    pub objects: Vec<ObjectScratches>,
    /// Shapes of lights, with the numbers of their materials.
    pub lamps: Vec<(LightKind, u32, Arc<Mesh>)>,
}

/// Source of a map.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum MapKey {
    File(Stamp),
    BuiltIn(BuiltInMap),
}

impl MapKey {
    pub(super) fn new(map: &Map, base_dir: &FilePath) -> Self {
        match map {
            Map::File(file) => Self::File(Stamp::read(&base_dir.join(file))),
            Map::BuiltIn(map) => Self::BuiltIn(*map),
        }
    }
}

/// Everything that an object's triangles depend on, except the numbers of their materials.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SurfaceKey {
    surface: Surface,
    /// Contents of the file that are shown.
    wanted: UsedContents,
    world_from_object: DMat4,
    /// The file, if it is one.
    file: Option<Stamp>,
    placing: Placing,
}

impl SurfaceKey {
    /// `world_up` is the axis that points up; `lights_of` as in [`description::Description::lights_of`].
    pub(super) fn new(
        object: &description::Object,
        lights_of: Option<&Path>,
        base_dir: &FilePath,
        world_up: DVec3,
    ) -> Self {
        let (file, placing) = match &object.surface {
            Surface::Shape(_) => (None, Placing::NONE),
            Surface::Mesh(file) => {
                let placing = object.placing(world_up);
                (Some(Stamp::read(&base_dir.join(file))), placing)
            }
        };
        Self {
            surface: object.surface.clone(),
            wanted: object.used_contents(lights_of),
            world_from_object: object.world_from_object(),
            file,
            placing,
        }
    }
}

/// Surfaces made ready for layers, each with the part of the object that it covers.
type Grounds = Vec<(OnPart, Arc<PartGround>)>;

/// An object's surface with the materials, textures and notes of its file.
pub(super) struct KeptSurface {
    key: SurfaceKey,
    /// Files that the mesh's file refers to.
    others: Vec<Stamp>,
    /// Mesh of the object; the materials of its triangles count from `first_material`.
    pub mesh: Arc<Mesh>,
    first_material: u32,
    /// The file's own; their textures count from 0.
    pub materials: Arc<Vec<Material>>,
    pub textures: Arc<Vec<Texture>>,
    /// Notes on the file for the scene's author.
    pub notes: Arc<Vec<String>>,
    /// Parts of the object that its file names.
    pub parts: Arc<Vec<NodeTriangles>>,
    /// Grounds of the surface. They do not depend on the numbers of its materials, so all objects share
    /// them.
    grounds: Arc<Mutex<Grounds>>,
}

impl KeptSurface {
    /// `key` is the path of the object in the scene file; its textures may take `free_bytes`.
    pub(super) fn read(
        loader: &Loader,
        surface_key: SurfaceKey,
        object: &description::Object,
        key: &str,
        free_bytes: f64,
    ) -> Result<Self, Error> {
        let (mut materials, mut textures) = (Vec::new(), Vec::new());
        let mut files = Vec::new();
        let (mut notes, mut parts) = (Vec::new(), Vec::new());
        let transform = &surface_key.world_from_object;
        let mesh = match (&surface_key.surface, &surface_key.file) {
            (Surface::Mesh(file), _) if let Some(arrays) = loader.arrays.mesh(file) => {
                if surface_key.wanted.own_materials {
                    let right = "a mesh in memory has none of its own";
                    return Err(Error::new(key, "`material` is missing", right));
                }
                arrays.surface().baked(transform)
            }
            (Surface::Mesh(file), Some(stamp)) => {
                let mut found = Vec::new();
                let stock = FileContents {
                    notes: &mut found,
                    moved_from: &mut None,
                    parts: &mut parts,
                    materials: &mut materials,
                    textures: &mut textures,
                    files: &mut files,
                    free_bytes,
                    with_mips: true,
                };
                let material = (!surface_key.wanted.own_materials).then_some(0);
                let placing = &surface_key.placing;
                let read = mesh_file::read(&stamp.path, material, transform, placing, stock);
                let left_out = mesh_file::left_out(&stamp.path, surface_key.wanted);
                notes = model_notes::notes(file, &left_out);
                notes.extend(found.iter().map(|what| model_notes::note(file, what)));
                read.map_err(|flaw| {
                    let file = shown(&file.to_string_lossy());
                    let found = format!("\"{file}\": {}", flaw.found);
                    Error::new(format!("{key}.mesh"), found, flaw.right)
                })?
            }
            (Surface::Shape(shape), _) => shape::surface(shape).baked(transform),
            (Surface::Mesh(_), None) => unreachable!("a file has a stamp"),
        };
        if mesh.triangles.is_empty() {
            notes.push(why_it_is_gone(object, key)?);
        }
        Ok(Self {
            key: surface_key,
            others: files.iter().map(Stamp::read).collect(),
            mesh: Arc::new(mesh),
            first_material: 0,
            materials: Arc::new(materials),
            textures: Arc::new(textures),
            notes: Arc::new(notes),
            parts: Arc::new(parts),
            grounds: Arc::default(),
        })
    }

    /// Whether there is nothing to be seen at the time that is shown.
    pub(super) fn is_gone(&self) -> bool {
        self.mesh.triangles.is_empty()
    }

    /// The surface with its materials numbered from `first` on.
    pub(super) fn with_materials_from(self: Arc<Self>, first: u32) -> Arc<Self> {
        if self.first_material == first {
            return self;
        }
        let renumber = |mesh: &mut Mesh| {
            for material in &mut mesh.triangle_materials {
                *material = *material - self.first_material + first;
            }
        };
        let mut mesh = Mesh::clone(&self.mesh);
        renumber(&mut mesh);
        Arc::new(Self {
            key: self.key.clone(),
            others: self.others.clone(),
            mesh: Arc::new(mesh),
            first_material: first,
            materials: self.materials.clone(),
            textures: self.textures.clone(),
            notes: self.notes.clone(),
            parts: self.parts.clone(),
            grounds: self.grounds.clone(),
        })
    }

    /// Returns the surface for layers on a part of the object; `key` is the path to such a layer in the
    /// scene file.
    pub(super) fn ground(&self, on: &OnPart, key: &str) -> Result<Arc<PartGround>, Error> {
        if let Some(made) = self.ground_if_made(on) {
            return Ok(made);
        }
        let triangles = on.triangles(&Surroundings {
            mesh: &self.mesh,
            first_material: self.first_material,
            materials: &self.materials,
            parts: &self.parts,
            key,
        })?;
        let made = Arc::new(PartGround::new(
            &self.mesh,
            triangles,
            self.key.world_from_object,
        ));
        self.grounds().push((on.clone(), made.clone()));
        Ok(made)
    }

    pub(super) fn ground_if_made(&self, on: &OnPart) -> Option<Arc<PartGround>> {
        let grounds = self.grounds();
        let (_, made) = grounds.iter().find(|(known, _)| known == on)?;
        Some(made.clone())
    }

    fn grounds(&self) -> MutexGuard<'_, Grounds> {
        // The list is consistent even after a panic: items are pushed whole.
        self.grounds.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Note about an object without surface. `key` is its path.
///
/// # Errors
/// It has none at any time.
fn why_it_is_gone(object: &description::Object, key: &str) -> Result<String, Error> {
    match (&object.surface, object.time_s) {
        // Animations hide what they move by a scale of 0.
        (Surface::Mesh(file), Some(time_s)) => {
            let why = format!("it has no surface at {time_s} s, so it is not seen then");
            Ok(model_notes::note(file, &why))
        }
        _ => {
            let name = shown(&object.name);
            let found = format!("found no surface: every triangle of \"{name}\" has zero area");
            Err(Error::new(
                key,
                found,
                "must have triangles that span an area",
            ))
        }
    }
}

/// A picture on a light, and how bright it is.
#[derive(Clone)]
pub(super) struct KeptPicture {
    pub file: Stamp,
    pub brightest: f64,
    /// The picture's texture, as the only element.
    pub texture: Arc<Vec<Texture>>,
}

/// Use of a grating's picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GroovePictureKind {
    /// Shares, in all channels.
    Mask,
    /// Directions, in red and green.
    Directions,
}

/// A picture of a grating.
#[derive(Clone)]
pub(super) struct KeptGroovePicture {
    pub file: Stamp,
    pub kind: GroovePictureKind,
    /// The picture's texture, as the only element.
    pub texture: Arc<Vec<Texture>>,
}

/// The textures of several surfaces, of gratings, then those of lights, one after the other.
#[derive(Clone, Default)]
pub(super) struct Textures {
    parts: Vec<Arc<Vec<Texture>>>,
    pub together: Arc<Vec<Texture>>,
}

/// A layer's scratches with all that they depend on.
pub(super) struct KeptLayer {
    pub layer: Layer,
    pub profile: Section,
    pub strokes: Vec<Stroke>,
    pub place: LayerPlaces,
    pub number: u64,
    pub ground: Arc<Ground>,
    /// The files that it was read from.
    pub files: Vec<Stamp>,
    pub laid: Laid,
}

/// The scratches of all layers of an object.
#[derive(Clone)]
pub(super) struct ObjectScratches {
    /// The layers with their places in the scene file.
    layers: Vec<(u32, Arc<KeptLayer>)>,
    pub scratches: Arc<Vec<Scratch>>,
    pub segments: Arc<Vec<Segment>>,
}

impl BuildCache {
    pub(super) fn surface(&self, key: &SurfaceKey) -> Option<Arc<KeptSurface>> {
        let alike = |kept: &&Arc<KeptSurface>| {
            kept.key == *key && kept.others.iter().all(Stamp::is_current)
        };
        self.surfaces.iter().find(alike).cloned()
    }

    pub(super) fn map(&self, key: &MapKey) -> Option<Environment> {
        let (_, map) = self.map.as_ref().filter(|(kept, _)| kept == key)?;
        Some(map.clone())
    }

    pub(super) fn picture(&self, file: &Stamp) -> Option<KeptPicture> {
        self.pictures
            .iter()
            .find(|kept| kept.file == *file)
            .cloned()
    }

    pub(super) fn groove_picture(
        &self,
        file: &Stamp,
        kind: GroovePictureKind,
    ) -> Option<KeptGroovePicture> {
        self.groove_pictures
            .iter()
            .find(|kept| kept.file == *file && kept.kind == kind)
            .cloned()
    }

    pub(super) fn grey_map(&self, file: &Stamp) -> Option<Arc<GreyMap>> {
        let (_, map) = self.grey_maps.iter().find(|(kept, _)| kept == file)?;
        Some(map.clone())
    }

    pub(super) fn lamp(&self, kind: &LightKind, material: u32) -> Option<Arc<Mesh>> {
        let mut lamps = self.lamps.iter();
        let (_, _, mesh) = lamps.find(|lamp| (&lamp.0, lamp.1) == (kind, material))?;
        Some(mesh.clone())
    }

    pub(super) fn textures(&self, parts: Vec<Arc<Vec<Texture>>>) -> Textures {
        let kept = &self.textures;
        if same(&kept.parts, &parts, Arc::ptr_eq) {
            return kept.clone();
        }
        let together = match parts.as_slice() {
            [only] => only.clone(),
            parts => Arc::new(parts.iter().flat_map(|part| part.iter().cloned()).collect()),
        };
        Textures { parts, together }
    }

    pub(super) fn layer(
        &self,
        table: &description::Scratches,
        number: u64,
        ground: &Arc<Ground>,
        files: &[Stamp],
    ) -> Option<Arc<KeptLayer>> {
        let alike = |kept: &&Arc<KeptLayer>| {
            Arc::ptr_eq(&kept.ground, ground)
                && kept.number == number
                && kept.layer == table.layer
                && kept.profile == table.profile
                && kept.strokes == table.strokes
                && kept.place == table.place
                && kept.files == files
        };
        self.layers.iter().find(alike).cloned()
    }

    /// The scratches of all layers of one object, each with its place in the scene file.
    pub(super) fn together(
        &self,
        layers: Vec<(u32, Arc<KeptLayer>)>,
    ) -> Result<ObjectScratches, Error> {
        let alike = |kept: &&ObjectScratches| {
            same(&kept.layers, &layers, |a, b| {
                a.0 == b.0 && Arc::ptr_eq(&a.1, &b.1)
            })
        };
        if let Some(kept) = self.objects.iter().find(alike) {
            return Ok(kept.clone());
        }
        let laid = scratches::put_together(layers.iter().map(|(i, kept)| (*i, &kept.laid)))?;
        Ok(ObjectScratches {
            layers,
            scratches: Arc::new(laid.scratches),
            segments: Arc::new(laid.segments),
        })
    }
}

fn same<T>(a: &[T], b: &[T], equal: impl Fn(&T, &T) -> bool) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| equal(a, b))
}
