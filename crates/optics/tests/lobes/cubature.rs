//! Exact integrals of lobes over lights: cubature on meshes graded towards the lobe's peak.
//!
//! Nothing here is shared with the code under test but the lobe that it is given. Cells shrink with their distance from the
//! mirror direction, down to a fraction of the lobe's width; each is integrated by 6 x 6 Gauss points. Cells across the
//! horizon, where lobes have a kink, are cut further.

use std::f64::consts::PI;
use std::ops::{Add, Mul};

use glam::DVec3;

const GAUSS: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_170),
    (-0.661_209_386_466_265, 0.360_761_573_048_139),
    (-0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.661_209_386_466_265, 0.360_761_573_048_139),
    (0.932_469_514_203_152, 0.171_324_492_379_170),
];

/// Direction and width of a lobe's peak.
#[derive(Clone, Copy)]
pub struct Peak {
    pub direction: DVec3,
    pub width_rad: f64,
}

/// A patch parametrised over the unit square: (direction, solid angle per unit of parameter).
pub trait Patch: Copy {
    fn at(&self, u: f64, v: f64) -> (DVec3, f64);
}

/// The spherical cap within `radius_rad` of `axis`, in polar coordinates.
#[derive(Clone, Copy)]
pub struct Cap {
    pub axis: DVec3,
    pub radius_rad: f64,
}

impl Patch for Cap {
    fn at(&self, u: f64, v: f64) -> (DVec3, f64) {
        let (x, y) = self.axis.any_orthonormal_pair();
        let (sin_g, cos_g) = (u * self.radius_rad).sin_cos();
        let (sin_p, cos_p) = (2.0 * PI * v).sin_cos();
        let direction = self.axis * cos_g + (x * cos_p + y * sin_p) * sin_g;
        (direction, sin_g * self.radius_rad * 2.0 * PI)
    }
}

/// A plane triangle; its solid angle is signed by its orientation.
#[derive(Clone, Copy)]
pub struct Triangle(pub [DVec3; 3]);

impl Patch for Triangle {
    fn at(&self, u: f64, v: f64) -> (DVec3, f64) {
        let [a, b, c] = self.0;
        let (ab, ac) = (b - a, c - a);
        // The square folds onto the triangle at a.
        let point = a + u * ((1.0 - v) * ab + v * ac);
        let r2 = point.length_squared();
        let direction = point / r2.sqrt();
        (direction, u * ab.cross(ac).dot(direction) / r2)
    }
}

/// Values that can be integrated: a number, or several at once.
pub trait Integrand: Copy + Default + Add<Output = Self> + Mul<f64, Output = Self> {}

impl<T: Copy + Default + Add<Output = T> + Mul<f64, Output = T>> Integrand for T {}

/// The integral of `lobe` over the part of a patch above the horizon.
pub fn integrate<T: Integrand>(patch: impl Patch, peak: Peak, lobe: &dyn Fn(DVec3) -> T) -> T {
    let is_coarse = |cell: Cell| {
        let near = ((cell.centre - peak.direction).length() - cell.reach).max(0.0);
        let crosses = cell.crosses_horizon() && cell.reach > 0.02 && cell.depth < 12;
        cell.depth < 44 && (cell.reach > 0.25 * (near + peak.width_rad) || crosses)
    };
    integrate_by(patch, &GAUSS, is_coarse, lobe)
}

/// A part of a patch.
pub struct Cell {
    pub centre: DVec3,
    /// Distance from the centre to the farthest of the corners and of the edges' middles.
    pub reach: f64,
    /// Number of times that the patch was halved.
    pub depth: u32,
}

impl Cell {
    pub fn crosses_horizon(&self) -> bool {
        (-self.reach..self.reach).contains(&self.centre.z)
    }
}

/// Integrates a patch by a rule of nodes and weights on [-1, 1], in cells that are halved while they are too coarse.
pub fn integrate_by<T: Integrand>(
    patch: impl Patch,
    rule: &[(f64, f64)],
    is_coarse: impl Fn(Cell) -> bool,
    lobe: &dyn Fn(DVec3) -> T,
) -> T {
    let mut cells = vec![([0.0, 1.0], [0.0, 0.5], 0), ([0.0, 1.0], [0.5, 1.0], 0)];
    let mut sum = T::default();
    while let Some((u, v, depth)) = cells.pop() {
        let at = |i: usize, j: usize| {
            let lerp = |r: [f64; 2], k: usize| r[0] + 0.5 * k as f64 * (r[1] - r[0]);
            patch.at(lerp(u, i), lerp(v, j)).0
        };
        let centre = at(1, 1);
        let reach = (0..9)
            .map(|k| (at(k / 3, k % 3) - centre).length())
            .fold(0.0, f64::max);
        if is_coarse(Cell {
            centre,
            reach,
            depth,
        }) {
            let along_u = (at(2, 1) - at(0, 1))
                .length()
                .max((at(2, 2) - at(0, 2)).length());
            let along_v = (at(1, 1) - at(1, 0)).length() + (at(2, 2) - at(2, 1)).length();
            let (mid_u, mid_v) = (0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
            if along_u > along_v {
                cells.push(([u[0], mid_u], v, depth + 1));
                cells.push(([mid_u, u[1]], v, depth + 1));
            } else {
                cells.push((u, [v[0], mid_v], depth + 1));
                cells.push((u, [mid_v, v[1]], depth + 1));
            }
            continue;
        }
        let (half_u, half_v) = (0.5 * (u[1] - u[0]), 0.5 * (v[1] - v[0]));
        for &(x, weight_x) in rule {
            for &(y, weight_y) in rule {
                let (direction, measure) =
                    patch.at(u[0] + half_u * (1.0 + x), v[0] + half_v * (1.0 + y));
                if direction.z > 0.0 {
                    let weight = weight_x * weight_y * half_u * half_v * measure;
                    sum = sum + lobe(direction) * weight;
                }
            }
        }
    }
    sum
}

/// Integral over a polygon in a plane, convex or not, as a fan of triangles; its sign is that of the polygon's orientation.
pub fn integrate_polygon<T: Integrand>(
    vertices: &[DVec3],
    peak: Peak,
    lobe: &dyn Fn(DVec3) -> T,
) -> T {
    (1..vertices.len() - 1)
        .map(|i| {
            integrate(
                Triangle([vertices[0], vertices[i], vertices[i + 1]]),
                peak,
                lobe,
            )
        })
        .fold(T::default(), T::add)
}
