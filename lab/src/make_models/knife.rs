//! A cook's knife on its side: a blade with a bevel at its edge, a bolster, a handle with three rivets. Millimetres; x from the end of the handle
//! to the tip, y from the edge to the spine, z across the blade; the heel of the blade is at x = 0.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::spline::smooth_step;
use super::spoon::MeshPart;

/// Length of the blade, from its heel.
const BLADE_MM: f64 = 196.0;
/// Place where the handle ends and the bolster begins.
const BOLSTER_MM: f64 = -16.0;
/// Place where the handle begins.
const END_MM: f64 = -132.0;
/// Width of the bevel, where the blade is wide enough.
const BEVEL_MM: f64 = 2.4;
/// Half of the blade where the bevel begins.
const BEVEL_HALF_MM: f64 = 0.3;
const RIVET_MM: f64 = 3.4;
const RIVETS_AT_MM: [f64; 3] = [-112.0, -74.0, -36.0];
/// Step of the differences that stand for derivatives, in lengths of a face.
const DIFFERENCE: f64 = 1e-6;

/// The blade's two sides and its back.
pub fn blade() -> MeshPart {
    let mut part = MeshPart::default();
    for side in [1.0, -1.0] {
        // u along, v from the spine to the bevel.
        add_face(&mut part, [120, 8], side > 0.0, |u, v| {
            let x = place_along_blade(u);
            let y = spine(x) + v * (edge(x) + bevel(x) - spine(x));
            let half = half_back(x) + v * (half_at_bevel(x) - half_back(x));
            DVec3::new(x, y, side * half)
        });
    }
    add_face(&mut part, [120, 1], false, |u, v| {
        let x = place_along_blade(u);
        DVec3::new(x, spine(x), half_back(x) * (1.0 - 2.0 * v))
    });
    part
}

/// The ground edge.
pub fn edge_bevel() -> MeshPart {
    let mut part = MeshPart::default();
    for side in [1.0, -1.0] {
        add_face(&mut part, [120, 2], side > 0.0, |u, v| {
            let x = place_along_blade(u);
            let y = edge(x) + (1.0 - v) * bevel(x);
            DVec3::new(x, y, side * half_at_bevel(x) * (1.0 - v))
        });
    }
    part
}

/// The bolster, from the handle to the heel of the blade.
pub fn bolster() -> MeshPart {
    let mut part = MeshPart::default();
    add_face(&mut part, [24, 64], true, |u, v| {
        let x = BOLSTER_MM * (1.0 - u);
        let t = smooth_step(BOLSTER_MM, 0.0, x);
        let handle = section(BOLSTER_MM);
        let heel = [
            0.5 * (spine(0.0) + edge(0.0)),
            0.5 * (spine(0.0) - edge(0.0)),
            half_back(0.0),
        ];
        let [middle, across, half] = [0, 1, 2].map(|i| handle[i] + t * (heel[i] - handle[i]));
        section_point(x, [middle, across, half], v)
    });
    part
}

/// The handle, round at its end.
pub fn handle() -> MeshPart {
    let mut part = MeshPart::default();
    add_face(&mut part, [72, 64], true, |u, v| {
        // More stations where it closes.
        let x = END_MM + (BOLSTER_MM - END_MM) * (1.0 - libm::cos(u * PI / 2.0));
        section_point(x, section(x), v)
    });
    part
}

/// The heads of the rivets on both sides of the handle.
pub fn rivets() -> MeshPart {
    let mut part = MeshPart::default();
    for x in RIVETS_AT_MM {
        let [middle, _, half] = section(x);
        for side in [1.0, -1.0] {
            add_face(&mut part, [10, 48], side > 0.0, |u, v| {
                let r = (1.0 - u).max(1e-3);
                let (sin, cos) = libm::sincos(v * TAU);
                let above = 0.35 * (1.0 - r * r);
                DVec3::new(
                    x + RIVET_MM * r * cos,
                    middle + RIVET_MM * r * sin,
                    side * (half - 0.02 + above),
                )
            });
        }
    }
    part
}

/// Place along the blade, from heel to tip, which is left a hundredth of a millimetre blunt.
fn place_along_blade(u: f64) -> f64 {
    BLADE_MM * (1.0 - libm::pow(1.0 - u, 1.5)) * (1.0 - 1e-4)
}

fn spine(x: f64) -> f64 {
    19.0 - 15.0 * libm::pow(x / BLADE_MM, 3.0)
}

fn edge(x: f64) -> f64 {
    -25.0 + 29.0 * libm::pow(x / BLADE_MM, 3.4)
}

fn bevel(x: f64) -> f64 {
    BEVEL_MM.min(0.3 * (spine(x) - edge(x)))
}

