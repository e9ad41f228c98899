use super::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Long thin segments all over a square of 10 cm, on both sides of it.
fn random_segments(count: usize) -> Vec<IndexedSegment> {
    let mut random = Pcg64::seed_from_u64(1);
    (0..count)
        .map(|_| {
            let mut number = || random.random::<f32>();
            let middle = Vec3::new(0.1 * number(), 0.1 * number(), 0.0);
            let (sin, cos) = (std::f32::consts::PI * number()).sin_cos();
            let half = Vec3::new(cos, sin, 0.0) * 0.005 * number();
            IndexedSegment {
                start_m: middle - half,
                end_m: middle + half,
                normal: if number() < 0.2 { -Vec3::Z } else { Vec3::Z },
                width_um: 1.0 + number(),
                depth_nm: 100.0 + 100.0 * number(),
                blur_um: 16.0,
            }
        })
        .collect()
}

/// The segments below each node.
fn below(tree: &ClusterTree, at: usize) -> &[IndexedSegment] {
    let nodes = &tree.nodes[at..tree.nodes[at].skip as usize];
    let ranges = nodes.iter().map(|n| n.segments()).filter(|r| !r.is_empty());
    let start = ranges.clone().map(|r| r.start).min().unwrap_or(0);
    let end = ranges.map(|r| r.end).max().unwrap_or(0);
    &tree.segments[start..end]
}

#[test]
fn nodes_bound_and_sum_what_is_below() {
    for count in [1, 4, 5, 3000] {
        let segments = random_segments(count);
        let tree = ClusterTree::build(segments.clone());
        let mut sorted = tree.segments.clone();
        let key = |s: &IndexedSegment| s.start_m.x;
        sorted.sort_by(|a, b| key(a).total_cmp(&key(b)));
        let mut expected = segments;
        expected.sort_by(|a, b| key(a).total_cmp(&key(b)));
        assert_eq!(sorted, expected, "each segment is in one leaf");
        for (at, node) in tree.nodes.iter().enumerate() {
            assert!(node.skip as usize > at);
            let below = below(&tree, at);
            let weight: f64 = below
                .iter()
                .map(|s| s.width_um as f64 * s.start_m.distance(s.end_m) as f64 * 1e6)
                .sum();
            assert!((node.weight_um2 as f64 / weight - 1.0).abs() < 1e-5);
            assert!(node.stray_um <= node.parent_stray_um);
            assert!(node.turn_rad <= node.parent_turn_rad);
            for segment in below {
                for end in [segment.start_m, segment.end_m] {
                    let v = end - node.center_m;
                    let along = v.dot(node.axis);
                    assert!(along.abs() <= node.half_m + 1e-8);
                    assert!((v - along * node.axis).length() <= node.radius_m + 1e-8);
                }
                let t = (segment.end_m - segment.start_m).normalize();
                assert!(t.dot(node.axis).abs() >= node.spread[1] - 1e-6);
                if node.stray_um.is_finite() {
                    assert!(segment.normal.dot(node.normal) > 0.5, "both sides in one");
                }
            }
        }
    }
}
