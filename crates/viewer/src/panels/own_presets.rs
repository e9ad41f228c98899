//! The user's own presets in menus, below ours.

use egui::Ui;
use hairline_document::Description;

use crate::workspace::Workspace;

/// Shows the presets that have what is wanted; the index of the one that was clicked. Each can be deleted.
pub(super) fn show(
    ui: &mut Ui,
    work: &mut Workspace,
    has: impl Fn(&Description) -> bool,
) -> Option<usize> {
    let list = work.own_presets.list().iter().enumerate();
    let named: Vec<(usize, String)> = list
        .filter(|(_, preset)| has(&preset.parts))
        .map(|(i, preset)| (i, preset.name.clone()))
        .collect();
    if named.is_empty() {
        return None;
    }
    ui.separator();
    ui.weak("Yours");
    let mut chosen = None;
    for (i, name) in named {
        ui.horizontal(|ui| {
            if ui.button(&name).clicked() {
                chosen = Some(i);
                ui.close();
            }
            let delete = ui.menu_button("×", |ui| {
                if ui.button(format!("Delete {name} for good")).clicked() {
                    work.delete_preset(&name);
                }
            });
            ui.ctx().accesskit_node_builder(delete.response.id, |node| {
                node.set_label(format!("Delete {name}"));
            });
        });
    }
    chosen
}
