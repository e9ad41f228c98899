use super::*;
use crate::spectrum;
use crate::table::ScratchTable;
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;
use std::f64::consts::PI;

const SIGMA_UM: f64 = 20.0;

/// Reflects about 550 nm alone: the table's wavelengths are nodes of a linear blend, so from 545 to 555 nm, most at 550.
fn green(nm: f64) -> f64 {
    f64::from(u8::from((nm - 550.0).abs() < 1.0))
}

/// The wavelengths that [`green`] stands for, with their shares.
fn green_parts() -> [(f64, f64); 9] {
    std::array::from_fn(|i| {
        let off = i as f64 - 4.0;
        (550.0 + off, (5.0 - off.abs()) / 25.0)
    })
}

/// T of green light at an oblique path's share of the depth.
fn green_rise(table: &ScratchTable, q: f64, depth_share: f64) -> f64 {
    table.scratch_table(GRATING_WIDTH_UM * q, GRATING_DEPTH_NM * depth_share)[1]
}

fn cd() -> Grating {
    Grating {
        pitch_um: 1.6,
        width_um: 0.6,
        depth_nm: 110.0,
        depth_spread: 0.0,
        jitter_um: 0.0,
    }
}

/// The light of rows of grooves under the window, over q in steps: each groove with its own place and depth, all with their phases.
/// [`Grating`] is asked for nothing but its numbers.
fn brute_force(row: &Grating, rows: usize, step: f64, count: usize, seed: u64) -> Vec<f64> {
    let mut random = Pcg32::seed_from_u64(seed);
    let mut normal = || {
        let [u, v] = [random.random::<f64>(), random.random::<f64>()];
        let radius = (-2.0 * (1.0 - u).ln()).sqrt();
        (radius * (2.0 * PI * v).cos(), u)
    };
    let mut sums = vec![0.0; count];
    let reach = (4.5 * SIGMA_UM / row.pitch_um).ceil() as i64 + 3;
    for r in 0..rows {
        // Place of the row under the pixel.
        let phase = (r as f64 + normal().1) / rows as f64;
        let grooves: Vec<(f64, f64)> = (-reach..=reach)
            .map(|j| {
                let place = (j as f64 + phase) * row.pitch_um + row.jitter_um * normal().0;
                let depth = row.depth_nm * (1.0 + row.depth_spread * normal().0);
                (place, depth)
            })
            .collect();
        for (nm, share) in green_parts() {
            let um = nm * 1e-3;
            let k = 2.0 * PI / um;
            // Real and imaginary part of each groove's wave at q, and by how much it turns for one step.
            let mut waves: Vec<(DVec2, DVec2)> = grooves
                .iter()
                .map(|(place, depth)| {
                    let window = (-place * place / (2.0 * SIGMA_UM * SIGMA_UM)).exp();
                    let phase = 4.0 * PI * depth / nm;
                    let floor = DVec2::new(1.0 - phase.cos(), phase.sin());
                    let at = |q: f64| DVec2::from_angle(-k * q * place);
                    ((window * floor).rotate(at(0.5 * step)), at(step))
                })
                .collect();
            for (i, sum) in sums.iter_mut().enumerate() {
                let q = (i as f64 + 0.5) * step;
                let mut field = DVec2::ZERO;
                for (wave, turn) in &mut waves {
                    field += *wave;
                    *wave = wave.rotate(*turn);
                }
                let x = 0.5 * k * row.width_um * q;
                let slit = row.width_um / um * x.sin() / x;
                // |S|^2 / (pi sigma^2), integrated over xi_t.
                let per_area = 2.0 * PI.sqrt() / (k * SIGMA_UM);
                *sum += share * per_area * slit * slit * field.length_squared() / rows as f64;
            }
        }
    }
    sums
}

