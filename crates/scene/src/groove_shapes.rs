//! The shapes of the grooves of a scene's scratches: each has tables of its own.

use crate::scene::{Object, Scene, Scratch};
use hairline_optics::section::{GrooveShape, NARROW, Section};
use rayon::prelude::*;

/// Number of shapes that a scene may have: renderers keep one in four bits.
pub const MOST_SHAPES: usize = 16;
/// Scratches of one task.
const TASK: usize = 1 << 14;

/// All shapes of a scene, narrow rectangles first.
#[derive(Clone, Debug, PartialEq)]
pub struct GrooveShapes {
    sections: Vec<Section>,
    /// Index of a section, and a class of widths, in ascending order.
    keys: Vec<(usize, u8)>,
}

/// Narrow rectangles alone.
impl Default for GrooveShapes {
    fn default() -> Self {
        Self {
            sections: vec![Section::Rectangle],
            keys: vec![(0, 0)],
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
            let profile = &scratch.profile;
            profile.section == Section::Rectangle && f64::from(profile.width_um) <= narrow_um
        };
        let mut all = Self::default();
        for object in &scene.objects {
            let tasks = object.scratches.par_chunks(TASK).map(|scratches| {
                let mut shapes = Vec::new();
                if scratches.iter().all(is_plain) {
                    return shapes;
                }
                for scratch in scratches {
                    let shape = scene.shape_key(object, scratch);
                    if !shapes.contains(&shape) {
                        shapes.push(shape);
                    }
                }
                shapes
            });
            for (section, class) in tasks.collect::<Vec<_>>().into_iter().flatten() {
                let number = all.number(section).unwrap_or_else(|| {
                    all.sections.push(section.clone());
                    all.sections.len() - 1
                });
                all.keys.push((number, class));
            }
        }
        all.keys.sort_unstable();
        all.keys.dedup();
        all
    }

    fn number(&self, section: &Section) -> Option<usize> {
        self.sections.iter().position(|it| it == section)
    }

    /// Cross section of a shape.
    pub fn section(&self, shape: u8) -> &Section {
        &self.sections[self.keys[usize::from(shape)].0]
    }

    /// The shapes that there are tables for: no more than [`MOST_SHAPES`].
    pub fn shapes(&self) -> impl ExactSizeIterator<Item = GrooveShape> {
        let keys = self.keys.iter().take(MOST_SHAPES);
        keys.map(|(section, width_class)| GrooveShape {
            section: self.sections[*section].clone(),
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
        let (section, class) = scene.shape_key(object, scratch);
        let key = (self.number(section).unwrap_or(0), class);
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

    fn shape_key<'s>(&self, object: &Object, scratch: &'s Scratch) -> (&'s Section, u8) {
        let coherence_um = self.scratch_coherence_um(object, scratch);
        let windows = f64::from(scratch.profile.width_um) / coherence_um.unwrap_or(f64::INFINITY);
        let class = hairline_optics::section::width_class(windows);
        (&scratch.profile.section, class)
    }
}
