// The scratches under a pixel by the method of 2018, or by parts of it among the default's. Each pixel walks the hierarchy
// by its skip pointers, or a list of its triangle. Twin: reference/src/published.rs.

// Needs, beside its modules: scratch_nodes, scratch_segments, lights, triangle_lists.

// Sides of the box that has the variance of a Gaussian of standard deviation 1: the square root of 12.
const PUBLISHED_BOX: f32 = 3.46410162;
// Segments seen and not yet lit. Finding and lighting are loops of their own, so that no driver that executes both sides of
// every branch lights a scratch at each node.
const PUBLISHED_BATCH: u32 = 16u;

struct PublishedBatch {
    count: u32,
    segments: array<u32, PUBLISHED_BATCH>,
    shares: array<f32, PUBLISHED_BATCH>,
}

var<private> published_batch: PublishedBatch;

// The point as scratches are seen from it: without a footprint it is the point in the pixel's middle.
fn published_seen(point: SurfacePoint) -> SurfacePoint {
    var seen = point;
    if METHOD_FOOTPRINT == FOOTPRINT_OFF {
        seen.footprint_x_m = vec3f(0.0);
        seen.footprint_y_m = vec3f(0.0);
        seen.turn_x = vec2f(0.0);
        seen.turn_y = vec2f(0.0);
    }
    return seen;
}

// Where a walk is at its end. It counts nodes, or places in a triangle's list from the object's first node on.
fn published_walk_end(object: Object, triangle: u32) -> u32 {
    if METHOD_LOOKUP == LOOKUP_TRIANGLES {
        let list = triangle_list(triangle);
        return object.first_node + list.y - list.x;
    }
    return object.end_node;
}

// Walks on to the end or until the rounds are spent.
fn published_scratches(point: SurfacePoint, object: Object, triangle: u32, end: u32, walk: ptr<function, ScratchWalk>) {
    let reach_m = gather_reach_m(point);
    // So that a batch cannot spend many more rounds than there are.
    let cells = select(0u, ENVIRONMENT_CELLS, HAS_ENVIRONMENT);
    let chords = frame.light_count * select(4u, 20u, METHOD_BAND == BAND_LINES);
    let rounds = (chords + cells) * (2u * METHOD_WAVELENGTHS + 2u) + 1u;
    let most = clamp(GATHER_MAX_ROUNDS / rounds, LEAF_SEGMENTS, PUBLISHED_BATCH);
    while (*walk).at < end && gather_rounds < GATHER_MAX_ROUNDS {
        gather_rounds += 1u;
        var found = 0u;
        if METHOD_LOOKUP == LOOKUP_TRIANGLES {
            found = published_find_listed(object, triangle, end, most, walk, &found_segments);
        } else {
            var at = (*walk).at;
            found = find_segments(point.position_m - reach_m, point.position_m + reach_m, end, most, &at, &found_segments);
            (*walk).at = at;
        }
        published_weigh(point, found, &found_segments, &published_batch, walk);
        published_light(point, &published_batch, walk);
    }
}

// The next segments of the triangle's list.
fn published_find_listed(
    object: Object,
    triangle: u32,
    end: u32,
    most: u32,
    walk: ptr<function, ScratchWalk>,
    segments: ptr<private, array<u32, FIND_SEGMENTS>>,
) -> u32 {
    let at = (*walk).at;
    let count = min(end - at, most);
    let first = triangle_list(triangle).x + at - object.first_node;
    for (var i = 0u; i < count; i += 1u) {
        (*segments)[i] = triangle_list_segment(first + i);
        gather_rounds += 1u;
    }
    (*walk).at = at + count;
    return count;
}

// What a pixel sees of a segment.
struct PublishedWeight {
    share: ScratchShare,
    density: f32,
}

