//! Tests of all wavelengths at once, by series, against the exact functions one by one; and of hidden parts against plain
//! slices.

use super::{pieces, random_grooves};
use glam::DVec2;
use hairline_optics::coherent::{
    CoherentResponse, GrooveField, GroovePiece, base_amplitude, phase_step, scratch_amplitude,
    window_fourier,
};
use num_complex::Complex64;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::PI;

const WAVELENGTHS_NM: [f64; 8] = [383.0, 433.0, 483.0, 533.0, 583.0, 633.0, 683.0, 733.0];
/// Bound of the errors of amplitudes, relative to the base's peak. Terms below 5e-10 are left out, and some tens of them may
/// add up.
const BOUND: f64 = 1e-8;

fn pick<T: Copy>(random: &mut Pcg64, from: &[T]) -> T {
    from[random.random_range(0..from.len())]
}

/// Grooves with much that is awkward: widths of 0 to 3 sigma, ends within the window or at infinity, no length, parallel to
/// another, the same as another, equal depths, at a flat angle.
fn awkward(random: &mut Pcg64, sigma: f64) -> Vec<GroovePiece> {
    let mut grooves: Vec<GroovePiece> = Vec::new();
    for _ in 0..random.random_range(1..5) {
        let width = match random.random_range(0..8) {
            0 => 0.0,
            1 => random.random_range(0.5..3.0),
            _ => random.random_range(0.01..0.3),
        };
        let start = random.random_range(-3.0..2.0);
        let (start, end) = match random.random_range(0..7) {
            0 => (f64::NEG_INFINITY, f64::INFINITY),
            1 => (f64::NEG_INFINITY, start),
            2 => (start, f64::INFINITY),
            3 => (start, start),
            4 => (-100.0 * start.abs(), 100.0 * start.abs()),
            5 => (start, start + random.random_range(0.0..0.5)),
            _ => (start, start + random.random_range(0.0..5.0)),
        };
        let mut groove = GroovePiece {
            tangent: DVec2::from_angle(random.random_range(-PI..PI)),
            offset_um: sigma * random.random_range(-4.0..4.0),
            start_um: sigma * start,
            end_um: sigma * end,
            width_um: sigma * width,
            depth_nm: pick(random, &[0.0, 60.0, 137.5, 140.0, 300.0]),
        };
        if let Some(&before) = grooves.last() {
            match random.random_range(0..8) {
                0 => groove = before,
                1 => groove.tangent = before.tangent,
                2 => (groove.tangent, groove.offset_um) = (-before.tangent, -before.offset_um),
                3 => groove.tangent = DVec2::from_angle(0.03).rotate(before.tangent),
                4 => groove.tangent = before.tangent.perp(),
                _ => {}
            }
        }
        grooves.push(groove);
    }
    grooves
}

/// Draws a direction in the peak, in a groove's band or across it, or anywhere.
fn direction(random: &mut Pcg64, grooves: &[GroovePiece]) -> DVec2 {
    let length = 10f64.powf(random.random_range(-3.0..0.2));
    let anywhere = DVec2::from_angle(random.random_range(-PI..PI));
    let tangent = pick(random, grooves).tangent;
    length
        * match random.random_range(0..5) {
            0 => tangent,
            1 => tangent.perp(),
            2 => tangent.perp() + 0.003 * anywhere,
            3 => DVec2::ZERO,
            _ => anywhere,
        }
}

fn error(a: Complex64, b: Complex64, sigma: f64, wavelength_nm: f64) -> f64 {
    (a - b).norm() / base_amplitude(DVec2::ZERO, sigma, wavelength_nm)
}

#[test]
fn all_wavelengths_at_once_equal_the_exact_ones() {
    let mut random = Pcg64::seed_from_u64(21);
    let mut worst = 0.0_f64;
    for round in 0..6000 {
        let sigma = 10f64.powf(random.random_range(0.0..1.7));
        let grooves = match round % 3 {
            0 => pieces(&random_grooves(
                8,
                2.0 * sigma,
                0.1 * sigma..30.0 * sigma,
                round,
            )),
            _ => awkward(&mut random, sigma),
        };
        let field = GrooveField::new(grooves, sigma);
        let xi = direction(&mut random, field.pieces());
        let cos_sum = random.random_range(0.0..2.0);
        // Whole lanes and less.
        let nm = &WAVELENGTHS_NM[..random.random_range(1..=8)];
        let mut amplitudes = [Complex64::ZERO; 8];
        field.amplitudes(xi, cos_sum, nm, &mut amplitudes);
        let mut responses = [CoherentResponse::default(); 8];
        field.responses(xi, cos_sum, nm, true, &mut responses);
        for (lane, &nm) in nm.iter().enumerate() {
            let exact = field.amplitude(xi, cos_sum, nm);
            let off = error(amplitudes[lane], exact, sigma, nm);
            assert!(off < BOUND, "{off:e} {xi} {sigma} {:#?}", field.pieces());
            worst = worst.max(off);
            let peak = base_amplitude(DVec2::ZERO, sigma, nm).powi(2) / (PI * sigma * sigma);
            let (f, exact) = (responses[lane], field.response(xi, cos_sum, nm, true));
            for (a, b) in [
                (f.base, exact.base),
                (f.cross, exact.cross),
                (f.scratches, exact.scratches),
            ] {
                // Twice the error of |S| times |S|, which is 2 at most and may be 4 where what overlaps is taken for joined.
                assert!((a - b).abs() < 8.0 * BOUND * peak, "{a} {b}");
            }
        }
    }
    println!("all wavelengths at once, relative to the base's peak: {worst:.1e}");
}

