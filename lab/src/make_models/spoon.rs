//! A dessert spoon as a closed surface: a sheet with an outline, a height and a thickness, all functions of the place along
//! it. Millimetres; x from the tip of the bowl to the end of the handle, y across, z up; the bowl opens upwards.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::spline::{Spline, smooth_step};

/// Length from the tip of the bowl to the end of the handle.
pub const LENGTH_MM: f64 = 179.0;
/// Place where the bowl's mesh ends and the handle's begins.
pub const JOINT_MM: f64 = 72.0;
/// Height of the tip's frame, and turn about y, at which the spoon rests on its back, on the bowl and the end of the handle.
pub const ON_BACK_MM: f64 = 11.04;
/// See [`ON_BACK_MM`].
pub const ON_BACK_RAD: f64 = 0.0106;
/// Turned over about x, it rests on the rim near the tip and the arch of the handle.
pub const ON_FACE_MM: f64 = 0.83;
/// See [`ON_FACE_MM`].
pub const ON_FACE_RAD: f64 = -0.0753;

/// Vertices around the section, and along the bowl and the handle.
const AROUND: usize = 48;
const ALONG_BOWL: usize = 76;
const ALONG_HANDLE: usize = 76;
/// Largest |y| in the handle's texture: one half of the texture shows the upper face, the other half the lower one.
pub const TEXTURE_HALF_WIDTH_MM: f64 = 10.0;
/// Step of the differences that stand for derivatives, mm and radians.
const DIFFERENCE: f64 = 1e-5;

/// Vertices and triangles of one primitive.
#[derive(Default)]
pub struct MeshPart {
    /// Positions in the part's own frame, mm.
    pub positions_mm: Vec<DVec3>,
    /// Unit.
    pub normals: Vec<DVec3>,
    /// Unit, along growing u. No face is mirrored in the texture, so the bitangent's sign is 1.
    pub tangents: Vec<DVec3>,
    /// (0, 0) is the upper left corner.
    pub uvs: Vec<DVec2>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// The curves that make the spoon.
pub struct Spoon {
    half_width_squared: Spline,
    rim: Spline,
    half_thickness: Spline,
}

impl Spoon {
    /// The spoon.
    pub fn new() -> Self {
        // The square of a half width goes to zero linearly, so the ends are round.
        let outline = [
            [0.0, 0.0],
            [9.0, 13.6],
            [28.0, 20.6],
            [44.0, 17.8],
            [55.0, 11.6],
            [64.0, 5.5],
            [72.0, 3.4],
            [84.0, 2.9],
            [108.0, 3.5],
            [135.0, 5.2],
            [158.0, 7.8],
            [170.0, 7.9],
            [LENGTH_MM, 0.0],
        ];
        Self {
            half_width_squared: Spline::new(&outline.map(|[x, w]| [x, w * w])),
            rim: Spline::new(&[
                [0.0, 0.6],
                [28.0, 0.0],
                [56.0, 1.4],
                [76.0, 4.6],
                [100.0, 4.8],
                [135.0, -0.6],
                [162.0, -6.4],
                [LENGTH_MM, -8.4],
            ]),
            half_thickness: Spline::new(&[
                [0.0, 0.75],
                [30.0, 0.8],
                [56.0, 1.2],
                [74.0, 1.8],
                [100.0, 1.7],
                [140.0, 1.3],
                [LENGTH_MM, 1.15],
            ]),
        }
    }

    /// The bowl with its tip, in the spoon's frame.
    pub fn bowl(&self) -> MeshPart {
        // Stations crowd where the tip closes.
        self.part(ALONG_BOWL, 0.0, |t| {
            JOINT_MM * (1.0 - libm::cos(t * PI / 2.0))
        })
    }

    /// The handle with its end, in a frame that starts at the joint.
    pub fn handle(&self) -> MeshPart {
        let length = LENGTH_MM - JOINT_MM;
        self.part(ALONG_HANDLE, JOINT_MM, |t| {
            JOINT_MM + length * libm::sin(t * PI / 2.0)
        })
    }

