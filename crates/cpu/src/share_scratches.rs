//! Sharing of scratches among the samples of a pixel on an edge. Twin: share_scratches.wgsl.

use crate::prepared::Prepared;
use crate::sample_point::{SamplePoint, SampleView, Shared, Wide};
use glam::DVec2;

/// Least cosine between two normals of samples that count as one surface.
const ALIKE_COS: f64 = 0.9994;

/// Lets one sample of a pixel shade the scratches for all samples that see the same surface: the sample nearest to the pixel's middle, with the
/// pixel's whole filter. The pixel's samples are those from `first` of the batch on. Scratches are most of the work, and a pixel without an edge
/// shades them once, too.
pub(crate) fn share_scratches(
    prepared: &Prepared,
    batch: &mut [SamplePoint],
    first: usize,
    middle_px: DVec2,
) {
    let filter = prepared.scene.render.filter_std_px;
    // Samples come in pairs that lie as far from it: the first one is taken, however their places are rounded.
    let off = |point: &SamplePoint| (1e9 * point.at_px.distance_squared(middle_px)).round();
    let mut order: Vec<usize> = (first..batch.len()).collect();
    order.sort_by(|&a, &b| off(&batch[a]).total_cmp(&off(&batch[b])));
    let mut leaders: Vec<usize> = Vec::new();
    for i in order {
        let is_scratched = match &batch[i].seen {
            SampleView::Surface { hit, .. } => prepared.is_scratched(hit),
            SampleView::Background(_) => false,
        };
        if !is_scratched {
            continue;
        }
        let like = |&&leader: &&usize| is_like(&batch[leader].seen, &batch[i].seen);
        match leaders.iter().find(like).copied() {
            Some(leader) => {
                batch[i].scratches = Shared::With(leader);
                if let Shared::Among(samples) = &mut batch[leader].scratches {
                    *samples += 1;
                }
            }
            None => leaders.push(i),
        }
    }
    for leader in leaders {
        let point = &mut batch[leader];
        if let (Shared::Among(2..), SampleView::Surface { point: at, .. }) =
            (point.scratches, &point.seen)
        {
            point.wide = Some(Wide {
                point: at.with_footprint_of(filter / point.std_px),
                std_px: filter,
            });
        }
    }
}

/// Whether both samples see one surface, as far as scratches depend on it.
fn is_like(one: &SampleView, other: &SampleView) -> bool {
    match (one, other) {
        (
            SampleView::Surface { hit, point, .. },
            SampleView::Surface {
                hit: other_hit,
                point: other,
                ..
            },
        ) => {
            hit.object == other_hit.object
                && point.material == other.material
                && point.normal.dot(other.normal) > ALIKE_COS
        }
        _ => false,
    }
}
