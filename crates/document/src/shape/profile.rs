//! Outlines in the half plane of r, to the right, and z, up, and the surfaces that they make when they are turned about z or
//! drawn along a line. They face to the left of their way.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec2};

use hairline_model::surface::{Surface, Vertex};

/// Facets of a quarter of a rounded edge, which is small beside its shape.
pub(super) const ROUNDING_FACETS: u32 = 16;

/// An end of a straight piece of a profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfileEnd {
    pub point_m: DVec2,
    pub normal: DVec2,
}

/// Straight pieces, in the order of their way.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile {
    pub pieces: Vec<[ProfileEnd; 2]>,
}

impl Profile {
    /// Adds a straight line, unless it has no length.
    pub(super) fn line(mut self, from_m: DVec2, to_m: DVec2) -> Self {
        if let Some(direction) = (to_m - from_m).try_normalize() {
            self.pieces.push([from_m, to_m].map(|point_m| ProfileEnd {
                point_m,
                normal: direction.perp(),
            }));
        }
        self
    }

    /// Adds a part of a circle, unless its radius is 0. It starts and ends at angles to z, towards r, in quarter turns; where they
    /// grow it faces away from the centre, where they fall towards it.
    pub(super) fn arc(
        mut self,
        center_m: DVec2,
        radius_m: f64,
        [from, to]: [f64; 2],
        pieces_a_quarter: u32,
    ) -> Self {
        if radius_m == 0.0 {
            return self;
        }
        let facing = (to - from).signum();
        let count = ((to - from).abs() * f64::from(pieces_a_quarter)).ceil();
        let end = |i: f64| {
            let direction = direction(from + (to - from) * (i / count));
            ProfileEnd {
                point_m: center_m + radius_m * direction,
                normal: facing * direction,
            }
        };
        let pieces = (0..count as u32).map(f64::from);
        self.pieces.extend(pieces.map(|i| [end(i), end(i + 1.0)]));
        self
    }

    /// Each piece with the shares of the whole length at its ends.
    fn with_shares(&self) -> impl Iterator<Item = ([ProfileEnd; 2], [f64; 2])> {
        let length = |[a, b]: &[ProfileEnd; 2]| a.point_m.distance(b.point_m);
        let total: f64 = self.pieces.iter().map(length).sum();
        self.pieces.iter().scan(0.0, move |along_m, piece| {
            let from_m = *along_m;
            *along_m += length(piece);
            Some((*piece, [from_m / total, *along_m / total]))
        })
    }

    /// Turned about z. u runs around, v along the profile; flat ends have a texture of their own.
    pub(super) fn turned(&self, segments: u32) -> Surface {
        let mut surface = Surface::default();
        for (ends, v) in self.with_shares() {
            let [from, to] = ends.map(|end| end.point_m);
            match is_floor(from, to) {
                true => {
                    let facing = ends[0].normal.y.signum();
                    add_flat_disk(&mut surface, from.x.max(to.x), from.y, segments, facing);
                }
                false => add_turned_piece(&mut surface, ends, v, segments),
            }
        }
        surface
    }

    /// Drawn along x, about the origin, with r along y. The texture stands upright as seen from -y.
    pub(super) fn swept(&self, width_m: f64) -> Surface {
        let mut surface = Surface::default();
        for (ends, share) in self.with_shares() {
            let first = surface.vertices.len() as u32;
            for (end, share) in ends.into_iter().zip(share) {
                for x in [-0.5, 0.5] {
                    surface.vertices.push(Vertex {
                        position_m: DVec3::new(x * width_m, end.point_m.x, end.point_m.y),
                        normal: DVec3::new(0.0, end.normal.x, end.normal.y),
                        tangent: DVec3::X,
                        uv: Vec2::new((0.5 + x) as f32, (1.0 - share) as f32),
                        ..Vertex::default()
                    });
                }
            }
            let [a, b, c, d] = [0, 1, 3, 2].map(|corner| first + corner);
            surface.triangles.extend([[a, b, c], [a, c, d]]);
        }
        surface
    }
}

