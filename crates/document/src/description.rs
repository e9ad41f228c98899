//! A scene as its author writes it: one type for each table of the scene file, units in the names, defaults filled in.
//!
//! A [`Description`] comes from TOML ([`Description::from_toml`]) or from an editor, is turned into a
//! [`Scene`](hairline_scene::Scene) by [`build`](crate::build()), and is saved by [`Description::to_toml`]; what was
//! saved loads again to an equal description. Reading is done by hand (`read`), not by serde, so that every mistake has
//! its line and a hint; ranges are checked in `check`, so that they hold for descriptions that come from no file. What a key is when a file
//! leaves it out is said in [`schema`](crate::schema) alone.

mod camera;
mod check;
mod distribution;
mod engraved;
mod files;
mod gratings;
pub(crate) mod hint;
mod json;
mod keyed;
mod lens;
mod light_kind;
mod lights;
mod looks;
mod overrides;
mod parse;
mod place;
mod ranges;
mod read;
pub(crate) mod references;
mod scratches;
mod shapes;
mod studio;
mod table;
pub(crate) mod values;

use std::path::{Path, PathBuf};

use hairline_image::ToneMap;
use hairline_model::mesh_file::Placing;
use hairline_optics::metal::Metal;
use serde::Serialize;

use hairline_scene::{Anisotropy, Coat, Specular};
use hairline_sky::BuiltInMap;
use values::{Named, is_default, serialize_named, serialize_scale};

pub use camera::Camera;
pub use check::STROKE_POINTS;
pub use distribution::Distribution;
pub use engraved::{Engraved, Line};
pub use files::FileUse;
pub use gratings::{Grating, GratingTheory, GroovePattern, UvAxis};
pub use light_kind::LightKind;
pub use lights::{Cone, Light};
pub use looks::Look;
pub use overrides::Override;
pub use place::LayerPlaces;
pub use ranges::LARGEST_SEED;
pub use scratches::{
    Amount, Around, Brush, Brushed, Laid, Layer, Listed, Pattern, Scratches, Standing, Stroke,
    standings,
};
pub use shapes::Shape;
pub use studio::{Ground, Studio};
pub use values::{metal_names, profile_names};

/// A whole scene file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// `[camera]`: required.
    pub camera: Camera,
    /// `[render]`: may be left out.
    pub render: Render,
    /// `[environment]`: may be left out; then there is no light but the `lights` and the studio, and without a studio the background is black.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// `[studio]`: may be left out; then there is one where a scene file has neither lights nor an environment.
    #[serde(skip_serializing_if = "Studio::is_none")]
    pub studio: Studio,
    /// `[ground]`: may be left out; then there is one where a scene file has a studio without asking for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<Ground>,
    /// `[[material]]`.
    #[serde(rename = "material", skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<Material>,
    /// `[[object]]`: at least one.
    #[serde(rename = "object", skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<Object>,
    /// `[[scratches]]`: each a layer of scratches on one object; an object may have many.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scratches: Vec<Scratches>,
    /// `[[grating]]`: each a row of grooves on one object; an object may have many.
    #[serde(rename = "grating", skip_serializing_if = "Vec::is_empty")]
    pub gratings: Vec<Grating>,
    /// `[[light]]`.
    #[serde(rename = "light", skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<Light>,
    /// `[[look]]`: other cameras, exposures and lights of the same objects.
    #[serde(rename = "look", skip_serializing_if = "Vec::is_empty")]
    pub looks: Vec<Look>,
    /// The model whose own lights the `lights` were made of, as its object names it. Not part of the file.
    #[serde(skip)]
    pub lights_of: Option<PathBuf>,
    /// Notes on the file for its author, a line each; they are no part of the file.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// `[render]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Render {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Standard deviation of the pixel's Gaussian filter.
    pub filter_std_px: f64,
    /// `"neutral"` (default), `"agx"`, `"aces"` or `"none"`.
    #[serde(serialize_with = "serialize_named")]
    pub tone_map: ToneMap,
    /// Whether pictures have an alpha.
    #[serde(skip_serializing_if = "is_default")]
    pub transparent: bool,
    /// A picture behind the objects.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub behind: Option<PathBuf>,
    /// Bits of each channel of a PNG: 8 or 16.
    #[serde(skip_serializing_if = "is_plain_depth")]
    pub png_bits: u32,
}

fn is_plain_depth(png_bits: &u32) -> bool {
    *png_bits == crate::schema::render::PNG_BITS.initial::<u32>()
}

impl Description {
    /// Whether nothing but objects and shadows is seen in pictures, so that they have an alpha.
    pub fn cuts_out(&self) -> bool {
        let ground = self.ground.as_ref();
        self.render.transparent
            || self.render.behind.is_some()
            || ground.is_some_and(|ground| ground.shadows_only && !ground.hidden)
    }
}

/// `[environment]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Environment {
    /// The map. Required.
    #[serde(flatten)]
    pub map: Map,
    /// Turns the picture about the world's up axis.
    pub rotation_deg: f64,
    /// Factor on its radiance.
    pub intensity: f64,
    /// Whether the camera sees it behind the objects.
    pub visible: bool,
}

/// The map of an `[environment]`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Map {
    /// `file`: an equirectangular `.hdr` or `.exr`, relative to the scene file.
    #[serde(rename = "file")]
    File(PathBuf),
    /// `builtin`: one in the box, `"studio"`, `"window"` or `"overcast"`.
    #[serde(rename = "builtin")]
    BuiltIn(BuiltInMap),
}

impl Map {
    /// The map's file, if it has one, as the scene names it.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File(file) => Some(file),
            Self::BuiltIn(_) => None,
        }
    }
}

