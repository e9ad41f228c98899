// The plane that stands for what a tile's pixels see, where they see one.

struct TilePlane {
    origin_m: vec3f,
    coherence_um: f32,
    normal: vec3f,
    table: u32,
    holds: bool,                // whether all pixels see it
}

// By how much normals of one plane may differ, rad: light that comes from one direction then goes by a tenth of the band's width
// in another one.
const PLANE_TURN_MAX: f32 = 1e-4;

fn plane_of(point: SurfacePoint) -> TilePlane {
    return TilePlane(point.position_m, point.coherence_um, point.normal, point.table, true);
}

// Whether a pixel sees the plane.
fn plane_holds(plane: TilePlane, point: SurfacePoint) -> bool {
    let apart_m = point.position_m - plane.origin_m;
    return length(point.normal - plane.normal) <= PLANE_TURN_MAX
        && abs(dot(apart_m, plane.normal)) <= 2e-6 * plane.coherence_um + PLANE_TURN_MAX * length(apart_m)
        && point.coherence_um == plane.coherence_um
        && point.table == plane.table;
}

// Whether whoever sees any point of a triangle of the same material sees the plane.
fn plane_holds_triangle(plane: TilePlane, triangle: u32) -> bool {
    let a = vertices[3u * triangle];
    let b = vertices[3u * triangle + 1u];
    let c = vertices[3u * triangle + 2u];
    let geometric = cross(b.position_m - a.position_m, c.position_m - a.position_m);
    // Sheets are seen from either side. Normals on the wrong side of their triangle are bent to the viewer, each in its own way.
    let side = select(1.0, -1.0, dot(geometric, plane.normal) < 0.0);
    return plane_holds_vertex(plane, a, side) && plane_holds_vertex(plane, b, side) && plane_holds_vertex(plane, c, side);
}

fn plane_holds_vertex(plane: TilePlane, vertex: Vertex, side: f32) -> bool {
    return length(side * vertex.normal - plane.normal) <= PLANE_TURN_MAX
        && abs(dot(vertex.position_m - plane.origin_m, plane.normal)) <= 0.25e-6 * plane.coherence_um;
}

// Whether a light in a sphere is all above the plane, or all below it, as seen from each point that the plane stands for.
fn plane_is_clear_of(plane: TilePlane, center_m: vec3f, radius_m: f32) -> bool {
    let apart_m = center_m - plane.origin_m;
    return abs(dot(apart_m, plane.normal)) > radius_m + 2.0 * PLANE_TURN_MAX * (length(apart_m) + radius_m);
}

// 24 bits that planes share only if they are turned the same way, but for chance; 0 for what is no plane.
fn plane_key(normal: vec3f) -> u32 {
    let turned = vec3i(round(normal * (0.5 / PLANE_TURN_MAX)));
    let mixed = (bitcast<vec3u>(turned) + vec3u(1u, 2u, 3u)) * vec3u(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);
    let key = mixed.x ^ ((mixed.y << 11u) | (mixed.y >> 21u)) ^ ((mixed.z << 22u) | (mixed.z >> 10u));
    return max(key >> 8u, 1u);
}
