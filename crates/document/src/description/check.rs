//! Checks of the ranges of numbers, whoever wrote them.

use super::keyed::Keyed;
use super::ranges::{Check, check_radii, check_seed};
use super::{
    Amount, Brush, Description, Distribution, Environment, Grating, Laid, Layer, LayerPlaces,
    Light, Look, Material, MaterialKind, MetalColor, Object, Override, Pattern, Scratches, Stroke,
    Surface,
};
use crate::error::Error;
use crate::schema::{environment, material, object, place, scratches, stroke};
use hairline_model::text::shown;
use hairline_optics::section::Section;
use std::collections::HashSet;

impl Description {
    /// Refuses values out of range. References between tables are checked where they are resolved.
    ///
    /// # Errors
    /// What is out of range, and where.
    pub fn check(&self) -> Result<(), Error> {
        self.camera.check_at("camera")?;
        self.render.check_keys("render")?;
        if !matches!(self.render.png_bits, 8 | 16) {
            let found = format!("found {}", self.render.png_bits);
            return Err(Error::new("render.png_bits", found, "must be 8 or 16"));
        }
        if let Some(environment) = &self.environment {
            check_environment(environment, "environment")?;
        }
        self.studio.check_keys("studio")?;
        if let Some(ground) = &self.ground {
            ground.check_keys("ground")?;
        }
        each("material", &self.materials, check_material)?;
        unique("material", self.materials.iter().map(|m| m.name.as_str()))?;
        if self.objects.is_empty() && self.ground.is_none() {
            let right = "must have at least one `[[object]]`, or a `[ground]`";
            return Err(Error::new("object", "found no object", right));
        }
        each("object", &self.objects, check_object)?;
        unique("object", self.objects.iter().map(|o| o.name.as_str()))?;
        check_layers(&self.scratches)?;
        check_gratings(&self.gratings)?;
        each("light", &self.lights, Light::check_at)?;
        each("look", &self.looks, check_look)?;
        unique("look", self.looks.iter().map(|look| look.name.as_str()))
    }
}

fn each<T>(key: &str, items: &[T], check: impl Fn(&T, &str) -> Check) -> Check {
    items
        .iter()
        .enumerate()
        .try_for_each(|(i, item)| check(item, &format!("{key}[{i}]")))
}

fn unique<'n>(key: &str, names: impl Iterator<Item = &'n str>) -> Check {
    let mut seen = HashSet::new();
    for (i, name) in names.enumerate() {
        let way = format!("{key}[{i}].name");
        if name.is_empty() {
            return Err(Error::new(way, "found an empty name", "must not be empty"));
        }
        if !seen.insert(name) {
            let found = format!("found a second {key} called \"{}\"", shown(name));
            return Err(Error::new(way, found, "names must differ"));
        }
    }
    Ok(())
}

fn check_environment(it: &Environment, key: &str) -> Check {
    environment::ROTATION_DEG.check(key, &it.rotation_deg)?;
    environment::INTENSITY.check(key, &it.intensity)
}

fn check_look(it: &Look, key: &str) -> Check {
    it.check_keys(key)?;
    if let Some(camera) = &it.camera {
        camera.check_at(&format!("{key}.camera"))?;
    }
    if let Some(environment) = &it.environment {
        check_environment(environment, &format!("{key}.environment"))?;
    }
    if let Some(studio) = &it.studio {
        studio.check_keys(&format!("{key}.studio"))?;
    }
    each(&format!("{key}.light"), &it.lights, Light::check_at)
}

