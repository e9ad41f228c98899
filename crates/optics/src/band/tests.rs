//! Chords and roots against quadrature by indicator functions, which shares no formula with them.

use super::polygon::line_down;
use super::*;
use crate::diffraction::chord_integral;
use crate::scratch::{band_std, oblique_depth_nm, phase_step_energy};
use std::f64::consts::PI;

const SIGMA_UM: f64 = 20.0;
const NM: f64 = 555.0;

/// A deterministic sequence of numbers in [0, 1).
struct Sequence(u64);
impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn uniform_between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
    fn direction(&mut self, lowest_z: f64) -> DVec3 {
        let z = self.uniform_between(lowest_z, 1.0);
        let (sin, cos) = self.uniform_between(0.0, 2.0 * PI).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * cos, r * sin, z)
    }
}

/// The integral of the band's Gaussian times sinc^2 over the directions above the horizon that a light covers:
/// over the plane of (w_t, w_n), with the indicator function of the light. Shares no formula with the roots.
fn quadrature(
    wo: DVec3,
    width_um: f64,
    covers: impl Fn(DVec3) -> bool,
    lines: usize,
    steps: usize,
    single_line: bool,
) -> f64 {
    let std_xi = band_std(SIGMA_UM, NM);
    let mut sum = 0.0;
    // Midpoints in phi; bisection would be a chord finder, so plain indicator sampling it is.
    let arc: Vec<(f64, f64)> = (0..steps)
        .map(|j| (PI * (j as f64 + 0.5) / steps as f64).sin_cos())
        .collect();
    let line_count = if single_line { 1 } else { lines };
    for i in 0..line_count {
        let z = if single_line {
            0.0
        } else {
            -4.5 + 9.0 * (i as f64 + 0.5) / lines as f64
        };
        let weight = if single_line {
            1.0
        } else {
            (-0.5 * z * z).exp() / (2.0 * PI).sqrt() * 9.0 / lines as f64
        };
        let w_t = z * std_xi - wo.x;
        if w_t.abs() >= 1.0 {
            continue;
        }
        let r = (1.0 - w_t * w_t).sqrt();
        for &(sin_phi, cos_phi) in &arc {
            let w = DVec3::new(w_t, r * cos_phi, r * sin_phi);
            if covers(w) {
                let x = 2.0 * PI / (NM * 1e-3) * width_um * (wo.y + w.y) / 2.0;
                let sinc = if x == 0.0 { 1.0 } else { x.sin() / x };
                sum += weight * sinc * sinc * r * sin_phi * PI / steps as f64;
            }
        }
    }
    sum
}

fn sphere_integral(wo: DVec3, cap: Cap, width_um: f64) -> f64 {
    let (lowest, highest) = sphere_band_extent(wo, cap);
    lines_integral(wo, lowest, highest, |line| {
        sphere_chord(line, cap).integral(line, |q| [chord_integral(q, width_um, NM * 1e-3)])[0]
    })
}

/// The scratch's frame is the surface's where a test needs no other.
const ALONG_X: BandFrame = BandFrame { tangent: DVec2::X };

fn with_view<R>(vertices: &[DVec3], two_sided: bool, f: impl Fn(&PolygonView) -> R) -> R {
    let directions: Vec<DVec3> = vertices.iter().map(|v| v.normalize_or_zero()).collect();
    let (away, facing) = polygon_facing(vertices.iter().copied(), two_sided);
    f(&PolygonView {
        directions: &directions,
        away,
        facing,
    })
}

fn one_line(vertices: &[DVec3], line: BandLine, antiderivative: impl Fn(f64) -> f64) -> f64 {
    with_view(vertices, true, |view| {
        view.integral(ALONG_X, line, |q| [antiderivative(q)])[0]
    })
}

