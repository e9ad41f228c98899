//! A few widths and depths that stand for those of many scratches.

use super::SizeRange;
use crate::scratch_index::IndexedSegment;
use hairline_optics::spread_table::SizePart;
use rayon::prelude::*;

/// Parts by width, each with as many by depth.
const PARTS: usize = 8;

/// Within a class widths and depths differ from their means by these shares, root mean square, unless that takes more classes than
/// are allowed. The light of a scratch goes with its width and depth to first order (`TableRow::moved`), which holds so far.
const SPREAD: [f64; 2] = [0.05, 0.2];

/// Parts segments into classes of like sizes, `most` at most: the class that is spread the most is cut in two, where the sizes of
/// both halves differ the most.
pub(super) fn classes(segments: Vec<IndexedSegment>, most: usize) -> Vec<Class> {
    let all = SizeRange {
        low: [f32::NEG_INFINITY; 2],
        high: [f32::INFINITY; 2],
    };
    let mut classes = vec![Class::new(segments, all)];
    while classes.len() < most {
        let cut = (0..classes.len())
            .flat_map(|i| [0, 1].map(|by| (i, by)))
            .filter(|(i, by)| classes[*i].excess[*by] > 1.0)
            .max_by(|a, b| {
                let cost = |(i, by): &(usize, usize)| classes[*i].excess[*by] * classes[*i].area;
                cost(a).total_cmp(&cost(b))
            });
        let Some((i, by)) = cut else {
            break;
        };
        let Class {
            segments, range, ..
        } = classes.swap_remove(i);
        let (bound, [low, high]) = cut_in_two(segments, by);
        let (mut below, mut above) = (range, range);
        (below.high[by], above.low[by]) = (bound, bound);
        classes.extend([Class::new(low, below), Class::new(high, above)]);
    }
    classes
}

/// Segments of like sizes.
pub(super) struct Class {
    pub segments: Vec<IndexedSegment>,
    /// Of all possible sizes, those of this class.
    pub range: SizeRange,
    area: f64,
    /// Variances over those that are allowed.
    excess: [f64; 2],
}

impl Class {
    fn new(segments: Vec<IndexedSegment>, range: SizeRange) -> Self {
        let (mut area, mut sums, mut squares) = (0.0, [0.0; 2], [0.0; 2]);
        for segment in &segments {
            let a = area_of(segment);
            area += a;
            for (i, size) in size(segment).into_iter().enumerate() {
                sums[i] += a * size;
                squares[i] += a * size * size;
            }
        }
        let excess = std::array::from_fn(|i| {
            let mean2 = sums[i] * sums[i] / area;
            let spread2 = SPREAD[i] * SPREAD[i];
            // What has no depth at all is not spread.
            ((squares[i] - mean2) / (spread2 * mean2).max(1e-300)).max(0.0)
        });
        Self {
            segments,
            range,
            area,
            excess,
        }
    }
}

fn size(segment: &IndexedSegment) -> [f64; 2] {
    [segment.width_um, segment.depth_nm].map(f64::from)
}

fn area_of(segment: &IndexedSegment) -> f64 {
    f64::from(segment.width_um * segment.start_m.distance(segment.end_m))
}

/// Cut at a size, the least of the second part, so that the least variance is left within both.
fn cut_in_two(segments: Vec<IndexedSegment>, by: usize) -> (f32, [Vec<IndexedSegment>; 2]) {
    let mut areas = areas(&segments);
    areas.par_sort_unstable_by(|a, b| a.0[by].total_cmp(&b.0[by]));
    let sum =
        |(area, sum): (f64, f64), (size, of): &([f64; 2], f64)| (area + of, sum + of * size[by]);
    let (area, total) = areas.iter().fold((0.0, 0.0), sum);
    let (mut low, mut best) = ((0.0, 0.0), (0.0, f64::INFINITY));
    for pair in areas.windows(2) {
        low = sum(low, &pair[0]);
        let between = (low.1 * area - total * low.0).powi(2) / (low.0 * (area - low.0));
        if between > best.0 && pair[0].0[by] < pair[1].0[by] {
            best = (between, pair[1].0[by]);
        }
    }
    let (low, high) = segments.into_iter().partition(|s| size(s)[by] < best.1);
    // Sizes are single precision.
    (best.1 as f32, [low, high])
}

/// Sizes and areas. A scratch's segments follow one another: one entry for all of them.
fn areas(segments: &[IndexedSegment]) -> Vec<([f64; 2], f64)> {
    let mut areas: Vec<([f64; 2], f64)> = Vec::new();
    for segment in segments {
        let (size, area) = (size(segment), area_of(segment));
        match areas.last_mut() {
            Some((last, sum)) if *last == size => *sum += area,
            _ => areas.push((size, area)),
        }
    }
    areas
}

/// The mean width (um) and depth (nm), by area.
pub(super) fn mean(segments: &[IndexedSegment]) -> [f32; 2] {
    mean_of(segments.iter().map(|s| (size(s), area_of(s)))).map(|x| x as f32)
}

/// Parts that hold equal areas, over the means of all.
pub(super) fn representative(segments: &[IndexedSegment]) -> Vec<SizePart> {
    let areas = areas(segments);
    let [width, depth] = mean_of(areas.iter().copied());
    parts(areas, 0)
        .into_iter()
        .map(|part| SizePart {
            width: mean_of(part.iter().copied())[0] / width,
            depths: parts(part, 1)
                .into_iter()
                .map(|part| match depth > 0.0 {
                    true => mean_of(part.into_iter())[1] / depth,
                    false => 1.0,
                })
                .collect(),
        })
        .collect()
}

fn mean_of(areas: impl Iterator<Item = ([f64; 2], f64)>) -> [f64; 2] {
    let (mut sums, mut total) = ([0.0; 2], 0.0);
    for (size, area) in areas {
        sums = [sums[0] + area * size[0], sums[1] + area * size[1]];
        total += area;
    }
    sums.map(|sum| sum / f64::max(total, 1e-300))
}

/// Sorted by one of both sizes and cut into parts of equal area; what lies on a cut is in both parts.
fn parts(mut areas: Vec<([f64; 2], f64)>, by: usize) -> Vec<Vec<([f64; 2], f64)>> {
    areas.par_sort_by(|a, b| a.0[by].total_cmp(&b.0[by]));
    let total: f64 = areas.iter().map(|a| a.1).sum();
    let mut parts = vec![Vec::new(); PARTS];
    let mut before = 0.0;
    for (size, area) in areas {
        let [first, last] =
            [before, before + area].map(|x| ((x / total * PARTS as f64) as usize).min(PARTS - 1));
        for (part, areas) in parts.iter_mut().enumerate().take(last + 1).skip(first) {
            let bound = |i: usize| i as f64 * total / PARTS as f64;
            let within = (before + area).min(bound(part + 1)) - before.max(bound(part));
            if within > 0.0 {
                areas.push((size, within));
            }
        }
        before += area;
    }
    parts
}
