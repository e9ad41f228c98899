//! A layer of engraved lines along smooth curves, which are laid onto the nearest places of the surface: each is one scratch, or so wide
//! that it is filled with short ones.
//!
//! Lines are few, so all of them are laid when the layer is made ready.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use hairline_image::FilePath;
use hairline_scene::Segment;
use kurbo::{PathEl, PathSeg, Point};
use rayon::prelude::*;

use super::curve::{Cubic, spline};
use super::facet::Facet;
use super::ground::Ground;
use super::guide::Guide;
use super::laying::{Groove, Laying, scratch_profile};
use super::outlines::{self, Stamp};
use super::random::Stream;
use super::walk::{Course, MeshPoint, StraightPiece, Walker, join};
use crate::description::{Engraved, Line};
use crate::error::Error;
use crate::loader::Loader;

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

/// Share of a filled line that its scratches would cover if none crossed another.
const FILLED: f64 = 0.3;

/// Engraved lines on the ground that they go on.
pub(super) struct Engraving<'a> {
    layer: &'a Engraved,
    /// Number that distinguishes layers of one seed.
    number: u64,
    ground: &'a Ground,
    runs: Vec<Run>,
    /// Number of lines, and of those of which nothing is on the surface.
    lines: usize,
    lines_off: usize,
}

/// A line, or the part of it up to an edge of the surface.
struct Run {
    /// Number of the line: its parts are alike.
    line: u64,
    course: Course,
    segments: Vec<Segment>,
    /// Length up to the end of each segment; of filled lines alone.
    ends_m: Vec<f64>,
    /// Numbers of its scratches.
    scratches: Range<u64>,
}

