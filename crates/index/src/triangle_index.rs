//! Triangles along a ray.

use std::ops::Range;

use glam::{DVec3, Vec3A};
use hairline_scene::{Object, Scene};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ray::{Ray, RayHit};
use rayon::prelude::*;

use crate::coverage::Coverage;
use crate::cutouts::Cutouts;
use crate::hit::Hit;
use crate::tree;

/// A node of a [`TriangleIndex`] in depth-first order. A walk goes on with the next node, or with `skip` if it wants nothing below this one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TriangleNode {
    /// The next node that is not below this one; always greater than the node's own index.
    pub skip: u32,
    /// Triangles of a leaf, at most eight, as [`TriangleIndex::triangles`] numbers them; empty for an inner node.
    pub triangles: Range<u32>,
}

/// A tree over all triangles of a scene.
pub struct TriangleIndex {
    tree: Bvh2,
    /// Object, triangle and corners, in the order of the leaves.
    triangles: Vec<(u32, u32, [DVec3; 3])>,
    /// The first of the objects that only the camera sees.
    lamps: u32,
    cutouts: Option<Cutouts>,
}

impl TriangleIndex {
    /// Builds the tree.
    pub fn build(scene: &Scene) -> Self {
        Self::with_objects(scene, |_| true)
    }

    /// Builds the index without the shapes of lights, for rays of light.
    pub fn without_lamps(scene: &Scene) -> Self {
        Self::with_objects(scene, |object| !object.is_lamp)
    }

    fn with_objects(scene: &Scene, is_in: impl Fn(&Object) -> bool) -> Self {
        let objects = scene.objects.iter().enumerate();
        let objects = objects.filter(|(_, object)| is_in(object));
        let numbers: Vec<(u32, u32)> = objects
            .flat_map(|(o, object)| {
                let triangles = 0..object.mesh.triangles.len() as u32;
                triangles.map(move |t| (o as u32, t))
            })
            .collect();
        let corners = |(o, t): (u32, u32)| {
            let mesh = &scene.objects[o as usize].mesh;
            mesh.triangles[t as usize].map(|v| mesh.positions_m[v as usize])
        };
        let boxes: Vec<Aabb> = numbers
            .par_iter()
            .map(|at| Aabb::from_points(&corners(*at).map(Vec3A::from)))
            .collect();
        let tree = tree::build(&boxes, &BvhBuildParams::medium_build());
        drop(boxes);
        let triangles = tree
            .primitive_indices
            .par_iter()
            .map(|i| {
                let (o, t) = numbers[*i as usize];
                (o, t, corners((o, t)).map(|corner| corner.as_dvec3()))
            })
            .collect();
        let mut objects = scene.objects.iter();
        let lamps = objects.position(|object| object.is_lamp);
        Self {
            tree,
            triangles,
            lamps: lamps.unwrap_or(scene.objects.len()) as u32,
            cutouts: Cutouts::from_scene(scene),
        }
    }

    /// Whether the surface exists at a hit, and is not cut out of its triangle there.
    pub(crate) fn is_there(&self, hit: &Hit, coverage: Coverage) -> bool {
        let cutouts = self.cutouts.as_ref();
        cutouts.is_none_or(|it| it.is_there(hit, coverage))
    }

    /// Whether the surface of a hit may cover only a part of what lies behind it.
    pub fn is_partial(&self, hit: &Hit) -> bool {
        let cutouts = self.cutouts.as_ref();
        cutouts.is_some_and(|it| it.is_partial(hit))
    }

    /// Coverage of a ray that is drawn by chance.
    fn by_ray(&self, origin: DVec3, direction: DVec3) -> Coverage {
        match self.cutouts {
            Some(_) => Coverage::of_ray(origin, direction),
            None => Coverage::Any,
        }
    }

    pub(crate) fn tree(&self) -> &Bvh2 {
        &self.tree
    }

    /// The tree's nodes in depth-first order.
    pub fn nodes(&self) -> Vec<TriangleNode> {
        enum Step {
            Enter(u32),
            Leave(usize),
        }
        let mut nodes = Vec::with_capacity(self.tree.nodes.len());
        let mut left = Vec::new();
        if !self.triangles.is_empty() {
            left.push(Step::Enter(0));
        }
        // Not by recursion: nobody bounds how deep a tree is.
        while let Some(step) = left.pop() {
            match step {
                Step::Leave(at) => {
                    let nodes: &mut Vec<TriangleNode> = &mut nodes;
                    nodes[at].skip = nodes.len() as u32;
                }
                Step::Enter(i) => {
                    let node = &self.tree.nodes[i as usize];
                    let at = nodes.len();
                    let first = node.first_index;
                    let is_leaf = node.is_leaf();
                    nodes.push(TriangleNode {
                        skip: at as u32 + 1,
                        triangles: if is_leaf {
                            first..first + node.prim_count
                        } else {
                            0..0
                        },
                    });
                    if !is_leaf {
                        left.extend([Step::Leave(at), Step::Enter(first + 1), Step::Enter(first)]);
                    }
                }
            }
        }
        nodes
    }

    /// Object, triangle and corners, in the order of the tree's leaves.
    pub fn triangles(&self) -> &[(u32, u32, [DVec3; 3])] {
        &self.triangles
    }