fn polygon_integral(wo: DVec3, vertices: &[DVec3], width_um: f64) -> f64 {
    let (lowest, highest) = with_view(vertices, true, |view| view.band_extent(ALONG_X, wo));
    lines_integral(wo, lowest, highest, |line| {
        one_line(vertices, line, |q| chord_integral(q, width_um, NM * 1e-3))
    })
}

fn lines_integral(wo: DVec3, lowest: f64, highest: f64, on_line: impl Fn(BandLine) -> f64) -> f64 {
    let std = band_std(SIGMA_UM, NM);
    let stds = BandStds {
        mean: std,
        channels: [std; 3],
    };
    let lines = band_lines(wo.x, lowest, highest, stds);
    lines.integral(wo, |line| [on_line(line); 3]).x
}

/// One line of very many scratches: the mean over where it lies is that of a fine quadrature.
#[test]
fn one_line_is_right_in_the_mean() {
    let (wo, width_um) = (DVec3::new(0.1, 0.2, 0.9).normalize(), 2.0);
    let cap = sphere_cap(DVec3::new(-0.05, 0.3, 1.0), 0.2).turned(ALONG_X);
    let (lowest, highest) = sphere_band_extent(wo, cap);
    for std in [0.02, 0.1, 0.25] {
        // Red is a little wider, as under a wide footprint.
        let stds = BandStds {
            mean: std,
            channels: [1.01 * std, std, 0.99 * std],
        };
        let on_line = |line: BandLine| {
            sphere_chord(line, cap).integral(line, |q| [chord_integral(q, width_um, NM * 1e-3); 3])
        };
        let count = 512;
        // Quadrature over xi_t, which shares no node with the lines.
        let step = (highest - lowest) / f64::from(count);
        let density =
            |xi_t: f64, std: f64| (-0.5 * (xi_t / std).powi(2)).exp() / (std * (2.0 * PI).sqrt());
        let expected = |std: f64| -> f64 {
            let xis = (0..count).map(|i| lowest + step * (f64::from(i) + 0.5));
            xis.map(|xi_t| step * density(xi_t, std) * on_line(BandLine::new(wo, xi_t))[1])
                .sum()
        };
        let expected = stds.channels.map(expected);
        let lines = band_lines(wo.x, lowest, highest, stds);
        let one = |i| lines.by_one_line((f64::from(i) + 0.5) / f64::from(count));
        let mean = (0..count)
            .map(|i| one(i).integral(wo, on_line))
            .sum::<DVec3>();
        let mean = mean / f64::from(count);
        println!("{std}: {mean} {expected:?}");
        for (found, expected) in mean.to_array().into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 5e-3, "{found} {expected}");
        }
        // Nodes that do not lie evenly are told.
        let uneven = (0..count).map(|i| {
            let node = ((f64::from(i) + 0.5) / f64::from(count)).powi(2);
            lines.by_one_line(node).integral(wo, on_line).y / f64::from(count)
        });
        assert!((uneven.sum::<f64>() / expected[1] - 1.0).abs() > 5e-3);
    }
}

fn relative_rms(pairs: &[(f64, f64)]) -> f64 {
    let (error2, value2) = pairs.iter().fold((0.0, 0.0), |(e, v), (value, expected)| {
        (e + (value - expected).powi(2), v + expected * expected)
    });
    (error2 / value2).sqrt()
}

