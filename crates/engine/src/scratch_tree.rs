//! An object's scratches as texels for engines that find them at a point. `shaders/engine/scratch_tree.wgsl` walks through them, and
//! documents their places.
//!
//! Hairline's own passes do not need it: they bring segments to the tiles of the picture.

use glam::Vec3;
use hairline_index::ScratchIndex;
use hairline_index::packed_profile::profile_words;
use hairline_optics::section::GrooveShape;
use hairline_optics::table::{ROWS, rows_down_to};
use hairline_scene::{GrooveShapes, Scene};

/// Texels in a row of the texture.
pub const WIDTH: usize = 1024;
/// Tables have a multiple of so many rows: materials with scratches of about the same depth share one.
const TABLE_ROWS: usize = 32;
/// Bits of a node that hold its first piece.
const FIRST_BITS: u32 = 28;

/// Scratches as shaders find them.
#[derive(Clone, Debug, PartialEq)]
pub struct ScratchTexels {
    /// The tree: a texture of `rgba32uint`, whole rows of [`WIDTH`] texels.
    pub tree: Vec<[u32; 4]>,
    /// Shapes of the grooves, each with a layer of [`scratch_table`](crate::scratch_table).
    pub shapes: Vec<GrooveShape>,
    /// Rows that the table needs for the deepest of them.
    pub table_rows: usize,
}

impl ScratchTexels {
    /// Those of one of a scene's objects; `unit_m` is the length of the engine's unit.
    pub fn of_scene(scene: &Scene, object: usize, unit_m: f32) -> Self {
        let depths = scene.objects[object].scratches.iter();
        let deepest_nm = depths.fold(0.0, |deepest, it| it.profile.depth_nm.max(deepest));
        let rows = rows_down_to(deepest_nm.into()) + 1;
        Self {
            tree: texels(&ScratchIndex::laid(scene), object, unit_m),
            shapes: GrooveShapes::new(scene).shapes().collect(),
            table_rows: rows.next_multiple_of(TABLE_ROWS).min(ROWS),
        }
    }
}

/// The scratches of one of a scene's objects, by the index of the scene: texels of an `rgba32uint` texture, whole rows of [`WIDTH`].
/// Positions are those of the scene, over `unit_m`, the length of the engine's unit.
fn texels(index: &ScratchIndex, object: usize, unit_m: f32) -> Vec<[u32; 4]> {
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
