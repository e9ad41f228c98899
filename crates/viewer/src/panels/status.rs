//! The line at the bottom: the state of the picture, its speed, and the renderer.

use std::time::Duration;

use egui::{DragValue, Panel, RichText, Ui};
use hairline_scene::Transport;

use super::busy::Busy;
use crate::command::Command;
use crate::progressive::{Frame, Latency, ProgressiveRenderer};
use crate::viewport::Viewport;
use crate::workspace::Workspace;

/// Share of the line that the name of what renders may have.
const LONGEST_BACKEND: f32 = 0.3;

pub(crate) fn show(ui: &mut Ui, work: &mut Workspace, viewport: &Viewport) {
    Panel::bottom("status").exact_size(26.0).show(ui, |ui| {
        let right_to_left = egui::Layout::right_to_left(egui::Align::Center);
        ui.with_layout(right_to_left, |ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            let time = viewport.interface_time;
            ui.label(RichText::new(format!("interface {}", milliseconds(time))).weak())
                .on_hover_text("The longest pass of the interface itself of late");
            let backend = work.renderer.backend();
            let most = LONGEST_BACKEND * ui.available_width();
            ui.scope(|ui| {
                ui.set_max_width(most);
                ui.add(egui::Label::new(backend.label()).truncate())
                    .on_hover_text("What renders the picture");
            });
            transport(ui, work);
            pause(ui, work);
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                progress(ui, &work.renderer, viewport);
            });
        });
    });
}

/// One line, whose end is left out where it has no room; all of it and more in the tooltip.
fn progress(ui: &mut Ui, renderer: &ProgressiveRenderer, viewport: &Viewport) {
    let mut parts = Vec::new();
    let mut details = String::new();
    match renderer.latest() {
        Some(frame) => {
            let is_stale = viewport.canvas.is_stale();
            parts.extend(picture(&frame, is_stale, renderer));
            details += &times(&frame);
        }
        None => parts.push(before_the_first(renderer).to_owned()),
    }
    if renderer.is_building() {
        ui.add(Busy::new());
        parts.push("laying scratches".to_owned());
    }
    if let Some(built) = renderer.built() {
        let (scratches, segments) = built.scratch_counts();
        parts.push(format!("{} scratches", grouped(scratches)));
        details += &format!("\n{} straight pieces of scratches", grouped(segments));
    }
    let text = parts.join(GAP);
    let label = egui::Label::new(&text).truncate();
    ui.add(label.show_tooltip_when_elided(false))
        .on_hover_text(format!("{text}\n{}", details.trim_start()));
}

/// Between parts of the line.
const GAP: &str = "    ";

/// What the picture is and how long it takes to be clean, in few words.
pub(super) fn summary(renderer: &ProgressiveRenderer, viewport: &Viewport) -> String {
    if renderer.is_building() {
        return "laying scratches".to_owned();
    }
    let Some(frame) = renderer.latest() else {
        return before_the_first(renderer).to_owned();
    };
    let is_stale = viewport.canvas.is_stale();
    let what = activity(&frame, is_stale);
    match frame.painted.left.filter(|_| !is_stale) {
        _ if renderer.is_paused() && !frame.painted.is_final => "paused".to_owned(),
        Some(_) if renderer.is_resting() => "paused while an export runs".to_owned(),
        Some(left) => format!("{} left: {what}", rough(left)),
        None => what,
    }
}

/// Text about the current work while there is no picture yet.
pub(crate) fn before_the_first(renderer: &ProgressiveRenderer) -> &'static str {
    match renderer.built() {
        Some(_) => "rendering the first picture",
        None if renderer.has_failed() => "the scene could not be built",
        None => "building the scene",
    }
}

/// Size, time and state of the picture.
fn picture(frame: &Frame, is_stale: bool, renderer: &ProgressiveRenderer) -> Vec<String> {
    let painted = &frame.painted;
    let [width, height] = painted.size_px;
    let part = renderer.region().filter(|part| part.number > frame.number);
    let (what, left) = match &part {
        Some(part) => (
            format!("region: {}", activity(part, false)),
            part.painted.left,
        ),
        None => (activity(frame, is_stale), painted.left),
    };
    let mut parts = vec![format!(
        "{width} × {height}, {}",
        milliseconds(painted.time)
    )];
    parts.extend(match renderer.is_paused() && !painted.is_final {
        true => vec!["paused".to_owned()],
        false => with_time_left(what, left.filter(|_| !is_stale), renderer.is_resting()),
    });
    if !painted.passes.is_empty() {
        let device: Duration = painted.passes.iter().map(|pass| pass.time).sum();
        parts.push(format!("device {}", milliseconds(device)));
    }
    parts
}

/// What is done, and the time that it takes.
fn with_time_left(what: String, left: Option<Duration>, is_resting: bool) -> Vec<String> {
    let time = match left {
        Some(_) if is_resting => "paused while an export runs".to_owned(),
        Some(left) => format!("{} left", rough(left)),
        None if what.ends_with('%') => "time left: estimating…".to_owned(),
        None => return vec![what],
    };
    vec![what, time]
}

/// What the picture and the last edit took.
fn times(frame: &Frame) -> String {
    let painted = &frame.painted;
    let passes = painted.passes.iter();
    let lines = passes.map(|pass| format!("\n{}: {}", pass.name, milliseconds(pass.time)));
    let mut times: String = lines.collect();
    if let Some(latency) = &painted.latency {
        times += &latency_text(latency);
    }
    times
}

