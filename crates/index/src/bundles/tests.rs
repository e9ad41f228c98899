use super::*;
use crate::scratch_index::IndexedSegment;
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Straight scratches all over a slope of 10 cm, a fifth of them on its far side.
fn random_segments(count: usize) -> Vec<IndexedSegment> {
    let mut random = Pcg64::seed_from_u64(1);
    let normal = Vec3::new(0.3, -0.2, 1.0).normalize();
    let (x, y) = normal.any_orthonormal_pair();
    (0..count)
        .map(|_| {
            let mut number = || random.random::<f32>();
            let middle = x * 0.1 * number() + y * 0.1 * number();
            let (sin, cos) = (std::f32::consts::PI * number()).sin_cos();
            let half = (x * cos + y * sin) * 0.003 * number();
            IndexedSegment {
                start_m: middle - half,
                end_m: middle + half,
                normal: if number() < 0.2 { -normal } else { normal },
                width_um: 1.0 + number(),
                depth_nm: 100.0 + 100.0 * number(),
                blur_um: 16.0,
            }
        })
        .collect()
}

fn weight_um2(segments: &[IndexedSegment]) -> f64 {
    segments
        .iter()
        .map(|s| f64::from(s.width_um * s.start_m.distance(s.end_m)) * 1e6)
        .sum()
}

/// Sum of the weights and, weighted, of places and of their squares.
fn moments(level: &BundleLevel) -> (f64, DVec3, DVec3) {
    let mut sums = (0.0, DVec3::ZERO, DVec3::ZERO);
    for bundle in &level.bundles {
        let (w, p) = (f64::from(bundle.weight_um2), bundle.place_m.as_dvec3());
        sums = (sums.0 + w, sums.1 + w * p, sums.2 + w * p * p);
    }
    sums
}

/// What scratches weigh and where they lie is kept from level to level; only the tents' variance grows, by what the renderer
/// takes off.
#[test]
fn levels_keep_weights_places_and_directions() {
    let segments = random_segments(3000);
    let mut level = splat::finest(&segments, 1e-3);
    let (weight, place, square) = moments(&level);
    assert!((weight / weight_um2(&segments) - 1.0).abs() < 1e-4);
    for _ in 0..3 {
        let coarse = splat::coarser(&level);
        assert!(coarse.bundles.len() < level.bundles.len());
        let (w, p, s) = moments(&coarse);
        assert!((w / weight - 1.0).abs() < 1e-4);
        assert!((p / w - place / weight).length() < 1e-6);
        // h^2/6 along each of the grid's axes.
        let h = f64::from(coarse.cell_m);
        let grown = (s / w - square / weight).truncate() / ((h * h - 1e-6) / 6.0);
        assert!((grown - 1.0).abs().max_element() < 0.05, "{grown}");
        level = coarse;
    }
    for bundle in &level.bundles {
        let shares: f32 = bundle.bins.iter().map(|b| f32::from(*b)).sum();
        // A bin is rounded to a part in 510 of the largest.
        assert!((shares * bundle.bin_scale / 255.0 - 1.0).abs() < 0.02);
    }
}

#[test]
fn a_vertex_is_found_and_sides_do_not_mix() {
    let segments = random_segments(2000);
    let level = splat::finest(&segments, 2e-3);
    for (vertex, bundle) in level.vertices.iter().zip(&level.bundles) {
        assert_eq!(level.find(*vertex), Some(bundle));
        assert!(Side(vertex.side).lean(bundle.normal) > 0.9);
        let nowhere = Vertex {
            height: vertex.height + 1000,
            ..*vertex
        };
        assert_eq!(level.find(nowhere), None);
    }
    let of_side = |side: u32| -> f64 {
        let both = level.vertices.iter().zip(&level.bundles);
        both.filter(|(v, _)| v.side == side)
            .map(|(_, b)| f64::from(b.weight_um2))
            .sum()
    };
    let far: Vec<_> = segments
        .iter()
        .filter(|s| s.normal.z < 0.0)
        .copied()
        .collect();
    assert!((of_side(5) / weight_um2(&far) - 1.0).abs() < 1e-4);
}

#[test]
fn directions_are_those_of_the_scratches() {
    let mut segments = random_segments(1);
    let n = segments[0].normal;
    let reference = Side::of(n).reference(n);
    for angle in [0.1f32, 1.5, 3.1] {
        let t = reference * angle.cos() + n.cross(reference) * angle.sin();
        segments[0].start_m = Vec3::ZERO;
        segments[0].end_m = 1e-3 * t;
        let level = splat::finest(&segments, 1e-2);
        let bins = level.bundles[0].bins;
        let at = angle / std::f32::consts::PI * BUNDLE_BINS as f32;
        let low = at as usize;
        assert_eq!(bins.iter().filter(|b| **b > 0).count(), 2, "{bins:?}");
        let [a, b] = [low, (low + 1) % BUNDLE_BINS].map(|i| f32::from(bins[i]));
        assert!((b / (a + b) - at.fract()).abs() < 0.01);
    }
}

#[test]
fn sizes_keep_their_means_and_classes_their_areas() {
    let segments = random_segments(4000);
    let sizes = sizes::representative(&segments);
    for i in 0..2 {
        let mean = sizes.iter().map(|s| s[i]).sum::<f32>() / sizes.len() as f32;
        assert!((mean - 1.0).abs() < 1e-3, "{mean}");
    }
    let total = weight_um2(&segments);
    let classes = sizes::by_width(segments, 4);
    assert_eq!(classes.len(), 4);
    for class in &classes {
        assert!((weight_um2(class) / total - 0.25).abs() < 0.01);
    }
    let same = vec![random_segments(1)[0]; 10];
    assert_eq!(sizes::by_width(same, 4).len(), 1);
}
