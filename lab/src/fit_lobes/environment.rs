//! Fits the look-ups of `optics::environment_lobe`: round lobes in the plane of view and normal that together are GGX, with one set of shares,
//! and GGX times the weight of a dielectric's reflectance beyond normal incidence, with another.
//!
//! Places of all but the last are fitted without it. The last lies at the horizon and takes away what the others put below.

use std::f64::consts::PI;

use glam::DVec3;
use hairline_optics::environment_lobe::ENVIRONMENT_TAPS;
use hairline_optics::fresnel::{dielectric_weight, schlick_weight};
use hairline_optics::ggx::{ggx_alpha, ggx_eval, ggx_g1, ggx_pdf, ggx_sample};
use hairline_optics::lobe_table::{LOBE_MIN_COS, LOBE_TABLE_SIZE, LobeTable, lobe_table_node};

use super::search::{grid, nelder_mead, uniform_direction};

const N: usize = ENVIRONMENT_TAPS;
/// Look-ups that add light.
const ADDING: usize = N - 1;
/// Slopes from the mirror direction over alpha, then logarithms of alphas over that of the surface.
type Places = [f64; 2 * ADDING];
/// Usual shares, to which shares are drawn where the fit leaves them open, and the strength of this pull, relative to the lobe.
const USUAL_SHARES: [f64; N] = [0.2661, 0.2399, 0.2399, 0.1271, 0.1271, 0.0];
const SHARES_HELD: f64 = 1e-4;
/// The least share of the first, from which the mean is taken on.
const FIRST_SHARE: f64 = 0.004;
/// The last look-up's angle from the normal, on the side of the mirror direction, and its alpha. Best places of single nodes are about there, and
/// errors hardly depend on either.
const TAKING_FROM_NORMAL_DEG: f64 = 95.0;
const TAKING_ALPHA: f64 = 0.25;
/// The most that it takes away.
const MOST_TAKEN: f64 = 0.4;
/// Alphas from which on it takes anything, and that much: the horizon does not cut sharp lobes.
const TAKEN_FROM_ALPHA: [f64; 2] = [0.05, 0.15];
/// Strength of the pull of places towards those of the nodes before.
const PLACES_HELD: f64 = 2e-5;
/// Bounds of the logarithms. Narrower look-ups would fit narrow lobes better, as a row of dots.
const NARROWEST: f64 = -1.5;
const WIDEST: f64 = 1.0;
/// Refractive index of the dielectric, and its reflectance along the normal, which weights the second set.
const IOR: f64 = 1.5;
const NORMAL_REFLECTANCE: f64 = 0.04;

/// A fitted node: (slope, alpha ratio, share, share of the dielectric's weight) of each look-up.
#[derive(Clone, Copy)]
pub struct Node {
    places: Places,
    taps: [[f32; 4]; N],
    /// Relative to the lobe's rms.
    rms: f64,
}

