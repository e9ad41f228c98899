// Converts the inputs of a fragment shader to the frame that the modules compute in.
//
// Needs: camera, scratched_surface, lit_base.
// Frame of the arguments: the camera's own, which looks along -z, y up, in metres; and the
// object's, turned and scaled by `view_from_object`, with one scale for all axes.

struct PixelFrame {
    view: SurfaceView,              // what scratched_point() takes
    position_view: vec3f,           // the point that the ray through the middle of the pixel meets
    surface_from_view: mat3x3f,     // into the frame of the surface, z along the normal, the viewer in the x-z plane
}

// Rows: z along the normal, the viewer in the x-z plane; any x where they look along the normal.
fn pixel_axes(n: vec3f, direction: vec3f) -> mat3x3f {
    let aside = direction - n * dot(n, direction);
    let any = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(n.x) > 0.7);
    let x = normalize(select(any - n * dot(n, any), aside, dot(aside, aside) > 1e-10));
    return transpose(mat3x3f(x, cross(n, x), n));
}

// `pixel`: how the ray changes over a pixel to the right and down at depth 1; z is 1 for a parallel view. `ray_view`: the ray through the
// middle of the pixel, at depth 1. `move` and `turn`: how position and smooth normal change from one pixel of a quad to the next, along x
// and y: derivatives of the fragment shader.
fn pixel_frame(
    position: vec3f,
    view_from_object: mat3x3f,
    position_view: vec3f,
    normal_view: vec3f,
    pixel: vec3f,
    ray_view: vec2f,
    move_x: vec3f,
    move_y: vec3f,
    turn_x: vec3f,
    turn_y: vec3f,
) -> PixelFrame {
    let is_parallel = pixel.z > 0.5;
    let direction = normalize(select(-position_view, vec3f(0.0, 0.0, 1.0), is_parallel));
    var n = normal_view;
    let cosine = dot(n, direction);
    if cosine < 0.01 {
        let aside = n - direction * cosine;
        n = direction * 0.01 + aside * (0.99995 * inverseSqrt(max(dot(aside, aside), 1e-12)));
    }
    let depth = select(max(-position_view.z, 1e-9), 1.0, is_parallel);
    let ray = select(vec3f(ray_view, -1.0), vec3f(0.0, 0.0, -1.0), is_parallel);
    // Rasterisers put corners on a grid of 1/256 of a pixel, some of 1/16: what they interpolate is that far from the middle of the pixel.
    let axes = pixel_axes(n, direction);
    let right = axes * footprint_axis(ray, depth, n, vec3f(pixel.x, 0.0, 0.0));
    let down = axes * footprint_axis(ray, depth, n, vec3f(0.0, -pixel.y, 0.0));
    let off = axes * (ray * (dot(position_view, n) / dot(ray, n)) - position_view);
    let is_near = dot(off, off) < dot(right, right) + dot(down, down);
    let shift = select(vec3f(0.0), off, is_near && !is_parallel);
    // Bend of the surface, from the quad: it changes less over a pixel than the surface's position does.
    let moves = mat2x2f((axes * move_x).xy, (axes * move_y).xy);
    let turns = mat2x3f(axes * turn_x, axes * turn_y);
    let exact = position_view + transpose(axes) * shift;
    let turned = normalize(n + transpose(axes) * pixel_turn(moves, turns, shift.xy));
    let surface_from_view = pixel_axes(turned, normalize(select(-exact, vec3f(0.0, 0.0, 1.0), is_parallel)));
    // The inverse of a rotation with one scale is the transpose over the square of the scale.
    let scale_sq = dot(view_from_object[0], view_from_object[0]);
    let view = SurfaceView(
        position + transpose(axes * view_from_object) * shift / max(scale_sq, 1e-20),
        surface_from_view * view_from_object,
        surface_from_view * select(-exact, vec3f(0.0, 0.0, 1e3), is_parallel),
        right,
        down,
        pixel_turn(moves, turns, right.xy),
        pixel_turn(moves, turns, down.xy),
    );
    return PixelFrame(view, exact, surface_from_view);
}

// A way in the plane of the surface in steps of the quad, along x and y.
fn pixel_steps(moves: mat2x2f, way: vec2f) -> vec2f {
    let area = determinant(moves);
    let safe = select(area, 1e-30, abs(area) < 1e-30);
    let steps = vec2f(way.x * moves[1].y - way.y * moves[1].x, moves[0].x * way.y - moves[0].y * way.x) / safe;
    return clamp(steps, vec2f(-4.0), vec2f(4.0));
}

fn pixel_turn(moves: mat2x2f, turns: mat2x3f, way: vec2f) -> vec3f {
    return turns * pixel_steps(moves, way);
}

// Ways in steps of the quad, for what a rasteriser interpolates: to the point that the ray through the middle of the pixel meets, and by one pixel to the
// right and down. Facets do not lie as the smooth normal has it, along which pixels are as far apart as these.
fn pixel_ways(here: PixelFrame, position_view: vec3f, move_x: vec3f, move_y: vec3f) -> mat3x2f {
    let turn = here.surface_from_view;
    let moves = mat2x2f((turn * move_x).xy, (turn * move_y).xy);
    return mat3x2f(
        pixel_steps(moves, (turn * (here.position_view - position_view)).xy),
        pixel_steps(moves, here.view.footprint_x_m.xy),
        pixel_steps(moves, here.view.footprint_y_m.xy),
    );
}

// Slopes that the pixel sees, with those of a normal map of a variance in each direction.
fn pixel_slopes(here: PixelFrame, variance: f32) -> PixelSlopes {
    let view = here.view;
    let viewer_m = length(view.to_viewer_m);
    return PixelSlopes(
        SCRATCHED_FILTER_STD * view.turn_x.xy,
        SCRATCHED_FILTER_STD * view.turn_y.xy,
        1e6 * SCRATCHED_FILTER_STD * view.footprint_x_m.xy,
        1e6 * SCRATCHED_FILTER_STD * view.footprint_y_m.xy,
        view.to_viewer_m.z / max(viewer_m, 1e-30),
        viewer_m,
        variance,
    );
}

// The base at the pixel, its lobe as wide as what the pixel sees.
fn pixel_base(
    here: PixelFrame,
    roughness: f32,
    fresnel: FresnelRgb,
    shapes: texture_2d<f32>,
    albedo: texture_2d<f32>,
    curves: texture_2d<f32>,
) -> LitBase {
    return lit_base(normalize(here.view.to_viewer_m), roughness, fresnel, pixel_slopes(here, 0.0), shapes, albedo, curves);
}
