//! The few scratches that stand for all in coarse pictures, for as long as the scratches stay.

use std::sync::{Arc, Weak};

use hairline_cpu::draft::{Draft, DraftLayer};
use hairline_document::description::Layer;
use hairline_index::ScratchIndex;

use super::Built;
use super::sketch::Sketch;

/// Drafts of the last scene, by their thinning.
#[derive(Default)]
pub(super) struct Drafts {
    scratches: Weak<ScratchIndex>,
    drafts: Vec<(u32, Arc<Draft>)>,
}

impl Drafts {
    /// One scratch of `thin`.
    pub fn draft(&mut self, built: &Built, thin: u32) -> Arc<Draft> {
        let scratches = Arc::downgrade(&built.scratches);
        if !self.scratches.ptr_eq(&scratches) {
            self.drafts.clear();
            self.scratches = scratches;
        }
        if let Some((_, draft)) = self.drafts.iter().find(|(of, _)| *of == thin) {
            return Arc::clone(draft);
        }
        // A sketch has few as it is.
        let step = f64::from(thin) / built.sketch.as_ref().map_or(1.0, Sketch::thin);
        let layer = |layer: u32| {
            let at = layer as usize;
            let table = built.description.scratches.get(at);
            DraftLayer {
                weight: built
                    .sketch
                    .as_ref()
                    .map_or(1.0, |sketch| sketch.weight(at)),
                is_random: table.is_some_and(|table| matches!(table.layer, Layer::Laid(_))),
            }
        };
        let draft = Arc::new(Draft::new(
            &built.scene,
            &built.tables.shapes,
            step.round() as usize,
            &layer,
        ));
        self.drafts.push((thin, Arc::clone(&draft)));
        draft
    }
}
