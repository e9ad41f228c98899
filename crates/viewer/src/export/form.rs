//! The question of an export: how large, how fine, how many, and where to.

use std::path::{Path, PathBuf};

use egui::{DragValue, Grid, Id, Modal, Response, RichText, TextEdit, Ui, Widget};

use super::work::{Motion, numbered};

/// Width and height; more is more than a file format or a machine is likely to hold.
const SIDE_PX: std::ops::RangeInclusive<u32> = 1..=16_384;
/// Some 4 GB of layers.
const MOST_PX: u64 = 1 << 26;
const LARGE_PX: [u32; 2] = [3840, 2160];

/// What is being asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Form {
    pub is_turntable: bool,
    pub size_px: [u32; 2],
    pub samples: u32,
    /// From where the window looks; else from the scene's camera.
    pub is_as_seen: bool,
    /// Whether what is no surface is transparent.
    pub is_transparent: bool,
    pub frames: u32,
    pub degrees: f64,
    /// The path, as it is typed.
    pub path: String,
    /// Why it cannot be done so.
    pub refused: Option<String>,
    /// The first file's path when it was last looked for, and whether it was there.
    seen: Option<(PathBuf, bool)>,
}

/// What was pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    Start,
    ChooseFile,
    Close,
}

impl Form {
    pub fn new(is_turntable: bool, size_px: [u32; 2], samples: u32, path: &Path) -> Self {
        Self {
            is_turntable,
            size_px,
            samples,
            is_as_seen: true,
            is_transparent: false,
            frames: 120,
            degrees: 360.0,
            path: path.display().to_string(),
            refused: None,
            seen: None,
        }
    }

    pub fn motion(&self) -> Motion {
        if self.is_turntable {
            Motion::Turntable {
                frames: self.frames,
                degrees: self.degrees,
            }
        } else {
            Motion::Still
        }
    }

    /// The path that is typed; a PNG where no ending is.
    pub fn path(&self) -> PathBuf {
        let path = crate::files::from_home(self.path.trim());
        match path.extension() {
            None if path.file_name().is_some() => path.with_extension("png"),
            _ => path,
        }
    }

    fn is_too_large(&self) -> bool {
        self.size_px.map(u64::from).iter().product::<u64>() > MOST_PX
    }

    fn first_path(&self) -> PathBuf {
        match self.motion() {
            Motion::Still => self.path(),
            Motion::Turntable { .. } => numbered(&self.path(), 1),
        }
    }

