// Single grooves of a grating. Twins: crates/optics/src/grating/single.rs, crates/scene/src/grating/single.rs.
// Needs: gratings, sobol, contents.

// Standard deviation of pixel and window, in pitches, up to which single grooves are seen, and from which on only their mean is.
const GROOVES_SINGLE_STD: f32 = 0.5;
const GROOVES_MEAN_STD: f32 = 1.0;
// Grooves that are asked for on either side; of those that branch, which are up to twice as dense.
const GROOVES_REACH: i32 = 6;
const GROOVES_BRANCHING_REACH: i32 = 8;
// Grooves that begin between two others grow within this share of the way on which their distance doubles.
const GROOVES_GROWTH: f32 = 0.015625;
// Grooves that branch are counted up to two to this power.
const GROOVES_MOST_BITS: u32 = 20u;
// Least cosine between arcs and the direction away from their axis: nearer to the circles about it, arcs have no numbers.
const GROOVES_LEAST_COS: f32 = 0.02;

// Grooves about a point.
struct GroovesAt {
    number: i32,
    offset_um: f32,
    pitch_um: f32,              // negative where they are counted against the direction of offset_um
    bits: u32,                  // of grooves that branch: there are two to this power of places to a turn; 0: they cannot be told apart
    taken: f32,                 // and this share of those with odd numbers is taken
}

// Two directions across one, at a right angle: the one follows the other counter-clockwise.
fn grooves_first_across(axis: vec3f) -> vec3f {
    let other = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 0.0, 1.0), abs(axis.z) < 0.9);
    return normalize(cross(axis, other));
}

// Two coordinates of a point that grooves stay at, and how they change along a direction.
fn grooves_across(grating: Grating, arm_m: vec3f, direction: vec3f) -> vec4f {
    if grating.kind == GROOVES_ALONG {
        let first = grooves_first_across(grating.axis);
        let second = cross(grating.axis, first);
        return vec4f(dot(arm_m, first), dot(arm_m, second), dot(direction, first), dot(direction, second));
    }
    let height_m = dot(grating.axis, arm_m);
    let away_m = arm_m - grating.axis * height_m;
    let radius_m = length(away_m);
    return vec4f(radius_m, height_m, dot(direction, away_m) / max(radius_m, 1e-30), dot(direction, grating.axis));
}

// Direction nearest to another one of the planes or cones that cut grooves, eight to a half turn.
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
    return GroovesAt(i32(number), 1e6 * (number * pitch_m - along_m) * stretch, grating.pitch_um * stretch, 0u, 0.0);
}

// Whether grooves come nearer to one another along their way.
fn grooves_branch(grating: Grating) -> bool {
    return HAS_BRANCHING_GROOVES && (grating.kind > GROOVES_CIRCULAR || (HAS_GROOVE_MAPS && (grating.maps & (GROOVES_BY_U | GROOVES_BY_V)) != 0u));
}

