//! A scene as its author writes it: one type for each table of the scene file, units in the names, defaults filled in.
//!
//! A [`Description`] comes from TOML ([`Description::from_toml`]) or from an editor, is turned into a
//! [`Scene`](crate::Scene) by [`Scene::build`](crate::Scene::build), and is saved by [`Description::to_toml`]; what was
//! saved loads again to an equal description. Reading is done by hand (`read`), not by serde, so that every mistake has
//! its line and a hint; ranges are checked in `check`, so that they hold for descriptions that come from no file.

mod check;
pub(crate) mod hint;
pub mod limits;
pub(crate) mod locate;
mod read;
pub(crate) mod references;
mod scratches;
mod table;

use std::path::{Path, PathBuf};

use hairline_image::ToneMap;
use hairline_optics::ggx::GGX_MIN_ALPHA;
use hairline_optics::metal::Metal;
use serde::{Serialize, Serializer};

use crate::environment::BuiltInMap;
use crate::error::Error;
use crate::text::printable;

pub use scratches::{
    Amount, Around, Brush, Brushed, DEFAULT_DEPTH_NM, DEFAULT_LENGTH_M, DEFAULT_SEED,
    DEFAULT_WIDTH_UM, Distribution, Laid, Layer, Listed, Pattern, Scratches, Stroke,
};

/// A whole scene file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// `[camera]`: required.
    pub camera: Camera,
    /// `[render]`: may be left out.
    pub render: Render,
    /// `[environment]`: may be left out; then there is no light but the `lights`, and the background is black.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// `[[material]]`.
    #[serde(rename = "material", skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<Material>,
    /// `[[object]]`: at least one.
    #[serde(rename = "object", skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<Object>,
    /// `[[scratches]]`: each a layer of scratches on one object; an object may have many.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scratches: Vec<Scratches>,
    /// `[[light]]`.
    #[serde(rename = "light", skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<Light>,
    /// What the author should know about the file, a line each. Not part of it.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// `[camera]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Camera {
    /// The pinhole. Required.
    pub position_m: [f64; 3],
    /// The point in the centre of the picture. Required.
    pub target_m: [f64; 3],
    /// The direction that is up in the picture. Default: `[0, 1, 0]`, as in glTF.
    pub up: [f64; 3],
    /// Vertical field of view, above 0 and below 180. Default: 30.
    pub fov_y_deg: f64,
    /// Radiances are multiplied by 2^exposure_ev before the tone map. Default: 0.
    pub exposure_ev: f64,
}

/// `[render]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Render {
    /// Width and height. Default: `[1280, 720]`.
    pub size_px: [u32; 2],
    /// Standard deviation of the pixel's Gaussian filter. Default: 0.5.
    pub filter_std_px: f64,
    /// `"neutral"` (default), `"agx"`, `"aces"` or `"none"`.
    #[serde(serialize_with = "serialize_named")]
    pub tone_map: ToneMap,
}

impl Default for Render {
    fn default() -> Self {
        Self {
            size_px: [1280, 720],
            filter_std_px: 0.5,
            tone_map: ToneMap::Neutral,
        }
    }
}

/// `[environment]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Environment {
    /// The map. Required.
    #[serde(flatten)]
    pub map: Map,
    /// Turns the picture about the world's up axis. Default: 0.
    pub rotation_deg: f64,
    /// Factor on its radiance. Default: 1.
    pub intensity: f64,
    /// Whether the camera sees it behind the objects. Default: true.
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
    /// What objects call it by; no two are equal. Required.
    pub name: String,
    /// `kind` and the keys that belong to it.
    #[serde(flatten)]
    pub kind: MaterialKind,
    /// Perceptual roughness, as in glTF: GGX's alpha is its square. In [0, 1]. Default: 0.1.
    pub roughness: f64,
    /// Standard deviation of the Gaussian coherence window. From 1 to 1000. Default: 20.
    pub coherence_um: f64,
}

/// `kind` of a `[[material]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum MaterialKind {
    /// `"metal"`, with `metal` or `base_color`.
    Metal(MetalColor),
    /// `"dielectric"`: a clear coat over a diffuse body.
    Dielectric {
        /// Refractive index, from 1 to 4. Default: 1.5.
        ior: f64,
        /// Albedo of the body, linear Rec.709, in [0, 1]. Default: `[0.5, 0.5, 0.5]`.
        base_color: [f64; 3],
    },
    /// `"metallic-roughness"`: the model of glTF 2.0.
    MetallicRoughness {
        /// Linear Rec.709, in [0, 1]. Default: `[1, 1, 1]`.
        base_color: [f64; 3],
        /// From 0, dielectric, to 1, metal. Default: 1.
        metallic: f64,
    },
    /// `"mirror"`: reflectance 1 at every wavelength.
    Mirror,
}

