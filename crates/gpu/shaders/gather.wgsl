// The scratches under a footprint and the light that they send to the viewer. Twin: reference/src/scratches.rs.

// The work is cut into stages, each a loop of its own: find segments, weigh them, then for each light ask which it reaches, and
// light those (gather_light.wgsl). Lanes of a processor that runs many in step then do the same work at the same time, and the
// dear stages run only as often as they must; in one nest of loops, every lane would wait for the dearest step of any.

// Segments that one batch holds.
const GATHER_SEGMENTS: u32 = 64u;

// Segments with a share under the pixel.
struct GatherBatch {
    count: u32,
    grooves: array<u32, GATHER_SEGMENTS>,       // width and depth, packed
    tangents: array<vec2f, GATHER_SEGMENTS>,    // in the surface's frame
    offsets_um: array<f32, GATHER_SEGMENTS>,    // across the tangent
    shares: array<f32, GATHER_SEGMENTS>,
    lit: array<u32, GATHER_SEGMENTS>,           // which of them a light reaches
}

// Whether pixels of tiles light batch after batch. Where few see more than one holds, a software driver has them walk: a loop about all
// of it would cost every pixel a twentieth.
override GATHER_BATCHES: bool = true;

// Of the module and not of a function, as all arrays here: WGSL has variables cleared where they are declared. In a function that is called
// under a condition a software driver does that element by element and lane by lane, as often as it comes there, and the code for it takes
// as long to compile as the rest.
var<private> gather_batch: GatherBatch;

// Loop rounds that a segment may take: to be asked for and lit by each light on several lines, and by the environment.
fn gather_rounds_a_segment() -> u32 {
    return 1u + 8u * frame.light_count + select(0u, 2u * ENVIRONMENT_CELLS, HAS_ENVIRONMENT);
}

// Walks on under the point's footprint, to the object's last node or until the rounds are spent.
// `single_share` is the weight of scratches that are looked at one by one.
fn gather_scratches(
    point: SurfacePoint,
    object: Object,
    list: SegmentList,
    single_share: f32,
    walk: ptr<function, ScratchWalk>,
) {
    var pixel = gather_pixel(point);
    pixel.single_share = single_share;
    let reach_m = gather_reach_m(point);
    let most = clamp(GATHER_MAX_ROUNDS / gather_rounds_a_segment(), LEAF_SEGMENTS, FIND_SEGMENTS);
    var sums = (*walk).sums;
    while (*walk).at < object.end_node || (*walk).at >= WALK_LISTED {
        if gather_rounds >= GATHER_MAX_ROUNDS {
            break;
        }
        gather_rounds += 1u;
        var found = 0u;
        if METHOD_LOOKUP == LOOKUP_TRIANGLES {
            found = gather_find_listed(list, most, walk, &found_segments);
        } else {
            var at = (*walk).at;
            found = find_segments(point.position_m - reach_m, point.position_m + reach_m, object.end_node, most, &at, &found_segments);
            (*walk).at = at;
        }
        gather_batch.count = 0u;
        for (var i = 0u; i < found; i += 1u) {
            gather_rounds += 1u;
            gather_weigh(point, pixel, found_segments[i], &gather_batch, &sums);
        }
        sums.radiance += gather_light(point, pixel, &gather_batch);
    }
    (*walk).sums = sums;
}

// Stage 1, from a triangle's list: the segments that may touch the pixel, until the batch is full.
fn gather_find_listed(
    list: SegmentList,
    most: u32,
    walk: ptr<function, ScratchWalk>,
    segments: ptr<private, array<u32, FIND_SEGMENTS>>,
) -> u32 {
    var found = 0u;
    var at = (*walk).at & ~WALK_LISTED;
    while at < list.count && found < most && gather_rounds < GATHER_MAX_ROUNDS {
        gather_rounds += 1u;
        (*segments)[found] = triangle_list_segment(list.first + at);
        found += 1u;
        at += 1u;
    }
    (*walk).at = select(list.end_node, at | WALK_LISTED, at < list.count);
    return found;
}

