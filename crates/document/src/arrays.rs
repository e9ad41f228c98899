//! Meshes, scratches, pictures and drawings in memory, which a program has computed and no file holds.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec3, Vec2};
use hairline_image::FilePath;
use hairline_memory::budget_bytes;
use hairline_model::surface::{Surface, Vertex};
use hairline_scene::Profile;

use crate::description::Scratches;
use crate::error::Error;
use crate::grey_map::GreyMap;
use crate::scratches::LISTED_SIZES;

/// Meshes, lists of scratches and pictures of places by the names that a description has in the place of their files. A name must stand for the same
/// numbers always: what was built from them is known by it.
#[derive(Clone, Debug, Default)]
pub struct Arrays {
    meshes: HashMap<PathBuf, Arc<MeshArrays>>,
    scratches: HashMap<PathBuf, Arc<ScratchArrays>>,
    pictures: HashMap<PathBuf, Arc<GreyMap>>,
    drawings: HashMap<PathBuf, Arc<[u8]>>,
}

impl Arrays {
    /// Empty arrays.
    pub(crate) fn none() -> &'static Self {
        static NONE: std::sync::LazyLock<Arrays> = std::sync::LazyLock::new(Arrays::default);
        &NONE
    }

    /// Puts a mesh in the place of a file.
    pub fn insert_mesh(&mut self, name: impl Into<PathBuf>, mesh: Arc<MeshArrays>) {
        self.meshes.insert(name.into(), mesh);
    }

    /// Puts scratches in the place of a file.
    pub fn insert_scratches(&mut self, name: impl Into<PathBuf>, scratches: Arc<ScratchArrays>) {
        self.scratches.insert(name.into(), scratches);
    }

    /// Puts an SVG file in the place of one on disk.
    pub fn insert_drawing(&mut self, name: impl Into<PathBuf>, svg: &[u8]) {
        self.drawings.insert(name.into(), svg.into());
    }

    /// Puts a picture of a layer's places in the place of a file, for [`lay_on_mesh`](crate::lay_on_mesh): `rgba` is four bytes a texel, row by row from
    /// the top.
    ///
    /// # Errors
    /// Bytes that are no whole rows.
    pub fn insert_picture(
        &mut self,
        name: impl Into<PathBuf>,
        width_px: u32,
        rgba: &[u8],
    ) -> Result<(), Error> {
        let map = GreyMap::new(width_px, rgba.as_chunks::<4>().0).ok_or_else(|| {
            let found = format!("found {} bytes in rows of {width_px} texels", rgba.len());
            Error::new("", found, "must be whole rows of four bytes a texel")
        })?;
        self.pictures.insert(name.into(), Arc::new(map));
        Ok(())
    }

    /// Puts the pictures that layers name in the place of their files, which are looked for in `base_dir`.
    ///
    /// # Errors
    /// What is no picture, by its key.
    pub fn read_pictures(
        &mut self,
        layers: &[Scratches],
        base_dir: impl Into<FilePath>,
    ) -> Result<(), Error> {
        let base_dir = base_dir.into();
        for (i, layer) in layers.iter().enumerate() {
            let place = &layer.place;
            for (name, file) in [("mask", &place.mask), ("density", &place.density)] {
                let Some(file) = file else {
                    continue;
                };
                let read = GreyMap::read(&base_dir.join(file), budget_bytes() as f64);
                let picture = read.map_err(|found| {
                    let right = "must be a .png, .jpg or .webp";
                    Error::new(format!("scratches[{i}].where.{name}"), found, right)
                })?;
                self.pictures.insert(file.clone(), Arc::new(picture));
            }
        }
        Ok(())
    }

    /// Whether a name stands for something in memory.
    pub fn has(&self, name: &Path) -> bool {
        self.meshes.contains_key(name) || self.scratches.contains_key(name)
    }

    pub(crate) fn mesh(&self, name: &Path) -> Option<&Arc<MeshArrays>> {
        self.meshes.get(name)
    }

    pub(crate) fn picture(&self, name: &Path) -> Option<&Arc<GreyMap>> {
        self.pictures.get(name)
    }

    pub(crate) fn drawing(&self, name: &Path) -> Option<&[u8]> {
        self.drawings.get(name).map(|svg| &**svg)
    }

    pub(crate) fn scratches(&self, name: &Path) -> Option<&Arc<ScratchArrays>> {
        self.scratches.get(name)
    }
}

