// How the slope that mirrors a light to the viewer changes over a pixel. Twin: PixelSlopes of optics/src/filtered_lobe.rs.

struct PixelSlopes {
    turn_x: vec2f,              // turns of the normal over one standard deviation of the pixel's filter to the right, in the plane of view and
    turn_y: vec2f,              // normal (x) and across it (y); and down
    step_x_um: vec2f,           // movements of the point over these
    step_y_um: vec2f,
    cos_o: f32,                 // of the view
    viewer_m: f32,              // distance
    variance: f32,              // of the slopes of a normal map, in each direction
}

const PIXEL_SLOPES_MIN_COS: f32 = 0.01;

// Variances of the slopes for a light at 1 / `per_m` metres, in the plane and across it; their covariance.
fn pixel_slopes_towards(slopes: PixelSlopes, per_m: f32) -> vec3f {
    let cos_o = max(slopes.cos_o, PIXEL_SLOPES_MIN_COS);
    let per_step = 5e-7 * (1.0 / max(slopes.viewer_m, 1e-6) + per_m) * vec2f(cos_o, 1.0 / cos_o);
    let x = slopes.turn_x + per_step * slopes.step_x_um;
    let y = slopes.turn_y + per_step * slopes.step_y_um;
    return vec3f(x * x + y * y + slopes.variance, x.x * x.y + y.x * y.y);
}

// One over the distance of a light from the point, held at its radius or above: of a sphere that holds it.
fn light_per_distance(center_m: vec3f, radius_m: f32) -> f32 {
    return 1.0 / max(max(length(center_m), radius_m), 1e-30);
}
