// Pass: the radiance of the base, before scratches take their part. A workgroup a group. Twin: cpu/src/shade_base.rs.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read_write> base_light: array<BaseLight>;
@group(3) @binding(3) var<storage, read_write> film: Film;

@compute @workgroup_size(8, 8)
fn shade_base(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    let point = surface_point_from(points[at], paints[at]);
    let light = base_radiance(point);
    let fresnel = coated_reflectance(FresnelRgb(point.f0, point.f90, point.curve), point.coat, point.wo.z);
    let emission = point.emission;
    base_light[at] = BaseLight(light.specular, emission.x, light.diffuse, emission.y, fresnel, emission.z);
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
}
