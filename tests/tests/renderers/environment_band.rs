//! Scratches under an environment: the cells along the band against a fine quadrature over the sharp map.

use glam::{DQuat, DVec2, DVec3};
use hairline_image::Picture;
use hairline_optics::band::{BandFrame, BandLine};
use hairline_optics::band_environment::environment_band;
use hairline_optics::metal::Metal;
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::table::ScratchTable;
use hairline_scene::Environment;
use hairline_scene::environment::lookup::environment_dir;

/// A map from a function of direction.
fn map(radiance: impl Fn(DVec3) -> DVec3) -> Environment {
    let size_px = [512, 256];
    let texel = |i: u32| {
        let (x, y) = (i % size_px[0], i / size_px[0]);
        let uv = DVec2::new(
            (f64::from(x) + 0.5) / f64::from(size_px[0]),
            (f64::from(y) + 0.5) / f64::from(size_px[1]),
        );
        radiance(environment_dir(uv)).as_vec3().to_array()
    };
    let rgb = (0..size_px[0] * size_px[1]).map(texel).collect();
    hairline_sky::from_map(Picture { size_px, rgb }, 0.0, 1.0, true)
}

/// A sky, brighter towards the top and bluer away from it.
fn sky(w: DVec3) -> DVec3 {
    let up = 0.5 + 0.5 * w.y;
    DVec3::new(0.2 + 0.6 * up, 0.25 + 0.55 * up, 0.5 + 0.3 * up) + 0.2 * w.x
}

/// Radiance of a disk of the given angular radius, with an edge that is a fifth of it wide.
fn disk(w: DVec3, towards: DVec3, radius_rad: f64) -> f64 {
    let t = (1.1 - w.angle_between(towards.normalize()) / radius_rad) / 0.2;
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

struct Case {
    cells: DVec3,
    exact: DVec3,
    width_um: f64,
}

fn cases(environment: &Environment, widths_um: &[f64]) -> Vec<Case> {
    let table = ScratchTable::new(|nm| Metal::Aluminium.reflectance(1.0, nm));
    let mut cases = Vec::new();
    for &width_um in widths_um {
        for angle_deg in [0.0_f64, 20.0, 45.0, 65.0, 80.0] {
            for turn_deg in (0..180).step_by(10) {
                // The surface is level, seen from -z; the map's top is +Y.
                let world_from_surface = DQuat::from_rotation_arc(DVec3::Z, DVec3::Y);
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                let wo = DVec3::new(sin, 0.0, cos);
                let (y, x) = (f64::from(turn_deg) + 7.0).to_radians().sin_cos();
                let frame = BandFrame {
                    tangent: DVec2::new(x, y),
                };
                let line = BandLine::new(frame.band_from_surface(wo), 0.0);
                let world = |w: DVec3| world_from_surface * frame.surface_from_band(w);
                let depth_nm = 140.0 + 25.0 * f64::from(turn_deg % 60);
                let t = |q: f64, cos_i: f64| {
                    table.scratch_table(width_um * q, oblique_depth_nm(depth_nm, cos_i, wo.z))
                };
                let cells = environment_band(line, width_um, t, |w, roughness| {
                    environment.prefiltered(world(w), roughness)
                });
                let exact = quadrature(line, t, |w| environment.radiance(world(w)));
                cases.push(Case {
                    cells,
                    exact,
                    width_um,
                });
            }
        }
    }
    cases
}

/// The response in each of many steps, at the step's own angle, times the sharp map in its middle.
fn quadrature(
    line: BandLine,
    antiderivative: impl Fn(f64, f64) -> [f64; 3],
    radiance: impl Fn(DVec3) -> DVec3,
) -> DVec3 {
    const STEPS: usize = 4000;
    let mut sum = DVec3::ZERO;
    for i in 0..STEPS {
        // Even in angle, so that the ends of the arc are resolved too.
        let angle = |i: f64| std::f64::consts::PI * (1.0 - i / STEPS as f64);
        let (sin, cos) = angle(i as f64 + 0.5).sin_cos();
        let direction = DVec3::new(line.along, line.radius * cos, line.radius * sin);
        let at = |i: usize| {
            let q = line.offset + line.radius * angle(i as f64).cos();
            DVec3::from(antiderivative(q, direction.z))
        };
        sum += (at(i + 1) - at(i)) * radiance(direction);
    }
    sum
}

/// Rms of the difference over rms of the exact value, all channels.
fn rms(cases: &[&Case]) -> f64 {
    let error: f64 = cases
        .iter()
        .map(|c| (c.cells - c.exact).length_squared())
        .sum();
    let size: f64 = cases.iter().map(|c| c.exact.length_squared()).sum();
    (error / size).sqrt()
}

#[test]
fn cells_equal_quadrature() {
    let towards = DVec3::new(-0.5, 0.75, 0.25);
    let glow = |w: DVec3, std_rad: f64| {
        let off = w.angle_between(towards.normalize()) / std_rad;
        8.0 * (-0.5 * off * off).exp()
    };
    let sun = |w: DVec3, radius_rad: f64| disk(w, towards, radius_rad) * 0.72 / radius_rad.powi(2);
    // Cells are 0.12 rad wide in the main lobe of the narrowest scratch seen from above, more beside it and at grazing views.
    // Light that varies over more than that must be right within a percent or two (one depth stands for all angles of a cell,
    // which narrow scratches seen at grazing angles feel even under an even sky), a wide disk within 6 % for its edge.
    // A disk as small as the cells is held to what it was measured at: lamps of a map so small are lights of their own.
    let maps: [(&str, Environment, f64); 3] = [
        (
            "soft sun of 0.15 rad",
            map(|w| sky(w) + glow(w, 0.15)),
            0.025,
        ),
        ("disk of 0.3 rad", map(|w| sky(w) + sun(w, 0.3)), 0.06),
        ("disk of 0.1 rad", map(|w| sky(w) + sun(w, 0.1)), 0.28),
    ];
    let mut failures = Vec::new();
    for (name, environment, bound) in &maps {
        let all = cases(environment, &[1.0, 2.0, 5.0]);
        let by_width = [1.0, 2.0, 5.0].map(|width_um| {
            let some: Vec<&Case> = all.iter().filter(|c| c.width_um == width_um).collect();
            rms(&some)
        });
        let total = rms(&all.iter().collect::<Vec<_>>());
        println!("{name}: rms {total:.4}; at 1, 2, 5 um {by_width:.4?}");
        if total > *bound {
            failures.push(format!("{name}: rms {total}"));
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}
