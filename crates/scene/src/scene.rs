//! The validated scene in canonical units, which every renderer reads. Positions are world space, metres; scratches keep the units of the physics
//! (width in micrometres, depth in nanometres).
//!
//! A [`Scene`] holds no choice and no default: whatever a scene file left out was filled in, and whatever was wrong
//! was refused, before one of these exists.

use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};
use hairline_image::Batches;
use hairline_optics::cover::Cover;
use hairline_optics::metal::Metal;
use serde::Serialize;
use std::ops::Range;
use std::sync::Arc;

use crate::environment::Environment;
use crate::grating::Grating;

pub use crate::light::{Cone, Doors, Light, LightShape};

/// Number of samples of a pixel with an edge or a crease, in a finished picture: of the window, of an export and of `hairline render`, by every
/// renderer.
pub const DEFAULT_SAMPLES: u32 = 8;

/// The ways that light may take besides the direct one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transport {
    /// Whether objects hide lights and the environment from one another.
    pub shadows: bool,
    /// Largest number of other objects on a path of light; only with shadows.
    pub bounces: u32,
}

impl Transport {
    /// No other way: the closed forms alone.
    pub const DIRECT: Self = Self {
        shadows: false,
        bounces: 0,
    };

    /// Batches that make up a picture of `samples` samples. None where a picture has all of its samples at once.
    pub fn batches(self, camera: &Camera, samples: u32) -> Option<Batches> {
        match (camera.has_lens(), self.shadows) {
            (true, _) => Some(Batches::new(samples.max(LENS_SAMPLES))),
            (false, true) => Some(Batches::of_rounds(samples)),
            (false, false) => None,
        }
    }
}

/// Least number of samples with a lens: fewer points of it would be seen one by one.
const LENS_SAMPLES: u32 = 64;

/// Default of `hairline render`.
pub const DEFAULT_TRANSPORT: Transport = Transport {
    shadows: true,
    bounces: 1,
};

/// Everything that a picture depends on.
///
/// What is large lies behind an [`Arc`], so a clone costs microseconds: an editor clones a scene, changes what is small (a
/// light, the camera, a material) and hands it on, and who has seen the scene before tells by [`Arc::ptr_eq`] what is still
/// the same. [`Arc::make_mut`] changes what is large.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The view.
    pub camera: Camera,
    /// Sampling and display of the picture.
    pub render: RenderSettings,
    /// Light from all around, if there is any.
    pub environment: Option<Environment>,
    /// Images that materials refer to.
    pub textures: Arc<Vec<Texture>>,
    /// Materials that the triangles of the objects refer to.
    pub materials: Vec<Material>,
    /// Objects in world space.
    pub objects: Vec<Object>,
    /// Area lights, without those of the environment: see [`Scene::all_lights`].
    pub lights: Vec<Light>,
    /// Notes on the scene file and its models for the author, a line each: a key that has no effect any more, a part of a model that is not shown.
    pub notes: Vec<String>,
}

impl Scene {
    /// The area lights, then the environment's [suns](Environment::suns): all that shine on surfaces besides the environment itself.
    pub fn all_lights(&self) -> impl Iterator<Item = &Light> + Clone {
        let suns = self.environment.iter().flat_map(Environment::suns);
        self.lights.iter().chain(suns)
    }

    /// Returns the scene with nothing to be seen behind its surfaces: its environment shines, and the camera does not see it.
    #[must_use]
    pub fn before_nothing(&self) -> Self {
        let mut scene = self.clone();
        let environment = scene.environment.take();
        scene.environment = environment.map(|it| it.with_visible(false));
        scene
    }

    /// The lights of [`Self::all_lights`], then the environment's [windows](Environment::windows): all that shine on scratches besides the rest of
    /// the environment.
    pub fn scratch_lights(&self) -> impl Iterator<Item = &Light> + Clone {
        let windows = self.environment.iter().flat_map(Environment::windows);
        self.all_lights().chain(windows)
    }
}

/// A camera: a pinhole, or a thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole, or the middle of the lens, world space.
    pub position_m: DVec3,
    /// The point in the centre of the picture without a shift, world space.
    pub target_m: DVec3,
    /// The direction that is up in the picture; need not be perpendicular to the view.
    pub up: DVec3,
    /// The picture's vertical field of view.
    pub fov_y_rad: f64,
    /// How far the picture's centre is off the target, to the right and up, at unit depth.
    pub shift_tan: DVec2,
    /// Exposure: radiances are multiplied by 2^exposure_ev before the tone map.
    pub exposure_ev: f64,
    /// Lens of the camera.
    pub lens: Lens,
}

