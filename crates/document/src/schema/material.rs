//! The keys of `[[material]]`.

use hairline_optics::metal::Metal;

use super::key::{Form, Initial, Key, linear, log};
use super::section::{Choice, Section};
use crate::description::values::{Named, names};

/// Metals whose refractive index was measured.
const METALS: &[&str] = &names::<Metal, { Metal::NAMES.len() }>(Metal::NAMES);

/// `[[material]]`
pub static MATERIAL: Section = Section::many(
    "material",
    "Material",
    "what an object is made of.",
    &[
        &NAME,
        &ROUGHNESS,
        &ANISOTROPY,
        &ANISOTROPY_DIRECTION_DEG,
        &CLEARCOAT,
        &CLEARCOAT_ROUGHNESS,
        &COHERENCE_UM,
    ],
)
.kinds(
    "kind",
    &[
        Choice::new(
            "metal",
            "A bare metal.",
            &[&METAL, &METAL_COLOR, &N_K, &COVER],
        ),
        Choice::new(
            "dielectric",
            "A clear coat over a diffuse body.",
            &[&IOR, &BODY_COLOR],
        ),
        Choice::new(
            "metallic-roughness",
            "The model of glTF 2.0.",
            &[&BASE_COLOR, &METALLIC, &SPECULAR, &SPECULAR_COLOR],
        ),
        Choice::new(
            "mirror",
            "Reflects everything at every wavelength: for tests, and for the purest colours.",
            &[],
        ),
    ],
);

pub static NAME: Key = Key::new("name", Form::Text)
    .range_words("not empty, no two equal")
    .means("What objects call it by.");

pub static ROUGHNESS: Key = Key::new("roughness", Form::Number)
    .number(0.1)
    .within(0.0, 1.0)
    .means("Perceptual roughness of the surface between the scratches, as in glTF (GGX's alpha is its square). Below 0.045 nothing changes any more, and a note says so.")
    .control("Roughness", linear(0.0, 0.6), "How far the polished highlight spreads. 0.05 to 0.15 leaves dark room around it where scratches shine; rougher surfaces drown them. The scratches themselves stay as sharp.");

pub static ANISOTROPY: Key = Key::new("anisotropy", Form::Number)
    .none()
    .within(0.0, 1.0)
    .means("How far highlights are drawn out one way, as on brushed metal (`KHR_materials_anisotropy`): that way GGX's alpha goes from that of the roughness to 1 with the square of this. 0.4 to 0.7 for brushed pans and panels.")
    .control("Anisotropy", linear(0.0, 1.0), "How far highlights are drawn out one way, as on brushed metal. 0: alike in all directions. 0.4 to 0.7 for brushed pans, lids and panels.");

pub static ANISOTROPY_DIRECTION_DEG: Key = Key::new("anisotropy_direction_deg", Form::Number)
    .unit("°")
    .number(0.0)
    .range_words("any; with `anisotropy`")
    .means("Which way: across the brushing, counter-clockwise from where u of the texture coordinates rises. On what is turned about an axis 0 is around it and 90 across, as of a lid that is brushed round and round (`scenes/lid.toml`).")
    .control("Drawn out", linear(-90.0, 90.0), "Which way highlights are drawn out: across the brushing. 0 is along the horizontal of the texture coordinates, around the axis of what is turned; 90 is across.");

pub static CLEARCOAT: Key = Key::new("clearcoat", Form::Number)
    .none()
    .within(0.0, 1.0)
    .means("The share of the surface that has a clear layer over it, as car paint has (`KHR_materials_clearcoat`): refractive index 1.5. Scratches lie in it; what is under it shines through.")
    .control("Clear coat", linear(0.0, 1.0), "How much of the surface has a layer of lacquer. Scratches lie in it: it mirrors about 4 % without a colour, whatever shines from under it.");

pub static CLEARCOAT_ROUGHNESS: Key = Key::new("clearcoat_roughness", Form::Number)
    .number(0.0)
    .within(0.0, 1.0)
    .range_words("0 to 1; with `clearcoat`")
    .means("As `roughness`, of the layer.")
    .control("Coat roughness", linear(0.0, 0.6), "How far the highlight of the coat spreads. 0 to 0.05 for car paint, more where it is matt.");

