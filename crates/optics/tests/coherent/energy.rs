//! Energy balance of a mirror with random grooves, over the hemisphere and beyond it.

use super::{Groove, pieces, random_grooves};
use glam::DVec2;
use hairline_optics::coherent::{CoherentResponse, GrooveField, coherent_response, groove_overlap};
use rayon::prelude::*;
use std::f64::consts::PI;

const WAVELENGTH_NM: f64 = 550.0;

/// The integral of f over |xi - wo_t| <= reach by the trapezoid rule. f is the Fourier transform of the windowed
/// surface's autocorrelation, which falls as exp(-x^2/4 sigma^2), so samples lambda/(7 sigma) apart alias 5e-6 of it.
/// `oblique` is false where the cosines' sum is to stay that of the mirror direction.
fn integral(
    response: impl Fn(DVec2, f64) -> CoherentResponse + Sync,
    wo: DVec2,
    reach: f64,
    coherence_um: f64,
    oblique: bool,
) -> f64 {
    let step = WAVELENGTH_NM * 1e-3 / (7.0 * coherence_um);
    let count = (reach / step) as i64;
    let cos_o = (1.0 - wo.length_squared()).sqrt();
    let row = |j: i64| {
        (-count..=count)
            .map(|i| step * DVec2::new(i as f64, j as f64))
            .filter(|wi| wi.length() <= reach)
            .map(|wi| {
                let cos_i = if oblique {
                    (1.0 - wi.length_squared()).sqrt()
                } else {
                    cos_o
                };
                response(wi + wo, cos_i + cos_o).total()
            })
            .sum::<f64>()
    };
    (-count..=count).into_par_iter().map(row).sum::<f64>() * step * step
}

/// Grooves that do not meet: each floor is a phase, so Parseval holds but for the energy beyond the reach.
#[test]
fn without_crossings_and_horizon_energy_is_exact() {
    let coherence_um = 5.0;
    let along = DVec2::from_angle(0.4);
    let grooves = pieces(&[-6.0, -1.0, 4.0, 9.0].map(|p| Groove {
        from: p * along.perp() - 3.0 * along,
        to: p * along.perp() + 4.0 * along,
        width_um: 1.5,
        depth_nm: 140.0,
    }));
    let covered: f64 = grooves
        .iter()
        .map(|g| groove_overlap(g, coherence_um))
        .sum();
    // The tail of sinc^2 beyond Q holds lambda/(pi^2 W Q) of what is scattered, and the ends add as much with the length
    // for W.
    let tail = 4.0 * covered * 0.55 / (PI * PI) * (1.0 / 1.5 + 1.0 / 7.0);
    for reach in [1.0, 2.0, 4.0, 8.0] {
        let f = |xi, cos_sum| {
            coherent_response(&grooves, xi, cos_sum, coherence_um, WAVELENGTH_NM, true)
        };
        let energy = integral(f, DVec2::ZERO, reach, coherence_um, false);
        let expected = 1.0 - tail / reach;
        println!(
            "share {covered:.3}: energy within |xi| <= {reach}: {energy:.5}, expected {expected:.5}"
        );
        assert!(
            (energy - expected).abs() < 0.15 * tail / reach,
            "{energy} {expected}"
        );
    }
}

/// Random grooves of one to three times the window's width on a mirror. On the infinite plane one floor everywhere keeps
/// the energy exactly; what is missing lies beyond the horizon, what the plain sum has too much lies at crossings.
#[test]
fn a_scratched_mirror_reflects_what_falls_on_it() {
    for (coherence_um, count, seeds) in [(10.0, 2, 0..4), (10.0, 4, 0..4), (20.0, 8, 1..2)] {
        let runs: Vec<_> = seeds
            .map(|seed| {
                let lengths = 2.0 * coherence_um..6.0 * coherence_um;
                let grooves = pieces(&random_grooves(count, 2.0 * coherence_um, lengths, seed));
                GrooveField::new(grooves, coherence_um)
            })
            .collect();
        let mean =
            |f: &dyn Fn(&GrooveField) -> f64| runs.iter().map(f).sum::<f64>() / runs.len() as f64;
        let share = mean(&|field| {
            field
                .pieces()
                .iter()
                .map(|g| groove_overlap(g, coherence_um))
                .sum()
        });
        // Seen from 60 degrees, lambda/(pi^2 W cos^2) = 10 to 40 % of a groove's light has no direction to go to.
        for (view_deg, lowest) in [(0.0_f64, 0.99), (30.0, 0.99), (60.0, 0.94)] {
            let wo = DVec2::new(view_deg.to_radians().sin(), 0.0);
            let energy = mean(&|field| {
                let f = |xi, cos_sum| field.response(xi, cos_sum, WAVELENGTH_NM, true);
                integral(f, wo, 1.0, coherence_um, true)
            });
            let sum = mean(&|field| {
                let f = |xi, cos_sum| {
                    coherent_response(
                        field.pieces(),
                        xi,
                        cos_sum,
                        coherence_um,
                        WAVELENGTH_NM,
                        true,
                    )
                };
                integral(f, wo, 1.0, coherence_um, true)
            });
            println!(
                "sigma {coherence_um} um, {count} grooves covering {share:.3}, seen at {view_deg} degrees: \
                 {energy:.4}; the plain sum {sum:.4}"
            );
            assert!((lowest..1.002).contains(&energy), "{energy}");
            // The comparison sees what is counted twice.
            if (count, view_deg) == (4, 0.0) {
                assert!(sum > 1.01, "{sum}");
            }
        }
    }
}
