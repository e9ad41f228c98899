// Look-ups in the fitted tables: rgba32float, x = sqrt(viewer's cosine), y = roughness, both from 0 to 1 across the nodes.
// albedo: E0. shapes: width_x, width_y, lean of the transformed cosine; in the tables under it what environment_lobe looks up.
// Twin: optics::lobe_table.

const LOBE_MIN_COS: f32 = 1e-3;

const LOBE_TABLE_SIZE: f32 = 32.0;

struct LobeTablePlace {
    corner: vec2f,
    share: vec2f,
}

fn lobe_table_at(size: f32, roughness: f32, cos_o: f32) -> LobeTablePlace {
    let at = vec2f(sqrt(clamp(cos_o, 0.0, 1.0)), clamp(roughness, 0.0, 1.0)) * (size - 1.0);
    let corner = min(floor(at), vec2f(size - 2.0));
    return LobeTablePlace(corner, at - corner);
}

fn lobe_table_lookup(table: texture_2d<f32>, roughness: f32, cos_o: f32) -> vec4f {
    return lobe_table_lookup_below(table, 0, roughness, cos_o);
}

// Looks up a table that lies below others, `first_row` rows down.
fn lobe_table_lookup_below(table: texture_2d<f32>, first_row: i32, roughness: f32, cos_o: f32) -> vec4f {
    let at = lobe_table_at(LOBE_TABLE_SIZE, roughness, cos_o);
    let i = vec2i(at.corner) + vec2i(0, first_row);
    let low = mix(textureLoad(table, i, 0), textureLoad(table, i + vec2i(1, 0), 0), at.share.x);
    let high = mix(
        textureLoad(table, i + vec2i(0, 1), 0),
        textureLoad(table, i + vec2i(1, 1), 0),
        at.share.x,
    );
    return mix(low, high, at.share.y);
}

fn lobe_albedo_lookup(albedo_table: texture_2d<f32>, roughness: f32, cos_o: f32) -> f32 {
    return lobe_table_lookup(albedo_table, roughness, cos_o).x;
}
