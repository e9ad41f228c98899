// The method of 2018, kept to be compared with: a triangular light on the band's middle line. Twin:
// src/polygon.rs, which explains the steps.
// Needs: published_segments.

const CULL_SLACK: f32 = 1e-6;
const CULLED: f32 = 2.0;

// A triangle above the horizon: 0, 3 or 4 unit directions, in order.
struct ClippedTriangle {
    count: u32,
    corners: array<vec3f, 4>,
}

// The unit vector along v, or zero, for lengths that a square would not survive.
fn published_unit(v: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if !(largest > 0.0) {
        return vec3f(0.0);
    }
    let w = v / largest;
    return w * inverseSqrt(dot(w, w));
}

// Step 1, clip to the upper hemisphere. Corners are relative to the point, z along the normal. The triangles of the result
// are corners 0, i - 1 and i, for i from 2 up to its count.
fn clip_triangle(corners: array<vec3f, 3>) -> ClippedTriangle {
    let above = vec3<bool>(corners[0].z >= 0.0, corners[1].z >= 0.0, corners[2].z >= 0.0);
    let a = published_unit(corners[0]);
    let b = published_unit(corners[1]);
    let c = published_unit(corners[2]);
    if all(above) {
        return ClippedTriangle(3u, array<vec3f, 4>(a, b, c, vec3f(0.0)));
    }
    let ab = horizon_crossing(corners[0], corners[1]);
    let bc = horizon_crossing(corners[1], corners[2]);
    let ca = horizon_crossing(corners[2], corners[0]);
    // Case by case and not corner by corner, so that they stay in registers.
    if above.x {
        if above.y {
            return ClippedTriangle(4u, array<vec3f, 4>(a, b, bc, ca));
        }
        if above.z {
            return ClippedTriangle(4u, array<vec3f, 4>(a, ab, bc, c));
        }
        return ClippedTriangle(3u, array<vec3f, 4>(a, ab, ca, vec3f(0.0)));
    }
    if above.y {
        if above.z {
            return ClippedTriangle(4u, array<vec3f, 4>(ab, b, c, ca));
        }
        return ClippedTriangle(3u, array<vec3f, 4>(ab, b, bc, vec3f(0.0)));
    }
    if above.z {
        return ClippedTriangle(3u, array<vec3f, 4>(bc, c, ca, vec3f(0.0)));
    }
    return ClippedTriangle(0u, array<vec3f, 4>());
}

// Direction to where an edge with one end below the horizon meets it.
fn horizon_crossing(a: vec3f, b: vec3f) -> vec3f {
    let fall = a.z - b.z;
    let crossing = a + (b - a) * (a.z / select(fall, 1.0, fall == 0.0));
    return published_unit(vec3f(crossing.xy, 0.0));
}

// Inward unit normal of the plane through the edge from a to b and the point; `side` 1 or -1 by the triangle's sense.
fn edge_plane(a: vec3f, b: vec3f, side: f32) -> vec3f {
    return side * published_unit(cross(a, b - a));
}

// Steps 3 and 4: where the line at x meets one edge within the triangle, CULLED where it does not.
fn edge_places(x: f32, plane: vec3f, other: vec3f, another: vec3f) -> vec2f {
    let extent2 = plane.y * plane.y + plane.z * plane.z;
    let s2 = extent2 - x * x;
    if s2 <= 0.0 {
        return vec2f(CULLED);
    }
    let s = sqrt(s2) / extent2;
    let middle = -plane.x * x / extent2;
    let y = middle * plane.y + vec2f(-s, s) * plane.z;
    let z = middle * plane.z + vec2f(s, -s) * plane.y;
    let inside = min(
        z,
        min(other.x * x + other.y * y + other.z * z, another.x * x + another.y * y + another.z * z),
    );
    return select(vec2f(CULLED), y, inside >= vec2f(-CULL_SLACK));
}

// Segments of the line that a triangle above the horizon covers; `wo` and the corners, unit directions, in the scratch's
// frame.
fn triangle_segments(wo: vec3f, a: vec3f, b: vec3f, c: vec3f) -> BandSegments {
    var segments: BandSegments;
    let x = -wo.x;
    // 2 Project: edges are arcs.
    let volume = dot(a, cross(b - a, c - a));
    if volume == 0.0 {
        return segments;
    }
    let side = sign(volume);
    let ab = edge_plane(a, b, side);
    let bc = edge_plane(b, c, side);
    let ca = edge_plane(c, a, side);
    // 3 Intersect. 4 Cull.
    let on_ab = edge_places(x, ab, bc, ca);
    let on_bc = edge_places(x, bc, ca, ab);
    let on_ca = edge_places(x, ca, ab, bc);
    // 5 Sort and assemble. An odd count is a corner found twice.
    let places = bitonic_sort(vec4f(on_ab, on_bc), vec4f(on_ca, vec2f(CULLED)));
    let low = places.low;
    let high = places.high;
    if low.y < CULLED {
        let three = low.z < CULLED && low.w == CULLED;
        push_segment(&segments, wo.y + low.x, wo.y + select(low.y, low.z, three));
    }
    if low.w < CULLED {
        let five = high.x < CULLED && high.y == CULLED;
        push_segment(&segments, wo.y + low.z, wo.y + select(low.w, high.x, five));
    }
    if high.y < CULLED {
        push_segment(&segments, wo.y + high.x, wo.y + high.y);
    }
    return segments;
}

// Eight numbers in order.
struct SortedPlaces {
    low: vec4f,
    high: vec4f,
}

// Each number against its partner: the lower of the two where `highest` is false, else the higher.
fn bitonic_round(v: vec4f, partner: vec4f, highest: vec4<bool>) -> vec4f {
    return select(min(v, partner), max(v, partner), highest);
}

// Ascending, by Batcher's bitonic network: six rounds.
fn bitonic_sort(first: vec4f, second: vec4f) -> SortedPlaces {
    let inner = vec4<bool>(false, true, false, true);
    let outer = vec4<bool>(false, false, true, true);
    // Blocks of two, up and down by turns.
    let by_turns = vec4<bool>(false, true, true, false);
    var a = bitonic_round(first, first.yxwz, by_turns);
    var b = bitonic_round(second, second.yxwz, by_turns);
    // Blocks of four, the first up, the second down.
    a = bitonic_round(a, a.zwxy, outer);
    a = bitonic_round(a, a.yxwz, inner);
    b = bitonic_round(b, b.zwxy, !outer);
    b = bitonic_round(b, b.yxwz, !inner);
    // All eight.
    var low = min(a, b);
    var high = max(a, b);
    low = bitonic_round(low, low.zwxy, outer);
    low = bitonic_round(low, low.yxwz, inner);
    high = bitonic_round(high, high.zwxy, outer);
    high = bitonic_round(high, high.yxwz, inner);
    return SortedPlaces(low, high);
}
