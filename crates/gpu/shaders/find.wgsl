// Segments in a box: a walk over the hierarchy by its skip pointers. Twin: index/src/segment_tree.rs.

const LEAF_FIRST_BITS: u32 = 28u;
// A leaf holds no more segments than this.
const LEAF_SEGMENTS: u32 = 4u;
const_assert LEAF_SEGMENTS == 4u; // as find_segments() has it
// Segments that are found before somebody looks at them.
const FIND_SEGMENTS: u32 = 32u;
var<private> found_segments: array<u32, FIND_SEGMENTS>;

// The segments of leaves that touch a box, from node `at` on, until the node `end`, until `most` might be exceeded, or until the
// rounds are spent. Returns how many; `at` is where to go on.
fn find_segments(
    lower_m: vec3f,
    upper_m: vec3f,
    end: u32,
    most: u32,
    at: ptr<function, u32>,
    segments: ptr<private, array<u32, FIND_SEGMENTS>>,
) -> u32 {
    var found = 0u;
    while *at < end && found + LEAF_SEGMENTS <= most && gather_rounds < GATHER_MAX_ROUNDS {
        let node = scratch_node(*at);
        // Lanes that a software driver has switched off read zeros, and would walk for ever.
        if node.skip <= *at {
            break;
        }
        gather_rounds += 1u;
        let touches = all(node.min_m <= upper_m) && all(node.max_m >= lower_m);
        *at = select(node.skip, *at + 1u, touches);
        let first = node.leaf & ((1u << LEAF_FIRST_BITS) - 1u);
        let count = select(0u, node.leaf >> LEAF_FIRST_BITS, touches);
        // As many as there may be, in no loop: there is room for them.
        (*segments)[found] = first;
        (*segments)[found + 1u] = first + 1u;
        (*segments)[found + 2u] = first + 2u;
        (*segments)[found + 3u] = first + 3u;
        found += count;
    }
    return found;
}
