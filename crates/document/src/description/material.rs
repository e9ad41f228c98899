//! The `[[material]]` tables of a scene file.

use hairline_keys::Keyed;
use hairline_optics::metal::Metal;
use hairline_scene::{Anisotropy, Coat, Specular};

use super::keyed::Keyed;
use super::ranges::Check;
use super::table::Table;
use crate::error::Error;
use crate::schema::Entry;
use crate::schema::key::{Form, Key, linear};
use crate::schema::section::keys;

pub(crate) use hairline_model::material::DEFAULT_COHERENCE_UM;

/// `[[material]]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, kinds = MaterialKind, of_kinds = OF_KINDS, check = Material::check_cover)]
pub struct Material {
    /// What objects call it by.
    #[key(range_words("not empty, no two equal"))]
    pub name: String,
    /// `kind` and the keys that belong to it.
    #[flat]
    pub kind: MaterialKind,
    /// Perceptual roughness of the surface between the scratches, as in glTF (GGX's alpha is its square). Below 0.045 nothing changes any more, and a
    /// note says so.
    #[key(number(0.1).in_range(0.0, 1.0)
        .control("Roughness", linear(0.0, 0.6), "How far the polished highlight spreads. 0.05 to 0.15 leaves dark room around it where scratches shine; rougher surfaces drown them. The scratches themselves stay as sharp."))]
    pub roughness: f64,
    /// Highlights that are drawn out one way, as on brushed metal.
    #[flat]
    #[read(anisotropy)]
    pub anisotropy: Option<Anisotropy>,
    /// A clear layer over it, in which its scratches lie.
    #[flat]
    #[read(coat)]
    pub coat: Option<Coat>,
    /// Over what distance light interferes: standard deviation of the Gaussian coherence window. Nothing finer is seen, however small the pixels.
    /// Leave it alone but for macro views and studies.
    #[key(unit("µm").number(20.0).in_range(1.0, 1000.0)
        .control("Coherence", log(5.0, 100.0), "How far apart two points of the surface still act together on light. Larger: each scratch catches a lamp in a narrower band, so glints are thinner and crisper. Smaller: broader, softer glints. 20 suits most."))]
    pub coherence_um: f64,
    /// A clear plate with parallel faces over the metal: the polycarbonate of discs, the glass of a dial. Its outer face reflects with the metal's
    /// roughness. Gratings lie under it: waves are shorter there, and orders have other brightnesses in the same directions. Scratches lie in the
    /// metal.
    #[key(none().range_words("see [cover](#cover); with `metal` or `n_k`, without `clearcoat`"))]
    #[of_kinds]
    pub cover: Option<Cover>,
}

/// The keys of a clear layer.
#[derive(Keyed)]
#[keyed(remote = Coat)]
pub struct Clearcoat {
    /// The share of the surface that has a clear layer over it, as car paint has (`KHR_materials_clearcoat`): refractive index 1.5. Scratches lie in
    /// it; what is under it shines through.
    #[key("clearcoat": none().in_range(0.0, 1.0)
        .control("Clear coat", linear(0.0, 1.0), "How much of the surface has a layer of lacquer. Scratches lie in it: it mirrors about 4 % without a colour, whatever shines from under it."))]
    weight: f64,
    /// As `roughness`, of the layer.
    #[key("clearcoat_roughness": number(0.0).in_range(0.0, 1.0).range_words("0 to 1; with `clearcoat`")
        .control("Coat roughness", linear(0.0, 0.6), "How far the highlight of the coat spreads. 0 to 0.05 for car paint, more where it is matt."))]
    roughness: f64,
}

/// The keys of what is brushed.
#[derive(Keyed)]
#[keyed(remote = Anisotropy)]
pub struct Brushing {
    /// How far highlights are drawn out one way, as on brushed metal (`KHR_materials_anisotropy`): that way GGX's alpha goes from that of the
    /// roughness to 1 with the square of this. 0.4 to 0.7 for brushed pans and panels.
    #[key("anisotropy": none().in_range(0.0, 1.0)
        .control("Anisotropy", linear(0.0, 1.0), "How far highlights are drawn out one way, as on brushed metal. 0: alike in all directions. 0.4 to 0.7 for brushed pans, lids and panels."))]
    strength: f64,
    /// Which way: across the brushing, counter-clockwise from where u of the texture coordinates rises. On what is turned about an axis 0 is around
    /// it and 90 across, as of a lid that is brushed round and round (`scenes/lid.toml`).
    #[key("anisotropy_direction_deg": unit("°").number(0.0).range_words("any; with `anisotropy`")
        .control("Drawn out", linear(-90.0, 90.0), "Which way highlights are drawn out: across the brushing. 0 is along the horizontal of the texture coordinates, around the axis of what is turned; 90 is across."))]
    direction_deg: f64,
}

