// Finding the scratches under a footprint: a tree of boxes over an object's scratches, with skip pointers. Twin: engine/src/scratch_tree.rs
// makes it; B. Smits, "Efficiency Issues for Ray Tracing", 1998.
//
// Needs: scratch.
// Frame: the object's own, in its own unit of length, which the caller's matrices turn into metres.
//
// All lies in one texture, rgba32uint, SCRATCH_TREE_WIDTH texels wide:
//   texel 0   number of nodes, number of pieces, depth coherence (f32), coherence window in micrometres (f32)
//   nodes     in depth-first order, two texels each: least corner and the node after those below; greatest corner and, in 28 bits, the
//             first piece below with, in the other 4, the number of pieces of a leaf, 0 for an inner node
//   pieces    in the order of the leaves, two texels each: start and end, each with a word of profile_unpacked()

const SCRATCH_TREE_WIDTH: u32 = 1024u;
const SCRATCH_TREE_FIRST_BITS: u32 = 28u;
const SCRATCH_TREE_END: u32 = 0xffffffffu;
// Pieces of a node within the footprint's reach that stand for all.
const SCRATCH_TREE_MOST: u32 = 64u;
// Word in the place of a normal: scratches from a list have none, and show on both sides of a sheet.
const SCRATCH_TREE_NO_NORMAL: u32 = 0x8080u;
// A scratch shows at a point only if their normals agree at least this well: the far side of a sheet has the opposite one.
const SCRATCH_TREE_FACING: f32 = 0.2;

// State of a walk through the tree.
struct ScratchWalk {
    lower: vec3f,
    node: u32,
    upper: vec3f,
    piece: u32,                 // the next one, before `end`
    end: u32,
    step: u32,
    weight: f32,                // how many pieces the last one stands for
    piece_count: u32,
    node_count: u32,
}

// A straight piece of a scratch, free ends moved inwards.
struct ScratchPiece {
    start: vec3f,
    end: vec3f,
    normal: vec3f,              // of the surface; 0 where it is not known
    profile: Profile,
    blur_um: f32,
}

fn scratch_tree_texel(tree: texture_2d<u32>, at: u32) -> vec4u {
    return textureLoad(tree, vec2u(at % SCRATCH_TREE_WIDTH, at / SCRATCH_TREE_WIDTH), 0);
}

// Coherence of the phase steps of the object's scratches, for mask_resolve().
fn scratch_tree_depth_coherence(tree: texture_2d<u32>) -> f32 {
    return bitcast<f32>(scratch_tree_texel(tree, 0u).z);
}

// The coherence window that the ends of its scratches are made for, in micrometres.
fn scratch_tree_coherence_um(tree: texture_2d<u32>) -> f32 {
    return bitcast<f32>(scratch_tree_texel(tree, 0u).w);
}

// Starts a walk to all pieces whose boxes come as near to a position as half the sides of a box around it.
fn scratch_walk(tree: texture_2d<u32>, position: vec3f, reach: vec3f) -> ScratchWalk {
    let head = scratch_tree_texel(tree, 0u);
    return ScratchWalk(position - reach, 0u, position + reach, 0u, 0u, 1u, 1.0, head.y, head.x);
}

fn scratch_tree_first(tree: texture_2d<u32>, walk: ScratchWalk, node: u32) -> u32 {
    if node >= walk.node_count {
        return walk.piece_count;
    }
    return scratch_tree_texel(tree, 2u + 2u * node).w & ((1u << SCRATCH_TREE_FIRST_BITS) - 1u);
}

// The next piece, or SCRATCH_TREE_END.
fn scratch_walk_next(tree: texture_2d<u32>, walk: ptr<function, ScratchWalk>) -> u32 {
    let here = (*walk).piece;
    if here < (*walk).end {
        (*walk).piece = here + (*walk).step;
        return here;
    }
    while (*walk).node < (*walk).node_count {
        let node = (*walk).node;
        let low = scratch_tree_texel(tree, 1u + 2u * node);
        let high = scratch_tree_texel(tree, 2u + 2u * node);
        // Lanes that a software driver has switched off read zeros, and would go round for ever.
        if low.w <= node {
            break;
        }
        let least = bitcast<vec3f>(low.xyz);
        let most = bitcast<vec3f>(high.xyz);
        if any(least > (*walk).upper) || any(most < (*walk).lower) {
            (*walk).node = low.w;
            continue;
        }
        let first = high.w & ((1u << SCRATCH_TREE_FIRST_BITS) - 1u);
        let of_leaf = high.w >> SCRATCH_TREE_FIRST_BITS;
        var count = of_leaf;
        if of_leaf == 0u && all(least >= (*walk).lower) && all(most <= (*walk).upper) {
            count = scratch_tree_first(tree, *walk, low.w) - first;
        }
        let is_many = of_leaf == 0u && count > SCRATCH_TREE_MOST;
        if of_leaf == 0u && !is_many {
            (*walk).node = node + 1u;
            continue;
        }
        let step = select(1u, (count + SCRATCH_TREE_MOST - 1u) / SCRATCH_TREE_MOST, is_many);
        let begin = first + step / 2u;
        (*walk).node = select(node + 1u, low.w, is_many);
        (*walk).piece = begin + step;
        (*walk).end = first + count;
        (*walk).step = step;
        (*walk).weight = f32(count) / f32((count - step / 2u + step - 1u) / step);
        return begin;
    }
    return SCRATCH_TREE_END;
}

fn scratch_tree_piece(tree: texture_2d<u32>, walk: ScratchWalk, piece: u32) -> ScratchPiece {
    let at = 1u + 2u * walk.node_count + 2u * piece;
    let start = scratch_tree_texel(tree, at);
    let end = scratch_tree_texel(tree, at + 1u);
    let is_known = (end.w & 0xffffu) != SCRATCH_TREE_NO_NORMAL;
    let unpacked = profile_unpacked(start.w, end.w);
    return ScratchPiece(
        bitcast<vec3f>(start.xyz),
        bitcast<vec3f>(end.xyz),
        select(vec3f(0.0), unpacked.normal, is_known),
        unpacked.profile,
        unpacked.blur_um,
    );
}
