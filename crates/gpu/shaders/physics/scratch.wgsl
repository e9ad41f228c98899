// One scratch under a Gaussian coherence window and a Gaussian footprint. Twins: optics/src/scratch.rs, footprint.rs.
// Needs: gaussian.

// The cross section of a groove as it is looked up. Twin: IndexedProfile in index/src/indexed_segment.rs.
struct Profile {
    width_um: f32,
    depth_nm: f32,
    shape: u32,                 // which of the material's tables; for a part of a wide groove 16 times its class of widths more
}

// Profile and more of a segment in two words. Twin: profile_words in src/host.rs.
//   first   width and depth, half floats
//   second  normal, two bytes of an octahedral map; table, four bits; blur, twelve bits of a half float
// The signs of width, depth and blur are the three bits of the class of widths.
struct PackedProfile {
    profile: Profile,
    normal: vec3f,
    blur_um: f32,
}

fn profile_unpacked(sizes: u32, more: u32) -> PackedProfile {
    let halves = abs(unpack2x16float(sizes));
    let width_class = extractBits(sizes, 15u, 1u) | ((sizes >> 31u) << 1u) | ((more >> 31u) << 2u);
    let shape = extractBits(more, 16u, 4u) | (width_class << 4u);
    let blur_um = abs(unpack2x16float(more & 0xfff00000u).y);
    return PackedProfile(Profile(halves.x, halves.y, shape), octahedral_normal(unpack4x8snorm(more).xy), blur_um);
}

// Layer of the table of a groove, where those of a material begin at one.
fn profile_table(first: u32, profile: Profile) -> u32 {
    return first + (profile.shape & 15u);
}

// Factor on the share of a part of a wide groove where scratches cover one another. Twin: cover_of_part in optics/src/section.rs.
fn profile_cover(profile: Profile) -> f32 {
    var covers = array<f32, 8>(1.0, 0.8403, 1.015, 1.3858, 2.1804, 4.1777, 1.0, 1.0);
    return covers[profile.shape >> 4u];
}

// Number of parts side by side that weaken one another as little as a scratch does itself.
fn profile_lines(profile: Profile) -> f32 {
    return select(1.0, 2.0, profile.shape >= 16u);
}

// A unit vector from its octahedral map. Q. Meyer et al., "On Floating-Point Normal Vectors", 2010.
fn octahedral_normal(octahedral: vec2f) -> vec3f {
    var v = vec3f(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
    let fold = max(-v.z, 0.0);
    v.x += select(fold, -fold, v.x >= 0.0);
    v.y += select(fold, -fold, v.y >= 0.0);
    return normalize(v);
}

// Standard deviation, in direction cosines along the scratch, of the band that it lights.
fn band_std(coherence_um: f32, wavelength_nm: f32) -> f32 {
    return wavelength_nm * 1e-3 / (8.88576588 * coherence_um);
}

// The depth whose phase step along the normal equals that of oblique light.
fn oblique_depth_nm(depth_nm: f32, cos_i: f32, cos_o: f32) -> f32 {
    return 0.5 * depth_nm * (cos_i + cos_o);
}

// Covariance of a footprint in a scratch's own axes, um^2.
struct Footprint {
    across_sq_um: f32,
    along_sq_um: f32,
    cross_sq_um: f32,
}

// The share of the footprint-averaged coherence window that a segment covers, and that its endless line would.
struct ScratchShare {
    segment: f32,
    line: f32,
    cover: f32,                 // factor on both where scratches cover one another
}

// Where the part of a segment lies that a footprint sees: mean and standard deviation of the place along it, in standard deviations of the
// footprint there; `within` is the footprint's share between the ends. Twin: SeenPart in optics/src/footprint.rs.
fn seen_part(low_end: f32, high_end: f32, within: f32) -> vec2f {
    let low = clamp(low_end, -8.0, 8.0);
    let high = clamp(high_end, -8.0, 8.0);
    let half = 0.5 * (high - low);
    let even = half * half / 3.0;
    if half < 0.5 {
        return vec2f(0.5 * (low + high) * (1.0 - even), sqrt(even));
    }
    let densities = 0.39894228 * exp(-0.5 * vec2f(low * low, high * high));
    let per_within = 1.0 / max(within, 1e-6);
    let mean = clamp((densities.x - densities.y) * per_within, low, high);
    let second = 1.0 + (low * densities.x - high * densities.y) * per_within;
    return vec2f(mean, sqrt(clamp(second - mean * mean, 0.0, min(even, 1.0))));
}

// `offset_um` is the distance from the footprint's centre to its line along n; `start_um` and `end_um` are its ends along t.
fn scratch_share(
    width_um: f32,
    offset_um: f32,
    start_um: f32,
    end_um: f32,
    blur_um: f32,
    footprint: Footprint,
    coherence_um: f32,
) -> ScratchShare {
    let variance = footprint.across_sq_um + 0.5 * coherence_um * coherence_um;
    let across = exp(-min(0.5 * offset_um * offset_um / variance, GAUSSIAN_TAIL)) * inverseSqrt(6.28318531 * variance);
    // A slanted footprint: its part on the scratch is displaced along the scratch.
    let slant = footprint.cross_sq_um / variance;
    let shift = offset_um * slant;
    let along_variance = footprint.along_sq_um - footprint.cross_sq_um * slant + blur_um * blur_um;
    let z = max(sqrt(2.0 * max(along_variance, 0.0)), 1e-6);
    let line = width_um * across;
    return ScratchShare(line * 0.5 * gaussian_erf_difference((start_um - shift) / z, (end_um - shift) / z), line, 1.0);
}