fn check_material(it: &Material, key: &str) -> Check {
    material::ROUGHNESS.check(key, &it.roughness)?;
    material::COHERENCE_UM.check(key, &it.coherence_um)?;
    if let Some(coat) = it.coat {
        material::CLEARCOAT.check(key, &coat.weight)?;
        material::CLEARCOAT_ROUGHNESS.check(key, &coat.roughness)?;
    }
    if let Some(cover) = it.cover {
        cover.check_keys(&format!("{key}.cover"))?;
    }
    if let Some(anisotropy) = it.anisotropy {
        material::ANISOTROPY.check(key, &anisotropy.strength)?;
        material::ANISOTROPY_DIRECTION_DEG.check(key, &anisotropy.direction_deg)?;
    }
    match &it.kind {
        MaterialKind::Metal(MetalColor::Measured(_)) | MaterialKind::Mirror => Ok(()),
        MaterialKind::Metal(MetalColor::Own(rows)) => check_n_k(key, rows),
        MaterialKind::Metal(MetalColor::Color(color)) => material::METAL_COLOR.check(key, color),
        MaterialKind::Dielectric { ior, base_color } => {
            material::IOR.check(key, ior)?;
            material::BODY_COLOR.check(key, base_color)
        }
        MaterialKind::MetallicRoughness {
            base_color,
            metallic,
            specular,
        } => {
            material::METALLIC.check(key, metallic)?;
            material::SPECULAR.check(key, &specular.weight)?;
            material::SPECULAR_COLOR.check(key, &specular.color)?;
            material::BASE_COLOR.check(key, base_color)
        }
    }
}

fn check_object(it: &Object, key: &str) -> Check {
    object::TRANSLATION_M.check(key, &it.translation_m)?;
    object::ROTATION_DEG.check(key, &it.rotation_deg)?;
    match it.scale {
        [x, y, z] if x == y && y == z => object::SCALE.check(key, &x)?,
        _ => object::SCALE.check(key, &it.scale)?,
    }
    object::FIT_M.check(key, &it.fit_m)?;
    object::TIME_S.check(key, &it.time_s)?;
    if it.animation.is_some() && it.time_s.is_none() {
        let right = "add one, such as `time_s = 0`: an animation is shown at a time";
        let found = "found no `time_s` beside it";
        return Err(Error::new(format!("{key}.animation"), found, right));
    }
    if let (Some(_), [_, ..]) = (&it.material, &it.overrides[..]) {
        return Err(Error::new(
            format!("{key}.overrides"),
            "found `material` beside it, of which all of the mesh is",
            "leave out one of the two",
        ));
    }
    let overrides = format!("{key}.overrides");
    each(&overrides, &it.overrides, Override::check_at)?;
    match (&it.surface, &it.material) {
        (Surface::Shape(shape), Some(_)) => shape.check_at(&format!("{key}.shape")),
        (Surface::Shape(_), None) => Err(Error::new(
            key,
            "`material` is missing",
            "a shape needs one; only a mesh brings its own",
        )),
        (Surface::Mesh(_), _) => Ok(()),
    }
}

/// Checks the tables `[[scratches]]`.
pub(super) fn check_layers(layers: &[Scratches]) -> Check {
    each("scratches", layers, check_scratches)
}

/// Checks the tables `[[grating]]`.
pub(super) fn check_gratings(gratings: &[Grating]) -> Check {
    each("grating", gratings, Grating::check_at)
}

fn check_scratches(it: &Scratches, key: &str) -> Check {
    match &it.layer {
        Layer::Laid(laid) => check_laid(laid, key)?,
        Layer::Brushed(brushed) => {
            check_drawn(brushed.seed, brushed.sizes(), key)?;
            scratches::JITTER_DEG.check(key, &brushed.jitter_deg)?;
        }
        Layer::Engraved(engraved) => engraved.check_at(key)?,
        Layer::Listed(_) => {}
    }
    check_profile(&it.profile, key)?;
    check_place(&it.place, &format!("{key}.where"))?;
    let paints = matches!(it.layer, Layer::Brushed(_));
    each(&format!("{key}.strokes"), &it.strokes, |s, key| {
        check_stroke(s, paints, key)
    })
}

/// Depths of one profile.
const PROFILE_DEPTHS: std::ops::RangeInclusive<usize> = 2..=64;

