//! The lights of a model's file, which have no size, as lamps that have one.

use glam::DVec3;
use std::f64::consts::PI;

use crate::description::limits::{CONE_DEG, LARGEST_M, SMALLEST_M};
use crate::description::{Cone, Light, LightKind};
use crate::mesh_file::{Punctual, PunctualKind};

/// The radius of a lamp over the extent of its model: scratches show clear colours of it.
const LAMP_RADIUS: f64 = 0.01;
/// Of the sun as the earth sees it.
const SUN_RADIUS_RAD: f64 = 0.004_65;
/// How far off a sun stands: beyond any model that is shown.
const SUN_M: f64 = 500.0;
/// The extension counts in lumens. Exporters take a watt for as many of them.
const LUMENS_PER_WATT: f64 = 683.0;

/// What stands for a light beside a model of an extent, in metres of the file, that is shown larger by a factor and turned to be upright.
/// None where it would lie beyond what scenes hold.
pub(super) fn lamp(
    light: &Punctual,
    extent: f64,
    factor: f64,
    upright: impl Fn(DVec3) -> DVec3,
) -> Option<Light> {
    let towards = upright(light.direction).normalize_or(DVec3::NEG_Z);
    let watts = light.intensity / LUMENS_PER_WATT;
    let (center_m, radius_m, radiance) = match light.kind {
        PunctualKind::Directional => {
            let radius_m = SUN_M * SUN_RADIUS_RAD.sin();
            // What falls on a surface that faces it is that of the disc that is seen.
            (
                -SUN_M * towards,
                radius_m,
                watts / (PI * SUN_RADIUS_RAD.sin().powi(2)),
            )
        }
        PunctualKind::Point | PunctualKind::Spot { .. } => {
            let radius = LAMP_RADIUS * extent;
            let radiance = watts / (PI * radius * radius);
            (
                upright(light.position),
                (factor * radius).max(SMALLEST_M),
                radiance,
            )
        }
    };
    if center_m.abs().max_element() > LARGEST_M || !radiance.is_finite() {
        return None;
    }
    let cone = match light.kind {
        PunctualKind::Spot {
            inner_rad,
            outer_rad,
        } => {
            let cone_deg = (2.0 * outer_rad.to_degrees()).clamp(*CONE_DEG.start(), 180.0);
            Some(Cone {
                cone_softness: (1.0 - inner_rad / outer_rad.max(1e-9)).clamp(0.0, 1.0),
                ..Cone::new(
                    cone_deg,
                    Some((center_m + factor * extent * towards).into()),
                )
            })
        }
        PunctualKind::Point | PunctualKind::Directional => None,
    };
    Some(Light {
        name: light.name.clone(),
        radiance,
        color: light.color,
        cone,
        barn_doors_deg: None,
        picture: None,
        ..Light::new(LightKind::sphere(center_m.into(), radius_m))
    })
}
