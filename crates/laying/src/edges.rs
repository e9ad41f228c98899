//! Measure of how far a place of a surface stands out, where things wear first.
//!
//! The measure is the surface's mean curvature about the place, which for a mesh is each edge's length times the angle by which it bends,
//! convex ones counted positive (David Cohen-Steiner, Jean-Marie Morvan, "Restricted Delaunay Triangulations and Normal Cycle", SoCG
//! 2003). Sharp edges and rounded ones count alike, and the noise of a scanned mesh, which bends both ways, nearly cancels.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use hairline_scene::Mesh;

use crate::neighbours::each_bend;

/// Longest piece of an edge, and width of the cubes in which pieces are merged, as a share of the reach.
const PIECE: f64 = 0.25;
/// Smaller bends are roundings.
const LEAST_BEND_RAD: f64 = 1e-6;
/// A piece counts for places that its side of the object faces. Of a right angle each face sees the other's edge just so.
const BEHIND_COS: f64 = -0.01;

/// The bends of a mesh, to be summed up about places.
#[derive(Debug)]
pub struct Edges {
    reach_m: f64,
    /// Pieces of edges in cubes as wide as the reach.
    cells: HashMap<[i32; 3], Vec<EdgePiece>>,
}

/// A piece of an edge, or several nearby.
#[derive(Clone, Copy, Debug)]
struct EdgePiece {
    middle_m: DVec3,
    /// Unit vector between the normals of the triangles at the edge; or zero.
    normal: DVec3,
    /// Length times angle.
    bend_m: f64,
}

/// Key of pieces that are merged: a cube, and the signs of their normals.
type PieceKey = ([i32; 3], [bool; 3]);

fn cube(point_m: DVec3, width_m: f64) -> [i32; 3] {
    (point_m / width_m).floor().as_ivec3().to_array()
}

impl Edges {
    /// Finds the edges of a mesh; each counts up to `reach_m` from it.
    pub fn new(mesh: &Mesh, reach_m: f64) -> Self {
        let piece_m = PIECE * reach_m;
        // Sums, weighted by the sizes of bends.
        let mut together: HashMap<PieceKey, (f64, EdgePiece)> = HashMap::new();
        each_bend(mesh, |bend| {
            let [from_m, to_m] = bend.ends_m(mesh);
            let angle_rad = angle_rad(bend.normals, to_m - from_m);
            if angle_rad.abs() < LEAST_BEND_RAD {
                return;
            }
            let normal = (bend.normals[0] + bend.normals[1]).normalize_or_zero();
            let length_m = from_m.distance(to_m);
            let count = (length_m / piece_m).ceil().max(1.0) as u32;
            // Each edge comes from both of its sides.
            let bend_m = 0.5 * length_m / f64::from(count) * angle_rad;
            for i in 0..count {
                let middle_m = from_m.lerp(to_m, (f64::from(i) + 0.5) / f64::from(count));
                let signs = normal.to_array().map(|c| c > 0.0);
                let place = (cube(middle_m, piece_m), signs);
                let (weight, sum) = together.entry(place).or_insert((
                    0.0,
                    EdgePiece {
                        middle_m: DVec3::ZERO,
                        normal: DVec3::ZERO,
                        bend_m: 0.0,
                    },
                ));
                *weight += bend_m.abs();
                sum.middle_m += bend_m.abs() * middle_m;
                sum.normal += bend_m.abs() * normal;
                sum.bend_m += bend_m;
            }
        });
        let mut cells: HashMap<[i32; 3], Vec<EdgePiece>> = HashMap::new();
        let mut together: Vec<_> = together.into_iter().collect();
        // Sums in a fixed order, so that scratches are the same each time.
        together.sort_unstable_by_key(|(place, _)| *place);
        for (_, (weight, sum)) in together {
            let middle_m = sum.middle_m / weight;
            cells
                .entry(cube(middle_m, reach_m))
                .or_default()
                .push(EdgePiece {
                    middle_m,
                    normal: sum.normal.normalize_or_zero(),
                    ..sum
                });
        }
        Self { reach_m, cells }
    }

