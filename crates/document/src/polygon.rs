//! Whether vertices make a polygon that can be a light: planar, simple, with an area.

use glam::{DVec2, DVec3};
use hairline_scene::vector_area_m2;

/// Largest distance of vertices from the plane, relative to the polygon's extent: twice the rounding to four digits.
const FLATNESS: f64 = 1e-3;
/// Smaller areas than this share of the squared extent have no direction to face.
const LEAST_AREA: f64 = 1e-9;
/// Each pair of edges is looked at, so the number is bounded.
const MOST_VERTICES: usize = 4096;

/// An error of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Flaw {
    #[error("found {0} vertices")]
    Count(usize),
    #[error("found two equal vertices, number {0} and the next (counted from 0)")]
    Repeated(usize),
    #[error("found a polygon without area")]
    NoArea,
    #[error(
        "found a polygon that is not planar: vertex {vertex} (counted from 0) is {distance_m:.2e} m off its plane"
    )]
    NotPlanar { vertex: usize, distance_m: f64 },
    #[error(
        "found a polygon that crosses itself: the edges after vertices {0} and {1} (counted from 0) meet"
    )]
    Crossing(usize, usize),
}

impl Flaw {
    /// Description of what would be right.
    pub(crate) fn remedy(self) -> &'static str {
        match self {
            Flaw::Count(n) if n > MOST_VERTICES => "must be at most 4096",
            Flaw::Count(_) => "must be at least three",
            Flaw::Repeated(_) => "leave one out",
            Flaw::NoArea => "its vertices must span an area",
            Flaw::NotPlanar { .. } => "all vertices must lie in one plane; split it into triangles",
            Flaw::Crossing(..) => "its edges must meet at vertices only; reorder the vertices",
        }
    }
}

/// Corners of the polygon that stands for a disk.
const DISK_CORNERS: usize = 24;

/// A regular polygon of the area of a disk with two half axes.
pub(crate) fn disk_corners_m(center_m: DVec3, x_m: DVec3, y_m: DVec3) -> Vec<DVec3> {
    let step = std::f64::consts::TAU / DISK_CORNERS as f64;
    let out = (step / step.sin()).sqrt();
    let corner = |i: usize| {
        let (sin, cos) = (step * i as f64).sin_cos();
        center_m + out * (cos * x_m + sin * y_m)
    };
    (0..DISK_CORNERS).map(corner).collect()
}

/// Refuses vertices that make no planar, simple polygon.
pub(crate) fn check(vertices_m: &[DVec3]) -> Result<(), Flaw> {
    let n = vertices_m.len();
    if !(3..=MOST_VERTICES).contains(&n) {
        return Err(Flaw::Count(n));
    }
    if let Some(i) = (0..n).find(|&i| vertices_m[i] == vertices_m[(i + 1) % n]) {
        return Err(Flaw::Repeated(i));
    }
    let mean = vertices_m.iter().sum::<DVec3>() / n as f64;
    let extent_m = vertices_m
        .iter()
        .map(|v| v.distance(mean))
        .fold(0.0, f64::max);

    // A figure of eight has lobes that cancel: look for crossings before the area is judged, in the plane of the largest
    // triangle rather than that of the vector area.
    let normal = widest_normal(vertices_m, mean);
    if normal.length() < LEAST_AREA * extent_m * extent_m {
        return Err(Flaw::NoArea);
    }
    let normal = normal.normalize();
    for (vertex, v) in vertices_m.iter().enumerate() {
        let distance_m = (v - mean).dot(normal).abs();
        if distance_m > FLATNESS * extent_m {
            return Err(Flaw::NotPlanar { vertex, distance_m });
        }
    }
    let (x, y) = normal.any_orthonormal_pair();
    let flat: Vec<_> = vertices_m
        .iter()
        .map(|v| DVec2::new((v - mean).dot(x), (v - mean).dot(y)))
        .collect();
    for i in 0..n {
        for j in i + 1..n {
            let neighbours = j == i + 1 || (i == 0 && j == n - 1);
            let [a, b] = [flat[i], flat[(i + 1) % n]];
            let [c, d] = [flat[j], flat[(j + 1) % n]];
            let meet = match neighbours {
                false => segments_meet(a, b, c, d),
                // Neighbours share a vertex; they must not run back over each other.
                true if j == i + 1 => folds_back(a, b, d),
                true => folds_back(c, d, b),
            };
            if meet {
                return Err(Flaw::Crossing(i, j));
            }
        }
    }
    if vector_area_m2(vertices_m).length() < LEAST_AREA * extent_m * extent_m {
        return Err(Flaw::NoArea);
    }
    Ok(())
}

/// The longest cross product of the arms from `mean` to two vertices that follow each other.
fn widest_normal(vertices_m: &[DVec3], mean: DVec3) -> DVec3 {
    let n = vertices_m.len();
    (0..n)
        .map(|i| (vertices_m[i] - mean).cross(vertices_m[(i + 1) % n] - mean))
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .unwrap_or(DVec3::ZERO)
}

fn segments_meet(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (c_side, d_side) = (side(a, b, c), side(a, b, d));
    let (a_side, b_side) = (side(c, d, a), side(c, d, b));
    if c_side == 0.0 && d_side == 0.0 {
        // On one line: they meet if their extents overlap.
        let along = b - a;
        let [mut from, mut to] = [(c - a).dot(along), (d - a).dot(along)];
        if from > to {
            std::mem::swap(&mut from, &mut to);
        }
        return to >= 0.0 && from <= along.length_squared();
    }
    c_side * d_side <= 0.0 && a_side * b_side <= 0.0
}

/// Whether the way from a to b turns straight back towards a on its way to d.
fn folds_back(a: DVec2, b: DVec2, d: DVec2) -> bool {
    let (back, on) = (a - b, d - b);
    back.perp_dot(on) == 0.0 && back.dot(on) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|p| DVec3::new(p[0], p[1], 0.3)).collect()
    }

    #[test]
    fn simple_polygons_pass_convex_or_not() {
        for points in [
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][..],
            &[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]],
            // An L, and a chevron whose vertices' mean lies outside it.
            &[
                [0.0, 0.0],
                [2.0, 0.0],
                [2.0, 1.0],
                [1.0, 1.0],
                [1.0, 2.0],
                [0.0, 2.0],
            ],
            &[[0.0, 0.0], [2.0, 2.0], [0.0, 0.5], [-2.0, 2.0]],
        ] {
            assert_eq!(check(&flat(points)), Ok(()), "{points:?}");
        }
    }

    #[test]
    fn flawed_polygons_are_told_apart() {
        assert_eq!(check(&flat(&[[0.0, 0.0], [1.0, 0.0]])), Err(Flaw::Count(2)));
        assert_eq!(
            check(&flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])),
            Err(Flaw::Repeated(1))
        );
        assert_eq!(
            check(&flat(&[[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]])),
            Err(Flaw::NoArea)
        );
        let bow_tie = flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(check(&bow_tie), Err(Flaw::Crossing(0, 2)));
        let spike = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(check(&spike), Err(Flaw::Crossing(1, 2)));
        let mut bent = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        bent[2].z += 0.2;
        assert!(matches!(check(&bent), Err(Flaw::NotPlanar { .. })));
    }
}
