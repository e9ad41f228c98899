use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Mutex;

use glam::{DMat3, DVec2, DVec3};
use hairline_optics::metal::Metal;
use hairline_optics::spectrum::Observer;
use hairline_scene::Reflector;

use super::BaseLobes;
use crate::reflectance::{MixedEnds, Reflectance, ReflectanceEnds};
use hairline_fixtures::statistics::{Draw, chi_square, jittered};

const ALPHAS: [f64; 6] = [0.002, 0.01, 0.05, 0.2, 0.5, 1.0];
const COSINES: [f64; 5] = [0.02, 0.1, 0.4, 0.8, 1.0];

fn viewer(cos: f64) -> DVec3 {
    DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

fn mirror(wo: DVec3) -> DVec3 {
    DVec3::new(-wo.x, -wo.y, wo.z)
}

/// Reflectances at each alpha, made once: tests ask for the same few again and again.
fn reflectance(reflector: Reflector, alpha: f64) -> &'static Reflectance {
    type Made = Vec<(Reflector, f64, &'static Reflectance)>;
    static MADE: Mutex<Made> = Mutex::new(Vec::new());
    let mut made = MADE.lock().unwrap();
    if let Some((.., found)) = made.iter().find(|m| (&m.0, m.1) == (&reflector, alpha)) {
        return found;
    }
    let new: &'static Reflectance = Box::leak(Box::new(Reflectance::with_roughness(
        Observer::eye(),
        reflector.clone(),
        &[alpha.sqrt()],
    )));
    made.push((reflector, alpha, new));
    new
}

fn gold(cos: f64, alpha: f64) -> BaseLobes<'static> {
    let reflectance = reflectance(Reflector::Metal(Metal::Gold.into()), alpha);
    let ends = MixedEnds::pure(ReflectanceEnds {
        f0: Metal::Gold.reflectance_rgb(1.0).into(),
        f90: 1.0,
    });
    BaseLobes::from_parts(viewer(cos), reflectance, ends, DVec3::ZERO, alpha.sqrt())
}

fn plastic(cos: f64, alpha: f64) -> BaseLobes<'static> {
    BaseLobes::from_parts(
        viewer(cos),
        reflectance(Reflector::Dielectric(1.5), alpha),
        MixedEnds::pure(ReflectanceEnds::COAT),
        DVec3::new(0.8, 0.5, 0.1),
        alpha.sqrt(),
    )
}

/// Directions by polar coordinates of their half vectors: rings that grow from well below the lobe's width, round for every
/// viewer, where the lobe itself is drawn out at grazing.
struct Rings {
    wo: DVec3,
    first_rad: f64,
    rings: usize,
    sectors: usize,
}

impl Rings {
    fn new(lobes: &BaseLobes, rings: usize, sectors: usize) -> Self {
        Self {
            wo: lobes.wo,
            first_rad: 0.02 * lobes.facets.alphas.x,
            rings,
            sectors,
        }
    }

    /// The angle at which a ring begins; t from 0 to 1.
    fn angle_rad(&self, t: f64) -> f64 {
        let growth = (FRAC_PI_2 / self.first_rad).ln();
        FRAC_PI_2 * (growth * t).exp_m1() / growth.exp_m1()
    }

    /// Index of the ring and the sector that hold a direction.
    fn cell(&self, wi: DVec3) -> usize {
        let h = wi + self.wo;
        let growth = (FRAC_PI_2 / self.first_rad).ln();
        let angle = h.x.hypot(h.y).atan2(h.z);
        let t = (angle / FRAC_PI_2 * growth.exp_m1()).ln_1p() / growth;
        let s = (h.y.atan2(h.x) / (2.0 * PI)).rem_euclid(1.0);
        let index = |t: f64, n: usize| ((t * n as f64) as usize).min(n - 1);
        index(t, self.rings) * self.sectors + index(s, self.sectors)
    }