/// Half of the blade's back, which is thinner to the tip.
fn half_back(x: f64) -> f64 {
    1.25 - 0.85 * x / BLADE_MM
}

fn half_at_bevel(x: f64) -> f64 {
    BEVEL_HALF_MM * bevel(x) / BEVEL_MM
}

/// Section of the handle: its middle along y, and its half sizes across and along z.
fn section(x: f64) -> [f64; 3] {
    let t = (x - END_MM) / (BOLSTER_MM - END_MM);
    let swell = libm::sin(PI * t);
    let [middle, across, half] = [
        4.5 + 2.5 * t - 1.5 * swell,
        14.5 - 2.5 * t - 1.8 * swell,
        9.5 + 0.6 * swell,
    ];
    const ROUNDING_MM: f64 = 9.0;
    let open = (1.0 - (x - END_MM) / ROUNDING_MM).max(0.0);
    let round = (1.0 - open * open).max(0.0).sqrt();
    [middle, across * round, half * round]
}

/// A point of a section, a superellipse, by the share of the way around.
fn section_point(x: f64, [middle, across, half]: [f64; 3], v: f64) -> DVec3 {
    const EXPONENT: f64 = 3.2;
    let (sin, cos) = libm::sincos(v * TAU);
    let size = libm::pow(
        libm::pow(cos.abs(), EXPONENT) + libm::pow(sin.abs(), EXPONENT),
        -1.0 / EXPONENT,
    );
    DVec3::new(x, middle + across * size * cos, half * size * sin)
}

/// A face of so many cells, whose outside is where u turns to v, or the other side.
fn add_face(
    part: &mut MeshPart,
    [cells_u, cells_v]: [usize; 2],
    is_turned: bool,
    point: impl Fn(f64, f64) -> DVec3,
) {
    let first = part.positions_mm.len() as u32;
    let sign = if is_turned { -1.0 } else { 1.0 };
    for i in 0..=cells_u {
        for j in 0..=cells_v {
            let (u, v) = (i as f64 / cells_u as f64, j as f64 / cells_v as f64);
            // Where a face closes to a point, its normal is that of the neighbourhood.
            let at = (u.clamp(2e-3, 1.0 - 2e-3), v);
            let along = point(at.0 + DIFFERENCE, at.1) - point(at.0 - DIFFERENCE, at.1);
            let across = point(at.0, at.1 + DIFFERENCE) - point(at.0, at.1 - DIFFERENCE);
            let normal = sign * along.cross(across).normalize_or(DVec3::Z);
            part.positions_mm.push(point(u, v));
            part.normals.push(normal);
            part.tangents
                .push((DVec3::X - normal * normal.x).normalize_or(DVec3::Y));
            part.uvs.push(DVec2::new(u, v));
        }
    }
    let row = cells_v as u32 + 1;
    for i in 0..cells_u as u32 {
        for j in 0..cells_v as u32 {
            let a = first + i * row + j;
            let (b, c, d) = (a + row, a + 1, a + row + 1);
            for [p, q, r] in [[a, b, c], [c, b, d]] {
                let corners = if is_turned { [p, r, q] } else { [p, q, r] };
                part.triangles.push(corners);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_look_outwards() {
        let middle = |x: f64| match x < 0.0 {
            true => section(x.max(END_MM))[0],
            false => 0.5 * (spine(x) + edge(x)),
        };
        for part in [blade(), edge_bevel(), bolster(), handle(), rivets()] {
            for triangle in &part.triangles {
                let [a, b, c] = triangle.map(|i| part.positions_mm[i as usize]);
                let area = (b - a).cross(c - a);
                if area.length() < 1e-9 {
                    continue;
                }
                let normal = part.normals[triangle[0] as usize];
                assert!(area.dot(normal) > 0.0, "turned inwards at {a}");
                let center = (a + b + c) / 3.0;
                // At its tip the blade is thicker than high, and its sides slope as steeply as its back.
                if center.x > 0.97 * BLADE_MM {
                    continue;
                }
                let out = DVec3::new(0.0, center.y - middle(center.x), center.z);
                // The ends of the handle and of the heads look along x.
                assert!(out.dot(area.normalize()) > -1e-2, "inside out at {a}");
            }
        }
    }

    #[test]
    fn the_bolster_fits_the_heel() {
        let bolster = bolster();
        let at_heel = bolster.positions_mm.iter().filter(|p| p.x.abs() < 1e-9);
        let (low, high) = at_heel.fold((f64::MAX, f64::MIN), |(low, high), p| {
            (low.min(p.y), high.max(p.y))
        });
        assert!((low - edge(0.0)).abs() < 1e-9 && (high - spine(0.0)).abs() < 1e-9);
    }
}
