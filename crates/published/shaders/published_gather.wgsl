// The scratches under a pixel by the method of 2018: each pixel traverses the BVH by its skip pointers, or goes through a list of its
// triangle. Twin: src/cpu.rs.
// Needs: published_lights, published_footprint, triangle_lists, method, mask.

const REACH_STD: f32 = 3.5;
const FACING_MIN_COS: f32 = 0.2;
// Sides of the box that has the variance of a Gaussian of standard deviation 1: the square root of 12.
const PUBLISHED_BOX: f32 = 3.46410162;
// Segments seen and not yet lit. Finding and lighting are loops of their own, so that lanes that run in step do the same work.
const PUBLISHED_BATCH: u32 = 16u;

struct PublishedBatch {
    count: u32,
    segments: array<u32, PUBLISHED_BATCH>,
    shares: array<f32, PUBLISHED_BATCH>,
}

var<private> published_batch: PublishedBatch;

// The point as scratches are seen from it: without anti-aliasing it is the point in the pixel's middle.
fn published_seen(point: SurfacePoint) -> SurfacePoint {
    var seen = point;
    if !PUBLISHED_ANTI_ALIASING {
        seen.footprint_x_um = vec2f(0.0);
        seen.footprint_y_um = vec2f(0.0);
        seen.turn_x = vec2f(0.0);
        seen.turn_y = vec2f(0.0);
    }
    return seen;
}

// All scratches of the object under the point's footprint.
fn published_scratches(point: SurfacePoint, object: Object, triangle: u32) -> ScratchSums {
    var sums = ScratchSums(0.0, 0.0, vec3f(0.0), vec3f(0.0));
    published_batch.count = 0u;
    if PUBLISHED_LISTS {
        let list = triangle_list(triangle);
        for (var i = list.x; i < list.y; i += 1u) {
            published_weigh(point, triangle_list_segment(i), &sums);
        }
        published_light(point, &sums);
        return sums;
    }
    let reach_m = surface_reach_m(point);
    let lower_m = point.position_m - reach_m;
    let upper_m = point.position_m + reach_m;
    var at = object.first_node;
    while at < object.end_node {
        let node = scratch_node(scratch_nodes, at);
        // Lanes that a software driver has switched off read zeros, and would go round for ever.
        if node.skip <= at {
            break;
        }
        let touches = all(node.min_m <= upper_m) && all(node.max_m >= lower_m);
        at = select(node.skip, at + 1u, touches);
        let first = node.leaf & ((1u << NODE_FIRST_BITS) - 1u);
        let count = select(0u, node.leaf >> NODE_FIRST_BITS, touches);
        for (var i = first; i < first + count; i += 1u) {
            published_weigh(point, i, &sums);
        }
    }
    published_light(point, &sums);
    return sums;
}

// Share of a segment that a pixel sees, and its density.
struct PublishedWeight {
    share: ScratchShare,
    density: f32,
}

// Weight of a segment at a point; 0 if the segment lies on another side of the surface or out of the footprint's reach.
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
    let reach2 = REACH_STD * REACH_STD * (footprint.across_sq_um + 0.5 * sigma * sigma);
    let elsewhere = dot(segment.normal, point.normal) < FACING_MIN_COS;
    if offset_um * offset_um > reach2 || elsewhere || !(view.end.x > view.start.x) {
        return PublishedWeight(ScratchShare(0.0, 0.0, 1.0), 0.0);
    }
    let width_um = segment.profile.width_um;
    if !PUBLISHED_ANTI_ALIASING {
        let share = scratch_share(width_um, offset_um, view.start.x, view.end.x, segment.blur_um, footprint, sigma);
        return PublishedWeight(share, 2.0 * share.segment);
    }
    let pixel = PixelFootprint(PUBLISHED_BOX * axis_x, PUBLISHED_BOX * axis_y);
    let seen = published_share(width_um, offset_um, view.start.x, view.end.x, segment.blur_um, pixel, sigma);
    var line = 0.0;
    if METHOD_MASK == MASK_ENERGY {
        line = published_share(width_um, offset_um, -1e9, 1e9, segment.blur_um, pixel, sigma).share;
    }
    return PublishedWeight(ScratchShare(seen.share, line, 1.0), seen.density);
}

// Adds the share of a segment and what it takes from the base; keeps it to be lit.
fn published_weigh(point: SurfacePoint, index: u32, sums: ptr<function, ScratchSums>) {
    let segment = segment_from(scratch_segment(index));
    let weight = published_weight(point, segment, published_view(point, segment));
    if !(weight.share.segment > 0.0) {
        return;
    }
    var taken = vec3f(weight.density / weight.share.segment);
    if METHOD_MASK != MASK_DENSITY {
        taken = published_total(point.table, segment.profile.depth_nm);
    }
    mask_add(sums, weight.share, taken, vec3f(0.0));
    if published_batch.count == PUBLISHED_BATCH {
        published_light(point, sums);
    }
    published_batch.segments[published_batch.count] = index;
    published_batch.shares[published_batch.count] = weight.share.segment;
    published_batch.count += 1u;
}

// Lights the segments that wait.
fn published_light(point: SurfacePoint, sums: ptr<function, ScratchSums>) {
    for (var i = 0u; i < published_batch.count; i += 1u) {
        let view = published_view(point, segment_from(scratch_segment(published_batch.segments[i])));
        var radiance = vec3f(0.0);
        for (var l = 0u; l < frame.light_count; l += 1u) {
            let light = light_at(l);
            let sent = published_light_radiance(light, point.position_m);
            if HAS_SPHERES && light.kind == LIGHT_SPHERE {
                radiance += sent * published_sphere(point, view, light);
            }
            if HAS_POLYGONS && light.kind != LIGHT_SPHERE {
                radiance += sent * published_polygon(point, view, light);
            }
        }
        if HAS_ENVIRONMENT {
            radiance += published_environment(point, view);
        }
        (*sums).radiance += published_batch.shares[i] * radiance;
    }
    published_batch.count = 0u;
}
