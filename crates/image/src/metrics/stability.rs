//! Steadiness of a sequence of pictures: whether a point of a surface looks from one frame to the next as it did.
//!
//! Each frame is compared with the one before it, moved to where its surfaces are now (by depth and camera; bilinear). The figure
//! is the mean FLIP ([`super::flip`]) over all pixels of all frames but the first whose surface the frame before shows too; without
//! the feature `flip` the root mean square of the difference over that of the frame. What was hidden, what lay outside
//! the picture, background and edges are left out, and make no difference.
//!
//! It is not 0 for a perfect renderer: highlights move over surfaces, scratches light up and go out as they do in reality,
//! and moving a frame blurs it. So it is read beside the figure of the same frames rendered with many samples.

use super::away_from_silhouettes;
use crate::{Display, Image, Picture};

/// Largest difference of depths, as a share of depth, at which a surface counts as the same one in the next frame.
const SAME_DEPTH: f64 = 0.01;
/// Neighbours whose depths differ by more than this share are of two surfaces: a slope has less, in all but tiny pictures.
const EDGE: f64 = 0.05;

/// Mapping of a point of a surface, seen at a pixel (from the upper left corner, pixel centres at half-integers) and a depth in
/// metres in one frame, to its pixel and depth in another; none behind the camera.
pub(crate) type Move<'a> = &'a (dyn Fn([f64; 2], f64) -> Option<([f64; 2], f64)> + Sync);

/// The figure of a sequence, frame by frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stability {
    sum: f64,
    pixels: usize,
}

impl Stability {
    /// Adds a frame and the one before it; `to_previous` leads from this one to that one.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn add(
        &mut self,
        frame: &Image,
        previous: &Image,
        display: &Display,
        to_previous: Move<'_>,
    ) {
        assert_eq!(frame.size_px, previous.size_px, "frames of different sizes");
        let (moved, seen) = moved(frame, previous, to_previous);
        let pixels = seen.iter().filter(|seen| **seen).count();
        if pixels > 0 {
            self.sum += pixels as f64 * difference(&frame.beauty(), &moved, display, &seen);
            self.pixels += pixels;
        }
    }

    /// 0 for a sequence that does not change. None if no pixel could be followed.
    pub fn mean(&self) -> Option<f64> {
        (self.pixels > 0).then(|| self.sum / self.pixels as f64)
    }

    /// Pixels that could be followed, over all frames.
    pub fn pixels(&self) -> usize {
        self.pixels
    }
}

fn difference(frame: &Picture, moved: &Picture, display: &Display, seen: &[bool]) -> f64 {
    super::flip(moved, frame, display, Some(seen)).map_or(0.0, |flip| flip.mean)
}

/// The frame before, where its surfaces are in `frame`, and where that is known; elsewhere `frame` itself, so that neighbours see
/// no difference there.
fn moved(frame: &Image, previous: &Image, to_previous: Move<'_>) -> (Picture, Vec<bool>) {
    let [now, before] = [frame, previous].map(Image::beauty);
    let inside = away_from_silhouettes(frame, frame, EDGE as f32);
    let width = frame.size_px[0].max(1) as usize;
    let mut moved = now;
    let mut seen = vec![false; frame.pixel_count()];
    for (i, (rgb, seen)) in moved.rgb.iter_mut().zip(&mut seen).enumerate() {
        if !inside[i] || !(frame.depth_m[i] > 0.0) {
            continue;
        }
        let pixel = [(i % width) as f64 + 0.5, (i / width) as f64 + 0.5];
        let depth_m = f64::from(frame.depth_m[i]);
        if let Some(there) = to_previous(pixel, depth_m)
            && let Some(was) = bilinear(&before, &previous.depth_m, there)
        {
            *rgb = was;
            *seen = true;
        }
    }
    (moved, seen)
}

