// The triangles of a scene along a ray. Twins: index/src/triangle_index.rs, and src/triangle_tree.rs, which says how the tree lies in its
// texture. A walk needs no stack: nodes lie in depth-first order, and each one knows which comes next if nothing below it counts.
// Needs: texels, surface_point.

struct TriangleHit {
    distance_m: f32,            // along the unit direction
    triangle: u32,              // of the scene, + 1; 0: nothing
    object: u32,
    barycentric: vec2f,         // of the second and third vertex
}

// A ray ready to be held against boxes and triangles.
struct TreeRay {
    origin_m: vec3f,
    direction: vec3f,           // unit
    per_direction: vec3f,
    // Two unit vectors across the direction.
    right: vec3f,
    up: vec3f,
}

// Slab tests divide by the direction.
const TREE_LEAST_COS: f32 = 1e-20;
// Relative rounding error of the end of a box: divisions are off by some steps of single precision.
const TREE_SLACK: f32 = 1.000001;

fn tree_ray(origin_m: vec3f, direction: vec3f) -> TreeRay {
    let least = select(vec3f(TREE_LEAST_COS), vec3f(-TREE_LEAST_COS), direction < vec3f(0.0));
    let right = surface_any_across(direction);
    return TreeRay(
        origin_m,
        direction,
        1.0 / select(direction, least, abs(direction) < vec3f(TREE_LEAST_COS)),
        right,
        cross(direction, right),
    );
}

// Signed area of a triangle with the ray, twice.
fn tree_side(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// The hit of a triangle, if it is nearer. Corners are projected along the ray, so that neighbours agree about their edge: S. Woop,
// C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", 2013. What has no area is not met; no comparison holds for what is
// not a number.
fn tree_nearer(tree: texture_2d<u32>, texel: u32, ray: TreeRay, but: u32, nearest: TriangleHit) -> TriangleHit {
    let first = textureLoad(tree, row_texel(texel), 0);
    let second = textureLoad(tree, row_texel(texel + 1u), 0);
    let a_m = bitcast<vec3f>(first.xyz) - ray.origin_m;
    let b_m = bitcast<vec3f>(second.xyz) - ray.origin_m;
    let c_m = bitcast<vec3f>(textureLoad(tree, row_texel(texel + 2u), 0).xyz) - ray.origin_m;
    let a = vec2f(dot(a_m, ray.right), dot(a_m, ray.up));
    let b = vec2f(dot(b_m, ray.right), dot(b_m, ray.up));
    let c = vec2f(dot(c_m, ray.right), dot(c_m, ray.up));
    let sides = vec3f(tree_side(b, c), tree_side(c, a), tree_side(a, b));
    let whole = sides.x + sides.y + sides.z;
    let inside = all(sides >= vec3f(0.0)) || all(sides <= vec3f(0.0));
    let weights = sides / select(whole, 1.0, whole == 0.0);
    let distance_m = dot(weights, vec3f(dot(a_m, ray.direction), dot(b_m, ray.direction), dot(c_m, ray.direction)));
    if inside && whole != 0.0 && distance_m > 0.0 && distance_m < nearest.distance_m && first.w != but {
        return TriangleHit(distance_m, first.w, second.w, weights.yz);
    }
    return nearest;
}

// Hit of the ray before `limit_m`, on either side of a triangle, but not on the one of number `but` (+ 1): the nearest, or the first that is
// found.
fn tree_hit(tree: texture_2d<u32>, ray: TreeRay, limit_m: f32, but: u32, first_met: bool) -> TriangleHit {
    var hit = TriangleHit(limit_m, 0u, 0u, vec2f(0.0));
    // The root's next is the end of all; 0 of a scene without triangles.
    let end = textureLoad(tree, row_texel(0u), 0).w;
    var at = 0u;
    while at < end {
        let low = textureLoad(tree, row_texel(2u * at), 0);
        let high = textureLoad(tree, row_texel(2u * at + 1u), 0);
        // Never so; but lanes that are done go on with zeros on a software driver, for as long as it lets them.
        if low.w <= at {
            break;
        }
        let a = (bitcast<vec3f>(low.xyz) - ray.origin_m) * ray.per_direction;
        let b = (bitcast<vec3f>(high.xyz) - ray.origin_m) * ray.per_direction;
        let enters = min(a, b);
        let leaves = max(a, b);
        let enter = max(max(enters.x, enters.y), max(enters.z, 0.0));
        let leave = min(min(leaves.x, leaves.y), leaves.z) * TREE_SLACK;
        if enter <= min(leave, hit.distance_m) {
            let count = high.w >> TREE_FIRST_BITS;
            let first = high.w & ((1u << TREE_FIRST_BITS) - 1u);
            for (var i = 0u; i < count; i += 1u) {
                hit = tree_nearer(tree, first + 3u * i, ray, but, hit);
            }
            if first_met && hit.triangle != 0u {
                break;
            }
            at += 1u;
        } else {
            at = low.w;
        }
    }
    return hit;
}

// Bits of a leaf that hold the texel of its first triangle; those above hold how many there are. Twin: src/triangle_tree.rs.
const TREE_FIRST_BITS: u32 = 28u;
