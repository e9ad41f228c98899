//! What is drawn over the picture, kind by kind.

use egui::{Align2, Color32, FontId, Painter, Ui};
use glam::DVec3;
use hairline_editor::actions::lights;
use hairline_editor::place_light;

use crate::app::Viewer;
use crate::viewport::Area;
use crate::viewport::ink;
use crate::viewport::lens::Lens;

/// A kind of lines or words over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Overlay {
    /// Which way the scratches of the selected layer run.
    Directions,
    /// The same of all layers that are shown.
    AllDirections,
    /// The edge of the brush on the surface.
    Brush,
    /// Outlines of lights.
    Lights,
    /// What moves and turns the selected part.
    Handles,
    /// Names of objects and lights.
    Names,
}

/// Which kinds are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Overlays {
    shown: [bool; Overlay::ALL.len()],
    /// All are hidden, whatever is switched on.
    are_hidden: bool,
}

impl Overlay {
    const ALL: [Self; 6] = [
        Self::Directions,
        Self::AllDirections,
        Self::Brush,
        Self::Lights,
        Self::Handles,
        Self::Names,
    ];
}

impl Default for Overlays {
    fn default() -> Self {
        let is_shown =
            |overlay: Overlay| !matches!(overlay, Overlay::AllDirections | Overlay::Names);
        Self {
            shown: Overlay::ALL.map(is_shown),
            are_hidden: false,
        }
    }
}

impl Overlays {
    /// Whether a kind is to be drawn.
    pub fn has(&self, overlay: Overlay) -> bool {
        self.is_on(overlay) && !self.are_hidden
    }

    /// Whether a kind is switched on, be all hidden for the moment.
    pub fn is_on(&self, overlay: Overlay) -> bool {
        self.shown[overlay as usize]
    }

    pub fn are_hidden(&self) -> bool {
        self.are_hidden
    }

    /// Switches a kind. One that is switched on is to be seen.
    pub fn toggle(&mut self, overlay: Overlay) {
        let is_on = &mut self.shown[overlay as usize];
        *is_on = !*is_on;
        if *is_on {
            self.are_hidden = false;
        }
    }

    /// Hides all, or shows those again that are switched on.
    pub fn toggle_all(&mut self) {
        self.are_hidden = !self.are_hidden;
    }
}

/// Writes names where their objects and lights are.
pub(crate) fn show_names(ui: &Ui, viewer: &Viewer, area: &Area) {
    if !viewer.overlays.has(Overlay::Names) {
        return;
    }
    let lens = Lens::new(&viewer.camera(), area);
    let painter = ui.painter().with_clip_rect(area.rect);
    let description = viewer.document.description();
    for (i, object) in description.objects.iter().enumerate() {
        let (low_m, high_m) = viewer.bounds_m(Some(i));
        name(
            &painter,
            &lens,
            0.5 * (low_m + high_m),
            &object.name,
            Color32::WHITE,
        );
    }
    for (i, light) in description.lights.iter().enumerate() {
        if light.hidden {
            continue;
        }
        let title = match &light.name {
            Some(name) => name.clone(),
            None => format!("{} {}", lights::title(light), i + 1),
        };
        let color = Color32::from_rgb(255, 228, 165);
        name(&painter, &lens, place_light::center(light), &title, color);
    }
}

fn name(painter: &Painter, lens: &Lens, point_m: DVec3, words: &str, color: Color32) {
    let Some(pos) = lens.project(point_m) else {
        return;
    };
    let at = pos + egui::vec2(0.0, 9.0);
    ink::words(
        painter,
        at,
        Align2::CENTER_TOP,
        words,
        FontId::proportional(13.0),
        color,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_switch_hides_all_and_each_kind_has_its_own() {
        let mut overlays = Overlays::default();
        assert!(overlays.has(Overlay::Directions) && !overlays.has(Overlay::Names));
        overlays.toggle_all();
        assert!(
            !Overlay::ALL
                .into_iter()
                .any(|overlay| overlays.has(overlay))
        );
        // What is asked for is seen.
        overlays.toggle(Overlay::Names);
        assert!(overlays.has(Overlay::Names) && overlays.has(Overlay::Lights));
        overlays.toggle(Overlay::Lights);
        assert!(!overlays.has(Overlay::Lights) && overlays.has(Overlay::Brush));
    }
}
