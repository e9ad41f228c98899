// Area lights as seen from a surface point. Needs lights. Twin: cpu/src/light_view.rs.

fn light_facing(point: SurfacePoint, light: Light) -> f32 {
    return polygon_facing(light.normal, light_corner_m(light.first_vertex) - point.position_m, light.two_sided != 0u);
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
