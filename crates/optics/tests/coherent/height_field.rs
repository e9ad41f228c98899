//! The closed form against the FFT of a rasterised surface.

use super::far_field::{Crossing, Grid, far_field};
use super::{Groove, pieces, random_grooves};
use glam::DVec2;
use hairline_optics::coherent::{
    GrooveField, GroovePiece, base_amplitude, groove_amplitude, groove_overlap, phase_step,
    scratch_amplitude, window_fourier,
};
use hairline_optics::diffraction::sinc;
use num_complex::Complex64;
use std::f64::consts::PI;

/// 61 um for a window of 5 um: 1.5e-8 of the window's amplitude lies beyond the edges.
const GRID: Grid = Grid {
    cells: 2048,
    step_um: 0.03,
};
const COHERENCE_UM: f64 = 5.0;
const WAVELENGTHS_NM: [f64; 3] = [450.0, 550.0, 650.0];

/// Error of the grid: cells of 0.03 um alias amplitude from beyond |xi| = lambda/0.03 - 1 = 14, where a groove's
/// spectrum has fallen to a fourteenth and the cell's transfer function to another. At worst 3e-4, at 450 nm.
const BOUND: f64 = 6e-4;

/// The difference of two fields relative to the grooves' light, rms over the propagating disc and at worst.
struct Difference {
    rms: f64,
    worst: f64,
}

fn compare(
    witness: &[(DVec2, Complex64)],
    scratches: impl Fn(DVec2) -> Complex64,
    coherence_um: f64,
    wavelength_nm: f64,
) -> Difference {
    let (mut error, mut signal, mut worst, mut peak) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for &(xi, expected) in witness {
        let s = scratches(xi);
        let difference = base_amplitude(xi, coherence_um, wavelength_nm) - s - expected;
        error += difference.norm_sqr();
        signal += s.norm_sqr();
        worst = worst.max(difference.norm());
        peak = peak.max(s.norm());
    }
    Difference {
        rms: (error / signal).sqrt(),
        worst: worst / peak,
    }
}

fn one() -> Vec<Groove> {
    vec![Groove {
        from: DVec2::new(-60.0, -23.0),
        to: DVec2::new(60.0, 28.0),
        width_um: 1.2,
        depth_nm: 140.0,
    }]
}

fn two_parallel() -> Vec<Groove> {
    let along = DVec2::from_angle(0.5);
    [(-3.0, 0.8, 140.0), (2.5, 1.5, 210.0)]
        .map(|(p, width_um, depth_nm)| Groove {
            from: p * along.perp() - 50.0 * along,
            to: p * along.perp() + 4.0 * along,
            width_um,
            depth_nm,
        })
        .to_vec()
}

/// Ends within the window, floors that cross.
fn five_random() -> Vec<Groove> {
    random_grooves(5, 5.0, 2.0..12.0, 3)
}

#[test]
fn the_field_is_that_of_the_rasterised_surface() {
    for (name, grooves) in [
        ("one", one()),
        ("two parallel", two_parallel()),
        ("five random", five_random()),
    ] {
        for wavelength_nm in WAVELENGTHS_NM {
            for cos_sum in [2.0, 1.3] {
                let witness = far_field(
                    &grooves,
                    Crossing::Sum,
                    GRID,
                    cos_sum,
                    COHERENCE_UM,
                    wavelength_nm,
                );
                let pieces = pieces(&grooves);
                let found = compare(
                    &witness,
                    |xi| scratch_amplitude(&pieces, xi, cos_sum, COHERENCE_UM, wavelength_nm),
                    COHERENCE_UM,
                    wavelength_nm,
                );
                println!(
                    "{name}, {wavelength_nm} nm, cosines' sum {cos_sum}: rms {:.1e}, worst {:.1e}, {} directions",
                    found.rms,
                    found.worst,
                    witness.len()
                );
                assert!(
                    found.rms < BOUND && found.worst < BOUND,
                    "{name} {}",
                    found.rms
                );
            }
        }
    }
}

