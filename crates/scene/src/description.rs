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
mod table;

use std::path::{Path, PathBuf};

use hairline_image::ToneMap;
use hairline_optics::metal::Metal;
use serde::{Serialize, Serializer};

use crate::error::Error;

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
    /// An equirectangular `.hdr` or `.exr`, relative to the scene file. Required.
    pub file: PathBuf,
    /// Turns the picture about the world's up axis. Default: 0.
    pub rotation_deg: f64,
    /// Factor on its radiance. Default: 1.
    pub intensity: f64,
    /// Whether the camera sees it behind the objects. Default: true.
    pub visible: bool,
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

/// `[[scratches]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scratches {
    /// The name of the object they lie on. Required.
    pub object: String,
    /// Free text, for lists that people read. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Laid nowhere. Other layers' scratches stay as they are. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// Where any layer of the scene is solo, only solo ones that are not hidden are laid. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub solo: bool,
    /// How they are laid.
    #[serde(flatten)]
    pub layer: Layer,
    /// What a brush did, in this order; the pattern's own scratches come before all strokes. Default: none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub strokes: Vec<Stroke>,
}

impl Scratches {
    /// A layer with nothing but its pattern: no name, not hidden, not solo, no strokes.
    pub fn new(object: impl Into<String>, layer: Layer) -> Self {
        Self {
            object: object.into(),
            name: None,
            hidden: false,
            solo: false,
            layer,
            strokes: Vec::new(),
        }
    }
}

/// Where the scratches of a layer come from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Layer {
    /// Drawn at random along a pattern.
    Laid(Laid),
    /// `pattern = "drawn"`
    Brushed(Brushed),
    /// `pattern = "file"`
    Listed(Listed),
}

impl Layer {
    /// The seed of a layer that draws random numbers.
    pub fn seed(&self) -> Option<u64> {
        match self {
            Self::Laid(laid) => Some(laid.seed),
            Self::Brushed(brushed) => Some(brushed.seed),
            Self::Listed(_) => None,
        }
    }

    /// See [`Layer::seed`].
    pub fn seed_mut(&mut self) -> Option<&mut u64> {
        match self {
            Self::Laid(laid) => Some(&mut laid.seed),
            Self::Brushed(brushed) => Some(&mut brushed.seed),
            Self::Listed(_) => None,
        }
    }
}

/// Scratches along the strokes of a brush; [`Scratches::strokes`] holds them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename = "drawn")]
pub struct Brushed {
    /// Standard deviation of a scratch's angle to its stroke. Default: 0.
    pub jitter_deg: f64,
    /// As in [`Laid::seed`]. Default: 1.
    pub seed: u64,
    /// As in [`Laid::length_m`].
    pub length_m: Distribution,
    /// As in [`Laid::width_um`].
    pub width_um: Distribution,
    /// As in [`Laid::depth_nm`].
    pub depth_nm: Distribution,
}

impl Default for Brushed {
    fn default() -> Self {
        Self {
            jitter_deg: 0.0,
            seed: DEFAULT_SEED,
            length_m: DEFAULT_LENGTH_M,
            width_um: DEFAULT_WIDTH_UM,
            depth_nm: DEFAULT_DEPTH_NM,
        }
    }
}

/// One of the `strokes` of a `[[scratches]]`: where a brush went.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// On or near the surface, in the object's own frame, in the order of the stroke. One point is a dab. Required.
    pub points_m: Vec<[f64; 3]>,
    /// Half of the brush's width, in the world's metres, whatever the object's `scale`. Required.
    pub radius_m: f64,
    /// `density_per_m` with its factors, or `erase`.
    pub brush: Brush,
}

/// What a stroke does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Brush {
    /// Lays scratches along the stroke; in layers of pattern `"drawn"` only.
    Paint {
        /// Scratches on each metre of the stroke. A stroke has at least one, and a dab as many as a stroke of its width.
        /// Required.
        density_per_m: f64,
        /// Factor on the layer's widths. Default: 1.
        width: f64,
        /// Factor on the layer's depths. Default: 1.
        depth: f64,
    },
    /// `erase = true`: takes away what the layer laid before, as far as it comes within the radius, exactly at the brush's
    /// edge. It does not reach through a sheet: what faces away from the surface under the brush stays.
    Erase,
}

impl Serialize for Stroke {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeMap;
        let mut table = serializer.serialize_map(None)?;
        table.serialize_entry("points_m", &self.points_m)?;
        table.serialize_entry("radius_m", &self.radius_m)?;
        match self.brush {
            Brush::Paint {
                density_per_m,
                width,
                depth,
            } => {
                table.serialize_entry("density_per_m", &density_per_m)?;
                for (key, factor) in [("width", width), ("depth", depth)] {
                    if factor != 1.0 {
                        table.serialize_entry(key, &factor)?;
                    }
                }
            }
            Brush::Erase => table.serialize_entry("erase", &true)?,
        }
        table.end()
    }
}

/// Scratches read from a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename = "file")]
pub struct Listed {
    /// A CSV file with the header `x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm`, relative to the scene file. Each row is
    /// a straight scratch, in the object's own frame: metres before its `scale`, `rotation_deg` and `translation_m`. Required.
    pub file: PathBuf,
}

