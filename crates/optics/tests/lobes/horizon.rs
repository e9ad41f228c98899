//! Lights that a surface's horizon cuts: a wall and a sphere that stand in a plane of metal, over all of its visible points.

use glam::DVec3;
use hairline_optics::fresnel::FresnelRgb;
use hairline_optics::ggx::{ggx_alpha, ggx_eval};
use hairline_optics::ltc::{polygon_light, sphere_light};

use super::cubature::{Cap, Peak, integrate, integrate_polygon};

const EYE: DVec3 = DVec3::new(0.0, -0.31, 0.25);
/// Points along each side of the plane.
const POINTS: usize = 12;

/// Prints and judges the ratio of the means and the rms difference over the mean of (light, exact) at all points.
fn judge(name: &str, roughness: f64, at: impl Fn(DVec3) -> (f64, f64)) {
    let place = |i: usize| 0.19 * (i as f64 / (POINTS - 1) as f64 - 0.5);
    let values: Vec<(f64, f64)> = (0..POINTS * POINTS)
        .map(|i| at(DVec3::new(place(i % POINTS), place(i / POINTS), 0.0)))
        .collect();
    let count = values.len() as f64;
    let mean = values.iter().map(|v| v.1).sum::<f64>() / count;
    let ratio = values.iter().map(|v| v.0).sum::<f64>() / count / mean;
    let rms = (values.iter().map(|v| (v.0 - v.1).powi(2)).sum::<f64>() / count).sqrt() / mean;
    println!(
        "{name}, roughness {roughness}: mean {ratio:.4}, rms {:.2} %",
        100.0 * rms
    );
    assert!((ratio - 1.0).abs() < 0.015, "{name} {roughness}: {ratio}");
    assert!(rms < 0.03, "{name} {roughness}: {rms}");
}

/// The viewer's direction, and the map from the world to the local frame.
fn viewer(point: DVec3) -> (DVec3, impl Fn(DVec3) -> DVec3) {
    let view = (EYE - point).normalize();
    let x = view.with_z(0.0).normalize();
    let y = DVec3::Z.cross(x);
    let local = move |w: DVec3| DVec3::new(w.dot(x), w.dot(y), w.z);
    (local(view), local)
}

fn peak(wo: DVec3, roughness: f64) -> Peak {
    Peak {
        direction: DVec3::new(-wo.x, -wo.y, wo.z),
        width_rad: 0.5 * ggx_alpha(roughness) * wo.z,
    }
}

#[test]
fn walls_that_stand_on_the_surface() {
    let (left, right) = (DVec3::new(-0.2, 0.15, 0.0), DVec3::new(0.2, 0.15, 0.0));
    let wall = [
        left.with_z(-0.13),
        right.with_z(-0.13),
        right.with_z(0.17),
        left.with_z(0.17),
    ];
    for roughness in [0.1, 0.3, 0.6, 1.0] {
        judge("wall", roughness, |point| {
            let (wo, local) = viewer(point);
            let vertices = wall.map(|vertex| local(vertex - point));
            let alpha = ggx_alpha(roughness);
            let exact = integrate_polygon(&vertices, peak(wo, roughness), &|wi| {
                ggx_eval(wi, wo, alpha)
            });
            let white = FresnelRgb::schlick([1.0; 3]);
            (
                polygon_light(wo, roughness, white, &vertices)[0],
                exact.abs(),
            )
        });
    }
}

#[test]
fn spheres_that_are_half_set() {
    let (center, radius) = (DVec3::new(0.02, 0.2, 0.02), 0.07);
    for roughness in [0.1, 0.3, 0.6, 1.0] {
        judge("sphere", roughness, |point| {
            let (wo, local) = viewer(point);
            let to_center = local(center - point);
            let axis = to_center.normalize();
            let sin2 = radius * radius / to_center.length_squared();
            let alpha = ggx_alpha(roughness);
            let cap = Cap {
                axis,
                radius_rad: sin2.sqrt().asin(),
            };
            let exact = integrate(cap, peak(wo, roughness), &|wi| ggx_eval(wi, wo, alpha));
            let white = FresnelRgb::schlick([1.0; 3]);
            (sphere_light(wo, roughness, white, axis, sin2)[0], exact)
        });
    }
}
