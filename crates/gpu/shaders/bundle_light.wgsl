// How much scratch lies in which direction, and the light of that, the lanes of a workgroup at work on one pixel. Twin:
// reference/src/bundles/directions.rs.

// Lanes of a workgroup: 8 to 32, a power of two. A software driver runs 8 in step, and idle ones cost it as much as others.
override BUNDLE_LANES: u32 = 32u;
const BUNDLE_LANES_MAX: u32 = 32u;
const BUNDLE_STRIDE_MAX: u32 = 8u;
const BUNDLE_ENVIRONMENT_STRIDE: u32 = 4u;
const BUNDLE_TURN_SHARE: f32 = 1.0;
const BUNDLE_SMEAR: f32 = 0.1;
const BUNDLE_MOVED_MAX: f32 = 1.0;

// How much scratch lies in which direction; the same times by how much it is wider, and deeper, than its population.
var<workgroup> bundle_bins: array<vec3f, BUNDLE_BINS>;
// What a lane has for the others.
var<workgroup> bundle_sums: array<vec4f, BUNDLE_LANES_MAX>;
var<workgroup> bundle_counts: array<u32, BUNDLE_LANES_MAX>;
// Directions that a light reaches.
var<workgroup> bundle_lit: array<u32, BUNDLE_BINS>;
// What all lanes go by. Loads from here are known to be the same for all, which barriers ask for.
var<workgroup> bundle_common: u32;

// The tile of a workgroup: one for each pixel of each tile in the queue.
fn bundle_tile(i: u32, count: u32, lane: u32) -> u32 {
    if lane == 0u {
        bundle_common = queue_tile(QUEUE_BUNDLED, walk_strided(i, count));
    }
    return workgroupUniformLoad(&bundle_common);
}

// Pixel `i` of a tile.
fn bundle_pixel(tile: u32, i: u32) -> vec2u {
    return tile_corner(tile) + vec2u(i % TILE_PX, i / TILE_PX + frame.rows.x);
}

// As film_visible; nothing for pixels of a tile beyond the film.
fn bundle_seen(pixel: vec2u) -> vec2u {
    if pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return vec2u(0u);
    }
    return film_visible(pixel);
}

// How many have been counted by the lanes before this one, and by all.
fn bundle_places(lane: u32, count: u32) -> vec2u {
    bundle_counts[lane] = count;
    workgroupBarrier();
    var places = vec2u(0u);
    for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
        let n = bundle_counts[i];
        places += vec2u(select(0u, n, i < lane), n);
    }
    return places;
}

// The share about a direction where only those `stride` bins apart are told from one another, and by which shares what lies there
// is wider and deeper than its population.
fn bundle_direction(at: u32, stride: u32) -> vec3f {
    var sum = bundle_bins[at];
    for (var away = 1u; away < stride; away += 1u) {
        gather_rounds += 1u;
        let tent = f32(stride - away) / f32(stride);
        sum += tent * (bundle_bins[(at + away) % BUNDLE_BINS] + bundle_bins[(at + BUNDLE_BINS - away) % BUNDLE_BINS]);
    }
    // Rounding of small ones may leave more than there is.
    let moved = clamp(sum.yz / max(sum.x, 1e-30), vec2f(-BUNDLE_MOVED_MAX), vec2f(BUNDLE_MOVED_MAX));
    return vec3f(max(sum.x, 0.0), moved);
}

// The surface's axes that directions are measured in.
struct BundleFrame {
    reference: vec2f,
    across: vec2f,
}

fn bundle_frame(point: SurfacePoint, side: u32) -> BundleFrame {
    let reference = bundle_reference(side, point.normal);
    return BundleFrame(
        surface_from_world(point, reference).xy,
        surface_from_world(point, cross(point.normal, reference)).xy,
    );
}

fn bundle_tangent(axes: BundleFrame, at: u32) -> vec2f {
    let angle = 3.14159265 / f32(BUNDLE_BINS) * f32(at);
    return normalize(axes.reference * cos(angle) + axes.across * sin(angle));
}