/// Numbers of any size, many of them degenerate on purpose.
#[test]
fn all_wavelengths_come_out_whatever_goes_in() {
    let mut random = Pcg64::seed_from_u64(23);
    let awkward = [0.0, -0.0, 1.0, -1.0, 1e-30, 1e9, -1e9];
    let mut number = || {
        if random.random_range(0.0..1.0) < 0.15 {
            pick(&mut random, &awkward)
        } else {
            random.random_range(-1.0..1.0) * 10f64.powf(random.random_range(-6.0..4.0))
        }
    };
    for _ in 0..10_000 {
        let grooves: Vec<GroovePiece> = (0..3)
            .map(|i| {
                let end = |x: f64| if x.abs() == 1e9 { x * f64::INFINITY } else { x };
                let (a, b) = (end(number()), end(number()));
                GroovePiece {
                    tangent: DVec2::from_angle(if i == 1 { 0.5 } else { number() }),
                    offset_um: number(),
                    start_um: a.min(b),
                    end_um: a.max(b),
                    width_um: number().abs(),
                    depth_nm: number(),
                }
            })
            .collect();
        let sigma = 10f64.powf(6.0 * number().clamp(-0.5, 1.0));
        let xi = DVec2::new(number(), number()).clamp_length_max(2.0);
        let field = GrooveField::new(grooves, sigma);
        let mut out = [CoherentResponse::default(); 8];
        field.responses(xi, 1.5, &WAVELENGTHS_NM, true, &mut out);
        for f in out {
            assert!(
                f.total().is_finite() && f.scratches >= 0.0,
                "{f:?} {xi} {sigma} {:#?}",
                field.pieces()
            );
        }
    }
}