/// A thin lens, across the view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lens {
    /// Radius of the lens's opening. Without one the camera is a pinhole: everything is in focus.
    pub radius_m: f64,
    /// Depth of focus along the view.
    pub focus_m: f64,
}

/// Sampling and display of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Standard deviation of the pixel's Gaussian filter (docs/model.md, section 6).
    pub filter_std_px: f64,
    /// The curve from linear radiance to the display.
    pub tone_map: hairline_image::ToneMap,
}

/// Material of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the scene file or the glTF file.
    pub name: String,
    /// The kind of surface and its colour.
    pub base: Base,
    /// Perceptual roughness as in glTF, in [0, 1]; GGX's alpha is its square.
    pub roughness: f64,
    /// Standard deviation sigma of the coherence window's amplitude.
    pub coherence_um: f64,
    /// Light that the surface emits, linear Rec.709 radiance.
    pub emission: [f64; 3],
    /// Base colour texture (sRGB encoded), multiplied with the base colour.
    pub base_color_texture: Option<usize>,
    /// glTF metallic-roughness texture (linear): green is roughness, blue is metallic.
    pub metallic_roughness_texture: Option<usize>,
    /// Index of the tangent-space normal map (linear), and the scale of its x and y.
    pub normal_texture: Option<(usize, f64)>,
    /// Emission texture (sRGB encoded), multiplied with the emission.
    pub emission_texture: Option<usize>,
    /// Texture whose red (linear) is the share of the environment's light that reaches the base, and the strength of that, in [0, 1].
    pub occlusion_texture: Option<(usize, f64)>,
    /// Reflectance at normal incidence of the dielectric part of [`Base::MetallicRoughness`], by its refractive index (KHR_materials_ior).
    pub dielectric_f0: f64,
    /// Factors on that.
    pub specular: Specular,
    /// Textures of these: the alpha (linear) of the first is a factor on the weight, the colours (sRGB encoded) of the second on the colour.
    pub specular_textures: [Option<usize>; 2],
    /// Whether it sends its base colour and reflects nothing, as a picture without light (KHR_materials_unlit).
    pub is_unlit: bool,
    /// Cutout of the surface; none if the surface fills its triangles.
    pub cutout: Option<Cutout>,
    /// Clear layer over the surface. Scratches lie in it.
    pub coat: Option<Coat>,
    /// Textures (linear) of the coat: the red of the first is a factor on its weight, the green of the second on its roughness.
    pub coat_textures: [Option<usize>; 2],
    /// Index of the coat's tangent-space normal map (linear), and the scale of its x and y. Without it the coat is smooth, whatever lies under it.
    pub coat_normal_texture: Option<(usize, f64)>,
    /// Highlights of the base that are drawn out one way, as on brushed metal.
    pub anisotropy: Option<Anisotropy>,
    /// Index of the texture (linear) of the anisotropy: red and green are a direction, which `direction_deg` turns, blue is a factor on the strength.
    pub anisotropy_texture: Option<usize>,
}

/// Factors on a dielectric's reflectance by its refractive index (KHR_materials_specular): `dielectric_f0` times the colour, at most 1, times the
/// weight at normal incidence, and the weight at grazing incidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Specular {
    /// `specular`: in [0, 1]. Default: 1.
    #[serde(rename = "specular", skip_serializing_if = "is_full")]
    pub weight: f64,
    /// `specular_color`: linear Rec.709, not negative. Default: `[1, 1, 1]`.
    #[serde(rename = "specular_color", skip_serializing_if = "is_white")]
    pub color: [f64; 3],
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            weight: 1.0,
            color: [1.0; 3],
        }
    }
}

impl Material {
    /// Whether its coat has other normals than the surface under it.
    pub fn has_coat_normals(&self) -> bool {
        self.coat.is_some() && self.coat_normal_texture != self.normal_texture
    }

