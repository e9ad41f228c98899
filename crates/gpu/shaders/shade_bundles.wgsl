// Pass: what many scratches add up to, for pixels whose footprints cover many. The sums are left where the shading pass goes on
// with them. Twin: reference/src/bundles.rs.
//
// A workgroup has one pixel: its lanes share out vertices, then directions, then those directions that a light reaches.

// Lanes of a workgroup: 8 to 32, a power of two. A software driver runs 8 in step, and idle ones cost it as much as others.
override BUNDLE_LANES: u32 = 32u;
const BUNDLE_LANES_MAX: u32 = 32u;
// Heights of one place of a grid: a tangent plane that leans as far as it may passes no more.
const BUNDLE_HEIGHTS: u32 = 3u;

const BUNDLE_STRIDE_MAX: u32 = 8u;
const BUNDLE_ENVIRONMENT_STRIDE: u32 = 4u;
const BUNDLE_TURN_SHARE: f32 = 1.0;
const BUNDLE_SMEAR: f32 = 0.1;

const BUNDLE_MOVED_MAX: f32 = 1.0;

// How much scratch lies in which direction; the same times by how much it is wider, and deeper, than its population.
var<workgroup> bundle_bins: array<vec3f, BUNDLE_BINS>;
// What a lane has for the others.
var<workgroup> bundle_parts: array<vec4f, 12 * BUNDLE_LANES_MAX>;
var<workgroup> bundle_sums: array<vec4f, BUNDLE_LANES_MAX>;
var<workgroup> bundle_counts: array<u32, BUNDLE_LANES_MAX>;
// Vertices and what their directions' three sums are scaled by.
var<workgroup> bundle_found: array<vec4u, BUNDLE_HEIGHTS * BUNDLE_LANES_MAX>;
// Directions that a light reaches.
var<workgroup> bundle_lit: array<u32, BUNDLE_BINS>;
// What all lanes go by. Loads from here are known to be the same for all, which barriers ask for.
var<workgroup> bundle_common: u32;
var<workgroup> bundle_total: f32;

@compute @workgroup_size(BUNDLE_LANES)
fn shade_bundles(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    if lane == 0u {
        bundle_common = queue_tile(QUEUE_BUNDLED, walk_strided(workgroup.x, workgroups.x));
    }
    let tile = workgroupUniformLoad(&bundle_common);
    let pixel = tile_corner(tile) + vec2u(workgroup.y % TILE_PX, workgroup.y / TILE_PX + frame.rows.x);
    if pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    let seen = film_visible(pixel);
    if seen.x == 0u {
        return;
    }
    let grids = bundle_grids(seen.y);
    if grids.populations == 0u {
        return;
    }
    var depth_m: f32;
    var point = hit_surface_point(seen.x - 1u, film_ray(pixel), &depth_m);
    let view = gather_pixel(point);
    let choice = bundle_choice(view, grids);
    if !choice.any {
        return;
    }
    if lane == 0u {
        bundle_common = film_bundled(pixel);
    }
    let begun = workgroupUniformLoad(&bundle_common);
    if begun == WALK_BUNDLES_DONE {
        return;
    }
    let own_table = point.table;
    let steps = select(1u, 2u, choice.share < 1.0 && choice.level > 0u);
    var unit = begun;
    // Of this lane, but for share and energy, which every lane knows whole.
    var sums = ScratchSums(0.0, 0.0, vec3f(0.0), vec3f(0.0));
    while unit < steps * grids.populations && !bundle_is_spent(lane) {
        let step = unit / grids.populations;
        let population = unit % grids.populations;
        let weight = select(1.0 - choice.share, choice.share, step == 0u);
        let level = bundle_level(grids, population, choice.level - step);
        let size = bundle_size(grids, population);
        point.table = bundle_table(grids, population, own_table);
        for (var side = 0u; side < BUNDLE_SIDES; side += 1u) {
            gather_rounds += 1u;
            let footprint = bundle_footprint(point, view, side, level);
            if footprint.rows > 0u {
                let share = bundle_read(point, footprint, level, lane);
                if share > 0.0 {
                    bundle_add(point, view, side, share, size, grids.width_um, weight, lane, &sums);
                }
            }
        }
        unit += 1u;
    }
    bundle_sums[lane] = vec4f(sums.radiance, sums.share_by_line);
    workgroupBarrier();
    if lane == 0u {
        var total = vec4f(0.0);
        for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
            total += bundle_sums[i];
        }
        sums.radiance = total.xyz;
        sums.share_by_line = total.w;
        let is_done = unit == steps * grids.populations;
        var next = WALK_BUNDLED | unit;
        if is_done {
            next = select(objects[seen.y].end_node, WALK_FRESH, bundle_single_share(choice) > 0.0);
        }
        film_keep_bundles(pixel, begun > 0u, is_done, next, sums);
    }
}

