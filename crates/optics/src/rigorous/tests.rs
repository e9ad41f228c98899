use super::efficiencies::kept_orders;
use super::*;
use crate::fresnel;
use crate::metal::Metal;
use num_complex::Complex64;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Aluminium at 550 nm.
const ALUMINIUM: Complex64 = Complex64::new(0.96, 6.69);

/// Efficiencies of both polarisations from a direction with the sine `across` in the plane across the grooves, and `along` them, by the order.
fn efficiencies(
    relief: &Relief,
    nm: f64,
    [across, along]: [f64; 2],
    most: i32,
) -> impl Fn(i32) -> [f64; 2] {
    let turns = across * relief.pitch_um * 1e3 / nm;
    let order = turns.round();
    let waves = CoupledWaves::new(relief, nm, turns - order, most);
    let all = waves.reflected(along);
    let from = all.into_iter().find(|of| of.order == order as i32).unwrap();
    move |order| {
        let at = from.order + order + most;
        from.efficiencies
            .get(at as usize)
            .copied()
            .unwrap_or([0.0; 2])
    }
}

/// G. Granet, JOSA A 16, 2510 (1999), the metallic lamellar grating of L. Li and C. Haggans, JOSA A 10, 1184 (1993): pitch, depth and wavelength 1 um,
/// grooves of half the pitch, n = 0.22 + 6.71 i, 30 degrees: 0.7342789 in order -1 of TE and 0.8484817 in order 0 of TM.
#[test]
fn a_published_grating_has_its_efficiencies() {
    let relief = Relief::lamellar(1.0, 0.5, 1000.0, 1.0, Complex64::new(0.22, 6.71));
    let found = efficiencies(&relief, 1000.0, [0.5, 0.0], 60);
    let [te, tm] = [found(-1)[0], found(0)[1]];
    println!("order -1 of TE {te:.5}, order 0 of TM {tm:.5}");
    assert!((te - 0.734_278_9).abs() < 3e-4 && (tm - 0.848_481_7).abs() < 1.2e-3);
    // Another metal is told apart.
    let wrong = Relief::lamellar(1.0, 0.5, 1000.0, 1.0, Complex64::new(0.22, 6.0));
    assert!((efficiencies(&wrong, 1000.0, [0.5, 0.0], 60)(0)[1] - tm).abs() > 0.01);
}

/// Numbers of a program of its own (numpy, orders to 60): a compact disc in aluminium at 550 nm, order 1, straight from above, TE and TM.
#[test]
fn another_program_finds_the_same() {
    let relief = Relief::lamellar(1.6, 0.6, 110.0, 1.0, ALUMINIUM);
    let [te, tm] = efficiencies(&relief, 550.0, [0.0, 0.0], 60)(1);
    println!("TE {te:.6}, TM {tm:.6}");
    assert!((te - PROTOTYPE[0]).abs() < 1e-5 && (tm - PROTOTYPE[1]).abs() < 1e-5);
}

const PROTOTYPE: [f64; 2] = [0.265679, 0.218854];

#[test]
fn a_flat_surface_has_its_fresnel_reflectance() {
    for (above, below) in [
        (1.0, ALUMINIUM),
        (1.0, Complex64::from(1.5)),
        (1.58, ALUMINIUM),
    ] {
        let relief = Relief::lamellar(1.0, 1e-9, 100.0, above, below);
        for [across, along] in [[0.0, 0.0], [0.5, 0.0], [-0.3, 0.7], [0.0, 0.9]] {
            let [s, p] = efficiencies(&relief, 550.0, [across, along], 8)(0);
            // In the medium above, by the index over its own.
            let index = below / above;
            let cos = (1.0 - (across * across + along * along) / (above * above)).sqrt();
            let expected = fresnel::conductor(cos, index.re, index.im);
            assert!(
                (0.5 * (s + p) - expected).abs() < 1e-8 && s > p - 1e-9,
                "{s} {p} {expected}"
            );
        }
    }
}

