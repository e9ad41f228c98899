//! A point of a surface on a ray.

/// Intersection of a ray with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index into [`Scene::objects`](hairline_scene::Scene::objects).
    pub object: u32,
    /// Index into the object's triangles.
    pub triangle: u32,
    /// Distance along the unit direction.
    pub distance_m: f64,
    /// Barycentric coordinates of the second and third vertex.
    pub barycentric: [f64; 2],
}
