// By which mask the base pays.

// What the scratches and what they take from the base come to.
fn gather_masked(sums: ScratchSums, depth_coherence: f32) -> Masked {
    if METHOD_MASK == MASK_LINEAR {
        return Masked(sums.radiance, sums.energy);
    }
    if METHOD_MASK == MASK_DENSITY {
        return Masked(sums.radiance, vec3f(min(2.0 * sums.share, 1.0)));
    }
    return mask_resolve(sums, depth_coherence);
}
