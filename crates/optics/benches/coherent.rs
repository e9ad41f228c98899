//! Benchmarks of the whole field: building it around a point, and one direction at the eight wavelengths of a sample.
//!
//! Directions are drawn as the renderer draws them: a third in the specular peak, a third in some groove's band, a third
//! anywhere.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use glam::DVec2;
use hairline_optics::coherent::{CoherentResponse, GrooveField, GroovePiece};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::{PI, TAU};
use std::hint::black_box;

const COHERENCE_UM: f64 = 20.0;
const DIRECTIONS: usize = 512;

fn piece(from: DVec2, to: DVec2, width_um: f64, depth_nm: f64) -> GroovePiece {
    let tangent = (to - from).normalize();
    GroovePiece {
        tangent,
        offset_um: from.dot(tangent.perp()),
        start_um: from.dot(tangent),
        end_um: to.dot(tangent),
        width_um,
        depth_nm,
    }
}

fn place(random: &mut Pcg64, reach_um: f64) -> DVec2 {
    reach_um
        * DVec2::new(
            random.random_range(-1.0..1.0),
            random.random_range(-1.0..1.0),
        )
}

/// Grooves of a worn plate: millimetres long and as wide as in the scenes, so that all that meet cross.
fn long_grooves(count: usize) -> Vec<GroovePiece> {
    let mut random = Pcg64::seed_from_u64(1);
    (0..count)
        .map(|_| {
            let middle = place(&mut random, 60.0);
            let half = 1000.0 * DVec2::from_angle(random.random_range(0.0..PI));
            let (width, depth) = (
                random.random_range(3.5..4.5),
                random.random_range(110.0..150.0),
            );
            piece(middle - half, middle + half, width, depth)
        })
        .collect()
}

/// Each of four pieces of 60 um that follow one arc, as cut at the triangles of a fine mesh.
fn curved_grooves(count: usize) -> Vec<GroovePiece> {
    let mut random = Pcg64::seed_from_u64(2);
    (0..count)
        .flat_map(|_| {
            let middle = place(&mut random, 50.0);
            let along = DVec2::from_angle(random.random_range(0.0..PI));
            let bend_per_um = random.random_range(-2e-3..2e-3);
            let (width, depth) = (
                random.random_range(3.0..5.0),
                random.random_range(110.0..150.0),
            );
            let at = move |s: f64| middle + s * along + 0.5 * bend_per_um * s * s * along.perp();
            (0..4).map(move |i| {
                let start = 60.0 * (f64::from(i) - 2.0);
                piece(at(start), at(start + 60.0), width, depth)
            })
        })
        .collect()
}

fn short_grooves(count: usize) -> Vec<GroovePiece> {
    let mut random = Pcg64::seed_from_u64(3);
    (0..count)
        .map(|_| {
            let middle = place(&mut random, 60.0);
            let half =
                random.random_range(5.0..40.0) * DVec2::from_angle(random.random_range(0.0..PI));
            let (width, depth) = (
                random.random_range(1.0..4.0),
                random.random_range(50.0..300.0),
            );
            piece(middle - half, middle + half, width, depth)
        })
        .collect()
}

fn directions(pieces: &[GroovePiece]) -> Vec<DVec2> {
    let mut random = Pcg64::seed_from_u64(4);
    (0..DIRECTIONS)
        .map(|i| {
            let far =
                random.random_range(0.0..1.0) * DVec2::from_angle(random.random_range(0.0..TAU));
            match i % 3 {
                0 => 0.01 * far,
                1 => {
                    let t = pieces[i / 3 % pieces.len()].tangent;
                    far - far.dot(t) * t + 0.01 * far.length() * t
                }
                _ => far,
            }
        })
        .collect()
}

fn coherent(c: &mut Criterion) {
    let wavelengths_nm: [f64; 8] = std::array::from_fn(|i| 400.0 + 50.0 * i as f64);
    for (name, pieces) in [
        ("8 long crossing grooves", long_grooves(8)),
        ("20 pieces of 5 curved grooves", curved_grooves(5)),
        ("30 short grooves", short_grooves(30)),
    ] {
        c.bench_function(&format!("{name}, field"), |b| {
            b.iter_batched(
                || pieces.clone(),
                |pieces| GrooveField::new(pieces, COHERENCE_UM),
                BatchSize::SmallInput,
            )
        });
        let field = GrooveField::new(pieces.clone(), COHERENCE_UM);
        let directions = directions(&pieces);
        let mut next = directions.iter().cycle();
        let mut out = [CoherentResponse::default(); 8];
        c.bench_function(&format!("{name}, direction"), |b| {
            b.iter(|| {
                let xi = *next.next().unwrap_or(&DVec2::ZERO);
                field.responses(black_box(xi), 1.8, &wavelengths_nm, true, &mut out);
                out[0].scratches
            })
        });
    }
}

criterion_group!(benches, coherent);
criterion_main!(benches);
