//! The surface that scratches are laid on, made ready for it.

use std::sync::{Arc, OnceLock};

use glam::{DMat4, DVec3};
use hairline_scene::Mesh;

use crate::closest::Closest;
use crate::facet::Facet;
use crate::neighbours::Neighbours;
use crate::random::Stream;
use crate::walk::{MeshPoint, Walker, shortest_piece_m};

/// Half of the usual coherence width.
const SHORTEST_M: f64 = 10e-6;
/// A longer scratch only goes over itself again; relative to the object's diagonal.
const LONGEST: f64 = 100.0;

/// Least sine at which a point's nearest place counts as beside the point and not below it: the point is then over a rim. Edges
/// of a right angle are no rims.
const BESIDE_SINE: f64 = 0.9;
/// Nearer than this, the direction is rounding.
const BESIDE_M: f64 = 1e-7;

/// A mesh with all data that laying needs.
#[derive(Debug)]
pub struct Ground {
    /// In world space.
    pub mesh: Arc<Mesh>,
    /// The object's own frame, in which patterns are described.
    pub world_from_object: DMat4,
    /// Corner of the bounding box with the least coordinates.
    pub corner_m: DVec3,
    /// The length of the box's diagonal.
    pub diagonal_m: f64,
    /// Length of the shortest piece of a walk.
    shortest_piece_m: f64,
    neighbours: Neighbours,
    /// The area of all triangles up to and including each.
    areas_m2: Vec<f64>,
    /// Search for closest points, made at the first use: few layers need it.
    closest: OnceLock<Closest>,
}

impl Ground {
    /// Makes a mesh ready.
    pub fn new(mesh: Arc<Mesh>, world_from_object: DMat4) -> Self {
        let mut sum = 0.0;
        let areas_m2 = (0..mesh.triangles.len())
            .map(|triangle| {
                let [a, b, c] = mesh.corners_m(triangle);
                sum += (b - a).cross(c - a).length() / 2.0;
                sum
            })
            .collect();
        let (least, most) = mesh.bounds_m();
        Self {
            neighbours: Neighbours::new(&mesh),
            mesh,
            world_from_object,
            corner_m: least.as_dvec3(),
            diagonal_m: f64::from((most - least).length()),
            areas_m2,
            shortest_piece_m: shortest_piece_m((least, most)),
            closest: OnceLock::new(),
        }
    }

    /// The area of the surface.
    pub fn area_m2(&self) -> f64 {
        self.areas_m2.last().copied().unwrap_or(0.0)
    }

    /// Walks on the mesh.
    pub fn walker(&self) -> Walker<'_> {
        Walker::new(&self.mesh, &self.neighbours, self.shortest_piece_m)
    }

    /// The nearest places on the surface.
    pub fn closest(&self) -> &Closest {
        self.closest.get_or_init(|| Closest::new(self.mesh.clone()))
    }

    /// Whether the nearest place to a point is below it, and not beside it on a rim.
    pub fn is_under(&self, spot: &MeshPoint, point_m: DVec3) -> bool {
        let off = point_m - spot.point_m;
        let beside = Facet::new(&self.mesh, spot.triangle).in_plane(off);
        off.length() <= BESIDE_M || beside.length() <= BESIDE_SINE * off.length()
    }

    /// Distance of a point of the object's own frame from the box about the object.
    pub fn off_box_m(&self, point_m: [f64; 3]) -> f64 {
        let (least, most) = self.mesh.bounds_m();
        let (least, most) = (least.as_dvec3(), most.as_dvec3());
        let point_m = self.point_in_world_m(point_m);
        point_m.distance(point_m.clamp(least, most))
    }

    /// The nearest length of a scratch that fits the surface.
    pub fn fitting_length_m(&self, length_m: f64) -> f64 {
        length_m.clamp(SHORTEST_M, (LONGEST * self.diagonal_m).max(SHORTEST_M))
    }

    /// A place on the surface, each area alike.
    pub fn random_spot(&self, stream: &mut Stream) -> MeshPoint {
        let wanted = stream.uniform() * self.area_m2();
        let triangle = self.areas_m2.partition_point(|area| *area <= wanted);
        // Rounding may carry the product up to the whole area.
        let triangle = triangle.min(self.areas_m2.len() - 1) as u32;
        let [a, b, c] = Facet::new(&self.mesh, triangle).corners_m;
        // The square root makes the density even over the triangle.
        let from_a = libm::sqrt(stream.uniform());
        let to_c = stream.uniform();
        MeshPoint {
            triangle,
            point_m: a.lerp(b.lerp(c, to_c), from_a),
        }
    }

    /// A point of the object's own frame, in world space.
    pub fn point_in_world_m(&self, point_m: [f64; 3]) -> DVec3 {
        self.world_from_object.transform_point3(point_m.into())
    }

    /// Points in world space, without repetitions.
    pub fn points_in_world_m(&self, points_m: &[[f64; 3]]) -> Vec<DVec3> {
        let points = points_m.iter();
        let mut points_m: Vec<_> = points.map(|p| self.point_in_world_m(*p)).collect();
        points_m.dedup_by(|next, last| next.distance(*last) == 0.0);
        points_m
    }

    /// A unit direction in world space.
    pub fn direction_in_world(&self, direction: [f64; 3]) -> DVec3 {
        self.world_from_object
            .transform_vector3(direction.into())
            .normalize_or_zero()
    }
}