// The angle of a direction, in turns. The built-in function may be off by a groove.
fn grooves_turns(at: vec2f) -> f32 {
    let size = abs(at);
    let slope = min(size.x, size.y) / max(max(size.x, size.y), 1e-30);
    // Beyond an eighth of a quarter turn what is left of one (S. Moshier, Cephes: atanf).
    let is_far = slope > 0.41421356;
    let x = select(slope, (slope - 1.0) / (slope + 1.0), is_far);
    let z = x * x;
    let near = (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * x + x;
    let octant = near * 0.15915494 + select(0.0, 0.125, is_far);
    let quarter = select(octant, 0.25 - octant, size.y > size.x);
    let half = select(quarter, 0.5 - quarter, at.x < 0.0);
    return select(half, -half, at.y < 0.0);
}

// The grooves that branch about a point so far from the middle of their field, counted along a unit direction across them.
fn grooves_branching_at(grating: Grating, course: GrooveCourse, arm_m: vec3f, normal: vec3f, across: vec3f) -> GroovesAt {
    var turns = course.level;
    var turns_per_m = dot(course.level_per_m, across);
    if grating.kind != GROOVES_ALONG {
        let first = grooves_first_across(grating.axis);
        let second = cross(grating.axis, first);
        let at = vec2f(dot(first, arm_m), dot(second, arm_m));
        let radius_m = max(length(at), GROOVES_NO_DIRECTION_M);
        // Arcs start from the axis at the angle of their chord less the half of what they turn until here.
        let sin = clamp(select(0.5, -0.5, dot(grating.axis, normal) < 0.0) * radius_m * grating.curvature_per_m, -1.0, 1.0);
        let cos = sqrt(max(1.0 - sin * sin, 0.0));
        let away = (first * at.x + second * at.y) / radius_m;
        let around = (second * at.x - first * at.y) / radius_m;
        turns = grooves_turns(at) - grooves_turns(vec2f(cos, sin));
        turns_per_m = 0.15915494 / radius_m * (dot(across, around) - dot(across, away) * sin / max(cos, GROOVES_LEAST_COS));
        if cos < GROOVES_LEAST_COS {
            turns_per_m = 0.0;
        }
    }
    let count = 1e6 / (grating.pitch_um * max(abs(turns_per_m), 1e-12));
    let doublings = max(log2(count), 0.0);
    let bits = u32(min(floor(doublings), 30.0)) + 1u;
    if bits > GROOVES_MOST_BITS {
        return GroovesAt(0, 0.0, 1.0, 0u, 0.0);
    }
    let places = f32(1u << bits);
    let at = fract(turns) * places;
    let place_um = 1e6 / (places * turns_per_m);
    return GroovesAt(i32(round(at)), (round(at) - at) * place_um, place_um, bits, exp2(fract(doublings)) - 1.0);
}

// Share of a branching groove that has grown, by its number among those of all turns.
fn groove_grown(at: GroovesAt, own: u32, is_odd: bool, seed: u32) -> f32 {
    let begins = f32(sobol_hash(own ^ sobol_hash(~seed)) >> 8u) / 16777216.0 * (1.0 - GROOVES_GROWTH);
    return select(1.0, clamp((at.taken - begins) / GROOVES_GROWTH, 0.0, 1.0), is_odd);
}

// Displacement of a groove from its place: mean 0, variance 1.
fn groove_shift(number: u32, seed: u32) -> f32 {
    let first = sobol_hash(number ^ sobol_hash(seed));
    let second = sobol_hash(first ^ 0x9e3779b9u);
    let sum = (first & 0xffffu) + (first >> 16u) + (second & 0xffffu) + (second >> 16u);
    return (f32(sum) / 65536.0 - 2.0) * 1.7320508;
}

// The factor on what a pixel sees of the grooves, in the place of their mean. `tangent` is along them, in the plane of the surface; the steps are of
// one standard deviation of the pixel's filter.
fn groove_density(
    grating: Grating, course: GrooveCourse, arm_m: vec3f, normal: vec3f, tangent: vec3f, right_m: vec3f, down_m: vec3f, coherence_um: f32,
) -> f32 {
    let across = cross(normal, tangent);
    let steps_um = 1e6 * vec2f(dot(right_m, across), dot(down_m, across));
    let std_um = sqrt(dot(steps_um, steps_um) + 0.5 * coherence_um * coherence_um);
    if (!HAS_BRANCHING_GROOVES && grating.kind > GROOVES_CIRCULAR) || std_um > 1.03 * GROOVES_MEAN_STD * grating.pitch_um {
        return 1.0;
    }
    let branch = grooves_branch(grating);
    var at: GroovesAt;
    if branch {
        at = grooves_branching_at(grating, course, arm_m, normal, across);
        if at.bits == 0u {
            return 1.0;
        }
    } else {
        at = grooves_at(grating, arm_m, across);
    }
    let place_um = abs(at.pitch_um);
    let pitch_um = select(place_um, grating.pitch_um, branch);
    let seen = 1.0 - smoothstep(GROOVES_SINGLE_STD, GROOVES_MEAN_STD, std_um / pitch_um);
    let edges_um = 0.5 * vec2f(-grating.width_um, grating.width_um);
    let reach = select(GROOVES_REACH, GROOVES_BRANCHING_REACH, branch);
    // In places.
    let jitter = grating.jitter_pitches * select(1.0, pitch_um / place_um, branch);
    var sum = 0.0;
    for (var step = -reach; step <= reach; step += 1) {
        var own = bitcast<u32>(at.number + step);
        var grown = 1.0;
        if branch {
            let is_odd = (own & 1u) == 1u;
            own <<= 32u - at.bits;
            grown = groove_grown(at, own, is_odd, grating.seed);
        }
        let shift = jitter * groove_shift(own, grating.seed);
        let far = (at.offset_um + (f32(step) + shift) * at.pitch_um + edges_um) / std_um;
        let edges = exp(-min(0.5 * far * far, vec2f(GAUSSIAN_TAIL)));
        sum += grown * (edges.x + edges.y);
    }
    let density = 0.5 * pitch_um / (2.5066283 * std_um) * sum;
    return min(1.0 + seen * (density - 1.0), grating.densest);
}
