// The energy that scratches take from the base, and from one another. Twin: optics/src/mask.rs, which explains it.

struct ScratchSums {
    share: f32,
    share_by_line: f32,
    radiance: vec3f,
    energy: vec3f,
}

// Adds one segment: its share, the mean of |D|^2 and its radiance per unit of share.
fn mask_add(sums: ptr<function, ScratchSums>, share: ScratchShare, phase_step_energy: vec3f, radiance_per_share: vec3f) {
    (*sums).share += share.segment;
    (*sums).share_by_line += share.segment * share.line;
    (*sums).energy += share.segment * phase_step_energy;
    (*sums).radiance += share.segment * radiance_per_share;
}

struct Masked {
    scratches: vec3f,
    taken: vec3f,
}

// Radiance of all scratches, each weakened by the others, and the share of the base's energy that they take.
fn mask_resolve(sums: ScratchSums, depth_coherence: f32) -> Masked {
    let share = max(sums.share, 1e-30);
    let itself = min(sums.share_by_line / share, sums.share);
    let scale = min(1.0 / (2.0 * depth_coherence * share), 1.0);
    let kept = scale * (1.0 - depth_coherence * scale * (sums.share - itself));
    // A groove nearly as wide as the window would by itself scatter more than there is.
    let most = kept * max(max(sums.energy.x, sums.energy.y), sums.energy.z);
    let bounded = kept / max(most, 1.0);
    return Masked(bounded * sums.radiance, bounded * sums.energy);
}
