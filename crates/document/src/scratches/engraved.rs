//! A layer of engraved lines along smooth curves, which are laid onto the nearest places of the surface: each is one scratch, or so wide
//! that it is filled with short ones.
//!
//! Lines are few, so all of them are laid when the layer is made ready.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use hairline_image::FilePath;
use hairline_laying::{
    Course, Cubic, Facet, Groove, Ground, Guide, Laying, MeshPoint, Outline, Stream, Walker,
    lay_outline, smooth_curve,
};
use hairline_scene::Segment;
use kurbo::{PathEl, PathSeg, Point};
use rayon::prelude::*;

use super::off_object::refuse_far;
use super::outlines::{self, Stamp};
use super::sizes::scratch_profile;
use crate::description::{Engraved, Line};
use crate::error::Error;
use crate::loader::Loader;

/// Least part of a direction that leads along the surface.
const LEAST_ALONG: f64 = 1e-3;
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
        let lines = outlines(loader, &layer.line, ground, table, base_dir)?;
        let mut runs: Vec<Run> = Vec::new();
        let count = lines.len();
        let mut lines_off = 0;
        for (together, lines) in (0..).step_by(TOGETHER).zip(lines.chunks(TOGETHER)) {
            loader.go_on()?;
            let laid: Vec<_> = lines
                .par_iter()
                .map(|path| lay_outline(ground, path))
                .collect();
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

/// The lines that are engraved. `table` is the path of the layer.
fn outlines(
    loader: &Loader,
    line: &Line,
    ground: &Ground,
    table: &str,
    base_dir: &FilePath,
) -> Result<Vec<Outline>, Error> {
    let key = format!("{table}.{}", line.key().name);
    Ok(match line {
        Line::Curve { points_m, closed } => {
            for (i, point) in points_m.iter().enumerate() {
                refuse_far(ground, *point, ground.diagonal_m, || format!("{key}[{i}]"))?;
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
    })
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
        refuse_far(ground, center_m, ground.diagonal_m, key_path)?;
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
