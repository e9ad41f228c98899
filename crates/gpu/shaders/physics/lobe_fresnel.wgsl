// Reflectance of the facets of a lobe. Needs fresnel, lobe_table. Twin: LobeFresnel of optics::ltc.
// Needs: fresnel, lobe_table.

struct LobeFresnel {
    fresnel: FresnelRgb,
    albedo: vec3f,              // of the whole lobe, single scattering
}

fn lobe_fresnel(fresnel: FresnelRgb, wo: vec3f, roughness: f32, curves: texture_2d<f32>) -> LobeFresnel {
    return LobeFresnel(fresnel, fresnel_of_parts(fresnel, lobe_curve_albedo(curves, fresnel.curve, roughness, max(wo.z, LOBE_MIN_COS))));
}

// The bilinear look-up of lobe_table_lookup in the grid below a curve.
fn lobe_curve_albedo(curves: texture_2d<f32>, curve: u32, roughness: f32, cos_o: f32) -> vec4f {
    let at = lobe_table_at(LOBE_TABLE_SIZE, roughness, cos_o);
    let i = vec2i(at.corner);
    let low = mix(lobe_curve_node(curves, curve, i), lobe_curve_node(curves, curve, i + vec2i(1, 0)), at.share.x);
    let high = mix(lobe_curve_node(curves, curve, i + vec2i(0, 1)), lobe_curve_node(curves, curve, i + vec2i(1, 1)), at.share.x);
    return mix(low, high, at.share.y);
}

fn lobe_curve_node(curves: texture_2d<f32>, curve: u32, node: vec2i) -> vec4f {
    let first = i32(curve * FRESNEL_CURVE_ROWS) + 1;
    return textureLoad(curves, vec2i(node.x + 32 * (node.y % 4), first + node.y / 4), 0);
}
