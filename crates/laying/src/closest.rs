//! The point of a mesh that is nearest to a given one: a tree of boxes over the triangles, split where it costs the queries least.
//!
//! The cost is that of MacDonald and Booth, "Heuristics for ray tracing using space subdivision", 1990, looked for between bins as by
//! Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007. Splits at the median leave a disk's rim of slivers in
//! the boxes of its large triangles, so that each query visits most of them.
//!
//! obvhs has queries for rays, boxes and points, none for what is nearest. parry has one, but keeps a mesh of its own besides ours,
//! and brings another version of glam and thirty crates.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use hairline_scene::Mesh;

use crate::walk::MeshPoint;

/// Triangles in a leaf.
const LEAF: usize = 4;
/// Places between which a split is looked for.
const BINS: usize = 16;
/// Deeper than this a node is halved: no tree is deeper than that and 32 more levels.
const MOST_UNEVEN: usize = 32;
/// Number of triangles that are worth another thread.
const ALONE: usize = 1 << 12;

/// A tree over a mesh's triangles.
#[derive(Debug)]
pub struct Closest {
    mesh: Arc<Mesh>,
    /// Triangles in the order of the leaves.
    triangles: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// First triangle of a leaf; else the first of two nodes.
    first: u32,
    /// Triangles of a leaf; else 0.
    count: u32,
}

/// Exact: the vertices are in single precision.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    least: Vec3,
    most: Vec3,
}

impl Bounds {
    const EMPTY: Self = Self {
        least: Vec3::INFINITY,
        most: Vec3::NEG_INFINITY,
    };

    fn union(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            most: self.most.max(other.most),
        }
    }

    /// Twice the middle.
    fn middle(&self) -> Vec3 {
        self.least + self.most
    }

    /// Half of the surface.
    fn area(&self) -> f32 {
        let size = (self.most - self.least).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    fn distance_squared(&self, point: DVec3) -> f64 {
        let (least, most) = (self.least.as_dvec3(), self.most.as_dvec3());
        point.clamp(least, most).distance_squared(point)
    }
}

/// Bounds and number of the items on one side of a cut.
#[derive(Clone, Copy)]
struct CutSide {
    bounds: Bounds,
    count: f32,
}

impl CutSide {
    const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        count: 0.0,
    };

    fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            count: self.count + other.count,
        }
    }

    fn cost(self) -> f32 {
        self.bounds.area() * self.count
    }
}

/// A triangle while the tree grows.
#[derive(Clone, Copy)]
struct Item {
    triangle: u32,
    bounds: Bounds,
}

impl Closest {
    /// `mesh` must have a triangle.
    pub fn new(mesh: Arc<Mesh>) -> Self {
        let mut items: Vec<Item> = (0..)
            .zip(&mesh.triangles)
            .map(|(triangle, corners)| {
                let corners = corners.map(|v| mesh.positions_m[v as usize]);
                let point = |least: Vec3| Bounds { least, most: least };
                let bounds = corners.map(point).into_iter().reduce(Bounds::union);
                Item {
                    triangle,
                    bounds: bounds.unwrap_or(Bounds::EMPTY),
                }
            })
            .collect();
        let nodes = grown(&mut items, 0, 0);
        Self {
            triangles: items.iter().map(|item| item.triangle).collect(),
            nodes,
            mesh,
        }
    }

    /// The nearest place on the mesh, and its distance in metres.
    pub fn find(&self, point_m: DVec3) -> (MeshPoint, f64) {
        self.nearest(point_m, f64::INFINITY).unwrap_or_else(|| {
            let spot = MeshPoint {
                triangle: 0,
                point_m: self.mesh.corners_m(0)[0],
            };
            (spot, f64::INFINITY)
        })
    }

    /// Finds the nearest point within a distance; a place far from the mesh costs no time.
    pub fn find_within(&self, point_m: DVec3, most_m: f64) -> Option<(MeshPoint, f64)> {
        // A little more, for what rounds.
        self.nearest(point_m, most_m * most_m * (1.0 + 1e-9))
    }

    /// The nearest place whose squared distance is below `most`.
    fn nearest(&self, point: DVec3, most: f64) -> Option<(MeshPoint, f64)> {
        let (mut found, mut least) = (None, most);
        let mut left = [(0, 0.0); MOST_UNEVEN + 32];
        let mut count = 1;
        left[0] = (0, self.nodes[0].bounds.distance_squared(point));
        while count > 0 {
            count -= 1;
            let (node, distance) = left[count];
            if distance >= least {
                continue;
            }
            let node: &Node = &self.nodes[node];
            let first = node.first as usize;
            if node.count > 0 {
                for &triangle in &self.triangles[first..first + node.count as usize] {
                    let corners_m = self.mesh.corners_m(triangle as usize);
                    let Some(point_m) = nearest_on_triangle(corners_m, point, least) else {
                        continue;
                    };
                    let distance = point_m.distance_squared(point);
                    if distance < least {
                        (found, least) = (Some(MeshPoint { triangle, point_m }), distance);
                    }
                }
                continue;
            }
            let distance = |node: usize| (node, self.nodes[node].bounds.distance_squared(point));
            let mut halves = [distance(first + 1), distance(first)];
            if halves[0].1 < halves[1].1 {
                halves.swap(0, 1);
            }
            // The nearer one last, which is taken first.
            for half in halves {
                if half.1 < least {
                    left[count] = half;
                    count += 1;
                }
            }
        }
        found.map(|spot| (spot, least.sqrt()))
    }
}

