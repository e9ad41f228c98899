// Pass: from what is visible to radiance, in tiles that have a list of scratches. The workgroup draws the scratches' lines into a
// bit for each pixel and scratch, 64 scratches at a time; each pixel then takes those whose bit it finds. shade.wgsl does all
// other pixels.

@group(3) @binding(2) var tile_lists: texture_2d<u32>;

// Two words a pixel: a bit for each scratch at hand.
var<workgroup> touches: array<atomic<u32>, 128>;
var<workgroup> tile_head: vec2u;
// Whether a pixel saw more scratches than there is room for, and goes on by a walk.
var<workgroup> tile_overflows: atomic<u32>;

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = queue_tile(QUEUE_LISTED, workgroup.x);
    let list = tile * frame.tile_entries;
    if lane == 0u {
        tile_head = textureLoad(tile_lists, row_texel(list), 0).xy;
    }
    let head = workgroupUniformLoad(&tile_head);
    let count = head.x;
    let reach_px = bitcast<f32>(head.y);

    let in_film = tile_corner(tile) + local.xy;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let ray = film_ray(pixel);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    // Any triangle does for pixels that see none; what they find is dropped.
    var depth_m: f32;
    let point = hit_surface_point(max(seen.x, 1u) - 1u, ray, &depth_m);
    var view = gather_pixel(point);
    var batch: GatherBatch;
    var sums: ScratchSums;
    var alone = true;
    if METHOD_GATHER == GATHER_CLUSTERS {
        view.single_share = bundle_single_share_at(point, seen.y);
        alone = view.single_share > 0.0;
        sums = film_resume(pixel, 0u).sums;
    }
    var overflows = false;
    // A walk may be left where a device ends long loops; this is not.
    let room = min(GATHER_SEGMENTS, GATHER_MAX_ROUNDS / gather_rounds_a_segment());
    for (var first = 0u; first < count; first += 64u) {
        atomicStore(&touches[2u * lane], 0u);
        atomicStore(&touches[2u * lane + 1u], 0u);
        workgroupBarrier();
        if first + lane < count {
            let entry = textureLoad(tile_lists, row_texel(list + TILE_HEAD + first + lane), 0).xy;
            tile_draw_segment(entry, tile_middle_px(tile_corner(tile)), reach_px, lane);
        }
        workgroupBarrier();
        var low = atomicLoad(&touches[2u * lane]);
        var high = atomicLoad(&touches[2u * lane + 1u]);
        workgroupBarrier();
        let touching = select(0u, countOneBits(low) + countOneBits(high), alone);
        overflows = overflows || batch.count + touching > room;
        let wanted = select(touching, 0u, overflows || seen.x == 0u);
        for (var i = 0u; i < wanted; i += 1u) {
            gather_rounds += 1u;
            let bit = select(firstTrailingBit(low), 32u + firstTrailingBit(high), low == 0u);
            high = select(high, high & (high - 1u), low == 0u);
            low = low & (max(low, 1u) - 1u);
            let segment = textureLoad(tile_lists, row_texel(list + TILE_HEAD + first + bit), 0).x;
            gather_weigh(point, view, segment, &batch, &sums);
        }
    }
    if !inside {
        return;
    }
    if seen.x == 0u {
        film_add_background(pixel, ray);
        return;
    }
    if overflows {
        // The first one of its tile says so.
        if atomicExchange(&tile_overflows, 1u) == 0u {
            queue_push(QUEUE_WALKED, tile);
        }
        return;
    }
    sums.radiance += gather_light(point, view, &batch);
    let masked = gather_masked(sums, objects[seen.y].depth_coherence);
    film_add_surface(pixel, point, depth_m, masked, base_radiance(point));
}

// Beyond a segment's ends pixels see it a little further than across it: the ends are blurred by up to 0.83 sigma, and the
// coherence window's standard deviation is 0.71 sigma.
const TILE_REACH_ALONG: f32 = 1.2;

// Sets the bit of a segment in every pixel that its line comes near to, between its ends.
fn tile_draw_segment(entry: vec2u, middle_px: vec2f, reach_px: f32, scratch: u32) {
    let segment = scratch_segment(entry.x);
    let seen = segment_seen(segment.start_m, segment.end_m, middle_px);
    let beyond_px = TILE_REACH_ALONG * reach_px;
    let lowest = select(vec2f(-1e9), min(seen.start_px, seen.end_px) - beyond_px, seen.has_line);
    let highest = select(vec2f(1e9), max(seen.start_px, seen.end_px) + beyond_px, seen.has_line);
    let line = unpack_tile_line(entry.y);
    let first_px = tile_at_px(vec2u(0u));
    let bit = 1u << (scratch & 31u);
    let word = scratch >> 5u;
    // Nearly level lines run through whole rows.
    let steep = max(abs(line.x), 1e-4);
    let side = select(1.0, -1.0, line.x < 0.0);
    let first_row = u32(clamp(ceil(lowest.y - first_px.y), 0.0, f32(TILE_PX)));
    let end_row = u32(clamp(floor(highest.y - first_px.y) + 1.0, 0.0, f32(TILE_PX)));
    for (var y = first_row; y < end_row; y += 1u) {
        gather_rounds += 1u;
        let middle = side * (line.z - line.y * (first_px.y + f32(y)));
        let low = max((middle - reach_px) / steep, lowest.x) - first_px.x;
        let high = min((middle + reach_px) / steep, highest.x) - first_px.x;
        let last = i32(clamp(floor(high), -1.0, f32(TILE_PX - 1u)));
        for (var x = i32(clamp(ceil(low), 0.0, f32(TILE_PX))); x <= last; x += 1) {
            gather_rounds += 1u;
            atomicOr(&touches[2u * (y * TILE_PX + u32(x)) + word], bit);
        }
    }
}
