//! A polygon in the cosine's space.

use glam::DVec3;

use super::reflected::ltc_reflected;
use super::{LobeFresnel, LtcLobe, ltc_lobe};
use crate::fresnel::FresnelRgb;
use crate::irradiance::{PolygonIrradiance, irradiance_begin, irradiance_edge, irradiance_end};

/// Starts a polygon; see [`ltc_end`].
pub fn ltc_begin() -> PolygonIrradiance {
    irradiance_begin()
}

/// Adds the edge from `a` to `b`, positions relative to the point, in the local frame. Edges follow one another and close.
pub fn ltc_edge(state: &mut PolygonIrradiance, lobe: &LtcLobe, a: DVec3, b: DVec3) {
    irradiance_edge(
        state,
        lobe.to_cosine(lobe.rotate(a)),
        lobe.to_cosine(lobe.rotate(b)),
        lobe.to_cosine(lobe.rotate(b - a)),
    );
}

/// The vector irradiance of a polygon in the cosine's space.
pub fn ltc_vector(lobe: &LtcLobe, vertices: &[DVec3]) -> DVec3 {
    let mut state = ltc_begin();
    for (i, &a) in vertices.iter().enumerate() {
        ltc_edge(&mut state, lobe, a, vertices[(i + 1) % vertices.len()]);
    }
    irradiance_end(&state)
}

/// Returns the light that the lobe reflects of the polygon, in either orientation, as [`polygon_light`].
pub fn ltc_end(state: &PolygonIrradiance, lobe: &LtcLobe, of: &LobeFresnel) -> [f64; 3] {
    ltc_reflected(lobe, of, irradiance_end(state))
}

/// The integral of the GGX lobe (the cosine inside) times Fresnel's reflectance at the half vector over a simple polygon,
/// convex or not, cut by the horizon; single scattering. `wo` and the vertices (relative to the point) are in the local frame.
pub fn polygon_light(
    wo: DVec3,
    roughness: f64,
    fresnel: FresnelRgb,
    vertices: &[DVec3],
) -> [f64; 3] {
    let lobe = ltc_lobe(wo, roughness);
    let mut state = ltc_begin();
    for (i, &a) in vertices.iter().enumerate() {
        ltc_edge(&mut state, &lobe, a, vertices[(i + 1) % vertices.len()]);
    }
    ltc_end(&state, &lobe, &LobeFresnel::new(fresnel, wo, roughness))
}
