// A pixel as the scratches under it see it: its footprint in the surface's frame, and how far it reaches.

// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations.
const REACH_STD: f32 = 3.5;
// A segment shows at a point only if their normals agree at least this well.
const FACING_MIN_COS: f32 = 0.2;

// 0 where the pixel is the point in its middle, else 1.
fn gather_filtered() -> f32 {
    return select(1.0, 0.0, METHOD_FOOTPRINT == FOOTPRINT_OFF);
}

// What is the same for all segments under a pixel, in the surface's frame.
struct GatherPixel {
    axis_x_um: vec3f,           // one standard deviation of the pixel's filter to the right and down
    axis_y_um: vec3f,
    covariance_um2: vec3f,      // xx, xy, yy of both
    window_um2: f32,            // the coherence window's variance
    stds: vec4f,                // of the band that a pixel without perspective sees
    turn_rad2: f32,             // variance of a tangent's angle, where one scratch stands for many
    single_share: f32,          // weight of scratches that are looked at one by one
}

fn gather_pixel(point: SurfacePoint) -> GatherPixel {
    let x = surface_from_world(point, point.footprint_x_m) * (1e6 * gather_filtered());
    let y = surface_from_world(point, point.footprint_y_m) * (1e6 * gather_filtered());
    return GatherPixel(
        x,
        y,
        vec3f(x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y),
        0.5 * point.coherence_um * point.coherence_um,
        band_stds(point.coherence_um),
        0.0,
        1.0,
    );
}

// The footprint in the axes of a scratch.
fn gather_footprint(pixel: GatherPixel, tangent: vec2f) -> Footprint {
    let c = pixel.covariance_um2;
    let xx = tangent.x * tangent.x;
    let xy = tangent.x * tangent.y;
    let yy = tangent.y * tangent.y;
    return Footprint(
        max(c.x * yy - 2.0 * c.y * xy + c.z * xx, 0.0),
        max(c.x * xx + 2.0 * c.y * xy + c.z * yy, 0.0),
        (c.z - c.x) * xy + c.y * (xx - yy),
    );
}

// How far a surface may be off the plane of a footprint for each length along it.
const GATHER_BENDS: f32 = 0.125;

// Half the sides of the box around a point that holds every segment with a share there, world space.
fn gather_reach_m(point: SurfacePoint) -> vec3f {
    let sigma_m = point.coherence_um * 1e-6;
    let footprint = point.footprint_x_m * point.footprint_x_m + point.footprint_y_m * point.footprint_y_m;
    let variance = footprint * gather_filtered() + 0.7 * sigma_m * sigma_m;
    // The footprint lies in the plane that shading sees. Scratches lie on triangles: this one leaves it by as much as its normal is
    // another one, its neighbours by about as much again; and where a surface bends elsewhere under a footprint, by a share of its size.
    let leaves = GATHER_BENDS + 2.0 * distance(point.normal, point.facet);
    let aside = leaves * sqrt(variance.x + variance.y + variance.z);
    return REACH_STD * (sqrt(variance) + abs(point.normal) * aside);
}
