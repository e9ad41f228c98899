// Pass: what many scratches add up to, for pixels whose footprints cover many. The sums are left where the shading pass goes on
// with them. Twin: reference/src/bundles.rs.
//
// A workgroup has one pixel: its lanes share out vertices, then directions, then those directions that a light reaches.

// Heights of one place of a grid: a tangent plane that leans as far as it may passes no more.
const BUNDLE_HEIGHTS: u32 = 3u;

// What a lane has for the others.
var<workgroup> bundle_parts: array<vec4f, 12 * BUNDLE_LANES_MAX>;
// Vertices and what their directions' three sums are scaled by.
var<workgroup> bundle_found: array<vec4u, BUNDLE_HEIGHTS * BUNDLE_LANES_MAX>;
var<workgroup> bundle_total: f32;

@compute @workgroup_size(BUNDLE_LANES)
fn shade_bundles(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let pixel = bundle_pixel(bundle_tile(workgroup.x, workgroups.x, lane), workgroup.y);
    let seen = bundle_seen(pixel);
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
                    bundle_add(point, view, side, share, size, weight, lane, &sums);
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

// Adds what was read to the sums, and its light.
fn bundle_add(
    point: SurfacePoint,
    pixel: GatherPixel,
    side: u32,
    share: f32,
    size: vec2f,
    weight: f32,
    lane: u32,
    sums: ptr<function, ScratchSums>,
) {
    let axes = bundle_frame(point, side);
    let radiance = bundle_radiance(point, pixel, side, size, lane);
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