    /// Whether the camera at `origin` does not see a triangle: the back of a lamp.
    pub(crate) fn is_unseen(&self, object: u32, [a, b, c]: &[DVec3; 3], origin: DVec3) -> bool {
        object >= self.lamps && (*b - *a).cross(*c - *a).dot(origin - *a) <= 0.0
    }

    /// The nearest hit of a ray of the camera, from `origin` along the unit `direction`: either side of a triangle, and the fronts of lamps.
    /// Of surfaces that cover a part of what lies behind them, any.
    pub fn intersect(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        self.intersect_covered(origin, direction, Coverage::Any)
    }

    /// [`Self::intersect`] with a rule for surfaces that cover a part of what lies behind them.
    pub(crate) fn intersect_covered(
        &self,
        origin: DVec3,
        direction: DVec3,
        coverage: Coverage,
    ) -> Option<Hit> {
        self.nearest(origin, direction, coverage, |object, corners| {
            !self.is_unseen(object, corners, origin)
        })
    }

    /// [`Self::intersect`] for one of many rays that are drawn by chance: it meets such surfaces as often as their alpha says.
    pub fn intersect_drawn(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let coverage = self.by_ray(origin, direction);
        self.intersect_covered(origin, direction, coverage)
    }

    /// The nearest hit of any other ray, drawn by chance: lamps are not in its way.
    pub fn intersect_solid(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let coverage = self.by_ray(origin, direction);
        self.nearest(origin, direction, coverage, |object, _| object < self.lamps)
    }

    /// Nearest hit of a ray that looks for an object: lamps and surfaces that cover it only in part are not in its way.
    pub fn intersect_object(&self, object: u32, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let coverage = Coverage::Only(object);
        let hit = self.nearest(origin, direction, coverage, |object, _| object < self.lamps);
        hit.filter(|hit| hit.object == object)
    }

    fn nearest(
        &self,
        origin: DVec3,
        direction: DVec3,
        coverage: Coverage,
        is_there: impl Fn(u32, &[DVec3; 3]) -> bool,
    ) -> Option<Hit> {
        if self.triangles.is_empty() {
            return None;
        }
        let ray = Ray::new_inf(origin.as_vec3a(), non_zero(direction.as_vec3a()));
        let mut nearest = RayHit::none();
        let mut hit: Option<Hit> = None;
        // The tree is walked in single precision, the triangle met in double: neighbours share their edge exactly enough.
        self.tree.ray_traverse(ray, &mut nearest, |_, id| {
            let (object, triangle, corners) = &self.triangles[id];
            if !is_there(*object, corners) {
                return f32::INFINITY;
            }
            match intersect_triangle(origin, direction, corners) {
                Some((distance_m, barycentric)) => {
                    let met = Hit {
                        object: *object,
                        triangle: *triangle,
                        distance_m,
                        barycentric,
                    };
                    if !self.is_there(&met, coverage) {
                        return f32::INFINITY;
                    }
                    if hit.is_none_or(|h| distance_m < h.distance_m) {
                        hit = Some(met);
                    }
                    distance_m as f32
                }
                None => f32::INFINITY,
            }
        });
        hit
    }

    /// Whether a ray from `origin` along the unit `direction`, drawn by chance, meets a triangle, either side of it, nearer than `distance_m`. Lamps hide nothing.
    pub fn is_hidden(&self, origin: DVec3, direction: DVec3, distance_m: f64) -> bool {
        if self.triangles.is_empty() {
            return false;
        }
        let coverage = self.by_ray(origin, direction);
        let (from, along) = (origin.as_vec3a(), non_zero(direction.as_vec3a()));
        let ray = Ray::new(from, along, 0.0, distance_m as f32);
        let is_free = self.tree.ray_traverse_miss(ray, |_, id| {
            let (object, triangle, corners) = &self.triangles[id];
            let met = match intersect_triangle(origin, direction, corners) {
                Some((at_m, barycentric)) if at_m < distance_m && *object < self.lamps => Hit {
                    object: *object,
                    triangle: *triangle,
                    distance_m: at_m,
                    barycentric,
                },
                _ => return f32::INFINITY,
            };
            match self.is_there(&met, coverage) {
                true => 0.0,
                false => f32::INFINITY,
            }
        });
        !is_free
    }
}

/// Slab tests divide by the direction.
fn non_zero(direction: Vec3A) -> Vec3A {
    Vec3A::from_array(direction.to_array().map(|c| {
        if c.abs() < 1e-20 {
            1e-20f32.copysign(c)
        } else {
            c
        }
    }))
}

/// The distance along a direction at which a line from `origin` meets a triangle, either side of it, and the barycentric coordinates of the second
/// and third corner there: T. Moeller, B. Trumbore, *Fast, Minimum Storage Ray/Triangle Intersection*, 1997.
pub fn intersect_triangle(
    origin: DVec3,
    direction: DVec3,
    [a, b, c]: &[DVec3; 3],
) -> Option<(f64, [f64; 2])> {
    let (e1, e2) = (*b - *a, *c - *a);
    let p = direction.cross(e2);
    let determinant = e1.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = origin - *a;
    let u = s.dot(p) / determinant;
    let q = s.cross(e1);
    let v = direction.dot(q) / determinant;
    let distance = e2.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some((distance, [u, v]))
}
