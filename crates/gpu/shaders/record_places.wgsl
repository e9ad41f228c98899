// Pass: a place for the records of each straight piece that may be seen in the picture, one for each of the parts that it is cut
// into there. Each invocation takes places for several pieces at once: there is one counter for all.

// Pieces that an invocation looks at. Twin: src/tiles.rs.
const PLACES: u32 = 16u;

// A part is no longer than this.
const RECORD_PART_PX: f32 = 28.0;
// Longer pieces have no records: pixels look at them for themselves.
const RECORD_PARTS: f32 = 64.0;
// How far from a piece it is seen, in standard deviations.
const RECORD_REACH_STD: f32 = 5.0;

@compute @workgroup_size(64)
fn record_places(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let lanes = 64u * workgroups.x;
    for (var begin = id.x; begin < frame.record_segments; begin += PLACES * lanes) {
        gather_rounds += 1u;
        var parts: array<u32, PLACES>;
        var sum = 0u;
        for (var i = 0u; i < PLACES; i += 1u) {
            gather_rounds += 1u;
            parts[i] = places_of(begin + i * lanes);
            sum += parts[i];
        }
        var first = record_take(sum);
        for (var i = 0u; i < PLACES; i += 1u) {
            gather_rounds += 1u;
            if begin + i * lanes < frame.record_segments {
                record_put(begin + i * lanes, first, parts[i]);
                first += parts[i];
            }
        }
    }
}

// How many parts a piece has in the picture; none if it is not seen there, or has no records.
fn places_of(index: u32) -> u32 {
    let segment = segment_at(min(index, frame.record_segments - 1u));
    let seen = segment_seen(segment.start_m, segment.end_m, vec2f(0.0));
    let depths_m = vec2f(
        dot(segment.start_m - frame.camera_m, frame.forward),
        dot(segment.end_m - frame.camera_m, frame.forward),
    );
    let px_per_m = frame.px_per_slope / max(min(depths_m.x, depths_m.y), frame.near_m);
    let reach_px = f32(TILE_PX) + RECORD_REACH_STD * (frame.footprint_std_px + 1e-6 * segment.blur_um * px_per_m);
    let half = 0.5 * vec2f(frame.size_px) + reach_px;
    let in_picture = all(max(seen.start_px, seen.end_px) >= -half) && all(min(seen.start_px, seen.end_px) <= half);
    let parts = max(ceil(length(seen.end_px - seen.start_px) / RECORD_PART_PX), 1.0);
    let has_parts = index < frame.record_segments && seen.has_line && in_picture && parts <= RECORD_PARTS;
    return select(0u, u32(min(parts, RECORD_PARTS)), has_parts);
}