fn check_profile(it: &Section, key: &str) -> Check {
    let Section::Listed(depths) = it else {
        return Ok(());
    };
    let wrong = |found: String, right: String| {
        Err(Error::new(
            format!("{key}.{}", scratches::PROFILE.name),
            found,
            right,
        ))
    };
    if !PROFILE_DEPTHS.contains(&depths.len()) {
        let (least, most) = PROFILE_DEPTHS.into_inner();
        let right = format!("must be from {least} to {most}, from the middle to the rim");
        return wrong(format!("found {} depths", depths.len()), right);
    }
    scratches::PROFILE.check(key, &depths[..])?;
    match depths.iter().all(|depth| *depth == 0.0) {
        true => wrong(
            "found no depth but 0".to_owned(),
            "must have one that is not, such as `[1, 0.5, 0]`".to_owned(),
        ),
        false => Ok(()),
    }
}

/// Refuses values out of range, and keys that need another one.
fn check_place(it: &LayerPlaces, key: &str) -> Check {
    let alone = |name: &str, right: &str| {
        let found = "found it without what it belongs to";
        Err(Error::new(format!("{key}.{name}"), found, right))
    };
    it.check_keys(key)?;
    if it.tile_m.is_some() && it.files().next().is_none() {
        return alone("tile_m", "belongs to `mask` or `density`");
    }
    if it.edge_width_m.is_some() && it.edges == 0.0 {
        return alone("edge_width_m", "belongs to `edges`, such as `edges = 0.8`");
    }
    check_radii(&place::RADIUS_M, key, it.radius_m)?;
    if it.center_m.is_some() && it.radius_m.is_none() {
        return alone("center_m", "belongs to `radius_m`");
    }
    Ok(())
}

/// Points of one stroke.
pub const STROKE_POINTS: std::ops::RangeInclusive<usize> = 1..=65_536;

/// Checks a stroke; `paints` says whether the layer takes strokes that lay scratches.
fn check_stroke(it: &Stroke, paints: bool, key: &str) -> Check {
    if !STROKE_POINTS.contains(&it.points_m.len()) {
        let (least, most) = STROKE_POINTS.into_inner();
        return Err(Error::new(
            format!("{key}.points_m"),
            format!("found {} points", it.points_m.len()),
            format!("must be from {least} to {most}"),
        ));
    }
    stroke::POINTS_M.check(key, &it.points_m[..])?;
    stroke::RADIUS_M.check(key, &it.radius_m)?;
    match &it.brush {
        Brush::Erase => Ok(()),
        Brush::Paint { .. } if !paints => Err(Error::new(
            key,
            "found a stroke that lays scratches in a layer of another pattern than `drawn`",
            "must be `erase = true` here; draw in a layer of its own",
        )),
        Brush::Paint {
            density_per_m,
            width,
            depth,
        } => {
            stroke::DENSITY_PER_M.check(key, density_per_m)?;
            stroke::WIDTH.check(key, width)?;
            stroke::DEPTH.check(key, depth)
        }
    }
}

/// The seed of a layer that draws random numbers, and its lengths, widths and depths.
fn check_drawn(seed: u64, [lengths, widths, depths]: [Distribution; 3], key: &str) -> Check {
    check_seed(seed, key)?;
    scratches::LENGTH_M.check(key, &lengths)?;
    scratches::WIDTH_UM.check(key, &widths)?;
    scratches::DEPTH_NM.check(key, &depths)
}

fn check_laid(laid: &Laid, key: &str) -> Check {
    if let Amount::DensityPerM2(density) = laid.amount {
        scratches::DENSITY_PER_M2.check(key, &density)?;
    }
    check_drawn(laid.seed, laid.sizes(), key)?;
    laid.pattern.check_keys(key)?;
    match laid.pattern {
        Pattern::Swirl { curvature_per_m } if curvature_per_m.mean == 0.0 => Err(Error::new(
            format!("{key}.curvature_per_m"),
            "found a mean of 0",
            "swirls need one: one over their radius",
        )),
        _ => Ok(()),
    }
}

/// Rows of a wavelength, n and k.
fn check_n_k(key: &str, rows: &[[f64; 3]]) -> Result<(), Error> {
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

/// Rows of a refractive index.
const MOST_N_K: usize = 4096;
