// The energy that scratches take from the base, and from one another. Twin: optics/src/mask.rs, which explains it.
// Needs: scratch.

struct ScratchSums {
    share: f32,
    share_by_line: f32,
    radiance: vec3f,
    energy: vec3f,
}

// What one segment adds to `share` and to `share_by_line`.
fn mask_shares(share: ScratchShare) -> vec2f {
    return share.cover * share.segment * vec2f(1.0, share.cover * share.line);
}

// Adds one segment: its share, the mean of |D|^2 and its radiance per unit of share.
fn mask_add(sums: ptr<function, ScratchSums>, share: ScratchShare, phase_step_energy: vec3f, radiance_per_share: vec3f) {
    let shares = mask_shares(share);
    (*sums).share += shares.x;
    (*sums).share_by_line += shares.y;
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
    let others = sums.share - itself;
    let covered = min(1.0 - exp(-others), 0.5 / depth_coherence);
    // A series where the quotient would lose all digits.
    let visible = select(covered / max(others, 1e-3), 1.0 - 0.5 * others, others < 1e-3);
    let kept = visible * (1.0 - depth_coherence * covered);
    // A groove nearly as wide as the window would by itself scatter more than there is.
    let most = kept * max(max(sums.energy.x, sums.energy.y), sums.energy.z);
    let bounded = kept / max(most, 1.0);
    return Masked(bounded * sums.radiance, bounded * sums.energy);
}
