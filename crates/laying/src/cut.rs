//! Removes parts of a scratch: those under an eraser, and those outside the places that its layer lies on.

use glam::DVec3;
use hairline_scene::Segment;

use crate::walk::{Course, Walker};

/// Parts of a segment that are taken away, from 0 to 1.
pub type RemovedParts = Vec<[f64; 2]>;

/// Returns the remaining parts in runs of joined segments; `None` where nothing is taken away. `removed` adds the parts of a
/// segment to be taken away.
pub fn remaining_runs(
    walker: &Walker,
    course: Course,
    segments: &[Segment],
    removed: impl Fn(&Segment, &mut RemovedParts),
) -> Option<Vec<Vec<Segment>>> {
    let removed: Vec<_> = segments
        .iter()
        .map(|segment| {
            let mut parts = RemovedParts::new();
            removed(segment, &mut parts);
            joined(parts)
        })
        .collect();
    if removed.iter().all(Vec::is_empty) {
        return None;
    }
    let mut runs = vec![Vec::new()];
    let mut push = |segment: Option<Segment>| match (segment, runs.last_mut()) {
        (Some(segment), Some(run)) => run.push(segment),
        (None, Some(run)) if !run.is_empty() => runs.push(Vec::new()),
        _ => {}
    };
    for (segment, removed) in segments.iter().zip(&removed) {
        let mut from = 0.0;
        for &[start, end] in removed {
            push(part(walker, segment, [from, start]));
            push(None);
            from = end;
        }
        push(part(walker, segment, [from, 1.0]));
    }
    if runs.last().is_some_and(Vec::is_empty) {
        runs.pop();
    }
    // A ring that is cut begins and ends at its cuts, and not where its list of segments does.
    if course == Course::Closed
        && let [first, .., last] = runs.as_mut_slice()
        && last.last().map(|s| s.end_m) == first.first().map(|s| s.start_m)
    {
        last.append(first);
        runs.swap_remove(0);
    }
    Some(runs)
}

/// Sorts the parts and joins those that overlap.
fn joined(mut parts: RemovedParts) -> RemovedParts {
    parts.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    parts.dedup_by(|next, last| {
        let joins = next[0] <= last[1];
        if joins {
            last[1] = last[1].max(next[1]);
        }
        joins
    });
    parts
}

/// A part of a segment, if it is long enough to matter.
fn part(walker: &Walker, segment: &Segment, [from, to]: [f64; 2]) -> Option<Segment> {
    if [from, to] == [0.0, 1.0] {
        return Some(*segment);
    }
    let [start, end] = [segment.start_m, segment.end_m].map(|p| p.as_dvec3());
    if !((to - from) * start.distance(end) >= walker.shortest_piece_m) {
        return None;
    }
    let cut = walker.segment(start.lerp(end, from), start.lerp(end, to), segment.triangle);
    Some(Segment {
        // Joints stay as they are, to the last bit.
        start_m: if from == 0.0 {
            segment.start_m
        } else {
            cut.start_m
        },
        end_m: if to == 1.0 { segment.end_m } else { cut.end_m },
        ..cut
    })
}

/// Interval of t in which |offset + t span| is below the radius.
pub fn ball(offset: DVec3, span: DVec3, radius_m: f64) -> Option<[f64; 2]> {
    let outside = offset.length_squared() - radius_m * radius_m;
    let squared = span.length_squared();
    // Also where nothing changes along the span, but for rounding.
    if squared <= 1e-24 * radius_m * radius_m {
        return (outside < 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let middle = -offset.dot(span) / squared;
    let half_squared = middle * middle - outside / squared;
    (half_squared > 0.0).then(|| {
        let half = libm::sqrt(half_squared);
        [middle - half, middle + half]
    })
}
