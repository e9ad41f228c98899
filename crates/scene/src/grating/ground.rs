//! The triangle that gratings are looked at on, with its pictures, and directions by texture coordinates. Twin:
//! groove_ground.wgsl.

use glam::{DVec2, DVec3};
use hairline_model::mesh::Mesh;
use hairline_model::texture::Texture;
use hairline_model::texture_lookup::texture_footprint;

use crate::picture_lie::{PictureLie, three_sides};

/// A picture on the surface of a grating.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroovePicture {
    /// Index of the texture in the scene.
    pub texture: usize,
    /// Mapping of the picture onto the surface.
    pub lie: PictureLie,
}

/// A direction by texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvField {
    /// Whether the grooves run along the second coordinate, in place of the first.
    pub along_v: bool,
    /// A picture (linear) of the scene's that turns it: red and green are the parts along the tangent and the bitangent, from -1 to 1.
    pub directions: Option<usize>,
}

/// Direction and numbering of grooves about a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct GrooveCourse {
    /// The direction there, of any length.
    pub here: DVec3,
    /// Change of the direction over one standard deviation of the pixel's filter to the right and down.
    pub steps: [DVec3; 2],
    /// Texture coordinate that stays the same along a groove, in turns of the texture, and its gradient: grooves are numbered by it.
    pub level: f64,
    pub level_per_m: DVec3,
}

/// A triangle of an object.
#[derive(Clone, Copy, Debug)]
pub struct GrooveGround<'a> {
    /// Textures of the scene.
    pub textures: &'a [Texture],
    /// Mesh of the object.
    pub mesh: &'a Mesh,
    /// Index in [`Mesh::triangles`].
    pub triangle: u32,
}

impl GrooveGround<'_> {
    fn corners(&self) -> [usize; 3] {
        self.mesh.triangles[self.triangle as usize].map(|corner| corner as usize)
    }

    fn corners_m(&self) -> [DVec3; 3] {
        self.mesh.corners_m(self.triangle as usize)
    }

    /// Derivatives of the weights of the second and the third corner along a step.
    fn weights_along(&self, step_m: DVec3) -> [f64; 2] {
        let [a, b, c] = self.corners_m();
        let (e1, e2) = (b - a, c - a);
        let geometric = e1.cross(e2);
        let area2 = geometric.length_squared();
        [
            step_m.cross(e2).dot(geometric) / area2,
            e1.cross(step_m).dot(geometric) / area2,
        ]
    }

    /// The weights of the corners at a point of the plane.
    fn weights(&self, point_m: DVec3) -> [f64; 3] {
        let [b, c] = self.weights_along(point_m - self.corners_m()[0]);
        [1.0 - b - c, b, c]
    }

    /// The place of a texture, and the edges of the triangle there.
    fn uv(&self, point_m: DVec3) -> (DVec2, [DVec2; 2]) {
        let [a, b, c] = self.corners().map(|i| self.mesh.uvs[i].as_dvec2());
        let [at_a, at_b, at_c] = self.weights(point_m);
        (a * at_a + b * at_b + c * at_c, [b - a, c - a])
    }

    /// The side of a pixel's filter in texture space.
    fn filter_side(&self, [e1, e2]: [DVec2; 2], axes_m: [DVec3; 2]) -> f64 {
        texture_footprint(e1.perp_dot(e2).abs(), &self.corners_m(), axes_m)
    }

    /// The mean of a picture over a pixel: that of its red.
    pub(super) fn picture_share(
        &self,
        picture: &GroovePicture,
        point_m: DVec3,
        axes_m: [DVec3; 2],
    ) -> f64 {
        let texture = &self.textures[picture.texture];
        match picture.lie {
            PictureLie::ByUv => {
                let (uv, edges) = self.uv(point_m);
                let side = self.filter_side(edges, axes_m);
                texture.filtered(uv, side, Texture::at_level).x
            }
            PictureLie::FromThreeSides { tiles_from_world } => {
                let normals = self.corners().map(|i| self.mesh.normals[i].as_dvec3());
                let weights = self.weights(point_m);
                let normal: DVec3 = (0..3).map(|i| normals[i] * weights[i]).sum();
                let (uvs, shares) = three_sides(&tiles_from_world, point_m, normal);
                let [right, down] = axes_m.map(|axis| tiles_from_world.transform_vector3(axis));
                let side = right.cross(down).length().sqrt();
                let seen = (0..3).filter(|&i| shares[i] > 0.0);
                seen.map(|i| shares[i] * texture.filtered(uvs[i], side, Texture::at_level).x)
                    .sum()
            }
        }
    }

    /// Course of grooves that run by texture coordinates.
    pub(super) fn course(
        &self,
        field: &UvField,
        point_m: DVec3,
        normal: DVec3,
        axes_m: [DVec3; 2],
    ) -> GrooveCourse {
        let (_, edges) = self.uv(point_m);
        let along = |step_m| self.direction(field, point_m + step_m, normal, edges, axes_m);
        let [u, v] = [DVec2::X, DVec2::Y].map(|of| {
            // Gradient in the triangle's plane: changes of the weights along each axis.
            let part = |axis: DVec3| {
                let [b, c] = self.weights_along(axis);
                of.dot(edges[0] * b + edges[1] * c)
            };
            DVec3::new(part(DVec3::X), part(DVec3::Y), part(DVec3::Z))
        });
        let (uv, _) = self.uv(point_m);
        let (level, level_per_m) = if field.along_v { (uv.x, u) } else { (uv.y, v) };
        GrooveCourse {
            here: along(DVec3::ZERO),
            steps: axes_m.map(|axis| along(0.5 * axis) - along(-0.5 * axis)),
            level,
            // Directions of a picture follow no level.
            level_per_m: match field.directions {
                Some(_) => DVec3::ZERO,
                None => level_per_m,
            },
        }
    }

    /// The direction at a point of the plane; not a unit vector.
    fn direction(
        &self,
        field: &UvField,
        point_m: DVec3,
        normal: DVec3,
        edges: [DVec2; 2],
        axes_m: [DVec3; 2],
    ) -> DVec3 {
        let corners = self.corners();
        let tangents = corners.map(|i| self.mesh.tangents[i].as_dvec4());
        let weights = self.weights(point_m);
        let tangent: DVec3 = (0..3).map(|i| tangents[i].truncate() * weights[i]).sum();
        let tangent = tangent - normal * normal.dot(tangent);
        // Either side of a sheet shows the same grooves.
        let [a, b, c] = self.corners_m();
        let outward = if (b - a).cross(c - a).dot(normal) < 0.0 {
            -normal
        } else {
            normal
        };
        let bitangent = outward.cross(tangent) * tangents[0].w;
        let mut way = DVec2::X;
        if let Some(directions) = field.directions {
            let (uv, _) = self.uv(point_m);
            let side = self.filter_side(edges, axes_m);
            let texel = self.textures[directions].filtered(uv, side, Texture::at_level);
            way = DVec2::new(2.0 * texel.x - 1.0, 2.0 * texel.y - 1.0);
        }
        if field.along_v {
            way = way.perp();
        }
        tangent * way.x + bitangent * way.y
    }
}