impl<'a> Engraving<'a> {
    /// `table` is the path of the layer.
    pub(super) fn new(
        loader: &Loader,
        layer: &'a Engraved,
        number: u64,
        ground: &'a Ground,
        table: &str,
        base_dir: &FilePath,
    ) -> Result<Self, Error> {
        let key = format!("{table}.{}", layer.line.key().name);
        let lines = match &layer.line {
            Line::Curve { points_m, closed } => {
                for (i, point) in points_m.iter().enumerate() {
                    ground.refuse_far(*point, ground.diagonal_m, || format!("{key}[{i}]"))?;
                }
                vec![Outline {
                    cubics: smooth_curve(points_m, *closed, ground),
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
        let mut runs: Vec<Run> = Vec::new();
        let count = lines.len();
        let mut lines_off = 0;
        for (together, lines) in (0..).step_by(TOGETHER).zip(lines.chunks(TOGETHER)) {
            loader.go_on()?;
            let laid: Vec<_> = lines.par_iter().map(|path| laid(ground, path)).collect();
            for (line, parts) in (together..).zip(laid) {
                lines_off += usize::from(parts.is_empty());
                for (course, segments) in parts {
                    let mut length_m = 0.0;
                    let lengths_m = segments.iter().map(|segment| {
                        length_m += f64::from(segment.start_m.distance(segment.end_m));
                        length_m
                    });
                    let ends_m: Vec<_> = lengths_m.collect();
                    let first = runs.last().map_or(0, |run| run.scratches.end);
                    runs.push(Run {
                        line,
                        course,
                        segments,
                        ends_m,
                        scratches: first..first + scratches_in(layer, length_m),
                    });
                }
            }
        }
        Ok(Self {
            layer,
            number,
            ground,
            runs,
            lines: count,
            lines_off,
        })
    }

    pub(super) fn count(&self) -> u64 {
        self.runs.last().map_or(0, |run| run.scratches.end)
    }

    fn is_filled(&self) -> bool {
        self.layer.line_m > 0.0
    }

    /// The run that a scratch belongs to.
    fn run(&self, index: u64) -> &Run {
        let run = (self.runs).partition_point(|run| run.scratches.end <= index);
        &self.runs[run]
    }

    /// Random numbers of a scratch. The parts of a line that is one scratch are alike.
    fn stream(&self, index: u64) -> Stream {
        let of = if self.is_filled() {
            index
        } else {
            self.run(index).line
        };
        Stream::new(self.layer.seed, self.number, of)
    }

    /// The middle and the way of a scratch of a filled line; none where the surface ends before. They follow one another along the line, each at a random
    /// place of its share of it.
    fn short(
        &self,
        walker: &Walker,
        index: u64,
        stream: &mut Stream,
    ) -> Option<(MeshPoint, Guide)> {
        let Run {
            segments,
            ends_m,
            scratches,
            ..
        } = self.run(index);
        let share = ((index - scratches.start) as f64 + stream.uniform())
            / (scratches.end - scratches.start) as f64;
        let along_m = share * ends_m.last()?;
        let across_m = (stream.uniform() - 0.5) * (self.layer.line_m - self.length_m());
        let angle_rad = PI * stream.uniform();
        let at = ends_m.partition_point(|end_m| *end_m < along_m);
        let (segment, end_m) = (segments.get(at)?, ends_m.get(at)?);
        let span = (segment.end_m - segment.start_m).as_dvec3();
        let tangent = span.try_normalize()?;
        let point_m = segment.end_m.as_dvec3() - (end_m - along_m) * tangent;
        let (place, _) = self.ground.closest().find(point_m);
        let facet = Facet::new(&self.ground.mesh, place.triangle);
        let to_side = facet.in_plane(facet.normal.cross(tangent)) * across_m.signum();
        let to_side = to_side.try_normalize()?;
        let (middle, to_side) = match across_m.abs() > walker.shortest_piece_m {
            true => walker.ahead(place, to_side, across_m.abs())?,
            false => (place, to_side),
        };
        let facet = Facet::new(&self.ground.mesh, middle.triangle);
        let to_side = facet.in_plane(to_side).try_normalize()?;
        let other = facet.normal.cross(to_side);
        let guide = Guide::Free {
            seed_direction: to_side * angle_rad.cos() + other * angle_rad.sin(),
            curvature_per_m: 0.0,
        };
        Some((middle, guide))
    }

    /// Length of the scratches of a filled line.
    fn length_m(&self) -> f64 {
        0.5 * self.layer.line_m
    }
}

/// Number of scratches in a line.
fn scratches_in(layer: &Engraved, length_m: f64) -> u64 {
    if layer.line_m == 0.0 {
        return 1;
    }
    // Each covers its width times half the line's width.
    (2.0 * FILLED * length_m / (1e-6 * layer.width_um.mean)).ceil() as u64
}

impl Laying for Engraving<'_> {
    fn lay(&self, walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove {
        let mut stream = self.stream(index);
        let mut course = Course::Open;
        if self.is_filled() {
            if let Some((middle, guide)) = self.short(walker, index, &mut stream) {
                walker.lay(middle, &guide, self.length_m(), segments);
            }
        } else {
            let run = self.run(index);
            segments.extend_from_slice(&run.segments);
            course = run.course;
        }
        let normals = std::array::from_fn(|_| stream.normal());
        Groove {
            profile: scratch_profile(
                [self.layer.width_um, self.layer.depth_nm],
                normals,
                [1.0; 2],
            ),
            course,
        }
    }

    fn note(&self) -> Option<String> {
        match (&self.layer.line, self.lines_off, self.lines) {
            (_, 0, _) => None,
            (Line::Curve { .. }, ..) => Some(
                "the curve lays no scratch: it lies off the object, or its points are one place"
                    .to_owned(),
            ),
            (_, off, all) => Some(format!("{off} of {all} outlines lie off the object")),
        }
    }

    fn middle(&self, index: u64) -> Option<MeshPoint> {
        if self.is_filled() {
            let short = self.short(&self.ground.walker(), index, &mut self.stream(index));
            return short.map(|(middle, _)| middle);
        }
        let segments = &self.run(index).segments;
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
    /// `key` is the path of the layer.
    fn new(
        ground: &'a Ground,
        center_m: [f64; 3],
        direction: [f64; 3],
        key: &str,
    ) -> Result<Self, Error> {
        let key_path = || format!("{key}.{}", Line::MIDDLE_M.name);
        ground.refuse_far(center_m, ground.diagonal_m, key_path)?;
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
                format!("{key}.{}", Line::READING.name),
                format!("found {direction:?}, which stands upright on the surface"),
                "must lead along it",
            )),
        }
    }

    /// The outlines of a stamp in the plane that touches the surface at its place; where the surface ends before it they are empty.
    fn stamped(&self, stamp: &Stamp) -> Vec<Outline> {
        let walker = self.ground.walker();
        let sign = 1.0f64.copysign(stamp.x_m);
        let there = walker.ahead(self.middle, sign * self.right, stamp.x_m.abs());
        let Some((place, direction)) = there else {
            let elements = stamp.outlines.elements().iter();
            let begins = elements.filter(|element| matches!(element, PathEl::MoveTo(_)));
            let nothing = begins.map(|_| Outline {
                cubics: Vec::new(),
                down: None,
            });
            return nothing.collect();
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
fn smooth_curve(points_m: &[[f64; 3]], is_closed: bool, ground: &Ground) -> Vec<Cubic> {
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
