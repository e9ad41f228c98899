// Single grooves of a grating. Twins: crates/optics/src/grating/single.rs, crates/scene/src/grating/single.rs.

// Standard deviation of pixel and window, in pitches, up to which single grooves are seen, and from which on only their mean is.
const GROOVES_SINGLE_STD: f32 = 0.5;
const GROOVES_MEAN_STD: f32 = 1.0;
// Grooves that are asked for on either side.
const GROOVES_REACH: i32 = 6;

// Grooves about a point.
struct GroovesAt {
    number: i32,
    offset_um: f32,
    pitch_um: f32,              // negative where they are counted against the direction of offset_um
}

// Two coordinates of a point that grooves stay at, and how they change along a direction.
fn grooves_across(grating: Grating, arm_m: vec3f, direction: vec3f) -> vec4f {
    if grating.kind == GROOVES_ALONG {
        let other = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 0.0, 1.0), abs(grating.axis.z) < 0.9);
        let first = normalize(cross(grating.axis, other));
        let second = cross(grating.axis, first);
        return vec4f(dot(arm_m, first), dot(arm_m, second), dot(direction, first), dot(direction, second));
    }
    let height_m = dot(grating.axis, arm_m);
    let away_m = arm_m - grating.axis * height_m;
    let radius_m = length(away_m);
    return vec4f(radius_m, height_m, dot(direction, away_m) / max(radius_m, 1e-30), dot(direction, grating.axis));
}

// Of the planes or cones that cut grooves, eight to a half turn, the one nearest to a direction.
fn grooves_cut(towards: vec2f) -> vec2f {
    let size = abs(towards);
    let slope = min(size.x, size.y) / max(max(size.x, size.y), 1e-30);
    let slanted = select(vec2f(0.92387953, 0.38268343), vec2f(0.70710678), slope >= 0.66817864);
    let cut = select(slanted, vec2f(1.0, 0.0), slope < 0.19891237);
    return sign(towards) * select(cut.yx, cut, size.x >= size.y);
}

// The grooves so far from the middle of their field, counted along a unit direction across them.
fn grooves_at(grating: Grating, arm_m: vec3f, across: vec3f) -> GroovesAt {
    let place = grooves_across(grating, arm_m, across);
    let cut = grooves_cut(place.zw);
    // The other way counts the same grooves.
    let direction = select(1.0, -1.0, cut.x < 0.0 || (cut.x == 0.0 && cut.y < 0.0));
    let along_m = direction * dot(place.xy, cut);
    // At least the cosine of half a cut, where the direction is one.
    let stretch = direction / max(dot(place.zw, cut), 0.5);
    let pitch_m = 1e-6 * grating.pitch_um;
    let number = round(along_m / pitch_m);
    return GroovesAt(i32(number), 1e6 * (number * pitch_m - along_m) * stretch, grating.pitch_um * stretch);
}

// How far a groove is off its place: of mean 0 and variance 1.
fn groove_shift(number: i32, seed: u32) -> f32 {
    let first = sobol_hash(bitcast<u32>(number) ^ sobol_hash(seed));
    let second = sobol_hash(first ^ 0x9e3779b9u);
    let sum = (first & 0xffffu) + (first >> 16u) + (second & 0xffffu) + (second >> 16u);
    return (f32(sum) / 65536.0 - 2.0) * 1.7320508;
}

// The factor on what a pixel sees of the grooves, in the place of their mean. `across` is a unit vector in the plane of the surface; the steps are of
// one standard deviation of the pixel's filter.
fn groove_density(grating: Grating, arm_m: vec3f, across: vec3f, right_m: vec3f, down_m: vec3f, coherence_um: f32) -> f32 {
    let steps_um = 1e6 * vec2f(dot(right_m, across), dot(down_m, across));
    let std_um = sqrt(dot(steps_um, steps_um) + 0.5 * coherence_um * coherence_um);
    if grating.kind > GROOVES_CIRCULAR || std_um > 1.03 * GROOVES_MEAN_STD * grating.pitch_um {
        return 1.0;
    }
    let at = grooves_at(grating, arm_m, across);
    let pitch_um = abs(at.pitch_um);
    let seen = 1.0 - smoothstep(GROOVES_SINGLE_STD, GROOVES_MEAN_STD, std_um / pitch_um);
    let edges_um = 0.5 * vec2f(-grating.width_um, grating.width_um);
    var sum = 0.0;
    for (var step = -GROOVES_REACH; step <= GROOVES_REACH; step += 1) {
        let shift = grating.jitter_pitches * groove_shift(at.number + step, grating.seed);
        let far = (at.offset_um + (f32(step) + shift) * at.pitch_um + edges_um) / std_um;
        let edges = exp(-min(0.5 * far * far, vec2f(GAUSSIAN_TAIL)));
        sum += edges.x + edges.y;
    }
    let density = 0.5 * pitch_um / (2.5066283 * std_um) * sum;
    return min(1.0 + seen * (density - 1.0), grating.densest);
}
