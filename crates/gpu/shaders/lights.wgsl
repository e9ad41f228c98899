// Area lights as seen from a surface point. Needs lights. Twin: reference/src/light_view.rs.

// 1 if a polygon's vertices are seen counter-clockwise, -1 if clockwise, 0 if it shines to the other side.
fn light_facing(point: SurfacePoint, light: Light) -> f32 {
    let distance = dot(light.normal, light_corner_m(light.first_vertex) - point.position_m);
    return select(select(0.0, -1.0, distance > 0.0 && light.two_sided != 0u), 1.0, distance < 0.0);
}

// Vertex `i` of a polygon relative to the point, in the surface's frame; vertices repeat.
fn light_vertex(point: SurfacePoint, light: Light, i: u32) -> vec3f {
    let index = light.first_vertex + select(i, i - light.vertex_count, i >= light.vertex_count);
    return surface_from_world(point, light_corner_m(index) - point.position_m);
}

// The cap of directions that holds a light.
fn light_cap(point: SurfacePoint, light: Light) -> Cap {
    return sphere_cap(surface_from_world(point, light.center_m - point.position_m), light.radius_m);
}
