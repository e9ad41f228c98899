//! Errors of the area-light integrals over a grid of roughness, angle, size and place.
//!
//! An error is |approximate - exact| over the largest exact value that a light of this shape and size has on this surface, seen from
//! this angle, wherever it stands. So an error of 1 % is 1 % of the brightest highlight that can be had.

use glam::DVec3;
use hairline_optics::ggx::{ggx_alpha, ggx_eval};
use hairline_optics::ltc::{polygon_light, sphere_light};
use hairline_optics::sptd::{sptd_lobe, sptd_sphere, sptd_sphere_published};
use rayon::prelude::*;

use crate::cubature::{Cap, Peak, integrate, integrate_polygon};

const ROUGHNESS: [f64; 9] = [0.0, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0];
// Only the ends of these axes are nodes of the tables.
const ANGLE_DEG: [f64; 7] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0];
/// Half the light's angle.
const RADIUS_RAD: [f64; 5] = [0.005, 0.02, 0.08, 0.25, 0.8];

struct Surface {
    roughness: f64,
    angle_deg: f64,
    wo: DVec3,
    alpha: f64,
}

impl Surface {
    fn grid() -> Vec<Surface> {
        let mut grid = Vec::new();
        for roughness in ROUGHNESS {
            for angle_deg in ANGLE_DEG {
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                grid.push(Surface {
                    roughness,
                    angle_deg,
                    wo: DVec3::new(sin, 0.0, cos),
                    alpha: ggx_alpha(roughness),
                });
            }
        }
        grid
    }

    fn mirror(&self) -> DVec3 {
        DVec3::new(-self.wo.x, 0.0, self.wo.z)
    }

    fn peak(&self) -> Peak {
        Peak {
            direction: self.mirror(),
            width_rad: 0.5 * self.alpha * self.wo.z.max(0.15),
        }
    }

    /// The mirror direction; one and two lobe widths (2 alpha) from it, up, down, sideways (where the lobe is narrower
    /// by cos) and diagonally; one light's radius from it; on the horizon in front, at the side and behind.
    fn places(&self, radius_rad: f64) -> Vec<(&'static str, DVec3)> {
        let mirror = self.mirror();
        let up = DVec3::new(self.wo.z, 0.0, self.wo.x);
        let side = DVec3::Y;
        let width = 2.0 * self.alpha;
        let width_side = width * self.wo.z;
        let off = |towards: DVec3, angle: f64| {
            let angle = angle.clamp(-1.5, 1.5);
            mirror * angle.cos() + towards * angle.sin()
        };
        let mut places = vec![
            ("mirror", mirror),
            ("up 1", off(up, width)),
            ("up 2", off(up, 2.0 * width)),
            ("down 1", off(up, -width)),
            ("down 2", off(up, -2.0 * width)),
            ("side 1", off(side, width_side)),
            ("side 2", off(side, 2.0 * width_side)),
            ("side 4", off(side, 4.0 * width_side)),
            ("diagonal 2", off((up + side).normalize(), 2.0 * width)),
            ("radius up", off(up, radius_rad)),
            ("radius side", off(side, radius_rad)),
            ("horizon front", DVec3::new(-1.0, 0.0, 0.25 * radius_rad)),
            ("horizon side", DVec3::new(-0.3, 1.0, -0.2 * radius_rad)),
            ("horizon back", DVec3::new(1.0, 0.2, 0.3 * radius_rad)),
        ];
        for place in &mut places {
            place.1 = place.1.normalize();
        }
        places.retain(|p| p.1.z > -0.9 * radius_rad.sin());
        places
    }
}

struct Sample {
    error: f64,
    exact: f64,
    angle_deg: f64,
    radius_rad: f64,
    roughness: f64,
    what: String,
}

struct Summary {
    mean: f64,
    worst: f64,
}

/// Prints mean, 95th percentile, worst and the means along each axis, in per cent.
fn summarise(name: &str, samples: &[Sample]) -> Summary {
    let mut order: Vec<&Sample> = samples.iter().collect();
    order.sort_by(|a, b| a.error.total_cmp(&b.error));
    let mean_where = |keep: &dyn Fn(&Sample) -> bool| {
        let kept: Vec<f64> = samples
            .iter()
            .filter(|s| keep(s))
            .map(|s| s.error)
            .collect();
        100.0 * kept.iter().sum::<f64>() / kept.len() as f64
    };
    let worst = order[order.len() - 1];
    let mean = mean_where(&|_| true);
    println!(
        "{name}: {} cases, mean {mean:.2} %, 95th percentile {:.2} %, worst {:.1} % at roughness {}, {} degrees, {} rad, {} (exact {:.3} of the brightest)",
        samples.len(),
        100.0 * order[order.len() * 95 / 100].error,
        100.0 * worst.error,
        worst.roughness,
        worst.angle_deg,
        worst.radius_rad,
        worst.what,
        worst.exact,
    );
    let bright: Vec<f64> = samples
        .iter()
        .filter(|s| s.exact > 0.1)
        .map(|s| s.error / s.exact)
        .collect();
    println!(
        "    relative to the exact value, where that is above a tenth of the brightest: mean {:.2} % of {} cases",
        100.0 * bright.iter().sum::<f64>() / bright.len() as f64,
        bright.len(),
    );
    let row = |label: &str, axis: &[f64], key: &dyn Fn(&Sample) -> f64| {
        let cells: Vec<String> = axis
            .iter()
            .map(|&x| format!("{x}: {:.2}", mean_where(&|s| key(s) == x)))
            .collect();
        println!("    by {label}: {}", cells.join(", "));
    };
    row("roughness", &ROUGHNESS, &|s| s.roughness);
    row("degrees", &ANGLE_DEG, &|s| s.angle_deg);
    row("radius", &RADIUS_RAD, &|s| s.radius_rad);
    Summary {
        mean,
        worst: 100.0 * worst.error,
    }
}

