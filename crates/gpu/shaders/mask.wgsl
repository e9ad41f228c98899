// The energy that scratches take from the base, and from one another. Twin: optics/src/mask.rs.

struct ScratchSums {
    share: f32,
    radiance: vec3f,
    radiance_by_share: vec3f,
    energy: vec3f,
    energy_by_share: vec3f,
}

// Adds one scratch: its share, the mean of |D|^2 and its radiance per unit of share.
fn mask_add(sums: ptr<function, ScratchSums>, share: f32, phase_step_energy: vec3f, radiance_per_share: vec3f) {
    (*sums).share += share;
    (*sums).energy += share * phase_step_energy;
    (*sums).energy_by_share += share * share * phase_step_energy;
    (*sums).radiance += share * radiance_per_share;
    (*sums).radiance_by_share += share * share * radiance_per_share;
}

struct Masked {
    scratches: vec3f,
    taken: vec3f,
}

// Radiance of all scratches, each weakened by the others, and the share of the base's energy that they take.
fn mask_resolve(sums: ScratchSums, depth_coherence: f32) -> Masked {
    let limit = 1.0 / (2.0 * depth_coherence);
    let scale = select(1.0, limit / max(sums.share, 1e-12), sums.share > limit);
    let alone = scale * (1.0 - depth_coherence * scale * sums.share);
    let own = scale * scale * depth_coherence;
    return Masked(
        alone * sums.radiance + own * sums.radiance_by_share,
        clamp(alone * sums.energy + own * sums.energy_by_share, vec3f(0.0), vec3f(1.0)),
    );
}