/// Bilinear mean of the four pixels around a place, if they show one surface at that depth.
fn bilinear(
    picture: &Picture,
    depths_m: &[f32],
    ([x, y], depth_m): ([f64; 2], f64),
) -> Option<[f32; 3]> {
    let [width, height] = picture.size_px.map(|side| i64::from(side) - 1);
    // A camera that stands still leads to the pixel's middle but for rounding, and the last pixel's has no neighbour.
    let [x, y] = [x - 0.5, y - 0.5].map(|place| {
        let middle = place.round();
        if (place - middle).abs() < 1e-9 {
            middle
        } else {
            place
        }
    });
    let (mut sum, mut sum_m) = ([0.0; 3], 0.0);
    for (column, row) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let (column, row) = (x.floor() + column as f64, y.floor() + row as f64);
        let weight = (1.0 - (x - column).abs()) * (1.0 - (y - row).abs());
        if !(weight > 0.0) {
            continue;
        }
        let inside = (0.0..=width as f64).contains(&column) && (0.0..=height as f64).contains(&row);
        if !inside {
            return None;
        }
        let i = row as usize * (width + 1) as usize + column as usize;
        let there_m = f64::from(depths_m[i]);
        if !((there_m - depth_m).abs() <= EDGE * depth_m) {
            return None;
        }
        sum_m += weight * there_m;
        for (sum, value) in sum.iter_mut().zip(picture.rgb[i]) {
            *sum += weight * f64::from(value);
        }
    }
    ((sum_m - depth_m).abs() <= SAME_DEPTH * depth_m).then(|| sum.map(|value| value as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE_PX: [u32; 2] = [48, 32];

    /// A surface with waves of light on it, seen from straight above, `right_px` pixels farther to the left.
    fn frame(right_px: f64, light: impl Fn(f64, f64) -> f64) -> Image {
        let mut image = Image::new(SIZE_PX);
        for y in 0..SIZE_PX[1] {
            for x in 0..SIZE_PX[0] {
                let i = image.index(x, y);
                let value = light(f64::from(x) - right_px, f64::from(y));
                image.base[i] = [value as f32; 3];
                image.depth_m[i] = 2.0;
            }
        }
        image
    }

    fn waves(x: f64, y: f64) -> f64 {
        0.3 + 0.1 * (0.2 * x).sin() + 0.1 * (0.15 * y).cos()
    }

    fn figure(frames: &[Image], step_px: f64) -> f64 {
        let mut stability = Stability::default();
        for pair in frames.windows(2) {
            stability.add(
                &pair[1],
                &pair[0],
                &Display::default(),
                &|[x, y], depth_m| Some(([x - step_px, y], depth_m)),
            );
        }
        stability.mean().expect("pixels that can be followed")
    }

    #[test]
    fn what_stands_still_is_0() {
        let frames = [0, 1, 2].map(|_| frame(0.0, waves));
        assert_eq!(figure(&frames, 0.0), 0.0);
    }

    #[test]
    fn what_moves_as_the_camera_says_is_0_and_else_not() {
        let whole = [0.0, 3.0, 6.0].map(|right_px| frame(right_px, waves));
        assert!(figure(&whole, 3.0) < 1e-6);
        assert!(figure(&whole, 0.0) > 1e-2);
        // Between pixels the waves are blurred by their curvature: 0.1 (0.2)^2 / 8 of 0.3 at most.
        let part = [0.0, 2.5, 5.0].map(|right_px| frame(right_px, waves));
        assert!(figure(&part, 2.5) < 5e-3, "{}", figure(&part, 2.5));
    }

    #[test]
    fn flicker_is_seen_and_more_of_it_is_more() {
        let flickering = |share: f64| {
            let frames: Vec<Image> = (0..4)
                .map(|i| {
                    let sign = if i % 2 == 0 { share } else { -share };
                    frame(f64::from(i), |x, y| waves(x, y) * (1.0 + sign))
                })
                .collect();
            figure(&frames, 1.0)
        };
        let [none, little, much] = [0.0, 0.03, 0.12].map(flickering);
        assert!(none < 1e-6, "{none}");
        assert!(little > 1e-3 && much > 2.0 * little, "{little} {much}");
    }

    #[test]
    fn what_was_hidden_or_outside_or_is_background_is_left_out() {
        let before = frame(0.0, waves);
        let mut now = frame(0.0, |_, _| 1.0);
        let add = |now: &Image, to_previous: Move<'_>| {
            let mut stability = Stability::default();
            stability.add(now, &before, &Display::default(), to_previous);
            (stability.pixels(), stability.mean())
        };
        let stay: Move<'_> = &|pixel, depth_m| Some((pixel, depth_m));
        let all = SIZE_PX[0] as usize * SIZE_PX[1] as usize;
        let (pixels, mean) = add(&now, stay);
        assert!(mean.unwrap() > 0.1);
        assert_eq!(pixels, all);
        let hidden: Move<'_> = &|pixel, depth_m| Some((pixel, 1.02 * depth_m));
        assert_eq!(add(&now, hidden), (0, None));
        let behind: Move<'_> = &|_, _| None;
        assert_eq!(add(&now, behind), (0, None));
        let outside: Move<'_> = &|[x, y], depth_m| Some(([x - 40.0, y], depth_m));
        assert_eq!(add(&now, outside).0, 8 * SIZE_PX[1] as usize);
        now.depth_m.fill(0.0);
        assert_eq!(add(&now, stay), (0, None));
    }
}