// This lane's part of the light of all directions; `size` is the population's.
fn bundle_radiance(
    point: SurfacePoint,
    pixel: GatherPixel,
    side: u32,
    size: vec2f,
    lane: u32,
) -> vec3f {
    let axes = bundle_frame(point, side);
    var radiance = vec3f(0.0);
    for (var l = 0u; l < frame.light_count; l += 1u) {
        gather_rounds += 1u;
        let seen = gather_light_seen(point, pixel, l);
        if seen.shines {
            radiance += seen.radiance * bundle_light(point, pixel, axes, size, seen, lane);
        }
    }
    if HAS_ENVIRONMENT {
        for (var at = lane * BUNDLE_ENVIRONMENT_STRIDE; at < BUNDLE_BINS; at += BUNDLE_LANES * BUNDLE_ENVIRONMENT_STRIDE) {
            gather_rounds += 1u + ENVIRONMENT_CELLS;
            let direction = bundle_direction(at, BUNDLE_ENVIRONMENT_STRIDE);
            if direction.x > 0.0 {
                let lit = bundle_lit_segment(bundle_tangent(axes, at), size, direction);
                radiance += direction.x * gather_environment(point, lit);
            }
        }
    }
    return radiance;
}

// What stands for the scratches of a population in a direction.
fn bundle_lit_segment(tangent: vec2f, size: vec2f, direction: vec3f) -> LitSegment {
    return LitSegment(tangent, 0.0, size.x, size.y, direction.yz);
}

// This lane's part of what a light of radiance 1 sends.
fn bundle_light(
    point: SurfacePoint,
    pixel: GatherPixel,
    axes: BundleFrame,
    size: vec2f,
    seen: LightSeen,
    lane: u32,
) -> vec3f {
    let stride = bundle_stride(pixel, seen);
    let turn = 3.14159265 / f32(BUNDLE_BINS) * f32(stride);
    var view = pixel;
    view.turn_rad2 = BUNDLE_SMEAR * turn * turn;
    // Most directions are dark to most lights.
    let directions = BUNDLE_BINS / stride;
    let each = (directions + BUNDLE_LANES - 1u) / BUNDLE_LANES;
    var reached = 0u;
    for (var i = 0u; i < each; i += 1u) {
        gather_rounds += 1u;
        let direction = lane * each + i;
        let reaches = gather_reaches(point, view, seen, bundle_tangent(axes, direction * stride), 0.0);
        reached |= select(0u, 1u << i, direction < directions && reaches);
    }
    let slots = bundle_places(lane, countOneBits(reached));
    var slot = slots.x;
    while reached != 0u {
        gather_rounds += 1u;
        let at = (lane * each + firstTrailingBit(reached)) * stride;
        bundle_lit[slot] = at;
        slot += 1u;
        reached &= reached - 1u;
    }
    workgroupBarrier();
    var radiance = vec3f(0.0);
    for (var i = lane; i < slots.y; i += BUNDLE_LANES) {
        gather_rounds += 1u;
        let at = bundle_lit[i];
        let direction = bundle_direction(at, stride);
        let lit = bundle_lit_segment(bundle_tangent(axes, at), size, direction);
        var value = vec3f(0.0);
        if HAS_SPHERES && seen.kind == LIGHT_SPHERE {
            value = gather_sphere(point, view, lit, seen);
        }
        if HAS_POLYGONS && seen.kind == LIGHT_POLYGON && seen.is_small {
            value = gather_polygon(point, view, lit, seen);
        }
        if HAS_LARGE_POLYGONS && seen.kind == LIGHT_POLYGON && !seen.is_small {
            value = gather_large_polygon(point, view, lit, seen);
        }
        radiance += direction.x * value;
    }
    gather_rounds += BUNDLE_LANES;
    return radiance;
}

// Into which steps of directions a light is resolved.
fn bundle_stride(pixel: GatherPixel, seen: LightSeen) -> u32 {
    var half_width = seen.cap.sin_radius;
    if seen.kind == LIGHT_POLYGON {
        // Half the width of a long one.
        half_width = min(half_width, seen.solid_angle / (4.0 * max(seen.cap.sin_radius, 1e-6)));
    }
    let spread = sqrt(pixel.stds.w * pixel.stds.w + dot(seen.move_x, seen.move_x) + dot(seen.move_y, seen.move_y));
    let turn = (half_width + spread) / max(length(seen.mirror), 0.1);
    let bin = 3.14159265 / f32(BUNDLE_BINS);
    var stride = 1u;
    while stride < BUNDLE_STRIDE_MAX && 2.0 * f32(stride) * bin < BUNDLE_TURN_SHARE * turn {
        stride *= 2u;
    }
    return stride;
}
