//! What is unlike the scene's own picture in the window, told in its corner, each with a way back.

use egui::{Align2, Area, Frame, Id, Order, Rect, Ui, vec2};

use crate::app::Viewer;
use crate::command::Command;
use crate::free_view::ViewCommand;
use crate::reading::{ReadCommand, Shows};

/// Shows them. `area` is the picture's.
pub(crate) fn show(ui: &mut Ui, viewer: &mut Viewer, area: Rect) {
    let shows = viewer.reading.shows;
    let exposure_ev = viewer.reading.exposure_ev;
    let is_free = viewer.free_view.is_free();
    if shows == Shows::Beauty && exposure_ev == 0.0 && !is_free {
        return;
    }
    let ctx = ui.ctx().clone();
    let mut wished = None;
    Area::new(Id::unique("badges"))
        .pivot(Align2::LEFT_TOP)
        .fixed_pos(area.min + vec2(10.0, 10.0))
        .order(Order::Middle)
        .constrain_to(area)
        .show(&ctx, |ui| {
            ui.horizontal(|ui| {
                if shows != Shows::Beauty {
                    badge(ui, |ui| {
                        ui.strong(shows.name()).on_hover_text(shows.hint());
                        let back = Command::Read(ReadCommand::Show(Shows::Beauty));
                        if ui.small_button("Back to the picture").clicked() {
                            wished = Some(back);
                        }
                    });
                }
                if is_free {
                    badge(ui, |ui| {
                        let name = match viewer.free_view.turns() {
                            true => "Turntable",
                            false => "Free view",
                        };
                        ui.strong(name)
                            .on_hover_text("The scene's camera stands where it stood");
                        for (words, command) in [
                            ("Look through camera", ViewCommand::LookThroughCamera),
                            ("Set camera to view", ViewCommand::SetCameraToView),
                        ] {
                            if ui.small_button(words).clicked() {
                                wished = Some(Command::View(command));
                            }
                        }
                    });
                }
                if exposure_ev != 0.0 {
                    badge(ui, |ui| {
                        ui.strong(format!("Exposure {exposure_ev:+} EV"))
                            .on_hover_text(
                                "In this window only: the scene and its exports are as they were",
                            );
                        if ui.small_button("Reset").clicked() {
                            wished = Some(Command::Read(ReadCommand::ResetExposure));
                        }
                    });
                }
            });
        });
    if let Some(command) = wished {
        viewer.run(&ctx, command);
    }
}

fn badge(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    Frame::popup(ui.style())
        .inner_margin(vec2(8.0, 3.0))
        .show(ui, |ui| ui.horizontal(content));
}
