//! Pictures and turntables to files, in the background: the scene may be edited meanwhile.
//!
//! An export keeps the scene and the camera of the moment it began. Each picture is written whole or not at all; those that
//! are there when it is cancelled stay.

mod form;
mod rehearsal;
mod work;

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use egui::{Align2, Id, ProgressBar, Rect};
use hairline_document::{DEFAULT_SAMPLES, Description};
use hairline_image::{Animation, Output, check_sequence};
use web_time::Instant;

use crate::files::Purpose;
use crate::jobs::Job;
use crate::notices::Notices;
use crate::progressive::SHADOW_SAMPLES;
use crate::viewport::camera;
use crate::workspace::Workspace;
use form::{Answer, ExportContext, Form, words};
use rehearsal::Rehearsal;
use work::{End, Expected, Report, Wish, fitting};

/// Form of an export, and the exports in progress.
#[derive(Default)]
pub(crate) struct Export {
    /// The question that is open.
    form: Option<Form>,
    /// The last one of each kind, a picture's and a turntable's.
    earlier: [Option<Form>; 2],
    /// The beginning of what the question is about.
    rehearsal: Option<Rehearsal>,
    /// Begins as soon as the newest scene is built.
    waiting: Option<Wish>,
    running: Option<Running>,
    /// Exports that were cancelled and have not ended yet, each with the number of pictures that was told.
    ending: Vec<(Running, u32)>,
}

struct Running {
    job: Job,
    wish: Wish,
    report: Report,
    since: Instant,
}

impl Export {
    /// Whether keys are answers and not commands.
    pub fn is_asking(&self) -> bool {
        self.form.is_some()
    }

    /// Stores the form as the start of the next question of its kind.
    fn remember(&mut self, form: Form) {
        let kind = usize::from(form.is_turntable);
        self.earlier[kind] = Some(form);
    }

    pub fn is_busy(&self) -> bool {
        self.running.is_some() || self.waiting.is_some()
    }

    /// Asks how large, how fine and where to.
    pub fn ask(&mut self, work: &mut Workspace, purpose: Purpose) {
        if self.is_busy() {
            work.notices.error(
                "export",
                "One export at a time: the one before is not complete yet.",
            );
            return;
        }
        let is_turntable = purpose == Purpose::Turntable;
        let form = self.earlier[usize::from(is_turntable)]
            .clone()
            .unwrap_or_else(|| {
                let folder = std::path::absolute(work.document.base_dir());
                let folder = folder
                    .or_else(|_| std::env::current_dir())
                    .unwrap_or_default();
                let path = folder.join(purpose.proposal(&work.document));
                let size_px = work.document.description().render.size_px;
                // As many samples as the window adds up.
                let has_lens = has_lens(work.document.description());
                let samples = match work.transport.shadows || has_lens {
                    true => SHADOW_SAMPLES,
                    false => DEFAULT_SAMPLES,
                };
                Form::new(is_turntable, size_px, samples, &path)
            });
        self.form = Some(form);
    }

    /// Takes the path that was chosen in a dialog. One of the system `has_asked` about a file that is there.
    pub fn take_path(
        &mut self,
        work: &mut Workspace,
        purpose: Purpose,
        path: &Path,
        has_asked: bool,
    ) {
        if self.form.is_none() {
            self.ask(work, purpose);
        }
        if let Some(form) = &mut self.form {
            form.set_path(path);
            form.agreed = has_asked.then(|| path.to_owned());
        }
    }

    /// Begins an export that has waited for its scene, reports those that have ended, and shows the progress. `area` is the
    /// picture's.
    pub fn show(&mut self, ctx: &egui::Context, work: &mut Workspace, area: Rect) {
        self.start(ctx, work);
        self.end(&mut work.notices);
        if self.show_progress(ctx, area) {
            self.cancel(&mut work.notices);
        }
        self.ending.retain(|(running, told)| {
            // A picture may have been on its way to its file.
            if running.job.is_over() && running.report.state().written != *told {
                running.tell_cancelled(&mut work.notices);
            }
            !running.job.is_over()
        });
        // The export gets the cores.
        let is_rehearsing = self.rehearsal.as_ref().is_some_and(|it| !it.is_over());
        work.renderer
            .set_resting(self.running.is_some() || is_rehearsing);
    }

    /// Ends the export at once, as far as the window is concerned: its thread stops after the pixels that it is at.
    fn cancel(&mut self, notices: &mut Notices) {
        self.waiting = None;
        if let Some(running) = self.running.take() {
            running.job.stop();
            let told = running.tell_cancelled(notices);
            self.ending.push((running, told));
        }
    }

