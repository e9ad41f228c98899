//! A layer whose scratches are scattered over the whole surface at random, along a pattern.

use std::f64::consts::TAU;

use hairline_laying::{Facet, Groove, Ground, Guide, Lattice, Laying, MeshPoint, Stream, Walker};
use hairline_scene::{Bearing, Segment};

use super::sizes::scratch_profile;
use crate::description::{Laid, Pattern, PatternAxis};

/// A layer's description with the ground that it goes on.
pub(super) struct Scattered<'a> {
    pub laid: &'a Laid,
    /// Number that distinguishes layers of one seed.
    pub number: u64,
    pub ground: &'a Ground,
}

impl Laying for Scattered<'_> {
    fn lay(&self, walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove {
        let laid = self.laid;
        let mut stream = self.stream(index);
        // Everything is drawn for every pattern, in this order: a layer that changes its pattern keeps its places and sizes.
        let seed = self.ground.random_spot(&mut stream);
        let seed_angle_rad = TAU * stream.uniform();
        let [length, width, depth, curvature, jitter] = std::array::from_fn(|_| stream.normal());

        let length_m = self
            .ground
            .fitting_length_m(laid.length_m.log_normal_at(length));
        let guide = self.guide(seed, seed_angle_rad, curvature, jitter);
        Groove {
            profile: scratch_profile([laid.width_um, laid.depth_nm], [width, depth], [1.0; 2]),
            course: walker.lay(seed, &guide, length_m, segments),
        }
    }

    fn middle(&self, index: u64) -> Option<MeshPoint> {
        Some(self.ground.random_spot(&mut self.stream(index)))
    }
}

impl Scattered<'_> {
    fn stream(&self, index: u64) -> Stream {
        Stream::new(self.laid.seed, self.number, index)
    }

    /// `curvature` and `jitter` are standard normal draws.
    fn guide(&self, seed: MeshPoint, seed_angle_rad: f64, curvature: f64, jitter: f64) -> Guide {
        let around = |around: &PatternAxis, bearing| Guide::Around {
            axis: self.ground.direction_in_world(around.axis),
            center_m: self.ground.point_in_world_m(around.center_m),
            bearing,
            jitter_rad: around.jitter_deg.to_radians() * jitter,
        };
        match &self.laid.pattern {
            Pattern::Random { curvature_per_m } => Guide::Free {
                seed_direction: Facet::new(&self.ground.mesh, seed.triangle)
                    .direction(seed_angle_rad),
                curvature_per_m: curvature_per_m.normal_at(curvature),
            },
            Pattern::Parallel {
                direction,
                jitter_deg,
            } => Guide::Parallel {
                direction: self.ground.direction_in_world(*direction),
                jitter_rad: jitter_deg.to_radians() * jitter,
            },
            Pattern::Circular(axis) => around(axis, Bearing::Circular),
            Pattern::Radial(axis) => around(axis, Bearing::Radial),
            Pattern::Spun {
                around: axis,
                curvature_per_m,
            } => {
                let curvature_per_m = curvature_per_m.normal_at(curvature);
                around(axis, Bearing::Spun { curvature_per_m })
            }
            Pattern::Swirl { curvature_per_m } => {
                let wanted_per_m = curvature_per_m.normal_at(curvature);
                self.swirl(
                    seed,
                    seed_angle_rad,
                    1.0 / curvature_per_m.mean.abs(),
                    wanted_per_m,
                )
            }
        }
    }

    fn swirl(&self, seed: MeshPoint, seed_angle_rad: f64, cell_m: f64, wanted_per_m: f64) -> Guide {
        let facet = Facet::new(&self.ground.mesh, seed.triangle);
        let lattice = Lattice {
            seed: self.laid.seed,
            number: self.number,
            cell_m,
            origin_m: self.ground.corner_m,
        };
        let center_m = lattice.center(&facet, seed.point_m, 1.0 / wanted_per_m.abs());
        let arm_m = center_m - seed.point_m;
        // On top of a centre every direction is as good; the floor keeps the curvature within what a scene may ask for.
        let radius_m = arm_m.length().max(1e-4);
        let seed_direction = match arm_m.cross(facet.normal).try_normalize() {
            Some(tangent) => tangent,
            None => facet.direction(seed_angle_rad),
        };
        Guide::Free {
            seed_direction,
            curvature_per_m: 1.0 / radius_m,
        }
    }
}