    /// Half the width at a place along.
    pub fn half_width_mm(&self, x: f64) -> f64 {
        self.half_width_squared.evaluate(x).max(0.0).sqrt()
    }

    /// The middle of the sheet. `v` runs from -1 to 1 across.
    fn sheet(&self, x: f64, v: f64) -> DVec3 {
        let w2 = self.half_width_squared.evaluate(x).max(0.0);
        // A paraboloid under a flat rim, fading into the handle, whose upper face bulges a little.
        let hollow =
            0.0232 * (1.0 - smooth_step(46.0, 86.0, x)) - 0.008 * smooth_step(70.0, 110.0, x);
        let z = self.rim.evaluate(x) - hollow * w2 * (1.0 - v * v);
        DVec3::new(x, w2.sqrt() * v, z)
    }

    /// A point of the surface, `angle` around the section: 0 and pi are the edges, pi/2 is above.
    fn point(&self, x: f64, angle: f64) -> DVec3 {
        // A superellipse by its polar angle: round edges, and level between them.
        let exponent = 4.0 - 1.4 * smooth_step(60.0, 80.0, x);
        // More of the angle goes to the faces than to the edges.
        let angle = angle + 0.25 * libm::sin(2.0 * angle);
        let (sin, cos) = libm::sincos(angle);
        let size = libm::pow(
            libm::pow(cos.abs(), exponent) + libm::pow(sin.abs(), exponent),
            -1.0 / exponent,
        );
        let (across, above) = (size * cos, size * sin);

        let to_end = x.min(LENGTH_MM - x);
        const ROUNDING_MM: f64 = 3.0;
        let rounded = (1.0 - to_end / ROUNDING_MM).max(0.0);
        let half_thickness = self.half_thickness.evaluate(x) * (1.0 - rounded * rounded).sqrt();

        let along_x = self.sheet(x + DIFFERENCE, across) - self.sheet(x - DIFFERENCE, across);
        let along_v = self.sheet(x, across + DIFFERENCE) - self.sheet(x, across - DIFFERENCE);
        let up = along_x.cross(along_v).normalize_or(DVec3::Z);
        // Straight up near the ends, where the outline closes and its slope has no bound.
        let up = DVec3::Z
            .lerp(up, smooth_step(0.0, ROUNDING_MM, to_end))
            .normalize();
        self.sheet(x, across) + up * (half_thickness * above)
    }

    fn normal(&self, x: f64, angle: f64) -> DVec3 {
        let x = x.clamp(0.02, LENGTH_MM - 0.02);
        let along = self.point(x + DIFFERENCE, angle) - self.point(x - DIFFERENCE, angle);
        let around = self.point(x, angle + DIFFERENCE) - self.point(x, angle - DIFFERENCE);
        around.cross(along).normalize()
    }

    /// Rings of vertices at the places that `x_at` gives for 0 to 1, and a pole where the section closes. The upper and
    /// the lower face are two sheets of texture, so the vertices of the edges are there twice.
    fn part(&self, stations: usize, origin_x: f64, x_at: impl Fn(f64) -> f64) -> MeshPart {
        let mut part = MeshPart::default();
        let row = AROUND / 2 + 1;
        for face in 0..2 {
            for i in 0..=stations {
                let x = x_at(i as f64 / stations as f64);
                for j in 0..row {
                    let angle = face as f64 * PI + j as f64 / (row - 1) as f64 * PI;
                    self.vertex(&mut part, x, angle, face == 0, origin_x);
                }
            }
        }
        for face in 0..2 {
            let first = face * (stations + 1) * row;
            for i in 0..stations {
                for j in 0..row - 1 {
                    let a = (first + i * row + j) as u32;
                    let (b, c, d) = (a + row as u32, a + 1, a + row as u32 + 1);
                    let is_closed = |k: usize| is_pole(x_at(k as f64 / stations as f64));
                    if !is_closed(i) {
                        part.triangles.push([a, c, b]);
                    }
                    if !is_closed(i + 1) {
                        part.triangles.push([c, d, b]);
                    }
                }
            }
        }
        part.weld_pole(row, stations, is_pole(x_at(0.0)));
        part
    }

