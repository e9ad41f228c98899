//! A picture on a flat light: where it is looked up, and how finely.
//!
//! E. Heitz, J. Dupuy, S. Hill, D. Neubelt, *Real-Time Polygonal-Light Shading with Linearly Transformed Cosines*, 2016: what a lobe reflects of a
//! light with a picture is what it reflects of an even one times one look-up in the blurred picture. Here the light is cut into sixteen parts, each
//! of which has a look-up, where its vector irradiance in the cosine's space points: the mean by their form factors is what an even light is
//! multiplied with. One look-up alone errs by 5 to 15 % of a soft box's brightest. Twin: picture.wgsl.

use glam::{DVec2, DVec3};

use crate::ltc::LtcLobe;

/// Parallelogram on which a picture lies, relative to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PicturePlane {
    /// Corner between the picture's left and lower edges.
    pub corner: DVec3,
    /// Vector along the lower edge.
    pub right: DVec3,
    /// Vector along the left edge.
    pub up: DVec3,
}

/// A look-up in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureLook {
    /// Position from the picture's left upper corner to the right and down, each from 0 to 1.
    pub uv: DVec2,
    /// Standard deviation of the blur over the root of the picture's area.
    pub spread: f64,
}

/// A cosine is as wide on a plane before it as a Gaussian of so many times the distance.
const COSINE_STD: f64 = 0.42;
/// Planes are seen no more slantwise.
const LEAST_COS: f64 = 0.05;

/// Parts of a picture along each side, for lobes and bodies.
pub const PICTURE_PARTS: usize = 4;

/// One over the square of the widest blur of a part, in its own widths: four texels in it, which still tell one side from the other.
const PART_WIDEST: f64 = 16.0;

/// Number of parts of a chord over a light with a picture; each part has one look-up at its middle.
pub const PICTURE_CELLS: usize = 12;
/// [`PICTURE_CELLS`] for a grating: its orders are narrower than a twelfth of a soft box.
pub const PICTURE_ROW_CELLS: usize = 48;
/// Scale of x as u = W q, as for an environment's cells.
const CELL_SCALE_UM: f64 = 0.3;
/// Standard deviation of a cell's blur over its length: half of an even chord's, because the blur also acts across the chord, which has no width.
const CELL_STD: f64 = 0.145;

impl PicturePlane {
    /// Makes the plane from a light's corners, counter-clockwise as seen from where it shines. The first is the left lower one.
    ///
    /// # Panics
    /// Panics with fewer than four corners.
    pub fn from_corners(corners: &[DVec3]) -> Self {
        Self {
            corner: corners[0],
            right: corners[1] - corners[0],
            up: corners[3] - corners[0],
        }
    }

    /// Counter-clockwise as seen from where it shines.
    pub fn corners(&self) -> [DVec3; 4] {
        let Self { corner, right, up } = *self;
        [corner, corner + right, corner + right + up, corner + up]
    }

    /// Part `i` of [`PICTURE_PARTS`]², row by row from below.
    pub fn picture_part(&self, i: usize) -> Self {
        let share = 1.0 / PICTURE_PARTS as f64;
        let (x, y) = ((i % PICTURE_PARTS) as f64, (i / PICTURE_PARTS) as f64);
        let (right, up) = (self.right * share, self.up * share);
        Self {
            corner: self.corner + right * x + up * y,
            right,
            up,
        }
    }

    /// Returns the position at which a direction meets the picture; beside the picture, that on its nearest edge.
    pub fn picture_uv(&self, toward: DVec3) -> DVec2 {
        let normal = self.right.cross(self.up);
        let per_area2 = 1.0 / normal.length_squared().max(1e-30);
        let along = toward.dot(normal);
        let least = 1e-9 * toward.length() / per_area2.sqrt();
        let along = along.abs().max(least).copysign(along);
        let place = toward * (self.corner.dot(normal) / along) - self.corner;
        let right = place.cross(self.up).dot(normal) * per_area2;
        let up = self.right.cross(place).dot(normal) * per_area2;
        DVec2::new(right, 1.0 - up).clamp(DVec2::ZERO, DVec2::ONE)
    }

    /// Returns the look-up for the mean of the picture under a cosine about the normal, given the picture's vector irradiance.
    pub fn picture_look(&self, vector: DVec3) -> PictureLook {
        let normal = self.right.cross(self.up);
        let area = normal.length().max(1e-30);
        let toward = vector.normalize_or(DVec3::Z);
        let cos = (toward.dot(normal).abs() / area).max(LEAST_COS);
        let distance = self.corner.dot(normal).abs() / area / cos;
        PictureLook {
            uv: self.picture_uv(toward),
            spread: COSINE_STD * distance / (cos * area).sqrt(),
        }
    }

