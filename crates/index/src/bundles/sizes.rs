//! A few widths and depths that stand for those of many scratches.

use crate::scratch_index::IndexedSegment;
use rayon::prelude::*;

/// Classes of width, each with as many classes of depth.
const CLASSES: usize = 6;

/// Parts segments by width into classes of about equal area: far from the mirror's direction a scratch's colour is a matter of its
/// own width, which a mean over all widths does not know. What has one width only stays together.
pub(super) fn by_width(
    mut segments: Vec<IndexedSegment>,
    count: usize,
) -> Vec<Vec<IndexedSegment>> {
    let area = |s: &IndexedSegment| f64::from(s.width_um * s.start_m.distance(s.end_m));
    segments.par_sort_by(|a, b| a.width_um.total_cmp(&b.width_um));
    let total: f64 = segments.iter().map(area).sum();
    let mut classes = Vec::new();
    let mut before = 0.0;
    let mut first = 0;
    for i in 0..segments.len() {
        let last = i + 1 == segments.len();
        before += area(&segments[i]);
        let full = before >= total * (classes.len() + 1) as f64 / count as f64;
        if last || (full && segments[i].width_um < segments[i + 1].width_um) {
            classes.push(segments[first..=i].to_vec());
            first = i + 1;
        }
    }
    classes
}

/// The mean widths and depths of classes that hold equal areas, over the means of all.
pub(super) fn representative(segments: &[IndexedSegment]) -> Vec<[f32; 2]> {
    // A scratch's segments follow one another: one entry for all of them.
    let mut areas: Vec<([f64; 2], f64)> = Vec::new();
    for segment in segments {
        let size = [segment.width_um, segment.depth_nm].map(f64::from);
        let area = size[0] * f64::from(segment.start_m.distance(segment.end_m));
        match areas.last_mut() {
            Some((last, sum)) if *last == size => *sum += area,
            _ => areas.push((size, area)),
        }
    }
    let [width, depth] = mean(&areas);
    let mut sizes = Vec::new();
    for widths in classes(areas, 0) {
        for class in classes(widths, 1) {
            let [w, d] = mean(&class);
            sizes.push([
                (w / width) as f32,
                if depth > 0.0 { d / depth } else { 1.0 } as f32,
            ]);
        }
    }
    sizes
}

fn mean(areas: &[([f64; 2], f64)]) -> [f64; 2] {
    let (mut sums, mut total) = ([0.0; 2], 0.0);
    for (size, area) in areas {
        sums = [sums[0] + area * size[0], sums[1] + area * size[1]];
        total += area;
    }
    sums.map(|sum| sum / f64::max(total, 1e-300))
}

/// Sorted by one of both sizes and cut into parts of equal area; what lies on a cut is in both parts.
fn classes(mut areas: Vec<([f64; 2], f64)>, by: usize) -> Vec<Vec<([f64; 2], f64)>> {
    areas.sort_by(|a, b| a.0[by].total_cmp(&b.0[by]));
    let total: f64 = areas.iter().map(|a| a.1).sum();
    let mut classes = vec![Vec::new(); CLASSES];
    let mut before = 0.0;
    for (size, area) in areas {
        let [first, last] = [before, before + area]
            .map(|x| ((x / total * CLASSES as f64) as usize).min(CLASSES - 1));
        for (class, areas) in classes.iter_mut().enumerate().take(last + 1).skip(first) {
            let bound = |i: usize| i as f64 * total / CLASSES as f64;
            let within = (before + area).min(bound(class + 1)) - before.max(bound(class));
            if within > 0.0 {
                areas.push((size, within));
            }
        }
        before += area;
    }
    classes
}
