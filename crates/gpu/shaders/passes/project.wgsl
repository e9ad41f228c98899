// Pass: from segments to the picture. One invocation a segment counts the tiles that its line comes near to; bin.wgsl lists it there.
// Twin: cpu/src/project.rs.
// Needs: projected.

@group(3) @binding(0) var<storage, read_write> entry_starts: array<u32>;

@compute @workgroup_size(256)
fn project(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let index = 256u * (workgroup.y * workgroups.x + workgroup.x) + lane;
    if index > frame.segment_count {
        return;
    }
    var count = 0u;
    // The last element becomes the sum of all.
    if index < frame.segment_count {
        let line = project_segment(index);
        for (var row = line.first_row; row < line.end_row; row += 1u) {
            let columns = projected_columns(line, row);
            count += columns.y - columns.x;
        }
    }
    entry_starts[index] = count;
}
