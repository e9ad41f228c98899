//! The point of a mesh that is nearest to a given one: a tree of boxes over the triangles, split at the median.
//!
//! obvhs has queries for rays, boxes and points, none for what is nearest. parry has one, but keeps a mesh of its own besides ours,
//! and brings another version of glam and thirty crates.

use std::sync::Arc;

use glam::DVec3;

use super::walk::Spot;
use crate::scene::Mesh;

/// Triangles in a leaf.
const LEAF: usize = 8;

/// A tree over a mesh's triangles. Node i has the children 2 i + 1 and 2 i + 2, each with half of its triangles.
#[derive(Debug)]
pub(super) struct Closest {
    mesh: Arc<Mesh>,
    triangles: Vec<u32>,
    nodes: Vec<Bounds>,
}

#[derive(Clone, Copy, Debug)]
struct Bounds {
    least: DVec3,
    most: DVec3,
}

impl Bounds {
    const EMPTY: Self = Self {
        least: DVec3::INFINITY,
        most: DVec3::NEG_INFINITY,
    };

    fn distance_squared(&self, point: DVec3) -> f64 {
        point.clamp(self.least, self.most).distance_squared(point)
    }
}

impl Closest {
    /// `mesh` must have a triangle.
    pub(super) fn new(mesh: Arc<Mesh>) -> Self {
        let mut tree = Self {
            triangles: (0..mesh.triangles.len() as u32).collect(),
            mesh,
            nodes: Vec::new(),
        };
        tree.split(0, 0, tree.triangles.len());
        tree
    }

    fn split(&mut self, node: usize, first: usize, end: usize) {
        if self.nodes.len() <= node {
            self.nodes.resize(node + 1, Bounds::EMPTY);
        }
        let mesh = &self.mesh;
        let corners = |t: &u32| mesh.corners_m(*t as usize);
        self.nodes[node] =
            self.triangles[first..end]
                .iter()
                .flat_map(corners)
                .fold(Bounds::EMPTY, |bounds, p| Bounds {
                    least: bounds.least.min(p),
                    most: bounds.most.max(p),
                });
        if end - first <= LEAF {
            return;
        }
        let axis = (self.nodes[node].most - self.nodes[node].least).max_position();
        let middle = (first + end) / 2;
        let place = |t: &u32| corners(t).iter().map(|p| p[axis]).sum::<f64>();
        self.triangles[first..end]
            .select_nth_unstable_by(middle - first, |a, b| place(a).total_cmp(&place(b)));
        self.split(2 * node + 1, first, middle);
        self.split(2 * node + 2, middle, end);
    }

    /// The nearest place on the mesh, and its distance in metres.
    pub(super) fn find(&self, point_m: DVec3) -> (Spot, f64) {
        let nowhere = Spot {
            triangle: 0,
            point_m: self.mesh.corners_m(0)[0],
        };
        let mut best = (nowhere, f64::INFINITY);
        self.visit(0, 0, self.triangles.len(), point_m, &mut best);
        (best.0, best.1.sqrt())
    }

    /// The same within a distance: what is far from the mesh is found to be so in no time.
    pub(super) fn find_within(&self, point_m: DVec3, most_m: f64) -> Option<(Spot, f64)> {
        let nowhere = Spot {
            triangle: 0,
            point_m,
        };
        // A little more, for what rounds.
        let most = most_m * most_m * (1.0 + 1e-9);
        let mut best = (nowhere, most);
        self.visit(0, 0, self.triangles.len(), point_m, &mut best);
        (best.1 < most).then(|| (best.0, best.1.sqrt()))
    }

    /// `best` holds a squared distance.
    fn visit(&self, node: usize, first: usize, end: usize, point: DVec3, best: &mut (Spot, f64)) {
        if self.nodes[node].distance_squared(point) >= best.1 {
            return;
        }
        if end - first <= LEAF {
            for &triangle in &self.triangles[first..end] {
                let point_m = nearest_on_triangle(self.mesh.corners_m(triangle as usize), point);
                let distance = point_m.distance_squared(point);
                if distance < best.1 {
                    *best = (Spot { triangle, point_m }, distance);
                }
            }
            return;
        }
        let middle = (first + end) / 2;
        let mut halves = [(2 * node + 1, first, middle), (2 * node + 2, middle, end)];
        let distance = |half: &(usize, usize, usize)| self.nodes[half.0].distance_squared(point);
        if distance(&halves[1]) < distance(&halves[0]) {
            halves.swap(0, 1);
        }
        for (node, first, end) in halves {
            self.visit(node, first, end, point, best);
        }
    }
}

/// The foot of the perpendicular if it lies inside, else the nearest point of an edge.
fn nearest_on_triangle([a, b, c]: [DVec3; 3], point: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(from, to)| normal.cross(to - from).dot(point - from) >= 0.0);
    if inside {
        return point - normal * ((point - a).dot(normal) / normal.length_squared());
    }
    [(a, b), (b, c), (c, a)]
        .map(|(from, to)| {
            let share = (point - from).dot(to - from) / (to - from).length_squared();
            from.lerp(to, share.clamp(0.0, 1.0))
        })
        .into_iter()
        .min_by(|p, q| {
            p.distance_squared(point)
                .total_cmp(&q.distance_squared(point))
        })
        .expect("there are three edges")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape;
    use glam::DMat4;

    #[test]
    fn finds_what_a_search_through_all_finds() {
        let mut mesh = Mesh::default();
        shape::sphere(0.1).bake(&DMat4::from_scale(DVec3::new(1.0, 2.0, 0.5)), 0, &mut mesh);
        let mesh = Arc::new(mesh);
        let tree = Closest::new(mesh.clone());
        for i in 0..50 {
            let angle = f64::from(i);
            let point = DVec3::new(angle.sin(), angle.cos(), (2.0 * angle).sin()) * 0.15;
            let all = (0..mesh.triangles.len())
                .map(|t| nearest_on_triangle(mesh.corners_m(t), point).distance(point));
            let (spot, distance_m) = tree.find(point);
            assert_eq!(distance_m, all.fold(f64::INFINITY, f64::min));
            assert_eq!(distance_m, spot.point_m.distance(point));
            let within = tree.find_within(point, distance_m);
            assert_eq!(within.map(|(spot, _)| spot.triangle), Some(spot.triangle));
            assert!(tree.find_within(point, 0.999 * distance_m).is_none());
        }
    }
}
