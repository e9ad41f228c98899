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

/// The finest grid, and nobody watches.
fn finest(segments: &[IndexedSegment], cell_m: f32) -> BundleLevel {
    let account = Account {
        watch: &Watch::default(),
        all: segments.len(),
        done: AtomicUsize::new(0),
    };
    splat::finest(segments, MEAN, cell_m, &account)
}

/// Of the sizes of those.
const MEAN: [f32; 2] = [1.5, 150.0];

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
    let mut level = finest(&segments, 1e-3);
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
    let level = finest(&segments, 2e-3);
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
        let level = finest(&segments, 1e-2);
        let bins = level.bundles[0].bins;
        let at = angle / std::f32::consts::PI * BUNDLE_BINS as f32;
        let low = at as usize;
        assert_eq!(bins.iter().filter(|b| **b > 0).count(), 2, "{bins:?}");
        let [a, b] = [low, (low + 1) % BUNDLE_BINS].map(|i| f32::from(bins[i]));
        assert!((b / (a + b) - at.fract()).abs() < 0.01);
    }
}

/// How much wider and deeper than the mean scratches are is kept too, direction by direction.
#[test]
fn sizes_go_with_directions() {
    // The more they turn, the wider and the less deep: wider and deeper by a cosine of twice the angle.
    let mut segments = random_segments(3000);
    segments.retain(|s| s.normal.z > 0.0);
    for segment in &mut segments {
        let along = (segment.end_m - segment.start_m).normalize();
        let reference = Side::of(segment.normal).reference(segment.normal);
        let cosine = 2.0 * along.dot(reference).powi(2) - 1.0;
        segment.width_um = MEAN[0] * (1.0 + 0.1 * cosine);
        segment.depth_nm = MEAN[1] * (1.0 - 0.2 * cosine);
    }
    let mut level = finest(&segments, 1e-2);
    for _ in 0..2 {
        for bundle in &level.bundles {
            let [wider, deeper] = bundle.moved_scales.map(|scale| scale / 127.0);
            let mut errors = [0.0; 2];
            for b in 0..BUNDLE_BINS {
                let share = f32::from(bundle.bins[b]) * bundle.bin_scale / 255.0;
                let cosine = (std::f32::consts::TAU * b as f32 / BUNDLE_BINS as f32).cos();
                errors[0] += (wider * f32::from(bundle.wider[b]) - 0.1 * share * cosine).abs();
                errors[1] += (deeper * f32::from(bundle.deeper[b]) + 0.2 * share * cosine).abs();
            }
            // Each of 128 is rounded to a part in 254 of the largest, and a bin is a fortieth of a radian.
            assert!(errors[0] < 0.005 && errors[1] < 0.01, "{errors:?}");
        }
        level = splat::coarser(&level);
    }
}

#[test]
fn classes_hold_like_sizes() {
    let segments = random_segments(4000);
    let total = weight_um2(&segments);
    let classes = sizes::classes(segments, 4);
    assert_eq!(classes.len(), 4);
    assert!(
        (classes.iter().map(|c| weight_um2(&c.segments)).sum::<f64>() / total - 1.0).abs() < 1e-4
    );
    for class in &classes {
        let (mean, sizes) = (
            sizes::mean(&class.segments),
            sizes::representative(&class.segments),
        );
        let mean_of = |sizes: &[f64]| sizes.iter().sum::<f64>() / sizes.len() as f64;
        let widths: Vec<_> = sizes.iter().map(|part| part.width).collect();
        let depths: Vec<_> = sizes.iter().map(|part| mean_of(&part.depths)).collect();
        for sizes in [widths, depths] {
            assert!((mean_of(&sizes) - 1.0).abs() < 1e-3, "{sizes:?}");
        }
        let widest = class
            .segments
            .iter()
            .map(|s| s.width_um)
            .fold(0.0, f32::max);
        assert!(widest < 1.4 * mean[0], "{widest} {mean:?}");
    }
    // Two kinds of scratches are two classes, all alike are one.
    let mut kinds = vec![random_segments(1)[0]; 10];
    for kind in &mut kinds[3..] {
        kind.width_um *= 2.0;
    }
    let mut counts: Vec<_> = sizes::classes(kinds.clone(), 4)
        .iter()
        .map(|class| class.segments.len())
        .collect();
    counts.sort_unstable();
    assert_eq!(counts, [3, 7]);
    assert_eq!(sizes::classes(kinds[3..].to_vec(), 4).len(), 1);
}

/// Progress is told from 0 to 1, and who cancels gets nothing.
#[test]
fn work_is_watched() {
    let text = "[[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n\
                [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.05 } }\n\
                [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = 2000\nlength_m = 0.01\nwidth_um = 3.0\ndepth_nm = 200.0\n\
                [camera]\nposition_m = [0.0, 0.0, 1.0]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 0.0]\n";
    let scene = Scene::from_toml(text, "disk", ".").unwrap_or_else(|error| panic!("{error}"));
    let told = std::sync::Mutex::new(Vec::new());
    let watch = Watch {
        progress: &|share| told.lock().unwrap().push(share),
        ..Watch::default()
    };
    let grids = BundleIndex::watched(&scene, &watch).unwrap();
    assert!(grids.bytes() > 0);
    let told = told.into_inner().unwrap();
    assert!(told.len() > 3 && told.iter().all(|share| (0.0..=1.0).contains(share)));
    assert_eq!(told.last(), Some(&1.0));
    let watch = Watch {
        cancelled: &|| true,
        ..Watch::default()
    };
    assert!(BundleIndex::watched(&scene, &watch).is_none());
}
