//! Material of a surface: its optics, and the textures that change them from place to place.

use hairline_optics::cover::Cover;
use hairline_optics::metal::MetalIndex;
use serde::Serialize;

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
    /// An even, opaque surface that emits nothing: no texture, no layer over it, dielectric parts as glTF has them without extensions.
    pub fn plain(name: String, base: Base, roughness: f64) -> Self {
        Self {
            name,
            base,
            roughness,
            coherence_um: DEFAULT_COHERENCE_UM,
            emission: [0.0; 3],
            base_color_texture: None,
            metallic_roughness_texture: None,
            normal_texture: None,
            emission_texture: None,
            occlusion_texture: None,
            dielectric_f0: GLTF_DIELECTRIC_F0,
            specular: Specular::default(),
            specular_textures: [None; 2],
            is_unlit: false,
            cutout: None,
            coat: None,
            coat_textures: [None; 2],
            coat_normal_texture: None,
            anisotropy: None,
            anisotropy_texture: None,
        }
    }

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

/// A layer of lacquer over a base, as of cars and phones: refractive index [`COAT_IOR`](hairline_optics::coat::COAT_IOR), without a colour
/// (KHR_materials_clearcoat).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Coat {
    /// `clearcoat`: the share of the surface that it covers, in [0, 1].
    #[serde(rename = "clearcoat")]
    pub weight: f64,
    /// `clearcoat_roughness`: as that of materials. In [0, 1]. Default: 0.
    #[serde(rename = "clearcoat_roughness")]
    pub roughness: f64,
}

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
#[derive(Clone, Debug, PartialEq)]
pub enum Base {
    /// Reflectance one at every wavelength and angle.
    Mirror,
    /// A metal by its measured n and k.
    Metal(MetalIndex),
    /// A metal by its measured n and k under a clear plate.
    Covered {
        /// The metal.
        metal: MetalIndex,
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

impl Material {
    /// Roughness of the base without its texture: a mirror has none.
    pub fn base_roughness(&self) -> f64 {
        match self.base {
            Base::Mirror => 0.0,
            _ => self.roughness,
        }
    }
}

impl Base {
    /// Base colour and metallic of glTF that come closest to it.
    pub fn color_and_metallic(&self) -> ([f64; 3], f64) {
        match self {
            Self::Mirror => ([1.0; 3], 1.0),
            Self::Metal(metal) | Self::Covered { metal, .. } => (metal.reflectance_rgb(1.0), 1.0),
            Self::ColoredMetal { base_color } => (*base_color, 1.0),
            Self::Dielectric { base_color, .. } => (*base_color, 0.0),
            Self::MetallicRoughness {
                base_color,
                metallic,
            } => (*base_color, *metallic),
        }
    }
}

/// Coherence of a surface whose file does not tell it: that of glTF, which has no such key.
pub const DEFAULT_COHERENCE_UM: f64 = 20.0;