    /// Calls `f` with (cell, direction, solid angle) for `fine` x `fine` points in each cell.
    fn for_each(&self, fine: usize, mut f: impl FnMut(usize, DVec3, f64)) {
        let (rings, sectors) = (self.rings * fine, self.sectors * fine);
        for ring in 0..rings {
            let at = |k: f64| self.angle_rad((ring as f64 + k) / rings as f64);
            let (sin, cos) = at(0.5).sin_cos();
            // The cosines' difference, without its cancelling.
            let of_h = 2.0
                * (0.5 * (at(0.0) + at(1.0))).sin()
                * (0.5 * (at(1.0) - at(0.0))).sin()
                * 2.0
                * PI
                / sectors as f64;
            for sector in 0..sectors {
                let (sin_s, cos_s) = (2.0 * PI * (sector as f64 + 0.5) / sectors as f64).sin_cos();
                let h = DVec3::new(sin * cos_s, sin * sin_s, cos);
                let cos_d = self.wo.dot(h);
                if cos_d > 0.0 {
                    let wi = 2.0 * cos_d * h - self.wo;
                    f(
                        ring / fine * self.sectors + sector / fine,
                        wi,
                        4.0 * cos_d * of_h,
                    );
                }
            }
        }
    }
}

/// (specular, diffuse) light under a white sky, by quadrature.
fn quadrature(lobes: &BaseLobes) -> (DVec3, DVec3) {
    let (mut specular, mut diffuse) = (DVec3::ZERO, DVec3::ZERO);
    Rings::new(lobes, 300, 300).for_each(1, |_, wi, solid_angle| {
        let (s, d) = lobes.eval(wi);
        specular += s * solid_angle;
        diffuse += d * solid_angle;
    });
    (specular, diffuse)
}

#[test]
fn the_mean_of_brdf_over_density_is_the_albedo() {
    for make in [gold, plastic] {
        for alpha in ALPHAS {
            for cos in COSINES {
                let lobes = make(cos, alpha);
                let (specular, diffuse) = quadrature(&lobes);
                let (mut mean, mut picks) = (DVec3::ZERO, Draw::new(1));
                const SIDE: usize = 200;
                for u in jittered(SIDE, 2) {
                    if let Some(wi) = lobes.sample(picks.one(), u) {
                        let (s, d) = lobes.eval(wi);
                        mean += (s + d) / (lobes.pdf(wi) * (SIDE * SIDE) as f64);
                    }
                }
                let error = (mean - specular - diffuse).abs().max_element();
                // Grazing rough lobes lose half their samples below the horizon, and which lobe a sample takes is not
                // jittered: 40,000 samples of deviation up to 0.5, and three standard deviations.
                assert!(
                    error < 8e-3,
                    "alpha {alpha}, cosine {cos}: {mean} {specular} {diffuse}"
                );
            }
        }
    }
}

/// The body receives the light that the lobe does not reflect.
#[test]
fn the_albedo_of_the_model_is_that_of_its_lobes() {
    for alpha in ALPHAS {
        for cos in COSINES {
            let lobes = plastic(cos, alpha);
            let (specular, _) = quadrature(&lobes);
            let albedo = lobes
                .reflectance
                .albedo(alpha.sqrt(), cos)
                .reflected(lobes.ends.dielectric);
            let error = (albedo / specular - DVec3::ONE).abs().max_element();
            assert!(error < 0.01, "alpha {alpha}, cosine {cos}: {error}");
        }
    }
}

#[test]
fn the_density_sums_to_one_with_the_samples_that_are_lost() {
    for make in [gold, plastic] {
        for alpha in ALPHAS {
            for cos in COSINES {
                let lobes = make(cos, alpha);
                let mut whole = 0.0;
                Rings::new(&lobes, 300, 300).for_each(1, |_, wi, solid_angle| {
                    whole += lobes.pdf(wi) * solid_angle;
                });
                const SIDE: usize = 200;
                let mut picks = Draw::new(3);
                let kept = jittered(SIDE, 4)
                    .filter(|u| lobes.sample(picks.one(), *u).is_some())
                    .count() as f64
                    / (SIDE * SIDE) as f64;
                assert!(
                    (whole - kept).abs() < 8e-3,
                    "alpha {alpha}, cosine {cos}: {whole} {kept}"
                );
            }
        }
    }
}

