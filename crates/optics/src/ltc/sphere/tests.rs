//! Cones under the lobe's map.

use super::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// Lobes from mirrors to rough ones, at all views, and cones of half-angles from 1e-5 to 89 degrees, near the mirror or not.
fn cones() -> impl Iterator<Item = (LtcLobe, DVec3, f64)> {
    let mut random = Pcg32::seed_from_u64(5);
    (0..4000).map(move |i| {
        let mut next = || random.random::<f64>();
        let (z, phi) = (next(), 2.0 * PI * next());
        let wo = DVec3::new(
            (1.0 - z * z).sqrt() * phi.cos(),
            (1.0 - z * z).sqrt() * phi.sin(),
            z,
        );
        let roughness = next();
        let lobe = ltc_lobe(wo, roughness);
        let offset = DVec3::new(next() - 0.5, next() - 0.5, next() - 0.5);
        let reach = if i % 2 == 0 { 4.0 * lobe.alpha } else { 4.0 };
        let axis = (DVec3::new(-wo.x, -wo.y, wo.z) + reach * offset).normalize();
        let sine = 10f64.powf(-5.0 * next()).min(0.9998);
        (lobe, axis, sine * sine)
    })
}

#[test]
fn rims_are_on_their_cones() {
    let (mut worst, mut worst_wrong) = (0.0_f64, f64::INFINITY);
    for (lobe, axis, sin2) in cones() {
        let axis = lobe.rotate(axis);
        let cone = ltc_cone_axes(&ltc_cone(&lobe, axis, sin2));
        let (u, v) = irradiance_basis(axis);
        let (mut off, mut wrong) = (0.0_f64, 0.0_f64);
        for i in 0..8 {
            let (sin, cos) = (PI * f64::from(i) / 4.0).sin_cos();
            let rim = axis * (1.0 - sin2).sqrt() + (u * cos + v * sin) * sin2.sqrt();
            let rim = lobe.to_cosine(rim).normalize();
            // Distances from the rim, in units of its own half-axes.
            let on = |axis: DVec3, t1: f64| {
                let (x, y) = (rim.dot(cone.side1) / t1, rim.dot(cone.side2) / cone.t2);
                let (depth, across) = (rim.dot(axis), x.hypot(y));
                (across - depth).abs() / (across + depth.abs())
            };
            off = off.max(on(cone.axis, cone.t1));
            wrong = wrong.max(on(cone.axis, 1.01 * cone.t1));
        }
        // Half-angles end before 90 degrees.
        if cone.t2 < 1e3 {
            // The rim's points are rounded, and a narrow cone is told by their differences.
            worst = worst.max(off * cone.t1.min(1.0));
            worst_wrong = worst_wrong.min(wrong);
        }
    }
    // A half-axis of one percent more is seen.
    assert!(worst < 1e-12, "{worst:e}");
    assert!(worst_wrong > 1e-3, "{worst_wrong:e}");
}

#[test]
fn whole_cones_are_cones_that_nothing_cuts() {
    for (lobe, axis, sin2) in cones() {
        if axis.z < 0.0 || axis.z * axis.z < sin2 {
            continue;
        }
        let cone = ltc_cone(&lobe, lobe.rotate(axis), sin2);
        let (whole, by_axes) = (
            ltc_cone_whole(&cone),
            irradiance_cone(&ltc_cone_axes(&cone)),
        );
        let off = (whole - by_axes).length() / whole.length();
        // Limit of half-angles.
        let t2 = ltc_cone_axes(&cone).t2;
        let tolerance = if t2 < 1e3 { 1e-9 } else { 1e-6 };
        assert!(off < tolerance, "{off:e} {sin2} {t2}");
    }
}
