// Which pixels of a tile of 8 x 8 a line in the picture comes near to. No binding: a test draws lines with it.

// A tile's pixels: a byte for each row, the first four rows in x; the lowest bit is the pixel at the left.
// The line runs between two ends, with a unit normal; pixels are near to it up to `reach_px.x` across it, and, in rows and columns,
// up to `reach_px.y` beyond its ends. `first_px` is where the first pixel's sample lies.
fn tile_near(start_px: vec2f, end_px: vec2f, normal: vec2f, reach_px: vec2f, first_px: vec2f) -> vec2u {
    let lowest = min(start_px, end_px) - reach_px.y;
    let highest = max(start_px, end_px) + reach_px.y;
    let offset_px = dot(normal, start_px);
    // Nearly level lines run through whole rows.
    let per_normal = select(-1.0, 1.0, normal.x >= 0.0) / max(abs(normal.x), 1e-4);
    let half_width = reach_px.x * abs(per_normal);
    var near: array<vec4u, 2>;
    for (var h = 0u; h < 2u; h += 1u) {
        let y = first_px.y + f32(4u * h) + vec4f(0.0, 1.0, 2.0, 3.0);
        let middle = (offset_px - normal.y * y) * per_normal;
        let low = max(middle - half_width, vec4f(lowest.x)) - first_px.x;
        let high = min(middle + half_width, vec4f(highest.x)) - first_px.x;
        let begin = vec4u(clamp(ceil(low), vec4f(0.0), vec4f(8.0)));
        let end = vec4u(clamp(floor(high) + 1.0, vec4f(0.0), vec4f(8.0)));
        let touches = (end > begin) & (y >= vec4f(lowest.y)) & (y <= vec4f(highest.y));
        near[h] = select(vec4u(0u), (vec4u(1u) << end) - (vec4u(1u) << begin), touches) << vec4u(0u, 8u, 16u, 24u);
    }
    return vec2u(
        near[0].x | near[0].y | near[0].z | near[0].w,
        near[1].x | near[1].y | near[1].z | near[1].w,
    );
}

// Of eight lines' pixels the rows: a byte for each line, the first four in x.
fn tile_rows(near: array<vec2u, 8>) -> array<vec2u, 8> {
    let a = bytes_turned(vec4u(near[0].x, near[1].x, near[2].x, near[3].x));
    let b = bytes_turned(vec4u(near[4].x, near[5].x, near[6].x, near[7].x));
    let c = bytes_turned(vec4u(near[0].y, near[1].y, near[2].y, near[3].y));
    let d = bytes_turned(vec4u(near[4].y, near[5].y, near[6].y, near[7].y));
    return array(
        vec2u(a.x, b.x),
        vec2u(a.y, b.y),
        vec2u(a.z, b.z),
        vec2u(a.w, b.w),
        vec2u(c.x, d.x),
        vec2u(c.y, d.y),
        vec2u(c.z, d.z),
        vec2u(c.w, d.w),
    );
}

// Which of the eight lines a pixel of a row is near to, a bit for each.
fn tile_row_bits(row: vec2u, x: u32) -> u32 {
    // Each byte's bit for the pixel, moved to the highest four bits.
    let bits = (((row >> vec2u(x)) & vec2u(0x01010101u)) * 0x10204080u) >> vec2u(28u);
    return bits.x | (bits.y << 4u);
}

// The bytes of four words by turns: word `i` of the result has their bytes `i`.
fn bytes_turned(words: vec4u) -> vec4u {
    let low = vec4u(words.xz & vec2u(0x00ff00ffu), (words.xz >> vec2u(8u)) & vec2u(0x00ff00ffu));
    let pairs = low | (vec4u(words.yw & vec2u(0x00ff00ffu), (words.yw >> vec2u(8u)) & vec2u(0x00ff00ffu)) << vec4u(8u));
    return vec4u(
        (pairs.x & 0xffffu) | (pairs.y << 16u),
        (pairs.z & 0xffffu) | (pairs.w << 16u),
        (pairs.x >> 16u) | (pairs.y & 0xffff0000u),
        (pairs.z >> 16u) | (pairs.w & 0xffff0000u),
    );
}