/// `cover` of a `[[material]]`: a clear plate with parallel faces.
#[derive(Clone, Copy, Debug, PartialEq, Keyed)]
#[keyed(table, default)]
pub struct Cover {
    /// Refractive index: 1.58 is the polycarbonate of discs, 1.52 window glass.
    #[key(number(1.58).in_range(1.0, 4.0)
        .control("Cover's index", linear(1.0, 2.5), "How much the outer face of the plate mirrors, and how short waves are over the grooves under it. 1.58 is the polycarbonate of discs."))]
    pub ior: f64,
    /// How thick it is: how far light goes through its colour. 1.2 is a compact disc, 0.6 a DVD.
    #[key(unit("mm").number(1.2).in_range(0.0, 100.0)
        .control("Cover's thickness", linear(0.0, 0.005), "How far light goes through the colour of the plate."))]
    pub thickness_mm: f64,
    /// The light that a millimetre lets through.
    #[key(color().is(Initial::Numbers(&[1.0, 1.0, 1.0])).in_range(0.0, 1.0)
        .control("Cover's colour", linear(0.0, 1.0), "The light that a millimetre of the plate lets through. White: clear."))]
    pub color: [f64; 3],
}

/// `kind` of a `[[material]]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(tag = "kind")]
pub enum MaterialKind {
    /// A bare metal.
    #[kind("metal")]
    Metal(MetalColor),
    /// A clear coat over a diffuse body.
    #[kind("dielectric")]
    Dielectric {
        /// Refractive index of the clear coat. 1.5 is glass and most plastics and lacquers.
        #[key(number(1.5).in_range(1.0, 4.0)
            .control("Refractive index", linear(1.0, 2.5), "How much the clear coat mirrors: 1.5 is lacquer or glass, about 4 %. Higher: brighter highlights and brighter scratches."))]
        ior: f64,
        /// Albedo of the diffuse body below the coat.
        #[key(BODY_COLOR: color().like(&COLOR).is(Initial::Numbers(&[0.5, 0.5, 0.5])))]
        base_color: [f64; 3],
    },
    /// The model of glTF 2.0.
    #[kind("metallic-roughness")]
    MetallicRoughness {
        /// The base colour of glTF 2.0.
        #[key(color().like(&COLOR).is(Initial::Numbers(&[1.0, 1.0, 1.0])))]
        base_color: [f64; 3],
        /// From dielectric to metal.
        #[key(number(1.0).in_range(0.0, 1.0)
            .control("Metallic", linear(0.0, 1.0), "0: a painted surface with weak, white reflections. 1: bare metal, whose reflections and scratches are bright and take its colour."))]
        metallic: f64,
        /// Factors on the reflection of its part that is no metal.
        #[flat]
        specular: Specular,
    },
    /// Reflects everything at every wavelength: for tests, and for the purest colours.
    #[kind("mirror")]
    Mirror,
}

const OF_KINDS: &[(&str, &[Entry])] = &[("metal", &[Entry::Key(Material::COVER)])];

/// The keys of reflections of what is no metal.
#[derive(Keyed)]
#[keyed(remote = Specular)]
pub struct Reflections {
    /// As far as it is no metal: how much of its reflections it keeps, straight on and at grazing views (`KHR_materials_specular`). 1 is as of glass,
    /// 0 as of chalk.
    #[key("specular": omitted().number(1.0).in_range(0.0, 1.0)
        .control("Specular", linear(0.0, 1.0), "How much of its reflections what is no metal keeps. 1: those of plastic, refractive index 1.5. 0: none, as chalk."))]
    weight: f64,
    /// As far as it is no metal: the colour of its reflections straight on. At grazing views they stay white.
    #[key("specular_color": color().omitted().is(Initial::Numbers(&[1.0, 1.0, 1.0])).in_range(0.0, 1.0)
        .control("Specular colour", linear(0.0, 1.0), "The colour of what it reflects straight on, as far as it is no metal. White for all but cloth, feathers and other things of many layers."))]
    color: [f64; 3],
}

