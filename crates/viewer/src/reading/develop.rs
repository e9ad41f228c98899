//! Conversion of a render to the picture on the screen, by a reading.

use egui::ColorImage;
use hairline_image::{Display, Image, png};

use super::histogram::Histogram;
use super::layer_view::{self, Shows};

/// Choice of what is read from a render: a layer or a false colour, and findings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadingRequest {
    /// Layer or false colour on the screen.
    pub shows: Shows,
    /// Width and height of the middle part, which is the scene's picture, for its histogram; none without a histogram.
    pub histogram_px: Option<[u32; 2]>,
    /// Whether the brightness of lamps is looked for in which most of the scratches are noticed.
    pub tries_lamps: bool,
}

impl ReadingRequest {
    /// Whether the layers have to be in main memory.
    pub fn needs_layers(&self) -> bool {
        *self != Self::default()
    }
}

/// Findings about a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Histogram, if the reading includes one.
    pub histogram: Option<Histogram>,
    /// Nearest and farthest surface of a picture of depths, metres.
    pub depths_m: Option<[f32; 2]>,
    /// The share of the scratched pixels in which scratches are noticed; none where there are no such pixels.
    pub noticed: Option<f32>,
    /// The stops by which all light would have to change so that most of the scratches are noticed, and the share that then are; if the
    /// reading asks for it.
    pub best_lamps: Option<(i32, f32)>,
}

/// Stops that are tried.
const LAMP_STOPS: std::ops::RangeInclusive<i32> = -10..=2;

/// One pixel of so many is looked at.
const LOOKED_AT: usize = 7;

/// Converts a render to the picture on the screen, with the findings about it. `full_px` is the size of a picture at full
/// resolution.
pub(crate) fn develop(
    image: &Image,
    full_px: [u32; 2],
    display: &Display,
    wanted: &ReadingRequest,
) -> (ColorImage, Findings) {
    let size = image.size_px.map(|side| side as usize);
    let beauty = png::quantize(&image.beauty(), display);
    let histogram = wanted.histogram_px.map(|frame_px| {
        // A coarse picture shows the same part.
        let scale = |i: usize| {
            let share = f64::from(frame_px[i]) / f64::from(full_px[i].max(1));
            ((share * f64::from(image.size_px[i])).round() as u32).clamp(1, image.size_px[i])
        };
        Histogram::of(image, &beauty, display, [scale(0), scale(1)])
    });
    let (pixels, depths_m) = match wanted.shows {
        Shows::Beauty => (beauty, None),
        other => layer_view::pixels(image, other, display),
    };
    let findings = Findings {
        histogram,
        depths_m,
        noticed: noticed(image, display),
        best_lamps: wanted
            .tries_lamps
            .then(|| best_lamps(image, display))
            .flatten(),
    };
    (ColorImage::from_rgb(size, &pixels), findings)
}

fn noticed(image: &Image, display: &Display) -> Option<f32> {
    let (mut scratched, mut noticed) = (0, 0);
    for i in (0..image.pixel_count()).step_by(LOOKED_AT) {
        if image.density[i] == [0.0; 3] {
            continue;
        }
        scratched += 1;
        let (base, scratches) = (image.base[i], image.scratches[i]);
        let with = std::array::from_fn(|c| base[c] + scratches[c]);
        noticed += u32::from(display.is_noticed(base, with));
    }
    (scratched > 0).then(|| noticed as f32 / scratched as f32)
}

fn best_lamps(image: &Image, display: &Display) -> Option<(i32, f32)> {
    let shares = LAMP_STOPS.filter_map(|stops| {
        let exposure_ev = display.exposure_ev + f64::from(stops);
        let share = noticed(
            image,
            &Display {
                exposure_ev,
                ..*display
            },
        );
        Some((stops, share?))
    });
    // As they are, where others are hardly better.
    shares.max_by(|(a, x), (b, y)| {
        let worth = |stops: &i32, share: &f32| if *stops == 0 { 1.15 * share } else { *share };
        worth(a, x).total_cmp(&worth(b, y))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A base as bright as that of brushed metal under a lamp hides its scratches in white: dimmer lamps show them.
    #[test]
    fn dimmer_lamps_show_scratches_that_drown_in_white() {
        let mut image = Image::new([50, 10]);
        image.density.fill([0.1; 3]);
        image.base.fill([40.0; 3]);
        image.scratches.fill([30.0; 3]);
        let display = Display {
            exposure_ev: 0.0,
            tone_map: Default::default(),
        };
        assert_eq!(noticed(&image, &display), Some(0.0));
        let (stops, share) = best_lamps(&image, &display).unwrap();
        assert!(stops < -3 && share == 1.0, "{stops} {share}");
        // Where they show already, lamps stay as they are.
        image.base.fill([0.02; 3]);
        image.scratches.fill([0.2; 3]);
        assert_eq!(best_lamps(&image, &display), Some((0, 1.0)));
    }
}
