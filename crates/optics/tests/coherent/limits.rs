//! Limits, additivity, quadrature, awkward inputs.

use super::{pieces, random_grooves};
use glam::DVec2;
use hairline_optics::coherent::{
    CoherentResponse, GrooveField, GroovePiece, base_amplitude, coherent_response,
    groove_amplitude, groove_overlap, phase_step, scratch_amplitude, window_fourier,
};
use hairline_optics::scratch::{phase_step_energy, window_overlap_um2, window_share};
use num_complex::Complex64;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::PI;

/// The window's Fourier integral by the trapezoid rule with Richardson's extrapolation, 24 steps a period or more.
fn quadrature(low: f64, high: f64, sigma: f64, kappa: f64) -> Complex64 {
    let (low, high) = (low.max(-9.0 * sigma), high.min(9.0 * sigma));
    if low >= high {
        return Complex64::ZERO;
    }
    // Gauss-Legendre with 5 nodes on panels short against window and period.
    let nodes = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let panel = (0.2 * sigma).min(0.5 / kappa.abs().max(1e-300));
    let count = ((high - low) / panel).ceil().max(1.0);
    let half = 0.5 * (high - low) / count;
    let mut sum = Complex64::ZERO;
    for i in 0..count as usize {
        let middle = low + half * (2 * i + 1) as f64;
        for (x, weight) in nodes {
            let s = middle + half * x;
            let w = (-0.5 * (s / sigma).powi(2)).exp();
            sum += Complex64::from_polar(w * weight * half, -kappa * s);
        }
    }
    sum / ((2.0 * PI).sqrt() * sigma)
}