/// Errors of the table against the light of random rows towards lights of the given sizes, relative rms, without order 0.
fn errors(row: &Grating, sizes: &[f64], rows: usize) -> Vec<f64> {
    let table = row.table(SIGMA_UM, green);
    let step = 1e-3;
    let count = 1200;
    let densities = brute_force(row, rows, step, count, 7);
    // Order 0 is the base's.
    let first = (6.0 * 0.0032 / step) as usize;
    sizes
        .iter()
        .map(|size| {
            let width = (size / step).round() as usize;
            let (mut error2, mut value2) = (0.0, 0.0);
            for low in (first..count - width).step_by((width / 4).max(1)) {
                let expected: f64 = densities[low..low + width].iter().sum::<f64>() * step;
                let q = |i: usize| green_rise(&table, i as f64 * step, 1.0);
                error2 += (q(low + width) - q(low) - expected).powi(2);
                value2 += expected * expected;
            }
            (error2 / value2).sqrt()
        })
        .collect()
}

#[test]
fn the_table_is_the_sum_over_random_rows() {
    let row = |pitch_um, width_um| Grating {
        pitch_um,
        width_um,
        ..cd()
    };
    for (row, rows) in [(row(0.74, 0.35), 160), (row(10.0, 3.0), 800)] {
        for (jitter, depth_spread) in [(0.0, 0.0), (0.0, 0.3), (0.05, 0.1), (0.2, 0.0)] {
            let row = Grating {
                depth_spread,
                jitter_um: jitter * row.pitch_um,
                ..row
            };
            // Random rows are speckled: their own noise is the most of it. Others differ in where they lie alone.
            let is_random = jitter > 0.0 || depth_spread > 0.0;
            let rows = if is_random { rows } else { 24 };
            let [small, wide] = errors(&row, &[0.004, 0.04], rows)[..] else {
                panic!("two sizes");
            };
            println!(
                "grating: pitch {} um, jitter {jitter}, depth spread {depth_spread}: {:.2} % rms under 0.004 rad, {:.2} % under 0.04",
                row.pitch_um,
                100.0 * small,
                100.0 * wide
            );
            // Orders of one wavelength are as sharp as the table can hold: its columns cut their flanks.
            let most = if is_random {
                [0.05, 0.03]
            } else {
                [0.03, 0.005]
            };
            assert!(small < most[0] && wide < most[1], "{row:?}");
        }
    }
}

/// sin theta = m lambda / pitch, and the efficiencies of a rectangular phase grating.
#[test]
fn orders_have_the_angles_and_efficiencies_of_gratings() {
    for (row, share) in [(cd(), 1.0), (cd(), 0.8)] {
        let table = row.table(SIGMA_UM, green);
        for order in 1..=3 {
            let middle = f64::from(order) * 0.55 / 1.6;
            let reach = 0.5 * 0.55 / 1.6;
            let steps = 4000;
            let (mut energy, mut moment) = (0.0, 0.0);
            for i in 0..steps {
                let at = |i: i32| middle + reach * (f64::from(2 * i) / f64::from(steps) - 1.0);
                let (low, high) = (at(i), at(i + 1));
                let sent = green_rise(&table, high, share) - green_rise(&table, low, share);
                energy += sent;
                moment += sent * 0.5 * (low + high);
            }
            let fill = 0.6 / 1.6;
            let slit = (PI * f64::from(order) * fill).sin() / (PI * f64::from(order));
            let step = (2.0 * PI * 110.0 * share / 550.0).sin();
            let expected = 4.0 * step * step * slit * slit;
            println!(
                "grating: order {order} at {:.5}, expected {middle:.5}; sends {energy:.5}, expected {expected:.5}",
                moment / energy
            );
            assert!((moment / energy - middle).abs() < 1e-3);
            assert!((energy - expected).abs() < 1e-3);
            assert!((row.order_q(order, 550.0) - middle).abs() < 1e-12);
            assert!((row.order_energy(order, share, 550.0) - expected).abs() < 1e-12);
        }
    }
}

