// The sums of a sample over all scratches that it sees, and the mask.
// Needs: layout, method, mask, film, contents.

@group(3) @binding(3) var<storage, read> chunk_starts: array<u32>;
@group(3) @binding(4) var<storage, read> chunk_sums: array<ChunkSum>;

// The chunk behind those of all lists that holds what the gratings of a group send, Fresnel included, and what they take of the mirror's direction.
fn grating_chunk(group: u32) -> u32 {
    return chunk_starts[frame.group_count] + group;
}

fn grating_sums(group: u32, lane: u32) -> Masked {
    if !HAS_GRATINGS {
        return Masked(vec3f(0.0), vec3f(0.0));
    }
    let sum = chunk_sums[GROUP * grating_chunk(group) + lane];
    return Masked(sum.radiance, sum.energy);
}

// Light of gratings under scratches, and the energy that both take of the mirror's direction: scratches lie on top.
fn under_scratches(gratings: Masked, taken: vec3f) -> Masked {
    return Masked((1.0 - taken) * gratings.scratches, 1.0 - (1.0 - taken) * (1.0 - gratings.taken));
}

struct SampleSums {
    all: ScratchSums,
    cut: u32,                   // chunks whose loops the device cut short
}

// Over all chunks of its group, in the order of the list.
fn sample_sums(group: u32, lane: u32) -> SampleSums {
    var sums = ScratchSums(0.0, 0.0, vec3f(0.0), vec3f(0.0));
    var cut = 0u;
    for (var chunk = chunk_starts[group]; chunk < chunk_starts[group + 1u]; chunk += 1u) {
        let sum = chunk_sums[GROUP * chunk + lane];
        cut += u32(sum.share < 0.0);
        sums.share += sum.share;
        sums.share_by_line += sum.share_by_line;
        sums.radiance += sum.radiance;
        sums.energy += sum.energy;
    }
    return SampleSums(sums, cut);
}

// Sums of the sample `by` that has the scratches of the sample `at`.
fn sample_sums_of(by: u32, at: u32, group: u32, lane: u32) -> SampleSums {
    let place = by - at + lane + GROUP * group;
    return sample_sums(place / GROUP, place % GROUP);
}

fn masked(sums: ScratchSums, depth_coherence: f32) -> Masked {
    if METHOD_MASK == MASK_LINEAR {
        return Masked(sums.radiance, sums.energy);
    }
    if METHOD_MASK == MASK_DENSITY {
        return Masked(sums.radiance, min(sums.energy, vec3f(1.0)));
    }
    return mask_resolve(sums, depth_coherence);
}