    /// Computes how far a place of a facet of this unit normal stands out, from 0 to 1. At a distance d from a straight edge that bends by
    /// an angle it is (1 - d² / reach²)^1.5 times the angle's share of a right one; on a ball whose radius is R, 1.5 reach / R.
    pub fn prominence(&self, point_m: DVec3, normal: DVec3) -> f64 {
        let [x, y, z] = cube(point_m, self.reach_m);
        let mut sum_m = 0.0;
        for (dx, dy, dz) in (0..27).map(|i| (i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1)) {
            let cell = [x + dx, y + dy, z + dz];
            for piece in self.cells.get(&cell).into_iter().flatten() {
                let squared = piece.middle_m.distance_squared(point_m);
                let weight = 1.0 - squared / (self.reach_m * self.reach_m);
                if weight > 0.0 && piece.normal.dot(normal) >= BEHIND_COS {
                    sum_m += weight * piece.bend_m;
                }
            }
        }
        // A right angle through the place has this much.
        let whole_m = 4.0 / 3.0 * self.reach_m * FRAC_PI_2;
        (sum_m / whole_m).clamp(0.0, 1.0)
    }
}

/// Angle by which a surface bends at an edge, positive where it is convex. `axis` is along the edge with the first triangle to the left.
fn angle_rad([first, second]: [DVec3; 2], axis: DVec3) -> f64 {
    let cos = first.dot(second);
    let sin = first.cross(second).dot(axis.normalize_or_zero());
    let angle_rad = libm::atan2(sin, cos);
    // A sheet that is folded onto itself bends by half a turn outwards, whichever way it was rounded.
    match cos < -0.9999 {
        true => angle_rad.abs(),
        false => angle_rad,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::mesh;
    use std::f64::consts::PI;

    fn edges(shape: &str, reach_m: f64) -> Edges {
        Edges::new(&mesh(shape), reach_m)
    }

    #[test]
    fn a_right_angle_fades_as_its_closed_form() {
        // The second has its edge rounded: it bends about the middle of a quarter of a circle, so much within the corner.
        for (rounding_m, within_m) in [(0.0, 0.0), (0.001, 0.001 * (1.0 - 2.0 / PI))] {
            let shape = format!("box = {{ size_m = [0.2, 0.2, 0.2], rounding_m = {rounding_m} }}");
            let edges = edges(&shape, 0.01);
            for distance_m in [0.002f64, 0.005, 0.008, 0.011] {
                let point_m = DVec3::new(0.013, 0.1 - distance_m, 0.1);
                let off_m = (distance_m - within_m).hypot(within_m);
                let expected = (1.0 - (off_m / 0.01).powi(2)).max(0.0).powf(1.5);
                let found = edges.prominence(point_m, DVec3::Z);
                assert!(
                    (found - expected).abs() < 0.02,
                    "{rounding_m} {distance_m}: {found} {expected}"
                );
            }
            assert_eq!(edges.prominence(DVec3::new(0.0, 0.0, 0.1), DVec3::Z), 0.0);
        }
    }

    #[test]
    fn a_ball_stands_out_by_its_curvature() {
        let edges = edges("sphere = { radius_m = 0.1 }", 0.02);
        for direction in [DVec3::X, DVec3::new(0.48, 0.6, 0.64)] {
            let found = edges.prominence(0.1 * direction, direction);
            // 1.5 x 0.02 / 0.1, and what the ball's bend takes off the reach.
            assert!((found - 0.3).abs() < 0.015, "{found}");
        }
    }

    #[test]
    fn a_hollow_does_not() {
        // A lathe seen from within: a tube's inside, with a corner to its floor.
        let shape =
            "lathe = { profile_m = [[0.0, 0.0], [0.05, 0.0], [0.05, 0.1]], segments = 128 }";
        let edges = edges(shape, 0.01);
        assert_eq!(edges.prominence(DVec3::new(0.049, 0.0, 0.0), DVec3::Z), 0.0);
        assert_eq!(
            edges.prominence(DVec3::new(0.05, 0.0, 0.05), -DVec3::X),
            0.0
        );
    }

    #[test]
    fn the_far_side_of_a_sheet_does_not_count() {
        // 2 mm thick, a reach of 10 mm.
        let shape = "box = { size_m = [0.2, 0.2, 0.002] }";
        let edges = edges(shape, 0.01);
        let found = edges.prominence(DVec3::new(0.0, 0.095, 0.001), DVec3::Z);
        assert!((found - 0.75f64.powf(1.5)).abs() < 0.02, "{found}");
    }
}
