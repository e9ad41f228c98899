// Rule by which a ray meets surfaces that cover a part of what lies behind them. Twin:
// index/src/coverage.rs.
// Needs: sobol, triangle_tree.

// Threshold of a material whose alpha is such a share. Twin: src/host.rs.
const ALPHA_IS_SHARE: f32 = 2.0;

// Key of the sample of a pixel. Rounds of one key spread their numbers evenly.
fn coverage_key_of_pixel(pixel: vec2u) -> u32 {
    return sobol_hash(pixel.x ^ sobol_hash(pixel.y));
}

// Key of a ray that is drawn by chance itself.
fn coverage_key_of_ray(ray: TreeRay) -> u32 {
    let origin = bitcast<vec3u>(ray.origin_m);
    let direction = bitcast<vec3u>(ray.direction);
    var key = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        key = sobol_hash(key ^ sobol_hash(origin[i]));
        key = sobol_hash(key ^ sobol_hash(direction[i]));
    }
    return key;
}

// Whether a ray meets a surface of an alpha on a triangle of the scene.
fn coverage_meets(alpha: f32, triangle: u32, key: u32, round: u32) -> bool {
    return alpha >= sobol_pair(round, key ^ sobol_hash(triangle + 1u)).x;
}
