//! Undo as snapshots: a step keeps the whole description on its other side. Neighbouring steps share theirs, and a
//! description is small unless much was drawn on it, so a bound in bytes is enough; nothing needs an inverse.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use hairline_document::Description;
use hairline_document::description::{Layer, Line, Stroke};

use crate::Selection;

/// Key that distinguishes one drag from another: the widget or gizmo that is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DragKey(pub u64);

impl DragKey {
    /// The key of whatever names a widget.
    pub fn from_name(name: impl Hash) -> Self {
        let mut hasher = DefaultHasher::new();
        name.hash(&mut hasher);
        Self(hasher.finish())
    }
}

/// A description and its selection.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub description: Arc<Description>,
    pub selection: Selection,
}

/// A way from one state to another; in the undo list it leads back, in the redo list forward.
#[derive(Clone, Debug)]
struct Step {
    label: String,
    /// The state on the other side.
    other: State,
    /// Selection on this side when the step was made or last taken.
    selection_here: Selection,
    bytes: usize,
}

/// Limits of the history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bounds {
    pub bytes: usize,
    pub steps: usize,
}

impl Default for Bounds {
    /// Hundreds of steps on a scene with a million drawn points, all of a day's work on most.
    fn default() -> Self {
        Self {
            bytes: 256 << 20,
            steps: 1000,
        }
    }
}

#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    undo: VecDeque<Step>,
    redo: Vec<Step>,
    bounds: Bounds,
}

impl History {
    #[cfg(test)]
    pub(crate) fn with_bounds(bounds: Bounds) -> Self {
        Self {
            bounds,
            ..Self::default()
        }
    }

    /// Adds a step from `before` to the present state; steps that were undone are forgotten.
    pub(crate) fn push(&mut self, label: &str, before: State, selection_now: Selection) {
        self.redo.clear();
        self.undo.push_back(Step {
            label: label.to_owned(),
            bytes: estimated_bytes(&before.description),
            other: before,
            selection_here: selection_now,
        });
        self.drop_oldest();
    }

    /// The description before the newest step; none after steps back.
    pub(crate) fn previous(&self) -> Option<&Arc<Description>> {
        let newest = self.undo.back().filter(|_| self.redo.is_empty());
        newest.map(|step| &step.other.description)
    }

    /// Forgets the step that [`Self::redo`] would take.
    pub(crate) fn drop_redo(&mut self) {
        self.redo.pop();
    }

    /// Takes the newest step out, for a drag that came back to where it began.
    pub(crate) fn pop(&mut self) {
        self.undo.pop_back();
    }

    /// Sets the selection after the newest step.
    pub(crate) fn set_newest_selection(&mut self, selection: Selection) {
        if let Some(step) = self.undo.back_mut() {
            step.selection_here = selection;
        }
    }

    /// Goes one step back from `now`; returns the state there and the step's label.
    pub(crate) fn undo(&mut self, now: State) -> Option<(State, String)> {
        let step = self.undo.pop_back()?;
        let (label, state, back) = turn(step, now);
        self.redo.push(back);
        Some((state, label))
    }

    /// Goes one step forward again from `now`.
    pub(crate) fn redo(&mut self, now: State) -> Option<(State, String)> {
        let step = self.redo.pop()?;
        let (label, state, back) = turn(step, now);
        self.undo.push_back(back);
        Some((state, label))
    }

    pub(crate) fn undo_label(&self) -> Option<&str> {
        self.undo.back().map(|step| step.label.as_str())
    }

    pub(crate) fn redo_label(&self) -> Option<&str> {
        self.redo.last().map(|step| step.label.as_str())
    }

    /// Changes every kept description alike. Steps that share one share the changed one.
    pub(crate) fn rewrite(
        &mut self,
        change: &mut dyn FnMut(&Arc<Description>) -> Arc<Description>,
    ) {
        for step in self.undo.iter_mut().chain(&mut self.redo) {
            step.other.description = change(&step.other.description);
        }
    }

    fn drop_oldest(&mut self) {
        let mut bytes: usize = self.undo.iter().map(|step| step.bytes).sum();
        while self.undo.len() > self.bounds.steps || bytes > self.bounds.bytes {
            // The newest step stays, whatever it takes: an edit that cannot be undone is worse than the memory.
            if self.undo.len() <= 1 {
                break;
            }
            bytes -= self.undo.pop_front().map_or(0, |step| step.bytes);
        }
    }
}

/// Takes a step: its label, the state on the other side, and the step that leads back here.
fn turn(step: Step, now: State) -> (String, State, Step) {
    let back = Step {
        label: step.label.clone(),
        bytes: estimated_bytes(&now.description),
        other: State {
            description: now.description,
            selection: step.selection_here,
        },
        selection_here: step.other.selection,
    };
    (step.label, step.other, back)
}

/// Estimated memory of a description: the points of strokes and polygons as they are, all else as one flat sum for each
/// table.
fn estimated_bytes(description: &Description) -> usize {
    const TABLE_BYTES: usize = 512;
    let tables = description.materials.len()
        + description.objects.len()
        + description.scratches.len()
        + description.lights.len();
    let strokes = description
        .scratches
        .iter()
        .flat_map(|layer| &layer.strokes);
    let stroke_bytes = strokes.map(|s| size_of::<Stroke>() + size_of_val(&s.points_m[..]));
    let curves = description
        .scratches
        .iter()
        .map(|layer| match &layer.layer {
            Layer::Engraved(engraved) => match &engraved.line {
                Line::Curve { points_m, .. } => size_of_val(&points_m[..]),
                Line::Text { .. } | Line::Svg { .. } => 0,
            },
            _ => 0,
        });
    let lights = description
        .lights
        .iter()
        .map(|light| size_of_val(light.kind.vertices_m()));
    TABLE_BYTES * (1 + tables)
        + stroke_bytes.sum::<usize>()
        + curves.sum::<usize>()
        + lights.sum::<usize>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(exposure_ev: f64) -> State {
        let text = format!(
            "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\nexposure_ev = {exposure_ev:?}\n"
        );
        State {
            description: Arc::new(Description::from_toml(&text, "test".as_ref()).unwrap()),
            selection: Selection::None,
        }
    }

    #[test]
    fn the_oldest_steps_go_first_and_the_newest_stays() {
        let bounds = Bounds {
            bytes: usize::MAX,
            steps: 3,
        };
        let mut history = History::with_bounds(bounds);
        for i in 0..5 {
            history.push(&format!("{i}"), state(f64::from(i)), Selection::None);
        }
        let mut now = state(5.0);
        let mut labels = Vec::new();
        while let Some((state, label)) = history.undo(now.clone()) {
            now = state;
            labels.push(label);
        }
        assert_eq!(labels, ["4", "3", "2"]);
        assert_eq!(now.description.camera.exposure_ev, 2.0);

        let mut tight = History::with_bounds(Bounds { bytes: 1, steps: 9 });
        tight.push("a", state(0.0), Selection::None);
        tight.push("b", state(1.0), Selection::None);
        assert_eq!(tight.undo_label(), Some("b"));
        assert!(tight.undo(state(2.0)).is_some() && tight.undo(state(1.0)).is_none());
    }
}