// Whether any lane has spent its rounds: the rest is for another dispatch.
fn bundle_is_spent(lane: u32) -> bool {
    if GATHER_MAX_ROUNDS == 0xffffffffu {
        return false;
    }
    bundle_counts[lane] = gather_rounds;
    workgroupBarrier();
    if lane == 0u {
        var most = 0u;
        for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
            most = max(most, bundle_counts[i]);
        }
        bundle_common = most;
    }
    return workgroupUniformLoad(&bundle_common) >= GATHER_MAX_ROUNDS;
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

// 16 directions.
struct BundleSixteen {
    a: vec4f,
    b: vec4f,
    c: vec4f,
    d: vec4f,
}

fn bundle_add_shares(sum: BundleSixteen, scale: f32, words: vec4u) -> BundleSixteen {
    return BundleSixteen(
        sum.a + scale * unpack4x8unorm(words.x),
        sum.b + scale * unpack4x8unorm(words.y),
        sum.c + scale * unpack4x8unorm(words.z),
        sum.d + scale * unpack4x8unorm(words.w),
    );
}

fn bundle_add_moved(sum: BundleSixteen, scale: f32, words: vec4u) -> BundleSixteen {
    return BundleSixteen(
        sum.a + scale * unpack4x8snorm(words.x),
        sum.b + scale * unpack4x8snorm(words.y),
        sum.c + scale * unpack4x8snorm(words.z),
        sum.d + scale * unpack4x8snorm(words.w),
    );
}

fn bundle_keep_part(kind: u32, lane: u32, sum: BundleSixteen) {
    let first = 4u * (kind * BUNDLE_LANES + lane);
    bundle_parts[first] = sum.a;
    bundle_parts[first + 1u] = sum.b;
    bundle_parts[first + 2u] = sum.c;
    bundle_parts[first + 3u] = sum.d;
}

// Reads the vertices under a footprint. What lies in which direction is in bundle_bins then; returns the sum of all shares.
fn bundle_read(point: SurfacePoint, footprint: BundleFootprint, level: BundleLevel, lane: u32) -> f32 {
    let groups = BUNDLE_LANES / BUNDLE_BIN_TEXELS;
    let none = BundleSixteen(vec4f(0.0), vec4f(0.0), vec4f(0.0), vec4f(0.0));
    var shares = none;
    var wider = none;
    var deeper = none;
    var total = 0.0;
    let places = footprint.rows * footprint.width;
    for (var first = 0u; first < places; first += BUNDLE_LANES) {
        var vertices: array<vec4u, BUNDLE_HEIGHTS>;
        var count = 0u;
        let place = bundle_place(footprint, first + lane);
        let heights = select(0, min(place.count, i32(BUNDLE_HEIGHTS)), first + lane < places);
        for (var h = 0; h < heights; h += 1) {
            gather_rounds += 1u;
            let vertex = bundle_find(level, footprint.side, place.at, place.low + h);
            if vertex != BUNDLE_NONE {
                let share = bundle_share(point, footprint, vertex);
                let bin_scale = bitcast<f32>(bundle_texel(vertex + 1u).w);
                let moved_scales = bitcast<vec2f>(bundle_texel(vertex + 2u).xy);
                vertices[count] = vec4u(vertex, bitcast<vec3u>(share * vec3f(bin_scale, moved_scales)));
                total += share;
                count += u32(share > 0.0);
            }
        }
        let slots = bundle_places(lane, count);
        for (var i = 0u; i < count; i += 1u) {
            bundle_found[slots.x + i] = vertices[i];
        }
        workgroupBarrier();
        // A lane has 16 of the directions, of every so many vertices.
        for (var i = lane / BUNDLE_BIN_TEXELS; i < slots.y; i += groups) {
            gather_rounds += 1u;
            let found = bundle_found[i];
            let scales = bitcast<vec3f>(found.yzw);
            let texel = found.x + 3u + lane % BUNDLE_BIN_TEXELS;
            shares = bundle_add_shares(shares, scales.x, bundle_texel(texel));
            wider = bundle_add_moved(wider, scales.y, bundle_texel(texel + BUNDLE_BIN_TEXELS));
            deeper = bundle_add_moved(deeper, scales.z, bundle_texel(texel + 2u * BUNDLE_BIN_TEXELS));
        }
        gather_rounds += 1u + BUNDLE_LANES;
    }
    workgroupBarrier();
    bundle_keep_part(0u, lane, shares);
    bundle_keep_part(1u, lane, wider);
    bundle_keep_part(2u, lane, deeper);
    bundle_sums[lane] = vec4f(total, vec3f(0.0));
    workgroupBarrier();
    for (var bin = lane; bin < BUNDLE_BINS; bin += BUNDLE_LANES) {
        var sum = vec3f(0.0);
        for (var group = 0u; group < groups; group += 1u) {
            gather_rounds += 1u;
            let part = 4u * (group * BUNDLE_BIN_TEXELS + bin / 16u) + (bin / 4u) % 4u;
            sum += vec3f(
                bundle_parts[part][bin % 4u],
                bundle_parts[part + 4u * BUNDLE_LANES][bin % 4u],
                bundle_parts[part + 8u * BUNDLE_LANES][bin % 4u],
            );
        }
        bundle_bins[bin] = sum;
    }
    if lane == 0u {
        var sum = 0.0;
        for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
            sum += bundle_sums[i].x;
        }
        bundle_total = sum;
    }
    gather_rounds += BUNDLE_LANES;
    return workgroupUniformLoad(&bundle_total);
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

