// Pass: the light and the mask of scratches. A workgroup takes a group of samples and a chunk of its tile's list, a batch of segments at
// a time, in four stages, so that lanes which run in step do the same work. "Pixel" stands for a sample of a pixel here.
// 1. Each lane fetches a segment; each pixel marks those that it may see, of those whose lines come near to it.
// 2. The marks are pairs of a pixel and a segment. Each lane takes a pair, whichever pixel it is of: its share, and which lights reach it.
// 3. Pairs that a light reaches wait in a queue. Each lane takes one and lights it: most pairs are dark to most lights.
// 4. Each pixel adds up what is its own, in the order of the list.
// Twin: cpu/src/shade_scratches.rs.
// Needs: nearness, pair_light, picks, groups.

@group(3) @binding(1) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(2) var<storage, read> entries: array<vec4u>;
@group(3) @binding(3) var<storage, read> list_starts: array<u32>;
@group(3) @binding(4) var<storage, read> chunk_starts: array<u32>;
// A ChunkSum takes two words; or, where scratches are picked, what picks.wgsl says.
@group(3) @binding(5) var<storage, read_write> chunk_words: array<vec4u>;
@group(3) @binding(6) var<uniform> range: LightRange;

// Whether the pass does not add up light, but picks scratches that stand for it: shadow rays go by way of them.
override PICKS: bool = false;

const LANES: u32 = 64u;
// Number of segments in a tile's list from which on one line stands for the band of each. Footprints are wide there, and wide bands take five
// lines.
const LONG_LIST: u32 = 16384u;
// A segment shows at a point only if their normals agree at least this well.
const FACING_MIN_COS: f32 = 0.2;

// Pairs that lights reach and that are not lit yet: fewer than 64 are left over, and a round adds up to 7 lights for each lane.
const QUEUE: u32 = 512u;
// Twin: gpu/src/light_ranges.rs.
const LIGHTS_AT_ONCE: u32 = 7u;
const_assert LANES * (LIGHTS_AT_ONCE + 1u) <= QUEUE;

// Ends of each segment of the batch.
var<workgroup> ends: array<Ends, LANES>;
// Pixels near to each segment of the batch, the upper half of the tile and the lower one.
var<workgroup> near_pixels: array<vec2u, LANES>;
// Segments near to each pixel.
var<workgroup> marks: array<vec2u, LANES>;
// Inclusive prefix sums of the numbers of marks.
var<workgroup> pair_ends: array<u32, LANES>;
// Number of each lane, four lanes to an element, and the sum of all.
var<workgroup> lane_counts: array<vec4u, LANES / 4u>;
var<workgroup> lanes_total: u32;
// Contribution of each pair: its energy, or its radiance; share, and share by line.
var<workgroup> results: array<vec3f, LANES>;
var<workgroup> shares: array<vec2f, LANES>;
// The pixel in 6 bits, the light in 3, the place of the segment in the chunk.
var<workgroup> queue: array<u32, QUEUE>;
// Which of the pairs that are lit together belong to each pixel: two words of a bit for each lane.
var<workgroup> own_lit: array<atomic<u32>, 2u * LANES>;
var<workgroup> is_shaded: atomic<u32>;
var<workgroup> any_is_shaded: u32;

