//! The walk of one scratch over a mesh: from its seed both ways along its guide, across edges, until its length is used up or
//! the surface ends.

use glam::{DVec3, Vec3};
use hairline_scene::{Mesh, Segment};

use crate::facet::{self, Arc, Facet};
use crate::guide::{Aim, Guide, chord_length_m};
use crate::neighbours::Neighbours;

/// A walk that needs more steps than this is going nowhere.
const MOST_STEPS: usize = 1 << 20;
/// Steps without progress before a walk gives up: more than triangles meet in any sensible corner.
const MOST_IDLE_STEPS: usize = 128;
/// A field that turns by more than 60 degrees at once has no direction there: a pole, or a ridge with both sides facing it.
const TURN_BACK_COS: f64 = 0.5;

/// Longest way on the surface between two points over their distance: on a curved surface it is longer than the straight line.
pub const LONGEST_WAY: f64 = 4.0;
/// Share of a way by which it may miss its end and still arrives.
const MISSED: f64 = 1e-3;
/// A place that is nearer to a triangle is on its edge, but for rounding.
const ON_EDGE_M: f64 = 1e-10;

/// A place on the surface.
#[derive(Clone, Copy, Debug)]
pub struct MeshPoint {
    /// Index of the triangle that it lies on.
    pub triangle: u32,
    /// World space.
    pub point_m: DVec3,
}

/// A straight piece within one triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StraightPiece {
    start_m: DVec3,
    end_m: DVec3,
    triangle: u32,
}

/// Walks on one mesh.
pub struct Walker<'a> {
    mesh: &'a Mesh,
    neighbours: &'a Neighbours,
    /// Shorter pieces are left out.
    pub shortest_piece_m: f64,
}

/// The shortest piece that is laid on a mesh of such bounds. Shorter ones add nothing under a coherence width of 20 um, and their direction would
/// be lost in single precision.
pub(crate) fn shortest_piece_m((least, most): (Vec3, Vec3)) -> f64 {
    let farthest = least.abs().max(most.abs()).max_element();
    f64::from(farthest * f32::EPSILON * 16.0).max(0.5e-6)
}

/// Course of a walk, besides its segments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// The walk has two ends.
    Open,
    /// The walk came back to its start.
    Closed,
}

impl<'a> Walker<'a> {
    /// `shortest_piece_m` is that of the mesh.
    pub(crate) fn new(mesh: &'a Mesh, neighbours: &'a Neighbours, shortest_piece_m: f64) -> Self {
        Self {
            mesh,
            neighbours,
            shortest_piece_m,
        }
    }

    /// Lays a scratch with its middle at the seed and appends its segments: none if the guide has no direction there.
    pub fn lay(
        &self,
        seed: MeshPoint,
        guide: &Guide,
        length_m: f64,
        segments: &mut Vec<Segment>,
    ) -> Course {
        if length_m >= guide.shortest_ring_m(seed.point_m) {
            let (pieces, course) = self.walk(seed, guide, false, length_m);
            if course == Course::Closed {
                return self.append(pieces, course, segments);
            }
        }
        let (ahead, _) = self.walk(seed, guide, false, length_m / 2.0);
        let (behind, _) = self.walk(seed, guide, true, length_m / 2.0);
        let mut pieces: Vec<_> = behind
            .into_iter()
            .rev()
            .map(StraightPiece::reversed)
            .collect();
        // A straight scratch has no joint at its seed.
        join(&mut pieces, ahead);
        self.append(pieces, Course::Open, segments)
    }

    /// Lays a scratch from `start` on, as far as its guide leads.
    pub fn lay_from(
        &self,
        start: MeshPoint,
        guide: &Guide,
        length_m: f64,
        segments: &mut Vec<Segment>,
    ) {
        let (pieces, _) = self.walk(start, guide, false, length_m);
        self.append(pieces, Course::Open, segments);
    }

    /// The place at a distance straight ahead, and the direction there; none where the surface ends before.
    pub fn ahead(
        &self,
        start: MeshPoint,
        direction: DVec3,
        length_m: f64,
    ) -> Option<(MeshPoint, DVec3)> {
        let guide = Guide::Free {
            seed_direction: direction,
            curvature_per_m: 0.0,
        };
        let (pieces, _) = self.walk(start, &guide, false, length_m);
        let lengths_m = pieces.iter().map(StraightPiece::length_m);
        let missed_m = length_m - lengths_m.sum::<f64>();
        let last = pieces.last()?;
        let place = MeshPoint {
            triangle: last.triangle,
            point_m: last.end_m,
        };
        // Shorter ones have no direction.
        let mut long = pieces.iter().rev();
        let long = long.find(|piece| piece.length_m() > self.shortest_piece_m);
        let direction = long.map_or(direction, |it| (it.end_m - it.start_m).normalize());
        (missed_m <= MISSED * length_m).then_some((place, direction))
    }