/// The window that scenes have by default, once.
#[test]
fn so_is_it_for_a_window_of_20_um() {
    let grid = Grid {
        cells: 4096,
        step_um: 0.06,
    };
    let grooves = random_grooves(5, 20.0, 20.0..60.0, 4);
    let witness = far_field(&grooves, Crossing::Sum, grid, 2.0, 20.0, 550.0);
    let pieces = pieces(&grooves);
    let found = compare(
        &witness,
        |xi| scratch_amplitude(&pieces, xi, 2.0, 20.0, 550.0),
        20.0,
        550.0,
    );
    println!(
        "sigma 20 um: rms {:.1e}, worst {:.1e}",
        found.rms, found.worst
    );
    assert!(found.rms < BOUND && found.worst < BOUND, "{}", found.rms);
    // The same with one floor where they cross.
    let witness = far_field(&grooves, Crossing::Deepest, grid, 2.0, 20.0, 550.0);
    let field = GrooveField::new(pieces, 20.0);
    let one_floor = compare(&witness, |xi| field.amplitude(xi, 2.0, 550.0), 20.0, 550.0);
    let sum = compare(
        &witness,
        |xi| scratch_amplitude(field.pieces(), xi, 2.0, 20.0, 550.0),
        20.0,
        550.0,
    );
    println!(
        "one floor: rms {:.1e}, worst {:.1e}; the plain sum {:.1e}, {:.1e}",
        one_floor.rms, one_floor.worst, sum.rms, sum.worst
    );
    assert!(
        one_floor.rms < BOUND && sum.rms > 10.0 * BOUND,
        "{}",
        one_floor.rms
    );
}

#[test]
fn a_wrong_groove_is_seen() {
    let grooves = five_random();
    let witness = far_field(&grooves, Crossing::Sum, GRID, 2.0, COHERENCE_UM, 550.0);
    let right = pieces(&grooves);
    type Change = fn(&mut GroovePiece);
    let changes: [(&str, Change); 6] = [
        ("moved by 0.1 um", |g| g.offset_um += 0.1),
        ("on the other side", |g| g.offset_um = -g.offset_um),
        ("5 % wider", |g| g.width_um *= 1.05),
        ("2 % deeper", |g| g.depth_nm *= 1.02),
        ("0.1 um longer", |g| g.end_um += 0.1),
        ("turned by 0.1 degrees", |g| {
            g.tangent = DVec2::from_angle(0.1_f64.to_radians()).rotate(g.tangent);
        }),
    ];
    for (name, change) in changes {
        let mut wrong = right.clone();
        change(&mut wrong[1]);
        let found = compare(
            &witness,
            |xi| scratch_amplitude(&wrong, xi, 2.0, COHERENCE_UM, 550.0),
            COHERENCE_UM,
            550.0,
        );
        println!("one of five {name}: rms {:.1e}", found.rms);
        assert!(found.rms > 3.0 * BOUND, "{name}: {}", found.rms);
    }
}

/// Two at right angles, one at a sharp angle over both, one that ends within another, one beside and partly in another.
fn five_that_cross() -> Vec<Groove> {
    [
        (-40.0, -1.0, 40.0, -1.0, 1.5, 140.0),
        (1.0, -40.0, 1.0, 5.0, 2.0, 90.0),
        (-8.0, -3.0, 9.0, 2.0, 1.0, 230.0),
        (-3.0, 6.0, -2.0, -1.2, 1.2, 60.0),
        (-4.0, -1.9, 6.0, -1.9, 0.8, 140.0),
    ]
    .map(|(x0, y0, x1, y1, width_um, depth_nm)| Groove {
        from: DVec2::new(x0, y0),
        to: DVec2::new(x1, y1),
        width_um,
        depth_nm,
    })
    .to_vec()
}