/// Light that goes the other way is sent as much: off the plane across the grooves too.
#[test]
fn orders_are_reciprocal() {
    let relief = Relief::lamellar(1.2, 0.5, 140.0, 1.0, ALUMINIUM);
    for along in [0.0, 0.4] {
        let there = efficiencies(&relief, 600.0, [0.1, along], 20)(1);
        let back = efficiencies(&relief, 600.0, [-0.6, -along], 20)(1);
        let mean = |v: [f64; 2]| 0.5 * (v[0] + v[1]);
        assert!(
            (mean(there) - mean(back)).abs() < 1e-9,
            "{there:?} {back:?}"
        );
        assert!(mean(there) > 0.05);
    }
}

#[test]
fn layers_of_one_profile_are_one_layer() {
    let whole = Relief::lamellar(0.74, 0.32, 105.0, 1.0, ALUMINIUM);
    let mut cut = whole.clone();
    cut.layers = [30.0, 50.0, 25.0]
        .map(|thickness_nm| Layer {
            thickness_nm,
            ..whole.layers[0].clone()
        })
        .to_vec();
    let [a, b] = [&whole, &cut].map(|it| efficiencies(it, 500.0, [0.2, 0.3], 16));
    for order in -2..=1 {
        for s in 0..2 {
            // Of waves that fade in the first layer, which is thinner in one of them, the last bit is left out.
            assert!((a(order)[s] - b(order)[s]).abs() < 5e-4);
        }
    }
}

#[test]
fn no_light_is_made() {
    let mut random = Pcg64::seed_from_u64(2);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    for _ in 0..60 {
        let pitch_um = between(0.3, 2.0);
        let width_um = between(0.05, 0.95) * pitch_um;
        let metal = Metal::ALL[between(0.0, Metal::ALL.len() as f64) as usize];
        let nm = between(380.0, 780.0);
        let (n, k) = metal.n_k(nm);
        let relief = Relief::lamellar(
            pitch_um,
            width_um,
            between(1.0, 400.0),
            1.0,
            Complex64::new(n, k),
        );
        let waves = CoupledWaves::new(&relief, nm, between(-0.5, 0.5), 20);
        for from in waves.reflected(between(0.0, 0.99)) {
            for s in 0..2 {
                let all: f64 = from.efficiencies.iter().map(|of| of[s]).sum();
                assert!((0.0..1.0).contains(&all), "{relief:?} {nm}: {all}");
                assert!(from.efficiencies.iter().all(|of| of[s] > -1e-9));
            }
        }
    }
}

/// The table is as near to the coupled waves as its steps let it be, across the grooves and along them. Where an order leaves along the surface,
/// efficiencies have edges that are sharper.
#[test]
fn the_table_is_the_coupled_waves() {
    let grooves = FineGrooves {
        pitch_um: 0.74,
        width_um: 0.32,
        depth_nm: 105.0,
        above: 1.0,
        medium: Medium::Metal(Metal::Aluminium.into()),
    };
    let table = Efficiencies::new(&grooves, &|| false).unwrap();
    let again = Efficiencies::from_values(&grooves, table.values()).unwrap();
    let mut random = Pcg64::seed_from_u64(1);
    for most_along in [0.0, 0.97] {
        let mut errors = Vec::new();
        for _ in 0..200 {
            let nm = 400.0 + 300.0 * random.random::<f64>();
            let along: f64 = most_along * (2.0 * random.random::<f64>() - 1.0);
            let across =
                (2.0 * random.random::<f64>() - 1.0) * 0.966 * (1.0 - along * along).sqrt();
            let relief = Relief::lamellar(0.74, 0.32, 105.0, 1.0, grooves.medium.index(nm));
            let exact = efficiencies(&relief, nm, [across, along], kept_orders(&grooves));
            for order in -3..=3 {
                let exact = 0.5 * exact(order).iter().sum::<f64>();
                let found = table.efficiency(order, nm, across, along);
                assert_eq!(found, again.efficiency(order, nm, across, along));
                if exact > 0.01 {
                    errors.push((found / exact - 1.0).abs());
                }
            }
        }
        errors.sort_by(f64::total_cmp);
        let part = |share: f64| errors[(share * (errors.len() - 1) as f64) as usize];
        println!(
            "efficiencies, {most_along} along: half are off by {:.4}, three quarters by {:.4}, nine tenths by {:.4}",
            part(0.5),
            part(0.75),
            part(0.9)
        );
        assert!(part(0.5) < 0.01 && part(0.75) < 0.04, "{most_along}");
    }
}
