// Pass: weakens what scratches send by what is hidden of it. A workgroup a group. Twin: cpu/src/shadows.rs.

@group(3) @binding(2) var<storage, read> chunk_starts: array<u32>;
@group(3) @binding(3) var<storage, read> chunk_sums: array<ChunkSum>;
@group(3) @binding(4) var<storage, read_write> base_light: array<BaseLight>;
@group(3) @binding(5) var<uniform> shadow_round: ShadowRound;

@compute @workgroup_size(8, 8)
fn shadow_scratches(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    var open = vec3f(0.0);
    for (var chunk = chunk_starts[group]; chunk < chunk_starts[group + 1u]; chunk += 1u) {
        open += chunk_sums[GROUP * chunk + lane].radiance;
    }
    let even = even_half(group_pixel(group, lane), at, shadow_round);
    let odd = halves[2u * at + 1u];
    let lost = shadow_lost(
        open,
        mat2x3f(even.specular, even.specular_hidden),
        mat2x3f(odd.specular, odd.specular_hidden),
        shadow_round.rounds,
    );
    // Channels may be zero, or below zero where colours are out of gamut.
    let share = select(lost / open, vec3f(0.0), (lost == vec3f(0.0)) | (open == vec3f(0.0)));
    // The surface's reflectance is the last factor of what scratches send, and of nothing else.
    base_light[at].fresnel *= 1.0 - share;
}
