// What a scratch adds to a pixel, from the record of one of its parts.

// A part's record, and what it sends near a place in the picture.
struct RecordThere {
    record: Record,
    sent: vec4u,
    share: f32,                 // of the way from the station before the place to the one after it
    along: f32,                 // the place, in stations
    across: f32,
}

// At a place in the picture with its record_scale(). `texel` is the record's: record_at().
fn record_there(texel: u32, at_px: vec2f, scale: f32) -> RecordThere {
    let record = record_from_texels(tile_list_texel(texel), tile_list_texel(texel + 1u));
    let apart_px = at_px - record.middle_px;
    let across = scale * dot(record.across, apart_px);
    let along = 0.5 * record.last + dot(record.along, apart_px);
    let station = min(u32(clamp(along, 0.0, record.last)), u32(max(record.last, 1.0)) - 1u);
    let sent = tile_list_texel(texel + RECORD_HEAD_TEXELS + station);
    return RecordThere(record, sent, clamp(along - f32(station), 0.0, 1.0), along, across);
}

// Whether it serves pixels that see a plane.
fn record_serves(there: RecordThere, plane_key: u32) -> bool {
    return there.record.half_line >= 0.0 && record_key(there.sent) == plane_key;
}

fn record_add(there: RecordThere, single_share: f32, sums: ptr<function, ScratchSums>) {
    let across2 = there.across * there.across;
    let near = across2 <= 0.5 * REACH_STD * REACH_STD;
    let half_line = select(0.0, there.record.half_line * exp(-min(across2, GAUSSIAN_TAIL)), near);
    let ends = (there.record.ends - there.along) * there.record.per_blur;
    let segment = single_share * half_line * max(gaussian_quick_erf(ends.y) - gaussian_quick_erf(ends.x), 0.0);
    (*sums).share += segment;
    (*sums).share_by_line += segment * 2.0 * half_line;
    (*sums).energy += segment * there.record.energy;
    (*sums).radiance += segment * record_between(there.sent, there.share);
}
