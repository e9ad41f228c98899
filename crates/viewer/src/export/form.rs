//! The question of an export: how large, how fine, how many, and where to.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{Checkbox, DragValue, Grid, Id, Modal, Response, RichText, TextEdit, Ui, Widget};
use hairline_document::navigate::Turns;
use hairline_image::{Animation, BATCH_SAMPLES, Batches, FPS, FPS_MAX};
use hairline_render::Motion;

use super::work::{Expected, frame_path, is_animation};
use crate::progressive::SHADOW_SAMPLES;

/// Width and height; more is more than a file format or a machine is likely to hold.
const SIDE_PX: std::ops::RangeInclusive<u32> = 1..=16_384;
/// Some 4 GB of layers.
const MOST_PX: u64 = 1 << 26;
const LARGE_PX: [u32; 2] = [3840, 2160];

/// Settings of an export.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Form {
    pub is_turntable: bool,
    pub size_px: [u32; 2],
    pub samples: u32,
    /// Whether the camera is that of the window; else it is the scene's.
    pub is_as_seen: bool,
    /// Whether the background is transparent.
    pub is_transparent: bool,
    pub frames: u32,
    pub degrees: f64,
    /// Pictures of an animation in a second.
    pub fps: u16,
    /// What a turntable turns.
    pub turns: Turns,
    /// Path as typed.
    pub path: String,
    /// Reason why it cannot be done so.
    pub refused: Option<String>,
    /// Path whose file may be replaced, since a dialog of the system has asked about it.
    pub agreed: Option<PathBuf>,
    /// Whether files that are there may be replaced; none while that is not asked.
    question: Option<String>,
}

/// Properties of the scene and the window that the form depends on.
pub(super) struct ExportContext {
    /// Size of the scene's picture.
    pub scene_px: [u32; 2],
    /// Size of the picture in the window.
    pub window_px: [u32; 2],
    /// Whether there is depth of field.
    pub has_lens: bool,
    /// Whether the window looks from elsewhere than the scene's camera.
    pub is_view_free: bool,
    /// Whether the window shows a snapshot in the place of the scene.
    pub is_snapshot: bool,
    /// Whether the scene says that its pictures have an alpha.
    pub cuts_out: bool,
    /// Whether the scene's PNGs have 16 bits a channel.
    pub is_deep: bool,
    /// Whether the scene has a picture behind the objects.
    pub has_backdrop: bool,
    /// What is known of the pictures beforehand.
    pub expected: Expected,
}

