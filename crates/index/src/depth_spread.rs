//! Coherence of the phase steps of an object's scratches (docs/model.md, section 3), for millions of them.

use hairline_optics::mask::depth_coherence;
use hairline_optics::scratch::DEPTH_MAX_NM;
use hairline_optics::section::Section;
use hairline_scene::{Object, Scratch};
use rayon::prelude::*;
use std::collections::HashMap;

/// Number of bins of depth: for grooves of 2 µm a bin is 0.13 nm wide, and its depths are taken at their mean. This moves a
/// phase by 0.002 at most and, since deeper and shallower ones even out, the result by some millionths.
const BINS: usize = 1 << 14;

/// Computes the coherence by area: a scratch counts by its width times its length.
pub(crate) fn object_coherence(object: &Object) -> f32 {
    let deepest = object.scratches.iter().map(|s| s.profile.depth_nm);
    let deepest = deepest.fold(0.0_f32, f32::max);
    if (object.scratches.iter()).any(|s| s.profile.section != Section::Rectangle) {
        return of_strips(object);
    }
    let area = |s: &Scratch| f64::from(object.covered_um_m(s));
    let areas: Vec<f64> = object.scratches.par_iter().map(area).collect();
    // Weights, and weights times depths.
    let mut bins = vec![[0.0_f64; 2]; BINS];
    for (scratch, area) in object.scratches.iter().zip(areas) {
        let depth_nm = scratch.profile.depth_nm.max(0.0);
        let bin = (depth_nm / deepest.max(f32::MIN_POSITIVE) * BINS as f32) as usize;
        let [weight, moment] = &mut bins[bin.min(BINS - 1)];
        *weight += area;
        *moment += area * depth_nm as f64;
    }
    bins.retain(|[weight, _]| *weight > 0.0);
    let depths = bins
        .iter()
        .map(|[weight, moment]| (moment / weight, *weight));
    depth_coherence(depths) as f32
}

/// Strips of a section, each of one depth.
const STRIPS: usize = 16;
/// Bins of depth of each section.
const SECTION_BINS: usize = 256;

/// The coherence where floors are not all of one depth: each strip of a groove counts as a groove.
fn of_strips(object: &Object) -> f32 {
    let mut sections: Vec<&Section> = Vec::new();
    let mut bins: HashMap<(usize, u32), [f64; 2]> = HashMap::new();
    for scratch in object.scratches.iter() {
        let area = f64::from(object.covered_um_m(scratch));
        let depth_nm = f64::from(scratch.profile.depth_nm.max(0.0));
        let bin = (depth_nm / DEPTH_MAX_NM * SECTION_BINS as f64) as u32;
        let section = &scratch.profile.section;
        let known = sections.iter().position(|it| *it == section);
        let number = known.unwrap_or_else(|| {
            sections.push(section);
            sections.len() - 1
        });
        let sum = bins.entry((number, bin)).or_default();
        sum[0] += area;
        sum[1] += area * depth_nm;
    }
    let mut bins: Vec<_> = bins.into_iter().collect();
    bins.sort_unstable_by_key(|bin| bin.0);
    let depths = bins.iter().flat_map(|((section, _), [weight, moment])| {
        let strips = sections[*section].strips(STRIPS);
        let each = weight / strips.len() as f64;
        strips
            .into_iter()
            .map(move |(_, share)| (share * moment / weight.max(f64::MIN_POSITIVE), each))
    });
    depth_coherence(depths.collect::<Vec<_>>().iter().copied()) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_in_bins_are_as_alike_as_they_are_one_by_one() {
        let text = "
            camera = { position_m = [0.0, -0.3, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0] }
            material = [{ name = \"m\", kind = \"mirror\" }]
            object = [{ name = \"o\", material = \"m\", shape = { disk = { radius_m = 0.08 } } }]
            scratches = [{ object = \"o\", pattern = \"random\", count = 20000, seed = 1, length_m = 0.002, \
                width_um = { mean = 2.0, spread = 0.5 }, depth_nm = { mean = 150.0, spread = 0.6 } }]
        ";
        let scene = hairline_document::from_toml(text, "test", ".")
            .unwrap_or_else(|error| panic!("{error}"));
        let object = &scene.objects[0];
        let one_by_one = object.scratches.iter().map(|s| {
            let pieces = &object.segments[s.segments.start as usize..s.segments.end as usize];
            let length: f32 = pieces.iter().map(|p| p.start_m.distance(p.end_m)).sum();
            (
                s.profile.depth_nm as f64,
                (s.profile.width_um * length) as f64,
            )
        });
        let right = depth_coherence(one_by_one.clone());
        assert!((object_coherence(object) as f64 - right).abs() < 1e-5);
        // Not so coarse that anything would do.
        let wrong = depth_coherence(one_by_one.map(|(depth, weight)| (0.99 * depth, weight)));
        assert!((wrong - right).abs() > 1e-4, "{wrong} {right}");
    }
}