#[test]
fn sphere_lights_equal_two_dimensional_quadrature() {
    let std_xi = band_std(SIGMA_UM, NM);
    for (radius, bound) in [
        (0.001, 0.01),
        (0.005, 0.01),
        (0.02, 0.01),
        (0.049, 0.01),
        (0.05, 0.01),
        (0.15, 0.005),
        (0.6, 0.005),
    ] {
        let mut random = Sequence(7);
        let mut pairs = Vec::new();
        while pairs.len() < 24 {
            let wo = random.direction(0.2);
            // Near the band, or there is nothing to compare.
            let (offset, turn) = (
                random.uniform_between(-1.5, 1.5) * (radius + std_xi),
                random.uniform_between(0.0, PI),
            );
            let w_t = -wo.x + offset;
            if w_t.abs() > 0.9 {
                continue;
            }
            let r = (1.0 - w_t * w_t).sqrt();
            let axis = DVec3::new(w_t, r * turn.cos(), r * turn.sin());
            let cap = Cap {
                axis,
                sin_radius: f64::sin(radius),
                cos_radius: f64::cos(radius),
            };
            let steps = (2000.0 / radius.min(0.2)) as usize;
            // A chord much shorter than the arc needs fine steps only near the light.
            let expected = quadrature(
                wo,
                2.0,
                |w| (w - axis).length() < 2.0 * (radius / 2.0).sin(),
                if radius < 0.01 { 401 } else { 121 },
                steps.min(40_000),
                false,
            );
            pairs.push((sphere_integral(wo, cap, 2.0), expected));
        }
        let rms = relative_rms(&pairs);
        println!(
            "sphere of {radius} rad: relative rms error {:.3} %",
            100.0 * rms
        );
        assert!(rms < bound, "{radius}: {rms}");
    }
}

#[test]
fn one_line_through_a_sphere_is_exact_wherever_it_lies() {
    // On the line itself there is nothing to approximate: horizon, point under the light, huge lights.
    let mut random = Sequence(3);
    let mut pairs = Vec::new();
    for _ in 0..200 {
        let (wo, axis, radius) = (
            random.direction(0.0),
            random.direction(-1.0),
            random.uniform_between(0.05, 3.0),
        );
        let cap = Cap {
            axis,
            sin_radius: f64::sin(radius),
            cos_radius: f64::cos(radius),
        };
        let line = BandLine::new(wo, 0.0);
        let value =
            sphere_chord(line, cap).integral(line, |q| [chord_integral(q, 2.0, NM * 1e-3)])[0];
        pairs.push((
            value,
            quadrature(wo, 2.0, |w| w.dot(axis) > f64::cos(radius), 1, 20_000, true),
        ));
    }
    let rms = relative_rms(&pairs);
    println!("sphere, one line: relative rms error {:.4} %", 100.0 * rms);
    assert!(rms < 1e-3);
}

/// A random planar polygon, star-shaped about its centre and seldom convex, with its plane's normal.
fn random_polygon(random: &mut Sequence, size: f64) -> Vec<DVec3> {
    let center = random.direction(-0.4) * random.uniform_between(0.5, 2.0);
    let normal = random.direction(-1.0);
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let count = 3 + (random.next() * 6.0) as usize;
    (0..count)
        .map(|i| {
            let (sin, cos) = (2.0 * PI * (i as f64 + 0.8 * random.next()) / count as f64).sin_cos();
            center + size * random.uniform_between(0.2, 1.0) * (u * cos + v * sin)
        })
        .collect()
}

/// Whether the ray from the origin hits the polygon: planar crossing number.
fn hits(vertices: &[DVec3], w: DVec3) -> bool {
    let normal: DVec3 = (1..vertices.len() - 1)
        .map(|i| (vertices[i] - vertices[0]).cross(vertices[i + 1] - vertices[0]))
        .sum();
    let t = normal.dot(vertices[0]) / normal.dot(w);
    if !(t > 0.0) {
        return false;
    }
    let u = normal.any_orthonormal_vector();
    let v = normal.normalize().cross(u);
    let flat = |p: DVec3| (p.dot(u), p.dot(v));
    let (px, py) = flat(w * t);
    let mut inside = false;
    for i in 0..vertices.len() {
        let ((ax, ay), (bx, by)) = (flat(vertices[i]), flat(vertices[(i + 1) % vertices.len()]));
        if (ay > py) != (by > py) && px < ax + (py - ay) / (by - ay) * (bx - ax) {
            inside = !inside;
        }
    }
    inside
}