/// Button that was pressed.
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
            fps: FPS,
            turns: Turns::Object,
            path: path.display().to_string(),
            refused: None,
            agreed: None,
            question: None,
        }
    }

    /// The turntable; none: one picture.
    pub fn motion(&self) -> Option<Motion> {
        self.is_turntable.then_some(Motion {
            frames: self.frames,
            turn_deg: self.degrees,
            turns: self.turns,
            zoom: [1.0, 1.0],
            times_s: None,
        })
    }

    /// The path that is typed; a PNG where no ending is.
    pub fn path(&self) -> PathBuf {
        let path = crate::files::from_home(self.path.trim());
        match path.extension() {
            None if path.file_name().is_some() => path.with_extension("png"),
            _ => path,
        }
    }

    /// Replaces the typed path by another one.
    pub fn set_path(&mut self, path: &Path) {
        self.path = path.display().to_string();
        self.take_path();
    }

    /// Takes what was typed. A video whose program is not there is refused at once.
    fn take_path(&mut self) {
        let path = self.path();
        let is_video = (path.extension()).is_some_and(|it| it.eq_ignore_ascii_case("mp4"));
        let checked = (self.is_turntable && is_video).then(|| Animation::check(&path));
        self.refused = checked.and_then(Result::err).map(|error| error.to_string());
        self.question = None;
    }

    fn is_too_large(&self) -> bool {
        self.size_px.map(u64::from).iter().product::<u64>() > MOST_PX
    }

    /// Shows the form; returns the button that was pressed, if any.
    pub fn show(&mut self, ctx: &egui::Context, scene: &ExportContext) -> Option<Answer> {
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
                self.rows(ui, scene);
                answer = self.path_row(ui);
            });
            self.remarks(ui, scene);
            self.expectations(ui, scene.expected);
            if scene.is_snapshot {
                ui.colored_label(
                    ui.visuals().error_fg_color,
                    "The window shows a snapshot; the file will show the scene as it is now. \
                     \"Restore\" below its picture brings its look back.",
                );
            }
            ui.add_space(8.0);
            answer.or(match self.question.clone() {
                Some(question) => self.replace_buttons(ui, &question),
                None => self.buttons(ui),
            })
        });
        match modal.should_close() {
            // Escape answers the question first.
            true if self.question.take().is_some() => modal.inner,
            should_close => modal.inner.or(should_close.then_some(Answer::Close)),
        }
    }

    fn rows(&mut self, ui: &mut Ui, scene: &ExportContext) {
        self.size_rows(ui, scene.window_px, scene.scene_px);
        let samples = DragValue::new(&mut self.samples).range(1..=4096);
        row(ui, "Samples", samples).on_hover_text(
            "Samples of a pixel that has an edge or a crease in it; elsewhere one is enough. With shadows also the rays to \
             each light",
        );
        if scene.has_lens {
            ui.label("");
            ui.label(RichText::new(self.lens_remark()).weak());
            ui.end_row();
        }
        if scene.is_view_free {
            ui.label("Seen from");
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.is_as_seen, true, "Where the window looks from");
                ui.selectable_value(&mut self.is_as_seen, false, "The scene's camera");
            });
            ui.end_row();
        }
        ui.label("");
        let mut is_transparent = self.is_transparent || scene.cuts_out;
        let transparent = Checkbox::new(&mut is_transparent, "Transparent background");
        let transparent = ui.add_enabled(!scene.cuts_out, transparent);
        if transparent.changed() {
            self.is_transparent = is_transparent;
        }
        transparent.on_hover_text(
            "PNG and EXR get an alpha channel: the share of each pixel that objects cover. The environment lights \
             them and is not seen",
        );
        ui.end_row();
        if self.is_turntable {
            self.turntable_rows(ui);
        }
    }

    fn turntable_rows(&mut self, ui: &mut Ui) {
        ui.label("Turns");
        ui.horizontal(|ui| {
            ui.selectable_value(&mut self.turns, Turns::Object, "The objects")
                .on_hover_text("Before the camera and under the lights, which stand still");
            ui.selectable_value(&mut self.turns, Turns::Camera, "The camera")
                .on_hover_text(
                    "Around the objects and under the lights: what a floor mirrors swings by",
                );
            ui.selectable_value(&mut self.turns, Turns::Lights, "The lights")
                .on_hover_text(
                    "Lights, studio and environment, about objects and camera that stand still",
                );
        });
        ui.end_row();
        let frames = DragValue::new(&mut self.frames).range(1..=9999);
        if row(ui, "Pictures", frames).changed() {
            self.question = None;
        }
        let degrees = DragValue::new(&mut self.degrees)
            .range(-3600.0..=3600.0)
            .suffix("°");
        row(ui, "Turn by", degrees).on_hover_text(
            "In all, about the camera's up through its target. The step after the last picture would \
             complete it, so that 360° go round without a jump",
        );
        if is_animation(&self.path(), self.motion()) {
            let fps = DragValue::new(&mut self.fps).range(1..=FPS_MAX);
            row(ui, "Pictures in a second", fps);
        }
    }

    fn buttons(&mut self, ui: &mut Ui) -> Option<Answer> {
        let can_start = !self.is_too_large() && !self.path.trim().is_empty();
        let start = egui::Button::new(if self.is_turntable {
            "Export"
        } else {
            "Save the picture"
        });
        ui.horizontal(|ui| {
            let is_started = ui.add_enabled(can_start, start).clicked();
            if is_started {
                self.question = self.question_before();
            }
            if ui.button("Cancel").clicked() {
                return Some(Answer::Close);
            }
            (is_started && self.question.is_none()).then_some(Answer::Start)
        })
        .inner
    }

    /// Question before files are replaced; none where none is there, or only the one that a dialog has asked about.
    fn question_before(&self) -> Option<String> {
        let (path, motion) = (self.path(), self.motion());
        let frames = match motion {
            Some(Motion { frames, .. }) if !is_animation(&path, motion) => frames,
            _ => 1,
        };
        let paths = (0..frames).map(|frame| frame_path(&path, motion, frame));
        let there: Vec<PathBuf> = paths
            .filter(|path| self.agreed.as_ref() != Some(path) && path.is_file())
            .collect();
        let first = there.first()?.display();
        Some(match (frames > 1, there.len()) {
            (false, _) => format!("\"{first}\" is there already. Its contents would be lost."),
            (true, 1) => format!(
                "\"{first}\" is there already, one of {frames} pictures. Its contents would be lost."
            ),
            (true, n) => format!(
                "{n} of {frames} pictures are there already, \"{first}\" first. Their contents would be lost."
            ),
        })
    }

    fn replace_buttons(&mut self, ui: &mut Ui, question: &str) -> Option<Answer> {
        ui.colored_label(ui.visuals().warn_fg_color, question);
        let answer = ui.horizontal(|ui| {
            // This button lies where the one that opened the question was: a double click there replaces nothing.
            if ui.button("Choose another name").clicked() {
                return Some(None);
            }
            let replace = match self.is_turntable {
                true => "Replace the pictures",
                false => "Replace the file",
            };
            ui.button(replace).clicked().then_some(Some(Answer::Start))
        });
        let answer = answer.inner?;
        self.question = None;
        answer
    }

    /// Remark on the samples with depth of field.
    fn lens_remark(&self) -> String {
        let samples = Batches::new(self.samples).samples();
        let points = samples.div_ceil(BATCH_SAMPLES);
        let s = if points == 1 { "" } else { "s" };
        let grain = match samples < SHADOW_SAMPLES {
            true => format!("; {SHADOW_SAMPLES} make blur smooth"),
            false => String::new(),
        };
        format!(
            "Depth of field: {samples} samples look through {points} point{s} of the lens{grain}."
        )
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
                self.take_path();
            }
            if ui.button("Choose file…").clicked() {
                answer = Some(Answer::ChooseFile);
            }
        });
        ui.end_row();
        answer
    }

    /// Remarks on the result.
    fn remarks(&mut self, ui: &mut Ui, scene: &ExportContext) {
        let first = frame_path(&self.path(), self.motion(), 0);
        let ending = first.extension().unwrap_or_default().to_string_lossy();
        let format = match ending.to_lowercase().as_str() {
            "png" => match (scene.is_deep, scene.has_backdrop) {
                (false, false) => "PNG: with the look of the window.",
                (true, false) => "PNG: with the look of the window, 16 bits a channel.",
                (false, true) => "PNG: with the look of the window, and the picture behind.",
                (true, true) => {
                    "PNG: with the look of the window and the picture behind, 16 bits a channel."
                }
            },
            "apng" if self.is_turntable => {
                "APNG: one file that browsers play, as the window shows it, 8 bits a channel."
            }
            "mp4" if self.is_turntable => {
                "MP4: one file that players play, made by the program ffmpeg."
            }
            "exr" => {
                "EXR: linear radiance, with the layers base, scratches, density, depth and normal."
            }
            _ if self.is_turntable => {
                "End the name in .png or .exr, or in .apng or .mp4 for one file that plays."
            }
            _ => "End the name in .png or .exr.",
        };
        let names = match self.is_turntable && !is_animation(&self.path(), self.motion()) {
            true => {
                let name = first.file_name().unwrap_or_default();
                format!(" The first picture is {}.", name.to_string_lossy())
            }
            false => String::new(),
        };
        ui.label(RichText::new(format!("{format}{names}")).weak());
        if self.is_too_large() {
            ui.label(format!("At most {} million pixels.", MOST_PX >> 20));
        }
        if let Some(refused) = &self.refused {
            ui.colored_label(ui.visuals().error_fg_color, refused);
        }
    }
}

