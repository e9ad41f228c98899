// A walk over the scratches under a pixel, which may be left and gone on with in another dispatch; and in which order pixels are
// walked.

// Loop rounds of this invocation. A software driver ends loops after 65,536, its neighbours' counted in; the host lowers
// the bound there, and the walk goes on in another dispatch.
var<private> gather_rounds: u32;
override GATHER_MAX_ROUNDS: u32 = 0xffffffffu;

// Where to go on, and what was added up before it.
struct ScratchWalk {
    at: u32,
    sums: ScratchSums,
}

// Set in ScratchWalk.at while a list is gone through; the rest is the place in it. Else it is a node of the hierarchy.
const WALK_LISTED: u32 = 0x80000000u;
// Set while grids of many scratches are gone through; the rest counts those that are done.
const WALK_BUNDLED: u32 = 0x40000000u;
// Grids are done, single scratches not begun.
const WALK_FRESH: u32 = 0x3fffffffu;
// Nothing is left to do with grids.
const WALK_BUNDLES_DONE: u32 = 0xffffffffu;

// A software driver gives each of its threads one piece of a dispatch. Strided by so many, the pieces are equally dear, be they
// of the object or of its background. 1 on GPUs, which want neighbours together.
override WALK_STRIDE: u32 = 1u;

// The place of workgroup `i` of `count`: first all places that leave no rest when divided by WALK_STRIDE, then those that leave 1.
fn walk_strided(i: u32, count: u32) -> u32 {
    let piece = count / WALK_STRIDE;
    // So many rests have a place more.
    let longer = count % WALK_STRIDE;
    let in_longer = longer * (piece + 1u);
    if i < in_longer {
        return i % (piece + 1u) * WALK_STRIDE + i / (piece + 1u);
    }
    let j = i - in_longer;
    return j % max(piece, 1u) * WALK_STRIDE + longer + j / max(piece, 1u);
}