    /// Adds the way on the surface to a near place to the last run of pieces. Where no way leads over an edge between them, that run ends
    /// there, and a new one begins on its other side.
    pub(crate) fn go(&self, from: MeshPoint, to: MeshPoint, runs: &mut Vec<Vec<StraightPiece>>) {
        let (ahead, arrives) = self.path_to(from, to);
        let run = runs.last_mut();
        match run {
            Some(run) => join(run, ahead),
            None => runs.push(ahead),
        }
        if !arrives {
            let (back, _) = self.path_to(to, from);
            runs.push(
                back.into_iter()
                    .rev()
                    .map(StraightPiece::reversed)
                    .collect(),
            );
        }
    }

    /// The path to a near place, and whether it arrives.
    fn path_to(&self, from: MeshPoint, to: MeshPoint) -> (Vec<StraightPiece>, bool) {
        for triangle in [from.triangle, to.triangle] {
            let facet = Facet::new(self.mesh, triangle);
            let is_in = |place: MeshPoint| facet.distance_m(place.point_m) < ON_EDGE_M;
            // Along an edge neither of its facets leads on.
            if facet.normal != DVec3::ZERO && is_in(from) && is_in(to) {
                let piece = StraightPiece {
                    start_m: from.point_m,
                    end_m: to.point_m,
                    triangle,
                };
                return (vec![piece], true);
            }
        }
        let guide = Guide::Towards { end_m: to.point_m };
        let distance_m = from.point_m.distance(to.point_m);
        let (pieces, _) = self.walk(from, &guide, false, LONGEST_WAY * distance_m);
        let missed_m = pieces
            .last()
            .map_or(distance_m, |last| last.end_m.distance(to.point_m));
        let arrives = missed_m < self.shortest_piece_m + MISSED * distance_m;
        (pieces, arrives)
    }

    fn walk(
        &self,
        start: MeshPoint,
        guide: &Guide,
        reversed: bool,
        length_m: f64,
    ) -> (Vec<StraightPiece>, Course) {
        let mut pieces = Vec::new();
        let mut spot = start;
        let mut heading = None;
        let mut entry = None;
        let mut left_m = length_m;
        let mut start_direction = None;
        let mut idle_steps = 0;
        let mut facet = Facet::new(self.mesh, start.triangle);
        for _ in 0..MOST_STEPS {
            let Some(aim) = self.aim(guide, &facet, spot, heading, entry, reversed) else {
                break;
            };
            let start_direction = *start_direction.get_or_insert(aim.direction);
            let arc = facet.arc(spot.point_m, aim.direction, aim.curvature_per_m);
            // Up to a quarter of a turn, well within what `exit` and `nearest` can tell.
            let quarter_turn_m = std::f64::consts::FRAC_PI_2 / aim.curvature_per_m.abs();
            let most_m = aim.reach_m.min(left_m).min(quarter_turn_m);
            let exit = facet.exit(&arc, entry);
            let exit = exit.filter(|(exit_m, _)| *exit_m <= most_m);
            let reach_m = exit.map_or(most_m, |(exit_m, _)| exit_m);
            let walked_m = length_m - left_m;
            if spot.triangle == start.triangle
                && let Some(along_m) = closes(&arc, start, start_direction, walked_m, reach_m)
            {
                push_chords(&mut pieces, spot.triangle, &arc, along_m);
                return (pieces, Course::Closed);
            }
            push_chords(&mut pieces, spot.triangle, &arc, reach_m);
            left_m -= reach_m;
            if left_m <= 0.0 {
                break;
            }
            idle_steps = match reach_m < self.shortest_piece_m * 1e-3 {
                true => idle_steps + 1,
                false => 0,
            };
            if idle_steps > MOST_IDLE_STEPS {
                break;
            }
            let (point_m, direction) = arc.point_and_tangent(reach_m);
            let Some((_, edge)) = exit else {
                spot.point_m = point_m;
                heading = Some(direction);
                entry = None;
                continue;
            };
            let across = self.neighbours.across_edge(spot.triangle, edge);
            let Some((triangle, next_edge)) = across else {
                break;
            };
            let next = Facet::new(self.mesh, triangle);
            let share = 1.0 - facet.share_of_edge(edge, point_m);
            heading = Some(facet.unfold(direction, edge, &next, next_edge));
            let point_m = next.point_on_edge(next_edge, share);
            (spot, facet, entry) = (MeshPoint { triangle, point_m }, next, Some(next_edge));
        }
        (pieces, Course::Open)
    }

    /// The guide's aim, if it leads on from where the scratch comes.
    fn aim(
        &self,
        guide: &Guide,
        facet: &Facet,
        spot: MeshPoint,
        heading: Option<DVec3>,
        entry: Option<usize>,
        reversed: bool,
    ) -> Option<Aim> {
        let aim = guide.aim(facet, spot.point_m, heading, reversed)?;
        if let Some(heading) = heading
            && heading.dot(aim.direction) < TURN_BACK_COS
        {
            return None;
        }
        match (entry, heading) {
            // The fields of two facets can both point at their edge; then cross this one straight on.
            (Some(edge), Some(heading)) if !facet.is_inward(aim.direction, edge) => facet
                .is_inward(heading, edge)
                .then(|| Aim::straight(heading)),
            _ => Some(aim),
        }
    }

