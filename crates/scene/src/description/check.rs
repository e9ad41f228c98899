//! Checks of the ranges of numbers, whoever wrote them.

use super::limits;
use super::ranges::{
    Check, check_seed, components, direction, finite, found, jitter, not_negative, point, size,
    spread, within,
};
use super::sizes;
use super::{
    Amount, Around, Brush, Camera, Description, Distribution, Grating, Laid, Layer, LayerPlaces,
    Light, Material, MaterialKind, MetalColor, Object, Override, Pattern, Render, Scratches,
    Stroke, Surface,
};
use crate::error::Error;
use crate::text::shown;
use std::collections::HashSet;

impl Description {
    /// Refuses values out of range. References between tables are checked where they are resolved.
    ///
    /// # Errors
    /// What is out of range, and where.
    pub fn check(&self) -> Result<(), Error> {
        camera(&self.camera, "camera")?;
        render(&self.render, "render")?;
        if let Some(environment) = &self.environment {
            finite("environment.rotation_deg", environment.rotation_deg)?;
            not_negative("environment.intensity", environment.intensity)?;
        }
        self.studio.check()?;
        if let Some(ground) = &self.ground {
            ground.check()?;
        }
        each("material", &self.materials, material)?;
        unique("material", self.materials.iter().map(|m| m.name.as_str()))?;
        if self.objects.is_empty() {
            let right = "must have at least one `[[object]]`";
            return Err(Error::new("object", "found no object", right));
        }
        each("object", &self.objects, object)?;
        unique("object", self.objects.iter().map(|o| o.name.as_str()))?;
        each("scratches", &self.scratches, scratches)?;
        each("grating", &self.gratings, Grating::check_at)?;
        each("light", &self.lights, Light::check_at)
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

fn camera(camera: &Camera, key: &str) -> Check {
    point(&format!("{key}.position_m"), camera.position_m)?;
    point(&format!("{key}.target_m"), camera.target_m)?;
    direction(&format!("{key}.up"), camera.up)?;
    finite(&format!("{key}.exposure_ev"), camera.exposure_ev)?;
    within(
        &format!("{key}.exposure_ev"),
        camera.exposure_ev,
        limits::EXPOSURE_EV,
    )?;
    within(
        &format!("{key}.fov_y_deg"),
        camera.fov_y_deg,
        limits::FOV_Y_DEG,
    )?;
    if let Some(sensor_mm) = camera.sensor_width_mm {
        within(
            &format!("{key}.sensor_width_mm"),
            sensor_mm,
            limits::SENSOR_WIDTH_MM,
        )?;
    }
    if let Some(aperture_mm) = camera.aperture_mm {
        within(
            &format!("{key}.aperture_mm"),
            aperture_mm,
            limits::APERTURE_MM,
        )?;
    }
    if let Some(focus_distance_m) = camera.focus_distance_m {
        within(
            &format!("{key}.focus_distance_m"),
            focus_distance_m,
            limits::SIZE_M,
        )?;
    }
    for (i, shift) in camera.shift.into_iter().flatten().enumerate() {
        within(&format!("{key}.shift[{i}]"), shift, limits::SHIFT)?;
    }
    let [position, target, up] =
        [camera.position_m, camera.target_m, camera.up].map(glam::DVec3::from_array);
    let view = target - position;
    if view.length() < limits::SMALLEST_M {
        return Err(Error::new(
            format!("{key}.target_m"),
            "found the camera's own position",
            "must be another point, for the camera to look at",
        ));
    }
    // The picture's right direction is their cross product; below this angle it is made of rounding.
    const LEAST_ANGLE_RAD: f64 = 1e-6;
    if view.normalize().cross(up.normalize()).length() < LEAST_ANGLE_RAD {
        return Err(Error::new(
            format!("{key}.up"),
            "found the direction of view",
            "must be another direction",
        ));
    }
    Ok(())
}

fn render(render: &Render, key: &str) -> Check {
    for (i, &size) in render.size_px.iter().enumerate() {
        let key = format!("{key}.size_px[{i}]");
        within(&key, size.into(), limits::PICTURE_PX)?;
    }
    within(
        &format!("{key}.filter_std_px"),
        render.filter_std_px,
        limits::FILTER_STD_PX,
    )
}

fn material(material: &Material, key: &str) -> Check {
    within(
        &format!("{key}.roughness"),
        material.roughness,
        limits::ROUGHNESS,
    )?;
    let coherence = format!("{key}.coherence_um");
    within(&coherence, material.coherence_um, limits::COHERENCE_UM)?;
    if let Some(coat) = material.coat {
        within(&format!("{key}.clearcoat"), coat.weight, limits::CLEARCOAT)?;
        let roughness = format!("{key}.clearcoat_roughness");
        within(&roughness, coat.roughness, limits::ROUGHNESS)?;
    }
    if let Some(anisotropy) = material.anisotropy {
        let strength = format!("{key}.anisotropy");
        within(&strength, anisotropy.strength, limits::ANISOTROPY)?;
        let direction = format!("{key}.anisotropy_direction_deg");
        finite(&direction, anisotropy.direction_deg)?;
    }
    let color = |rgb: [f64; 3]| components(&format!("{key}.base_color"), rgb, limits::BASE_COLOR);
    match material.kind {
        MaterialKind::Metal(MetalColor::Measured(_)) | MaterialKind::Mirror => Ok(()),
        MaterialKind::Metal(MetalColor::Color(base_color)) => color(base_color),
        MaterialKind::Dielectric { ior, base_color } => {
            within(&format!("{key}.ior"), ior, limits::IOR)?;
            color(base_color)
        }
        MaterialKind::MetallicRoughness {
            base_color,
            metallic,
            specular,
        } => {
            within(&format!("{key}.metallic"), metallic, limits::METALLIC)?;
            let weight = format!("{key}.specular");
            within(&weight, specular.weight, limits::SPECULAR)?;
            let of_color = format!("{key}.specular_color");
            components(&of_color, specular.color, limits::SPECULAR)?;
            color(base_color)
        }
    }
}

fn object(object: &Object, key: &str) -> Check {
    point(&format!("{key}.translation_m"), object.translation_m)?;
    for (i, angle) in object.rotation_deg.into_iter().enumerate() {
        finite(&format!("{key}.rotation_deg[{i}]"), angle)?;
    }
    let scale = object.scale;
    let scale_key = |i: usize| match scale[0] == scale[1] && scale[1] == scale[2] {
        true => format!("{key}.scale"),
        false => format!("{key}.scale[{i}]"),
    };
    for (i, factor) in scale.into_iter().enumerate() {
        finite(&scale_key(i), factor)?;
        if !limits::SCALE.contains(&factor.abs()) {
            return Err(Error::new(
                scale_key(i),
                found(factor),
                "its size must be between 1e-6 and 1e6",
            ));
        }
    }
    if let Some(fit_m) = object.fit_m {
        size(&format!("{key}.fit_m"), fit_m)?;
    }
    if let Some(time_s) = object.time_s
        && !limits::TIME_S.contains(&time_s)
    {
        let right = "must be from 0 to 1e6";
        return Err(Error::new(format!("{key}.time_s"), found(time_s), right));
    }
    if object.animation.is_some() && object.time_s.is_none() {
        let right = "add one, such as `time_s = 0`: an animation is shown at a time";
        let found = "found no `time_s` beside it";
        return Err(Error::new(format!("{key}.animation"), found, right));
    }
    if let (Some(_), [_, ..]) = (&object.material, &object.overrides[..]) {
        return Err(Error::new(
            format!("{key}.overrides"),
            "found `material` beside it, of which all of the mesh is",
            "leave out one of the two",
        ));
    }
    let overrides = format!("{key}.overrides");
    each(&overrides, &object.overrides, Override::check_at)?;
    match (&object.surface, &object.material) {
        (Surface::Shape(shape), Some(_)) => shape.check_at(&format!("{key}.shape")),
        (Surface::Shape(_), None) => Err(Error::new(
            key,
            "`material` is missing",
            "a shape needs one; only a mesh brings its own",
        )),
        (Surface::Mesh(_), _) => Ok(()),
    }
}

fn scratches(scratches: &Scratches, key: &str) -> Check {
    match &scratches.layer {
        Layer::Laid(laid) => self::laid(laid, key)?,
        Layer::Brushed(brushed) => {
            drawn(brushed.seed, brushed.sizes(), key)?;
            jitter(brushed.jitter_deg, key)?;
        }
        Layer::Listed(_) => {}
    }
    place(&scratches.place, &format!("{key}.where"))?;
    let paints = matches!(scratches.layer, Layer::Brushed(_));
    each(&format!("{key}.strokes"), &scratches.strokes, |s, key| {
        stroke(s, paints, key)
    })
}

/// Refuses values out of range, and keys that need another one.
fn place(place: &LayerPlaces, key: &str) -> Check {
    let way = |name: &str| format!("{key}.{name}");
    let alone = |name: &str, right: &str| {
        let found = "found it without what it belongs to";
        Err(Error::new(way(name), found, right))
    };
    if let Some(tile_m) = place.tile_m {
        size(&way("tile_m"), tile_m)?;
        if place.files().next().is_none() {
            return alone("tile_m", "belongs to `mask` or `density`");
        }
    }
    within(&way("edges"), place.edges, limits::EDGES)?;
    if let Some(edge_width_m) = place.edge_width_m {
        size(&way("edge_width_m"), edge_width_m)?;
        if place.edges == 0.0 {
            return alone("edge_width_m", "belongs to `edges`, such as `edges = 0.8`");
        }
    }
    if let Some([least, most]) = place.radius_m {
        within(&way("radius_m[0]"), least, limits::PROFILE_RADIUS_M)?;
        within(&way("radius_m[1]"), most, limits::PROFILE_RADIUS_M)?;
        if least >= most {
            let found = format!("found {least} and {most}");
            let right = "the second must be the greater one";
            return Err(Error::new(way("radius_m"), found, right));
        }
    }
    match (place.center_m, place.radius_m) {
        (Some(_), None) => alone("center_m", "belongs to `radius_m`"),
        (Some(center_m), _) => point(&way("center_m"), center_m),
        (None, _) => Ok(()),
    }
}

/// Checks a stroke; `paints` says whether the layer takes strokes that lay scratches.
fn stroke(stroke: &Stroke, paints: bool, key: &str) -> Check {
    let points = format!("{key}.points_m");
    if !limits::STROKE_POINTS.contains(&stroke.points_m.len()) {
        let (least, most) = limits::STROKE_POINTS.into_inner();
        return Err(Error::new(
            points,
            format!("found {} points", stroke.points_m.len()),
            format!("must be from {least} to {most}"),
        ));
    }
    each(&points, &stroke.points_m, |p, key| point(key, *p))?;
    size(&format!("{key}.radius_m"), stroke.radius_m)?;
    match stroke.brush {
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
            not_negative(&format!("{key}.density_per_m"), density_per_m)?;
            within(&format!("{key}.width"), width, limits::STROKE_FACTOR)?;
            within(&format!("{key}.depth"), depth, limits::STROKE_FACTOR)
        }
    }
}

/// The seed of a layer that draws random numbers, and its lengths, widths and depths.
fn drawn(seed: u64, sizes: [Distribution; 3], key: &str) -> Check {
    check_seed(seed, key)?;
    sizes::check(sizes, key)
}

fn laid(laid: &Laid, key: &str) -> Check {
    if let Amount::DensityPerM2(density) = laid.amount {
        not_negative(&format!("{key}.density_per_m2"), density)?;
    }
    drawn(laid.seed, laid.sizes(), key)?;
    laid.pattern.check_at(key)
}

impl Pattern {
    /// Refuses values out of range; `key` is the way to the table that has the pattern.
    pub(super) fn check_at(&self, key: &str) -> Check {
        let jitter = |jitter_deg| jitter(jitter_deg, key);
        let around = |around: &Around| around.check_at(key);
        let curvature = |drawn: Distribution| {
            let way = format!("{key}.curvature_per_m");
            spread(&way, drawn, limits::CURVATURE_SPREAD_PER_M)?;
            within(&way, drawn.mean, limits::CURVATURE_PER_M)
        };
        match self {
            Self::Random { curvature_per_m } => curvature(*curvature_per_m),
            Self::Parallel {
                direction: along,
                jitter_deg,
            } => {
                direction(&format!("{key}.direction"), *along)?;
                jitter(*jitter_deg)
            }
            Self::Circular(axis) | Self::Radial(axis) => around(axis),
            Self::Spun {
                around: axis,
                curvature_per_m,
            } => {
                around(axis)?;
                curvature(*curvature_per_m)
            }
            Self::Swirl { curvature_per_m } => {
                curvature(*curvature_per_m)?;
                if curvature_per_m.mean == 0.0 {
                    return Err(Error::new(
                        format!("{key}.curvature_per_m"),
                        "found a mean of 0",
                        "swirls need one: one over their radius",
                    ));
                }
                Ok(())
            }
        }
    }
}

impl Around {
    /// Refuses values out of range; `key` is the way to the table that has the axis.
    pub(super) fn check_at(&self, key: &str) -> Check {
        direction(&format!("{key}.axis"), self.axis)?;
        point(&format!("{key}.center_m"), self.center_m)?;
        jitter(self.jitter_deg, key)
    }
}
