//! Nodes of tables over the cosine: dense towards grazing, where reflectances rise.

use crate::ggx::unit_clamp;

/// The node below a cosine, of some in even steps of its square root, and the way to the next one.
pub(super) fn place(cos: f64, nodes: usize) -> (usize, f64) {
    let at = unit_clamp(cos).sqrt() * (nodes - 1) as f64;
    let i = (at as usize).min(nodes - 2);
    (i, at - i as f64)
}
