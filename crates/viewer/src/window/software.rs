//! A window that a software driver draws on the cores that paint: a frame and a picture take turns.

use std::time::Duration;

use egui::Color32;

use crate::progressive::{ProgressiveRenderer, View};

/// Time to wait for a picture, before the window is drawn without it. A picture in motion takes less if nothing else runs.
const PATIENCE: Duration = Duration::from_millis(100);

/// Behaviour of such a window that differs from one that a GPU draws.
#[derive(Default)]
pub(crate) struct SoftwareWindow {
    is_free: bool,
    /// View and revision of the picture that was last waited for.
    waited_for: Option<(View, u64)>,
}

impl SoftwareWindow {
    /// Leaves out layers that the driver pays for and nobody sees: the panels' ground is the colour that the window is cleared
    /// to.
    pub fn new(ctx: &egui::Context) -> Self {
        ctx.all_styles_mut(|style| style.visuals.panel_fill = Color32::TRANSPARENT);
        Self::default()
    }

    /// Makes frames wait for no refresh of the screen, for which the driver stands still.
    pub fn free(&mut self, frame: &mut eframe::Frame) {
        if !std::mem::replace(&mut self.is_free, true)
            && let Some(config) = frame.wgpu_surface_config()
        {
            frame.set_wgpu_surface_config(eframe::SurfaceConfig {
                present_mode: wgpu::PresentMode::AutoNoVsync,
                ..config
            });
        }
    }

    /// Waits for the picture of the view since the last pass. A frame without it would take as long as the picture, from the
    /// same cores, and show nothing new.
    pub fn wait_for_picture(&mut self, renderer: &ProgressiveRenderer, view: View, revision: u64) {
        let is_new = self
            .waited_for
            .is_none_or(|(last, of)| of != revision || !last.has_same_pixels(&view));
        self.waited_for = Some((view, revision));
        if is_new && renderer.latest().is_some() {
            renderer.wait_for_picture(revision, PATIENCE);
        }
    }
}
