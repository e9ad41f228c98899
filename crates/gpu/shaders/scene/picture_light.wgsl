// Pictures on lights as a point sees them, and the light that one scratch sends of a light with one. Twins: cpu/src/picture.rs,
// cpu/src/shade_scratches/scratch_light.rs.
// Needs: scene, picture.

// Texture of the picture, for scene_texture().
fn light_picture(light: Light) -> vec2u {
    let doors = select(0u, 3u, (light.extras & LIGHT_DOORS) != 0u);
    let at = light.first_vertex + light.vertex_count + doors;
    return textureLoad(lights, row_texel(LIGHT_TEXELS * frame.light_count + at), 0).xy;
}

// Relative to a place, along its axes: the columns of world_from_local.
fn light_picture_plane(light: Light, place_m: vec3f, world_from_local: mat3x3f) -> PicturePlane {
    let corner = light_corner_m(light.first_vertex);
    let right = light_corner_m(light.first_vertex + 1u);
    let up = light_corner_m(light.first_vertex + 3u);
    return PicturePlane((corner - place_m) * world_from_local, (right - corner) * world_from_local, (up - corner) * world_from_local);
}

// A trilinear look-up that ends at the edges of a square. The code of a texel stands in it once: passes with it are long.
fn picture_radiance(picture: vec2u, uv: vec2f, wanted_lod: f32, low: vec2f, side: f32) -> vec3f {
    let lod = min(wanted_lod, f32(scene_texture_levels(picture) - 1u));
    let past = fract(lod);
    let taps = select(4u, 8u, past > 0.0);
    var sum = vec3f(0.0);
    for (var tap = 0u; tap < taps; tap += 1u) {
        let level = u32(lod) + tap / 4u;
        let size = vec2f(max(scene_texture_size(picture) >> vec2u(level), vec2u(1u)));
        let half = min(0.5 / size, vec2f(0.5 * side));
        let at = clamp(uv, low + half, low + side - half) * size - 0.5;
        let upper = vec2f(f32(tap & 1u), f32((tap >> 1u) & 1u));
        let shares = abs(1.0 - upper - (at - floor(at)));
        let texel = scene_texel(picture, level, vec2i(clamp(floor(at) + upper, vec2f(0.0), size - 1.0)));
        sum += (shares.x * shares.y * select(1.0 - past, past, tap >= 4u)) * texel.rgb;
    }
    return sum;
}

fn picture_at(picture: vec2u, look: PictureLook) -> vec3f {
    return picture_radiance(picture, look.uv, picture_lod(look.spread, vec2f(scene_texture_size(picture))), vec2f(0.0), 1.0);
}

// Looks up part `i` of a picture, which is not looked up in others.
fn picture_part_at(picture: vec2u, look: PictureLook, i: u32) -> vec3f {
    let share = 1.0 / f32(PICTURE_PARTS);
    let lod = picture_lod(picture_part_spread(look.spread), vec2f(scene_texture_size(picture)));
    let low = picture_part_uv(i);
    return picture_radiance(picture, low + look.uv * share, lod, low, share);
}

// The mean of all of it.
fn picture_mean(picture: vec2u) -> vec3f {
    return scene_texture_level(picture, scene_texture_levels(picture) - 1u, vec2f(0.5), 0.0).rgb;
}
