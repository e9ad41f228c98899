// The surface under a pixel: position, frame, footprint, material. Twin: cpu/src/surface.rs.
// Needs: pixel_slopes.

const MIN_VIEW_COS: f32 = 0.01;

// A shading point. Its local frame has z along the shading normal and the viewer in the x-z plane. Of a surface under a coat it is that of the
// coat; surface_under_coat() has that of what is under it.
struct SurfacePoint {
    position_m: vec3f,
    axis_x: vec3f,
    axis_y: vec3f,
    normal: vec3f,
    wo: vec3f,                  // unit direction to the viewer in the local frame
    distance_m: f32,            // to the viewer
    footprint_x_um: vec2f,      // one standard deviation of the pixel's filter to the right, in the local frame
    footprint_y_um: vec2f,      // and down
    turn_x: vec2f,              // how the smooth normal, on the viewer's side, turns over each of them, in the local frame
    turn_y: vec2f,
    leaves: f32,                // how far the surface may be off the plane of shading for each length along it
    f0: vec3f,
    f90: f32,                   // reflectance at grazing incidence
    curve: u32,                 // of the reflectance over the angle
    diffuse: vec3f,             // albedo of the body, times the share that is no metal
    metallic: f32,              // share of the surface that is a metal
    roughness: f32,             // perceptual, of the surface between the scratches
    slope_std: f32,             // how far a normal map's slopes spread about the one that is looked up, in each direction
    emission: vec3f,
    coherence_um: f32,
    table: u32,
    open: f32,                  // what of the environment's light reaches the base
    coat: u32,                  // a clear layer over it, see surface_coat()
    coat_slope_std: f32,        // as slope_std, of the layer's own normal map
    under_coat: u32,            // the normal of what is under it, see surface_under_coat()
    long_alpha: f32,            // of facets that lean further one way than across it, that way; 0 where they do not
    long_axis: vec2f,           // that way, a unit vector of the frame of what is under the coat
}

// Largest distance of a surface from the plane of a footprint, over the length along it, where shading and facet normal agree.
const SURFACE_BENDS: f32 = 0.125;

fn surface_from_world(point: SurfacePoint, v: vec3f) -> vec3f {
    return vec3f(dot(v, point.axis_x), dot(v, point.axis_y), dot(v, point.normal));
}

fn world_from_surface(point: SurfacePoint, v: vec3f) -> vec3f {
    return point.axis_x * v.x + point.axis_y * v.y + point.normal * v.z;
}

// Variances of the slopes by which a pixel mirrors a light at 1 / `per_m` metres, and their covariance: pixel_slopes_towards().
fn surface_slope_spread(point: SurfacePoint, per_m: f32) -> vec3f {
    let slopes = PixelSlopes(
        point.turn_x,
        point.turn_y,
        point.footprint_x_um,
        point.footprint_y_um,
        point.wo.z,
        point.distance_m,
        point.slope_std * point.slope_std,
    );
    return pixel_slopes_towards(slopes, per_m);
}

// Beyond this many standard deviations nothing of a footprint is told apart from a Gaussian's tail.
const SURFACE_REACH_STD: f32 = 3.5;

// Half the sides of the box around a point that holds every segment with a share there, world space. Twin: cpu/src/gather.rs.
fn surface_reach_m(point: SurfacePoint) -> vec3f {
    let sigma_m = point.coherence_um * 1e-6;
    let x = 1e-6 * (point.axis_x * point.footprint_x_um.x + point.axis_y * point.footprint_x_um.y);
    let y = 1e-6 * (point.axis_x * point.footprint_y_um.x + point.axis_y * point.footprint_y_um.y);
    let variance = x * x + y * y + 0.7 * sigma_m * sigma_m;
    let aside = point.leaves * sqrt(variance.x + variance.y + variance.z);
    return SURFACE_REACH_STD * (sqrt(variance) + abs(point.normal) * aside);
}

// v of unit length, or `otherwise` where v has none.
fn surface_normalize_or(v: vec3f, otherwise: vec3f) -> vec3f {
    let length2 = dot(v, v);
    return select(otherwise, v * inverseSqrt(max(length2, 1e-37)), length2 > 1e-30);
}

// A unit vector across the unit vector n. Tom Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
fn surface_any_across(n: vec3f) -> vec3f {
    let s = select(1.0, -1.0, n.z < 0.0);
    let a = -1.0 / (s + n.z);
    return vec3f(1.0 + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x);
}

// Barycentric coordinates of the second and third vertex, where the ray's line meets the triangle's plane.
// T. Moeller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
fn surface_barycentric(origin: vec3f, ray: vec3f, a: vec3f, b: vec3f, c: vec3f) -> vec2f {
    let e1 = b - a;
    let e2 = c - a;
    let p = cross(ray, e2);
    let determinant = dot(e1, p);
    let s = origin - a;
    let q = cross(s, e1);
    let safe = select(determinant, 1e-37, abs(determinant) < 1e-37);
    // The rasteriser covers pixels up to a rounding beyond the edge.
    return clamp(vec2f(dot(s, p), dot(ray, q)) / safe, vec2f(-0.5), vec2f(1.5));
}

// Bends a normal that the viewer cannot see until its cosine is MIN_VIEW_COS.
fn surface_face_viewer(normal: vec3f, to_viewer: vec3f) -> vec3f {
    let cos_view = dot(normal, to_viewer);
    if cos_view >= MIN_VIEW_COS {
        return normal;
    }
    let tangential = surface_normalize_or(normal - to_viewer * cos_view, surface_any_across(to_viewer));
    return to_viewer * MIN_VIEW_COS + tangential * sqrt(1.0 - MIN_VIEW_COS * MIN_VIEW_COS);
}

// The level of a texture whose filter is `footprint` wide in texture space.
fn surface_texture_lod(footprint: f32, size: vec2u, levels: u32) -> f32 {
    let texels = footprint * sqrt(f32(size.x) * f32(size.y));
    return clamp(log2(max(2.0 * texels, 1e-6)), 0.0, f32(levels - 1u));
}