/// `[[material]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Material {
    /// Name of the material, to which objects refer; no two are equal. Required.
    pub name: String,
    /// `kind` and the keys that belong to it.
    #[serde(flatten)]
    pub kind: MaterialKind,
    /// Perceptual roughness, as in glTF: GGX's alpha is its square. In [0, 1].
    pub roughness: f64,
    /// Standard deviation of the Gaussian coherence window. From 1 to 1000.
    pub coherence_um: f64,
    /// `clearcoat` and `clearcoat_roughness`: a clear layer over it, in which its scratches lie.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub coat: Option<Coat>,
    /// `anisotropy` and `anisotropy_direction_deg`: highlights that are drawn out one way, as on brushed metal.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub anisotropy: Option<Anisotropy>,
    /// A clear plate over a measured metal, as discs have it over their tracks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cover: Option<Cover>,
}

/// `cover` of a `[[material]]`: a clear plate with parallel faces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cover {
    /// Refractive index, from 1 to 4.
    pub ior: f64,
    /// How thick it is, from 0 to 100.
    pub thickness_mm: f64,
    /// The light that a millimetre lets through, linear Rec.709, in [0, 1].
    pub color: [f64; 3],
}

/// `kind` of a `[[material]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum MaterialKind {
    /// `"metal"`, with `metal`, `base_color` or `n_k`.
    Metal(MetalColor),
    /// `"dielectric"`: a clear coat over a diffuse body.
    Dielectric {
        /// Refractive index, from 1 to 4.
        ior: f64,
        /// Albedo of the body, linear Rec.709, in [0, 1].
        base_color: [f64; 3],
    },
    /// `"metallic-roughness"`: the model of glTF 2.0.
    MetallicRoughness {
        /// Linear Rec.709, in [0, 1].
        base_color: [f64; 3],
        /// Share of metal from 0, dielectric, to 1, metal.
        metallic: f64,
        /// `specular` and `specular_color`: factors on the reflection of its part that is no metal.
        #[serde(flatten)]
        specular: Specular,
    },
    /// `"mirror"`: reflectance 1 at every wavelength.
    Mirror,
}

/// Colour of a metal.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum MetalColor {
    /// `metal`: measured n and k of `"iron"`, `"steel"` (stainless), `"aluminium"`, `"copper"`, `"gold"`, `"silver"`,
    /// `"brass"`, `"chromium"`, `"titanium"` or `"nickel"`.
    #[serde(rename = "metal", serialize_with = "serialize_named")]
    Measured(Metal),
    /// `base_color`: reflectance at normal incidence, linear Rec.709, in [0, 1].
    #[serde(rename = "base_color")]
    Color([f64; 3]),
    /// `n_k`: rows of a wavelength in nm, n and k.
    #[serde(rename = "n_k")]
    Own(Vec<[f64; 3]>),
}

/// `[[object]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Object {
    /// Name of the object, to which layers of scratches and gratings refer; no two are equal. Required.
    pub name: String,
    /// `shape` or `mesh`.
    #[serde(flatten)]
    pub surface: Surface,
    /// The axis of a mesh's file that points up; it is turned to the axis of the world nearest to the camera's up. Shapes have no
    /// such key, and stand on z.
    #[serde(skip_serializing_if = "is_default", serialize_with = "serialize_named")]
    pub up: Up,
    /// The largest extent of a mesh along its axes before `scale`; it is scaled to that. Shapes have no such key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit_m: Option<f64>,
    /// The time of an animation of a mesh, in seconds. Shapes have no such key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// With `time_s`: the name of the animation, or its number from 0. Shapes have no such key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub animation: Option<String>,
    /// Name of a material. Required for a shape; a mesh that leaves it out keeps the materials of its file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Factors that replace those of materials of its file, whose maps stay. Shapes, and meshes of a `material`, have no such key.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub overrides: Vec<Override>,
    /// Moves the object, after it was scaled and rotated.
    pub translation_m: [f64; 3],
    /// Turns the object about the world's x axis, then y, then z.
    pub rotation_deg: [f64; 3],
    /// Factors along the object's own axes, or one number for all. None may be 0; negative ones mirror.
    #[serde(serialize_with = "serialize_scale")]
    pub scale: [f64; 3],
    /// Whether the scene is as if the object were not there, nor what lies on it.
    #[serde(skip_serializing_if = "is_default")]
    pub hidden: bool,
}

/// `up` of an object with a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Up {
    /// `"y"`
    #[default]
    Y,
    /// `"z"`
    Z,
}

impl Object {
    /// Placing of the file that the object's triangles come from, by its keys.
    pub(crate) fn placing(&self, world_up: glam::DVec3) -> Placing {
        Placing {
            up: self.up.axis(),
            world_up,
            fit_m: self.fit_m,
            time_s: self.time_s,
            animation: self.animation.clone(),
            stands_alone: self.fit_m.is_some(),
        }
    }
}

impl Up {
    /// The axis in the file's frame.
    fn axis(self) -> glam::DVec3 {
        match self {
            Self::Y => glam::DVec3::Y,
            Self::Z => glam::DVec3::Z,
        }
    }
}

/// Source of an object's triangles.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Surface {
    /// `shape = { KIND = { .. } }`
    Shape(Shape),
    /// `mesh = "FILE"`: a `.gltf`, `.glb`, `.obj` or `.stl`, relative to the scene file.
    Mesh(PathBuf),
}

pub(crate) use hairline_model::material::DEFAULT_COHERENCE_UM;

impl Named for Up {
    const NAMES: &'static [(&'static str, Self)] = &[("y", Up::Y), ("z", Up::Z)];
}