    fn vertex(&self, part: &mut MeshPart, x: f64, angle: f64, is_upper: bool, origin_x: f64) {
        let position = self.point(x, angle.rem_euclid(TAU));
        let normal = match is_pole(x) {
            false => self.normal(x, angle),
            true => DVec3::X * if x < 1.0 { -1.0 } else { 1.0 },
        };
        // u runs along the spoon; v runs down the picture, which shows each face as one sees it.
        let length = LENGTH_MM - JOINT_MM;
        let u = if origin_x > 0.0 {
            (x - JOINT_MM) / length
        } else {
            x / JOINT_MM
        };
        let across = 0.25 * position.y / TEXTURE_HALF_WIDTH_MM;
        let v = if is_upper {
            0.25 - across
        } else {
            0.75 + across
        };
        let tangent = (DVec3::X - normal * normal.x).normalize_or(DVec3::Z);
        part.positions_mm.push(position - DVec3::X * origin_x);
        part.normals.push(normal);
        part.tangents.push(tangent);
        part.uvs.push(DVec2::new(u, v));
    }
}

/// Whether the section has closed to a point.
fn is_pole(x: f64) -> bool {
    !(1e-9..=LENGTH_MM - 1e-9).contains(&x)
}

impl MeshPart {
    /// A pole has as many vertices as a ring, for the texture, but one position, so that rounding opens no slit.
    fn weld_pole(&mut self, row: usize, stations: usize, at_start: bool) {
        let ring = if at_start { 0 } else { stations };
        let pole = self.positions_mm[ring * row];
        for face in 0..2 {
            let first = (face * (stations + 1) + ring) * row;
            self.positions_mm[first..first + row].fill(pole);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// Positions as a glTF file keeps them, bit by bit.
    fn key(p: DVec3) -> [u32; 3] {
        (p + 0.0).as_vec3().to_array().map(f32::to_bits)
    }

    #[test]
    fn the_surface_is_closed_but_for_the_joint_and_faces_outwards() {
        let spoon = Spoon::new();
        for (part, open_edges) in [(spoon.bowl(), AROUND), (spoon.handle(), AROUND)] {
            let mut edges: HashMap<_, i32> = HashMap::new();
            for &[a, b, c] in &part.triangles {
                let [pa, pb, pc] = [a, b, c].map(|i| part.positions_mm[i as usize]);
                let area = (pb - pa).cross(pc - pa);
                assert!(area.length() > 0.0, "a triangle without area at {pa}");
                assert!(
                    area.dot(part.normals[a as usize]) > 0.0,
                    "turned inwards at {pa}"
                );
                for (from, to) in [(pa, pb), (pb, pc), (pc, pa)] {
                    *edges.entry((key(from), key(to))).or_default() += 1;
                    *edges.entry((key(to), key(from))).or_default() -= 1;
                }
            }
            let open = edges.values().filter(|&&n| n > 0).count();
            assert_eq!(open, open_edges);
        }
    }

    #[test]
    fn bowl_and_handle_meet_without_a_kink() {
        let (bowl, handle) = (Spoon::new().bowl(), Spoon::new().handle());
        let row = AROUND / 2 + 1;
        for face in 0..2 {
            for j in 0..row {
                let b = (face * (ALONG_BOWL + 1) + ALONG_BOWL) * row + j;
                let h = face * (ALONG_HANDLE + 1) * row + j;
                let gap = handle.positions_mm[h] + DVec3::X * JOINT_MM - bowl.positions_mm[b];
                assert!(gap.length() < 1e-9, "a gap of {gap}");
                // Normals come from differences over 1e-5 mm.
                assert!(bowl.normals[b].dot(handle.normals[h]) > 1.0 - 1e-6);
            }
        }
    }
}