/// Triangles in the object's own frame.
#[derive(Clone, Debug)]
pub struct MeshArrays {
    vertices_m: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Option<Vec<[f64; 3]>>,
    uvs: Option<Vec<[f64; 2]>>,
}

impl MeshArrays {
    /// `triangles` are indices of vertices, counter-clockwise seen from outside. Without `normals`, one a vertex, triangles are flat.
    ///
    /// # Errors
    /// The first array that does not fit the others or holds a number that is none, by its key.
    pub fn new(
        vertices_m: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
        normals: Option<Vec<[f64; 3]>>,
        uvs: Option<Vec<[f64; 2]>>,
    ) -> Result<Self, Error> {
        let count = vertices_m.len();
        finite("vertices_m", &vertices_m)?;
        for (key, length) in [
            ("normals", normals.as_ref().map(Vec::len)),
            ("uvs", uvs.as_ref().map(Vec::len)),
        ] {
            if let Some(length) = length.filter(|length| *length != count) {
                let found = format!("found {length} rows for {count} vertices");
                return Err(Error::new(key, found, "must have a row for each vertex"));
            }
        }
        normals.iter().try_for_each(|it| finite("normals", it))?;
        uvs.iter().try_for_each(|it| finite("uvs", it))?;
        for (i, triangle) in triangles.iter().enumerate() {
            if let Some(index) = triangle.iter().find(|index| **index as usize >= count) {
                return Err(Error::new(
                    format!("triangles[{i}]"),
                    format!("found vertex {index} of {count}"),
                    "must be below the number of vertices",
                ));
            }
        }
        if triangles.is_empty() {
            return Err(Error::new("triangles", "found none", "must have a surface"));
        }
        Ok(Self {
            vertices_m,
            triangles,
            normals,
            uvs,
        })
    }

    /// Positions, metres.
    pub fn vertices_m(&self) -> &[[f64; 3]] {
        &self.vertices_m
    }

    /// Indices of vertices.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Normals, one for each vertex, if there are any.
    pub fn normals(&self) -> Option<&[[f64; 3]]> {
        self.normals.as_deref()
    }

    /// Texture coordinates, one pair for each vertex, if there are any.
    pub fn uvs(&self) -> Option<&[[f64; 2]]> {
        self.uvs.as_deref()
    }

    pub(crate) fn surface(&self) -> Surface {
        let row = |rows: &Option<Vec<[f64; 3]>>, i: usize| {
            rows.as_ref().map_or(DVec3::ZERO, |rows| rows[i].into())
        };
        let vertices = self.vertices_m.iter().enumerate().map(|(i, &at)| Vertex {
            position_m: at.into(),
            normal: row(&self.normals, i).normalize_or_zero(),
            uv: self.uvs.as_ref().map_or(Vec2::ZERO, |uvs| {
                Vec2::new(uvs[i][0] as f32, uvs[i][1] as f32)
            }),
            ..Vertex::default()
        });
        let mut surface = Surface {
            vertices: vertices.collect(),
            triangles: self.triangles.clone(),
        };
        match self.normals {
            Some(_) => {
                surface.turn_to_normals();
            }
            None => surface.make_flat_normals(),
        }
        surface
    }
}

const SIZE_COUNT: usize = LISTED_SIZES.len();

/// Straight scratches in the object's own frame, or the straight pieces of bent ones.
#[derive(Clone, Debug)]
pub struct ScratchArrays {
    ends_m: Vec<[[f64; 3]; 2]>,
    profiles: Vec<Profile>,
    /// The first piece of each scratch, and the number of pieces.
    first: Vec<u32>,
}

impl ScratchArrays {
    /// Keys of the columns of sizes that [`ScratchArrays::new`] takes beside the ends, in this order.
    pub const SIZES: [&str; SIZE_COUNT] = {
        let mut keys = [""; SIZE_COUNT];
        let mut i = 0;
        while i < SIZE_COUNT {
            keys[i] = LISTED_SIZES[i].key;
            i += 1;
        }
        keys
    };

