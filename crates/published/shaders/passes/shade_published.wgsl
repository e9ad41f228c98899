// Pass: base and scratches of a sample by the method of 2018, in place of shade_base and shade_scratches. Twin:
// src/cpu.rs.
// Needs: other_method, published_gather, published_base, film, pixel_point.

@compute @workgroup_size(8, 8)
fn shade_published(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    let object = points[at].object;
    if object == 0u {
        return;
    }
    let point = surface_point_from(points[at], paints[at]);
    let light = published_base(point);
    let fresnel = coated_reflectance(FresnelRgb(point.f0, point.f90, point.curve), point.coat, point.wo.z);
    let emission = point.emission;
    base_light[at] = BaseLight(light.specular, emission.x, light.diffuse, emission.y, fresnel, emission.z);
    if HAS_SCRATCHES {
        let sums = published_scratches(published_seen(point), objects[object - 1u], paints[at].triangle);
        chunk_sums[GROUP * group + lane] = ChunkSum(sums.radiance, sums.share, sums.energy, sums.share_by_line);
    }
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
}