    /// Rounds pieces to segments and appends them, without those too short to matter.
    pub(crate) fn append(
        &self,
        pieces: Vec<StraightPiece>,
        course: Course,
        segments: &mut Vec<Segment>,
    ) -> Course {
        let Some(first) = pieces.first() else {
            return Course::Open;
        };
        let first_segment = segments.len();
        let mut joint_m = first.start_m;
        for piece in &pieces {
            if piece.end_m.distance(joint_m) < self.shortest_piece_m {
                continue;
            }
            segments.push(self.segment(joint_m, piece.end_m, piece.triangle));
            joint_m = piece.end_m;
        }
        let laid = &mut segments[first_segment..];
        match (course, laid) {
            // Fewer than three segments cannot go round.
            (Course::Closed, [first, _, .., last]) => {
                last.end_m = first.start_m;
                Course::Closed
            }
            _ => Course::Open,
        }
    }

    /// A piece of a triangle with the shading normal at its middle.
    pub(crate) fn segment(&self, start_m: DVec3, end_m: DVec3, triangle: u32) -> Segment {
        let middle = MeshPoint {
            triangle,
            point_m: (start_m + end_m) / 2.0,
        };
        Segment {
            start_m: start_m.as_vec3(),
            end_m: end_m.as_vec3(),
            normal: self.normal(&middle).as_vec3(),
            triangle,
        }
    }

    /// The shading normal.
    pub fn normal(&self, at: &MeshPoint) -> DVec3 {
        let corners_m = self.mesh.corners_m(at.triangle as usize);
        let facet_normal = facet::normal(corners_m);
        let weights = facet::barycentric(corners_m, facet_normal, at.point_m);
        let corners = self.mesh.triangles[at.triangle as usize];
        let normal: DVec3 = (0..3)
            .map(|i| self.mesh.normals[corners[i] as usize].as_dvec3() * weights[i])
            .sum();
        normal.normalize_or(facet_normal)
    }
}

/// Adds pieces to those that end where they begin.
pub(crate) fn join(pieces: &mut Vec<StraightPiece>, ahead: Vec<StraightPiece>) {
    let mut ahead = ahead.into_iter();
    if let (Some(last), Some(first)) = (pieces.last_mut(), ahead.as_slice().first())
        && last.continues_straight(first)
    {
        last.end_m = first.end_m;
        ahead.next();
    }
    pieces.extend(ahead);
}

/// The length along an arc of `reach_m` at which a scratch is back where it started, with the direction in which it started.
fn closes(
    arc: &Arc,
    start: MeshPoint,
    start_direction: DVec3,
    walked_m: f64,
    reach_m: f64,
) -> Option<f64> {
    // Error of a ring by vertices in single precision: facets are tilted by some 1e-5, at random.
    let tolerance_m = (1e-6 * walked_m).max(1e-7);
    if walked_m <= tolerance_m {
        return None;
    }
    let (along_m, miss_m) = arc.nearest(start.point_m);
    let met = (-tolerance_m..=reach_m + tolerance_m).contains(&along_m) && miss_m < tolerance_m;
    let is_along = || arc.point_and_tangent(along_m).1.dot(start_direction) > 0.999;
    (met && is_along()).then(|| along_m.max(0.0))
}

/// Cuts an arc into chords of equal length.
fn push_chords(pieces: &mut Vec<StraightPiece>, triangle: u32, arc: &Arc, length_m: f64) {
    let chords = match arc.curvature_per_m == 0.0 {
        true => 1,
        false => (length_m / chord_length_m(arc.curvature_per_m))
            .ceil()
            .max(1.0) as usize,
    };
    let mut start_m = arc.start_m;
    for i in 1..=chords {
        let (end_m, _) = arc.point_and_tangent(length_m * i as f64 / chords as f64);
        pieces.push(StraightPiece {
            start_m,
            end_m,
            triangle,
        });
        start_m = end_m;
    }
}

impl StraightPiece {
    fn reversed(self) -> Self {
        Self {
            start_m: self.end_m,
            end_m: self.start_m,
            ..self
        }
    }

    fn length_m(&self) -> f64 {
        self.start_m.distance(self.end_m)
    }

    /// Whether the next piece goes on in the same triangle and the same direction.
    fn continues_straight(&self, next: &StraightPiece) -> bool {
        let (step, next_step) = (self.end_m - self.start_m, next.end_m - next.start_m);
        let turn = step.cross(next_step).length();
        self.triangle == next.triangle && turn <= 1e-9 * step.length() * next_step.length()
    }
}