// The group that a chunk belongs to.
fn chunk_group(chunk: u32) -> u32 {
    var low = 0u;
    var high = frame.group_count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if chunk_starts[middle] <= chunk {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// The place of the k-th set bit.
fn nth_bit(mark: vec2u, k: u32) -> u32 {
    let low = countOneBits(mark.x);
    var word = select(mark.x, mark.y, k >= low);
    var left = select(k, k - low, k >= low);
    var at = 0u;
    for (var half = 16u; half > 0u; half /= 2u) {
        let here = countOneBits(word & ((1u << half) - 1u));
        if left >= here {
            left -= here;
            at += half;
            word >>= half;
        }
    }
    return at + select(0u, 32u, k >= low);
}

// The pixel that pair k belongs to.
fn pair_pixel(k: u32) -> u32 {
    var low = 0u;
    var high = LANES - 1u;
    for (var i = 0u; i < 6u; i += 1u) {
        let middle = (low + high) / 2u;
        if pair_ends[middle] > k {
            high = middle;
        } else {
            low = min(middle + 1u, LANES - 1u);
        }
    }
    return low;
}

// Marked segments of a batch that a pixel may see.
fn marks_seen(at: u32, marked: vec2u) -> vec2u {
    let here = nearness(points[at]);
    var seen = vec2u(0u);
    for (var word = 0u; word < 2u; word += 1u) {
        var left = marked[word];
        while left != 0u {
            let bit = firstTrailingBit(left);
            left &= left - 1u;
            seen[word] |= u32(is_near(here, ends[32u * word + bit])) << bit;
        }
    }
    return seen;
}

// Place of the one line of a segment in its band: even over the segments, and the same in each pixel.
fn one_line_node(index: u32) -> f32 {
    return f32(index * 0x9E3779B9u) / 4294967296.0;
}

// Whether a segment lies on the pixel's object, and on the side that it sees.
fn is_there(pixel: PixelPoint, index: u32, segment: Segment) -> bool {
    let object = objects[pixel.object - 1u];
    return index >= object.first_segment && index < object.end_segment && dot(segment.normal, pixel.normal) >= FACING_MIN_COS;
}

// Lights of the dispatch that may reach a pair, a bit for each.
fn lights_reaching(pair: Pair) -> u32 {
    if lights_are_around() {
        return 1u;
    }
    var reaching = 0u;
    if lights_are_none() {
        return reaching;
    }
    for (var l = range.first; l < range.end; l += 1u) {
        reaching |= u32(pair_meets(pair, l)) << (l - range.first);
    }
    return reaching;
}

// The light of a pair, Fresnel left out.
fn light_pair(pair: Pair, light_index: u32) -> vec3f {
    if lights_are_around() {
        let map_from_surface = frame.environment_from_world * pair.surface;
        let radiance = scratch_environment(scratch_tables, pair.point, pair.seen, environment_levels, map_from_surface);
        return frame.environment_texel_radiance * radiance;
    }
    return pair_light(pair, light_index);
}

// Sum of the numbers of the lanes before, given each lane's. Called in uniform control flow. With two barriers in place of twelve: each lane
// adds up all before it. lanes_total is the sum of all then.
fn before_lane(lane: u32, own: u32) -> u32 {
    lane_counts[lane / 4u][lane % 4u] = own;
    workgroupBarrier();
    // The last element counts in part.
    var before = select(vec4u(0u), lane_counts[lane / 4u], vec4u(0u, 1u, 2u, 3u) < vec4u(lane % 4u));
    for (var i = 0u; i < lane / 4u; i += 1u) {
        before += lane_counts[i];
    }
    let sum = before.x + before.y + before.z + before.w;
    if lane == LANES - 1u {
        lanes_total = sum + own;
    }
    return sum;
}

// Place of the pick of the next stratum of a sample. One that has the scratches of others has a pick for each of them.
fn pick_to(at: u32, state: PickState) -> u32 {
    let slot = pick_slot(state);
    if !pixel_shares(points[at]) {
        return state.per_sample * at + slot;
    }
    var left = slot;
    var to = at;
    for (var i = max(at, SHARED_REACH) - SHARED_REACH; i <= at + SHARED_REACH; i += 1u) {
        if pixel_shares(points[i]) && pixel_scratched(points[i], i) == at {
            to = i;
            if left == 0u {
                break;
            }
            left -= 1u;
        }
    }
    return to;
}

// Entries of a chunk.
struct Chunk {
    group: u32,
    first_entry: u32,
    end_entry: u32,
    is_of_long_list: bool,
}

fn chunk_at(chunk: u32) -> Chunk {
    let group = chunk_group(chunk);
    let list = group_list(group);
    let first = list_starts[list.x] + (chunk - chunk_starts[group]) * CHUNK_SEGMENTS;
    return Chunk(
        group,
        first,
        min(first + CHUNK_SEGMENTS, list_starts[list.y]),
        list_starts[list.y] - list_starts[list.x] >= LONG_LIST,
    );
}

@compute @workgroup_size(8, 8)
fn shade_scratches(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let chunk_index = workgroup.y * workgroups.x + workgroup.x;
    if chunk_index >= chunk_starts[frame.group_count] {
        return;
    }
    let chunk = chunk_at(chunk_index);
    let own_point = group_point(chunk.group, lane);
    // Another sample of the pixel may have its scratches.
    let has_surface = group_has(chunk.group, lane) && points[own_point].object != 0u && pixel_scratched(points[own_point], own_point) == own_point;
    let place = pixel_place(points[own_point]);
    if has_surface {
        atomicStore(&is_shaded, 1u);
    }
    workgroupBarrier();
    if lane == 0u {
        any_is_shaded = atomicLoad(&is_shaded);
    }
    // Nobody reads the sums of a tile that shows nothing.
    if workgroupUniformLoad(&any_is_shaded) == 0u {
        return;
    }
    var sum = ChunkSum(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
    let at = LANES * chunk_index + lane;
    var state: PickState;
    var first_pick = 0u;
    if PICKS {
        state = pick_state_from(chunk_words[at]);
        first_pick = LANES * chunk_starts[frame.group_count];
    }
    // Pairs that were queued, and those that have been lit.
    var queued = 0u;
    var lit = 0u;
    for (var first = chunk.first_entry; first < chunk.end_entry; first += LANES) {
        let count = min(LANES, chunk.end_entry - first);
        if lane < count {
            let entry = entries[first + lane];
            near_pixels[lane] = entry.zw;
            let segment = segment_from(scratch_segment(entry.y));
            let start = segment.start_m - frame.camera_m;
            let end = segment.end_m - frame.camera_m;
            ends[lane] = Ends(array(start.x, start.y, start.z), array(end.x, end.y, end.z), segment.blur_um);
        }
        workgroupBarrier();
        var mark = vec2u(0u);
        if has_surface {
            let half = place / 32u;
            let bit = place % 32u;
            for (var i = 0u; i < min(count, 32u); i += 1u) {
                mark.x |= ((near_pixels[i][half] >> bit) & 1u) << i;
            }
            for (var i = 32u; i < count; i += 1u) {
                mark.y |= ((near_pixels[i][half] >> bit) & 1u) << (i - 32u);
            }
            mark = marks_seen(own_point, mark);
        }
        marks[lane] = mark;
        let own = countOneBits(mark.x) + countOneBits(mark.y);
        let end = before_lane(lane, own) + own;
        pair_ends[lane] = end;
        let total = workgroupUniformLoad(&lanes_total);
        let is_last = first + LANES >= chunk.end_entry;
        // Pairs of the batch that have been asked for. A round asks for as many as there are lanes, or lights as many as wait.
        var asked = 0u;
        loop {
            let waiting = min(queued - lit, LANES);
            let lights_now = waiting == LANES || (asked >= total && is_last && waiting > 0u);
            if asked >= total && !lights_now {
                break;
            }
            let has_pair = lane < select(total - min(asked, total), waiting, lights_now);
            var reaching = 0u;
            var item = 0u;
            if has_pair {
                if lights_now {
                    item = queue[(lit + lane) % QUEUE];
                } else {
                    let k = asked + lane;
                    let owner = pair_pixel(k);
                    let before = select(0u, pair_ends[max(owner, 1u) - 1u], owner > 0u);
                    item = owner | ((first - chunk.first_entry + nth_bit(marks[owner], k - before)) << 9u);
                }
                let index = entries[chunk.first_entry + (item >> 9u)].y;
                let pixel = points[group_point(chunk.group, item & 63u)];
                let segment = segment_from(scratch_segment(index));
                var pair = pair_of(pixel, segment);
                let share = pair.seen.share;
                if lights_now {
                    if chunk.is_of_long_list {
                        pair.seen.node = one_line_node(index);
                    }
                    results[lane] = share.segment * light_pair(pair, range.first + ((item >> 6u) & 7u));
                    atomicOr(&own_lit[2u * (item & 63u) + lane / 32u], 1u << (lane % 32u));
                } else {
                    var energy = vec3f(0.0);
                    if !PICKS || lights_are_none() {
                        energy = pair_energy(scratch_tables, pair);
                    }
                    let is_seen = share.segment > 0.0 && is_there(pixel, index, segment);
                    if is_seen {
                        reaching = lights_reaching(pair);
                    }
                    results[lane] = select(vec3f(0.0), share.segment * energy, is_seen);
                    shares[lane] = select(vec2f(0.0), mask_shares(share), is_seen);
                }
            }
            if lights_now {
                workgroupBarrier();
                for (var word = 0u; word < 2u; word += 1u) {
                    var left = atomicExchange(&own_lit[2u * lane + word], 0u);
                    while left != 0u {
                        let j = 32u * word + firstTrailingBit(left);
                        left &= left - 1u;
                        if PICKS {
                            let item_lit = queue[(lit + j) % QUEUE];
                            state.sum += max(rgb_luminance(results[j]), 0.0);
                            // Picks whose threshold the sum has passed.
                            while pick_is_due(state) {
                                let source = select(range.first + ((item_lit >> 6u) & 7u), frame.light_count, lights_are_around());
                                let segment = entries[chunk.first_entry + (item_lit >> 9u)].y;
                                chunk_words[first_pick + pick_to(own_point, state)] = pick_packed(segment, source, results[j]);
                                state.next += 1u;
                            }
                        }
                        sum.radiance += results[j];
                    }
                }
                lit += waiting;
            } else {
                var at = queued + before_lane(lane, countOneBits(reaching));
                while reaching != 0u {
                    queue[at % QUEUE] = item | (firstTrailingBit(reaching) << 6u);
                    reaching &= reaching - 1u;
                    at += 1u;
                }
                queued += workgroupUniformLoad(&lanes_total);
                for (var j = max(end - own, asked); j < min(end, asked + LANES); j += 1u) {
                    if PICKS && lights_are_none() {
                        state.sum += max(rgb_luminance(results[j - asked]), 0.0);
                        while pick_is_due(state) {
                            let segment = entries[first + nth_bit(marks[lane], j + own - end)].y;
                            chunk_words[first_pick + pick_to(own_point, state)] = pick_packed(segment, 0u, results[j - asked]);
                            state.next += 1u;
                        }
                    }
                    sum.energy += results[j - asked];
                    sum.share += shares[j - asked].x;
                    sum.share_by_line += shares[j - asked].y;
                }
                asked += LANES;
            }
            // The next round writes where this one reads.
            workgroupBarrier();
        }
    }
    if PICKS {
        chunk_words[at] = pick_state_packed(state);
        return;
    }
    if range.adds == 0u {
        chunk_words[2u * at] = bitcast<vec4u>(vec4f(sum.radiance, sum.share));
        chunk_words[2u * at + 1u] = bitcast<vec4u>(vec4f(sum.energy, sum.share_by_line));
    } else {
        chunk_words[2u * at] = bitcast<vec4u>(bitcast<vec4f>(chunk_words[2u * at]) + vec4f(sum.radiance, 0.0));
    }
    // No share is negative: resolve.wgsl tells the host.
    if loops_were_cut() {
        chunk_words[2u * at].w = bitcast<u32>(-1.0);
    }
}
