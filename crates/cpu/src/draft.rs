//! A few of the scratches for all of them: pictures in motion, which must come soon and need not be exact.
//!
//! Of each layer some scratches are taken, whole and evenly from all of it, and each counts for as many as there are of them for each
//! that is taken. A picture of them is right in the mean: brightness and fans are those of the full picture, with more noise. It is
//! the same few each time, so a picture in motion does not flicker.

use hairline_index::{IndexedSegment, ScratchIndex};
use hairline_scene::{GrooveShapes, Scene};
use std::ops::Range;

/// A layer keeps at least so many scratches: those of a hand are few, and each of them is looked for.
const FEWEST: usize = 48;

/// Properties of a layer that a draft depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DraftLayer {
    /// Number of scratches for which each scratch of the scene stands already.
    pub weight: f64,
    /// Whether the scratches are in random order: then the first ones are taken, which an editor has first. Else they are taken
    /// evenly from all of the layer.
    pub is_random: bool,
}

/// Some scratches of each layer of a scene, with their weights.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// Object by object.
    pub(crate) segments: Vec<IndexedSegment>,
    /// Number of pieces for which each of the `segments` stands.
    pub(crate) weights: Vec<f32>,
    /// The segments of each object.
    pub(crate) objects: Vec<Range<usize>>,
}

impl Draft {
    /// Takes one of every `step` scratches of each layer, or all of them where they are few. `layer` describes a layer by its number.
    pub fn new(
        scene: &Scene,
        shapes: &GrooveShapes,
        step: usize,
        layer: &dyn Fn(u32) -> DraftLayer,
    ) -> Self {
        let mut draft = Self::default();
        for object in &scene.objects {
            let first = draft.segments.len();
            for scratches in object.scratches.chunk_by(|a, b| a.layer == b.layer) {
                let all = scratches.len();
                let DraftLayer { weight, is_random } = layer(scratches[0].layer);
                let kept = (all / step.max(1)).max(FEWEST).min(all);
                let pieces = if is_random || kept == all {
                    ScratchIndex::pieces(scene, shapes, object, &scratches[..kept])
                } else {
                    let chosen = (0..kept).map(|i| scratches[i * all / kept].clone());
                    ScratchIndex::pieces(scene, shapes, object, &chosen.collect::<Vec<_>>())
                };
                let weight = weight * all as f64 / kept as f64;
                let end = draft.segments.len() + pieces.len();
                draft.weights.resize(end, weight as f32);
                draft.segments.extend(pieces);
            }
            draft.objects.push(first..draft.segments.len());
        }
        draft
    }

    /// Number of its pieces.
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    /// Whether there are no scratches.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }
}

#[cfg(test)]
mod tests;