#[test]
fn one_line_through_any_polygon_is_exact() {
    let mut random = Sequence(11);
    let (mut pairs, mut crossing, mut covering_down) = (Vec::new(), 0, 0);
    while pairs.len() < 174 {
        let size = random.uniform_between(0.1, 6.0);
        let vertices = random_polygon(&mut random, size);
        let wo = random.direction(0.0);
        let line = BandLine::new(wo, 0.0);
        let expected = quadrature(wo, 2.0, |w| hits(&vertices, w), 1, 20_000, true);
        if expected == 0.0 && random.next() < 0.9 {
            continue;
        }
        crossing += vertices.iter().any(|v| v.z < 0.0) as u32;
        covering_down += hits(&vertices, line_down(line)) as u32;
        pairs.push((
            one_line(&vertices, line, |q| chord_integral(q, 2.0, NM * 1e-3)),
            expected,
        ));
    }
    let rms = relative_rms(&pairs);
    println!(
        "polygon, one line: relative rms error {:.4} % on {} polygons, {crossing} across the horizon, {covering_down} over the nadir",
        100.0 * rms,
        pairs.len()
    );
    assert!(
        crossing > 40 && covering_down > 4,
        "the set must hold the hard cases"
    );
    // 20,000 steps place each root within 1.6e-4 rad.
    assert!(rms < 1e-3, "{rms}");
}

#[test]
fn polygon_lights_equal_two_dimensional_quadrature() {
    let mut random = Sequence(5);
    for size in [0.01, 0.05, 0.3] {
        let mut pairs = Vec::new();
        while pairs.len() < 24 {
            let mut vertices = random_polygon(&mut random, size);
            let wo = random.direction(0.3);
            // Moved onto the band.
            let center: DVec3 = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
            let w_t = -wo.x + random.uniform_between(-1.0, 1.0) * 0.3 * size;
            if w_t.abs() > 0.8 {
                continue;
            }
            let (sin, cos) = random.uniform_between(0.3, PI - 0.3).sin_cos();
            let r = (1.0 - w_t * w_t).sqrt();
            let target = DVec3::new(w_t, r * cos, r * sin);
            vertices.iter_mut().for_each(|v| *v += target - center);
            let expected = quadrature(wo, 2.0, |w| hits(&vertices, w), 121, 20_000, false);
            if expected > 0.0 {
                pairs.push((polygon_integral(wo, &vertices, 2.0), expected));
            }
        }
        let rms = relative_rms(&pairs);
        println!("polygon of {size}: relative rms error {:.3} %", 100.0 * rms);
        assert!(rms < 0.015, "{size}: {rms}");
    }
}

/// A panel beyond the far end of the scratch, looked at along it: the band's arcs are small circles about the tangent,
/// which the panel may hold whole, and its outline never meets them.
#[test]
fn panels_around_the_tangent_equal_two_dimensional_quadrature() {
    let mut pairs = Vec::new();
    for bottom in [-0.3, -0.05, 0.0, 0.01] {
        for elevation in [0.05f64, 0.1, 0.2] {
            let wo = DVec3::new(elevation.cos(), 0.0, elevation.sin());
            let corner = |y: f64, z: f64| DVec3::new(-1.0, y, z);
            let vertices = [
                corner(-0.3, bottom),
                corner(0.3, bottom),
                corner(0.3, bottom + 0.6),
                corner(-0.3, bottom + 0.6),
            ];
            let expected = quadrature(wo, 2.0, |w| hits(&vertices, w), 241, 20_000, false);
            let value = polygon_integral(wo, &vertices, 2.0);
            println!(
                "panel from {bottom} seen at {elevation} rad: {value:.4}, quadrature {expected:.4}"
            );
            pairs.push((value, expected));
        }
    }
    let rms = relative_rms(&pairs);
    println!(
        "panels around the tangent: relative rms error {:.3} %",
        100.0 * rms
    );
    assert!(rms < 5e-3, "{rms}");
}

