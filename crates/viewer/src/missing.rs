//! Files that the scene names and that are not there: told over the picture, each with a button to find it.

use std::path::{Path, PathBuf};

use egui::{Align2, Area, Context, Frame, Id, Order, Rect, RichText, vec2};
use hairline_document::Description;
use hairline_document::description::{FileUse, GroovePattern};

use crate::workspace::Workspace;

/// Largest number of messages: more would hide the picture; the others follow when these are found.
const MOST: usize = 6;

/// Shows them. `area` is the picture's. The one that is to be found, if its button was pressed.
pub(crate) fn show(ctx: &Context, work: &Workspace, area: Rect) -> Option<(FileUse, PathBuf)> {
    if work.missing.is_empty() {
        return None;
    }
    let shown = Area::new(Id::unique("missing files"))
        .pivot(Align2::CENTER_TOP)
        .fixed_pos(area.center_top() + vec2(0.0, 48.0))
        .order(Order::Middle)
        .constrain_to(area)
        .show(ctx, |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                let mut wanted = None;
                for (of, path) in work.missing.iter().take(MOST) {
                    ui.horizontal(|ui| {
                        let words = words(work.document.description(), *of, path);
                        let text = RichText::new(words).color(crate::style::ERROR);
                        let full = work.document.base_dir().join(path);
                        ui.label(text).on_hover_text(full.display().to_string());
                        if ui.button("Find the file…").clicked() {
                            wanted = Some((*of, path.clone()));
                        }
                    });
                }
                let more = work.missing.len().saturating_sub(MOST);
                if more > 0 {
                    ui.label(format!("{more} more are not there."));
                }
                wanted
            })
        });
    shown.inner.inner
}

/// Message about a missing file.
pub(crate) fn words(description: &Description, of: FileUse, path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    let what = what(description, of, path);
    format!("The {what} {} is not there.", name.to_string_lossy())
}

/// Use of the file in the scene.
fn what(description: &Description, of: FileUse, path: &Path) -> &'static str {
    let is_it = |file: Option<&PathBuf>| file.is_some_and(|file| file == path);
    match of {
        FileUse::Map => "environment map",
        FileUse::Behind => "picture behind",
        FileUse::Mesh(_) => "model",
        FileUse::ScratchList(_) => "list of scratches",
        FileUse::Drawing(_) => "drawing",
        FileUse::ScratchPicture(i) => {
            let layer = description.scratches.get(i);
            match is_it(layer.and_then(|layer| layer.place.mask.as_ref())) {
                true => "mask",
                false => "density map",
            }
        }
        FileUse::GratingPicture(i) => {
            let pattern = description.gratings.get(i).map(|grating| &grating.pattern);
            match pattern {
                Some(GroovePattern::Uv { directions, .. }) if is_it(directions.as_ref()) => {
                    "map of directions"
                }
                _ => "mask",
            }
        }
        FileUse::LightPicture(_) | FileUse::Look(_) => "picture",
    }
}