    /// `sizes` are those of [`Self::SIZES`]; each has one number for each scratch, or one for all.
    ///
    /// # Errors
    /// The first array that does not fit the others or holds a number out of range, by its key.
    pub fn new(ends_m: Vec<[[f64; 3]; 2]>, sizes: [&[f64]; SIZE_COUNT]) -> Result<Self, Error> {
        let count = ends_m.len();
        for (i, ends) in ends_m.iter().enumerate() {
            finite("", ends).map_err(|error| {
                let key = format!("ends_m[{i}]{}", error.key());
                Error::new(key, error.found(), error.right())
            })?;
            if ends[0] == ends[1] {
                let found = "found both ends at one point";
                return Err(Error::new(
                    format!("ends_m[{i}]"),
                    found,
                    "must be two points",
                ));
            }
        }
        let mut profiles = vec![Profile::default(); count];
        for (size, values) in LISTED_SIZES.iter().zip(sizes) {
            if values.len() != count && values.len() != 1 {
                return Err(Error::new(
                    size.key,
                    format!("found {} numbers for {count} scratches", values.len()),
                    "must be one for each, or one for all",
                ));
            }
            for (i, value) in values.iter().enumerate() {
                let key = || match values.len() {
                    1 => size.key.to_owned(),
                    _ => format!("{}[{i}]", size.key),
                };
                size.check(key, *value)?;
            }
            for (profile, value) in profiles.iter_mut().zip(values.iter().cycle()) {
                *(size.of)(profile) = *value as f32;
            }
        }
        Ok(Self {
            ends_m,
            profiles,
            first: (0..=count as u32).collect(),
        })
    }

    /// Makes one scratch of straight pieces side by side that have the same number. Each begins where the one before it ends, and has its sizes.
    ///
    /// # Errors
    /// Too few or too many numbers, or a piece that does not go on, by its key.
    pub fn with_scratches(mut self, numbers: &[u32]) -> Result<Self, Error> {
        let count = self.ends_m.len();
        if numbers.len() != count {
            let found = format!("found {} numbers for {count} pieces", numbers.len());
            return Err(Error::new("scratches", found, "must be one for each"));
        }
        let goes_on = |i: usize| i > 0 && numbers[i] == numbers[i - 1];
        let is_off = |i: usize| {
            let is_elsewhere = self.ends_m[i][0] != self.ends_m[i - 1][1];
            is_elsewhere || self.profiles[i] != self.profiles[i - 1]
        };
        if let Some(i) = (0..count).find(|i| goes_on(*i) && is_off(*i)) {
            let found = format!(
                "found a piece off the one before it, of the same scratch {}",
                numbers[i]
            );
            let right = "must begin at its end, and be as wide and as deep";
            return Err(Error::new(format!("ends_m[{i}]"), found, right));
        }
        let first = (0..count).filter(|i| !goes_on(*i)).chain([count]);
        self.first = first.map(|i| i as u32).collect();
        Ok(self)
    }

    /// The first piece of each scratch, and the number of pieces.
    pub(crate) fn first(&self) -> &[u32] {
        &self.first
    }

    /// Values of one size for each scratch; `place` is its index in [`Self::SIZES`].
    pub fn size(&self, place: usize) -> impl Iterator<Item = f32> {
        let of = LISTED_SIZES[place].of;
        self.profiles
            .iter()
            .map(move |profile| *of(&mut profile.clone()))
    }

    /// Both ends of each scratch, metres.
    pub fn ends_m(&self) -> &[[[f64; 3]; 2]] {
        &self.ends_m
    }

    /// The groove of each.
    pub(crate) fn profiles(&self) -> &[Profile] {
        &self.profiles
    }
}

fn finite<const N: usize>(key: &str, rows: &[[f64; N]]) -> Result<(), Error> {
    for (i, row) in rows.iter().enumerate() {
        if let Some(c) = row.iter().position(|value| !value.is_finite()) {
            let found = format!("found {}", row[c]);
            return Err(Error::new(
                format!("{key}[{i}][{c}]"),
                found,
                "must be finite",
            ));
        }
    }
    Ok(())
}
