// The rays of a pixel's neighbours beside its own, while something moves: visibility alone is blurred, within a surface, and nothing of what the
// closed forms know.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> halves: array<ShadowHalf>;

// So many pixels to each side.
const NEAR_RAYS_PX: i32 = 2;

// Whether a sample lies on the same surface as its neighbour: near its plane and facing the same way.
fn is_same_surface(own: PixelPoint, other: PixelPoint) -> bool {
    let to_m = other.position_m - own.position_m;
    return other.object == own.object && dot(other.normal, own.normal) > 0.95 && abs(dot(to_m, own.normal)) <= 0.2 * length(to_m);
}

// A ray of weight 1: a bright neighbour counts as much as a dark one.
fn even_ray(ray: ShadowHalf) -> ShadowHalf {
    let per_specular = 1.0 / max(rgb_luminance(ray.specular), 1e-30);
    let per_body = 1.0 / max(rgb_luminance(ray.body), 1e-30);
    return ShadowHalf(ray.specular * per_specular, ray.specular_hidden * per_specular, ray.body * per_body, ray.body_hidden * per_body);
}

// The sum over the single rays of a pixel and of its neighbours; the pixel is one of those.
fn near_rays(pixel: vec2u, at: u32) -> ShadowHalf {
    let own = points[at];
    var sum: ShadowHalf;
    for (var y = -NEAR_RAYS_PX; y <= NEAR_RAYS_PX; y += 1) {
        for (var x = -NEAR_RAYS_PX; x <= NEAR_RAYS_PX; x += 1) {
            let there = vec2i(pixel) + vec2i(x, y);
            let is_there = there.x >= 0 && there.x < i32(frame.size_px.x) && there.y >= i32(frame.rows.x) && there.y < i32(frame.rows.y);
            let other = strip_index(select(pixel, vec2u(there), is_there));
            if is_there && is_same_surface(own, points[other]) {
                let ray = even_ray(halves[2u * other]);
                sum.specular += ray.specular;
                sum.specular_hidden += ray.specular_hidden;
                sum.body += ray.body;
                sum.body_hidden += ray.body_hidden;
            }
        }
    }
    return sum;
}

// The half of a sample's rays that holds its single one, or what that and its neighbours' say together.
fn even_half(pixel: vec2u, at: u32, round: ShadowRound) -> ShadowHalf {
    var even = halves[2u * at];
    if round.blurs != 0u {
        even = near_rays(pixel, at);
    }
    return even;
}
