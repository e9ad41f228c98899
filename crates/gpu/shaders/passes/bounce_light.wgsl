// Pass: what the rays have met sends, added to the samples that the camera sees. A workgroup a group. Twin: cpu/src/bounces.rs.

@group(3) @binding(0) var<storage, read> rays: array<BounceRay>;
@group(3) @binding(1) var<storage, read> base_light: array<BaseLight>;
@group(3) @binding(2) var<storage, read_write> bounced: array<Bounced>;
// 3 and 4: sums.wgsl.
@group(3) @binding(5) var<storage, read_write> film: Film;
@group(3) @binding(6) var<uniform> shadow_round: ShadowRound;

@compute @workgroup_size(8, 8)
fn bounce_light(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    let ray = rays[at];
    if !(ray.distance_m > 0.0) {
        return;
    }
    var scratches = Masked(vec3f(0.0), vec3f(0.0));
    if HAS_SCRATCHES {
        let sums = sample_sums(group, lane);
        if sums.cut > 0u {
            atomicAdd(&film.gave_up, sums.cut);
        }
        scratches = masked(sums.all, objects[ray.object].depth_coherence);
    }
    let light = base_light[at];
    let gratings = under_scratches(grating_sums(group, lane), scratches.taken);
    let radiance = light.body + light.specular * (1.0 - gratings.taken) + scratches.scratches * light.fresnel + gratings.scratches;
    if shadow_round.way == BOUNCE_BY_BASE {
        bounced[at].base += ray.throughput * radiance;
    } else {
        bounced[at].scratches += ray.throughput * radiance;
    }
}
