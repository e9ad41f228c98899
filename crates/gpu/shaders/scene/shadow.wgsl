// What the passes of shadows share: docs/model.md, section 11. Twin: cpu/src/shadows.rs.

// What random numbers are for: each purpose is a pair. Those of the candidates for the environment follow the last.
const SHADOW_START: u32 = 0u;
const SHADOW_CHOICE: u32 = 1u;
const SHADOW_LIGHT: u32 = 2u;
const SHADOW_LINE: u32 = 3u;
const SHADOW_CHORD: u32 = 4u;
const SHADOW_PLACE: u32 = 5u;
const SHADOW_LOBE: u32 = 6u;
const BOUNCE_WAY: u32 = 16u;
const BOUNCE_START: u32 = 17u;
const BOUNCE_CHOICE: u32 = 18u;
const BOUNCE_DIRECTION: u32 = 19u;
const BOUNCE_PLACE: u32 = 20u;
const SHADOW_PURPOSES: u32 = 32u;

// Of a sample: another one for each place on the surface.
fn shadow_seed(position_m: vec3f, which: ShadowRound) -> u32 {
    let word = bitcast<vec3u>(position_m);
    return sobol_hash(word.x ^ sobol_hash(word.y ^ sobol_hash(word.z))) + which.seed;
}

// Two numbers in (0, 1) for a purpose, of a round and a source of the base. Even and odd rounds know nothing of one another, since one half of
// the rays guesses for the other: neighbours in one sequence avoid each other, and where weights differ the guess would be off.
fn shadow_random(seed: u32, which: ShadowRound, purpose: u32) -> vec2f {
    let round = which.first_round + which.round;
    return sobol_pair(round / 2u, seed + SHADOW_PURPOSES * (2u * which.source + round % 2u) + purpose);
}

// The same for rays by way of scratches, which all stand for as much light: out of one sequence for all rounds they are the more even.
fn shadow_random_alike(seed: u32, which: ShadowRound, purpose: u32) -> vec2f {
    return sobol_pair(which.first_round + which.round, seed + SHADOW_PURPOSES * 2u * which.source + purpose);
}

// Beyond this a Gaussian is cut off: rays from farther would start beyond what the pixel shows.
const SHADOW_REACH_STD: f32 = 3.0;

// Two independent standard normal numbers from two even ones.
fn shadow_normals(u: vec2f) -> vec2f {
    let radius = min(sqrt(-2.0 * log(1.0 - u.x)), SHADOW_REACH_STD);
    return radius * vec2f(cos(6.28318531 * u.y), sin(6.28318531 * u.y));
}

// No ray is as long: what is all around has no distance. Its square is a single still.
const SHADOW_FAR_M: f32 = 1e15;

// The share of its light that a half of the rays finds hidden; none without a ray. Where no ray is hidden it is 0 to the bit.
fn shadow_share(weight: vec3f, hidden: vec3f) -> f32 {
    let all = rgb_luminance(weight);
    return select(0.0, rgb_luminance(hidden) / max(all, 1e-30), all > 0.0);
}

// What of `open`, which a source sends where nothing hides it, is hidden, from the sums over even and odd rounds: (41) of docs/model.md, written
// for the part that is missing, so that no hidden ray means no difference.
fn shadow_lost(open: vec3f, even: mat2x3f, odd: mat2x3f, rounds: u32) -> vec3f {
    let even_share = shadow_share(even[0], even[1]);
    if rounds < 2u {
        // One ray cannot guess for another: it speaks for all colours.
        return open * even_share;
    }
    let odd_share = shadow_share(odd[0], odd[1]);
    let of_even = open * odd_share + (even[1] - odd_share * even[0]) / f32((rounds + 1u) / 2u);
    let of_odd = open * even_share + (odd[1] - even_share * odd[0]) / f32(rounds / 2u);
    return 0.5 * (of_even + of_odd);
}
