// Pass: what single scratches under a pixel add up to, where no grid is fine against its footprint and they are so many that
// lighting directions takes less than lighting each. Twin: reference/src/bundles/tally.rs.
//
// A workgroup has one pixel: its lanes go through the hierarchy together and share out what leaves hold, then directions.

// Scratches under a pixel from which on they are added up.
const BUNDLE_TALLY_FROM: u32 = 448u;
// Sums are whole numbers of this part, so that their order does not matter.
const BUNDLE_TALLY_PART: f32 = 1.0 / 67108864.0;
const BUNDLE_POPULATIONS_MAX: u32 = 4u;
// Where a device ends long loops, so much of the rounds is for the walk; with more, pixels look at scratches for themselves.
const BUNDLE_TALLY_WALK_SHARE: f32 = 0.8;

// Shares, and those times by how much they are wider and deeper, population by population.
var<workgroup> bundle_tallies: array<atomic<i32>, 3u * BUNDLE_POPULATIONS_MAX * BUNDLE_BINS>;
// So many segments at least are found before somebody looks at them.
const BUNDLE_FIND: u32 = 32u;
const BUNDLE_FIND_ROOM: u32 = BUNDLE_FIND + 2u * LEAF_SEGMENTS;
var<private> bundle_segments: array<u32, BUNDLE_FIND_ROOM>;

@compute @workgroup_size(BUNDLE_LANES)
fn bundle_tally(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = bundle_tile(workgroup.x, workgroups.x, lane);
    let pixel = bundle_pixel(tile, workgroup.y);
    let seen = bundle_seen(pixel);
    if seen.x == 0u {
        return;
    }
    let grids = bundle_grids(seen.y);
    var depth_m: f32;
    var point = hit_surface_point(seen.x - 1u, film_ray(pixel), &depth_m);
    var view = gather_pixel(point);
    let choice = bundle_choice(view, grids);
    if !choice.may_tally {
        return;
    }
    for (var i = lane; i < 3u * BUNDLE_POPULATIONS_MAX * BUNDLE_BINS; i += BUNDLE_LANES) {
        atomicStore(&bundle_tallies[i], 0);
    }
    workgroupBarrier();
    view.single_share = bundle_single_share(choice);
    let side = bundle_side(point.normal);
    let axes = bundle_frame(point, side);
    var sums = ScratchSums(0.0, 0.0, vec3f(0.0), vec3f(0.0));
    let count = bundle_tally_all(point, view, grids, axes, objects[seen.y], lane, &sums);
    if count < BUNDLE_TALLY_FROM {
        return;
    }
    let own_table = point.table;
    for (var population = 0u; population < min(grids.populations, BUNDLE_POPULATIONS_MAX); population += 1u) {
        for (var bin = lane; bin < BUNDLE_BINS; bin += BUNDLE_LANES) {
            gather_rounds += 1u;
            let at = 3u * (population * BUNDLE_BINS + bin);
            bundle_bins[bin] = BUNDLE_TALLY_PART * vec3f(
                f32(atomicLoad(&bundle_tallies[at])),
                f32(atomicLoad(&bundle_tallies[at + 1u])),
                f32(atomicLoad(&bundle_tallies[at + 2u])),
            );
        }
        workgroupBarrier();
        point.table = bundle_table(grids, population, own_table);
        sums.radiance += bundle_radiance(point, view, side, bundle_size(grids, population), lane);
        workgroupBarrier();
    }
    bundle_join_sums(lane, &sums);
    if lane == 0u {
        let continues = film.pixels[film_index(pixel)].walk_at != 0u;
        film_keep_bundles(pixel, continues, true, objects[seen.y].end_node, sums);
        let in_film = pixel - vec2u(0u, frame.rows.x);
        queue_mark_tallied(tile, in_film.y % TILE_PX * TILE_PX + in_film.x % TILE_PX);
    }
}