    /// Whether the part of the surface that is no metal reflects otherwise than its refractive index says.
    pub fn has_specular(&self) -> bool {
        let textured = self.specular_textures.iter().any(Option::is_some);
        textured || self.specular != Specular::default() || self.is_unlit
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_full(weight: &f64) -> bool {
    *weight == 1.0
}

fn is_white(color: &[f64; 3]) -> bool {
    *color == [1.0; 3]
}

/// Facets that lean further one way than across it (KHR_materials_anisotropy).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Anisotropy {
    /// `anisotropy`: the alpha of GGX one way goes from that of the roughness to 1 with the square of this. In [0, 1].
    #[serde(rename = "anisotropy")]
    pub strength: f64,
    /// `anisotropy_direction_deg`: that way, counter-clockwise from the surface's tangent, along which u of its texture coordinates rises.
    /// Default: 0.
    #[serde(rename = "anisotropy_direction_deg")]
    pub direction_deg: f64,
}

/// A layer of lacquer over a base, as of cars and phones: refractive index [`COAT_IOR`], without a colour (KHR_materials_clearcoat).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Coat {
    /// `clearcoat`: the share of the surface that it covers, in [0, 1].
    #[serde(rename = "clearcoat")]
    pub weight: f64,
    /// `clearcoat_roughness`: as that of materials. In [0, 1]. Default: 0.
    #[serde(rename = "clearcoat_roughness")]
    pub roughness: f64,
}

/// The refractive index of a [`Coat`].
pub const COAT_IOR: f64 = 1.5;
/// Reflectance of a coat at normal incidence.
pub const COAT_F0: f64 = 0.04;

/// Reflectance at normal incidence of a glTF dielectric without extensions: [`Material::dielectric_f0`].
pub const GLTF_DIELECTRIC_F0: f64 = 0.04;

/// A surface that is not everywhere on its triangles: rays go through the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutout {
    /// Factor on the alpha of the base colour texture and of the vertices.
    pub alpha: f64,
    /// Rule by which the product of the alphas decides where the surface is.
    pub rule: AlphaRule,
}

/// Meaning of a surface's alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaRule {
    /// The surface is there where alpha is at least this.
    AtLeast(f64),
    /// Alpha is the share of the background that the surface covers.
    Share,
}

/// The kind of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base {
    /// Reflectance one at every wavelength and angle.
    Mirror,
    /// A metal by its measured n and k.
    Metal(Metal),
    /// A metal by its measured n and k under a clear plate.
    Covered {
        /// The metal.
        metal: Metal,
        /// The plate.
        cover: Cover,
    },
    /// A metal by its reflectance at normal incidence, linear Rec.709.
    ColoredMetal {
        /// Reflectance at normal incidence.
        base_color: [f64; 3],
    },
    /// A smooth or rough dielectric coat over a diffuse body.
    Dielectric {
        /// Refractive index.
        ior: f64,
        /// Albedo of the diffuse body, linear Rec.709.
        base_color: [f64; 3],
    },
    /// The glTF 2.0 metallic-roughness model.
    MetallicRoughness {
        /// Base colour, linear Rec.709.
        base_color: [f64; 3],
        /// 0 dielectric (reflectance 0.04), 1 metal.
        metallic: f64,
    },
}

/// An image with its mip chain; level 0 is `size_px`, each further level is half, rounded down, at least 1.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Width and height of level 0.
    pub size_px: [u32; 2],
    /// Texels of each level, row by row from the top, 8 bits a channel, as stored in the file (sRGB data stays encoded).
    pub levels: Vec<Vec<[u8; 4]>>,
    /// Whether colour channels are sRGB encoded.
    pub srgb: bool,
    /// Sampling of the texture.
    pub sampling: Sampling,
}

/// Sampling of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampling {
    /// Continuation beyond its left and right borders, and beyond the upper and lower ones.
    pub wrap: [Wrap; 2],
    /// Whether its texels, seen large, are rectangles of one value each.
    pub is_sharp: bool,
    /// Whether the texture uses [`Mesh::other_uvs`] in place of [`Mesh::uvs`].
    pub by_other_uvs: bool,
}

/// Continuation of a texture beyond a border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture repeats.
    #[default]
    Repeat,
    /// The texture's mirror image.
    Mirror,
    /// The texels at the border.
    Clamp,
}

