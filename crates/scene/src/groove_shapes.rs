//! The shapes of the grooves of a scene's scratches: each has tables of its own.

use crate::scene::{Object, Scene, Scratch};
use crate::section_id::SectionId;
use hairline_optics::section::{GrooveShape, NARROW};
use rayon::prelude::*;

/// Number of shapes that a scene may have: renderers keep one in four bits.
pub const MOST_SHAPES: usize = 16;
/// Scratches of one task.
const TASK: usize = 1 << 14;

/// All shapes of a scene, narrow rectangles first.
#[derive(Clone, Debug, PartialEq)]
pub struct GrooveShapes {
    keys: Vec<(SectionId, u8)>,
}

/// Narrow rectangles alone.
impl Default for GrooveShapes {
    fn default() -> Self {
        Self {
            keys: vec![(SectionId::default(), 0)],
        }
    }
}

impl GrooveShapes {
    /// Finds the shapes of all scratches.
    pub fn new(scene: &Scene) -> Self {
        let coherences_um = scene.materials.iter().map(|material| material.coherence_um);
        // Most scenes have nothing else, which the scratches tell by themselves.
        let narrow_um = NARROW * coherences_um.fold(f64::INFINITY, f64::min);
        let is_plain = |scratch: &Scratch| {
            let profile = scratch.profile;
            profile.section == SectionId::default() && f64::from(profile.width_um) <= narrow_um
        };
        let Self { mut keys } = Self::default();
        for object in &scene.objects {
            let tasks = object.scratches.par_chunks(TASK).map(|scratches| {
                let mut keys = Vec::new();
                if scratches.iter().all(is_plain) {
                    return keys;
                }
                for scratch in scratches {
                    let key = scene.shape_key(object, scratch);
                    if !keys.contains(&key) {
                        keys.push(key);
                    }
                }
                keys
            });
            for more in tasks.collect::<Vec<_>>() {
                keys.extend(more);
            }
        }
        keys.sort_unstable();
        keys.dedup();
        Self { keys }
    }

    /// The shapes that there are tables for: no more than [`MOST_SHAPES`].
    pub fn shapes(&self) -> impl ExactSizeIterator<Item = GrooveShape> {
        let keys = self.keys.iter().take(MOST_SHAPES);
        keys.map(|(section, width_class)| GrooveShape {
            section: section.section(),
            width_class: *width_class,
        })
    }

    /// Number of shapes that the scene has.
    pub fn count(&self) -> usize {
        self.keys.len()
    }

    /// Whether a scratch of the scene is wide: its halves lie apart.
    pub fn is_wide(&self, scene: &Scene, object: &Object, scratch: &Scratch) -> bool {
        self.keys.len() > 1 && scene.shape_key(object, scratch).1 > 0
    }

    /// Index of the shape of a scratch of the scene. Of shapes beyond the last the nearest one.
    pub fn index(&self, scene: &Scene, object: &Object, scratch: &Scratch) -> u8 {
        if self.keys.len() == 1 {
            return 0;
        }
        let key = scene.shape_key(object, scratch);
        let at = self.keys.partition_point(|it| *it < key);
        at.min(self.keys.len().min(MOST_SHAPES) - 1) as u8
    }
}

impl Scene {
    /// Coherence length of the material under the beginning of a scratch.
    pub fn scratch_coherence_um(&self, object: &Object, scratch: &Scratch) -> Option<f64> {
        let first = object.segments.get(scratch.segments.start as usize)?;
        let material = object.mesh.triangle_materials[first.triangle as usize];
        Some(self.materials[material as usize].coherence_um)
    }

    fn shape_key(&self, object: &Object, scratch: &Scratch) -> (SectionId, u8) {
        let coherence_um = self.scratch_coherence_um(object, scratch);
        let windows = f64::from(scratch.profile.width_um) / coherence_um.unwrap_or(f64::INFINITY);
        let class = hairline_optics::section::width_class(windows);
        (scratch.profile.section, class)
    }
}