    /// Shows it. `window_px` is the size of the picture in the window, `scene_px` that of the scene; `is_view_free` if the
    /// window looks from elsewhere than the scene's camera.
    pub fn show(
        &mut self,
        ctx: &egui::Context,
        window_px: [u32; 2],
        scene_px: [u32; 2],
        is_view_free: bool,
    ) -> Option<Answer> {
        let modal = Modal::new(Id::unique("export")).show(ctx, |ui| {
            ui.set_width(500.0);
            ui.heading(if self.is_turntable {
                "Export a turntable"
            } else {
                "Save a picture"
            });
            ui.add_space(4.0);
            let mut answer = None;
            Grid::new("export").num_columns(2).show(ui, |ui| {
                self.size_rows(ui, window_px, scene_px);
                let samples = DragValue::new(&mut self.samples).range(1..=4096);
                row(ui, "Samples", samples).on_hover_text(
                    "Samples of a pixel that has an edge or a crease in it; elsewhere one is enough. With shadows also the rays to \
                     each light",
                );
                if is_view_free {
                    ui.label("Seen from");
                    ui.horizontal(|ui| {
                        ui.selectable_value(&mut self.is_as_seen, true, "Where the window looks from");
                        ui.selectable_value(&mut self.is_as_seen, false, "The scene's camera");
                    });
                    ui.end_row();
                }
                ui.label("");
                ui.checkbox(&mut self.is_transparent, "Transparent background")
                    .on_hover_text(
                        "PNG and EXR get an alpha channel: the share of each pixel that objects cover. The environment lights \
                         them and is not seen",
                    );
                ui.end_row();
                if self.is_turntable {
                    row(ui, "Pictures", DragValue::new(&mut self.frames).range(1..=9999));
                    let degrees = DragValue::new(&mut self.degrees)
                        .range(-3600.0..=3600.0)
                        .suffix("°");
                    row(ui, "Turn by", degrees).on_hover_text(
                        "In all, about the camera's up through its target. The step after the last picture would \
                         complete it, so that 360° go round without a jump",
                    );
                }
                answer = self.path_row(ui);
            });
            self.remarks(ui);
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let can_start = !self.is_too_large() && !self.path.trim().is_empty();
                let start = egui::Button::new(if self.is_turntable {
                    "Export"
                } else {
                    "Save the picture"
                });
                if ui.add_enabled(can_start, start).clicked() {
                    answer = Some(Answer::Start);
                }
                if ui.button("Cancel").clicked() {
                    answer = Some(Answer::Close);
                }
            });
            answer
        });
        let should_close = modal.should_close();
        modal.inner.or(should_close.then_some(Answer::Close))
    }

    fn size_rows(&mut self, ui: &mut Ui, window_px: [u32; 2], scene_px: [u32; 2]) {
        let [width, height] = &mut self.size_px;
        row(
            ui,
            "Width",
            DragValue::new(width).range(SIDE_PX).suffix(" px"),
        );
        row(
            ui,
            "Height",
            DragValue::new(height).range(SIDE_PX).suffix(" px"),
        );
        ui.label("");
        ui.horizontal(|ui| {
            let sizes = [
                ("Scene", scene_px),
                ("Window", window_px),
                ("Window × 2", window_px.map(|side| 2 * side)),
                ("4K", LARGE_PX),
            ];
            for (name, size_px) in sizes {
                let [width, height] = size_px.map(|side| side.clamp(1, *SIDE_PX.end()));
                let button = ui.button(name).on_hover_text(format!("{width} × {height}"));
                if button.clicked() {
                    self.size_px = [width, height];
                }
            }
        });
        ui.end_row();
    }

    fn path_row(&mut self, ui: &mut Ui) -> Option<Answer> {
        let mut answer = None;
        let label = ui.label("File");
        ui.horizontal(|ui| {
            let edit = TextEdit::singleline(&mut self.path).desired_width(300.0);
            let response = ui.add(edit).labelled_by(label.id);
            if response.changed() {
                self.refused = None;
            }
            if ui.button("Choose file…").clicked() {
                answer = Some(Answer::ChooseFile);
            }
        });
        ui.end_row();
        answer
    }

    /// What will come of it.
    fn remarks(&mut self, ui: &mut Ui) {
        let first = self.first_path();
        let is_there = match &self.seen {
            Some((path, is_there)) if *path == first => *is_there,
            _ => first.exists(),
        };
        let ending = first.extension().unwrap_or_default().to_string_lossy();
        let format = match ending.to_lowercase().as_str() {
            "png" => "PNG: as the window shows it.",
            "exr" => {
                "EXR: linear radiance, with the layers base, scratches, density, depth and normal."
            }
            _ => "End the name in .png or .exr.",
        };
        let names = first.file_name().unwrap_or_default().to_string_lossy();
        let names = match (self.is_turntable, is_there) {
            (true, false) => format!(" The first picture is {names}."),
            (true, true) => format!(" {names} exists: pictures of these names are replaced."),
            (false, true) => format!(" {names} exists and is replaced."),
            (false, false) => String::new(),
        };
        ui.label(RichText::new(format!("{format}{names}")).weak());
        self.seen = Some((first, is_there));
        if self.is_too_large() {
            ui.label(format!("At most {} million pixels.", MOST_PX >> 20));
        }
        if let Some(refused) = &self.refused {
            ui.colored_label(ui.visuals().error_fg_color, refused);
        }
    }
}

fn row(ui: &mut Ui, label: &str, control: impl Widget) -> Response {
    let label = ui.label(label);
    let response = ui.add(control).labelled_by(label.id);
    ui.end_row();
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_without_an_ending_is_a_png() {
        let path = |text: &str| Form::new(false, [4, 4], 8, Path::new(text)).path();
        assert_eq!(path("/tmp/a"), Path::new("/tmp/a.png"));
        assert_eq!(path(" /tmp/a.exr "), Path::new("/tmp/a.exr"));
        assert_eq!(path("/tmp/a.jpg"), Path::new("/tmp/a.jpg"));
        assert_eq!(path("/"), Path::new("/"));
    }

    #[test]
    fn a_picture_that_no_memory_holds_is_refused() {
        let mut form = Form::new(false, [8192, 8192], 8, Path::new("a.png"));
        assert!(!form.is_too_large());
        form.size_px = [16_384, 8192];
        assert!(form.is_too_large());
    }
}