fn spread(lobes: &BaseLobes, judged: &BaseLobes) -> f64 {
    const SAMPLES: usize = 50_000;
    let rings = Rings::new(judged, 24, 16);
    let mut expected = vec![0.0; 24 * 16];
    rings.for_each(16, |cell, wi, solid_angle| {
        expected[cell] += SAMPLES as f64 * judged.pdf(wi) * solid_angle;
    });
    let mut counts = vec![0.0; 24 * 16];
    let mut draw = Draw::new(5);
    for _ in 0..SAMPLES {
        if let Some(wi) = lobes.sample(draw.one(), draw.two()) {
            counts[rings.cell(wi)] += 1.0;
        }
    }
    chi_square(&counts, &expected)
}

#[test]
fn samples_are_spread_as_the_density_says() {
    for make in [gold, plastic] {
        for alpha in ALPHAS {
            for cos in COSINES {
                let lobes = make(cos, alpha);
                let z = spread(&lobes, &lobes);
                assert!(z < 5.0, "alpha {alpha}, cosine {cos}: {z}");
            }
        }
    }
}

#[test]
fn a_wider_lobe_would_be_noticed() {
    let z = spread(&gold(0.4, 0.2), &gold(0.4, 0.22));
    assert!(z > 20.0, "{z}");
}

/// A cap of even light, sampled by the base and by the cap.
#[test]
fn samples_of_the_base_and_of_a_light_agree() {
    for make in [gold, plastic] {
        for alpha in ALPHAS {
            for cos in COSINES {
                let lobes = make(cos, alpha);
                // Beside the highlight, and no wider than it is across, so that its flank and not only its sum is judged.
                let radius = (2.0 * alpha * cos).min(0.6);
                let axis = (mirror(lobes.wo) + DVec3::new(0.3, 0.5, 0.7) * radius).normalize();
                let versine = 2.0 * (0.5 * radius).sin().powi(2);
                let (x, y) = axis.any_orthonormal_pair();
                const SIDE: usize = 300;
                let share = 1.0 / (SIDE * SIDE) as f64;
                let (mut by_light, mut by_base) = (DVec3::ZERO, DVec3::ZERO);
                let mut squares = 0.0;
                let mut picks = Draw::new(6);
                for u in jittered(SIDE, 7) {
                    let v = u.x * versine;
                    let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
                    let wi =
                        axis * (1.0 - v) + (x * cos_phi + y * sin_phi) * (v * (2.0 - v)).sqrt();
                    let (s, d) = lobes.eval(wi);
                    by_light += (s + d) * (2.0 * PI * versine * share);
                    let Some(wi) = lobes.sample(picks.one(), u) else {
                        continue;
                    };
                    if (wi - axis).length_squared() < 2.0 * versine {
                        let (s, d) = lobes.eval(wi);
                        let value = (s + d) / lobes.pdf(wi);
                        by_base += value * share;
                        squares += value.max_element().powi(2) * share;
                    }
                }
                // Five standard errors of independent samples, and what the light's own grid leaves of narrow lobes.
                let error = (by_base - by_light).abs().max_element();
                let allowed = 5.0 * (squares * share).sqrt() + 2e-3 * by_light.max_element();
                assert!(
                    error < allowed,
                    "alpha {alpha}, cosine {cos}: {by_base} {by_light}"
                );
            }
        }
    }
}

#[test]
fn no_nan_on_awkward_input() {
    let last = 1.0 - f64::EPSILON / 2.0;
    for make in [gold, plastic] {
        for alpha in [0.0, 0.002, 1.0] {
            for cos in [-0.1, 0.0, 1e-12, 1e-3, 1.0] {
                let lobes = make(cos, alpha);
                for pick in [0.0, last] {
                    for u in [
                        (0.0, 0.0),
                        (last, last),
                        (0.0, last),
                        (last, 0.0),
                        (0.5, 0.5),
                    ] {
                        let Some(wi) = lobes.sample(pick, DVec2::from(u)) else {
                            continue;
                        };
                        assert!(wi.is_normalized(), "{wi}");
                        let (s, d) = lobes.eval(wi);
                        assert!(s.is_finite() && d.is_finite() && lobes.pdf(wi) >= 0.0);
                        assert!((s + d).max_element() <= 100.0 * lobes.pdf(wi) + 1e-9);
                    }
                }
                for wi in [
                    DVec3::Z,
                    -DVec3::Z,
                    DVec3::X,
                    -lobes.wo,
                    lobes.wo,
                    mirror(lobes.wo),
                ] {
                    let (s, d) = lobes.eval(wi);
                    assert!(s.is_finite() && d.is_finite(), "{wi}: {s} {d}");
                    assert!(lobes.pdf(wi).is_finite() && lobes.pdf(wi) >= 0.0, "{wi}");
                }
            }
        }
    }
}