/// Measures one kind of light: `evaluate` gives (approximate..., exact) for a light at a place.
fn measure<const N: usize>(
    evaluate: impl Fn(&Surface, DVec3, f64) -> ([f64; N], f64) + Sync,
    what: &str,
) -> [Vec<Sample>; N] {
    let groups: Vec<[Vec<Sample>; N]> = Surface::grid()
        .par_iter()
        .flat_map_iter(|surface| RADIUS_RAD.iter().map(move |&radius| (surface, radius)))
        .map(|(surface, radius_rad)| {
            let cases: Vec<_> = surface
                .places(radius_rad)
                .into_iter()
                .map(|(place, centre)| (place, evaluate(surface, centre, radius_rad)))
                .collect();
            let brightest = cases.iter().map(|c| c.1.1).fold(0.0, f64::max);
            std::array::from_fn(|k| {
                cases
                    .iter()
                    .map(|(place, (approximate, exact))| Sample {
                        error: (approximate[k] - exact).abs() / brightest,
                        exact: exact / brightest,
                        angle_deg: surface.angle_deg,
                        radius_rad,
                        roughness: surface.roughness,
                        what: format!("{what} {place}"),
                    })
                    .collect()
            })
        })
        .collect();
    let mut all: [Vec<Sample>; N] = std::array::from_fn(|_| Vec::new());
    for group in groups {
        for (samples, part) in all.iter_mut().zip(group) {
            samples.extend(part);
        }
    }
    all
}

#[test]
fn spheres_match_ggx() {
    let [default, pivot, published] = measure(
        |surface, centre, radius_rad| {
            let (wo, alpha) = (surface.wo, surface.alpha);
            let sin2 = radius_rad.sin().powi(2);
            let light = Cap {
                axis: centre,
                radius_rad,
            };
            let exact = integrate(light, surface.peak(), &|wi| ggx_eval(wi, wo, alpha));
            let lobe = sptd_lobe(wo, surface.roughness);
            let approximate = [
                sphere_light(wo, surface.roughness, centre, sin2),
                sptd_sphere(&lobe, centre, sin2),
                sptd_sphere_published(&lobe, centre, sin2),
            ];
            (approximate, exact)
        },
        "sphere",
    );
    let summary = summarise("sphere_light", &default);
    let pivot = summarise("sptd_sphere", &pivot);
    let published = summarise("sptd_sphere_published", &published);
    assert!(summary.mean < 0.5, "mean {} %", summary.mean);
    assert!(summary.worst < 12.0, "worst {} %", summary.worst);
    assert!(pivot.mean < 3.0, "mean {} %", pivot.mean);
    // The published form is what others are compared with: neither better nor worse than it is.
    assert!(
        (published.mean - 4.57).abs() < 0.1,
        "mean {} %",
        published.mean
    );
}

/// Outlines in the unit disk: convex, pointed, non-convex and long.
fn outlines() -> [(&'static str, Vec<(f64, f64)>); 4] {
    [
        (
            "square",
            vec![(-0.7, -0.7), (0.7, -0.7), (0.7, 0.7), (-0.7, 0.7)],
        ),
        ("triangle", vec![(-0.9, -0.5), (0.9, -0.5), (0.0, 1.0)]),
        (
            "arrow",
            vec![(-0.9, -0.8), (0.0, -0.1), (0.9, -0.8), (0.0, 1.0)],
        ),
        (
            "rod",
            vec![(-1.0, -0.05), (1.0, -0.05), (1.0, 0.05), (-1.0, 0.05)],
        ),
    ]
}

#[test]
fn polygons_match_ggx() {
    let mut all = Vec::new();
    for (name, outline) in outlines() {
        for tilt in [0.0, 1.0] {
            let [samples] = measure(
                |surface, centre, radius_rad| {
                    let (wo, alpha) = (surface.wo, surface.alpha);
                    let (x, y) = centre.any_orthonormal_pair();
                    // Tilted by 45 degrees for the second round, and turned by 0.3 rad.
                    let (x, y) = (x * 0.955 + y * 0.296, y * 0.955 - x * 0.296);
                    let x = (x + tilt * centre).normalize();
                    let vertices: Vec<DVec3> = outline
                        .iter()
                        .map(|&(u, v)| 2.0 * (centre + radius_rad.tan() * (u * x + v * y)))
                        .collect();
                    let exact =
                        integrate_polygon(&vertices, surface.peak(), &|wi| ggx_eval(wi, wo, alpha));
                    ([polygon_light(wo, surface.roughness, &vertices)], exact)
                },
                name,
            );
            summarise(&format!("polygon_light, {name}, tilt {tilt}"), &samples);
            all.extend(samples);
        }
    }
    let summary = summarise("polygon_light, all", &all);
    assert!(summary.mean < 0.5, "mean {} %", summary.mean);
    assert!(summary.worst < 25.0, "worst {} %", summary.worst);
}
