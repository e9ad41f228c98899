//! Growing a tree on all cores: halves by the median until they are small, then obvhs (PLOC and reinsertion) for each, side
//! by side. The size of a part is fixed, so the tree does not depend on the number of cores.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};

use super::{LEAF_FIRST_BITS, ScratchNode, Straight};

/// Most segments in one leaf.
const LEAF_SEGMENTS: u32 = 4;
/// Segments that one thread takes: enough that the medians above them are few, and the tree as good as one grown whole.
const PART_SEGMENTS: usize = 1 << 15;

/// A tree or a part of one, counted from its own beginning, in depth-first order.
pub(super) struct Part<S> {
    pub nodes: Vec<ScratchNode>,
    pub segments: Vec<S>,
}

/// The tree over an object's segments; nothing for none.
pub(super) fn grow<S: Straight>(mut segments: Vec<S>) -> Part<S> {
    grow_part(&mut segments)
}

fn grow_part<S: Straight>(segments: &mut [S]) -> Part<S> {
    if segments.len() <= PART_SEGMENTS {
        return Part::of_few(segments);
    }
    let middle = segments.len() / 2;
    let place = |s: &S| {
        let [a, b] = s.ends_m();
        a + b
    };
    let (low, high) = segments.iter().map(place).fold(
        (Vec3::INFINITY, Vec3::NEG_INFINITY),
        |(low, high), place| (low.min(place), high.max(place)),
    );
    let axis = (high - low).max_position();
    segments.select_nth_unstable_by(middle, |a, b| place(a)[axis].total_cmp(&place(b)[axis]));
    let (left, right) = segments.split_at_mut(middle);
    let (left, right) = rayon::join(|| grow_part(left), || grow_part(right));
    Part::of_halves(left, right)
}

impl<S: Straight> Part<S> {
    /// A node over two trees.
    fn of_halves(left: Self, right: Self) -> Self {
        let (first, second) = (left.nodes[0], right.nodes[0]);
        let above = ScratchNode {
            min_m: first.min_m.min(second.min_m),
            skip: (1 + left.nodes.len() + right.nodes.len()) as u32,
            max_m: first.max_m.max(second.max_m),
            leaf: 0,
        };
        let mut nodes = Vec::with_capacity(above.skip as usize);
        nodes.push(above);
        nodes.extend(left.nodes.iter().map(|node| node.moved(1, 0)));
        let before = (nodes.len() as u32, left.segments.len() as u32);
        nodes.extend(
            right
                .nodes
                .iter()
                .map(|node| node.moved(before.0, before.1)),
        );
        let mut segments = left.segments;
        segments.extend(right.segments);
        Self { nodes, segments }
    }

    fn of_few(segments: &[S]) -> Self {
        let mut part = Self {
            nodes: Vec::new(),
            segments: Vec::with_capacity(segments.len()),
        };
        if segments.is_empty() {
            return part;
        }
        let boxes: Vec<SegmentBox> = segments
            .iter()
            .map(|s| SegmentBox::new(s.ends_m()))
            .collect();
        let params = BvhBuildParams {
            max_prims_per_leaf: LEAF_SEGMENTS,
            ..BvhBuildParams::medium_build()
        };
        let tree = build_bvh2(&boxes, params, &mut std::time::Duration::default());
        part.append_depth_first(&tree, segments);
        part
    }

    /// obvhs keeps siblings side by side; skip pointers want depth-first order.
    fn append_depth_first(&mut self, tree: &Bvh2, segments: &[S]) {
        // The second child's turn comes when the first one's subtree is done; a node's skip is known when its own is.
        enum Step {
            Enter(usize),
            Leave(usize),
        }
        let mut steps = vec![Step::Enter(0)];
        while let Some(step) = steps.pop() {
            match step {
                Step::Leave(written) => self.nodes[written].skip = self.nodes.len() as u32,
                Step::Enter(at) => {
                    let node = &tree.nodes[at];
                    let written = self.nodes.len();
                    let mut leaf = 0;
                    steps.push(Step::Leave(written));
                    if node.is_leaf() {
                        let first = self.segments.len() as u32;
                        let own = node.first_index as usize
                            ..(node.first_index + node.prim_count) as usize;
                        self.segments.extend(
                            tree.primitive_indices[own]
                                .iter()
                                .map(|i| segments[*i as usize]),
                        );
                        leaf = first | node.prim_count << LEAF_FIRST_BITS;
                    } else {
                        steps.push(Step::Enter(node.first_index as usize + 1));
                        steps.push(Step::Enter(node.first_index as usize));
                    }
                    let bounds = node.aabb();
                    self.nodes.push(ScratchNode {
                        min_m: bounds.min.into(),
                        skip: 0,
                        max_m: bounds.max.into(),
                        leaf,
                    });
                }
            }
        }
    }
}

struct SegmentBox(Aabb);

impl SegmentBox {
    fn new(ends_m: [Vec3; 2]) -> Self {
        Self(Aabb::from_points(&ends_m.map(Into::into)))
    }
}

impl Boundable for SegmentBox {
    fn aabb(&self) -> Aabb {
        self.0
    }
}