/// The whole spectrum's light off a scratch by a sphere, each wavelength by its own band, line by line; per unit of W |D|^2.
fn spectral(wo: DVec3, cap: Cap, width_um: f64, depth_nm: f64) -> DVec3 {
    let widest = band_std(SIGMA_UM, 780.0);
    let (lowest, highest) = sphere_band_extent(wo, cap);
    let (low, high) = (lowest.max(-5.0 * widest), highest.min(5.0 * widest));
    let count = 240;
    let mut sum = DVec3::ZERO;
    for i in 0..count {
        let xi_t = low + (high - low) * (i as f64 + 0.5) / count as f64;
        let line = BandLine::new(wo, xi_t);
        let chord = sphere_chord(line, cap);
        for sample in crate::spectrum::samples().iter().step_by(2) {
            let (nm, std) = (
                sample.wavelength_nm,
                band_std(SIGMA_UM, sample.wavelength_nm),
            );
            let along = (-0.5 * (xi_t / std).powi(2)).exp() / ((2.0 * PI).sqrt() * std);
            let across = chord.integral(line, |q| [chord_integral(q, width_um, nm * 1e-3)])[0];
            let weight = 2.0 * phase_step_energy(depth_nm, nm) * width_um / (nm * 1e-3);
            sum += DVec3::from(sample.weight) * (weight * along * across);
        }
    }
    sum * ((high - low) / count as f64)
}

/// The error in a light's colour for lights of some radius near the band: with a band for each channel, and with one for all.
fn colour_errors(table: &crate::table::ScratchTable, radius: f64) -> [f64; 2] {
    let mut random = Sequence(17);
    let (mut own, mut one) = (Vec::new(), Vec::new());
    let stds = band_stds(SIGMA_UM);
    let for_all = BandStds {
        channels: [stds.mean; 3],
        ..stds
    };
    while own.len() < 3 * 60 {
        let wo = random.direction(0.3);
        let offset = random.uniform_between(-1.5, 1.5) * (radius + stds.mean);
        let w_t = -wo.x + offset;
        if w_t.abs() > 0.9 {
            continue;
        }
        let r = (1.0 - w_t * w_t).sqrt();
        // Within some lobes of the mirror's direction, where there is light.
        let q = random.uniform_between(-0.4, 0.4);
        let across = q - wo.y;
        if across.abs() > 0.95 * r {
            continue;
        }
        let axis = DVec3::new(w_t, across, (r * r - across * across).sqrt());
        let (sin_radius, cos_radius) = radius.sin_cos();
        let cap = Cap {
            axis,
            sin_radius,
            cos_radius,
        };
        let (width_um, depth_nm) = (
            random.uniform_between(1.0, 5.0),
            random.uniform_between(60.0, 400.0),
        );
        let exact = spectral(wo, cap, width_um, depth_nm);
        let (lowest, highest) = sphere_band_extent(wo, cap);
        let value = |stds| {
            band_lines(wo.x, lowest, highest, stds).integral(wo, |line| {
                sphere_chord(line, cap)
                    .integral(line, |q| table.scratch_table(width_um * q, depth_nm))
            })
        };
        let (with_own, with_one) = (value(stds), value(for_all));
        for c in 0..3 {
            own.push((with_own[c], exact[c]));
            one.push((with_one[c], exact[c]));
        }
    }
    [relative_rms(&own), relative_rms(&one)]
}

#[test]
fn each_channel_has_its_own_band() {
    let table = crate::table::ScratchTable::new(|_| 1.0);
    for (radius, bound) in [
        (0.001, 0.03),
        (0.005, 0.03),
        (0.017, 0.015),
        (0.07, 0.005),
        (0.2, 0.005),
        (0.6, 0.005),
    ] {
        let [own, one] = colour_errors(&table, radius);
        println!(
            "colours, sphere of {radius} rad: relative rms error {:.2} %, {:.2} % with one band for all",
            100.0 * own,
            100.0 * one
        );
        assert!(own < bound && own < one + 1e-3, "{radius}: {own} {one}");
    }
}

