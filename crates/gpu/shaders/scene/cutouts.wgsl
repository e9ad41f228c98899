// Cutouts: parts of triangles where their surface is not. Twins: model/src/texture_lookup.rs, index/src/cutouts.rs.
// Needs: scene, coverage.

// Layers of cut-out surfaces that a ray goes through; at the next one it ends.
const CUTOUT_LAYERS: u32 = 64u;

// The alpha of a material at a place of its texture.
fn cutout_alpha(material: Material, uv: vec2f, other_uv: vec2f) -> f32 {
    var alpha = material.alpha;
    if HAS_TEXTURES && scene_has_texture(material.base_color_texture) {
        let map = material.base_color_texture;
        alpha *= scene_texture_level(map, 0u, select(uv, other_uv, scene_by_other_uv(map)), 0.0).w;
    }
    return alpha;
}

// Whether a ray meets the surface where it meets its triangle: of those that cover a part of what lies behind them, any of the object
// `only` (+ 1) and no other; with 0 by chance.
fn cutout_is_there(hit: TriangleHit, only: u32, key: u32) -> bool {
    let triangle = hit.triangle - 1u;
    let a = vertices[3u * triangle];
    let material = material_at(a.material & ~VERTEX_BITANGENT_FLIPPED);
    if material.threshold < 0.0 {
        return true;
    }
    let b = vertices[3u * triangle + 1u];
    let c = vertices[3u * triangle + 2u];
    let weights = vec3f(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    let uv = vec2f(a.u, a.v) * weights.x + vec2f(b.u, b.v) * weights.y + vec2f(c.u, c.v) * weights.z;
    let other_uv = a.other_uv * weights.x + b.other_uv * weights.y + c.other_uv * weights.z;
    let alphas = vec3f(unpack2x16unorm(a.color.y).y, unpack2x16unorm(b.color.y).y, unpack2x16unorm(c.color.y).y);
    let alpha = cutout_alpha(material, uv, other_uv) * dot(alphas, weights);
    if material.threshold != ALPHA_IS_SHARE {
        return alpha >= material.threshold;
    }
    if only != 0u {
        return alpha > 0.0 && hit.object + 1u == only;
    }
    return coverage_meets(alpha, triangle, key, 0u);
}

// tree_hit() through the cutouts.
fn cutout_hit(tree: texture_2d<u32>, ray: TreeRay, limit_m: f32, but: u32, first_met: bool, only: u32) -> TriangleHit {
    if !HAS_CUTOUTS {
        return tree_hit(tree, ray, limit_m, but, first_met);
    }
    let key = coverage_key_of_ray(ray);
    var from_there = ray;
    var gone_m = 0.0;
    var hit = tree_hit(tree, from_there, limit_m, but, false);
    for (var i = 0u; i < CUTOUT_LAYERS; i += 1u) {
        if hit.triangle == 0u || cutout_is_there(hit, only, key) {
            break;
        }
        gone_m += hit.distance_m;
        from_there.origin_m = ray.origin_m + gone_m * ray.direction;
        hit = tree_hit(tree, from_there, limit_m - gone_m, hit.triangle, false);
    }
    hit.distance_m += gone_m;
    return hit;
}
