//! A tile of pixels as a graphics adapter's default path sees it: scratches are lines in the picture, with a bit for each pixel
//! that a line comes near to; that the shader leaves out pixels beyond a line's ends is left out here. Twin: crates/gpu/shaders/tiles.wgsl, shade_tiles.wgsl.

use glam::{DVec2, DVec3, Vec3};
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::REACH_STD;
use hairline_scene::CameraFrame;

/// Side of the tiles that share a walk.
pub const TILE_PX: u32 = 8;

// Of the shader: the line's distance is rounded, and the surface is a plane within a tile only nearly.
const MARGIN: f64 = 1.02;
const MARGIN_PX: f64 = 0.02;
/// Segments shorter than this have no line, and touch every pixel.
const LENGTH_MIN_PX: f64 = 0.05;

/// A segment in a tile's list.
pub struct Entry {
    pub segment: usize,
    line: Option<Line>,
}

/// What one walk finds for all pixels of a tile.
pub struct TileList {
    pub entries: Vec<Entry>,
    /// How far a line may be from a pixel that sees its scratch.
    pub reach_px: f64,
}

impl TileList {
    /// Whether the pixel with this middle finds the bit of an entry set.
    pub fn touches(&self, entry: &Entry, at_px: DVec2) -> bool {
        let near = |line: &Line| line.distance_px(at_px) <= self.reach_px;
        entry.line.as_ref().is_none_or(near)
    }
}

/// In the picture, pixels from its upper left corner.
struct Line {
    normal: DVec2,
    offset_px: f64,
}

impl Line {
    fn distance_px(&self, at_px: DVec2) -> f64 {
        (self.normal.dot(at_px) - self.offset_px).abs()
    }
}

/// A tile's entry for a segment; None if its line passes by all pixels.
pub fn entry(
    camera: &CameraFrame,
    index: usize,
    segment: &IndexedSegment,
    middle_px: DVec2,
    reach_px: f64,
) -> Option<Entry> {
    let line = line_of(camera, segment);
    // Half the diagonal of the pixels' centres, and a jitter.
    let within = 0.5_f64.sqrt() * f64::from(TILE_PX) + reach_px;
    let near = |line: &Line| line.distance_px(middle_px) <= within;
    line.as_ref().is_none_or(near).then_some(Entry {
        segment: index,
        line,
    })
}

/// None where an end is not in front of the camera, or both are in one place.
fn line_of(camera: &CameraFrame, segment: &IndexedSegment) -> Option<Line> {
    let start = seen_px(camera, segment.start_m)?;
    let along = seen_px(camera, segment.end_m)? - start;
    if along.length() <= LENGTH_MIN_PX {
        return None;
    }
    let normal = along.perp() / along.length();
    Some(Line {
        normal,
        offset_px: normal.dot(start),
    })
}

fn seen_px(camera: &CameraFrame, at_m: Vec3) -> Option<DVec2> {
    let relative = at_m.as_dvec3() - camera.position_m;
    let depth = relative.dot(camera.forward);
    let place = |per_px: DVec3| relative.dot(per_px) / (per_px.length_squared() * depth);
    let at = DVec2::new(place(camera.per_px_x), place(camera.per_px_y));
    (depth > 0.0).then_some(at + 0.5 * camera.size_px)
}

/// How far from a pixel a line may be whose scratch it sees; `steps_m` from it to the next pixel on the surface.
pub fn reach_px(steps_m: [DVec3; 2], filter_px: f64, coherence_um: f64) -> f64 {
    let [x, y] = steps_m;
    let mean = 0.5 * (x.length_squared() + y.length_squared());
    let product = x.length_squared() * y.length_squared() - x.dot(y).powi(2);
    // The side of a pixel where it is narrowest: the least singular value of its two steps.
    let narrowest2 = product / (mean + (mean * mean - product).max(0.0).sqrt());
    let window2 = 0.5 * (1e-6 * coherence_um).powi(2) / narrowest2;
    MARGIN * f64::from(REACH_STD) * (filter_px * filter_px + window2).sqrt() + MARGIN_PX
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::stage::Stage;

    #[test]
    fn a_ray_meets_the_picture_where_it_left_it() {
        let stage = Stage {
            scratches: 1,
            ..Stage::default()
        };
        let scene = stage.build().unwrap_or_else(|error| panic!("{error}"));
        let camera = scene.camera.frame(scene.render.size_px);
        for pixel in [DVec2::new(3.5, 700.5), DVec2::new(640.0, 360.0)] {
            let at = camera.position_m + 0.3 * camera.camera_ray(pixel);
            let seen = seen_px(&camera, at.as_vec3()).expect("in front");
            // Positions are of single precision: a hundred-millionth of a metre under pixels of 0.1 mm.
            assert!((seen - pixel).length() < 1e-3, "{pixel} {seen}");
        }
        let behind = camera.position_m - 0.3 * camera.forward;
        assert!(seen_px(&camera, behind.as_vec3()).is_none());
    }

    #[test]
    fn a_line_reaches_as_far_as_filter_and_window() {
        let steps = [DVec3::X * 1e-4, DVec3::Y * 2e-4];
        let fine = reach_px(steps, 0.0, 20.0);
        // 3.5 standard deviations of the window over the narrower side.
        let expected = 1.02 * 3.5 * 20e-6 / 2.0_f64.sqrt() / 1e-4 + 0.02;
        assert!((fine - expected).abs() < 1e-9, "{fine} {expected}");
        assert!(reach_px(steps, 0.3, 20.0) > fine);
    }
}