/// A light's chord with the phase step of each direction inside the integral, against one depth for the whole chord. The
/// lights are centred on the line, within about a lobe of the mirror's direction or `near_horizon`.
fn oblique_errors(radius: f64, near_horizon: bool) -> [f64; 2] {
    let mut random = Sequence(21);
    let (mut pairs, mut normal) = (Vec::new(), Vec::new());
    while pairs.len() < 400 {
        let wo = random.direction(0.2);
        let line = BandLine::new(wo, 0.0);
        let (width_um, depth_nm) = (
            random.uniform_between(1.0, 5.0),
            random.uniform_between(60.0, 400.0),
        );
        let middle = if near_horizon {
            random.uniform_between(-0.2, 0.2) + if random.next() < 0.5 { 0.0 } else { PI }
        } else {
            random.uniform_between(0.0, PI)
        };
        let off = (line.offset + line.radius * middle.cos()).abs();
        if random.next() > (-(off - radius).max(0.0) / 0.25).exp() {
            continue;
        }
        let (start, end) = ((middle - radius).max(0.0), (middle + radius).min(PI));
        if end <= start {
            continue;
        }
        let at = |phi: f64| line.offset + line.radius * phi.cos();
        let antiderivative = |q: f64| chord_integral(q, width_um, NM * 1e-3);
        let energy = |cos_i: f64| phase_step_energy(oblique_depth_nm(depth_nm, cos_i, wo.z), NM);
        let steps = 2000;
        let exact: f64 = (0..steps)
            .map(|i| {
                let phi = |i: f64| start + (end - start) * i / steps as f64;
                let part =
                    antiderivative(at(phi(i as f64))) - antiderivative(at(phi(i as f64 + 1.0)));
                part * energy(line.radius * phi(i as f64 + 0.5).sin())
            })
            .sum();
        let (low, high) = (at(end), at(start));
        let chord = antiderivative(high) - antiderivative(low);
        pairs.push((chord * energy(chord_cos(line, low, high, width_um)), exact));
        normal.push((chord * phase_step_energy(depth_nm, NM), exact));
    }
    [relative_rms(&pairs), relative_rms(&normal)]
}

#[test]
fn one_depth_serves_a_chord() {
    for near_horizon in [false, true] {
        // The remaining error grows with the range of angles for which one depth is used.
        for (radius, bound) in [
            (0.005, 0.001),
            (0.02, 0.003),
            (0.07, 0.015),
            (0.2, 0.05),
            (0.6, 0.07),
        ] {
            let [one, normal] = oblique_errors(radius, near_horizon);
            println!(
                "oblique, chord of {radius} rad{}: {:.2} %, at the depth of normal incidence {:.0} %",
                if near_horizon { " at the horizon" } else { "" },
                100.0 * one,
                100.0 * normal
            );
            assert!(one < bound, "{radius}: {one}");
            assert!(normal > 0.5, "a wrong depth must show: {normal}");
        }
    }
}