#[test]
fn the_windows_fourier_integral_equals_quadrature() {
    let mut random = Pcg64::seed_from_u64(1);
    let mut worst = [0.0_f64; 2];
    for _ in 0..3000 {
        let sigma = 10f64.powf(random.random_range(0.0..2.0));
        // Range from within the band to a hundred times its width.
        let kappa = 10f64.powf(random.random_range(-3.0..2.3)) / sigma;
        let a = sigma * random.random_range(-5.0..5.0);
        let b = a + sigma * 10f64.powf(random.random_range(-2.0..1.0));
        let found = window_fourier(a, b, sigma, kappa);
        let expected = quadrature(a, b, sigma, kappa);
        let error = (found - expected).norm();
        // Relative to the largest that an interval in this place can give: its share without the phase.
        let scale = quadrature(a, b, sigma, 0.0).norm();
        worst[0] = worst[0].max(error);
        worst[1] = worst[1].max(error / scale);
    }
    println!(
        "window_fourier against quadrature: {:.1e}, relative {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst[0] < 1e-13 && worst[1] < 1e-10, "{worst:?}");
}

/// Far off the band the field comes from the ends alone, as 1/(kappa s): erf would be inf times 0 there.
#[test]
fn far_off_the_band_the_ends_remain() {
    for kappa_sigma in [1e2, 1e3, 1e4] {
        let found = window_fourier(f64::NEG_INFINITY, 0.0, 20.0, kappa_sigma / 20.0);
        let expected = Complex64::new(0.0, 1.0 / ((2.0 * PI).sqrt() * kappa_sigma));
        assert!(
            (found / expected - 1.0).norm() < 2.0 / kappa_sigma.powi(2) + 1e-12,
            "{found}"
        );
        let endless = window_fourier(f64::NEG_INFINITY, f64::INFINITY, 20.0, kappa_sigma / 20.0);
        assert_eq!(endless, Complex64::ZERO);
    }
}

fn endless(width_um: f64, depth_nm: f64, offset_um: f64) -> GroovePiece {
    GroovePiece {
        tangent: DVec2::from_angle(0.7),
        offset_um,
        start_um: f64::NEG_INFINITY,
        end_um: f64::INFINITY,
        width_um,
        depth_nm,
    }
}

/// A groove as wide as the plane and half a wave's phase deep turns the mirror's sign and nothing else.
#[test]
fn a_plane_of_grooves_is_a_mirror() {
    let plane = endless(1e4, 137.5, 0.0);
    for xi in [DVec2::ZERO, DVec2::new(0.004, 0.002)] {
        let f = coherent_response([&plane], xi, 2.0, 20.0, 550.0, true);
        let mirror = coherent_response([], xi, 2.0, 20.0, 550.0, true);
        assert!((f.total() / mirror.total() - 1.0).abs() < 1e-12, "{f:?}");
        assert!((f.scratches / (4.0 * f.base) - 1.0).abs() < 1e-12);
    }
}

/// An endless groove far narrower than the window is (2) with (4): Gaussian along, sinc across, and no more.
#[test]
fn an_endless_groove_is_separable() {
    let (sigma, wavelength_um) = (20.0, 0.55);
    let k = 2.0 * PI / wavelength_um;
    let groove = endless(0.1, 140.0, 7.0);
    let (t, n) = (groove.tangent, groove.tangent.perp());
    for (along, across) in [(0.0, 0.2), (0.003, -0.5), (0.008, 0.9)] {
        let found = groove_amplitude(&groove, along * t + across * n, sigma, 550.0);
        let eta2 = (-(k * sigma * along).powi(2)).exp()
            * window_overlap_um2(groove.offset_um, f64::NEG_INFINITY, f64::INFINITY, sigma);
        let x = 0.5 * k * groove.width_um * across;
        let expected = (groove.width_um / wavelength_um * x.sin() / x).powi(2) * eta2;
        // The window's fall across: (W p/sigma^2)^2/24 and below.
        assert!(
            (found.norm_sqr() / expected - 1.0).abs() < 1e-4,
            "{found} {expected}"
        );
        let phase = found * Complex64::from_polar(1.0, k * across * groove.offset_um);
        assert!(
            phase.re > 0.0 && phase.im.abs() < 1e-2 * phase.re,
            "{phase}"
        );
    }
}

/// The exact eta is the separable one in the band's middle, with ends far away or near; off it only the exact one has
/// light.
#[test]
fn ends_scatter_off_the_band() {
    let mut groove = endless(1.0, 140.0, 3.0);
    let (t, n) = (groove.tangent, groove.tangent.perp());
    let at = |groove: &GroovePiece, along: f64| {
        groove_amplitude(groove, along * t + 0.2 * n, 20.0, 550.0).norm_sqr()
    };
    let far = at(&groove, 0.0);
    (groove.start_um, groove.end_um) = (-130.0, 140.0);
    assert!((at(&groove, 0.0) / far - 1.0).abs() < 1e-9);
    assert!(at(&groove, 0.1) < 1e-16 * far);
    groove.end_um = 10.0;
    let e = window_overlap_um2(3.0, -130.0, 10.0, 20.0)
        / window_overlap_um2(3.0, f64::NEG_INFINITY, f64::INFINITY, 20.0);
    assert!((at(&groove, 0.0) / far / e - 1.0).abs() < 1e-9);
    assert!(at(&groove, 0.1) > 1e-5 * far);
}

/// |S|^2 over the plane is |D|^2 times the share of (6), and the cross term takes exactly as much from the base.
#[test]
fn one_groove_radiates_its_share_and_takes_it_from_the_base() {
    let (sigma, wavelength_um) = (20.0, 0.55);
    let groove = endless(1.5, 100.0, 9.0);
    let (t, n) = (groove.tangent, groove.tangent.perp());
    let k = 2.0 * PI / wavelength_um;
    // Along t a Gaussian; across, sinc^2 to Q with a tail of lambda/(pi^2 W Q).
    let (ht, hn, reach) = (0.25 / (k * sigma), 0.25 / (k * sigma), 20.0);
    let mut sum = CoherentResponse::default();
    for j in -((reach / hn) as i64)..=(reach / hn) as i64 {
        for i in -24..=24 {
            let xi = i as f64 * ht * t + j as f64 * hn * n;
            let f = coherent_response([&groove], xi, 2.0, sigma, 550.0, true);
            sum.base += f.base * ht * hn;
            sum.cross += f.cross * ht * hn;
            sum.scratches += f.scratches * ht * hn;
        }
    }
    let energy = phase_step_energy(100.0, 550.0);
    let overlap = window_overlap_um2(9.0, f64::NEG_INFINITY, f64::INFINITY, sigma);
    let share = window_share(1.5, overlap, sigma);
    println!("one groove: {sum:?}, share {:.6}", energy * share);
    assert!((sum.base - 1.0).abs() < 1e-9);
    assert!((sum.scratches / (energy * share) - 1.0).abs() < 3e-3);
    assert!((sum.cross / -(energy * groove_overlap(&groove, sigma)) - 1.0).abs() < 1e-9);
    assert!((groove_overlap(&groove, sigma) / share - 1.0).abs() < 1e-3);
}

#[test]
fn phase_step_is_that_of_its_energy() {
    for depth in [0.0, 1e-6, 80.0, 137.5, 275.0, 900.0] {
        let d = phase_step(depth, 2.0, 550.0);
        let expected = 1.0 - Complex64::from_polar(1.0, -4.0 * PI * depth / 550.0);
        assert!((d - expected).norm() < 1e-14);
        assert!((d.norm_sqr() - phase_step_energy(depth, 550.0)).abs() < 1e-14);
        assert!((d.norm_sqr() - 2.0 * d.re).abs() < 1e-14);
        // At 60 degrees in and out a groove has the phase of half its depth.
        assert!(
            (phase_step(depth, 1.0, 550.0) - phase_step(0.5 * depth, 2.0, 550.0)).norm() < 1e-14
        );
    }
}

/// A straight groove cut in pieces of any length is the whole one.
#[test]
fn pieces_sum_to_the_whole() {
    let mut random = Pcg64::seed_from_u64(5);
    let mut worst = [0.0_f64; 2];
    for groove in pieces(&random_grooves(200, 30.0, 10.0..300.0, 6)) {
        let mut ends: Vec<f64> = (0..9)
            .map(|_| random.random_range(groove.start_um..groove.end_um))
            .chain([groove.start_um, groove.end_um])
            .collect();
        ends.sort_by(f64::total_cmp);
        let cut: Vec<GroovePiece> = ends
            .windows(2)
            .map(|e| GroovePiece {
                start_um: e[0],
                end_um: e[1],
                ..groove
            })
            .collect();
        let xi = 10f64.powf(random.random_range(-4.0..0.0))
            * DVec2::from_angle(random.random_range(0.0..6.3));
        let whole = scratch_amplitude([&groove], xi, 2.0, 20.0, 550.0);
        let parts = scratch_amplitude(&cut, xi, 2.0, 20.0, 550.0);
        let scale = base_amplitude(DVec2::ZERO, 20.0, 550.0);
        worst[0] = worst[0].max((whole - parts).norm() / scale);
        let overlap: f64 = cut.iter().map(|g| groove_overlap(g, 20.0)).sum();
        worst[1] = worst[1].max((groove_overlap(&groove, 20.0) - overlap).abs());
    }
    println!(
        "pieces against the whole, relative to the base: {:.1e}, overlap {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst[0] < 1e-14 && worst[1] < 1e-14, "{worst:?}");
}

/// A field without crossings is the plain sum, and a groove cut in pieces hides nothing.
#[test]
fn a_field_without_crossings_is_the_sum() {
    let groove = pieces(&random_grooves(1, 5.0, 60.0..80.0, 3))[0];
    let beside = GroovePiece {
        offset_um: groove.offset_um + 7.0,
        ..groove
    };
    let cut = [-20.0, -3.0, 4.0, 20.0]
        .windows(2)
        .map(|e| GroovePiece {
            start_um: e[0],
            end_um: e[1],
            ..groove
        })
        .collect::<Vec<_>>();
    let all: Vec<GroovePiece> = cut.into_iter().chain([beside]).collect();
    let field = GrooveField::new(all.clone(), 20.0);
    for xi in [DVec2::ZERO, DVec2::new(0.02, -0.1), DVec2::new(0.7, 0.4)] {
        let sum = coherent_response(&all, xi, 1.9, 20.0, 550.0, true);
        assert_eq!(field.response(xi, 1.9, 550.0, true), sum);
    }
}

/// A groove that bends is the sum of its pieces: their overlap within and their gap without are alike.
#[test]
fn a_bend_hides_nothing() {
    let before = GroovePiece {
        start_um: -100.0,
        end_um: 0.0,
        ..endless(1.0, 140.0, 0.0)
    };
    let after = GroovePiece {
        tangent: DVec2::from_angle(0.3).rotate(before.tangent),
        start_um: 0.0,
        end_um: 100.0,
        ..before
    };
    let field = GrooveField::new(vec![before, after], 20.0);
    let xi = 0.3 * before.tangent.perp();
    let sum = scratch_amplitude(field.pieces(), xi, 2.0, 20.0, 550.0);
    assert_eq!(field.amplitude(xi, 2.0, 550.0), sum);
    // Pieces of two grooves do hide one another there.
    let other = GroovePiece {
        depth_nm: 90.0,
        ..after
    };
    let field = GrooveField::new(vec![before, other], 20.0);
    let sum = scratch_amplitude(field.pieces(), xi, 2.0, 20.0, 550.0);
    assert_ne!(field.amplitude(xi, 2.0, 550.0), sum);
}

/// Two grooves at right angles share as much of the window as the product of the shares of each strip. A patch takes the
/// window's energy as exponential: off by L^2/12 sigma^2 in each direction, 0.7 % at a fifth of sigma, times |D| below 2.
#[test]
fn a_square_crossing_counts_once() {
    for width in [1.0, 3.5, 9.0] {
        let one = endless(width, 140.0, 11.0);
        let other = GroovePiece {
            tangent: one.tangent.perp(),
            offset_um: -8.0,
            depth_nm: 90.0,
            ..one
        };
        let shares = [one, other].map(|g| groove_overlap(&g, 20.0));
        let field = GrooveField::new(vec![one, other], 20.0);
        let found = field.mean_reflection(2.0, 550.0);
        let expected = 1.0
            - phase_step(140.0, 2.0, 550.0) * shares[0]
            - phase_step(90.0, 2.0, 550.0) * (shares[1] - shares[0] * shares[1]);
        assert!(
            (found - expected).norm() < 1.4e-2 * shares[0] * shares[1],
            "{width}: {found} {expected}"
        );
    }
}

/// Turning a groove's direction about names the same groove.
#[test]
fn a_groove_has_no_direction() {
    for g in pieces(&random_grooves(50, 30.0, 10.0..300.0, 8)) {
        let turned = GroovePiece {
            tangent: -g.tangent,
            offset_um: -g.offset_um,
            start_um: -g.end_um,
            end_um: -g.start_um,
            ..g
        };
        let xi = DVec2::new(0.013, -0.021);
        let a = groove_amplitude(&g, xi, 20.0, 550.0);
        let b = groove_amplitude(&turned, xi, 20.0, 550.0);
        assert!((a - b).norm() < 1e-12, "{a} {b}");
    }
}

/// A million configurations, many of them degenerate on purpose.
#[test]
fn numbers_come_out_whatever_goes_in() {
    let mut random = Pcg64::seed_from_u64(9);
    let awkward = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-30,
        1e-7,
        1e9,
        -1e9,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ];
    let mut before = [endless(1.0, 100.0, 0.0); 2];
    for round in 0..1_000_000 {
        let row: [f64; 8] = std::array::from_fn(|_| {
            if random.random_range(0.0..1.0) < 0.15 {
                awkward[random.random_range(0..awkward.len())]
            } else {
                random.random_range(-1.0..1.0) * 10f64.powf(random.random_range(-6.0..4.0))
            }
        });
        // Quantities that must be positive are, ends are in order, directions are finite.
        let finite = |x: f64| if x.is_finite() { x } else { 1.0 };
        let groove = GroovePiece {
            tangent: DVec2::from_angle(finite(row[0])),
            offset_um: finite(row[1]),
            start_um: row[2].min(row[3]),
            end_um: row[2].max(row[3]),
            width_um: finite(row[4]).abs(),
            depth_nm: finite(row[5]),
        };
        let xi = DVec2::new(finite(row[6]), finite(row[7])).clamp_length_max(2.0);
        let sigma = 10f64.powf(random.random_range(-3.0..6.0));
        let wavelength = random.random_range(300.0..900.0);
        let f = coherent_response(
            [&groove, &groove],
            xi,
            random.random_range(0.0..2.0),
            sigma,
            wavelength,
            true,
        );
        let overlap = groove_overlap(&groove, sigma);
        assert!(
            f.total().is_finite() && f.scratches >= 0.0 && f.base >= 0.0,
            "{groove:?} {xi} {sigma}: {f:?}"
        );
        assert!(
            (-1e-15..=1.0 + 1e-15).contains(&overlap),
            "{groove:?} {sigma}: {overlap}"
        );
        // One floor for this groove and the two before it; in fewer rounds, since widths of 1e9 um take many slices.
        if round % 100 == 0 {
            let field = GrooveField::new(vec![before[0], groove, before[1]], sigma);
            let f = field.response(xi, 1.5, wavelength, true);
            assert!(f.total().is_finite(), "{:?} {xi}: {f:?}", field.pieces());
            assert!(
                field.mean_reflection(1.5, wavelength).norm() < 1.0 + 1e-3,
                "{field:?}"
            );
        }
        before = [before[1], groove];
        // No phase can make a groove stronger than the base's peak.
        let amplitude = groove_amplitude(&groove, xi, sigma, wavelength).norm();
        assert!(
            amplitude <= base_amplitude(DVec2::ZERO, sigma, wavelength) * (1.0 + 1e-12),
            "{groove:?}"
        );
    }
}

/// Prints the time of a term. It is not bounded, since machines differ.
#[test]
fn a_term_is_cheap() {
    let mut random = Pcg64::seed_from_u64(2);
    let grooves = pieces(&random_grooves(10, 30.0, 20.0..200.0, 7));
    let directions: Vec<DVec2> = (0..20_000)
        .map(|_| random.random_range(0.0..1.0) * DVec2::from_angle(random.random_range(0.0..6.3)))
        .collect();
    let start = std::time::Instant::now();
    let sum: f64 = directions
        .iter()
        .map(|&xi| coherent_response(&grooves, xi, 1.8, 20.0, 550.0, true).total())
        .sum();
    let count = (directions.len() * grooves.len()) as f64;
    let plain_ns = start.elapsed().as_secs_f64() / count * 1e9;
    let start = std::time::Instant::now();
    let mut field = GrooveField::new(grooves.clone(), 20.0);
    for _ in 0..1000 {
        field = std::hint::black_box(GrooveField::new(grooves.clone(), 20.0));
    }
    let new_us = start.elapsed().as_secs_f64() * 1e3;
    let start = std::time::Instant::now();
    let with_floors: f64 = directions
        .iter()
        .map(|&xi| field.response(xi, 1.8, 550.0, true).total())
        .sum();
    println!(
        "a groove and direction: {plain_ns:.0} ns; with crossings {:.0} ns, and {new_us:.0} us to find those of ten",
        start.elapsed().as_secs_f64() / count * 1e9
    );
    assert!(with_floors.is_finite());
    assert!(sum.is_finite());
}