    /// The question, if it is open. What a file is wanted for, if one is to be chosen.
    pub fn show_form(&mut self, ctx: &egui::Context, work: &mut Workspace) -> Option<Purpose> {
        let mut form = self.form.take()?;
        let description = work.document.description();
        let scene_px = description.render.size_px;
        let window_px = work
            .renderer
            .latest()
            .map_or(scene_px, |frame| fitting(scene_px, frame.view.size_px));
        let scene = ExportContext {
            scene_px,
            window_px,
            has_lens: has_lens(description),
            is_view_free: work.free_view.is_free(),
            is_snapshot: work.snapshots.cover(),
            cuts_out: description.cuts_out(),
            is_deep: description.render.png_bits == 16,
            has_backdrop: description.render.behind.is_some(),
            expected: self.expected(ctx, work, &form),
        };
        let answer = form.show(ctx, &scene);
        if matches!(answer, Some(Answer::Close | Answer::Start))
            && let Some(rehearsal) = self.rehearsal.take()
        {
            rehearsal.leave();
        }
        match answer {
            None => self.form = Some(form),
            Some(Answer::ChooseFile) => {
                let purpose = match form.is_turntable {
                    true => Purpose::Turntable,
                    false => Purpose::Screenshot,
                };
                self.form = Some(form);
                return Some(purpose);
            }
            Some(Answer::Close) => self.remember(form),
            Some(Answer::Start) => self.begin(work, form),
        }
        None
    }

    /// What is known of the pictures; finds it out where nothing is.
    fn expected(&mut self, ctx: &egui::Context, work: &Workspace, form: &Form) -> Expected {
        let wish = Self::wish(work, form);
        let rehearsal = self.rehearsal.as_ref();
        if let Some(rehearsal) = rehearsal.filter(|it| it.is_of(&wish)) {
            return rehearsal.expected();
        }
        let is_over = rehearsal.is_none_or(Rehearsal::is_over);
        if let Some(rehearsal) = rehearsal {
            rehearsal.stop();
            // The thread is at some pixels still.
            ctx.request_repaint_after(Duration::from_millis(100));
        }
        if is_over
            && !work.renderer.is_building()
            && let Some(built) = work.renderer.built()
        {
            self.rehearsal = Rehearsal::start(ctx, wish, built).ok();
        }
        Expected::default()
    }

    /// What the form asks for.
    fn wish(work: &Workspace, form: &Form) -> Wish {
        let mut description = Arc::clone(work.document.description());
        if form.is_as_seen {
            let camera = work.camera();
            if camera != description.camera {
                Arc::make_mut(&mut description).camera = camera;
            }
        }
        Wish {
            is_transparent: form.is_transparent || description.cuts_out(),
            description,
            base_dir: work.document.base_dir().to_owned(),
            size_px: form.size_px,
            samples: form.samples,
            transport: work.wanted_transport(),
            motion: form.motion(),
            fps: form.fps,
            path: form.path(),
            backend: work.renderer.backend(),
        }
    }

    /// Begins an export; refuses at once files that could not be written in the end.
    fn begin(&mut self, work: &mut Workspace, mut form: Form) {
        let wish = Self::wish(work, &form);
        let checked = match wish.is_animation() {
            true => Animation::check(wish.base_dir.with_path(&wish.path)),
            false => {
                let ending = match form.is_turntable {
                    true => check_sequence(&wish.path),
                    false => Ok(()),
                };
                ending.and_then(|()| {
                    Output::check(wish.base_dir.with_path(wish.frame_path(0))).map(drop)
                })
            }
        };
        match checked {
            Err(error) => {
                let message = error.to_string();
                work.notices.error("export", message.clone());
                form.refused = Some(message);
                self.form = Some(form);
            }
            Ok(()) => {
                work.notices.clear("export");
                // The next picture of this name would replace this one.
                (form.refused, form.agreed) = (None, None);
                self.remember(form);
                self.waiting = Some(wish);
            }
        }
    }

    fn start(&mut self, ctx: &egui::Context, work: &mut Workspace) {
        if self.running.is_some() || work.renderer.is_building() {
            return;
        }
        let (Some(built), Some(wish)) = (work.renderer.built(), self.waiting.take()) else {
            return;
        };
        let wake = ctx.clone();
        let report = Report::new(Arc::new(move || wake.request_repaint()));
        let (wished, told) = (wish.clone(), report.clone());
        #[cfg(not(target_arch = "wasm32"))]
        let job = Job::start("export", move |stop| {
            let running = work::run(&wished, &built, stop, &told);
            hairline_render::block_on(wished.backend.gpu(), running);
        });
        #[cfg(target_arch = "wasm32")]
        let job = Job::in_page(async move |stop| work::run(&wished, &built, &stop, &told).await);
        match job {
            Err(error) => work.notices.error("export", error.to_string()),
            Ok(job) => {
                self.running = Some(Running {
                    job,
                    wish,
                    report,
                    since: Instant::now(),
                });
            }
        }
    }