/// What gives a metal its colour.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum MetalColor {
    /// `metal`: measured n and k of `"iron"`, `"steel"` (stainless), `"aluminium"`, `"copper"`, `"gold"`, `"silver"`,
    /// `"brass"`, `"chromium"`, `"titanium"` or `"nickel"`.
    #[serde(rename = "metal", serialize_with = "serialize_named")]
    Measured(Metal),
    /// `base_color`: reflectance at normal incidence, linear Rec.709, in [0, 1].
    #[serde(rename = "base_color")]
    Color([f64; 3]),
}

/// `[[object]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Object {
    /// What layers of scratches call it by; no two are equal. Required.
    pub name: String,
    /// `shape` or `mesh`.
    #[serde(flatten)]
    pub surface: Surface,
    /// Which axis of a mesh's file points up; it is turned to the axis of the world nearest to the camera's up. Default: `"y"`, as
    /// glTF has it. Shapes have no such key, and stand on z.
    #[serde(skip_serializing_if = "is_default", serialize_with = "serialize_named")]
    pub up: Up,
    /// The largest extent of a mesh along its axes before `scale`; it is scaled to that. Default: as large as its file says. Shapes
    /// have no such key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit_m: Option<f64>,
    /// Name of a material. Required for a shape; a mesh that leaves it out keeps the materials of its file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Moves the object, after it was scaled and rotated. Default: `[0, 0, 0]`.
    pub translation_m: [f64; 3],
    /// Turns the object about the world's x axis, then y, then z. Default: `[0, 0, 0]`.
    pub rotation_deg: [f64; 3],
    /// Factors along the object's own axes, or one number for all. None may be 0; negative ones mirror. Default: 1.
    #[serde(serialize_with = "serialize_scale")]
    pub scale: [f64; 3],
}

/// `up` of an object with a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// `"y"`
    #[default]
    Y,
    /// `"z"`
    Z,
}

impl Up {
    /// The axis in the file's frame.
    pub(crate) fn axis(self) -> glam::DVec3 {
        match self {
            Self::Y => glam::DVec3::Y,
            Self::Z => glam::DVec3::Z,
        }
    }
}

/// Where an object's triangles come from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Surface {
    /// `shape = { KIND = { .. } }`
    Shape(Shape),
    /// `mesh = "FILE"`: a `.gltf` or `.glb`, relative to the scene file.
    Mesh(PathBuf),
}

/// A built-in shape about the origin, z up.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// A rectangle in the xy plane that faces +z.
    Plane {
        /// Edge lengths along x and y. Required.
        size_m: [f64; 2],
    },
    /// A disk in the xy plane that faces +z.
    Disk {
        /// Required.
        radius_m: f64,
    },
    /// A sphere.
    Sphere {
        /// Required.
        radius_m: f64,
    },
    /// A profile turned about the z axis.
    Lathe {
        /// Points `[r, z]`, at least two, r not negative. The surface faces to the left of the way along the profile, r
        /// to the right and z up: a plate's upper side runs from the axis outwards, a cup's outside runs downwards.
        /// A profile that ends where it starts is closed, as for a ring. Required.
        profile_m: Vec<[f64; 2]>,
        /// Facets around, from 3 to 4096. Default: 256.
        segments: u32,
        /// Whether the profile is rounded where it bends by less than 40 degrees; sharper corners stay. Default: true.
        smooth: bool,
    },
}

/// `[[light]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Light {
    /// Free text, for lists that people read. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Lights nothing, as if it were not there. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// `kind` and the keys that belong to it.
    #[serde(flatten)]
    pub kind: LightKind,
    /// W sr^-1 m^-2 in effect; not negative. Default: 1.
    pub radiance: f64,
    /// Factor on the radiance, linear Rec.709, not negative; `[1, 1, 1]` has the spectrum of D65. Default: `[1, 1, 1]`.
    pub color: [f64; 3],
}

/// `kind` of a `[[light]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum LightKind {
    /// `"sphere"`
    Sphere {
        /// Required.
        center_m: [f64; 3],
        /// Required.
        radius_m: f64,
    },
    /// `"polygon"`: planar, simple, convex or not; shines to the side that sees its vertices counter-clockwise.
    Polygon {
        /// At least three. Required.
        vertices_m: Vec<[f64; 3]>,
        /// Whether the other side shines too. Default: false.
        two_sided: bool,
    },
}

impl Light {
    /// A white light of radiance 1, without a name, not hidden.
    pub fn new(kind: LightKind) -> Self {
        Self {
            name: None,
            hidden: false,
            kind,
            radiance: 1.0,
            color: [1.0; 3],
        }
    }
}