// Stage 2: the share of a segment, and the energy that it takes from the base. Without a share it is dropped: on another side
// of the surface, or out of the footprint's reach. The batch must have room.
fn gather_weigh(
    point: SurfacePoint,
    pixel: GatherPixel,
    index: u32,
    batch: ptr<private, GatherBatch>,
    sums: ptr<function, ScratchSums>,
) {
    let segment = segment_at(index);
    let start_um = surface_from_world(point, segment.start_m - point.position_m).xy * 1e6;
    let end_um = surface_from_world(point, segment.end_m - point.position_m).xy * 1e6;
    let chord_um = end_um - start_um;
    let length2 = dot(chord_um, chord_um);
    let tangent = chord_um * inverseSqrt(max(length2, 1e-30));
    let across = vec2f(-tangent.y, tangent.x);
    let offset_um = 0.5 * dot(across, start_um + end_um);
    let footprint = gather_footprint(pixel, tangent);
    let near = offset_um * offset_um <= REACH_STD * REACH_STD * (footprint.across_um2 + pixel.window_um2);
    if !near || !(length2 > 0.0) || dot(segment.normal, point.normal) < FACING_MIN_COS {
        return;
    }
    let start = dot(tangent, start_um);
    let end = dot(tangent, end_um);
    var share = scratch_share(segment.width_um, offset_um, start, end, segment.blur_um, footprint, point.coherence_um);
    share.segment *= pixel.single_share;
    if !(share.segment > 0.0) {
        return;
    }
    // In the mirror's direction both cosines are the viewer's.
    let depth_nm = oblique_depth_nm(segment.depth_nm, point.wo.z, point.wo.z);
    mask_add(sums, share, scratch_table_total(scratch_tables, point.table, depth_nm), vec3f(0.0));
    let slot = (*batch).count;
    (*batch).grooves[slot] = segment.width_depth;
    (*batch).tangents[slot] = tangent;
    (*batch).offsets_um[slot] = offset_um;
    (*batch).shares[slot] = share.segment;
    (*batch).count = slot + 1u;
}

// Stages 3 and 4: the light of a batch.
fn gather_light(point: SurfacePoint, pixel: GatherPixel, batch: ptr<private, GatherBatch>) -> vec3f {
    var radiance = vec3f(0.0);
    if HAS_MANY_LIGHTS {
        radiance += gather_light_pairs(point, pixel, batch);
    } else if HAS_SPHERES || HAS_POLYGONS {
        radiance += gather_light_by_light(point, pixel, batch);
    }
    if HAS_ENVIRONMENT {
        for (var i = 0u; i < (*batch).count; i += 1u) {
            gather_rounds += 1u;
            let lit = gather_lit((*batch).grooves[i], (*batch).tangents[i], (*batch).offsets_um[i]);
            radiance += (*batch).shares[i] * gather_environment(point, lit);
        }
    }
    return radiance;
}

// Few lights: what is the same for all segments under a light is found once.
fn gather_light_by_light(point: SurfacePoint, pixel: GatherPixel, batch: ptr<private, GatherBatch>) -> vec3f {
    var radiance = vec3f(0.0);
    let light_count = select(frame.light_count, 0u, (*batch).count == 0u);
    for (var l = 0u; l < light_count; l += 1u) {
        gather_rounds += 1u;
        let seen = gather_light_seen(point, pixel, l);
        var reached = 0u;
        let count = select(0u, (*batch).count, seen.shines);
        for (var i = 0u; i < count; i += 1u) {
            gather_rounds += 1u;
            (*batch).lit[reached] = i;
            reached += u32(gather_reaches(point, pixel, seen, (*batch).tangents[i], (*batch).offsets_um[i]));
        }
        if HAS_SPHERES {
            for (var i = 0u; i < select(0u, reached, seen.kind == LIGHT_SPHERE); i += 1u) {
                radiance += gather_pair(point, pixel, seen, (*batch).lit[i], LIGHT_SPHERE, batch);
            }
        }
        if HAS_POLYGONS {
            for (var i = 0u; i < select(0u, reached, seen.kind == LIGHT_POLYGON && seen.is_small); i += 1u) {
                radiance += gather_pair(point, pixel, seen, (*batch).lit[i], LIGHT_POLYGON, batch);
            }
        }
        if HAS_LARGE_POLYGONS {
            for (var i = 0u; i < select(0u, reached, seen.kind == LIGHT_POLYGON && !seen.is_small); i += 1u) {
                radiance += gather_pair(point, pixel, seen, (*batch).lit[i], LIGHT_LARGE_POLYGON, batch);
            }
        }
    }
    return radiance;
}