// Adds up all scratches under the footprint: directions, and this lane's part of the sums without light. Returns how many there
// are; 0 if that takes too long.
fn bundle_tally_all(
    point: SurfacePoint,
    view: GatherPixel,
    grids: BundleGrids,
    axes: BundleFrame,
    object: Object,
    lane: u32,
    sums: ptr<function, ScratchSums>,
) -> u32 {
    let reach_m = gather_reach_m(point);
    let lower_m = point.position_m - reach_m;
    let upper_m = point.position_m + reach_m;
    var most_rounds = GATHER_MAX_ROUNDS;
    if GATHER_MAX_ROUNDS != 0xffffffffu {
        most_rounds = u32(BUNDLE_TALLY_WALK_SHARE * f32(GATHER_MAX_ROUNDS));
    }
    // The lanes find the same segments, and each looks at its own of them.
    var walk = BundleWalk(object.first_node, 0u);
    var found = 0u;
    while walk.at < object.end_node && gather_rounds < most_rounds {
        gather_rounds += 1u;
        walk.found = 0u;
        let before = walk.at;
        while walk.at < object.end_node && walk.found < BUNDLE_FIND && gather_rounds < most_rounds {
            gather_rounds += 1u;
            // Two at a time: a driver that ends long loops counts rounds.
            bundle_visit(lower_m, upper_m, object.end_node, &walk, &bundle_segments);
            bundle_visit(lower_m, upper_m, object.end_node, &walk, &bundle_segments);
        }
        for (var i = lane; i < walk.found; i += BUNDLE_LANES) {
            gather_rounds += 1u;
            found += bundle_tally_one(point, view, grids, axes, bundle_segments[i], sums);
        }
        // Lanes that a software driver has switched off read zeros, and would walk for ever.
        if walk.at <= before {
            break;
        }
    }
    bundle_counts[lane] = select(found, 0u, walk.at < object.end_node);
    workgroupBarrier();
    var total = 0u;
    for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
        total += bundle_counts[i];
    }
    gather_rounds += BUNDLE_LANES;
    return total;
}

struct BundleWalk {
    at: u32,
    found: u32,
}

// Goes on by one node of the hierarchy. A leaf's segments are found; there must be room for LEAF_SEGMENTS.
fn bundle_visit(
    lower_m: vec3f,
    upper_m: vec3f,
    end: u32,
    walk: ptr<function, BundleWalk>,
    segments: ptr<private, array<u32, BUNDLE_FIND_ROOM>>,
) {
    let node = scratch_node(min((*walk).at, end - 1u));
    let touches = all(node.min_m <= upper_m) && all(node.max_m >= lower_m);
    let is_on = (*walk).at < end;
    let first = node.leaf & ((1u << LEAF_FIRST_BITS) - 1u);
    for (var i = 0u; i < LEAF_SEGMENTS; i += 1u) {
        (*segments)[(*walk).found + i] = first + i;
    }
    (*walk).found += select(0u, node.leaf >> LEAF_FIRST_BITS, touches && is_on);
    (*walk).at = select((*walk).at, select(node.skip, (*walk).at + 1u, touches), is_on);
}

// Whether a segment lies under the footprint; if so it is added.
fn bundle_tally_one(
    point: SurfacePoint,
    view: GatherPixel,
    grids: BundleGrids,
    axes: BundleFrame,
    index: u32,
    sums: ptr<function, ScratchSums>,
) -> u32 {
    gather_batch.count = 0u;
    gather_weigh(point, view, index, &gather_batch, sums);
    if gather_batch.count == 0u {
        return 0u;
    }
    let tangent = gather_batch.tangents[0];
    let size = unpack2x16float(gather_batch.grooves[0]);
    let population = bundle_population(grids, size);
    let mean = bundle_size(grids, population);
    let moved = select(vec2f(0.0), size / mean - 1.0, mean > vec2f(0.0));
    let bin = atan2(dot(tangent, axes.across), dot(tangent, axes.reference)) * (f32(BUNDLE_BINS) / 3.14159265) + f32(BUNDLE_BINS);
    let low = floor(bin);
    let high_share = bin - low;
    for (var i = 0u; i < 2u; i += 1u) {
        gather_rounds += 1u;
        let share = gather_batch.shares[0] * select(1.0 - high_share, high_share, i == 1u);
        let first = 3u * (population * BUNDLE_BINS + (u32(low) + i) % BUNDLE_BINS);
        let parts = vec3i(round(clamp(share * vec3f(1.0, moved) / BUNDLE_TALLY_PART, vec3f(-1e9), vec3f(1e9))));
        atomicAdd(&bundle_tallies[first], parts.x);
        atomicAdd(&bundle_tallies[first + 1u], parts.y);
        atomicAdd(&bundle_tallies[first + 2u], parts.z);
    }
    return 1u;
}

// The sum of all lanes' sums.
fn bundle_join_sums(lane: u32, sums: ptr<function, ScratchSums>) {
    bundle_sums[lane] = vec4f((*sums).radiance, (*sums).share_by_line);
    workgroupBarrier();
    var total = vec4f(0.0);
    for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
        total += bundle_sums[i];
    }
    workgroupBarrier();
    bundle_sums[lane] = vec4f((*sums).energy, (*sums).share);
    workgroupBarrier();
    var more = vec4f(0.0);
    for (var i = 0u; i < BUNDLE_LANES; i += 1u) {
        more += bundle_sums[i];
    }
    *sums = ScratchSums(more.w, total.w, total.xyz, more.xyz);
}
