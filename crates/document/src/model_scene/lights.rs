//! The lights of a model's file, which have no size, as lamps that have one.

use glam::DVec3;
use std::f64::consts::PI;

use hairline_model::mesh_file::{Punctual, PunctualKind};

use super::fit::Fit;
use crate::description::{Cone, Light, LightKind, SUN_DEG};
use crate::schema::{LARGEST_M, SMALLEST_M};

/// Radius of a lamp over the extent of its model, small enough for scratches to show clear colours.
const LAMP_RADIUS: f64 = 0.01;
/// The extension counts in lumens. Exporters take a watt for as many of them.
const LUMENS_PER_WATT: f64 = 683.0;

/// Makes a lamp from a light of a model, which stands in its scene by `fit`.
///
/// # Errors
/// The reason why there is no lamp.
pub(super) fn lamp(light: &Punctual, fit: &Fit) -> Result<Light, String> {
    let towards = fit.turned(light.direction).normalize_or(DVec3::NEG_Z);
    let watts = light.intensity / LUMENS_PER_WATT;
    let of_kind = |kind: LightKind| Light {
        name: light.name.clone(),
        color: light.color,
        ..Light::new(kind)
    };
    let too_large = || "its intensity is too large for a number".to_owned();
    if light.kind == PunctualKind::Directional {
        if !watts.is_finite() {
            return Err(too_large());
        }
        return Ok(of_kind(LightKind::Sun {
            direction: towards.into(),
            angle_deg: SUN_DEG,
            irradiance: watts,
        }));
    }
    let radius = LAMP_RADIUS * fit.extent_m;
    let radiance = watts / (PI * radius * radius);
    let center_m = fit.placed_m(light.position);
    let radius_m = (fit.factor * radius).max(SMALLEST_M);
    // A point that is no number does not lie within either.
    if !center_m.abs().cmple(DVec3::splat(LARGEST_M)).all() {
        return Err(format!("it would stand over {LARGEST_M} m off"));
    }
    if !radiance.is_finite() {
        return Err(too_large());
    }
    let cone = match light.kind {
        PunctualKind::Spot {
            inner_rad,
            outer_rad,
        } => {
            let cone_deg =
                (2.0 * outer_rad.to_degrees()).clamp(*Cone::CONE_DEG.bounds.ends().start(), 180.0);
            Some(Cone {
                cone_softness: (1.0 - inner_rad / outer_rad.max(1e-9)).clamp(0.0, 1.0),
                ..Cone::new(
                    cone_deg,
                    Some((center_m + fit.factor * fit.extent_m * towards).into()),
                )
            })
        }
        PunctualKind::Point | PunctualKind::Directional => None,
    };
    Ok(Light {
        radiance,
        cone,
        ..of_kind(LightKind::sphere(center_m.into(), radius_m))
    })
}
