//! A layer of engraved lines: each is a scratch along a smooth curve, which is laid onto the nearest places of the surface.
//!
//! Lines are few, so all of them are laid when the layer is made ready.

use std::path::Path;

use glam::DVec3;
use hairline_scene::Segment;
use kurbo::{PathSeg, Point};
use rayon::prelude::*;

use super::curve::{Cubic, spline};
use super::facet::Facet;
use super::ground::Ground;
use super::laying::{Groove, Laying, scratch_profile};
use super::outlines::{self, Stamp};
use super::random::Stream;
use super::walk::{Course, MeshPoint, StraightPiece, Walker, join};
use crate::description::{Engraved, Line};
use crate::error::Error;
use crate::loader::Loader;
use crate::schema::scratches;

/// Distance of a curve from the surface, as a share of the object's diagonal, up to which it is moved onto it as it is.
const OFF_SURFACE: f64 = 1e-4;
/// A curve gets further points on the surface in so many rounds at most: each halves their distance.
const ROUNDS: usize = 8;
/// The longest piece of a curve that is laid as one, as a share of the object's diagonal: over an edge both ends of it are near.
const LONGEST: f64 = 1.0 / 256.0;

/// Least part of a direction that leads along the surface.
const LEAST_ALONG: f64 = 1e-3;
/// Steps in which a point is moved along a direction onto the surface, facet by facet.
const STEPS: usize = 16;
/// Least part of that direction across a facet.
const LEAST_ACROSS: f64 = 0.1;
/// Lines that are laid between two looks at whether to give up.
const TOGETHER: usize = 64;

/// Engraved lines on the ground that they go on.
pub(super) struct Engraving<'a> {
    layer: &'a Engraved,
    /// Number that distinguishes layers of one seed.
    number: u64,
    ground: &'a Ground,
    runs: Vec<Run>,
}

/// A line, or the part of it up to an edge of the surface.
struct Run {
    /// Number of the line: its parts are alike.
    line: u64,
    course: Course,
    segments: Vec<Segment>,
}

impl<'a> Engraving<'a> {
    /// `table` is the way to the layer.
    pub(super) fn new(
        loader: &Loader,
        layer: &'a Engraved,
        number: u64,
        ground: &'a Ground,
        table: &str,
        base_dir: &Path,
    ) -> Result<Self, Error> {
        let key = format!("{table}.{}", layer.line.key().name);
        let lines = match &layer.line {
            Line::Curve { points_m, closed } => {
                for (i, point) in points_m.iter().enumerate() {
                    ground.refuse_far(*point, ground.diagonal_m, || format!("{key}[{i}]"))?;
                }
                vec![Outline {
                    cubics: through(points_m, *closed, ground),
                    down: None,
                }]
            }
            Line::Text {
                text,
                height_m,
                center_m,
                direction,
            } => {
                let plate = Plate::new(ground, *center_m, *direction, table)?;
                let letters = outlines::letters(text, *height_m);
                letters.iter().flat_map(|it| plate.stamped(it)).collect()
            }
            Line::Svg {
                file,
                fit_m,
                center_m,
                direction,
            } => {
                let plate = Plate::new(ground, *center_m, *direction, table)?;
                let held = loader.arrays.drawing(file);
                let path = base_dir.join(file);
                plate.stamped(&outlines::drawing(held, &path, &key, *fit_m)?)
            }
        };
        let mut runs = Vec::new();
        for (together, lines) in (0..).step_by(TOGETHER).zip(lines.chunks(TOGETHER)) {
            loader.go_on()?;
            let laid: Vec<_> = lines.par_iter().map(|path| laid(ground, path)).collect();
            for (line, parts) in (together..).zip(laid) {
                runs.extend(parts.into_iter().map(|(course, segments)| Run {
                    line,
                    course,
                    segments,
                }));
            }
        }
        Ok(Self {
            layer,
            number,
            ground,
            runs,
        })
    }