    fn end(&mut self, notices: &mut Notices) {
        let Some(running) = self.running.take_if(|running| running.job.is_over()) else {
            return;
        };
        let state = running.report.state();
        let wish = &running.wish;
        let written = state.written;
        let name = |frame: u32| wish.frame_path(frame).display().to_string();
        let kept = wish.kept(written);
        match state.end {
            Some(End::Complete) if written <= 1 || wish.is_animation() => {
                notices.note("export", format!("Saved {}", name(0)));
            }
            Some(End::Complete) => notices.note(
                "export",
                format!(
                    "Saved {written} pictures, {} to {}",
                    name(0),
                    name(written - 1)
                ),
            ),
            Some(End::Cancelled) => {
                notices.note("export", format!("The export was cancelled. {kept}"))
            }
            Some(End::Failed(message)) => {
                notices.error("export", format!("{message}. {kept}"));
            }
            None => notices.error("export", format!("The export failed. {kept}")),
        }
    }

    /// Shows how far the export is; whether it is to be cancelled.
    fn show_progress(&self, ctx: &egui::Context, area: Rect) -> bool {
        if !self.is_busy() {
            return false;
        }
        let corner = area.right_bottom() - egui::vec2(12.0, 12.0);
        let cancel = egui::Area::new(Id::unique("export progress"))
            .pivot(Align2::RIGHT_BOTTOM)
            .fixed_pos(corner)
            .order(egui::Order::Foreground)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style())
                    .show(ui, |ui| {
                        ui.set_width(260.0);
                        match &self.running {
                            None => drop(ui.label("Waiting for the scene")),
                            Some(running) => running.show(ui),
                        }
                        ui.button("Cancel the export").clicked()
                    })
                    .inner
            });
        // The time that is left goes on between two bands too.
        ctx.request_repaint_after(Duration::from_millis(500));
        cancel.inner
    }
}

impl Running {
    /// Tells that it was cancelled, and how many pictures there are; returns that number.
    fn tell_cancelled(&self, notices: &mut Notices) -> u32 {
        let written = self.report.state().written;
        let kept = self.wish.kept(written);
        notices.note("export", format!("The export was cancelled. {kept}"));
        written
    }

    fn show(&self, ui: &mut egui::Ui) {
        let state = self.report.state();
        let frames = self.wish.frames();
        let done = (f64::from(state.written) + state.share) / f64::from(frames.max(1));
        let what = if frames == 1 {
            "Saving a picture".to_owned()
        } else {
            format!("Picture {} of {frames}", (state.written + 1).min(frames))
        };
        ui.label(what);
        let text = match time_left(self.since.elapsed(), done) {
            None => percent(done),
            Some(left) => format!("{}, {left} left", percent(done)),
        };
        ui.add(ProgressBar::new(done as f32).text(text));
        if frames > 1 && !self.wish.is_animation() {
            ui.weak("Cancelling keeps the pictures that are complete.");
        }
    }
}

/// Whether the scene's camera has depth of field.
fn has_lens(description: &Description) -> bool {
    camera(&description.camera).has_lens()
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// Time that is left, in words; none before anything can be said.
fn time_left(elapsed: Duration, done: f64) -> Option<String> {
    if done < 0.01 || elapsed < Duration::from_secs(1) {
        return None;
    }
    Some(words(elapsed.mul_f64((1.0 - done) / done)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_that_is_left_is_told_in_units_that_fit() {
        let left = |seconds, done| time_left(Duration::from_secs(seconds), done);
        assert_eq!(left(10, 0.001), None);
        assert_eq!(left(10, 0.5).as_deref(), Some("10 s"));
        assert_eq!(left(100, 0.1).as_deref(), Some("15 min"));
        assert_eq!(left(3600, 0.1).as_deref(), Some("9.0 h"));
    }

    #[test]
    fn the_windows_picture_has_the_scenes_shape() {
        assert_eq!(fitting([1600, 900], [800, 800]), [800, 450]);
        assert_eq!(fitting([900, 1600], [800, 800]), [450, 800]);
    }
}
