//! Benchmarks of one scratch under one light, step by step: the default path beside the method of 2018.
//!
//! Inputs are drawn beforehand, near the band, so that most lights meet it.

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DVec2, DVec3};
use hairline_optics::band::{
    BandFrame, BandLine, Cap, PolygonView, band_lines, band_stds, polygon_facing, sphere_cap,
    sphere_chord,
};
use hairline_optics::footprint::{Footprint, scratch_share};
use hairline_optics::fresnel::FresnelRgb;
use hairline_optics::ltc::polygon_light;
use hairline_optics::metal::Metal;
use hairline_optics::table::ScratchTable;
use hairline_published::footprint::{PixelFootprint, published_share};
use hairline_published::polygon::triangle_segments;
use hairline_published::sine_integral::SineIntegral;
use hairline_published::spectrum::{PUBLISHED_WAVELENGTHS, PublishedSpectrum};
use hairline_published::sphere::sphere_segments;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::hint::black_box;

const COHERENCE_UM: f64 = 20.0;
const WIDTH_UM: f64 = 3.0;
const DEPTH_NM: f64 = 165.0;
const INPUTS: usize = 1024;

/// A bench over inputs that follow one another.
fn bench<T>(c: &mut Criterion, name: &str, inputs: &[T], mut run: impl FnMut(&T) -> f64) {
    let mut at = 0;
    c.bench_function(name, |b| {
        b.iter(|| {
            at = (at + 1) % inputs.len();
            run(black_box(&inputs[at]))
        })
    });
}

fn draw<T>(seed: u64, mut one: impl FnMut(&mut Pcg64) -> T) -> Vec<T> {
    let mut random = Pcg64::seed_from_u64(seed);
    (0..INPUTS).map(|_| one(&mut random)).collect()
}

/// A viewer, and the direction in which the mirror would send their light off, up to 0.05 to the side of the band.
fn viewer_and_light(random: &mut Pcg64) -> (DVec3, DVec3) {
    let wo = DVec3::new(
        random.random_range(-0.6..0.6),
        random.random_range(-0.6..0.6),
        1.0,
    )
    .normalize();
    let along = -wo.x + random.random_range(-0.05..0.05);
    let across = random.random_range(-0.6..0.6);
    (
        wo,
        DVec3::new(along, across, 1.0 - along * along - across * across).normalize(),
    )
}

/// A sphere of 0.01 to 0.3 rad.
fn sphere(random: &mut Pcg64) -> (DVec3, Cap) {
    let (wo, axis) = viewer_and_light(random);
    (
        wo,
        sphere_cap(axis, 10f64.powf(random.random_range(-2.0..-0.5))),
    )
}

/// Corners of a regular polygon about a light of such a size.
fn polygon(random: &mut Pcg64, corners: usize) -> (DVec3, Vec<DVec3>) {
    let (wo, axis) = viewer_and_light(random);
    let (x, y) = axis.any_orthonormal_pair();
    let size = 10f64.powf(random.random_range(-2.0..-0.5));
    let vertices = (0..corners)
        .map(|i| {
            let v = DVec2::from_angle(std::f64::consts::TAU * i as f64 / corners as f64);
            (axis + size * (x * v.x + y * v.y)).normalize()
        })
        .collect();
    (wo, vertices)
}

fn spectra(c: &mut Criterion) {
    let gold = |nm| Metal::Gold.reflectance(1.0, nm);
    let table = ScratchTable::new(gold);
    let places = draw(1, |random| random.random_range(-5.0..5.0));
    bench(c, "scratch_table", &places, |u| {
        table.scratch_table(*u, DEPTH_NM)[1]
    });
    let spectrum = PublishedSpectrum::new(PUBLISHED_WAVELENGTHS, gold);
    let segments = draw(2, |random| {
        let (wo, cap) = sphere(random);
        sphere_segments(wo, cap)
    });
    for (name, si) in [
        (
            "published_radiance, 8 wavelengths, fast Si",
            SineIntegral::Fast,
        ),
        (
            "published_radiance, 8 wavelengths, exact Si",
            SineIntegral::Exact,
        ),
    ] {
        bench(c, name, &segments, |segments| {
            spectrum.radiance(segments, WIDTH_UM, DEPTH_NM, si)[1]
        });
    }
}

fn chords(c: &mut Criterion) {
    let extents = draw(3, |random| {
        let (middle, half) = (
            random.random_range(-0.01..0.01),
            10f64.powf(random.random_range(-3.0..-0.5)),
        );
        (middle - half, middle + half)
    });
    let stds = band_stds(COHERENCE_UM);
    bench(c, "band_lines and their weights", &extents, |extent| {
        let lines = band_lines(0.3, extent.0, extent.1, stds);
        (0..lines.count).map(|i| lines.band_line(i).1.y).sum()
    });
    let spheres = draw(4, sphere);
    bench(c, "sphere_chord", &spheres, |(wo, cap)| {
        sphere_chord(BandLine::new(*wo, 0.0), *cap).enter
    });
    bench(c, "sphere_segments (published)", &spheres, |(wo, cap)| {
        sphere_segments(*wo, *cap).integral(|q| q)
    });
    for (name, corners) in [("triangle", 3), ("hexagon", 6)] {
        let polygons = draw(5, |random| polygon(random, corners));
        let frame = BandFrame { tangent: DVec2::X };
        bench(
            c,
            &format!("polygon integral, {name}"),
            &polygons,
            |(wo, vertices)| {
                let (away, facing) = polygon_facing(vertices.iter().copied(), true);
                let view = PolygonView {
                    directions: vertices,
                    away,
                    facing,
                };
                view.integral(frame, BandLine::new(*wo, 0.0), |q| [q])[0]
            },
        );
    }
    let triangles = draw(5, |random| polygon(random, 3));
    bench(c, "triangle_segments (published)", &triangles, |(wo, v)| {
        triangle_segments(*wo, [v[0], v[1], v[2]]).integral(|q| q)
    });
    bench(
        c,
        "base: ltc polygon_light, triangle",
        &triangles,
        |(wo, v)| polygon_light(*wo, 0.2, FresnelRgb::schlick([0.9; 3]), v)[0],
    );
}

fn footprints(c: &mut Criterion) {
    let places = draw(6, |random| {
        let axes = [
            DVec2::new(random.random_range(10.0..60.0), 0.0),
            DVec2::new(0.0, random.random_range(10.0..60.0)),
        ];
        let turn = DVec2::from_angle(random.random_range(0.0..3.0));
        (
            random.random_range(-60.0..60.0),
            random.random_range(-500.0..0.0),
            axes.map(|a| turn.rotate(a)),
        )
    });
    bench(c, "scratch_share", &places, |(offset, start, [x, y])| {
        let footprint = Footprint {
            across_um2: x.y * x.y + y.y * y.y,
            along_um2: x.x * x.x + y.x * y.x,
            cross_um2: x.x * x.y + y.x * y.y,
        };
        let end = start + 500.0;
        scratch_share(
            WIDTH_UM,
            *offset,
            *start,
            end,
            16.5,
            footprint,
            COHERENCE_UM,
        )
        .segment
    });
    bench(c, "published_share", &places, |(offset, start, [x, y])| {
        let pixel = PixelFootprint {
            right_um: *x,
            down_um: *y,
        };
        let end = start + 500.0;
        published_share(WIDTH_UM, *offset, *start, end, 16.5, pixel, COHERENCE_UM).share
    });
}

criterion_group!(benches, spectra, chords, footprints);
criterion_main!(benches);