impl Form {
    /// Remarks on what is known beforehand.
    fn expectations(&self, ui: &mut Ui, expected: Expected) {
        ui.label(match (expected.picture, self.is_turntable) {
            (None, _) => "Finding out how long it takes".to_owned(),
            (Some(picture), false) => format!("It takes about {}.", words(picture)),
            (Some(picture), true) => format!(
                "It takes about {}: {} for each picture.",
                words(self.frames * picture),
                words(picture)
            ),
        });
        if expected.is_filled && self.is_transparent {
            ui.colored_label(
                ui.visuals().warn_fg_color,
                "No pixel will be transparent: objects fill the picture. Hide what stands behind the others in the list, such as a table or \
                 the ground plane.",
            );
        }
    }
}

fn row(ui: &mut Ui, label: &str, control: impl Widget) -> Response {
    let label = ui.label(label);
    let response = ui.add(control).labelled_by(label.id);
    ui.end_row();
    response
}

/// A time in units that fit.
pub(super) fn words(time: Duration) -> String {
    match time.as_secs_f64() {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
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
    fn a_video_is_refused_as_soon_as_it_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nowhere/a.mp4");
        let mut form = Form::new(true, [4, 4], 8, Path::new("a.png"));
        form.set_path(&path);
        let refused = Animation::check(&path).unwrap_err().to_string();
        assert_eq!(form.refused, Some(refused));
    }

    #[test]
    fn a_picture_that_no_memory_holds_is_refused() {
        let mut form = Form::new(false, [8192, 8192], 8, Path::new("a.png"));
        assert!(!form.is_too_large());
        form.size_px = [16_384, 8192];
        assert!(form.is_too_large());
    }
}
