//! The published method against the default path's closed forms where the talk's approximations are exact, on the line
//! xi_t = 0. (Those are held to quadrature in band/tests.rs; they share no formula with segments that are clipped and sorted.)

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::polygon::*;
use crate::sphere::sphere_segments;
use hairline_optics::band::{
    BandFrame, BandLine, Cap, PolygonView, polygon_facing, sphere_cap, sphere_chord,
};
use hairline_optics::diffraction::sinc_squared_integral;

const WIDTH_UM: f64 = 2.0;
const WAVELENGTH_UM: f64 = 0.555;

fn antiderivative(q: f64) -> f64 {
    sinc_squared_integral(WIDTH_UM * q, WAVELENGTH_UM) / WIDTH_UM
}

fn direction(random: &mut Pcg64Mcg, lowest_z: f64) -> DVec3 {
    let z = random.random_range(lowest_z..1.0);
    let (sin, cos) = random.random_range(0.0..2.0 * PI).sin_cos();
    let r = f64::sqrt(1.0 - z * z);
    DVec3::new(r * cos, r * sin, z)
}

fn cap(axis: DVec3, radius: f64) -> Cap {
    Cap {
        axis,
        sin_radius: radius.sin(),
        cos_radius: radius.cos(),
    }
}

/// A sphere near the line by both ways.
fn sphere_both(random: &mut Pcg64Mcg, off_by: f64) -> (f64, f64, usize) {
    let wo = direction(random, 0.0);
    let radius = 10f64.powf(random.random_range(-3.0..0.45));
    let along = (-wo.x + radius * random.random_range(-1.2..1.2)).clamp(-1.0, 1.0);
    let (sin, cos) = random.random_range(-PI..PI).sin_cos();
    let rest = (1.0 - along * along).sqrt();
    let axis = DVec3::new(along, rest * cos, rest * sin);
    let line = BandLine::new(wo, 0.0);
    let expected = sphere_chord(line, cap(axis, radius)).integral(line, |q| [antiderivative(q)])[0];
    let segments = sphere_segments(wo, cap(axis, radius * off_by));
    (segments.integral(antiderivative), expected, segments.count)
}

#[test]
fn spheres_equal_the_default_path_on_the_line() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let (mut worst, mut lit, mut counts): (f64, u32, [u32; 4]) = (0.0, 0, [0; 4]);
    for _ in 0..100_000 {
        let (value, expected, count) = sphere_both(&mut random, 1.0);
        counts[count] += 1;
        lit += (expected > 0.0) as u32;
        worst = worst.max((value - expected).abs());
    }
    println!("spheres: {lit} lit, {counts:?} by number of segments, worst difference {worst:.1e}");
    assert!(
        lit > 30_000 && counts[2] > 100,
        "the set must hold the hard cases"
    );
    assert!(worst < 1e-12, "{worst}");
}

#[test]
fn a_sphere_of_another_size_is_told_apart() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let different = (0..1000)
        .filter(|_| {
            let (value, expected, _) = sphere_both(&mut random, 1.01);
            (value - expected).abs() > 1e-7
        })
        .count();
    assert!(different > 300, "{different}");
}

#[test]
fn a_point_within_the_sphere_sees_it_all_around() {
    let wo = DVec3::new(0.6, 0.0, 0.8);
    let segments = sphere_segments(wo, sphere_cap(DVec3::new(0.1, 0.0, 0.0), 1.0));
    assert_eq!((segments.count, segments.ends[0]), (1, [-0.8, 0.8]));
}

/// Clip and sort, over all triangles of a polygon.
fn by_triangles(wo: DVec3, vertices: &[DVec3]) -> (f64, usize) {
    let mut most = 0;
    let sum = triangulate(vertices)
        .into_iter()
        .map(|corners| {
            let clipped = clip_triangle(corners.map(|i| vertices[i]));
            clipped
                .triangles()
                .map(|triangle| {
                    let segments = triangle_segments(wo, triangle);
                    most = most.max(segments.count);
                    segments.integral(antiderivative)
                })
                .sum::<f64>()
        })
        .sum();
    (sum, most)
}

fn by_roots(wo: DVec3, vertices: &[DVec3]) -> f64 {
    let directions: Vec<DVec3> = vertices.iter().map(|v| v.normalize_or_zero()).collect();
    let (away, facing) = polygon_facing(vertices.iter().copied(), true);
    let view = PolygonView {
        directions: &directions,
        away,
        facing,
    };
    let frame = BandFrame { tangent: DVec2::X };
    view.integral(frame, BandLine::new(wo, 0.0), |q| [antiderivative(q)])[0]
}

