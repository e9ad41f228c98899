// Pass: takes what is hidden of it from what gratings send. A workgroup a group. Twin: cpu/src/shadows.rs.

@group(3) @binding(2) var<storage, read> chunk_starts: array<u32>;
@group(3) @binding(3) var<storage, read_write> chunk_sums: array<ChunkSum>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;

@compute @workgroup_size(8, 8)
fn shadow_gratings(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    // As sums.wgsl says.
    let sum = GROUP * (chunk_starts[frame.group_count] + group) + lane;
    let even = even_half(group_pixel(group, lane), at, shadow_round);
    let odd = halves[2u * at + 1u];
    chunk_sums[sum].radiance -= shadow_lost(
        chunk_sums[sum].radiance,
        mat2x3f(even.specular, even.specular_hidden),
        mat2x3f(odd.specular, odd.specular_hidden),
        shadow_round.rounds,
    );
}
