//! The sign that something is being made.

use egui::{Response, Role, Sense, Ui, Widget, WidgetInfo, pos2, vec2};

/// Interval between two steps of the sign, seconds.
const STEP_S: f64 = 0.15;
const DOTS: usize = 8;

/// A ring of dots with a bright one that goes round in steps. egui's own spinner asks for as many frames as the device can
/// draw, and a software driver would take the time for them from the very work that is waited for.
pub(crate) struct Busy {
    size: Option<f32>,
}

impl Busy {
    /// A sign as high as a line.
    pub fn new() -> Self {
        Self { size: None }
    }

    /// Width and height, points.
    pub fn size(size: f32) -> Self {
        Self { size: Some(size) }
    }
}

impl Widget for Busy {
    fn ui(self, ui: &mut Ui) -> Response {
        let size = self.size.unwrap_or(ui.spacing().interact_size.y);
        let (rect, response) = ui.allocate_exact_size(vec2(size, size), Sense::hover());
        response.widget_info(|| WidgetInfo::new(Role::ProgressIndicator));
        if ui.is_rect_visible(rect) {
            let step = (ui.input(|input| input.time) / STEP_S) as usize;
            let bright = ui.visuals().strong_text_color();
            let radius = 0.36 * size;
            for dot in 0..DOTS {
                let angle = dot as f32 / DOTS as f32 * std::f32::consts::TAU;
                let at = rect.center() + radius * vec2(angle.sin(), -angle.cos());
                let age = (step + DOTS - dot) % DOTS;
                let color = bright.gamma_multiply(1.0 - 0.8 * age as f32 / (DOTS - 1) as f32);
                ui.painter()
                    .circle_filled(pos2(at.x, at.y), 0.09 * size, color);
            }
            ui.ctx()
                .request_repaint_after(std::time::Duration::from_secs_f64(STEP_S));
        }
        response
    }
}
