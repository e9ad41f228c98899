//! Outlines against [`PolygonView`].

use super::*;
use crate::band::{PolygonView, polygon_facing};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// A star about a random direction: simple, seldom convex, often across the horizon, sometimes over the nadir or around the
/// tangent.
fn star(random: &mut Pcg64) -> Vec<DVec3> {
    let mut number = |low: f64, high: f64| random.random_range(low..high);
    let axis = loop {
        let v = DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 0.6));
        if v.length() > 0.1 {
            break v.normalize();
        }
    };
    let (x, y) = axis.any_orthonormal_pair();
    let size = 10f64.powf(number(-1.5, 1.0));
    let lean = number(-0.9, 0.9);
    let corners = 3 + number(0.0, 6.0) as usize;
    (0..corners)
        .map(|i| {
            let angle = TAU * (i as f64 + number(0.0, 0.9)) / corners as f64;
            let v = DVec2::from_angle(angle) * size * number(0.3, 1.0);
            axis * (1.0 + lean * v.x / size) + x * v.x + y * v.y
        })
        .collect()
}

#[test]
fn an_outline_is_its_polygon() {
    let mut random = Pcg64::seed_from_u64(1);
    let (mut crossed, mut held, mut poles, mut turned) = (0, 0, 0, 0);
    let mut roots = OutlineRoots::default();
    for _ in 0..20_000 {
        let vertices = star(&mut random);
        let directions: Vec<DVec3> = vertices.iter().map(|v| v.normalize()).collect();
        let (away, facing) = polygon_facing(vertices.iter().copied(), true);
        let view = PolygonView {
            directions: &directions,
            away,
            facing,
        };
        let edges: Vec<OutlineEdge> = OutlineEdge::of_outline(&directions).collect();
        let outline = Outline {
            edges: &edges,
            away,
            facing,
            sets: vertices.iter().any(|v| v.z < 0.0),
        };
        let frame = BandFrame {
            tangent: DVec2::from_angle(random.random_range(0.0..TAU)),
        };
        let wo_t = random.random_range(-0.9..0.9);
        let wo = DVec3::new(wo_t, 0.0, (1.0 - wo_t * wo_t).sqrt());
        let (expected, extent) = (
            view.band_extent(frame, wo),
            outline.band_extent(frame, wo.x),
        );
        assert!(
            (expected.0 - extent.0).abs() < 1e-9 && (expected.1 - extent.1).abs() < 1e-9,
            "{vertices:?}: {extent:?} {expected:?}"
        );
        poles += i32::from(extent.0 == wo.x - 1.0 || extent.1 == wo.x + 1.0);

        let inside = extent.0 + (extent.1 - extent.0) * random.random_range(-0.1..1.1);
        let line = BandLine::new(wo, inside);
        outline.roots(frame, line, &mut roots);
        // Three antiderivatives, so that roots cannot stand for one another.
        let up_to = |q: f64| [q, q * q, q * q * q];
        let (expected, value) = (view.integral(frame, line, up_to), roots.integral(up_to));
        let range = view.range(frame, line);
        for (a, b) in expected
            .into_iter()
            .zip(value)
            .chain([(range.0, roots.range.0), (range.1, roots.range.1)])
        {
            assert!((a - b).abs() < 1e-6, "{vertices:?}: {value:?} {expected:?}");
        }
        crossed += i32::from(!roots.roots.is_empty());
        held += i32::from(
            roots.roots.len() % 2 == 0
                && roots.roots.iter().any(|r| r.1 == line.q_start())
                && roots.roots.iter().any(|r| r.1 == line.q_end()),
        );
        let other = Outline {
            facing: -facing,
            ..outline
        };
        other.roots(frame, line, &mut roots);
        turned += i32::from((roots.integral(up_to)[0] - expected[0]).abs() > 1e-3);
    }
    println!(
        "{crossed} crossed, {held} with the whole arc, {poles} to the pole, {turned} seen to be turned"
    );
    assert!(crossed > 10_000 && held > 500 && poles > 200 && turned > 5_000);
}
