//! Maps in what half floats hold.

use hairline_image::Picture;

/// The largest half float.
const HALF_MAX: f32 = 65504.0;

/// The largest power of two by which maps are divided: dark parts of a brighter map would lose their bits.
const TEXEL_SCALE_MAX: f32 = 1024.0;

/// Divides the map by the power of two that brings it below the largest half float, and cuts what stays above.
pub(super) fn fit_half(map: &mut Picture) -> f64 {
    let brightest = map.rgb.iter().flatten().fold(0.0_f32, |a, &b| a.max(b));
    let mut scale = 1.0;
    while brightest / scale > HALF_MAX && scale < TEXEL_SCALE_MAX {
        scale *= 2.0;
    }
    for c in map.rgb.iter_mut().flatten() {
        *c = (*c / scale).min(HALF_MAX);
    }
    f64::from(scale)
}

/// Rounds to what a half-float texture holds.
pub(super) fn round_to_half(map: &mut Picture) {
    for c in map.rgb.iter_mut().flatten() {
        *c = half::f16::from_f32(c.min(HALF_MAX)).to_f32();
    }
}
