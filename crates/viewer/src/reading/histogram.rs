//! Histogram: numbers of pixels by radiance.

use hairline_image::tone_map::tone_luminance;
use hairline_image::{Display, Image};

use super::false_color::MIDDLE_GREY;

/// Stops from middle grey that the histogram spans.
pub(super) const STOPS: [f32; 2] = [-10.0, 6.0];
const BINS_PER_STOP: f32 = 8.0;
const BINS: usize = ((STOPS[1] - STOPS[0]) * BINS_PER_STOP) as usize;

/// Counts of exposed radiances by stops, for luminance, red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Counts for each eighth of a stop, from ten below middle grey to six above; values outside are counted at the
    /// ends.
    pub bins: Vec<[u32; 4]>,
    /// Pixels that were counted.
    pub pixels: u32,
    /// Share of the pixels with a channel at the display's white.
    pub white: f64,
    /// Share of the pixels with all channels at the display's black.
    pub black: f64,
    /// Share of the pixels without any light, which have no place on a scale of stops.
    pub unlit: f64,
}

impl Histogram {
    /// Counts the middle `frame_px` pixels of an image that is displayed as `codes`, three bytes a pixel.
    pub(super) fn count(
        image: &Image,
        codes: &[u8],
        display: &Display,
        frame_px: [u32; 2],
    ) -> Self {
        let gain = display.exposure_ev.exp2() as f32 / MIDDLE_GREY;
        let mut bins = vec![[0; 4]; BINS];
        let [width, height] = image.size_px;
        let [left, top] = [(width - frame_px[0]) / 2, (height - frame_px[1]) / 2];
        let [mut white, mut black, mut unlit] = [0_u32; 3];
        for y in top..top + frame_px[1] {
            for x in left..left + frame_px[0] {
                let i = image.index(x, y);
                let rgb: [f32; 3] =
                    std::array::from_fn(|c| gain * (image.base[i][c] + image.scratches[i][c]));
                let values = [tone_luminance(rgb), rgb[0], rgb[1], rgb[2]];
                unlit += u32::from(values.iter().all(|value| !(*value > 0.0)));
                for (channel, value) in values.into_iter().enumerate() {
                    if value > 0.0 {
                        bins[bin(value)][channel] += 1;
                    }
                }
                let code = &codes[3 * i..][..3];
                white += u32::from(code.contains(&255));
                black += u32::from(code.iter().all(|code| *code == 0));
            }
        }
        let pixels = frame_px[0] * frame_px[1];
        let share = |count: u32| f64::from(count) / f64::from(pixels.max(1));
        Self {
            bins,
            pixels,
            white: share(white),
            black: share(black),
            unlit: share(unlit),
        }
    }
}

/// Bin of a positive value in units of middle grey.
fn bin(value: f32) -> usize {
    (((value.log2() - STOPS[0]) * BINS_PER_STOP) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_image::png;

    #[test]
    fn pixels_are_counted_by_stops_and_clipped_ones_told() {
        let mut image = Image::new([4, 2]);
        // Outside of the frame, then middle grey, two stops above, far too bright; below: nothing, and a faint one.
        image.base = [1.0, 0.18, 0.72, 1e5, 1.0, 0.0, 0.18 / 2048.0, 0.18]
            .map(|value| [value; 3])
            .to_vec();
        image.base[7] = [0.36, 0.18, 0.0];
        let display = Display::default();
        let codes = png::quantize(&image.beauty(), &display);
        let of = |frame_px, display: &Display| Histogram::count(&image, &codes, display, frame_px);
        let all = of([4, 2], &display);
        assert_eq!(all.pixels, 8);
        let at = |stops: f32| ((stops - STOPS[0]) * BINS_PER_STOP) as usize;
        assert_eq!(all.bins[at(0.0)][2], 2, "green at middle grey");
        assert_eq!(all.bins[at(1.0)][1], 1, "red a stop above");
        assert_eq!(all.bins[BINS - 1][0], 1, "what is too bright is at the end");
        assert_eq!(all.bins[0][0], 1, "what is too faint at the other");
        assert_eq!(all.white, 1.0 / 8.0);
        assert_eq!(all.unlit, 1.0 / 8.0);
        assert!(all.black >= 1.0 / 8.0);
        let middle = of([2, 2], &display);
        assert_eq!((middle.pixels, middle.white), (4, 0.0));
        // A stop more of exposure moves all by a stop.
        let brighter = Display {
            exposure_ev: 1.0,
            ..display
        };
        assert_eq!(of([4, 2], &brighter).bins[at(1.0)][2], 2);
    }
}
