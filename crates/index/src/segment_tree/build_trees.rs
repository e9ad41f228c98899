//! Trees side by side: new ones grown at the same time, each in its part of the segments, and those that were grown before.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::grow;
use super::node::{LEAF_FIRST_BITS, Piece, ScratchNode, SegmentTree, Straight, Tree};
use crate::watch::Watch;

/// Appends segments.
type Fill<'a, S> = Box<dyn FnOnce(&mut Vec<S>) + Send + 'a>;

/// Source of a tree.
pub(crate) enum TreeSource<'a, S> {
    /// A tree to be grown over the segments that `fill` appends, `most` at most.
    New { most: usize, fill: Fill<'a, S> },
    /// A tree that was grown before.
    Kept(Tree),
}

/// Share of the filling in of segments in all work.
const FILL_SHARE: f64 = 0.1;

/// Number of segments or nodes that are worth another thread to copy them.
const COPY: usize = 1 << 14;

/// Grows the trees, several for each object, all cores at work. Those that were grown before lie in `last`. `None` if it was
/// cancelled.
///
/// # Panics
/// Beyond 268 million segments.
pub(crate) fn build_trees<S: Straight>(
    objects: Vec<Vec<TreeSource<S>>>,
    last: Option<&SegmentTree<S>>,
    watch: &Watch,
) -> Option<SegmentTree<S>> {
    let counts: Vec<usize> = objects.iter().map(Vec::len).collect();
    let sources = objects.into_iter().flatten().collect();
    let (mut segments, places) = fill_segments(sources, last, watch)?;
    let grown = grow_trees(&mut segments, places, watch)?;
    let (nodes, trees) = join_nodes(counts, grown);
    let mut end = 0;
    let ranges = trees.iter().map(|own| {
        let first = end;
        end = own.last().map_or(first, |tree| tree.nodes.end);
        first..end
    });
    Some(SegmentTree {
        objects: ranges.collect(),
        nodes,
        segments,
        trees,
    })
}

/// The segments of a tree, and where it was grown before.
type Place<'a, S> = (Range<u32>, Option<(&'a SegmentTree<S>, Tree)>);

/// Fills in the segments of all trees, one after the other.
fn fill_segments<'a, S: Straight>(
    sources: Vec<TreeSource<S>>,
    last: Option<&'a SegmentTree<S>>,
    watch: &Watch,
) -> Option<(Vec<S>, Vec<Place<'a, S>>)> {
    let most = sources.iter().map(|source| match source {
        TreeSource::New { most, .. } => *most,
        TreeSource::Kept(tree) => tree.segments.len(),
    });
    let most = most.sum::<usize>();
    let mut segments = Vec::with_capacity(most);
    let mut places = Vec::with_capacity(sources.len());
    for source in sources {
        if (watch.cancelled)() {
            return None;
        }
        let first = segments.len();
        let kept = match source {
            TreeSource::New { fill, .. } => {
                fill(&mut segments);
                None
            }
            TreeSource::Kept(tree) => {
                let last = last?;
                let own = last.segments[as_usize(&tree.segments)].par_iter();
                segments.par_extend(own.with_min_len(COPY).copied());
                Some((last, tree))
            }
        };
        let end = segments.len();
        assert!(end < 1 << LEAF_FIRST_BITS, "more than 268 million segments");
        (watch.progress)(FILL_SHARE * end as f64 / most.max(1) as f64);
        places.push((first as u32..end as u32, kept));
    }
    Some((segments, places))
}

/// Nodes of each tree, with its segments.
type Grown<'a> = Vec<(Range<u32>, Vec<Piece<'a>>)>;

/// Grows the new trees, each in its part of the segments, which come into the order of its leaves.
fn grow_trees<'a, S: Straight>(
    segments: &mut [S],
    places: Vec<Place<'a, S>>,
    watch: &Watch,
) -> Option<Grown<'a>> {
    let (all, done) = (segments.len(), AtomicUsize::new(0));
    let goes_on = |count: usize| {
        let done = done.fetch_add(count, Ordering::Relaxed) + count;
        let share = FILL_SHARE + (1.0 - FILL_SHARE) * done as f64 / all as f64;
        (watch.progress)(share.min(1.0));
        !(watch.cancelled)()
    };
    let mut rest = segments;
    let places: Vec<_> = places
        .into_iter()
        .map(|(place, kept)| {
            let (own, others) = std::mem::take(&mut rest).split_at_mut(place.len());
            rest = others;
            (place, own, kept)
        })
        .collect();
    let grown = places
        .into_par_iter()
        .map(|(place, own, kept)| {
            let pieces = match kept {
                None => grow::grow(own, place.start, &goes_on),
                Some((last, tree)) => {
                    goes_on(own.len());
                    vec![Piece {
                        nodes: Cow::Borrowed(&last.nodes[as_usize(&tree.nodes)]),
                        first_node: tree.nodes.start,
                        segments_by: place.start.wrapping_sub(tree.segments.start),
                    }]
                }
            };
            (place, pieces)
        })
        .collect();
    (!(watch.cancelled)()).then_some(grown)
}

/// Joins the nodes of all trees: so many trees for each object.
fn join_nodes(counts: Vec<usize>, grown: Grown) -> (Vec<ScratchNode>, Vec<Vec<Tree>>) {
    let pieces = grown.iter().flat_map(|(_, pieces)| pieces);
    let mut nodes = Vec::with_capacity(pieces.map(|piece| piece.nodes.len()).sum());
    let mut grown = grown.into_iter();
    let trees = counts.into_iter().map(|count| {
        let own = grown.by_ref().take(count).map(|(segments, pieces)| {
            let first = nodes.len() as u32;
            for piece in pieces {
                let by = (nodes.len() as u32).wrapping_sub(piece.first_node);
                let own = piece.nodes.par_iter().with_min_len(COPY);
                nodes.par_extend(own.map(|node| node.moved(by, piece.segments_by)));
            }
            let nodes = first..nodes.len() as u32;
            Tree { nodes, segments }
        });
        own.collect()
    });
    let trees = trees.collect();
    (nodes, trees)
}

fn as_usize(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}