// Many lights: first all pairs of a segment and a light that reaches it are found, spheres from the front, polygons from the
// back; then those are lit, whichever light it is. Most pairs are dark.
const GATHER_PAIRS: u32 = 128u;
var<private> gather_pairs: array<u32, GATHER_PAIRS>;

fn gather_light_pairs(point: SurfacePoint, pixel: GatherPixel, batch: ptr<private, GatherBatch>) -> vec3f {
    var radiance = vec3f(0.0);
    // So that all pairs have room; with more lights than that, they take turns.
    let at_once = GATHER_PAIRS / max((*batch).count, 1u);
    let light_count = select(frame.light_count, 0u, (*batch).count == 0u);
    for (var first = 0u; first < light_count; first += at_once) {
        gather_rounds += 1u;
        var spheres = 0u;
        var polygons = 0u;
        let end = min(first + at_once, light_count);
        for (var l = first; l < end; l += 1u) {
            gather_rounds += 1u;
            let seen = gather_light_seen(point, pixel, l);
            let count = select(0u, (*batch).count, seen.shines);
            for (var i = 0u; i < count; i += 1u) {
                gather_rounds += 1u;
                let reaches = gather_reaches(point, pixel, seen, (*batch).tangents[i], (*batch).offsets_um[i]);
                let is_sphere = seen.kind == LIGHT_SPHERE;
                gather_pairs[select(GATHER_PAIRS - 1u - polygons, spheres, is_sphere)] = i | (l << 8u);
                spheres += u32(reaches && is_sphere);
                polygons += u32(reaches && !is_sphere);
            }
        }
        if HAS_SPHERES {
            for (var i = 0u; i < spheres; i += 1u) {
                let seen = gather_light_seen(point, pixel, gather_pairs[i] >> 8u);
                radiance += gather_pair(point, pixel, seen, gather_pairs[i] & 0xffu, LIGHT_SPHERE, batch);
            }
        }
        if HAS_POLYGONS {
            for (var i = 0u; i < polygons; i += 1u) {
                let pair = gather_pairs[GATHER_PAIRS - 1u - i];
                let seen = gather_light_seen(point, pixel, pair >> 8u);
                if HAS_LARGE_POLYGONS && !seen.is_small {
                    radiance += gather_pair(point, pixel, seen, pair & 0xffu, LIGHT_LARGE_POLYGON, batch);
                } else {
                    radiance += gather_pair(point, pixel, seen, pair & 0xffu, LIGHT_POLYGON, batch);
                }
            }
        }
    }
    return radiance;
}

// A kind of its own here: a polygon whose outline is walked vertex by vertex.
const LIGHT_LARGE_POLYGON: u32 = 2u;

// The light of one pair; `kind` is known where this is called.
fn gather_pair(
    point: SurfacePoint,
    pixel: GatherPixel,
    seen: LightSeen,
    slot: u32,
    kind: u32,
    batch: ptr<private, GatherBatch>,
) -> vec3f {
    gather_rounds += 1u;
    let lit = gather_lit((*batch).grooves[slot], (*batch).tangents[slot], (*batch).offsets_um[slot]);
    var radiance: vec3f;
    if kind == LIGHT_SPHERE {
        radiance = gather_sphere(point, pixel, lit, seen);
    } else if kind == LIGHT_POLYGON {
        radiance = gather_polygon(point, pixel, lit, seen);
    } else {
        radiance = gather_large_polygon(point, pixel, lit, seen);
    }
    return (*batch).shares[slot] * seen.radiance * radiance;
}
