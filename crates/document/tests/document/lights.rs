//! The shapes of lights against exact integrals over their surfaces.

use glam::{DVec2, DVec3};
use hairline_document::Description;
use hairline_document::description::{Cone, Light, LightKind};
use hairline_optics::band::{BandFrame, BandLine, Outline, OutlineEdge, OutlineRoots};
use hairline_optics::irradiance::lambert_polygon;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::PI;
use std::path::Path;

#[test]
fn a_rectangle_lies_as_its_keys_say() {
    let rectangle = |target_m: [f64; 3], rotation_deg: f64| {
        let kind = LightKind::Rectangle {
            center_m: [1.0, 2.0, 3.0],
            target_m,
            width_m: 0.4,
            height_m: 0.2,
            rotation_deg,
            two_sided: false,
        };
        kind.corners_m()
            .into_iter()
            .map(|v| v - DVec3::new(1.0, 2.0, 3.0))
            .collect::<Vec<_>>()
    };
    // Facing z: y is up, x is right as the target sees it; seen from there counter-clockwise.
    let upright = [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]];
    for (found, [x, y]) in rectangle([1.0, 2.0, 5.0], 0.0).iter().zip(upright) {
        assert!(found.distance(DVec3::new(x, y, 0.0)) < 1e-12, "{found}");
    }
    for (found, [x, y]) in rectangle([1.0, 2.0, 5.0], 90.0).iter().zip(upright) {
        assert!(found.distance(DVec3::new(-y, x, 0.0)) < 1e-12, "{found}");
    }
    // Facing down along y, where z is up.
    for (found, [x, y]) in rectangle([1.0, 0.0, 3.0], 0.0).iter().zip(upright) {
        assert!(found.distance(DVec3::new(x, 0.0, y)) < 1e-12, "{found}");
    }
}

/// A sun's irradiance is the same wherever in the scene, and however wide it is, by the solid angle's projection on a
/// surface that faces it.
#[test]
fn a_sun_stands_in_one_direction_and_sends_what_its_irradiance_says() {
    for (direction, angle_deg) in [([0.0, 3.0, -4.0], 0.53), ([-1.0, 0.0, 0.0], 30.0)] {
        let light = Light {
            color: [1.0, 0.5, 0.25],
            exposure_ev: 1.0,
            ..Light::new(LightKind::Sun {
                direction,
                angle_deg,
                irradiance: 2.0,
            })
        };
        light.check().unwrap();
        let towards_it = -DVec3::from(direction).normalize();
        let sun = in_scene(light);
        let (center_m, radius_m) = sun.bounding_sphere();
        for at_m in [DVec3::ZERO, DVec3::new(3.0, -2.0, 1.0)] {
            let offset = center_m - at_m;
            // A scene of some metres is a point beside it.
            assert!(offset.normalize().distance(towards_it) < 1e-4);
            let sin = radius_m / offset.length();
            assert!((2.0 * sin.asin().to_degrees() / angle_deg - 1.0).abs() < 1e-4);
            for (radiance, expected) in sun.radiance.into_iter().zip([4.0, 2.0, 1.0]) {
                let irradiance = PI * radiance * sin * sin;
                assert!((irradiance / expected - 1.0).abs() < 1e-4, "{irradiance}");
            }
        }
    }
}

#[test]
fn what_a_sun_cannot_have_is_refused_in_code_too() {
    let sun = Light::new(LightKind::sun([0.0, 0.0, -1.0]));
    sun.check().unwrap();
    let odd = [
        (
            "visible",
            Light {
                visible: true,
                ..sun.clone()
            },
        ),
        (
            "radiance",
            Light {
                radiance: 2.0,
                ..sun.clone()
            },
        ),
        (
            "cone_deg",
            Light {
                cone: Some(Cone::new(30.0, None)),
                ..sun.clone()
            },
        ),
    ];
    for (key, light) in odd {
        let error = light.check().unwrap_err();
        assert_eq!(error.key(), format!("light.{key}"));
    }
}

fn in_scene(light: Light) -> hairline_scene::Light {
    const DARK: &str = "[camera]\nposition_m = [0, -1, 1]\ntarget_m = [0, 0, 0]\n[[material]]\nname = \"m\"\nkind = \"mirror\"\n[[object]]\nname = \"o\"\nshape = { disk = { radius_m = 0.1 } }\nmaterial = \"m\"";
    let mut description = Description::from_toml(DARK, Path::new("test")).unwrap();
    description.lights = vec![light];
    hairline_document::build(&description, Path::new(""))
        .unwrap()
        .lights[0]
        .clone()
}

/// A round light before the surface whose normal is z, seen from the origin.
struct Disk {
    center: DVec3,
    axis: DVec3,
    radius: f64,
}

impl Disk {
    fn corners(&self) -> Vec<DVec3> {
        let kind = LightKind::Disk {
            center_m: self.center.into(),
            target_m: (self.center + self.axis).into(),
            radius_m: self.radius,
            two_sided: false,
        };
        kind.corners_m()
    }

    fn is_hit(&self, w: DVec3) -> bool {
        let t = self.axis.dot(self.center) / self.axis.dot(w);
        t > 0.0 && self.center.distance(t * w) < self.radius
    }
}

