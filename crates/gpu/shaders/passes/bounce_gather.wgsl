// Passes: the scratches that each sample may see, by the tree over them: for samples that no tile has a list for. The first one counts them; the
// second one lists them. A workgroup a group. Twin: cpu/src/gather.rs.
// Needs: rows, film, pixel_point.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
// One more than samples; becomes prefix sums between the passes.
@group(3) @binding(1) var<storage, read_write> list_starts: array<u32>;
@group(3) @binding(2) var<storage, read_write> entries: array<vec4u>;
@group(3) @binding(3) var<storage, read_write> film: Film;
@group(3) @binding(4) var tree: texture_2d<u32>;

// Counts the segments that a sample may see; lists them from a place on, for one lane of a group.
fn gather(at: u32, group: u32, lane: u32, lists: bool, from_entry: u32) -> u32 {
    let paint = PixelPaint();
    let point = surface_point_from(points[at], paint);
    let object = objects[points[at].object - 1u];
    let reach_m = surface_reach_m(point);
    let lower_m = point.position_m - reach_m;
    let upper_m = point.position_m + reach_m;
    let near = select(vec2u(0u, 1u << (lane & 31u)), vec2u(1u << (lane & 31u), 0u), lane < 32u);
    var found = 0u;
    var i = object.first_node;
    while i < object.end_node {
        let node = scratch_node(tree, i);
        // Lanes that a software driver has switched off read zeros, and would go round for ever.
        if node.skip <= i {
            break;
        }
        let touches = all(node.min_m <= upper_m) && all(node.max_m >= lower_m);
        i = select(node.skip, i + 1u, touches);
        let first = node.leaf & ((1u << NODE_FIRST_BITS) - 1u);
        let count = select(0u, node.leaf >> NODE_FIRST_BITS, touches);
        if lists {
            for (var k = 0u; k < count; k += 1u) {
                entries[from_entry + found + k] = vec4u(group, first + k, near);
            }
        }
        found += count;
    }
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
    return found;
}

@compute @workgroup_size(8, 8)
fn bounce_count(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count {
        return;
    }
    let at = group_point(group, lane);
    var count = 0u;
    if group_has(group, lane) && points[at].object != 0u {
        count = gather(at, group, lane, false, 0u);
    }
    list_starts[GROUP * group + lane] = count;
    // The last element becomes the sum of all.
    if lane == 0u {
        list_starts[GROUP * frame.group_count] = 0u;
    }
}

@compute @workgroup_size(8, 8)
fn bounce_list(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object != 0u {
        gather(at, group, lane, true, list_starts[GROUP * group + lane]);
    }
}