impl Wrap {
    /// Index of the texel, of `count` in a row, at a place of the endless row.
    pub fn texel(self, at: i64, count: i64) -> i64 {
        match self {
            Self::Repeat => at.rem_euclid(count),
            Self::Clamp => at.clamp(0, count - 1),
            Self::Mirror => {
                let at = at.rem_euclid(2 * count);
                at.min(2 * count - 1 - at)
            }
        }
    }
}

/// A surface, with the scratches and gratings that lie on it.
#[derive(Clone, Debug)]
pub struct Object {
    /// The name in the scene file.
    pub name: String,
    /// The surface.
    pub mesh: Arc<Mesh>,
    /// Scratches, each a run of `segments`.
    pub scratches: Arc<Vec<Scratch>>,
    /// Straight pieces, one triangle each, those of one scratch side by side in the order of its walk.
    pub segments: Arc<Vec<Segment>>,
    /// Parts of the object that its file names; none of a shape.
    pub parts: Arc<Vec<NodeTriangles>>,
    /// Grooves that are finer than a pixel.
    pub gratings: Vec<Grating>,
    /// Whether it is the shape of a light that the camera sees: black but for its emission, met by no ray but the camera's, and by that on its
    /// front alone. Such objects are the last of a scene.
    pub is_lamp: bool,
}

/// The triangles of one node of a model's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeTriangles {
    /// The names of the node and of those above it, from the innermost on.
    pub nodes: Arc<[String]>,
    /// Range of the part in [`Mesh::triangles`].
    pub triangles: Range<usize>,
}

impl Object {
    /// The area of a scratch: its width in micrometres times its length in metres.
    pub fn covered_um_m(&self, scratch: &Scratch) -> f32 {
        let own = scratch.segments.start as usize..scratch.segments.end as usize;
        let lengths = self.segments[own]
            .iter()
            .map(|p| p.start_m.distance(p.end_m));
        scratch.profile.width_um * lengths.sum::<f32>()
    }

    /// Whether two objects share their surface, unchanged.
    pub fn same_mesh(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.mesh, &other.mesh)
    }

    /// Whether two objects share their scratches, unchanged.
    pub fn same_scratches(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scratches, &other.scratches)
            && Arc::ptr_eq(&self.segments, &other.segments)
    }
}

/// Triangles in world space. The vertex arrays are equally long; those of other coordinates and of colours may be empty.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// World space, metres.
    pub positions_m: Vec<Vec3>,
    /// Unit shading normals.
    pub normals: Vec<Vec3>,
    /// Unit tangents in xyz, the sign of the bitangent in w, as in glTF.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates; (0, 0) is the upper left corner.
    pub uvs: Vec<Vec2>,
    /// A second set of texture coordinates; without it they are (0, 0).
    pub other_uvs: Vec<Vec2>,
    /// Factors on base colour and alpha, linear Rec.709; without them 1.
    pub colors: Vec<Vec4>,
    /// Vertex indices, counter-clockwise seen from outside. None is degenerate.
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Scene::materials`], one for each triangle.
    pub triangle_materials: Vec<u32>,
}

impl Mesh {
    /// Materials of the triangles, each once, in order.
    pub fn materials(&self) -> Vec<usize> {
        let all = self.triangle_materials.iter();
        let mut all: Vec<usize> = all.map(|material| *material as usize).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// The cross section of a groove: a rectangle. It travels whole, from the layer that draws it to what shades it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile {
    /// Width of the opening.
    pub width_um: f32,
    /// Depth of the floor.
    pub depth_nm: f32,
}

/// One scratch: one groove, one wave. Where two of its segments meet, the end is joined; its own two ends are free,
/// unless it is closed to a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct Scratch {
    /// Profile of its groove.
    pub profile: Profile,
    /// Index of the `[[scratches]]` table of the scene file that laid it, from 0.
    pub layer: u32,
    /// Whether the last segment's end is joined to the first one's start.
    pub closed: bool,
    /// Range of its segments in [`Object::segments`].
    pub segments: Range<u32>,
}

/// A straight piece of a scratch within one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// World space, metres.
    pub start_m: Vec3,
    /// World space, metres.
    pub end_m: Vec3,
    /// Unit shading normal of the surface at the middle: tells the two sides of a thin sheet apart.
    pub normal: Vec3,
    /// Index in [`Mesh::triangles`] of the segment's triangle.
    pub triangle: u32,
}