/// A line across the plane's places v along a normal: which parts of a groove's line there lie in others.
fn hidden_intervals(
    piece: &GroovePiece,
    deeper: &[GroovePiece],
    across_um: f64,
    reach_um: f64,
) -> Vec<(f64, f64)> {
    let origin = across_um * piece.tangent.perp();
    let mut found: Vec<(f64, f64)> = Vec::new();
    for other in deeper {
        let half = 0.5 * other.width_um;
        let mut range = (piece.start_um.max(-reach_um), piece.end_um.min(reach_um));
        for (axis, low, high) in [
            (
                other.tangent.perp(),
                other.offset_um - half,
                other.offset_um + half,
            ),
            (other.tangent, other.start_um, other.end_um),
        ] {
            let (start, slope) = (origin.dot(axis), piece.tangent.dot(axis));
            if slope.abs() < 1e-13 {
                if start < low || start > high {
                    range.1 = f64::NEG_INFINITY;
                }
                continue;
            }
            let (a, b) = ((low - start) / slope, (high - start) / slope);
            range = (range.0.max(a.min(b)), range.1.min(a.max(b)));
        }
        if range.0 < range.1 {
            found.push(range);
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut apart: Vec<(f64, f64)> = Vec::new();
    for range in found {
        match apart.last_mut() {
            Some(last) if range.0 <= last.1 => last.1 = last.1.max(range.1),
            _ => apart.push(range),
        }
    }
    apart
}

/// The lines that bound a groove, as normal and distance.
fn edges(g: &GroovePiece) -> impl Iterator<Item = (DVec2, f64)> {
    let half = 0.5 * g.width_um;
    [
        (g.tangent.perp(), g.offset_um - half),
        (g.tangent.perp(), g.offset_um + half),
        (g.tangent, g.start_um),
        (g.tangent, g.end_um),
    ]
    .into_iter()
    .filter(|(_, distance)| distance.is_finite())
}

/// The Fourier integral of the part of a piece that deeper grooves hide, in thin slices along it. Slices are Gauss's on
/// panels that end wherever two edges meet, as what is hidden of a line has its kinks there.
fn hidden_by_slices(
    piece: &GroovePiece,
    deeper: &[GroovePiece],
    k_xi: DVec2,
    sigma: f64,
) -> Complex64 {
    let reach = 9.0 * sigma;
    let half = 0.5 * piece.width_um;
    let (near, far) = (
        (piece.offset_um - half).max(-reach),
        (piece.offset_um + half).min(reach),
    );
    if deeper.is_empty() || !(near < far) {
        return Complex64::ZERO;
    }
    let normal = piece.tangent.perp();
    let mut cuts = vec![near, far];
    let lines: Vec<(DVec2, f64)> = deeper.iter().chain([piece]).flat_map(edges).collect();
    for (i, &(m, p)) in lines.iter().enumerate() {
        // A jump where an edge runs along the piece.
        if m.perp_dot(normal).abs() < 1e-13 {
            cuts.push(p * m.dot(normal));
        }
        for &(n, q) in &lines[..i] {
            let sin = m.perp_dot(n);
            if sin.abs() > 1e-9 {
                cuts.push((p * n.perp() - q * m.perp()).dot(normal) / -sin);
            }
        }
    }
    cuts.retain(|v| (near..=far).contains(v));
    cuts.sort_by(f64::total_cmp);
    const NODES: [(f64, f64); 3] = [
        (0.238_619_186_083_196_9, 0.467_913_934_572_691_04),
        (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
        (0.932_469_514_203_152, 0.171_324_492_379_170_36),
    ];
    let (along, across) = (k_xi.dot(piece.tangent), k_xi.dot(normal));
    // At flat angles the hidden part of a line changes fast.
    let flattest = deeper
        .iter()
        .map(|g| g.tangent.perp_dot(piece.tangent).abs())
        .filter(|sin| *sin > 1e-9)
        .fold(1.0, f64::min);
    let longest = flattest * (0.4 * sigma).min(0.7 / k_xi.length().max(1e-300));
    let mut sum = Complex64::ZERO;
    for panel in cuts.windows(2) {
        let count = ((panel[1] - panel[0]) / longest).ceil();
        let half = 0.5 * (panel[1] - panel[0]) / count;
        for part in 0..count as usize {
            for (x, weight) in NODES.into_iter().flat_map(|(x, w)| [(x, w), (-x, w)]) {
                let v = panel[0] + half * ((2 * part + 1) as f64 + x);
                let window = (-0.5 * (v / sigma).powi(2)).exp() / ((2.0 * PI).sqrt() * sigma);
                let weight = Complex64::from_polar(half * weight * window, -across * v);
                for (start, end) in hidden_intervals(piece, deeper, v, reach) {
                    sum += weight * window_fourier(start, end, sigma, along);
                }
            }
        }
    }
    sum
}

#[test]
fn what_is_hidden_equals_slices() {
    let mut random = Pcg64::seed_from_u64(22);
    let (mut worst, mut hides) = (0.0_f64, 0);
    for round in 0..3000 {
        let sigma = 10f64.powf(random.random_range(0.3..1.5));
        let grooves = match round % 3 {
            0 => pieces(&random_grooves(5, sigma, sigma..30.0 * sigma, round)),
            _ => awkward(&mut random, sigma),
        };
        let field = GrooveField::new(grooves.clone(), sigma);
        let (xi, nm) = (
            direction(&mut random, &grooves),
            pick(&mut random, &WAVELENGTHS_NM),
        );
        let cos_sum = random.random_range(0.0..2.0);
        let k = 2e3 * PI / nm;
        let hidden: Complex64 = (0..grooves.len())
            .map(|i| {
                let deeper: Vec<GroovePiece> = (0..grooves.len())
                    .filter(|&j| (grooves[j].depth_nm, i) > (grooves[i].depth_nm, j))
                    .map(|j| grooves[j])
                    .collect();
                phase_step(grooves[i].depth_nm, cos_sum, nm)
                    * hidden_by_slices(&grooves[i], &deeper, k * xi, sigma)
            })
            .sum();
        let plain = scratch_amplitude(&grooves, xi, cos_sum, sigma, nm);
        let expected = plain - hidden * k * sigma * sigma;
        let off = error(field.amplitude(xi, cos_sum, nm), expected, sigma, nm);
        hides += usize::from(error(plain, expected, sigma, nm) > 1e-5);
        assert!(off < BOUND, "{round}: {off:e} {xi} {sigma} {grooves:#?}");
        worst = worst.max(off);
    }
    println!(
        "what is hidden, relative to the base's peak: {worst:.1e}; {hides} of 3000 hide something"
    );
    assert!(hides > 500, "{hides}");
}
