//! Places of a part's triangles in its maps.

use glam::{DVec2, DVec3, Vec2};
use hairline_scene::Mesh;

/// Largest share of texels on which more than one triangle may lie.
const LARGEST_OVERLAP: f64 = 0.01;
/// Least weight of a corner inside of a triangle. Neighbours share their edges, which are as wide.
const INSIDE: f64 = 1e-6;
/// Largest number of maps that a triangle may reach over, in one direction.
const MOST_MAPS: f64 = 1.01;

/// The triangles of one material in maps that repeat.
pub(super) struct Atlas<'a> {
    pub mesh: &'a Mesh,
    material: u32,
    /// Whether [`Mesh::other_uvs`] are used.
    pub by_other_uvs: bool,
    /// Texels of a side.
    pub size: usize,
    /// The triangle on which the middle of a texel lies, row by row.
    triangles: Vec<Option<u32>>,
}

/// A triangle in the maps.
pub(super) struct Placed {
    corners_m: [DVec3; 3],
    corners: [DVec2; 3],
}

impl<'a> Atlas<'a> {
    /// By the first set of texture coordinates that do not overlap; or what is wrong with the first set.
    pub(super) fn new(mesh: &'a Mesh, material: u32, size_px: u32) -> Result<Self, String> {
        let size = size_px as usize;
        let with = |by_other_uvs: bool| {
            let mut atlas = Self {
                mesh,
                material,
                by_other_uvs,
                size,
                triangles: vec![None; size * size],
            };
            atlas.fill().map(|()| atlas)
        };
        with(false).or_else(|why| with(true).map_err(|_| why))
    }

    /// Numbers of the part's triangles.
    fn own(&self) -> impl Iterator<Item = u32> + use<'a> {
        let material = self.material;
        let all = (0..).zip(&self.mesh.triangle_materials);
        all.filter(move |(_, it)| **it == material)
            .map(|(triangle, _)| triangle)
    }

    fn fill(&mut self) -> Result<(), String> {
        let (mut filled, mut shared) = (0_usize, 0_usize);
        for triangle in self.own() {
            let placed = self.placed(triangle);
            let (low, high) = placed.bounds();
            if (high - low).max_element() > MOST_MAPS * self.size as f64 {
                return Err("has triangles that repeat their textures".to_owned());
            }
            let (low, high) = ((low - 0.5).ceil(), (high - 0.5).floor());
            for y in low.y as i64..=high.y as i64 {
                for x in low.x as i64..=high.x as i64 {
                    let weights = placed.weights(DVec2::new(x as f64, y as f64) + 0.5);
                    let inside = weights.min_element();
                    // Written so that a NaN is outside too.
                    if !(inside > -INSIDE) {
                        continue;
                    }
                    let texel = self.texel(x, y);
                    match self.triangles[texel] {
                        Some(_) if inside < INSIDE => {}
                        Some(_) => shared += 1,
                        None => {
                            self.triangles[texel] = Some(triangle);
                            filled += 1;
                        }
                    }
                }
            }
        }
        if filled == 0 {
            return Err("has no texture coordinates".to_owned());
        }
        let share = shared as f64 / (filled + shared) as f64;
        match share > LARGEST_OVERLAP {
            true => Err(format!(
                "has texture coordinates of which {:.0} % lie on one another",
                100.0 * share
            )),
            false => Ok(()),
        }
    }

    /// Number of a texel of the endless map.
    pub(super) fn texel(&self, x: i64, y: i64) -> usize {
        let side = self.size as i64;
        (y.rem_euclid(side) * side + x.rem_euclid(side)) as usize
    }

    /// Number of the texel at a place of the endless map, or beside it where no triangle lies on its middle.
    pub(super) fn covered_texel(&self, x: i64, y: i64) -> Option<usize> {
        let steps = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)];
        let corners = [(1, 1), (-1, 1), (1, -1), (-1, -1)];
        let mut near = steps.into_iter().chain(corners);
        near.find_map(|(dx, dy)| {
            let texel = self.texel(x + dx, y + dy);
            self.triangles[texel].map(|_| texel)
        })
    }

    /// The triangle on which the middle of a texel lies, and the weights of its corners there.
    pub(super) fn surface(&self, texel: usize) -> Option<(u32, DVec3)> {
        let triangle = self.triangles[texel]?;
        let placed = self.placed(triangle);
        let at = DVec2::new((texel % self.size) as f64, (texel / self.size) as f64) + 0.5;
        // Of the maps side by side, the one that the triangle reaches into.
        let side = self.size as f64;
        let (low, _) = placed.bounds();
        let at = at + ((low - at) / side).ceil() * side;
        Some((triangle, placed.weights(at)))
    }

    /// Whether a triangle is of the part.
    pub(super) fn is_own(&self, triangle: u32) -> bool {
        self.mesh.triangle_materials[triangle as usize] == self.material
    }

    /// A triangle's places.
    pub(super) fn placed(&self, triangle: u32) -> Placed {
        let uvs = match self.by_other_uvs {
            true => &self.mesh.other_uvs,
            false => &self.mesh.uvs,
        };
        let corner = |v: u32| uvs.get(v as usize).copied().unwrap_or(Vec2::ZERO);
        let corners = self.mesh.triangles[triangle as usize].map(corner);
        Placed {
            corners_m: self.mesh.corners_m(triangle as usize),
            corners: corners.map(|uv| uv.as_dvec2() * self.size as f64),
        }
    }
}

