// Area lights as seen from a surface point. Needs lights. Twin: cpu/src/light_view.rs.
// Needs: rows, contents, surface_point, outline_light.

// The cap of directions that holds a light.
fn light_cap(point: SurfacePoint, light: Light) -> Cap {
    return sphere_cap(surface_from_world(point, light.center_m - point.position_m), light.radius_m);
}

fn light_per_m(light: Light, position_m: vec3f) -> f32 {
    return light_per_distance(light.center_m - position_m, light.radius_m);
}

// A light with an outline, for its look by a scratch. Whether it is a tube may be known where a pass is compiled.
fn outline_light(light: Light, is_tube: bool) -> OutlineLight {
    return OutlineLight(light_vertex_texel(light.first_vertex), light.vertex_count, light.normal, light.two_sided != 0u, is_tube);
}

// A light with an outline in the frame of a surface.
fn surface_outline(point: SurfacePoint, light: Light) -> OutlineView {
    let surface = mat3x3f(point.axis_x, point.axis_y, point.normal);
    return outline_view(lights, outline_light(light, light_is_tube(light)), point.position_m, surface, vec2f(1.0, 0.0));
}