/// sigma of materials that do not say it, those of glTF files among them.
pub(crate) const DEFAULT_COHERENCE_UM: f64 = 20.0;

impl Description {
    /// Reads a scene file's text. `name` is what errors call the file.
    ///
    /// Only the form is checked here: keys, types, units. Ranges and references are checked by
    /// [`Scene::build`](crate::Scene::build).
    pub fn from_toml(text: &str, name: &Path) -> Result<Self, Error> {
        crate::memory::check_text(text.len()).map_err(|error| error.at(name, None))?;
        let root = locate::parse(text, name)?;
        let description = read::description(&root);
        let mut description = description.map_err(|error| error.in_scene_file(text, name))?;
        let without_effect = read::keys_without_effect(&root);
        let notes = without_effect.map(|(key, why)| note(text, name, key, why));
        description.notes = notes
            .chain(description.smoother_than_can_be(text, name))
            .collect();
        Ok(description)
    }

    /// The scene file that loads to this description: a `[table]` or `[[table]]` for each part, and one line for each key.
    ///
    /// # Errors
    /// Numbers above 2^63 - 1, which TOML does not have.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let mut text = String::new();
        for (name, value) in toml::Table::try_from(self)? {
            let (header, parts) = match value {
                toml::Value::Array(parts) => (format!("[[{name}]]"), parts),
                part => (format!("[{name}]"), vec![part]),
            };
            for part in parts {
                text += &format!("{header}\n");
                for (key, value) in part.as_table().into_iter().flatten() {
                    text += &format!("{key} = {value}\n");
                }
                text.push('\n');
            }
        }
        Ok(text)
    }
}

impl Description {
    /// Notes about materials that look rougher than they say.
    fn smoother_than_can_be(&self, text: &str, name: &Path) -> Vec<String> {
        let least = GGX_MIN_ALPHA.sqrt();
        let is_smoother = |(_, material): &(usize, &Material)| {
            (0.0..least).contains(&material.roughness) && material.kind != MaterialKind::Mirror
        };
        let materials = self.materials.iter().enumerate().filter(is_smoother);
        // One is enough to be warned, and a scene may have thousands.
        let first = materials.take(1).map(|(i, material)| {
            let key = format!("material[{i}].roughness");
            let why = format!(
                "{} looks as {least:.3} does, which is the smoothest; only `kind = \"mirror\"` is smoother",
                material.roughness
            );
            note(text, name, &key, &why)
        });
        first.collect()
    }
}

/// A note about a key of the file: `file:line: key: why`, as errors are written.
fn note(text: &str, name: &Path, key: &str, why: &str) -> String {
    let line = locate::line_of_key(text, key).map_or_else(String::new, |line| format!(":{line}"));
    format!("{}{line}: {key}: {why}", printable(&name.to_string_lossy()))
}

/// Values that a scene file calls by name.
trait Named: Copy + PartialEq + 'static {
    const NAMES: &'static [(&'static str, Self)];
}

impl Named for ToneMap {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("neutral", ToneMap::Neutral),
        ("agx", ToneMap::Agx),
        ("aces", ToneMap::Aces),
        ("none", ToneMap::None),
    ];
}

impl Named for Metal {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("iron", Metal::Iron),
        ("steel", Metal::StainlessSteel),
        ("aluminium", Metal::Aluminium),
        ("copper", Metal::Copper),
        ("gold", Metal::Gold),
        ("silver", Metal::Silver),
        ("brass", Metal::Brass),
        ("chromium", Metal::Chromium),
        ("titanium", Metal::Titanium),
        ("nickel", Metal::Nickel),
    ];
}

impl Named for BuiltInMap {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("studio", BuiltInMap::Studio),
        ("window", BuiltInMap::Window),
        ("overcast", BuiltInMap::Overcast),
    ];
}

impl Named for Up {
    const NAMES: &'static [(&'static str, Self)] = &[("y", Up::Y), ("z", Up::Z)];
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn is_false(value: &bool) -> bool {
    !value
}

fn serialize_named<T: Named, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    let (name, _) = T::NAMES
        .iter()
        .find(|(_, named)| named == value)
        .ok_or_else(|| serde::ser::Error::custom("a value that scene files have no name for"))?;
    serializer.serialize_str(name)
}

fn serialize_scale<S: Serializer>(scale: &[f64; 3], serializer: S) -> Result<S::Ok, S::Error> {
    if scale[0] == scale[1] && scale[1] == scale[2] {
        scale[0].serialize(serializer)
    } else {
        scale.serialize(serializer)
    }
}