/// A planar polygon around a random centre that the line may meet: star-shaped, seldom convex beyond three vertices.
fn polygon(random: &mut Pcg64Mcg, wo: DVec3, count: usize) -> Vec<DVec3> {
    let size = 10f64.powf(random.random_range(-2.5..0.8));
    let along = (-wo.x + size * random.random_range(-0.7..0.7)).clamp(-1.0, 1.0);
    let (sin, cos) = random.random_range(-0.4..PI + 0.4).sin_cos();
    let rest = (1.0 - along * along).sqrt();
    let center = DVec3::new(along, rest * cos, rest * sin);
    let (u, v) = direction(random, -1.0).any_orthonormal_pair();
    let scale = random.random_range(0.5..20.0);
    (0..count)
        .map(|i| {
            let turn = i as f64 + 0.8 * random.random_range(0.0..1.0);
            let (sin, cos) = (2.0 * PI * turn / count as f64).sin_cos();
            scale * (center + size * random.random_range(0.2..1.0) * (u * cos + v * sin))
        })
        .collect()
}

/// Largest difference over random polygons of `count` vertices, each vertex times `stretch` for the published way.
fn worst_of_polygons(count: usize, number: usize, stretch: DVec3) -> f64 {
    let mut random = Pcg64Mcg::seed_from_u64(count as u64);
    let (mut worst, mut lit, mut across, mut counts): (f64, u32, u32, [u32; 4]) =
        (0.0, 0, 0, [0; 4]);
    for _ in 0..number {
        let wo = direction(&mut random, 0.0);
        let vertices = polygon(&mut random, wo, count);
        let expected = by_roots(wo, &vertices);
        let moved: Vec<DVec3> = vertices.iter().map(|v| v * stretch).collect();
        let (value, most) = by_triangles(wo, &moved);
        lit += (expected > 0.0) as u32;
        across += vertices
            .iter()
            .any(|v| (v.z < 0.0) != (vertices[0].z < 0.0)) as u32;
        counts[most] += 1;
        worst = worst.max((value - expected).abs());
    }
    println!(
        "polygons of {count}: {lit} of {number} lit, {across} across the horizon, {counts:?} by most segments of a triangle, worst difference {worst:.1e}"
    );
    assert!(
        lit as usize > number / 4 && across as usize > number / 10 && counts[2] > 0,
        "the set must hold the hard cases"
    );
    worst
}

#[test]
fn triangles_equal_the_default_path_on_the_line() {
    // The slack at corners adds points that lie 1e-6 outside.
    assert!(worst_of_polygons(3, 100_000, DVec3::ONE) < 1e-5);
}

#[test]
fn polygons_equal_the_default_path_on_the_line() {
    for count in [4, 5, 8, 13] {
        assert!(worst_of_polygons(count, 5_000, DVec3::ONE) < 1e-5);
    }
}

#[test]
fn a_stretched_triangle_is_told_apart() {
    assert!(worst_of_polygons(3, 2_000, DVec3::new(1.0, 1.0, 1.01)) > 1e-3);
}

#[test]
fn a_clipped_triangle_lies_above_the_horizon() {
    let above = [
        DVec3::Z,
        DVec3::new(1.0, 0.0, 0.5),
        DVec3::new(0.0, 1.0, 0.5),
    ];
    assert_eq!(clip_triangle(above).count, 3);
    assert_eq!(clip_triangle(above.map(|v| -v)).count, 0);
    let one_below = [above[0], above[1], DVec3::new(0.0, 1.0, -0.5)];
    let split = clip_triangle(one_below);
    assert_eq!((split.count, split.triangles().count()), (4, 2));
    assert!(split.corners.iter().all(|c| c.z >= 0.0));
    assert_eq!(
        clip_triangle(one_below.map(|v| v * DVec3::new(1.0, 1.0, -1.0))).count,
        3
    );
}

#[test]
fn the_network_sorts() {
    // 0-1 principle: a network that sorts every row of zeros and ones sorts everything.
    for bits in 0..256u32 {
        let row: [f64; 8] = std::array::from_fn(|i| (bits >> i & 1) as f64);
        assert!(bitonic_sort(row).is_sorted(), "{row:?}");
    }
}
