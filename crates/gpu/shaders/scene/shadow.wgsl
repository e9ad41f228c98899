// Functions that the passes of shadows share: docs/model.md, section 11. Twin: cpu/src/shadows.rs.
// Needs: layout, sobol, luminance.

// Uses of random numbers: each use is a pair. Those of the candidates for the environment follow the last.
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

// Seed of a sample: another one for each place on the surface.
fn shadow_seed(position_m: vec3f, which: ShadowRound) -> u32 {
    let word = bitcast<vec3u>(position_m);
    return sobol_hash(word.x ^ sobol_hash(word.y ^ sobol_hash(word.z))) + which.seed;
}

// Two numbers in (0, 1) for a purpose, of a source, even over the rounds.
fn shadow_random(seed: u32, which: ShadowRound, purpose: u32) -> vec2f {
    return sobol_pair(which.first_round + which.round, seed + SHADOW_PURPOSES * which.source + purpose);
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

// Distance by which rounding may move a point on a surface: vertices are in single precision, and this is some ten
// of its steps.
fn ray_step_m(at_m: vec3f, extent_m: f32) -> f32 {
    return 1e-6 * (extent_m + length(at_m));
}
