// Pass: the radiance of the base, before scratches take their part. A workgroup a group. Twin: cpu/src/shade_base.rs.
// Needs: base, pixel_parts, film, pixel_point.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read_write> base_light: array<BaseLight>;
@group(3) @binding(3) var<storage, read_write> film: Film;

// Of a sample: the mean over its parts, if it has any.
fn pixel_base_radiance(at: u32) -> BaseRadiance {
    if !HAS_BUMPS {
        return base_radiance(surface_point_from(points[at], paints[at]));
    }
    let along = max(pixel_parts_along(points[at]), 1u);
    var light: BaseRadiance;
    for (var i = 0u; i < along * along; i += 1u) {
        // Made within the loop, which leaves fewer registers in use from part to part.
        var part: SurfacePoint;
        if along > 1u {
            part = pixel_part(points[at].position_m, paints[at].triangle, along, i);
        } else {
            part = surface_point_from(points[at], paints[at]);
        }
        let weight = parts_weight(along, i);
        let by_part = base_radiance(part);
        light.specular += weight * by_part.specular;
        light.diffuse += weight * by_part.diffuse;
    }
    return light;
}

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
    let light = pixel_base_radiance(at);
    let point = surface_point_from(points[at], paints[at]);
    let fresnel = coated_reflectance(FresnelRgb(point.f0, point.f90, point.curve), point.coat, point.wo.z);
    let emission = point.emission;
    base_light[at] = BaseLight(light.specular, emission.x, light.diffuse, emission.y, fresnel, emission.z);
    if loops_were_cut() {
        atomicAdd(&film.gave_up, 1u);
    }
}
