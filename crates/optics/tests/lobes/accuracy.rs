//! Errors of the area-light integrals over a grid of roughness, angle, size and place.
//!
//! An error is |approximate - exact| over the largest exact value that a light of this shape and size has on this surface, seen from
//! this angle, wherever it stands. So an error of 1 % is 1 % of the brightest highlight that can be had.
//!
//! With a Fresnel reflectance the exact value is the integral of GGX times that reflectance at the half vector.

use std::sync::LazyLock;

use glam::{DVec3, DVec4};
use hairline_optics::fresnel::{FresnelCurve, FresnelRgb, dielectric};
use hairline_optics::ggx::{ggx_alpha, ggx_eval};
use hairline_optics::lobe_table::albedo_lookup;
use hairline_optics::ltc::{polygon_light, sphere_light};
use hairline_optics::metal::Metal;
use hairline_published::sptd::{sptd_lobe, sptd_sphere_published};
use rayon::prelude::*;

use super::cubature::{Cap, Peak, integrate, integrate_polygon};

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

/// Reflectances: a dielectric, whose lobe's average is far from its reflectance of most lights; gold's blue, which rises; chromium's red, with
/// a deep dip.
const REFLECTANCES: [&str; 3] = ["glass", "gold, blue", "chromium, red"];

fn reflectances(cos_h: f64) -> [f64; 3] {
    [
        dielectric(cos_h, 1.5),
        Metal::Gold.reflectance_rgb(cos_h)[2],
        Metal::Chromium.reflectance_rgb(cos_h)[0],
    ]
}

/// All three reflectances at once, one in each channel.
fn fresnel() -> FresnelRgb<'static> {
    static CURVE: LazyLock<FresnelCurve> = LazyLock::new(|| FresnelCurve::new(reflectances));
    FresnelRgb {
        f0: [0.0; 3],
        f90: 1.0,
        curve: &CURVE,
    }
}

/// The spectral sums take long: a table so fine that its error does not count.
fn fine_reflectances(cos_h: f64) -> DVec3 {
    const STEPS: usize = 4000;
    static FINE: LazyLock<Vec<DVec3>> = LazyLock::new(|| {
        let node = |i: usize| DVec3::from(reflectances((i as f64 / STEPS as f64).powi(2)));
        (0..=STEPS).map(node).collect()
    });
    let at = cos_h.clamp(0.0, 1.0).sqrt() * STEPS as f64;
    let i = (at as usize).min(STEPS - 1);
    FINE[i].lerp(FINE[i + 1], at - i as f64)
}

/// GGX with each reflectance, and GGX itself behind them: one cubature for all.
fn plain_and_reflected(wo: DVec3, alpha: f64) -> impl Fn(DVec3) -> DVec4 {
    let reflectance = move |wi: DVec3| fine_reflectances(wo.dot((wi + wo).normalize()));
    move |wi| ggx_eval(wi, wo, alpha) * reflectance(wi).extend(1.0)
}

