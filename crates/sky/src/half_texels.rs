//! Rounding of maps to half floats.

use hairline_image::Picture;

/// The largest half float.
pub(super) const HALF_MAX: f32 = 65504.0;

/// Largest power of two by which a map is divided: with a larger one a single wrong texel would leave nothing of all others. The sun's disk
/// takes 2^15 in cd/m2, and a candela is then still exact to a part in a thousand.
const TEXEL_SCALE_MAX: f32 = 1048576.0;

/// Divides the map by the power of two that brings it below the largest half float, and cuts what stays above. Returns the power, and how
/// many texels were cut.
pub(super) fn fit_half(map: &mut Picture) -> (f64, usize) {
    let brightest = map.rgb.iter().flatten().fold(0.0_f32, |a, &b| a.max(b));
    let mut scale = 1.0;
    while brightest / scale > HALF_MAX && scale < TEXEL_SCALE_MAX {
        scale *= 2.0;
    }
    let mut cut = 0;
    for texel in &mut map.rgb {
        let scaled = texel.map(|c| c / scale);
        *texel = scaled.map(|c| c.min(HALF_MAX));
        cut += usize::from(*texel != scaled);
    }
    (f64::from(scale), cut)
}

/// Rounds to the values that a half-float texture holds.
pub(super) fn round_to_half(map: &mut Picture) {
    for c in map.rgb.iter_mut().flatten() {
        *c = half::f16::from_f32(c.min(HALF_MAX)).to_f32();
    }
}