    pub(super) fn count(&self) -> u64 {
        self.runs.len() as u64
    }
}

impl Laying for Engraving<'_> {
    fn lay(&self, _walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove {
        let run = &self.runs[index as usize];
        segments.extend_from_slice(&run.segments);
        let mut stream = Stream::new(self.layer.seed, self.number, run.line);
        let normals = std::array::from_fn(|_| stream.normal());
        Groove {
            profile: scratch_profile(
                [self.layer.width_um, self.layer.depth_nm],
                normals,
                [1.0; 2],
            ),
            course: run.course,
        }
    }

    fn middle(&self, index: u64) -> Option<MeshPoint> {
        let segments = &self.runs[index as usize].segments;
        let middle = segments.get(segments.len() / 2)?;
        let point_m = middle.start_m.midpoint(middle.end_m).as_dvec3();
        Some(self.ground.closest().find(point_m).0)
    }
}

/// A line before it is laid.
struct Outline {
    cubics: Vec<Cubic>,
    /// Direction in which it is moved onto the surface, for what is off it.
    down: Option<DVec3>,
}

/// The place of outlines on the surface.
struct Plate<'a> {
    ground: &'a Ground,
    middle: MeshPoint,
    /// To the right, in the plane of the middle's triangle.
    right: DVec3,
}

impl<'a> Plate<'a> {
    /// `key` is the way to the layer.
    fn new(
        ground: &'a Ground,
        center_m: [f64; 3],
        direction: [f64; 3],
        key: &str,
    ) -> Result<Self, Error> {
        let way = || format!("{key}.{}", scratches::MIDDLE_M.name);
        ground.refuse_far(center_m, ground.diagonal_m, way)?;
        let (middle, _) = ground.closest().find(ground.point_in_world_m(center_m));
        let facet = Facet::new(&ground.mesh, middle.triangle);
        let along = facet.in_plane(ground.direction_in_world(direction));
        match along.length() > LEAST_ALONG {
            true => Ok(Self {
                ground,
                middle,
                right: along.normalize(),
            }),
            false => Err(Error::new(
                format!("{key}.{}", scratches::READING.name),
                format!("found {direction:?}, which stands upright on the surface"),
                "must lead along it",
            )),
        }
    }

    /// The outlines of a stamp in the plane that touches the surface at its place; none where the surface ends before it.
    fn stamped(&self, stamp: &Stamp) -> Vec<Outline> {
        let walker = self.ground.walker();
        let sign = 1.0f64.copysign(stamp.x_m);
        let there = walker.ahead(self.middle, sign * self.right, stamp.x_m.abs());
        let Some((place, direction)) = there else {
            return Vec::new();
        };
        let normal = walker.normal(&place);
        let right = (sign * direction)
            .reject_from_normalized(normal)
            .normalize_or_zero();
        let up = normal.cross(right);
        let at = |point: Point| place.point_m + right * point.x + up * point.y;
        let mut lines: Vec<Outline> = Vec::new();
        let mut last = None;
        for segment in stamp.outlines.segments() {
            let curve = PathSeg::to_cubic(&segment);
            let cubic = Cubic([curve.p0, curve.p1, curve.p2, curve.p3].map(at));
            match lines.last_mut().filter(|_| last == Some(curve.p0)) {
                Some(line) => line.cubics.push(cubic),
                None => lines.push(Outline {
                    cubics: vec![cubic],
                    down: Some(-normal),
                }),
            }
            last = Some(curve.p3);
        }
        lines
    }
}

/// The smooth curve through points. It gets further points on the surface where it is off it, so that it follows the surface between distant
/// points.
fn through(points_m: &[[f64; 3]], is_closed: bool, ground: &Ground) -> Vec<Cubic> {
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
fn laid(ground: &Ground, outline: &Outline) -> Vec<(Course, Vec<Segment>)> {
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
        let way_m = (spot.point_m - point_m).dot(normal) / slope;
        point_m += along * way_m;
        if way_m.abs() < 1e-12 {
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
