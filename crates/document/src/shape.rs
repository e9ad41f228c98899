//! The built-in shapes, z up about the origin. Each is fine enough for its outline to look round in a picture of 1280
//! pixels: a regular 256-gon of 640 pixels' radius stays within 0.05 pixels of its circle.

mod lathe;
mod profile;
mod rounded_box;
#[cfg(test)]
mod tests;
pub(crate) mod text;

use glam::{DVec2, DVec3};
use hairline_model::surface::Surface;

use crate::description::Shape;
use profile::{Profile, ROUNDING_FACETS, add_flat_disk, flat_vertex};

/// Facets around a disk or a sphere.
const FACETS: u32 = 256;

/// The surface of a shape.
pub(crate) fn surface(shape: &Shape) -> Surface {
    match shape {
        Shape::Plane { size_m } => plane(*size_m),
        Shape::Disk { radius_m } => disk(*radius_m),
        Shape::Box { size_m, rounding_m } => rounded_box::surface((*size_m).into(), *rounding_m),
        Shape::Sweep { size_m, .. } => profile(shape).swept(size_m[0]),
        Shape::Text {
            line,
            height_m,
            depth_m,
        } => text::surface(line, *height_m, *depth_m),
        Shape::Lathe { segments, .. } => profile(shape).turned(*segments),
        Shape::Sphere { .. }
        | Shape::Cylinder { .. }
        | Shape::Torus { .. }
        | Shape::Dome { .. } => profile(shape).turned(FACETS),
    }
}

impl Shape {
    /// The box around it in its own frame.
    pub fn bounds_m(&self) -> (DVec3, DVec3) {
        let points_m = surface(self).vertices.into_iter();
        let boxes = points_m.map(|vertex| (vertex.position_m, vertex.position_m));
        let around = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        around.unwrap_or_default()
    }
}

/// Largest numbers of triangles and vertices of a shape.
pub(crate) fn size(shape: &Shape) -> [f64; 2] {
    let facets = f64::from(FACETS);
    let turned = |pieces: usize, around: f64| {
        let pieces = pieces as f64;
        [2.0 * pieces * around, 2.0 * pieces * (around + 1.0)]
    };
    match shape {
        Shape::Plane { .. } => [2.0, 4.0],
        Shape::Disk { .. } => [facets, facets],
        Shape::Box { rounding_m, .. } => rounded_box::size(*rounding_m),
        Shape::Text { line, .. } => text::size(line),
        Shape::Lathe {
            profile_m,
            segments,
            ..
        } => turned(profile_m.len().saturating_sub(1), f64::from(*segments)),
        Shape::Sweep { .. } => turned(profile(shape).pieces.len(), 1.0),
        Shape::Sphere { .. }
        | Shape::Cylinder { .. }
        | Shape::Torus { .. }
        | Shape::Dome { .. } => turned(profile(shape).pieces.len(), facets),
    }
}

/// Profile that is turned about z, or drawn along x. Empty for shapes that are made otherwise.
fn profile(shape: &Shape) -> Profile {
    let at = DVec2::new;
    match shape {
        Shape::Plane { .. } | Shape::Disk { .. } | Shape::Box { .. } | Shape::Text { .. } => {
            Profile::default()
        }
        Shape::Sphere { radius_m } => {
            Profile::default().arc(DVec2::ZERO, *radius_m, [0.0, 2.0], FACETS / 4)
        }
        Shape::Cylinder {
            radius_m,
            height_m,
            rounding_m,
        } => {
            // The ends of the straight parts, and the extents, with one rounding where pieces meet.
            let (r, z) = (radius_m - rounding_m, 0.5 * height_m - rounding_m);
            let (wall, end) = (r + rounding_m, z + rounding_m);
            Profile::default()
                .line(at(0.0, end), at(r, end))
                .arc(at(r, z), *rounding_m, [0.0, 1.0], ROUNDING_FACETS)
                .line(at(wall, z), at(wall, -z))
                .arc(at(r, -z), *rounding_m, [1.0, 2.0], ROUNDING_FACETS)
                .line(at(r, -end), at(0.0, -end))
        }
        Shape::Torus {
            radius_m,
            tube_radius_m,
        } => Profile::default().arc(at(*radius_m, 0.0), *tube_radius_m, [-1.0, 3.0], FACETS / 8),
        Shape::Dome { radius_m, height_m } => {
            let sphere_m = 0.5 * (radius_m * radius_m / height_m + height_m);
            let quarters = 2.0 * libm::atan2(*height_m, *radius_m) / std::f64::consts::FRAC_PI_2;
            Profile::default().arc(
                at(0.0, height_m - sphere_m),
                sphere_m,
                [0.0, quarters],
                FACETS / 4,
            )
        }
        Shape::Sweep {
            size_m: [_, y_m],
            height_m,
            rounding_m,
        } => {
            let turn = 0.5 * y_m - rounding_m;
            let wall = turn + rounding_m;
            Profile::default()
                .line(at(-0.5 * y_m, 0.0), at(turn, 0.0))
                .arc(
                    at(turn, *rounding_m),
                    *rounding_m,
                    [2.0, 1.0],
                    ROUNDING_FACETS,
                )
                .line(at(wall, *rounding_m), at(wall, *height_m))
        }
        Shape::Lathe {
            profile_m, smooth, ..
        } => lathe::profile(profile_m, *smooth),
    }
}

/// A capsule: all points within a radius of a line along z about the origin.
pub(crate) fn capsule(half_length_m: f64, radius_m: f64, facets: u32) -> Surface {
    let end = DVec2::new(0.0, half_length_m);
    let side = DVec2::new(radius_m, half_length_m);
    Profile::default()
        .arc(end, radius_m, [0.0, 1.0], facets / 4)
        .line(side, DVec2::new(radius_m, -half_length_m))
        .arc(-end, radius_m, [1.0, 2.0], facets / 4)
        .turned(facets)
}

fn plane([x_m, y_m]: [f64; 2]) -> Surface {
    let corner = |x: f64, y: f64| flat_vertex(DVec2::new(x * x_m, y * y_m).extend(0.0), 1.0, x, y);
    Surface {
        vertices: vec![
            corner(-0.5, -0.5),
            corner(0.5, -0.5),
            corner(0.5, 0.5),
            corner(-0.5, 0.5),
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

fn disk(radius_m: f64) -> Surface {
    let mut surface = Surface::default();
    add_flat_disk(&mut surface, radius_m, 0.0, FACETS, 1.0);
    surface
}
