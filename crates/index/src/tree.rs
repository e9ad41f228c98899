//! A tree over boxes, by obvhs. Its clustering merges boxes that are each other's best partners, and of equally good ones takes the
//! last: among boxes that coincide, or stand in an even row, only the last two agree, so each of its rounds would merge one pair.
//! Boxes moved by uneven, tiny amounts have no ties.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::PlocBuilder;
use obvhs::{Boundable, BvhBuildParams};

/// Largest movement of a box, over its own size, while it looks for a partner: more makes worse trees of even rows, less is lost in
/// rounding.
const LARGEST_MOVE: f32 = 1e-4;

/// Builds the tree over `boxes`, without moving any of them.
pub(crate) fn build(boxes: &[Aabb], params: &BvhBuildParams) -> Bvh2 {
    let moved: Vec<Moved> = (0u32..).zip(boxes).map(Moved::new).collect();
    let mut tree = PlocBuilder::with_capacity(moved.len()).build(
        params.ploc_search_distance,
        &moved,
        (0..moved.len() as u32).collect(),
        params.sort_precision,
        params.search_depth_threshold,
    );
    for node in tree.nodes.iter_mut().filter(|node| node.is_leaf()) {
        let first = tree.primitive_indices[node.first_index as usize];
        node.set_aabb(boxes[first as usize]);
    }
    tree.refit_all();
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut tree, params.reinsertion_batch_ratio, None);
    collapse(
        &mut tree,
        params.max_prims_per_leaf,
        params.collapse_traversal_cost,
    );
    let after = params.post_collapse_reinsertion_batch_ratio_multiplier;
    optimizer.run(&mut tree, params.reinsertion_batch_ratio * after, None);
    tree
}

/// A box, moved along its diagonal by a pseudo-random amount while partners are sought.
struct Moved(Aabb);

impl Moved {
    fn new((number, own): (u32, &Aabb)) -> Self {
        // Knuth's multiplicative hash: neighbours in number are moved by unlike amounts.
        let share = number.wrapping_mul(0x9e37_79b9) as f32 / u32::MAX as f32;
        let by = own.diagonal() * (LARGEST_MOVE * share);
        Self(Aabb::new(own.min + by, own.max + by))
    }
}

impl Boundable for Moved {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3A;

    /// Each of 20,000 boxes lay as deep as there are boxes, and took 8 to 18 s.
    fn is_shallow(boxes: &[Aabb]) {
        for params in [BvhBuildParams::medium_build(), BvhBuildParams::fast_build()] {
            let tree = build(boxes, &params);
            let depth = tree.depth(0);
            assert!(depth < 60, "{depth} levels over {} boxes", boxes.len());
            let lies_as_it_is = |node: &obvhs::bvh2::node::Bvh2Node| {
                let own = node.first_index as usize..(node.first_index + node.prim_count) as usize;
                let mut all = Aabb::empty();
                for i in &tree.primitive_indices[own] {
                    all = all.union(&boxes[*i as usize]);
                }
                all == *node.aabb()
            };
            assert!(
                tree.nodes
                    .iter()
                    .filter(|node| node.is_leaf())
                    .all(lies_as_it_is)
            );
        }
    }

    #[test]
    fn coincident_boxes_make_a_shallow_tree() {
        is_shallow(&vec![
            Aabb::new(Vec3A::ZERO, Vec3A::new(1.0, 0.5, 0.0));
            20_000
        ]);
    }

    #[test]
    fn an_even_row_of_boxes_is_done_in_a_moment() {
        let boxes: Vec<Aabb> = (0..100_000)
            .map(|i| Vec3A::new(i as f32 * 0.125, 0.0, 0.0))
            .map(|at| Aabb::new(at, at + Vec3A::new(0.125, 0.5, 0.0)))
            .collect();
        let start = std::time::Instant::now();
        is_shallow(&boxes);
        let seconds = start.elapsed().as_secs_f64();
        assert!(seconds < 20.0, "{seconds} s");
    }
}
