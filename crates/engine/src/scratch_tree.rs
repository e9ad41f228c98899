//! An object's scratches as texels for engines that find them at a point. `shaders/engine/scratch_tree.wgsl` walks through them, and
//! documents their places.
//!
//! Hairline's own passes do not need it: they bring segments to the tiles of the picture.

use glam::Vec3;
use hairline_index::ScratchIndex;
use hairline_index::packed_profile::profile_words;

/// Texels in a row of the texture.
pub const WIDTH: usize = 1024;
/// Bits of a node that hold its first piece.
const FIRST_BITS: u32 = 28;

/// The scratches of one of a scene's objects, by the index of the scene: texels of an `rgba32uint` texture, whole rows of [`WIDTH`].
/// Positions are those of the scene, over `unit_m`, the length of the engine's unit.
pub fn texels(index: &ScratchIndex, object: usize, unit_m: f32) -> Vec<[u32; 4]> {
    let range = index.tree.objects[object].clone();
    let first_node = range.start;
    let nodes = &index.tree.nodes[range.start as usize..range.end as usize];
    let range = index.segment_range(object);
    let first_piece = range.start;
    let pieces = &index.tree.segments[range.start as usize..range.end as usize];
    let mut texels = vec![[0; 4]; 1 + 2 * nodes.len() + 2 * pieces.len()];
    texels[0] = [
        nodes.len() as u32,
        pieces.len() as u32,
        index.depth_coherence[object].to_bits(),
        index.coherence_max_um()[object].to_bits(),
    ];
    let with = |v: Vec3, word: u32| {
        let [x, y, z] = (v / unit_m).to_array().map(f32::to_bits);
        [x, y, z, word]
    };
    // The first piece below an inner node is that of the node after it.
    let mut first = pieces.len() as u32;
    for (i, node) in nodes.iter().enumerate().rev() {
        let own = node.segments();
        if !own.is_empty() {
            first = own.start as u32 - first_piece;
        }
        texels[1 + 2 * i] = with(node.min_m, node.skip - first_node);
        texels[2 + 2 * i] = with(node.max_m, first | (own.len() as u32) << FIRST_BITS);
    }
    let pieces_at = 1 + 2 * nodes.len();
    for (i, piece) in pieces.iter().enumerate() {
        let [sizes, more] = profile_words(piece);
        texels[pieces_at + 2 * i] = with(piece.start_m, sizes);
        texels[pieces_at + 2 * i + 1] = with(piece.end_m, more);
    }
    texels.resize(texels.len().next_multiple_of(WIDTH), [0; 4]);
    texels
}
