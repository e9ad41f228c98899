// Scratches that stand for all of a sample: some of its pairs of a scratch and a light, each with the probability of its luminance in the sum of
// all. The sum is cut into even strata, and in each a random place is drawn: the pair that the running sum passes it with is picked. Twin:
// cpu/src/shade_scratches/picks.rs, where reservoirs do the same for each light by itself.
// Needs: sobol, luminance.
//
// One array holds, for each chunk and lane, a state, and behind the states of all chunks for each sample its picks.

// Progress of the running sum of a chunk.
struct PickState {
    sum: f32,                   // luminance, that of the chunks before it included
    next: u32,                  // stratum
    end: u32,                   // the first stratum that is drawn in a later chunk
    per_sample: u32,            // how many strata there are
    step: f32,                  // their luminance
    seed: u32,                  // 24 bits
}

fn pick_state_packed(state: PickState) -> vec4u {
    return vec4u(bitcast<u32>(state.sum), state.next | (state.end << 16u), bitcast<u32>(state.step), (state.seed << 8u) | state.per_sample);
}

fn pick_state_from(packed: vec4u) -> PickState {
    return PickState(
        bitcast<f32>(packed.x),
        packed.y & 0xffffu,
        packed.y >> 16u,
        packed.w & 0xffu,
        bitcast<f32>(packed.z),
        packed.w >> 8u,
    );
}

// The place that is drawn in a stratum.
fn pick_threshold(seed: u32, stratum: u32, step: f32) -> f32 {
    return (f32(stratum) + f32(sobol_hash(seed + 0x1000000u * stratum) >> 8u) / 16777216.0) * step;
}

// Whether the sum has passed the place of the next stratum. Chunks add up what the sums of chunks hold in another order.
fn pick_is_due(state: PickState) -> bool {
    return state.next < state.end && pick_threshold(state.seed, state.next, state.step) <= state.sum * 1.000004;
}

// Round in which the pick of the next stratum serves: any stratum in any round.
fn pick_slot(state: PickState) -> u32 {
    return (state.next + state.seed) % max(state.per_sample, 1u);
}

struct Pick {
    segment: u32,
    source: u32,
    color: vec3f,               // of luminance 1
}

const PICK_NONE: u32 = 0xffffffffu;

fn pick_packed(segment: u32, source: u32, radiance: vec3f) -> vec4u {
    let color = clamp(radiance / max(rgb_luminance(radiance), 1e-30), vec3f(-60000.0), vec3f(60000.0));
    return vec4u(segment, source, pack2x16float(color.xy), pack2x16float(vec2f(color.z, 0.0)));
}

fn pick_from(packed: vec4u) -> Pick {
    return Pick(packed.x, packed.y, vec3f(unpack2x16float(packed.z), unpack2x16float(packed.w).x));
}
