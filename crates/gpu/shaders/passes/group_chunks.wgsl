// Pass: number of chunks into which the list of each group is cut. One invocation a group.
// Needs: groups.

@group(3) @binding(1) var<storage, read> list_starts: array<u32>;
// One more than groups; becomes prefix sums.
@group(3) @binding(2) var<storage, read_write> chunk_starts: array<u32>;

@compute @workgroup_size(64)
fn group_chunks(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = GROUP * (workgroup.y * workgroups.x + workgroup.x) + lane;
    if group > frame.group_count {
        return;
    }
    var count = 0u;
    if group < frame.group_count {
        let list = group_list(group);
        count = (list_starts[list.y] - list_starts[list.x] + CHUNK_SEGMENTS - 1u) / CHUNK_SEGMENTS;
    }
    chunk_starts[group] = count;
}
