// What pixels need to know of a part of a scratch on a plane: a record, as texels hold it. No binding: a test packs and unpacks it.
//
// A pixel's share of a scratch is a product of functions of two lengths, across the scratch and along it, which are as good as affine
// in the picture over a part's few pixels. What the scratch sends is known at a few stations along it, as many as it changes, and
// pixels take what lies between. Pieces that are long in the picture are cut into parts, each with a record of the whole piece's
// shares as they are seen about it.

// Most stations of a part.
const RECORD_STATIONS: u32 = 8u;
// Two for the shares; one from each station to the next. Twin: src/tile_room.rs.
const RECORD_HEAD_TEXELS: u32 = 2u;
const RECORD_TEXELS: u32 = 1u + RECORD_STATIONS;
// Shares on the line are a ten thousandth or so, too little for half floats.
const RECORD_SCALE: f32 = 1024.0;

struct Record {
    middle_px: vec2f,           // in the picture, from its middle: halfway between the first station and the last
    last: f32,                  // number of the last station
    half_line: f32,             // half of the share on the line; negative where pixels look at the scratch for themselves
    across: vec2f,              // how the distance across over sqrt(2) standard deviations grows by pixel, over record_scale()
    along: vec2f,               // likewise the place along it, in stations
    ends: vec2f,                // where the piece begins and ends, in stations
    per_blur: f32,              // units of the blur at its ends to a station
    energy: vec3f,              // what it takes from the base
}

fn record_texel(record: Record, i: u32) -> vec4u {
    if i == 0u {
        // The last station stands in the last bits of a place: two thousandths of a pixel at most.
        let y = (bitcast<u32>(record.middle_px.y) & ~7u) | u32(record.last);
        return vec4u(bitcast<u32>(record.middle_px.x), y, bitcast<vec2u>(record.across));
    }
    return vec4u(
        pack2x16float(record.along),
        pack2x16float(clamp(record.ends, vec2f(-6e4), vec2f(6e4))),
        pack2x16float(vec2f(record.per_blur, min(record.half_line * RECORD_SCALE, 6e4))),
        record_energy_word(record.energy),
    );
}

// Of its second texel.
fn record_half_line(b: vec4u) -> f32 {
    return unpack2x16float(b.z).y / RECORD_SCALE;
}

fn record_from_texels(a: vec4u, b: vec4u) -> Record {
    return Record(
        vec2f(bitcast<f32>(a.x), bitcast<f32>(a.y & ~7u)),
        f32(a.y & 7u),
        record_half_line(b),
        bitcast<vec2f>(a.zw),
        unpack2x16float(b.x),
        unpack2x16float(b.y),
        unpack2x16float(b.z).x,
        record_energy(b.w),
    );
}

// Three numbers in 9 bits each with an exponent in common: to four thousandths of the largest. (Channels of deep colours are negative.)
fn record_energy_word(energy: vec3f) -> u32 {
    let sizes = abs(clamp(energy, vec3f(-60.0), vec3f(60.0)));
    let exponent = clamp(bitcast<u32>(max(max(sizes.x, sizes.y), sizes.z)) >> 23u, 102u, 133u) - 102u;
    // The largest is less than 255.
    let per = bitcast<f32>((159u - exponent) << 23u) * 0.996;
    let steps = bitcast<vec3u>(vec3i(round(clamp(energy, vec3f(-60.0), vec3f(60.0)) * per))) & vec3u(511u);
    return steps.x | (steps.y << 9u) | (steps.z << 18u) | (exponent << 27u);
}

fn record_energy(word: u32) -> vec3f {
    let steps = bitcast<vec3i>(vec3u(word << 23u, word << 14u, word << 5u)) >> vec3u(23u);
    return vec3f(steps) * (bitcast<f32>((95u + (word >> 27u)) << 23u) * (1.0 / 0.996));
}

// From one station to the next: what it sends there, 16 bits for each number with an exponent in common, and the key of its plane,
// which has 24 bits.
fn record_station_texel(before: vec3f, after: vec3f, key: u32) -> vec4u {
    let sizes = max(abs(before), abs(after));
    let exponent = clamp((bitcast<u32>(max(max(sizes.x, sizes.y), sizes.z)) >> 23u) + 1u, 20u, 252u);
    let per = bitcast<f32>((254u - exponent) << 23u);
    let a = before * per;
    let b = after * per;
    return vec4u(
        pack2x16snorm(a.xy),
        pack2x16snorm(vec2f(a.z, b.x)),
        pack2x16snorm(b.yz),
        (key << 8u) | exponent,
    );
}

// What is sent a share of the way from one station to the next.
fn record_between(texel: vec4u, share: f32) -> vec3f {
    // As unpack2x16snorm() but for the clamps, which what is packed here has no need of.
    let low = vec3f(bitcast<vec3i>(texel.xyz << vec3u(16u)) >> vec3u(16u));
    let high = vec3f(bitcast<vec3i>(texel.xyz) >> vec3u(16u));
    let sent = mix(vec3f(low.x, high.x, low.y), vec3f(high.y, low.z, high.z), share);
    return sent * (bitcast<f32>((texel.w & 0xffu) << 23u) * (1.0 / 32767.0));
}

fn record_key(texel: vec4u) -> u32 {
    return texel.w >> 8u;
}