// Nothing where the segment lies on another side of the surface or out of the footprint's reach.
fn published_weight(point: SurfacePoint, segment: Segment, view: PublishedView) -> PublishedWeight {
    let axis_x = view.axis_x;
    let axis_y = view.axis_y;
    let footprint = Footprint(
        axis_x.y * axis_x.y + axis_y.y * axis_y.y,
        axis_x.x * axis_x.x + axis_y.x * axis_y.x,
        axis_x.x * axis_x.y + axis_y.x * axis_y.y,
    );
    let sigma = point.coherence_um;
    let offset_um = published_offset_um(view);
    let reach2 = REACH_STD * REACH_STD * (footprint.across_um2 + 0.5 * sigma * sigma);
    let elsewhere = dot(segment.normal, point.normal) < FACING_MIN_COS;
    if offset_um * offset_um > reach2 || elsewhere || !(view.end.x > view.start.x) {
        return PublishedWeight(ScratchShare(0.0, 0.0), 0.0);
    }
    let width_um = segment.width_um;
    if METHOD_FOOTPRINT != FOOTPRINT_PUBLISHED {
        let share = scratch_share(width_um, offset_um, view.start.x, view.end.x, segment.blur_um, footprint, sigma);
        return PublishedWeight(share, 2.0 * share.segment);
    }
    let pixel = PixelFootprint(PUBLISHED_BOX * axis_x.xy, PUBLISHED_BOX * axis_y.xy);
    let seen = published_share(width_um, offset_um, view.start.x, view.end.x, segment.blur_um, pixel, sigma);
    var line = 0.0;
    if METHOD_MASK == MASK_ENERGY {
        line = published_share(width_um, offset_um, -1e9, 1e9, segment.blur_um, pixel, sigma).share;
    }
    return PublishedWeight(ScratchShare(seen.share, line), seen.density);
}

// The share of each segment and what it takes from the base; keeps those that are seen.
fn published_weigh(
    point: SurfacePoint,
    found: u32,
    segments: ptr<private, array<u32, FIND_SEGMENTS>>,
    batch: ptr<private, PublishedBatch>,
    walk: ptr<function, ScratchWalk>,
) {
    var sums = (*walk).sums;
    var kept = 0u;
    for (var i = 0u; i < found; i += 1u) {
        gather_rounds += 1u;
        let index = (*segments)[i];
        let segment = segment_at(index);
        let weight = published_weight(point, segment, published_view(point, segment));
        if weight.share.segment > 0.0 {
            var taken = vec3f(weight.density / weight.share.segment);
            if METHOD_MASK != MASK_DENSITY {
                taken = published_total(point.table, published_mirror_depth_nm(point, segment.depth_nm));
            }
            mask_add(&sums, weight.share, taken, vec3f(0.0));
            (*batch).segments[kept] = index;
            (*batch).shares[kept] = weight.share.segment;
            kept += 1u;
        }
    }
    (*walk).sums = sums;
    (*batch).count = kept;
}

// Their light.
fn published_light(point: SurfacePoint, batch: ptr<private, PublishedBatch>, walk: ptr<function, ScratchWalk>) {
    for (var i = 0u; i < (*batch).count; i += 1u) {
        gather_rounds += 1u;
        let view = published_view(point, segment_at((*batch).segments[i]));
        var radiance = vec3f(0.0);
        if HAS_SPHERES {
            for (var l = published_next_light(0u, LIGHT_SPHERE); l < frame.light_count; l = published_next_light(l + 1u, LIGHT_SPHERE)) {
                radiance += light_at(l).radiance * published_sphere(point, view, light_at(l));
                gather_rounds += 1u;
            }
        }
        if HAS_POLYGONS {
            for (var l = published_next_light(0u, LIGHT_POLYGON); l < frame.light_count; l = published_next_light(l + 1u, LIGHT_POLYGON)) {
                radiance += light_at(l).radiance * published_polygon(point, view, light_at(l));
                gather_rounds += 1u;
            }
        }
        if HAS_ENVIRONMENT {
            radiance += published_environment(point, view);
        }
        (*walk).sums.radiance += (*batch).shares[i] * radiance;
    }
}
