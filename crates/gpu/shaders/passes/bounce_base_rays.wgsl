// Pass: for each sample a ray by the lobes of its base. A workgroup a group. Twin: cpu/src/shadows/base.rs.
// Needs: bounce, traced, base_lobes, sums, pixel_point.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
// Holds the way by which the camera sees the samples, at first.
@group(3) @binding(2) var<storage, read_write> rays: array<BounceRay>;
// 3 and 4: sums.wgsl.
@group(3) @binding(5) var<uniform> shadow_round: ShadowRound;
// Light that rays found for the samples that the camera sees.
@group(3) @binding(6) var<storage, read_write> traced: array<TracedRays>;

@compute @workgroup_size(8, 8)
fn bounce_base_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    var ray: BounceRay;
    if points[at].object == 0u {
        rays[at] = ray;
        return;
    }
    var taken = vec3f(0.0);
    if HAS_SCRATCHES && shadow_round.depth > 0u {
        taken = masked(sample_sums(group, lane).all, objects[points[at].object - 1u].depth_coherence).taken;
    }
    let point = surface_point_from(points[at], paints[at]);
    let seed = shadow_seed(point.position_m, shadow_round);
    let gratings = grating_sums(group, lane).taken;
    let way = bounce_way(SHADOW_BY_BASE, taken, gratings, shadow_round);
    if !bounce_goes(way, shadow_random(seed, shadow_round, BOUNCE_WAY).x) {
        return;
    }
    let lobes = base_lobes(point);
    if shadow_round.depth == 0u && shadow_round.round == 0u {
        let around = base_lobes_around(lobes);
        traced[traced_at(at, TRACED_SPECULAR)].around = around.specular;
        traced[traced_at(at, TRACED_BODY)].around = around.diffuse;
    }
    let choice = shadow_random(seed, shadow_round, BOUNCE_CHOICE);
    let wi = base_lobes_sample(lobes, choice.x, shadow_random(seed, shadow_round, BOUNCE_DIRECTION));
    let density = base_lobes_pdf(lobes, wi);
    if base_lobes_above(lobes, wi) && density > 0.0 {
        let each_sr = 1.0 / (f32(shadow_round.all_rounds) * density);
        let sent = base_lobes_eval(lobes, wi);
        let body = sent.diffuse / (density * way.share);
        var specular = sent.specular / (density * way.share);
        if shadow_round.depth > 0u {
            // shadow_traced.wgsl does it for samples that the camera sees.
            specular = specular * (1.0 - taken) * (1.0 - gratings) + body;
        }
        let start = shadow_normals(shadow_random(seed, shadow_round, BOUNCE_START));
        ray = bounce_ray(rays[at], world_from_surface(point, wi), specular, body, each_sr, start, shadow_round);
    }
    rays[at] = ray;
}