fn bundle_tangent(axes: BundleFrame, at: u32) -> vec2f {
    let angle = 3.14159265 / f32(BUNDLE_BINS) * f32(at);
    return normalize(axes.reference * cos(angle) + axes.across * sin(angle));
}

// Lights what was read and adds it to the sums.
fn bundle_add(
    point: SurfacePoint,
    pixel: GatherPixel,
    side: u32,
    share: f32,
    size: vec2f,
    mean_width_um: f32,
    weight: f32,
    lane: u32,
    sums: ptr<function, ScratchSums>,
) {
    let reference = bundle_reference(side, point.normal);
    let axes = BundleFrame(
        surface_from_world(point, reference).xy,
        surface_from_world(point, cross(point.normal, reference)).xy,
    );
    var radiance = vec3f(0.0);
    for (var l = 0u; l < frame.light_count; l += 1u) {
        gather_rounds += 1u;
        let seen = gather_light_seen(point, pixel, l);
        if seen.shines {
            radiance += seen.radiance * bundle_light(point, pixel, axes, size, mean_width_um, seen, lane);
        }
    }
    if HAS_ENVIRONMENT {
        for (var at = lane * BUNDLE_ENVIRONMENT_STRIDE; at < BUNDLE_BINS; at += BUNDLE_LANES * BUNDLE_ENVIRONMENT_STRIDE) {
            gather_rounds += 1u + ENVIRONMENT_CELLS;
            let direction = bundle_direction(at, BUNDLE_ENVIRONMENT_STRIDE);
            if direction.x > 0.0 {
                let lit = bundle_lit_segment(bundle_tangent(axes, at), size, mean_width_um, direction);
                radiance += direction.x * gather_environment(point, lit);
            }
        }
    }
    (*sums).radiance += weight * radiance;
    (*sums).share += weight * share;
    // The mean of a Gaussian over itself is 1/sqrt2 of its peak.
    var deeper = 0.0;
    for (var at = lane * BUNDLE_STRIDE_MAX; at < BUNDLE_BINS; at += BUNDLE_LANES * BUNDLE_STRIDE_MAX) {
        gather_rounds += 1u;
        let across_um2 = gather_footprint(pixel, bundle_tangent(axes, at)).across_um2;
        let direction = bundle_direction(at, BUNDLE_STRIDE_MAX);
        let width_um = (1.0 + direction.y) * size.x;
        let line = width_um * inverseSqrt(12.5663706 * (across_um2 + pixel.window_um2));
        (*sums).share_by_line += weight * line * direction.x;
        deeper += direction.x * direction.z;
    }
    // Every lane has the whole of share and energy.
    bundle_sums[lane] = vec4f(deeper, vec3f(0.0));
    workgroupBarrier();
    deeper = 0.0;
    for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
        deeper += bundle_sums[i].x;
    }
    workgroupBarrier();
    gather_rounds += BUNDLE_LANES;
    let depth_nm = oblique_depth_nm((1.0 + deeper / share) * size.y, point.wo.z, point.wo.z);
    (*sums).energy += weight * share * scratch_table_total(scratch_tables, point.table, depth_nm);
}

// What stands for the scratches of a population in a direction.
fn bundle_lit_segment(tangent: vec2f, size: vec2f, mean_width_um: f32, direction: vec3f) -> LitSegment {
    return LitSegment(tangent, 0.0, mean_width_um, size.y, vec3f(direction.yz, size.x / mean_width_um));
}

// This lane's part of what a light of radiance 1 sends.
fn bundle_light(
    point: SurfacePoint,
    pixel: GatherPixel,
    axes: BundleFrame,
    size: vec2f,
    mean_width_um: f32,
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
        let lit = bundle_lit_segment(bundle_tangent(axes, at), size, mean_width_um, direction);
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
