// The plane that stands for what a tile's pixels see, where they see one.

struct TilePlane {
    origin_m: vec3f,
    coherence_um: f32,
    axis_x: vec3f,
    table: u32,
    axis_y: vec3f,
    holds: u32,                 // 1 where all pixels see the plane
}

// Texels that it is kept in.
const PLANE_TEXELS: u32 = 3u;

// By how much normals of one plane may differ, rad: light that comes from one direction then goes by a tenth of the band's width
// in another one.
const PLANE_TURN_MAX: f32 = 1e-4;

fn plane_of(point: SurfacePoint) -> TilePlane {
    return TilePlane(point.position_m, point.coherence_um, point.axis_x, point.table, point.axis_y, 1u);
}

// Whether a pixel sees the plane.
fn plane_holds(plane: TilePlane, point: SurfacePoint) -> bool {
    let normal = cross(plane.axis_x, plane.axis_y);
    let apart_m = point.position_m - plane.origin_m;
    return length(point.normal - normal) <= PLANE_TURN_MAX
        && abs(dot(apart_m, normal)) <= 2e-6 * plane.coherence_um + PLANE_TURN_MAX * length(apart_m)
        && point.coherence_um == plane.coherence_um
        && point.table == plane.table;
}

// Where a point lies on the plane, um.
fn plane_from_world(plane: TilePlane, position_m: vec3f) -> vec2f {
    let apart_m = position_m - plane.origin_m;
    return vec2f(dot(apart_m, plane.axis_x), dot(apart_m, plane.axis_y)) * 1e6;
}

fn plane_texel(plane: TilePlane, i: u32) -> vec4u {
    if i == 0u {
        return bitcast<vec4u>(vec4f(plane.origin_m, plane.coherence_um));
    }
    let axis = bitcast<vec3u>(select(plane.axis_y, plane.axis_x, i == 1u));
    return vec4u(axis, select(plane.holds, plane.table, i == 1u));
}

fn plane_from_texels(a: vec4u, b: vec4u, c: vec4u) -> TilePlane {
    return TilePlane(bitcast<vec3f>(a.xyz), bitcast<f32>(a.w), bitcast<vec3f>(b.xyz), b.w, bitcast<vec3f>(c.xyz), c.w);
}