/// A surface has one floor where grooves cross. [`GrooveField`] has it too; the plain sum misses it, and by how much is
/// printed.
#[test]
fn one_floor_where_grooves_cross() {
    for (name, grooves) in [
        ("five random", five_random()),
        ("five that cross", five_that_cross()),
    ] {
        for wavelength_nm in WAVELENGTHS_NM {
            let witness = far_field(
                &grooves,
                Crossing::Deepest,
                GRID,
                2.0,
                COHERENCE_UM,
                wavelength_nm,
            );
            let field = GrooveField::new(pieces(&grooves), COHERENCE_UM);
            let found = compare(
                &witness,
                |xi| field.amplitude(xi, 2.0, wavelength_nm),
                COHERENCE_UM,
                wavelength_nm,
            );
            let pieces = pieces(&grooves);
            let sum = compare(
                &witness,
                |xi| scratch_amplitude(&pieces, xi, 2.0, COHERENCE_UM, wavelength_nm),
                COHERENCE_UM,
                wavelength_nm,
            );
            println!(
                "{name}, {wavelength_nm} nm, one floor: rms {:.1e}, worst {:.1e}; the plain sum {:.1e}, {:.1e}",
                found.rms, found.worst, sum.rms, sum.worst
            );
            // The hidden part is right to 1 %.
            assert!(found.rms < BOUND + 0.01 * sum.rms, "{}", found.rms);
            assert!(sum.rms > 3.0 * BOUND, "{}", sum.rms);
        }
    }
}

/// The window's mean reflection is the specular peak's middle, where floors are counted once too.
#[test]
fn the_mean_reflection_counts_floors_once() {
    // Twice the same groove is one groove, and a groove within a wider one of its depth is nothing.
    let one = pieces(&one())[0];
    let inner = GroovePiece {
        width_um: 0.3 * one.width_um,
        ..one
    };
    let expected = 1.0 - phase_step(one.depth_nm, 2.0, 550.0) * groove_overlap(&one, COHERENCE_UM);
    let field = GrooveField::new(vec![one, one, inner], COHERENCE_UM);
    let found = field.mean_reflection(2.0, 550.0);
    assert!((found - expected).norm() < 1e-5, "{found} {expected}");
    let alone = GrooveField::new(vec![one], COHERENCE_UM);
    for xi in [DVec2::ZERO, DVec2::new(0.1, -0.2)] {
        let (a, b) = (
            field.amplitude(xi, 2.0, 550.0),
            alone.amplitude(xi, 2.0, 550.0),
        );
        assert!((a - b).norm() < 1e-4, "{a} {b}");
    }
}

/// Error of the window's being constant across a groove in (2): W sinc(k W xi_n/2) exp(-p^2/2 sigma^2).
#[test]
fn a_window_constant_across_the_groove_costs_its_width_squared() {
    let (coherence_um, wavelength_um) = (20.0, 0.55);
    let k = 2.0 * PI / wavelength_um;
    println!("W/sigma: rms error of sinc over |xi_n| <= 1 at p = 0 | sigma | 2 sigma");
    for (ratio, bound) in [(0.05, 0.03), (0.1, 0.06), (0.2, 0.15), (0.4, 0.4)] {
        let width = ratio * coherence_um;
        let errors = [0.0, 1.0, 2.0].map(|p| {
            let offset = p * coherence_um;
            let height = f64::exp(-0.5 * p * p) * width / ((2.0 * PI).sqrt() * coherence_um);
            let (mut error, mut signal) = (0.0, 0.0);
            for i in -2000..=2000 {
                let q = i as f64 / 2000.0;
                let exact = window_fourier(
                    offset - 0.5 * width,
                    offset + 0.5 * width,
                    coherence_um,
                    k * q,
                );
                let flat =
                    Complex64::from_polar(height * sinc(0.5 * k * width * q), -k * q * offset);
                error += (exact - flat).norm_sqr();
                signal += exact.norm_sqr();
            }
            (error / signal).sqrt()
        });
        println!(
            "{ratio}: {:.2} % | {:.2} % | {:.2} %",
            100.0 * errors[0],
            100.0 * errors[1],
            100.0 * errors[2]
        );
        assert!(errors[1] < bound, "{ratio}: {errors:?}");
    }
}

/// The sum consists of amplitudes without D times D, and depths may share the amplitudes.
#[test]
fn the_sum_is_made_of_its_terms() {
    let grooves = pieces(&five_random());
    let xi = DVec2::new(0.05, -0.08);
    let sum: Complex64 = grooves
        .iter()
        .map(|g| phase_step(g.depth_nm, 1.7, 550.0) * groove_amplitude(g, xi, 5.0, 550.0))
        .sum();
    assert!((sum - scratch_amplitude(&grooves, xi, 1.7, 5.0, 550.0)).norm() < 1e-12 * sum.norm());
}
