// Pass: takes what is hidden of one source from the radiance of the base. A workgroup a group. Twin: cpu/src/shadows.rs.

@group(3) @binding(2) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(3) var<storage, read_write> base_light: array<BaseLight>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;

@compute @workgroup_size(8, 8)
fn shadow_base(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    let even = even_half(group_pixel(group, lane), at, shadow_round);
    let odd = halves[2u * at + 1u];
    // Most samples see all of most lights.
    if all(even.specular_hidden + even.body_hidden == vec3f(0.0))
        && (shadow_round.rounds < 2u || all(odd.specular_hidden + odd.body_hidden == vec3f(0.0))) {
        return;
    }
    let point = surface_point_from(points[at], paints[at]);
    let source = shadow_round.source;
    let open = base_radiance_of(point, vec2u(source, min(source + 1u, frame.light_count)), source >= frame.light_count);
    base_light[at].specular -= shadow_lost(
        open.specular,
        mat2x3f(even.specular, even.specular_hidden),
        mat2x3f(odd.specular, odd.specular_hidden),
        shadow_round.rounds,
    );
    base_light[at].body -= shadow_lost(
        open.diffuse,
        mat2x3f(even.body, even.body_hidden),
        mat2x3f(odd.body, odd.body_hidden),
        shadow_round.rounds,
    );
}