    /// Returns the look-up for a lobe; the vector irradiance is that in the cosine's space.
    pub fn picture_on_lobe(&self, lobe: &LtcLobe, vector: DVec3) -> PictureLook {
        let in_cosine = |w: DVec3| lobe.to_cosine(lobe.rotate(w));
        let plane = Self {
            corner: in_cosine(self.corner),
            right: in_cosine(self.right),
            up: in_cosine(self.up),
        };
        plane.picture_look(vector)
    }

    /// Look-up for a part of a chord, by the directions of the part's ends and its middle. `across_std` is the standard deviation of the band about
    /// the chord, in direction cosines.
    pub fn picture_on_chord(
        &self,
        [low, middle, high]: [DVec3; 3],
        across_std: f64,
    ) -> PictureLook {
        let length = self.picture_uv(low).distance(self.picture_uv(high));
        // Share of the chord's length; across the chord the picture is about as far away.
        let share = across_std / low.distance(high).max(1e-30);
        PictureLook {
            uv: self.picture_uv(middle),
            spread: CELL_STD.max(share) * length,
        }
    }
}

/// Left upper corner of part `i` in the picture; each side is one over [`PICTURE_PARTS`].
pub fn picture_part_uv(i: usize) -> DVec2 {
    let (x, y) = (i % PICTURE_PARTS, PICTURE_PARTS - 1 - i / PICTURE_PARTS);
    DVec2::new(x as f64, y as f64) / PICTURE_PARTS as f64
}

/// Spread of a part's look-up, over the root of the whole picture's area, from `spread` over the root of the part's area. No part spreads further
/// than its own width.
pub fn picture_part_spread(spread: f64) -> f64 {
    spread / (1.0 + PART_WIDEST * spread * spread).sqrt() / PICTURE_PARTS as f64
}

/// The level of a picture's mip chain for a blur: level 0 serves half a texel.
pub fn picture_lod(spread: f64, size_px: DVec2) -> f64 {
    let texels = spread * (size_px.x * size_px.y).sqrt();
    (2.0 * texels).max(1.0).log2()
}

/// A place between `low` and `high` in q at a share of the way, even in x = q / (|q| + h) as an environment's cells are.
pub fn picture_place(share: f64, low: f64, high: f64, width_um: f64) -> f64 {
    let scale = CELL_SCALE_UM / width_um.max(1e-3);
    let from = low / (low.abs() + scale);
    let to = high / (high.abs() + scale);
    let x = from + (to - from) * share;
    let q = scale * x / (1.0 - x.abs()).max(1e-9);
    // Rounding must not leave out a part.
    if share <= 0.0 {
        low
    } else if share >= 1.0 {
        high
    } else {
        q.clamp(low.min(high), high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners and the middle are found from anywhere; directions beside the picture find an edge.
    #[test]
    fn directions_find_their_places() {
        let plane = PicturePlane {
            corner: DVec3::new(-1.0, 0.5, 2.0),
            right: DVec3::new(2.0, 0.2, 0.4),
            up: DVec3::new(-0.1, 1.0, 0.3),
        };
        for (right, up) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.2, 0.9)] {
            let place = plane.corner + right * plane.right + up * plane.up;
            let uv = plane.picture_uv(place.normalize());
            assert!((uv - DVec2::new(right, 1.0 - up)).length() < 1e-12, "{uv}");
        }
        let beside = plane.corner - plane.right + 0.5 * plane.up;
        assert!((plane.picture_uv(beside) - DVec2::new(0.0, 0.5)).length() < 1e-12);
    }

    #[test]
    fn cells_tile_a_chord() {
        for (low, high) in [(-0.8, 0.3), (0.01, 0.02), (-0.5, -0.1)] {
            for width_um in [0.0, 1.0, 50.0] {
                let place =
                    |i: usize| picture_place(i as f64 / PICTURE_CELLS as f64, low, high, width_um);
                let ends: Vec<f64> = (0..=PICTURE_CELLS).map(place).collect();
                assert_eq!([ends[0], ends[PICTURE_CELLS]], [low, high]);
                assert!(ends.is_sorted(), "{ends:?}");
            }
        }
    }
}
