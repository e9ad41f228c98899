//! Rigorous, scalar and Hairline's light of fine gratings in metals: a part of `cargo lab gratings`.

use std::fmt::Write;
use std::time::Instant;

use hairline_optics::grating::{GRATING_WIDTH_UM, Grating, IncidenceRow, RigorousGrating};
use hairline_optics::metal::Metal;
use hairline_optics::rigorous::{CoupledWaves, Efficiencies, FineGrooves, Medium, Relief};
use hairline_optics::spectrum::{self, Observer};
use hairline_scene::FINE_PITCH_UM;
use rayon::prelude::*;

/// Name, pitch, width and depth.
const GRATINGS: [(&str, f64, f64, f64); 5] = [
    ("DVD", 0.74, 0.32, 105.0),
    ("foil", 1.2, 0.6, 140.0),
    ("compact disc", 1.6, 0.6, 110.0),
    ("rows of 4 µm", 4.0, 1.6, 120.0),
    ("rows of 10 µm", 10.0, 4.0, 120.0),
];
const METALS: [Metal; 3] = [Metal::Aluminium, Metal::Silver, Metal::Gold];
/// Angles to the normal across the grooves, and along them.
const VIEWS_DEG: [[f64; 2]; 7] = [
    [0.0, 0.0],
    [15.0, 0.0],
    [30.0, 0.0],
    [45.0, 0.0],
    [60.0, 0.0],
    [75.0, 0.0],
    [20.0, 40.0],
];
/// Wavelengths of the direct sums, and the part of the order's place that is asked for: beyond, the eye sees little.
const STEP_NM: f64 = 4.0;
const SEEN_NM: [f64; 2] = [430.0, 670.0];
const COHERENCE_UM: f64 = 20.0;
/// Orders of less light are left out.
const LEAST: f64 = 0.01;

/// One grating in one metal from one direction: of the places of orders, rigorous light over all, and scalar light and ours over it.
struct MeasuredOrders {
    orders: Vec<(i32, f64, f64, f64)>,
}

pub(crate) fn measured() -> String {
    let mut text = String::from(HEAD);
    let mut times = String::new();
    for (name, pitch_um, width_um, depth_nm) in GRATINGS {
        for metal in METALS {
            let medium = Medium::Metal(metal.into());
            let row = Grating {
                pitch_um,
                width_um,
                depth_nm,
                depth_spread: 0.0,
                jitter_um: 0.0,
            };
            let fine = (pitch_um < FINE_PITCH_UM).then(|| {
                let start = Instant::now();
                let grooves = FineGrooves {
                    pitch_um,
                    width_um,
                    depth_nm,
                    above: 1.0,
                    medium: medium.clone(),
                };
                let found = Efficiencies::new(&grooves, &|| false).expect("nothing cancels it");
                let seconds = start.elapsed().as_secs_f64();
                let table = RigorousGrating {
                    row,
                    efficiencies: &found,
                    observer: Observer::eye(),
                    medium: &medium,
                    is_colored: false,
                    cover: None,
                }
                .table(COHERENCE_UM);
                let both = start.elapsed().as_secs_f64();
                if metal == Metal::Aluminium {
                    let _ = writeln!(times, "| {name} | {seconds:.1} | {:.1} |", both - seconds);
                }
                table
            });
            for view in VIEWS_DEG {
                let [across, along] = view.map(|deg: f64| deg.to_radians().sin());
                let ours = fine.as_ref().map(|table| {
                    let seen = IncidenceRow::new(table, [across, along]);
                    move |low: f64, high: f64| {
                        let at = |q: f64| luminance(seen.look_up(GRATING_WIDTH_UM * q));
                        (at(high) - at(low)).abs()
                    }
                });
                let seen = MeasuredOrders::new(&row, metal, [across, along], ours);
                let cells = seen.orders.iter().filter(|of| of.1 > LEAST);
                let [mut scalar, mut own] = [[f64::MAX, 0.0_f64]; 2];
                let mut first = String::new();
                for (order, light, by_scalar, by_ours) in cells {
                    scalar = [scalar[0].min(*by_scalar), scalar[1].max(*by_scalar)];
                    own = [own[0].min(*by_ours), own[1].max(*by_ours)];
                    if order.abs() == 1 {
                        let _ = write!(
                            first,
                            "{}{:.1} % ",
                            if *order > 0 { "+" } else { "-" },
                            100.0 * light
                        );
                    }
                }
                let _ = writeln!(
                    text,
                    "| {name} | {} | {}, {} | {first}| {:.2} to {:.2} | {:.3} to {:.3} |",
                    format!("{metal:?}").to_lowercase(),
                    view[0],
                    view[1],
                    scalar[0],
                    scalar[1],
                    own[0],
                    own[1]
                );
            }
            println!("{name}, {metal:?}");
        }
    }
    text + TIMES + &times
}

fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

impl MeasuredOrders {
    /// `ours` is the light between two q; without it, it is the scalar one.
    fn new(
        row: &Grating,
        metal: Metal,
        [across, along]: [f64; 2],
        ours: Option<impl Fn(f64, f64) -> f64>,
    ) -> Self {
        let medium = Medium::Metal(metal.into());
        let cos_of = |across: f64| (1.0 - along * along - across * across).max(0.0).sqrt();
        let cos_o = cos_of(across);
        let flat = luminance(spectrum::rgb_from_reflectance(|nm| {
            medium.reflectance(1.0, cos_o, nm)
        }));
        let most = (2.0 * row.pitch_um / 0.38) as i32;
        let kept = 20 + (10.0 * row.pitch_um) as i32;
        let step_nm = if row.pitch_um > 5.0 {
            3.0 * STEP_NM
        } else {
            STEP_NM
        };
        let count = (400.0 / step_nm) as usize;
        // Light of each order at each wavelength: rigorous and scalar.
        let of_nm = |i: usize| {
            let nm = 380.0 + step_nm * (i as f64 + 0.5);
            let weight = luminance(spectrum::weight_per_nm(nm)) * step_nm / flat;
            let (n, k) = metal.n_k(nm);
            let index = num_complex::Complex64::new(n, k);
            let relief = Relief::lamellar(row.pitch_um, row.width_um, row.depth_nm, 1.0, index);
            // Orders leave on the viewer's other side.
            let turns = -across / row.order_q(1, nm);
            let from = turns.round();
            let waves = CoupledWaves::new(&relief, nm, turns - from, kept);
            let all = waves.reflected(along);
            let of = all.iter().find(|of| of.order == from as i32);
            let orders = (-most..=most)
                .filter(|order| *order != 0)
                .filter_map(|order| {
                    let q = row.order_q(order, nm);
                    let cos_i = cos_of(q - across);
                    let at = of?.order + order + kept;
                    let [s, p] = *of?.efficiencies.get(at as usize)?;
                    let scalar = row.order_energy(order, 0.5 * (cos_i + cos_o), nm);
                    let scalar = scalar * medium.reflectance(1.0, cos_o, nm);
                    (cos_i > 0.0).then_some((q, weight * 0.5 * (s + p), weight * scalar))
                });
            orders.collect::<Vec<_>>()
        };
        let sent: Vec<_> = (0..count).into_par_iter().flat_map(of_nm).collect();
        let orders = (-most..=most).filter(|order| *order != 0).map(|order| {
            let [a, b] = SEEN_NM.map(|nm| row.order_q(order, nm));
            let (low, high) = (a.min(b), a.max(b));
            let here = sent.iter().filter(|of| low < of.0 && of.0 < high);
            let (mut rigorous, mut scalar) = (0.0, 0.0);
            for (_, by_waves, by_steps) in here {
                rigorous += by_waves;
                scalar += by_steps;
            }
            let own = ours.as_ref().map_or(scalar, |ours| ours(low, high));
            (order, rigorous, scalar / rigorous, own / rigorous)
        });
        Self {
            orders: orders.collect(),
        }
    }
}

const HEAD: &str = "\n## Fine gratings in metals\n\n\
    Grooves of rectangular profile by coupled waves, both polarisations (model.md, section 12), straight, at wavelengths 4 nm apart and with more orders than tables are made with; against scalar efficiencies, and \
    against the light that Hairline's table sends. Light is luminance over that of the flat metal, summed over the place of an order from 430 to 670 nm, with what other orders send there. Angles are those of the viewer \
    to the normal, across the grooves and along them. The third column is the light of the first orders; the last two are the least and the greatest ratio of all orders of more than 1 % of the light. \
    From 4 µm on Hairline's efficiencies are the scalar ones.\n\n\
    | grating | metal | degrees | first orders | scalar over rigorous | ours over rigorous |\n|---|---|---|---|---|---|\n";

const TIMES: &str = "\nSeconds to make the efficiencies of a grating in aluminium, once for a user, and the table of a scene:\n\n| grating | efficiencies | table |\n|---|---|---|\n";
