// Pass: what passes before have counted, as sizes of the dispatches to come. Where there is no room for it, the step and those that follow add
// nothing to the film: their dispatches are empty, and the host, which reads how much room is needed when it reads pixels, asks for them again.
// Needs: film, at_hits, contents.

// Prefix sums: the last one is the sum of all.
@group(3) @binding(0) var<storage, read> totals: array<u32>;
@group(3) @binding(1) var<storage, read_write> sizes: Sizes;
@group(3) @binding(2) var<storage, read_write> film: Film;

// Which number it is.
override COUNTED: u32 = COUNTED_ENTRIES;

// Largest number of workgroups in one dimension on every WebGPU device. Twin: src/compute_pass.rs.
const WORKGROUPS_MAX: u32 = 65535u;
// Entries of a block that is sorted. Twin: src/strip.rs.
const SORT_BLOCK: u32 = 2048u;

fn in_a_row(workgroups: u32) -> vec3u {
    let y = max((workgroups + WORKGROUPS_MAX - 1u) / WORKGROUPS_MAX, 1u);
    return vec3u((workgroups + y - 1u) / y, y, 1u);
}

// The number, and the groups of which it is.
fn counted() -> vec2u {
    if COUNTED == COUNTED_ENTRIES {
        return vec2u(totals[select(frame.segment_count, GROUP * frame.group_count, AT_HITS)], frame.group_count);
    }
    if COUNTED == COUNTED_GROUPS {
        let tiles = strip_tiles().x * strip_tiles().y;
        return vec2u(select(totals[tiles], tiles, frame.step == 0u));
    }
    return vec2u(totals[frame.group_count], frame.group_count);
}

@compute @workgroup_size(1)
fn count_sizes() {
    var it = counted();
    // Gratings have chunks behind those of lists.
    let needed = it.x + select(0u, it.y, HAS_GRATINGS && COUNTED == COUNTED_CHUNKS);
    // Other numbers follow from what was not made.
    if film.short == 0u || COUNTED == COUNTED_ENTRIES {
        sizes.needed[COUNTED] = max(sizes.needed[COUNTED], needed);
        if film.short == 0u && needed > sizes.capacity[COUNTED] {
            film.short = min(frame.step, 1u) + 1u;
        }
    }
    if film.short != 0u {
        it = vec2u(0u);
    }
    sizes.group_count = it.y;
    if COUNTED == COUNTED_ENTRIES {
        sizes.entry_count = it.x;
        sizes.blocks = in_a_row((it.x + SORT_BLOCK - 1u) / SORT_BLOCK);
    } else if COUNTED == COUNTED_GROUPS {
        sizes.groups = in_a_row(it.x);
    } else {
        sizes.chunks = in_a_row(it.x);
    }
}