/// Direction at an angle to z, towards r, in quarter turns; exact for whole ones.
fn direction(quarters: f64) -> DVec2 {
    if quarters == quarters.round() {
        return match quarters.rem_euclid(4.0) as u8 {
            0 => DVec2::Y,
            1 => DVec2::X,
            2 => DVec2::NEG_Y,
            _ => DVec2::NEG_X,
        };
    }
    let (sin, cos) = libm::sincos(0.5 * PI * quarters);
    DVec2::new(sin, cos)
}

/// Whether a piece makes a flat disk about the axis.
pub(super) fn is_floor(from_m: DVec2, to_m: DVec2) -> bool {
    from_m.y == to_m.y && from_m.x.min(to_m.x) == 0.0
}

/// A vertex that looks up (`facing` 1) or down (-1); x and y, from -0.5 to 0.5, are its place in the texture.
pub(super) fn flat_vertex(position_m: DVec3, facing: f64, x: f64, y: f64) -> Vertex {
    Vertex {
        position_m,
        normal: DVec3::Z * facing,
        tangent: DVec3::X,
        handedness: facing,
        uv: Vec2::new((0.5 + x) as f32, (0.5 - y) as f32),
        ..Vertex::default()
    }
}

/// A profile or an outline is rounded where it bends by less: 40 degrees.
pub(super) const ROUNDED_BEND_COS: f64 = 0.766_044_443_118_978;

/// A disk from a ring of vertices alone: cutting off every second vertex, again and again, leaves large triangles inside. A
/// fan around the centre would cut every scratch into a piece per facet.
pub(super) fn add_flat_disk(
    surface: &mut Surface,
    radius_m: f64,
    z_m: f64,
    facets: u32,
    facing: f64,
) {
    let first = surface.vertices.len() as u32;
    for i in 0..facets {
        let (sin, cos) = libm::sincos(2.0 * PI * f64::from(i) / f64::from(facets));
        let position = DVec3::new(radius_m * cos, radius_m * sin, z_m);
        surface
            .vertices
            .push(flat_vertex(position, facing, cos / 2.0, sin / 2.0));
    }
    let mut ring: Vec<u32> = (first..first + facets).collect();
    while ring.len() > 2 {
        let n = ring.len();
        for i in (1..n).step_by(2) {
            let (a, b, c) = (ring[i - 1], ring[i], ring[(i + 1) % n]);
            if a != c {
                let ear = if facing > 0.0 { [a, b, c] } else { [a, c, b] };
                surface.triangles.push(ear);
            }
        }
        ring = ring.into_iter().step_by(2).collect();
    }
}

fn add_turned_piece(surface: &mut Surface, ends: [ProfileEnd; 2], v: [f64; 2], segments: u32) {
    let first = surface.vertices.len() as u32;
    for i in 0..=segments {
        let turn = f64::from(i) / f64::from(segments);
        // The last column repeats the first one's place bit for bit.
        let (sin, cos) = libm::sincos(2.0 * PI * f64::from(i % segments) / f64::from(segments));
        for (end, v) in ends.into_iter().zip(v) {
            let turned = |p: DVec2| DVec3::new(p.x * cos, p.x * sin, p.y);
            surface.vertices.push(Vertex {
                position_m: turned(end.point_m),
                normal: turned(end.normal),
                tangent: DVec3::new(-sin, cos, 0.0),
                uv: Vec2::new(turn as f32, v as f32),
                ..Vertex::default()
            });
        }
    }
    for i in 0..segments {
        let [a, b, c, d] = [0, 1, 3, 2].map(|corner| first + 2 * i + corner);
        // On the axis one side of the quadrangle has no length.
        if ends[1].point_m.x > 0.0 {
            surface.triangles.push([a, b, c]);
        }
        if ends[0].point_m.x > 0.0 {
            surface.triangles.push([a, c, d]);
        }
    }
}