/// Builds a tree over `items`, and puts them into the order of its leaves. `first` is the index of the first of them in the mesh's
/// order. The root comes first.
fn grown(items: &mut [Item], first: usize, depth: usize) -> Vec<Node> {
    let bounds = items.iter().map(|item| item.bounds);
    let bounds = bounds.fold(Bounds::EMPTY, Bounds::union);
    if items.len() <= LEAF {
        return vec![Node {
            bounds,
            first: first as u32,
            count: items.len() as u32,
        }];
    }
    let middle = split(items, depth);
    let many = items.len() > ALONE;
    let (left, right) = items.split_at_mut(middle);
    let mut grow_left = || grown(left, first, depth + 1);
    let mut grow_right = || grown(right, first + middle, depth + 1);
    let (left, right) = match many {
        true => rayon::join(grow_left, grow_right),
        false => (grow_left(), grow_right()),
    };
    // Both roots side by side, then what lies below the left one and the right one.
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(Node {
        bounds,
        first: 1,
        count: 0,
    });
    let below_right = left.len() as u32 + 1;
    let moved = |node: &Node, by: u32| match node.count {
        0 => Node {
            first: node.first + by,
            ..*node
        },
        _ => *node,
    };
    nodes.extend([moved(&left[0], 2), moved(&right[0], below_right)]);
    nodes.extend(left[1..].iter().map(|node| moved(node, 2)));
    nodes.extend(right[1..].iter().map(|node| moved(node, below_right)));
    nodes
}

/// Finds the cut of `items` and sorts them to its sides.
fn split(items: &mut [Item], depth: usize) -> usize {
    let middles = items.iter().map(|item| item.bounds.middle());
    let (least, most) = middles.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), m| {
        (a.min(m), b.max(m))
    });
    let size = most - least;
    let bin = |item: &Item, axis: usize| {
        let share = (item.bounds.middle()[axis] - least[axis]) / size[axis];
        ((share * BINS as f32) as usize).min(BINS - 1)
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| depth < MOST_UNEVEN && size[axis] > 0.0) {
        let mut bins = [CutSide::EMPTY; BINS];
        for item in items.iter() {
            let bin = &mut bins[bin(item, axis)];
            *bin = bin.union(CutSide {
                bounds: item.bounds,
                count: 1.0,
            });
        }
        let mut right = [CutSide::EMPTY; BINS + 1];
        for cut in (0..BINS).rev() {
            right[cut] = right[cut + 1].union(bins[cut]);
        }
        let mut left = CutSide::EMPTY;
        for cut in 1..BINS {
            left = left.union(bins[cut - 1]);
            let cost = left.cost() + right[cut].cost();
            let has_both = left.count > 0.0 && right[cut].count > 0.0;
            if has_both && best.is_none_or(|best| cost < best.0) {
                best = Some((cost, axis, cut));
            }
        }
    }
    let Some((_, axis, cut)) = best else {
        let half = items.len() / 2;
        let axis = size.max_position();
        items.select_nth_unstable_by(half, |a, b| {
            let middle = |item: &Item| item.bounds.middle()[axis];
            middle(a).total_cmp(&middle(b))
        });
        return half;
    };
    let mut count = 0;
    for i in 0..items.len() {
        if bin(&items[i], axis) < cut {
            items.swap(i, count);
            count += 1;
        }
    }
    count
}

/// Nearest point of a triangle: the foot of the perpendicular if it lies inside, else the nearest point of an edge. None if it is
/// surely farther away than the root of `most`.
fn nearest_on_triangle([a, b, c]: [DVec3; 3], point: DVec3, most: f64) -> Option<DVec3> {
    // More than rounding.
    const CERTAIN: f64 = 1.0 + 1e-9;
    let edges = [(a, b - a), (b, c - b), (c, a - c)];
    let normal = (b - a).cross(c - a);
    let size = normal.length_squared();
    let mut is_inside = true;
    for (from, edge) in edges {
        let beyond = normal.cross(edge).dot(point - from);
        if beyond < 0.0 {
            is_inside = false;
            if beyond * beyond > most * (size * edge.length_squared() * CERTAIN) {
                return None;
            }
        }
    }
    if is_inside {
        return Some(point - normal * ((point - a).dot(normal) / size));
    }
    let mut best = (DVec3::ZERO, f64::INFINITY);
    for (from, edge) in edges {
        let share = (point - from).dot(edge) / edge.length_squared();
        let nearest = from.lerp(from + edge, share.clamp(0.0, 1.0));
        let distance = nearest.distance_squared(point);
        if distance < best.1 {
            best = (nearest, distance);
        }
    }
    Some(best.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::mesh;

    #[test]
    fn finds_what_a_search_through_all_finds() {
        let mut mesh = mesh("sphere = { radius_m = 0.1 }");
        for position_m in &mut mesh.positions_m {
            *position_m *= Vec3::new(1.0, 2.0, 0.5);
        }
        let mesh = Arc::new(mesh);
        let tree = Closest::new(mesh.clone());
        for i in 0..50 {
            let angle = f64::from(i);
            let point = DVec3::new(angle.sin(), angle.cos(), (2.0 * angle).sin()) * 0.15;
            let all = (0..mesh.triangles.len())
                .filter_map(|t| nearest_on_triangle(mesh.corners_m(t), point, f64::INFINITY))
                .map(|nearest| nearest.distance(point));
            let (spot, distance_m) = tree.find(point);
            assert_eq!(distance_m, all.fold(f64::INFINITY, f64::min));
            assert_eq!(distance_m, spot.point_m.distance(point));
            let within = tree.find_within(point, distance_m);
            assert_eq!(within.map(|(spot, _)| spot.triangle), Some(spot.triangle));
            assert!(tree.find_within(point, 0.999 * distance_m).is_none());
        }
    }
}
