//! Badges in the window's corner for each way in which it differs from the scene's own picture,
//! each with a way back.

use egui::{Align2, Area, Frame, Id, Order, Rect, Ui, vec2};

use crate::command::Command;
use crate::free_view::ViewCommand;
use crate::reading::{ReadCommand, Shows};
use crate::workspace::Workspace;

/// Shows them. `area` is the picture's.
pub(crate) fn show(ui: &mut Ui, work: &mut Workspace, area: Rect) {
    let shows = work.reading.shows;
    let exposure_ev = work.reading.exposure_ev;
    let is_free = work.free_view.is_free();
    if shows == Shows::Beauty && exposure_ev == 0.0 && !is_free {
        return;
    }
    Area::new(Id::unique("badges"))
        .pivot(Align2::LEFT_TOP)
        .fixed_pos(area.min + vec2(10.0, 10.0))
        .order(Order::Middle)
        .constrain_to(area)
        .show(&ui.ctx().clone(), |ui| {
            ui.horizontal(|ui| {
                if shows != Shows::Beauty {
                    badge(ui, |ui| {
                        ui.strong(shows.name()).on_hover_text(shows.hint());
                        let back = Command::Read(ReadCommand::Show(Shows::Beauty));
                        if ui.small_button("Back to the picture").clicked() {
                            work.requested.push(back);
                        }
                    });
                }
                if is_free {
                    badge(ui, |ui| {
                        let name = match work.free_view.turns {
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
                                work.requested.push(Command::View(command));
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
                            work.requested
                                .push(Command::Read(ReadCommand::ResetExposure));
                        }
                    });
                }
            });
        });
}

fn badge(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    Frame::popup(ui.style())
        .inner_margin(vec2(8.0, 3.0))
        .show(ui, |ui| ui.horizontal(content));
}