impl Placed {
    fn bounds(&self) -> (DVec2, DVec2) {
        let [a, b, c] = self.corners;
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// Weights of the corners at a place of the map; not numbers where the triangle has no area there.
    fn weights(&self, at: DVec2) -> DVec3 {
        let [a, b, c] = self.corners;
        let area = (b - a).perp_dot(c - a);
        let second = (at - a).perp_dot(c - a) / area;
        let third = (b - a).perp_dot(at - a) / area;
        DVec3::new(1.0 - second - third, second, third)
    }

    /// Steps on the surface along which the place in the map goes a texel to the right, and down.
    fn texel_steps_m(&self) -> [DVec3; 2] {
        let [a, b, c] = self.corners;
        let [a_m, b_m, c_m] = self.corners_m;
        let (along, across) = (b - a, c - a);
        let area = along.perp_dot(across);
        let right = (b_m - a_m) * across.y - (c_m - a_m) * along.y;
        let down = (c_m - a_m) * along.x - (b_m - a_m) * across.x;
        [right / area, down / area]
    }

    /// The area of the surface under a texel.
    pub(super) fn texel_area_m2(&self) -> f64 {
        let [right, down] = self.texel_steps_m();
        right.cross(down).length()
    }

    /// The way that a straight piece on the triangle takes in the map.
    pub(super) fn in_map(&self, ends_m: [DVec3; 2]) -> [DVec2; 2] {
        let [a_m, b_m, c_m] = self.corners_m;
        let (e1, e2) = (b_m - a_m, c_m - a_m);
        let across = e1.cross(e2);
        let [a, b, c] = self.corners;
        ends_m.map(|end_m| {
            let step = end_m - a_m;
            let second = step.cross(e2).dot(across);
            let third = e1.cross(step).dot(across);
            a + ((b - a) * second + (c - a) * third) / across.length_squared()
        })
    }

    /// The axes of normal maps about a normal: along the map's rows, and up.
    pub(super) fn frame(&self, normal: DVec3) -> [DVec3; 2] {
        let [right, down] = self.texel_steps_m();
        let tangent =
            (right - normal * normal.dot(right)).normalize_or(normal.any_orthonormal_vector());
        let bitangent = normal.cross(tangent);
        let is_mirrored = bitangent.dot(down) > 0.0;
        [tangent, if is_mirrored { -bitangent } else { bitangent }]
    }
}