/// Colour of a metal.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(one_of, check = MetalColor::check_rows)]
pub enum MetalColor {
    /// A metal by its measured refractive index; `"steel"` is stainless.
    #[key("metal": words("this, `base_color` or `n_k`"))]
    Measured(Metal),
    /// A metal by its reflectance when seen head-on.
    #[key("base_color": color().like(&COLOR).words("this, `metal` or `n_k`"))]
    Color([f64; 3]),
    /// A metal by a refractive index of your own: rows of a wavelength in nm, n and k, as `[[400, 1.5, 1.9], [500, 0.9, 1.8]]`. Linear between them,
    /// constant beyond.
    #[key("n_k": words("this, `metal` or `base_color`").range_words("1 to 4096 rows: a wavelength from 100 to 2000 nm, each greater than that before; n above 0, k 0 or more, up to 100"))]
    Own(Vec<[f64; 3]>),
}

const COLOR: Key = Key::new("base_color", Form::Color)
    .unit("linear RGB")
    .in_range(0.0, 1.0)
    .control("Colour", linear(0.0, 1.0), "On metals it tints the mirror image and the scratches in it; on coated surfaces it is the body under the coat, which scratches leave as it is. Dark bodies let scratches show.");

impl Material {
    /// Refuses a plate over what it does not belong to.
    fn check_cover(&self, key: &str) -> Check {
        let (found, right) = match self.cover {
            Some(_) if matches!(self.kind, MaterialKind::Metal(MetalColor::Color(_))) => (
                "found a plate over a metal that a colour stands for",
                "belongs to `metal` or `n_k`, whose refractive index is known",
            ),
            Some(_) if self.coat.is_some() => {
                ("found a `clearcoat` beside it", "leave one of them out")
            }
            _ => return Ok(()),
        };
        Err(Error::new(format!("{key}.cover"), found, right))
    }
}

/// The coat of a material that has one.
fn coat(table: &Table) -> Result<Option<Coat>, Error> {
    part(table, "clearcoat = 1")
}

/// The direction of a material that is brushed.
fn anisotropy(table: &Table) -> Result<Option<Anisotropy>, Error> {
    part(table, "anisotropy = 0.6")
}

/// A part that is there where its first key is, to which the others belong.
fn part<T: Keyed>(table: &Table, such_as: &str) -> Result<Option<T>, Error> {
    let part: Option<T> = Keyed::read_keys(table)?;
    let keys = keys(T::KEYS);
    let other = keys.iter().find(|key| table.has(key.name));
    match (part, other) {
        (None, Some(other)) => Err(Error::new(
            table.key_path(other.name),
            format!("found no `{}` beside it", keys[0].name),
            format!("add one, such as `{such_as}`"),
        )),
        (part, _) => Ok(part),
    }
}

/// Rows of a refractive index.
const MOST_N_K: usize = 4096;

impl MetalColor {
    /// Refuses rows that are no wavelength, n and k.
    fn check_rows(&self, key: &str) -> Check {
        let Self::Own(rows) = self else {
            return Ok(());
        };
        if !(1..=MOST_N_K).contains(&rows.len()) {
            let found = format!("found {} rows", rows.len());
            let right = format!("must have from 1 to {MOST_N_K}");
            return Err(Error::new(format!("{key}.n_k"), found, right));
        }
        for (i, &[nm, n, k]) in rows.iter().enumerate() {
            let at = |column: usize, found: f64, right: &str| {
                let key = format!("{key}.n_k[{i}][{column}]");
                Err(Error::new(key, format!("found {found}"), right))
            };
            if !(100.0..=2000.0).contains(&nm) {
                return at(0, nm, "must be a wavelength from 100 to 2000 (nm)");
            }
            if i > 0 && nm <= rows[i - 1][0] {
                return at(
                    0,
                    nm,
                    &format!("must be above {}, the wavelength before it", rows[i - 1][0]),
                );
            }
            // Written so that NaN is wrong.
            if !(n > 0.0 && n <= 100.0) {
                return at(1, n, "must be above 0, up to 100");
            }
            if !(0.0..=100.0).contains(&k) {
                return at(2, k, "must be from 0 to 100");
            }
        }
        if rows.iter().all(|row| row[1..] == [1.0, 0.0]) {
            let found = "found n = 1 and k = 0 in all rows, which is air";
            return Err(Error::new(
                format!("{key}.n_k"),
                found,
                "must reflect some light",
            ));
        }
        Ok(())
    }
}
