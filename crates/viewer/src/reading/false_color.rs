//! False colour: the exposure of each pixel, in stops from middle grey.

use hairline_image::tone_map::{tone_luminance, tone_sanitize};
use hairline_image::{Display, Picture};

/// Middle between black and white of an exposure meter.
pub(super) const MIDDLE_GREY: f32 = 0.18;

/// Stops at the ends of the scale.
pub(super) const STOPS: [f32; 2] = [-6.0, 6.0];

/// A colour for each stop of the scale: violet and blue for dark pixels, grey at middle grey, yellow, red and white for bright
/// ones. Displayed codes.
const COLORS: [[u8; 3]; 13] = [
    [18, 6, 40],
    [48, 18, 110],
    [58, 44, 176],
    [40, 92, 206],
    [26, 146, 198],
    [34, 168, 120],
    [128, 128, 128],
    [150, 196, 60],
    [226, 214, 46],
    [246, 164, 34],
    [238, 92, 32],
    [206, 24, 48],
    [255, 255, 255],
];

/// The colour of an exposure, displayed codes; in between it is mixed.
pub(super) fn color(stops: f32) -> [u8; 3] {
    let place = (stops.clamp(STOPS[0], STOPS[1]) - STOPS[0]).max(0.0);
    let (below, share) = (place.floor() as usize, place.fract());
    let [a, b] = [below, below + 1].map(|i| COLORS[i.min(COLORS.len() - 1)]);
    std::array::from_fn(|i| {
        (f32::from(a[i]) * (1.0 - share) + f32::from(b[i]) * share).round() as u8
    })
}

/// Number of stops from middle grey of a radiance after exposure; negative infinity for zero.
pub(super) fn stops(radiance: [f32; 3], display: &Display) -> f32 {
    let luminance = tone_sanitize(tone_luminance(radiance)).max(0.0);
    display.exposure_ev as f32 + (luminance / MIDDLE_GREY).log2()
}

/// The codes of a picture in false colour, three bytes a pixel.
pub(super) fn pixels(picture: &Picture, display: &Display) -> Vec<u8> {
    let colors = picture.rgb.iter().map(|rgb| color(stops(*rgb, display)));
    colors.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middle_grey_is_grey_and_each_stop_has_its_color() {
        let display = Display::default();
        let seen = |value: f32| color(stops([value; 3], &display));
        assert_eq!(seen(0.18), [128; 3]);
        assert_eq!(seen(0.36), COLORS[7]);
        assert_eq!(seen(0.18 / 8.0), COLORS[3]);
        assert_eq!(seen(0.0), COLORS[0]);
        assert_eq!(seen(f32::NAN), COLORS[0]);
        assert_eq!(seen(f32::INFINITY), COLORS[12]);
        // Exposure counts.
        let darker = Display {
            exposure_ev: -1.0,
            ..display
        };
        assert_eq!(color(stops([0.36; 3], &darker)), [128; 3]);
    }
}
