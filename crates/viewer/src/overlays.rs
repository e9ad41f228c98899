//! Kinds of overlays that are drawn over the picture.

/// A kind of lines or words over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Overlay {
    /// Directions of the scratches of the selected layer.
    Directions,
    /// Directions of the scratches of all visible layers.
    AllDirections,
    /// The edge of the brush on the surface.
    Brush,
    /// Outlines of lights.
    Lights,
    /// Handles that move and turn the selected part.
    Handles,
    /// Names of objects and lights.
    Names,
    /// Numbers of scratches of the layers whose directions are drawn.
    Numbers,
}

/// Choice of the visible overlays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Overlays {
    shown: [bool; Overlay::ALL.len()],
    /// Whether all are hidden, whatever is switched on.
    are_hidden: bool,
}

impl Overlay {
    const ALL: [Self; 7] = [
        Self::Directions,
        Self::AllDirections,
        Self::Brush,
        Self::Lights,
        Self::Handles,
        Self::Names,
        Self::Numbers,
    ];
}

impl Default for Overlays {
    fn default() -> Self {
        let is_shown = |overlay: Overlay| {
            !matches!(
                overlay,
                Overlay::AllDirections | Overlay::Names | Overlay::Numbers
            )
        };
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

    /// Hides all overlays, or shows those again that are switched on.
    pub fn toggle_all(&mut self) {
        self.are_hidden = !self.are_hidden;
    }
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
        // A selected overlay is visible.
        overlays.toggle(Overlay::Names);
        assert!(overlays.has(Overlay::Names) && overlays.has(Overlay::Lights));
        overlays.toggle(Overlay::Lights);
        assert!(!overlays.has(Overlay::Lights) && overlays.has(Overlay::Brush));
    }
}