/// Text about the current work on the picture.
fn activity(frame: &Frame, is_stale: bool) -> String {
    let painted = &frame.painted;
    let wanted = frame.view.transport;
    match (painted.is_final, painted.samples) {
        _ if is_stale => "rendering the new view".to_owned(),
        _ if painted.transport != wanted => {
            let left_out = transport_words(wanted);
            match painted.thin == 1 && painted.size_px == frame.view.size_px {
                true if painted.done < 1.0 => {
                    format!("{left_out} follow, {:.0} %", 100.0 * painted.done)
                }
                true => format!("{left_out} follow"),
                false => format!("its own {left_out} follow when it stands still"),
            }
        }
        (true, _) => "finished".to_owned(),
        _ if frame.built.is_sketch() => "a sketch of the scratches".to_owned(),
        (false, samples) if let Some(all) = painted.of_samples => match painted.done < 1.0 {
            true => format!(
                "sample {samples} of {all}, {:.0} % of the next ones",
                100.0 * painted.done
            ),
            false => format!("sample {samples} of {all}"),
        },
        _ if painted.done < 1.0 && wanted.shadows => {
            format!(
                "adding {}, {:.0} %",
                transport_words(wanted),
                100.0 * painted.done
            )
        }
        _ if painted.done < 1.0 => format!("finishing, {:.0} %", 100.0 * painted.done),
        (false, 1) if painted.thin > 1 => format!("refining, one scratch of {}", painted.thin),
        (false, 1) if painted.size_px == frame.view.size_px => "smoothing edges".to_owned(),
        (false, 1) => "refining".to_owned(),
        (false, samples) => format!("refining, {samples} samples"),
    }
}

/// A button that pauses what comes after the first picture, or goes on with it.
fn pause(ui: &mut Ui, work: &mut Workspace) {
    let is_paused = work.renderer.is_paused();
    let word = if is_paused { "Go on" } else { "Pause" };
    let button = ui.button(word).on_hover_text(
        "Whether pictures become finer while nothing moves. A new view or a change is shown once, coarsely, all the same (Shift+P)",
    );
    if button.clicked() {
        work.requested.push(Command::Pause);
    }
}

/// Name of the light besides the closed form.
fn transport_words(wanted: Transport) -> &'static str {
    match wanted.bounces {
        0 => "shadows",
        _ => "shadows and bounces",
    }
}

/// Range of bounces in the window.
const BOUNCES: std::ops::RangeInclusive<u32> = 0..=8;

/// Shadows and bounces, to be switched.
fn transport(ui: &mut Ui, work: &mut Workspace) {
    let Transport { shadows, bounces } = work.transport;
    let text = match (shadows, bounces) {
        (false, _) => "no shadows".to_owned(),
        (true, 0) => "shadows".to_owned(),
        (true, 1) => "shadows, 1 bounce".to_owned(),
        (true, bounces) => format!("shadows, {bounces} bounces"),
    };
    let menu = ui.menu_button(text, |ui| {
        let mut is_on = shadows;
        if ui
            .checkbox(&mut is_on, Command::Shadows.label())
            .on_hover_text("Objects hide lights and the environment from one another")
            .changed()
        {
            work.requested.push(Command::Shadows);
        }
        ui.add_enabled_ui(shadows, |ui| {
            ui.horizontal(|ui| {
                let label = ui.label("Bounces");
                let number = DragValue::new(&mut work.transport.bounces).range(BOUNCES);
                ui.add(number)
                    .labelled_by(label.id)
                    .on_hover_text("How many other objects light may go by on its way");
            });
        });
    });
    menu.response
        .on_hover_text("Of this window. While something moves, slow machines leave them out");
}

/// The way of the last edit to the picture.
fn latency_text(latency: &Latency) -> String {
    let build = &latency.build;
    let stages = [
        ("waited", build.waited),
        ("scratches laid", build.scene),
        ("trees", build.index),
        ("tables", build.tables),
        ("upload", latency.upload),
        ("first picture", latency.paint),
        ("in all", latency.total),
    ];
    let lines = stages.map(|(name, time)| format!("\n  {name}: {}", milliseconds(time)));
    format!("\nThe last edit:{}", lines.concat())
}

/// A time that is expected: seconds, or minutes.
fn rough(time: Duration) -> String {
    let seconds = time.as_secs_f64().ceil();
    match seconds < 100.0 {
        true => format!("{seconds:.0} s"),
        false => format!("{:.0} min", (seconds / 60.0).ceil()),
    }
}

fn milliseconds(time: Duration) -> String {
    let ms = 1e3 * time.as_secs_f64();
    if ms < 10.0 {
        format!("{ms:.1} ms")
    } else {
        format!("{ms:.0} ms")
    }
}

/// Formats a number with a thin space between thousands.
fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push('\u{202f}');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Duration, grouped, with_time_left};

    #[test]
    fn work_with_a_share_says_something_of_its_time() {
        let told = |what: &str, left| with_time_left(what.to_owned(), left, false).concat();
        assert_eq!(told("finished", None), "finished");
        let share = "finishing, 31 %";
        assert!(told(share, None).contains("estimating"));
        let left = Some(Duration::from_secs(7));
        assert!(told(share, left).ends_with("7 s left"));
    }

    #[test]
    fn thousands_are_set_apart() {
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1234567), "1\u{202f}234\u{202f}567");
    }
}
