// Pass: what each tile of pixels shows, and the scratches that it may see. One invocation a tile: its walk over the hierarchy
// serves 64 pixels.

@group(3) @binding(0) var tile_visibility: texture_2d<u32>;
@group(3) @binding(1) var tile_lists_out: texture_storage_2d<rg32uint, write>;

// The line's distance is rounded, and the surface is a plane within a tile only nearly.
const TILE_MARGIN: f32 = 1.15;
const TILE_MARGIN_PX: f32 = 0.1;
// Where shading bends the surface by more than this the footprint in the picture is not what the line tells.
const TILE_BENT: f32 = 0.05;

// What the pixels of a tile see of one object.
struct TileSight {
    object: u32,                // + 1; 0 if they see none
    one_object: bool,
    lower_m: vec3f,             // a box that every footprint lies in
    upper_m: vec3f,
    reach2_px: f32,             // the square of how far a line may be from a pixel that sees its scratch
}

@compute @workgroup_size(64)
fn tiles(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = 64u * walk_strided(workgroup.x, workgroups.x) + lane;
    let counts = tile_counts();
    if tile >= counts.x * counts.y {
        return;
    }
    let corner = tile_corner(tile);
    let sight = tile_sight(corner);
    let first = tile * frame.tile_entries;
    var found = 0u;
    var at = 0u;
    var end = 0u;
    if sight.object != 0u {
        let object = objects[sight.object - 1u];
        at = object.first_node;
        end = object.end_node;
    }
    // In two loops by turns: what leaves hold is found, and looked at.
    var segments: array<u32, FIND_SEGMENTS>;
    while at < end && found + TILE_HEAD + FIND_SEGMENTS <= frame.tile_entries && gather_rounds < GATHER_MAX_ROUNDS {
        let count = find_segments(sight.lower_m, sight.upper_m, end, FIND_SEGMENTS, &at, &segments);
        for (var i = 0u; i < count; i += 1u) {
            gather_rounds += 1u;
            let line = tile_line(segments[i], corner, sight);
            if line.touches {
                textureStore(tile_lists_out, row_texel(first + TILE_HEAD + found), vec4u(segments[i], line.packed, 0u, 0u));
                found += 1u;
            }
        }
    }
    textureStore(tile_lists_out, row_texel(first), vec4u(found, bitcast<u32>(sqrt(sight.reach2_px)), 0u, 0u));
    if sight.object == 0u {
        queue_push(QUEUE_EMPTY, tile);
    } else if sight.one_object && at >= end {
        queue_push(QUEUE_LISTED, tile);
    } else {
        queue_push(QUEUE_WALKED, tile);
    }
}

fn tile_sight(corner: vec2u) -> TileSight {
    var sight = TileSight(0u, true, vec3f(1e30), vec3f(-1e30), 0.0);
    let middle = tile_middle_px(corner);
    for (var i = 0u; i < TILE_PX * TILE_PX; i += 1u) {
        gather_rounds += 1u;
        let in_film = corner + vec2u(i % TILE_PX, i / TILE_PX);
        let inside = in_film.x < frame.size_px.x && in_film.y + frame.rows.x < frame.rows.y;
        let seen = textureLoad(tile_visibility, in_film, 0).xy;
        if !inside || seen.x == 0u {
            continue;
        }
        sight.one_object = sight.one_object && (sight.object == 0u || sight.object == seen.y + 1u);
        sight.object = seen.y + 1u;
        let ray = tile_ray(middle + tile_at_px(in_film));
        var depth_m: f32;
        let point = hit_surface_point(seen.x - 1u, ray, &depth_m);
        // What grids stand for needs no list.
        if METHOD_GATHER == GATHER_CLUSTERS && bundle_single_share_at(point, seen.y) == 0.0 {
            continue;
        }
        let reach = gather_reach_m(point);
        sight.lower_m = min(sight.lower_m, point.position_m - reach);
        sight.upper_m = max(sight.upper_m, point.position_m + reach);
        sight.reach2_px = max(sight.reach2_px, tile_reach2_px(point, ray));
    }
    return sight;
}

// The square of the distance in pixels beyond which a scratch's line does not touch a pixel.
fn tile_reach2_px(point: SurfacePoint, ray: vec3f) -> f32 {
    let bent = abs(dot(ray, point.normal) / dot(ray, point.facet) - 1.0);
    // The side of a pixel on the surface where it is narrowest: the least singular value of its two steps.
    let step = max(frame.footprint_std_px, 1e-9);
    let x = point.footprint_x_m / step;
    let y = point.footprint_y_m / step;
    let mean = 0.5 * (dot(x, x) + dot(y, y));
    let product = dot(x, x) * dot(y, y) - dot(x, y) * dot(x, y);
    let narrowest2 = product / max(mean + sqrt(max(mean * mean - product, 0.0)), 1e-37);
    if !(narrowest2 > 0.0) {
        return 1e30;
    }
    let sigma_m = point.coherence_um * 1e-6;
    let filter_px = frame.footprint_std_px * gather_filtered();
    let reach = TILE_MARGIN * REACH_STD * sqrt(filter_px * filter_px + 0.5 * sigma_m * sigma_m / narrowest2) + TILE_MARGIN_PX;
    return select(1e30, reach * reach, bent < TILE_BENT);
}

struct TileLine {
    packed: u32,
    touches: bool,              // any pixel of the tile
}

// A segment's line in the picture.
fn tile_line(index: u32, corner: vec2u, sight: TileSight) -> TileLine {
    let segment = scratch_segment(index);
    let in_box = all(min(segment.start_m, segment.end_m) <= sight.upper_m)
        && all(max(segment.start_m, segment.end_m) >= sight.lower_m);
    let seen = segment_seen(segment.start_m, segment.end_m, tile_middle_px(corner));
    if !seen.has_line {
        return TileLine(0u, in_box);
    }
    // Half the diagonal of the pixels' centres, and a jitter.
    let touches = abs(seen.offset_px) <= 0.7072 * f32(TILE_PX) + sqrt(sight.reach2_px);
    return TileLine(pack_tile_line(seen.normal, seen.offset_px), in_box && touches);
}