/// Fits all nodes, row by row. Each begins with what its neighbours towards the normal and towards the mirror have, and is held to that, so
/// that nodes can be interpolated.
pub fn fit() -> Vec<Node> {
    let first = [0.0, 0.01, -0.01, 0.02, -0.02, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut nodes: Vec<Node> = Vec::new();
    for row in 0..LOBE_TABLE_SIZE {
        let mut above = None;
        let mut fitted: Vec<Node> = (0..LOBE_TABLE_SIZE)
            .rev()
            .map(|column| {
                let smoother = row
                    .checked_sub(1)
                    .map(|row| nodes[row * LOBE_TABLE_SIZE + column].places);
                let neighbours: Vec<Places> = smoother.into_iter().chain(above).collect();
                let held = std::array::from_fn(|i| match neighbours.len() {
                    0 => first[i],
                    n => neighbours.iter().map(|places| places[i]).sum::<f64>() / n as f64,
                });
                let node = fit_node(row, column, held);
                above = Some(node.places);
                node
            })
            .collect();
        fitted.reverse();
        nodes.extend(fitted);
    }
    nodes
}

fn fit_node(row: usize, column: usize, held: Places) -> Node {
    let (roughness, cos_o) = lobe_table_node(row, column);
    let (cos_o, alpha) = (cos_o.max(LOBE_MIN_COS), ggx_alpha(roughness));
    // Metals that are given by a colour have Schlick's curve. Places serve them too.
    let target = Target::new(cos_o, alpha, schlick_weight);
    let cost = |p: &Places| {
        let moved: f64 = p.iter().zip(&held).map(|(a, b)| (a - b) * (a - b)).sum();
        target.fit(&look_ups(p, [0.0, 0.0]), 0.0).error2 + PLACES_HELD * moved
    };
    let mut places = held;
    for scale in [1.0, 0.4, 0.4] {
        let steps = std::array::from_fn(|i| scale * if i < ADDING { 0.3 } else { 0.15 });
        places = nelder_mead(&cost, places, steps).0;
    }
    let turn = TAKING_FROM_NORMAL_DEG.to_radians() - cos_o.acos();
    let looked_up = look_ups(
        &places,
        [(0.5 * turn).tan() / alpha, (TAKING_ALPHA / alpha).ln()],
    );
    let target = Target::new(cos_o, alpha, |cos| dielectric_weight(cos, IOR));
    let fit = target.fit(&looked_up, most_taken(alpha));
    let tap = |i: usize| {
        let [slope, ratio] = looked_up[i];
        [slope, ratio.exp(), fit.shares[i], fit.grazing[i]]
    };
    Node {
        places,
        taps: std::array::from_fn(|i| tap(i).map(|x| x as f32)),
        rms: fit.plain2.sqrt(),
    }
}

/// Slope and logarithm of each look-up, given those of the last.
fn look_ups(places: &Places, last: [f64; 2]) -> [[f64; 2]; N] {
    std::array::from_fn(|i| match i {
        ADDING => last,
        _ => [places[i], places[ADDING + i]],
    })
}

/// What the last look-up may take away.
fn most_taken(alpha: f64) -> f64 {
    let [from, whole] = TAKEN_FROM_ALPHA;
    MOST_TAKEN * ((alpha - from) / (whole - from)).clamp(0.0, 1.0)
}

/// A table for each look-up.
pub fn tables(nodes: &[Node]) -> [LobeTable; N] {
    std::array::from_fn(|i| LobeTable::new(nodes.iter().map(|node| node.taps[i]).collect()))
}

/// Prints how well it went.
pub fn report(nodes: &[Node]) {
    for (row, nodes) in nodes.chunks(LOBE_TABLE_SIZE).enumerate().step_by(4) {
        let errors: Vec<String> = nodes
            .iter()
            .skip(3)
            .step_by(4)
            .map(|node| format!("{:.1}", 100.0 * node.rms))
            .collect();
        println!(
            "environment, roughness {:.2}: rms error in % from grazing views to the normal: {}",
            lobe_table_node(row, 0).0,
            errors.join(", "),
        );
    }
}

/// GGX at points that are drawn from it, from a wider lobe and from the whole sphere, with the reciprocals of their density.
struct Target {
    wo: DVec3,
    alpha: f64,
    points: Vec<Point>,
    /// Integrals of the squares of GGX and of GGX times the weight, both over their integrals.
    plain2: f64,
    grazing2: f64,
    /// Weight of the second.
    grazing_part: f64,
}

struct Point {
    wi: DVec3,
    weight: f64,
    /// Errors count relative to the density that points are drawn with: tails count.
    per_density: f64,
    /// Each over its integral.
    plain: f64,
    grazing: f64,
}

struct Fit {
    shares: [f64; N],
    grazing: [f64; N],
    plain2: f64,
    error2: f64,
}

impl Target {
    fn new(cos_o: f64, alpha: f64, rises: impl Fn(f64) -> f64) -> Self {
        let wo = DVec3::new((1.0 - cos_o * cos_o).sqrt(), 0.0, cos_o);
        let wide = (3.0 * alpha).min(1.0);
        let drawn = |alpha: f64| grid().map(move |u| ggx_sample(wo, alpha, u));
        let anywhere = grid().map(uniform_direction);
        let count = 3.0 * grid().count() as f64;
        let mut points: Vec<Point> = drawn(alpha)
            .chain(drawn(wide))
            .chain(anywhere)
            .map(|wi| {
                let density = (ggx_pdf(wi, wo, alpha) + ggx_pdf(wi, wo, wide) + 0.25 / PI) / 3.0;
                let plain = ggx_eval(wi, wo, alpha);
                Point {
                    wi,
                    weight: 1.0 / (count * density),
                    per_density: 1.0 / density,
                    plain,
                    grazing: plain * rises(wo.dot((wi + wo).normalize())),
                }
            })
            .collect();
        let integral = |of: fn(&Point) -> f64| points.iter().map(|p| p.weight * of(p)).sum::<f64>();
        let (plain, grazing) = (integral(|p| p.plain), integral(|p| p.grazing));
        for p in &mut points {
            p.plain /= plain;
            p.grazing /= grazing;
        }
        let integral = |of: fn(&Point) -> f64| points.iter().map(|p| p.weight * of(p)).sum::<f64>();
        Self {
            wo,
            alpha,
            plain2: integral(|p| p.per_density * p.plain * p.plain),
            grazing2: integral(|p| p.per_density * p.grazing * p.grazing),
            grazing_part: grazing / (grazing + NORMAL_REFLECTANCE * plain),
            points,
        }
    }

    fn fit(&self, looked_up: &[[f64; 2]; N], most_taken: f64) -> Fit {
        let lobes: [RoundLobe; N] =
            looked_up.map(|[slope, ratio]| RoundLobe::new(self.wo, self.alpha, slope, ratio.exp()));
        let mut products = [[0.0; N]; N];
        let (mut plain, mut grazing) = ([0.0; N], [0.0; N]);
        for point in &self.points {
            let values = lobes.each_ref().map(|lobe| lobe.density(point.wi));
            for i in 0..N {
                let weighed = point.weight * point.per_density * values[i];
                plain[i] += weighed * point.plain;
                grazing[i] += weighed * point.grazing;
                for j in 0..N {
                    products[i][j] += weighed * values[j];
                }
            }
        }
        let (plain, plain2) = shares(&products, &plain, self.plain2, most_taken);
        let (grazing, grazing2) = shares(&products, &grazing, self.grazing2, most_taken);
        let outside: f64 = looked_up[..ADDING]
            .iter()
            .map(|[slope, ratio]| {
                (ratio - WIDEST).max(0.0)
                    + (NARROWEST - ratio).max(0.0)
                    + (slope.abs() * self.alpha - 1.0).max(0.0)
            })
            .sum();
        Fit {
            shares: plain,
            grazing,
            plain2,
            error2: plain2 + self.grazing_part * self.grazing_part * grazing2 + outside,
        }
    }
}

/// GGX seen along its normal.
struct RoundLobe {
    middle: DVec3,
    alpha: f64,
    per_integral: f64,
}

impl RoundLobe {
    fn new(wo: DVec3, alpha: f64, slope: f64, ratio: f64) -> Self {
        let (sin, cos) = (2.0 * (slope * alpha).atan()).sin_cos();
        let alpha = (ratio * alpha).min(1.0);
        let mut lobe = Self {
            middle: DVec3::new(-(wo.x * cos + wo.z * sin), 0.0, wo.z * cos - wo.x * sin),
            alpha,
            per_integral: 1.0,
        };
        // Steps of equal weight: even in the reciprocal of the term that is squared in the density.
        let rest = (1.0 - alpha * alpha).max(1e-6);
        let [from, to] = [0.5, 0.0].map(|half_sine2| 1.0 / (alpha * alpha + rest * half_sine2));
        let steps = 48;
        let sum: f64 = (0..steps)
            .map(|i| {
                let v = from + (to - from) * (f64::from(i) + 0.5) / f64::from(steps);
                let half_sine2 = (1.0 / v - alpha * alpha) / rest;
                ggx_g1(1.0 - 2.0 * half_sine2, alpha)
            })
            .sum();
        let squared = alpha * alpha / rest * (to - from) / f64::from(steps);
        lobe.per_integral = 1.0 / (4.0 * PI * squared * sum);
        lobe
    }

    fn density(&self, w: DVec3) -> f64 {
        let cos = w.dot(self.middle);
        let a2 = self.alpha * self.alpha;
        let t = a2 + (1.0 - a2) * 0.5 * (1.0 - cos);
        a2 / (t * t) * ggx_g1(cos, self.alpha) * self.per_integral
    }
}

/// Shares whose sum is 1, of at least 0 but for the last, which is 0 at most; and the square of the residual over the target's.
fn shares(
    products: &[[f64; N]; N],
    target: &[f64; N],
    target2: f64,
    most_taken: f64,
) -> ([f64; N], f64) {
    let held = SHARES_HELD * target2;
    let whole = 10.0 * target2;
    let mut x = USUAL_SHARES;
    for _ in 0..200 {
        for i in 0..N {
            let others: f64 = (0..N)
                .filter(|&j| j != i)
                .map(|j| (products[i][j] + whole) * x[j])
                .sum();
            let wanted = target[i] + whole + held * USUAL_SHARES[i] - others;
            let [least, most] = match i {
                0 => [FIRST_SHARE, f64::INFINITY],
                ADDING => [-most_taken, 0.0],
                _ => [0.0, f64::INFINITY],
            };
            x[i] = (wanted / (products[i][i] + whole + held)).clamp(least, most);
        }
    }
    let sum: f64 = x.iter().sum();
    let x = x.map(|share| share / sum);
    let crossed: f64 = (0..N).map(|i| x[i] * target[i]).sum();
    let own: f64 = (0..N)
        .map(|i| (0..N).map(|j| x[i] * x[j] * products[i][j]).sum::<f64>())
        .sum();
    (x, ((target2 - 2.0 * crossed + own) / target2).max(0.0))
}