/// Returns two approximations for each reflectance: the integral's own, and that for F = 1 times the ratio of albedos, as many renderers do.
fn reflected(surface: &Surface, plain: f64, reflected: [f64; 3]) -> [[f64; 2]; 3] {
    let e0 = albedo_lookup(surface.roughness, surface.wo.z);
    let albedo = fresnel().albedo(surface.roughness, surface.wo.z);
    std::array::from_fn(|k| [reflected[k], plain * albedo[k] / e0])
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

/// Measures one kind of light: `evaluate` gives (approximate, exact) of several quantities for a light at a place.
fn measure<const N: usize>(
    evaluate: impl Fn(&Surface, DVec3, f64) -> [(f64, f64); N] + Sync,
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
            std::array::from_fn(|k| {
                let brightest = cases.iter().map(|c| c.1[k].1).fold(0.0, f64::max);
                cases
                    .iter()
                    .map(|(place, values)| (place, values[k]))
                    .map(|(place, (approximate, exact))| Sample {
                        error: (approximate - exact).abs() / brightest,
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

/// Returns the pairs that [`measure`] compares for a light: two approximations of each reflectance, with the exact value.
fn compared(surface: &Surface, plain: f64, approximate: [f64; 3], exact: DVec3) -> [(f64, f64); 6] {
    let approximate = reflected(surface, plain, approximate);
    std::array::from_fn(|k| (approximate[k / 2][k % 2], exact[k / 2]))
}

/// Prints and checks errors with Fresnel: (reflectance's own, ratio of albedos) for each of [`REFLECTANCES`]. The ratio is the
/// wrong input: the bounds must not hold for it where reflectance changes much over the lobe.
fn judge_reflectances(name: &str, samples: &[Vec<Sample>; 6]) {
    for (k, material) in REFLECTANCES.into_iter().enumerate() {
        let own = summarise(&format!("{name}, {material}"), &samples[2 * k]);
        let ratio = summarise(
            &format!("{name}, {material}, ratio of albedos"),
            &samples[2 * k + 1],
        );
        assert!(own.mean < 0.6, "{material}: mean {} %", own.mean);
        assert!(own.worst < 28.0, "{material}: worst {} %", own.worst);
        assert!(own.mean < 0.8 * ratio.mean, "{material}");
        // A dielectric's reflectance changes most.
        assert!(
            k > 0 || ratio.mean > 3.0,
            "ratio of albedos: {} %",
            ratio.mean
        );
    }
}

#[test]
fn spheres_match_ggx() {
    let [default, published, r0, r1, r2, r3, r4, r5] = measure(
        |surface, centre, radius_rad| {
            let (wo, alpha) = (surface.wo, surface.alpha);
            let sin2 = radius_rad.sin().powi(2);
            let light = Cap {
                axis: centre,
                radius_rad,
            };
            let white = FresnelRgb::schlick([1.0; 3]);
            let both = integrate(light, surface.peak(), &plain_and_reflected(wo, alpha));
            let (exact_reflected, exact) = (both.truncate(), both.w);
            let lobe = sptd_lobe(wo, surface.roughness);
            let default = sphere_light(wo, surface.roughness, white, centre, sin2)[0];
            let of_fresnel = sphere_light(wo, surface.roughness, fresnel(), centre, sin2);
            let plain = [default, sptd_sphere_published(&lobe, centre, sin2)];
            let reflected = compared(surface, default, of_fresnel, exact_reflected);
            std::array::from_fn(|k| {
                if k < 2 {
                    (plain[k], exact)
                } else {
                    reflected[k - 2]
                }
            })
        },
        "sphere",
    );
    let summary = summarise("sphere_light", &default);
    let published = summarise("sptd_sphere_published", &published);
    judge_reflectances("sphere_light", &[r0, r1, r2, r3, r4, r5]);
    assert!(summary.mean < 0.5, "mean {} %", summary.mean);
    assert!(summary.worst < 12.0, "worst {} %", summary.worst);
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

/// Polygons are upright and tilted in turn, which halves the time of doing both.
#[test]
fn polygons_match_ggx() {
    polygons(|outline| if outline % 2 == 0 { &[0.0] } else { &[1.0] });
}

/// Prints the numbers of docs/lobes.md.
#[test]
#[ignore = "long: cargo long"]
fn all_polygons_match_ggx() {
    polygons(|_| &[0.0, 1.0]);
}

fn polygons(tilts: impl Fn(usize) -> &'static [f64]) {
    let mut all = Vec::new();
    let mut reflected: [Vec<Sample>; 6] = std::array::from_fn(|_| Vec::new());
    for (i, (name, outline)) in outlines().into_iter().enumerate() {
        for &tilt in tilts(i) {
            let [samples, parts @ ..] = measure(
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
                    let white = FresnelRgb::schlick([1.0; 3]);
                    let peak = surface.peak();
                    let both = integrate_polygon(&vertices, peak, &plain_and_reflected(wo, alpha));
                    let (exact, plain_exact) = (both.abs().truncate(), both.w.abs());
                    let plain = polygon_light(wo, surface.roughness, white, &vertices)[0];
                    let of_fresnel = polygon_light(wo, surface.roughness, fresnel(), &vertices);
                    let [a, b, c, d, e, f] = compared(surface, plain, of_fresnel, exact);
                    [(plain, plain_exact), a, b, c, d, e, f]
                },
                name,
            );
            summarise(&format!("polygon_light, {name}, tilt {tilt}"), &samples);
            all.extend(samples);
            for (all, part) in reflected.iter_mut().zip::<[Vec<Sample>; 6]>(parts) {
                all.extend(part);
            }
        }
    }
    let summary = summarise("polygon_light, all", &all);
    judge_reflectances("polygon_light, all", &reflected);
    assert!(summary.mean < 0.5, "mean {} %", summary.mean);
    assert!(summary.worst < 25.0, "worst {} %", summary.worst);
}