/// Scratches drawn at random along a pattern.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Laid {
    /// `pattern` and the keys that belong to it.
    #[serde(flatten)]
    pub pattern: Pattern,
    /// `count` or `density_per_m2`; one of them is required.
    #[serde(flatten)]
    pub amount: Amount,
    /// The same seed gives the same scratches, and a higher count keeps the first ones. Layers of different seeds do not
    /// depend on one another, nor on their order. Of layers of one object that have the same seed, hidden ones included,
    /// the second draws other numbers than the first, and so on. Default: 1.
    pub seed: u64,
    /// Log-normal, measured along the surface; draws are kept from 1e-5 to a hundred times the object's diagonal.
    /// Default: mean 0.02, spread 0.5.
    pub length_m: Distribution,
    /// Log-normal; draws are kept from 0.05 to 100. Default: mean 1.5, spread 0.3.
    pub width_um: Distribution,
    /// Log-normal; draws are kept from 0 to 2000. Default: mean 200, spread 0.2.
    pub depth_nm: Distribution,
}

/// How many scratches.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Amount {
    /// `count`
    Count(u64),
    /// `density_per_m2`: times the object's area.
    #[serde(rename = "density_per_m2")]
    DensityPerM2(f64),
}

/// `pattern` of a `[[scratches]]`. Axes, centres and directions are in the object's own frame, before its `scale`,
/// `rotation_deg` and `translation_m`, so they move with it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename_all = "lowercase")]
pub enum Pattern {
    /// `"random"`: every place and every direction alike. Daily wear: cutlery in a drawer, a phone in a pocket.
    Random {
        /// Normal. Default: mean 0, spread 0: straight.
        curvature_per_m: Distribution,
    },
    /// `"parallel"`: all along one direction. A brushed panel.
    Parallel {
        /// Default: `[1, 0, 0]`.
        direction: [f64; 3],
        /// Standard deviation of a scratch's angle to the pattern. Default: 0.
        jitter_deg: f64,
    },
    /// `"circular"`: around an axis. A turned pan, a lathe's marks, a plate wiped in circles.
    Circular(Around),
    /// `"radial"`: away from an axis. The sunburst of a watch dial.
    Radial(Around),
    /// `"spun"`: arcs of one curvature that leave the axis in all directions and sweep to the rim, all turning the same way. A
    /// cup wheel or a rotary polisher on a turning part: ground wafers, spiral-brushed watch parts.
    Spun {
        /// The axis.
        #[serde(flatten)]
        around: Around,
        /// One over the radius of the tool; normal. Default: mean 20, spread 0.
        curvature_per_m: Distribution,
    },
    /// `"swirl"`: arcs around many centres strewn over the surface. A polished or machine-washed car: the cobweb around
    /// each highlight.
    Swirl {
        /// One over the distance to the centres, which a scratch follows as closely as they allow; normal.
        /// Default: mean 25, spread 8.
        curvature_per_m: Distribution,
    },
}

/// An axis that a pattern turns about.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Around {
    /// Its direction. Default: `[0, 0, 1]`.
    pub axis: [f64; 3],
    /// A point on it. Default: `[0, 0, 0]`.
    pub center_m: [f64; 3],
    /// Standard deviation of a scratch's angle to the pattern. Default: 0.
    pub jitter_deg: f64,
}

impl Default for Around {
    fn default() -> Self {
        Self {
            axis: [0.0, 0.0, 1.0],
            center_m: [0.0; 3],
            jitter_deg: 0.0,
        }
    }
}

/// A number that is drawn anew for each scratch: `{ mean = .., spread = .. }`, or a plain number for no spread.
///
/// For a log-normal quantity `mean` is the mean itself and `spread` the standard deviation of the natural logarithm; for a
/// normal one `spread` is the standard deviation, in the unit of the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    /// The mean.
    pub mean: f64,
    /// Not negative.
    pub spread: f64,
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

/// What layers that draw random numbers start from, where they do not say it.
pub const DEFAULT_SEED: u64 = 1;
/// Lengths where a layer does not say them.
pub const DEFAULT_LENGTH_M: Distribution = Distribution {
    mean: 0.02,
    spread: 0.5,
};
/// Widths where a layer does not say them.
pub const DEFAULT_WIDTH_UM: Distribution = Distribution {
    mean: 1.5,
    spread: 0.3,
};
/// Depths where a layer does not say them.
pub const DEFAULT_DEPTH_NM: Distribution = Distribution {
    mean: 200.0,
    spread: 0.2,
};

/// sigma of materials that do not say it, those of glTF files among them.
pub(crate) const DEFAULT_COHERENCE_UM: f64 = 20.0;

impl Description {
    /// Reads a scene file's text. `name` is what errors call the file.
    ///
    /// Only the form is checked here: keys, types, units. Ranges and references are checked by
    /// [`Scene::build`](crate::Scene::build).
    pub fn from_toml(text: &str, name: &Path) -> Result<Self, Error> {
        let root = locate::parse(text, name)?;
        read::description(&root).map_err(|error| error.in_scene_file(text, name))
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

impl Serialize for Distribution {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        if self.spread == 0.0 {
            return self.mean.serialize(serializer);
        }
        let mut table = serializer.serialize_struct("Distribution", 2)?;
        table.serialize_field("mean", &self.mean)?;
        table.serialize_field("spread", &self.spread)?;
        table.end()
    }
}
