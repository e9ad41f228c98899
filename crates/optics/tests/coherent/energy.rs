//! Where the energy goes: a mirror with random grooves, over the hemisphere and beyond it.

use crate::{Groove, pieces, random_grooves};
use glam::DVec2;
use hairline_optics::coherent::{GroovePiece, coherent_response, groove_overlap};
use rayon::prelude::*;
use std::f64::consts::PI;

const WAVELENGTH_NM: f64 = 550.0;

/// The integral of f over |xi - wo_t| <= reach by the trapezoid rule. f is the Fourier transform of the windowed
/// surface's autocorrelation, which falls as exp(-x^2/4 sigma^2), so samples lambda/(8 sigma) apart alias 1e-7 of it.
/// `oblique` is false where the cosines' sum is to stay that of the mirror direction.
fn integral(
    grooves: &[GroovePiece],
    wo: DVec2,
    reach: f64,
    coherence_um: f64,
    oblique: bool,
) -> f64 {
    let step = WAVELENGTH_NM * 1e-3 / (8.0 * coherence_um);
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
                let f = coherent_response(
                    grooves,
                    wi + wo,
                    cos_i + cos_o,
                    coherence_um,
                    WAVELENGTH_NM,
                    true,
                );
                f.total()
            })
            .sum::<f64>()
    };
    (-count..=count).into_par_iter().map(row).sum::<f64>() * step * step
}

/// Grooves that do not meet: each floor is a phase, so Parseval holds to what lies beyond the reach.
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
        let energy = integral(&grooves, DVec2::ZERO, reach, coherence_um, false);
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

/// Random grooves of one to three times the window's width on a mirror.
#[test]
fn a_scratched_mirror_reflects_what_falls_on_it() {
    let coherence_um = 20.0;
    for count in [2, 4, 8] {
        for (view_deg, bound) in [(0.0_f64, 0.03), (30.0, 0.03), (60.0, 0.03)] {
            let wo = DVec2::new(view_deg.to_radians().sin(), 0.0);
            let (mut share, mut hemisphere) = (0.0, 0.0);
            for seed in 0..2 {
                let grooves = pieces(&random_grooves(count, 40.0, 40.0..120.0, seed));
                share += 0.5
                    * grooves
                        .iter()
                        .map(|g| groove_overlap(g, coherence_um))
                        .sum::<f64>();
                hemisphere += 0.5 * integral(&grooves, wo, 1.0, coherence_um, true);
            }
            println!(
                "{count} grooves covering {share:.3}, seen at {view_deg} degrees: {hemisphere:.4}"
            );
            assert!((hemisphere - 1.0).abs() < bound, "{hemisphere}");
        }
    }
}