/// Order 0 and the light that is sent aside add up to all light, where all of it has a direction.
#[test]
fn energy_is_kept() {
    for (pitch_um, fill, jitter_um, depth_spread) in [
        (16.0, 0.5, 0.0, 0.0),
        (16.0, 0.4, 0.5, 0.3),
        (20.0, 0.25, 2.0, 0.1),
        (40.0, 0.2, 3.0, 0.2),
    ] {
        let row = Grating {
            pitch_um,
            width_um: fill * pitch_um,
            depth_spread,
            jitter_um,
            ..cd()
        };
        let table = row.table(SIGMA_UM, |_| 1.0);
        for share in [0.4, 1.0] {
            let kept = spectrum::rgb_from_reflectance(|nm| row.order_energy(0, share, nm));
            let depth_nm = GRATING_DEPTH_NM * share;
            let sent = table.scratch_table(2.0 * GRATING_WIDTH_UM, depth_nm);
            for c in 0..3 {
                let all = kept[c] + 2.0 * sent[c];
                // Beyond |q| = 2 the tail of sinc^2 has no direction.
                assert!((0.99..1.001).contains(&all), "{row:?}, {share}: {all}");
            }
        }
    }
}

/// A row without any order sends the light of scratches with the density 1/pitch.
#[test]
fn a_row_without_order_is_its_scratches() {
    let row = Grating {
        jitter_um: 60.0,
        ..Grating {
            pitch_um: 8.0,
            width_um: 1.5,
            ..cd()
        }
    };
    let rows = row.table(SIGMA_UM, |_| 1.0);
    let scratches = ScratchTable::new(|_| 1.0);
    for (low, high) in [(0.05, 0.1), (0.2, 0.5), (0.6, 1.4)] {
        for share in [0.5, 1.0] {
            let [row_sent, sent] = [
                (&rows, GRATING_WIDTH_UM, GRATING_DEPTH_NM),
                (&scratches, row.width_um, row.depth_nm),
            ]
            .map(|(table, width_um, depth_nm)| {
                let at = |q: f64| table.scratch_table(width_um * q, depth_nm * share)[1];
                at(high) - at(low)
            });
            let expected = row.fill() * sent;
            assert!(
                (row_sent / expected - 1.0).abs() < 0.01,
                "{row_sent} {expected}"
            );
        }
    }
}

#[test]
fn no_configuration_breaks_the_table() {
    let mut random = Pcg32::seed_from_u64(3);
    let mut from = |low: f64, high: f64| low * (high / low).powf(random.random::<f64>());
    let mut looked_up = 0;
    for _ in 0..10 {
        let pitch_um = from(0.3, 60.0);
        let row = Grating {
            pitch_um,
            width_um: pitch_um * from(0.02, 1.0),
            depth_nm: from(1.0, 2000.0),
            depth_spread: from(1e-3, 3.0),
            jitter_um: pitch_um * from(1e-3, 2.0),
        };
        let table = row.table(from(1.0, 1000.0), |_| 1.0);
        for _ in 0..100_000 {
            let (low, high) = (from(1e-6, 4.0), from(1e-6, 4.0));
            let depth_nm = from(1.0, 2.0 * GRATING_DEPTH_NM);
            for q in [low, -high] {
                let t = table.scratch_table(GRATING_WIDTH_UM * q, depth_nm);
                assert!(t.iter().all(|t| t.is_finite() && t.abs() < 4.0), "{row:?}");
                let luminance = 0.2126 * t[0] + 0.7152 * t[1] + 0.0722 * t[2];
                assert!(luminance * q.signum() > -1e-4, "{row:?} {q} {t:?}");
            }
            looked_up += 1;
        }
        for nm in [380.0, 555.0, 780.0] {
            for order in [0, 1, -7, 1000] {
                let energy = row.order_energy(order, 0.7, nm);
                assert!((0.0..=4.0).contains(&energy), "{row:?} {order} {energy}");
            }
        }
    }
    assert_eq!(looked_up, 1_000_000);
}
