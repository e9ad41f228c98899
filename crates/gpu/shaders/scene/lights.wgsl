// Area lights as seen from a surface point. Needs lights. Twin: cpu/src/light_view.rs.

// The outline of a light with corners.
struct LightOutline {
    facing: f32,                // see polygon_facing
    tube: TubeOutline,          // of a tube; in the surface's frame
}

fn light_outline(point: SurfacePoint, light: Light) -> LightOutline {
    var outline: LightOutline;
    if light_is_tube(light) {
        let a = light_end_m(light.first_vertex);
        let b = light_end_m(light.first_vertex + 1u);
        outline.tube = tube_outline(
            surface_from_world(point, a.xyz - point.position_m),
            surface_from_world(point, b.xyz - point.position_m),
            a.w,
        );
        outline.facing = f32(outline.tube.seen);
    } else {
        let a = light_corner_m(light.first_vertex) - point.position_m;
        outline.facing = polygon_facing(light.normal, a, light.two_sided != 0u);
    }
    return outline;
}

// Vertex `i` of an outline relative to the point, in the surface's frame; vertices repeat.
fn light_vertex(point: SurfacePoint, light: Light, outline: LightOutline, i: u32) -> vec3f {
    let at = select(i, i - light.vertex_count, i >= light.vertex_count);
    var vertex: vec3f;
    if light_is_tube(light) {
        vertex = tube_corner(outline.tube, at);
    } else {
        vertex = surface_from_world(point, light_corner_m(light.first_vertex + at) - point.position_m);
    }
    return vertex;
}

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