/// The places of a pixel that see a scratch, one by one: the mean and the variance of xi_t over them.
#[test]
fn a_moved_band_is_that_of_the_places_which_see_the_scratch() {
    let (moves, across) = ([0.004, -0.0015], [35.0, 12.0]);
    let window2 = 0.5 * SIGMA_UM * SIGMA_UM;
    for offset in [-60.0, 0.0, 25.0] {
        let (mut total, mut mean, mut square) = (0.0, 0.0, 0.0);
        for i in 0..200 * 200 {
            let z = [i % 200, i / 200].map(|i| -5.0 + 0.05 * (f64::from(i) + 0.5));
            let off = offset - z[0] * across[0] - z[1] * across[1];
            let weight = (-0.5 * (z[0] * z[0] + z[1] * z[1] + off * off / window2)).exp();
            let xi = z[0] * moves[0] + z[1] * moves[1];
            (total, mean, square) = (
                total + weight,
                mean + weight * xi,
                square + weight * xi * xi,
            );
        }
        let mean = mean / total;
        let variance = square / total - mean * mean;
        let variance_um2 = across[0] * across[0] + across[1] * across[1] + window2;
        let stds = band_stds(SIGMA_UM);
        let band = moved_band(stds, moves, across, offset, variance_um2);
        // The sum ends at five standard deviations.
        assert!(
            (band.shift - mean).abs() < 1e-6,
            "{offset}: {band:?} {mean}"
        );
        let widened = band.stds.mean.powi(2) - stds.mean.powi(2);
        assert!(
            (widened / variance - 1.0).abs() < 1e-4,
            "{offset}: {widened} {variance}"
        );
    }
}

/// A step of the point turns the direction to a light, and a turn of the normal the scratch.
#[test]
fn directions_move_as_vectors_do() {
    let (eye, lamp) = (DVec3::new(0.2, -0.1, 0.9), DVec3::new(-0.3, 0.4, 0.5));
    let (axis, turn_t) = (DVec3::new(3e-5, -2e-5, 0.0), 4e-5);
    let tangent = DVec3::new(1.0, 0.0, -turn_t);
    let xi = |step: DVec3, t: DVec3| ((eye - step).normalize() + (lamp - step).normalize()).dot(t);
    let exact = xi(axis, tangent) - xi(DVec3::ZERO, DVec3::X);
    let (wo, wi) = (eye.normalize(), lamp.normalize());
    let turn = DVec2::new(turn_t, 0.0);
    let value = band_moves(turn, axis, wo, 1.0 / eye.length(), wi, 1.0 / lamp.length()).x;
    // First order in steps of 1e-4.
    assert!((value / exact - 1.0).abs() < 1e-3, "{value} {exact}");
}

#[test]
fn a_one_sided_polygon_is_dark_from_behind() {
    let front = [
        DVec3::new(-1.0, -1.0, 2.0),
        DVec3::new(-1.0, 1.0, 2.0),
        DVec3::new(1.0, 1.0, 2.0),
        DVec3::new(1.0, -1.0, 2.0),
    ];
    let line = BandLine::new(DVec3::Z, 0.0);
    let seen = |vertices: &[DVec3], two_sided| {
        with_view(vertices, two_sided, |view| {
            view.integral(ALONG_X, line, |q| [q])[0]
        })
    };
    let back: Vec<DVec3> = front.iter().rev().copied().collect();
    assert!(
        seen(&front, false) > 0.1,
        "counter-clockwise seen from below faces down"
    );
    assert_eq!(seen(&back, false), 0.0);
    assert!((seen(&back, true) - seen(&front, true)).abs() < 1e-12);
}

#[test]
fn no_input_yields_nan() {
    let mut random = Sequence(1);
    let awkward = [0.0, 1.0, -1.0, 1e-12, 1e-6];
    for i in 0..20_000 {
        let mut pick = || {
            if random.next() < 0.3 {
                awkward[(random.next() * 5.0) as usize]
            } else {
                random.uniform_between(-1.0, 1.0)
            }
        };
        let wo = DVec3::new(pick(), pick(), pick().abs()).normalize_or(DVec3::Z);
        let vertices: Vec<DVec3> = (0..3 + i % 4)
            .map(|_| DVec3::new(pick(), pick(), pick()))
            .collect();
        let value = polygon_integral(wo, &vertices, 2.0)
            + sphere_integral(wo, sphere_cap(vertices[0], vertices[1].x.abs()), 2.0);
        assert!(value.is_finite(), "{wo} {vertices:?}");
    }
}