pub static COHERENCE_UM: Key = Key::new("coherence_um", Form::Number)
    .unit("µm")
    .number(20.0)
    .within(1.0, 1000.0)
    .means("Over what distance light interferes: standard deviation of the Gaussian coherence window. Nothing finer is seen, however small the pixels. Leave it alone but for macro views and studies.")
    .control("Coherence", log(5.0, 100.0), "How far apart two points of the surface still act together on light. Larger: each scratch catches a lamp in a narrower band, so glints are thinner and crisper. Smaller: broader, softer glints. 20 suits most.");

pub static METAL: Key = Key::new("metal", Form::Name(METALS))
    .words("this, `base_color` or `n_k`")
    .means("A metal by its measured refractive index; `\"steel\"` is stainless.");

const COLOR: Key = Key::new("base_color", Form::Color)
    .unit("linear RGB")
    .within(0.0, 1.0)
    .control("Colour", linear(0.0, 1.0), "On metals it tints the mirror image and the scratches in it; on coated surfaces it is the body under the coat, which scratches leave as it is. Dark bodies let scratches show.");

pub static METAL_COLOR: Key = COLOR
    .words("this, `metal` or `n_k`")
    .means("A metal by its reflectance when seen head-on.");

pub static N_K: Key = Key::new("n_k", Form::Points(3))
    .words("this, `metal` or `base_color`")
    .within(0.0, 2000.0)
    .range_words("1 to 4096 rows: a wavelength from 100 to 2000 nm, each greater than that before; n above 0, k 0 or more, up to 100")
    .means("A metal by a refractive index of your own: rows of a wavelength in nm, n and k, as `[[400, 1.5, 1.9], [500, 0.9, 1.8]]`. Linear between them, constant beyond.");

pub static COVER: Key = Key::new("cover", Form::Table)
    .none()
    .range_words("see [cover](#cover); with `metal` or `n_k`, without `clearcoat`")
    .means("A clear plate with parallel faces over the metal: the polycarbonate of discs, the glass of a dial. Its outer face reflects with the metal's roughness. Gratings lie under it: waves are shorter there, and orders have other brightnesses in the same directions. Scratches lie in the metal.");

pub static IOR: Key = Key::new("ior", Form::Number)
    .number(1.5)
    .within(1.0, 4.0)
    .means("Refractive index of the clear coat. 1.5 is glass and most plastics and lacquers.")
    .control("Refractive index", linear(1.0, 2.5), "How much the clear coat mirrors: 1.5 is lacquer or glass, about 4 %. Higher: brighter highlights and brighter scratches.");

pub static BODY_COLOR: Key = COLOR
    .is(Initial::Numbers(&[0.5, 0.5, 0.5]))
    .means("Albedo of the diffuse body below the coat.");

pub static BASE_COLOR: Key = COLOR
    .is(Initial::Numbers(&[1.0, 1.0, 1.0]))
    .means("The base colour of glTF 2.0.");

pub static METALLIC: Key = Key::new("metallic", Form::Number)
    .number(1.0)
    .within(0.0, 1.0)
    .means("From dielectric to metal.")
    .control("Metallic", linear(0.0, 1.0), "0: a painted surface with weak, white reflections. 1: bare metal, whose reflections and scratches are bright and take its colour.");

pub static SPECULAR: Key = Key::new("specular", Form::Number)
    .number(1.0)
    .within(0.0, 1.0)
    .means("As far as it is no metal: how much of its reflections it keeps, straight on and at grazing views (`KHR_materials_specular`). 1 is as of glass, 0 as of chalk.")
    .control("Specular", linear(0.0, 1.0), "How much of its reflections what is no metal keeps. 1: those of plastic, refractive index 1.5. 0: none, as chalk.");

pub static SPECULAR_COLOR: Key = Key::new("specular_color", Form::Color)
    .unit("linear RGB")
    .is(Initial::Numbers(&[1.0, 1.0, 1.0]))
    .within(0.0, 1.0)
    .means("As far as it is no metal: the colour of its reflections straight on. At grazing views they stay white.")
    .control("Specular colour", linear(0.0, 1.0), "The colour of what it reflects straight on, as far as it is no metal. White for all but cloth, feathers and other things of many layers.");