/// The form factor of a disk that is parallel to the surface: J. R. Howell's catalogue of configuration factors, B-13.
fn parallel_disk(height: f64, beside: f64, radius: f64) -> f64 {
    let [h2, d2, r2] = [height, beside, radius].map(|x| x * x);
    let z = h2 + d2 + r2;
    0.5 * (1.0 - (h2 + d2 - r2) / (z * z - 4.0 * d2 * r2).sqrt())
}

#[test]
fn a_disk_on_a_body_is_round() {
    for (height, beside, radius) in [
        (1.0, 0.0, 0.3),
        (0.4, 0.5, 0.45),
        (0.1, 0.3, 0.25),
        (2.0, 5.0, 1.0),
    ] {
        let exact = parallel_disk(height, beside, radius);
        let seen = |radius: f64| {
            let disk = Disk {
                center: DVec3::new(beside, 0.0, height),
                axis: -DVec3::Z,
                radius,
            };
            lambert_polygon(&disk.corners()) / exact - 1.0
        };
        println!("{height} {beside} {radius}: {:.4} %", 100.0 * seen(radius));
        assert!(seen(radius).abs() < 2e-3);
        assert!(seen(1.005 * radius).abs() > 2e-3);
    }
}

/// k W / 2 of a scratch of 3 um at 555 nm.
const HALF_PHASE: f64 = PI * 3.0 / 0.555;
/// Standard deviation of the band.
const STD: f64 = 0.0031;
const STEPS: usize = 8_000;

fn sinc2(q: f64) -> f64 {
    let x = HALF_PHASE * q;
    if x.abs() < 1e-6 {
        1.0
    } else {
        (x.sin() / x).powi(2)
    }
}

/// The integral of sinc^2 from 0.
fn antiderivative(q: f64) -> f64 {
    let step = q / 400.0;
    (0..400)
        .map(|i| sinc2((f64::from(i) + 0.5) * step))
        .sum::<f64>()
        * step
}

/// Integral on one line of the band of a scratch along x.
fn on_line(wo: DVec3, line: BandLine, disk: &Disk) -> f64 {
    let step = PI / STEPS as f64;
    let at = |i: usize| {
        let (sin, cos) = ((i as f64 + 0.5) * step).sin_cos();
        let w = DVec3::new(line.along, line.radius * cos, line.radius * sin);
        if disk.is_hit(w) {
            sinc2(wo.y + w.y) * line.radius * sin
        } else {
            0.0
        }
    };
    (0..STEPS).map(at).sum::<f64>() * step
}

#[test]
fn a_disk_on_a_scratch_is_round() {
    let mut random = Pcg64::seed_from_u64(7);
    let (mut error, mut whole, mut wider) = (0.0, 0.0, 0.0);
    for i in 0..40 {
        let radius = 0.012 * 1.09_f64.powi(i);
        let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        // Near the mirror's direction, so that the light matters, and partly off the band.
        let wo = DVec3::new(between(-0.3, 0.3), between(-0.4, 0.4), 1.0).normalize();
        let center = wo * DVec3::new(-1.0, -1.0, 1.0)
            + DVec3::new(between(-0.5, 0.5), between(-1.0, 1.0), 0.0) * radius;
        let axis = (DVec3::new(between(-0.5, 0.5), between(-0.5, 0.5), 0.0) - center).normalize();
        let disk = Disk {
            center,
            axis,
            radius,
        };
        let closed = |radius: f64, line: BandLine| {
            let corners = Disk { radius, ..disk }.corners();
            let directions: Vec<_> = corners.iter().map(|v| v.normalize()).collect();
            let edges: Vec<_> = OutlineEdge::of_outline(&directions).collect();
            let outline = Outline {
                edges: &edges,
                away: -axis,
                facing: 1.0,
                sets: false,
            };
            let mut roots = OutlineRoots::default();
            outline.roots(BandFrame { tangent: DVec2::X }, line, &mut roots);
            let roots = roots.signed().iter();
            roots
                .map(|(sign, q)| sign * antiderivative(*q))
                .sum::<f64>()
        };
        // The same lines for all, so that only the shape differs.
        let over_band = |on: &dyn Fn(BandLine) -> f64| {
            let line = |i: i32| 0.25 * f64::from(i);
            (-12..=12)
                .map(|i| (-0.5 * line(i).powi(2)).exp() * on(BandLine::new(wo, line(i) * STD)))
                .sum::<f64>()
        };
        let exact = over_band(&|line| on_line(wo, line, &disk));
        error += (over_band(&|line| closed(radius, line)) - exact).powi(2);
        wider += (over_band(&|line| closed(1.01 * radius, line)) - exact).powi(2);
        whole += exact * exact;
    }
    let [error, wider] = [error, wider].map(|sum: f64| (sum / whole).sqrt());
    println!(
        "scratches, rms: {:.3} %, of a radius 1 % off {:.3} %",
        100.0 * error,
        100.0 * wider
    );
    assert!(error < 2e-3, "{error}");
    assert!(wider > 2e-3, "{wider}");
}
