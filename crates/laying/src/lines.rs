//! Lines along smooth curves, laid onto the nearest places of a surface.

use glam::DVec3;
use hairline_scene::Segment;

use crate::curve::{Cubic, spline};
use crate::facet::Facet;
use crate::ground::Ground;
use crate::walk::{Course, MeshPoint, StraightPiece, Walker, join};

/// Distance of a curve from the surface, as a share of the object's diagonal, up to which it is moved onto it as it is.
const OFF_SURFACE: f64 = 1e-4;
/// A curve gets further points on the surface in so many rounds at most: each halves their distance.
const ROUNDS: usize = 8;
/// The longest piece of a curve that is laid as one, as a share of the object's diagonal: over an edge both ends of it are near.
const LONGEST: f64 = 1.0 / 256.0;
/// Steps in which a point is moved along a direction onto the surface, facet by facet.
const STEPS: usize = 16;
/// Least part of that direction across a facet.
const LEAST_ACROSS: f64 = 0.1;

/// A line before it is laid.
pub struct Outline {
    /// Curves that follow one another.
    pub cubics: Vec<Cubic>,
    /// Direction in which it is moved onto the surface, for what is off it.
    pub down: Option<DVec3>,
}

/// The smooth curve through points. It gets further points on the surface where it is off it, so that it follows the surface between distant
/// points.
pub fn smooth_curve(points_m: &[[f64; 3]], is_closed: bool, ground: &Ground) -> Vec<Cubic> {
    let onto_surface = |point_m: DVec3| {
        let (spot, _) = ground.closest().find(point_m);
        let is_under = ground.is_under(&spot, point_m);
        if is_under { spot.point_m } else { point_m }
    };
    let points = points_m.iter();
    let mut points: Vec<_> = points
        .map(|point| onto_surface(ground.point_in_world_m(*point)))
        .collect();
    points.dedup();
    if is_closed && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 2 {
        return Vec::new();
    }
    let most_m = OFF_SURFACE * ground.diagonal_m;
    for _ in 0..ROUNDS {
        let mut finer = Vec::new();
        let cubics = spline(&points, is_closed);
        for cubic in &cubics {
            let middle_m = cubic.middle();
            let on_surface_m = onto_surface(middle_m);
            finer.push(cubic.0[0]);
            finer.extend((on_surface_m.distance(middle_m) > most_m).then_some(on_surface_m));
        }
        if finer.len() == cubics.len() {
            return cubics;
        }
        finer.extend(points.last().filter(|_| !is_closed));
        finer.dedup();
        points = finer;
    }
    spline(&points, is_closed)
}

/// Lays a line of curves that follow one another, in as many runs as edges of the surface part it into.
pub fn lay_outline(ground: &Ground, outline: &Outline) -> Vec<(Course, Vec<Segment>)> {
    let Some(first) = outline.cubics.first() else {
        return Vec::new();
    };
    let mut points_m = vec![first.0[0]];
    for cubic in &outline.cubics {
        cubic.flatten(LONGEST * ground.diagonal_m, &mut points_m);
    }
    if let Some(down) = outline.down {
        for point_m in &mut points_m {
            *point_m = moved(ground, *point_m, down);
        }
    }
    let walker = ground.walker();
    let mut runs = runs(ground, &walker, &points_m);
    let mut course = Course::Open;
    if points_m.first() == points_m.last() {
        match runs.len() {
            1 => course = Course::Closed,
            _ => {
                // The part before the first edge goes on from that after the last one.
                let first = runs.swap_remove(0);
                join(&mut runs[0], first);
            }
        }
    }
    runs.into_iter()
        .filter_map(|run| {
            let mut segments = Vec::new();
            let course = walker.append(run, course, &mut segments);
            (!segments.is_empty()).then_some((course, segments))
        })
        .collect()
}

/// A point moved along a direction onto the surface. The nearest places of points that are far off would follow the edges of facets.
fn moved(ground: &Ground, mut point_m: DVec3, along: DVec3) -> DVec3 {
    for _ in 0..STEPS {
        let (spot, off_m) = ground.closest().find(point_m);
        let normal = Facet::new(&ground.mesh, spot.triangle).normal;
        let slope = along.dot(normal);
        if off_m == 0.0 || slope.abs() < LEAST_ACROSS {
            break;
        }
        let along_m = (spot.point_m - point_m).dot(normal) / slope;
        point_m += along * along_m;
        if along_m.abs() < 1e-12 {
            break;
        }
    }
    point_m
}

/// The ways on the surface along points: one, or several with edges between them that no way leads over. There is none beyond a rim.
fn runs(ground: &Ground, walker: &Walker, points_m: &[DVec3]) -> Vec<Vec<StraightPiece>> {
    let mut runs = vec![Vec::new()];
    let mut last: Option<(MeshPoint, bool)> = None;
    for point_m in points_m {
        let (spot, _) = ground.closest().find(*point_m);
        let is_on = ground.is_under(&spot, *point_m);
        if let Some((from, was_on)) = last {
            if from.point_m.distance(spot.point_m) < walker.shortest_piece_m {
                continue;
            }
            if is_on || was_on {
                walker.go(from, spot, &mut runs);
            }
            if !is_on {
                runs.push(Vec::new());
            }
        }
        last = Some((spot, is_on));
    }
    runs
}
