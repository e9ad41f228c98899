// Look-ups in the fitted tables: rgba32float, x = sqrt(viewer's cosine), y = roughness, both from 0 to 1 across the nodes.
// albedo: E0, E1, E2. ltc: width_x, width_y, lean. sptd: width, lean.
// Twin: optics::lobe_table.

const LOBE_MIN_COS: f32 = 1e-3;

fn lobe_table_lookup(table: texture_2d<f32>, roughness: f32, cos_o: f32) -> vec4f {
    let last = f32(textureDimensions(table).x) - 1.0;
    let at = vec2f(sqrt(clamp(cos_o, 0.0, 1.0)), clamp(roughness, 0.0, 1.0)) * last;
    let corner = min(floor(at), vec2f(last - 1.0));
    let f = at - corner;
    let i = vec2i(corner);
    let low = mix(textureLoad(table, i, 0), textureLoad(table, i + vec2i(1, 0), 0), f.x);
    let high = mix(
        textureLoad(table, i + vec2i(0, 1), 0),
        textureLoad(table, i + vec2i(1, 1), 0),
        f.x,
    );
    return mix(low, high, f.y);
}

fn lobe_albedo_lookup(albedo_table: texture_2d<f32>, roughness: f32, cos_o: f32) -> vec3f {
    return lobe_table_lookup(albedo_table, roughness, cos_o).xyz;
}
