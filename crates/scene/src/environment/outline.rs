//! The outlines of windows, on the sphere of directions.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::light::Light;

/// A part of the sky of even radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Outline in the map's frame.
    pub outline: Outline,
    /// Radiance beyond what is left in the map, in texel units.
    pub radiance: [f64; 3],
    /// Radiance of the map around it.
    pub around: [f64; 3],
    /// Angle over which the map falls where the outline ends: lenses blur it, and some lamps fade
    /// out.
    pub edge_rad: f64,
}

/// A disc, or four corners.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// Directions within a radius of one.
    Disc {
        /// Unit vector.
        direction: DVec3,
        /// Angular radius of the disc.
        radius_rad: f64,
    },
    /// Convex; within a hemisphere.
    Quad {
        /// Unit vectors, counter-clockwise as seen from outside of the sphere.
        corners: [DVec3; 4],
    },
}

impl Outline {
    /// Returns a function of a direction: the share, within the outline, of a texel of this angle
    /// about it. A wider angle makes a soft edge.
    pub fn measure(&self, texel_rad: f64) -> impl Fn(DVec3) -> f64 + Sync + use<> {
        let step = move |inside_rad: f64| (0.5 + inside_rad / texel_rad).clamp(0.0, 1.0);
        let rim = self.rim();
        move |toward: DVec3| match &rim {
            Rim::Circle { .. } => step(rim.inside_rad(toward)),
            Rim::Edges(edges) => edges.iter().map(|edge| step(edge.dot(toward))).product(),
        }
    }

    /// Returns the angle of a direction from the nearest edge, positive within the outline.
    pub fn inside_rad(&self) -> impl Fn(DVec3) -> f64 + Sync + use<> {
        let rim = self.rim();
        move |toward: DVec3| rim.inside_rad(toward)
    }

    fn rim(&self) -> Rim {
        match self {
            Self::Disc {
                direction,
                radius_rad,
            } => Rim::Circle {
                direction: *direction,
                radius_rad: *radius_rad,
            },
            Self::Quad { corners } => Rim::Edges(edges(corners)),
        }
    }

    /// Solid angle of the outline.
    pub fn solid_angle_sr(&self) -> f64 {
        match self {
            Self::Disc { radius_rad, .. } => TAU * (1.0 - radius_rad.cos()),
            Self::Quad { corners } => {
                let [a, b, c, d] = *corners;
                triangle_sr(a, b, c) + triangle_sr(a, c, d)
            }
        }
    }

    /// Direction of the outline's middle.
    pub fn middle(&self) -> DVec3 {
        match self {
            Self::Disc { direction, .. } => *direction,
            Self::Quad { corners } => corners.iter().sum::<DVec3>().normalize(),
        }
    }

    /// Makes a light of the outline, so far away that its direction is the same over the whole
    /// scene.
    pub fn light(&self, distance_m: f64, radiance: [f64; 3]) -> Light {
        match self {
            Self::Disc {
                direction,
                radius_rad,
            } => Light::sphere(
                *direction * distance_m,
                distance_m * radius_rad.sin(),
                radiance,
            ),
            Self::Quad { corners } => {
                let middle = self.middle();
                let in_plane = |corner: &DVec3| *corner * (distance_m / corner.dot(middle));
                // The scene sees the other side of the sphere.
                let vertices_m = corners.iter().rev().map(in_plane).collect();
                Light::polygon(vertices_m, radiance, false)
            }
        }
    }

    /// Turns the outline.
    pub fn turned(&self, turn: impl Fn(DVec3) -> DVec3) -> Self {
        match self {
            Self::Disc {
                direction,
                radius_rad,
            } => Self::Disc {
                direction: turn(*direction),
                radius_rad: *radius_rad,
            },
            Self::Quad { corners } => Self::Quad {
                corners: corners.map(turn),
            },
        }
    }
}

/// Border of an outline.
enum Rim {
    Circle {
        direction: DVec3,
        radius_rad: f64,
    },
    /// See [`edges`].
    Edges([DVec3; 4]),
}

impl Rim {
    /// Returns the angle of a direction from the nearest edge, positive within the outline.
    fn inside_rad(&self, toward: DVec3) -> f64 {
        match self {
            Self::Circle {
                direction,
                radius_rad,
            } => radius_rad - direction.angle_between(toward),
            Self::Edges(edges) => {
                let inside = edges.iter().map(|edge| edge.dot(toward));
                inside.fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// Unit normals of the planes of the edges, to the side that is within.
fn edges(corners: &[DVec3; 4]) -> [DVec3; 4] {
    std::array::from_fn(|i| {
        let next = corners[(i + 1) % 4];
        corners[i].cross(next).normalize_or_zero()
    })
}

/// A. van Oosterom and J. Strackee, *The Solid Angle of a Plane Triangle*, 1983.
fn triangle_sr(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    2.0 * a
        .dot(b.cross(c))
        .abs()
        .atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
