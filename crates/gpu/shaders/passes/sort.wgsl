// Passes: a stable radix sort of the entries by their tile, one digit of 8 bits at a time. Entries of a tile stay in the order of
// segments, so that sums over a list are the same in every run. Local ranks by bit masks, as in vello's binning (Levien, 2022).
// Needs: bindings.

const SORT_LANES: u32 = 256u;
// Entries of a block, in rounds of one for each lane.
const SORT_ROUNDS: u32 = 8u;
const SORT_DIGITS: u32 = 256u;
// Words that hold a bit for each lane.
const SORT_WORDS: u32 = 8u;

@group(3) @binding(0) var<uniform> settings: SortSettings;
@group(3) @binding(1) var<storage, read> entries: array<vec4u>;
// Number of times that each digit occurs in each block, digit after digit; then the number of entries before those.
@group(3) @binding(2) var<storage, read_write> digit_starts: array<u32>;
@group(3) @binding(3) var<storage, read_write> sorted: array<vec4u>;

var<workgroup> sort_counts: array<atomic<u32>, SORT_DIGITS>;
var<workgroup> sort_masks: array<atomic<u32>, SORT_DIGITS * SORT_WORDS>;
var<workgroup> sort_next: array<u32, SORT_DIGITS>;

fn sort_digit(entry: vec4u) -> u32 {
    return (entry.x >> settings.shift) & (SORT_DIGITS - 1u);
}

fn sort_block(workgroup: vec3u, workgroups: vec3u) -> u32 {
    return workgroup.y * workgroups.x + workgroup.x;
}

fn sort_blocks() -> u32 {
    return (frame.entry_count + SORT_LANES * SORT_ROUNDS - 1u) / (SORT_LANES * SORT_ROUNDS);
}

@compute @workgroup_size(SORT_LANES)
fn sort_count(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let block = sort_block(workgroup, workgroups);
    atomicStore(&sort_counts[lane], 0u);
    workgroupBarrier();
    for (var round = 0u; round < SORT_ROUNDS; round += 1u) {
        let i = (block * SORT_ROUNDS + round) * SORT_LANES + lane;
        if i < frame.entry_count {
            atomicAdd(&sort_counts[sort_digit(entries[i])], 1u);
        }
    }
    workgroupBarrier();
    if block < sort_blocks() {
        digit_starts[lane * sort_blocks() + block] = atomicLoad(&sort_counts[lane]);
    }
}

@compute @workgroup_size(SORT_LANES)
fn sort_scatter(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let block = min(sort_block(workgroup, workgroups), sort_blocks() - 1u);
    let is_mine = sort_block(workgroup, workgroups) < sort_blocks();
    sort_next[lane] = digit_starts[lane * sort_blocks() + block];
    for (var round = 0u; round < SORT_ROUNDS; round += 1u) {
        for (var word = 0u; word < SORT_WORDS; word += 1u) {
            atomicStore(&sort_masks[lane * SORT_WORDS + word], 0u);
        }
        workgroupBarrier();
        let i = (block * SORT_ROUNDS + round) * SORT_LANES + lane;
        let is_there = is_mine && i < frame.entry_count;
        var entry: vec4u;
        var digit = 0u;
        if is_there {
            entry = entries[i];
            digit = sort_digit(entry);
            atomicOr(&sort_masks[digit * SORT_WORDS + lane / 32u], 1u << (lane % 32u));
        }
        workgroupBarrier();
        if is_there {
            var rank = countOneBits(atomicLoad(&sort_masks[digit * SORT_WORDS + lane / 32u]) & ((1u << (lane % 32u)) - 1u));
            for (var word = 0u; word < lane / 32u; word += 1u) {
                rank += countOneBits(atomicLoad(&sort_masks[digit * SORT_WORDS + word]));
            }
            sorted[sort_next[digit] + rank] = entry;
        }
        workgroupBarrier();
        var count = 0u;
        for (var word = 0u; word < SORT_WORDS; word += 1u) {
            count += countOneBits(atomicLoad(&sort_masks[lane * SORT_WORDS + word]));
        }
        sort_next[lane] += count;
    }
}