/// A clear layer on plastic that leans away from it towards the viewer: directions are drawn with the density that is stated, and have the
/// light in the mean that the base sends, from above either horizon.
#[test]
fn coats_on_what_leans_are_drawn_as_they_are_weighed() {
    const LEANS_RAD: f64 = 0.4;
    for (alpha, cos) in [(0.2, 0.5), (0.5, 0.3), (0.3, 0.9)] {
        let wo = viewer(cos);
        let coated = |leans_rad: f64| {
            let turn = DMat3::from_rotation_y(-leans_rad);
            let under_coat = BaseLobes {
                under_coat: Some(turn),
                ..plastic((turn * wo).z, 0.3)
            };
            let of_coat = reflectance(Reflector::COAT, alpha);
            under_coat.coated(0.7, alpha.sqrt(), wo, of_coat)
        };
        let lobes = coated(LEANS_RAD);
        const ROWS: usize = 500;
        let (mut whole, mut light) = (0.0, DVec3::ZERO);
        for i in 0..2 * ROWS * ROWS {
            let z = 2.0 * ((i / (2 * ROWS)) as f64 + 0.5) / ROWS as f64 - 1.0;
            let (sin, cos) = (PI * ((i % (2 * ROWS)) as f64 + 0.5) / ROWS as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let wi = DVec3::new(r * cos, r * sin, z);
            let solid_angle = 2.0 * PI / (ROWS * ROWS) as f64;
            let (s, d) = lobes.eval(wi);
            assert!(s + d == DVec3::ZERO || lobes.are_above(wi));
            whole += lobes.pdf(wi) * solid_angle;
            light += (s + d) * solid_angle;
        }
        const SIDE: usize = 200;
        let (mut kept, mut mean, mut picks) = (0.0, DVec3::ZERO, Draw::new(11));
        for u in jittered(SIDE, 12) {
            if let Some(wi) = lobes.sample(picks.one(), u) {
                let (s, d) = lobes.eval(wi);
                kept += 1.0 / (SIDE * SIDE) as f64;
                mean += (s + d) / (lobes.pdf(wi) * (SIDE * SIDE) as f64);
            }
        }
        // Same tolerance as above.
        assert!((whole - kept).abs() < 8e-3, "{alpha} {cos}: {whole} {kept}");
        let off = (mean - light).abs().max_element();
        assert!(off < 8e-3, "{alpha} {cos}: {mean} {light}");
        let [leaning, upright] = [LEANS_RAD, 0.0].map(|rad| coated(rad).eval(mirror(wo)).0.x);
        assert!(
            leaning < 0.9 * upright,
            "{alpha} {cos}: {leaning} {upright}"
        );
    }
}

/// Prints nanoseconds per call: `cargo test --release -p hairline-reference -- --ignored --nocapture base_timings`.
#[test]
#[ignore = "prints figures"]
fn base_timings() {
    const CALLS: usize = 1_000_000;
    let mut draw = Draw::new(8);
    let us: Vec<_> = (0..1024).map(|_| draw.two()).collect();
    let lobes = plastic(0.7, 0.1);
    let directions: Vec<_> = us
        .iter()
        .map(|u| lobes.sample(u.x, *u).unwrap_or(DVec3::Z))
        .collect();
    let time = |name: &str, call: &dyn Fn(usize) -> f64| {
        let start = std::time::Instant::now();
        let sum: f64 = (0..CALLS).map(|i| call(i % us.len())).sum();
        std::hint::black_box(sum);
        println!(
            "{name} {:.0} ns",
            start.elapsed().as_nanos() as f64 / CALLS as f64
        );
    };
    let (wo, ends) = (lobes.wo, lobes.ends);
    time("new", &|i| {
        BaseLobes::from_parts(wo, lobes.reflectance, ends, DVec3::ONE, us[i].x).gain
    });
    time("sample", &|i| {
        lobes.sample(us[i].x, us[i]).map_or(0.0, |w| w.z)
    });
    time("eval", &|i| lobes.eval(directions[i]).0.x);
    time("pdf", &|i| lobes.pdf(directions[i]));
}
