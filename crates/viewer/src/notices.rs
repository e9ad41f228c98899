//! Messages in the window: errors and notes. An error stays until it is dismissed.
//!
//! Not egui-notify: it paints its messages without widgets, so that neither a screen reader nor the keyboard finds them, and cannot
//! replace one message by the next of its topic.

use egui::{Align2, RichText};

/// Kind of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoticeKind {
    Error,
    Note,
}

struct Notice {
    kind: NoticeKind,
    text: String,
    /// Time in seconds at which the notice was first shown, or last shown while a scene was being built.
    since: Option<f64>,
    /// Replaced by the next of the same topic.
    topic: &'static str,
    /// Seconds for which it stays, if it is a note.
    seconds: f64,
}

/// The newest last.
#[derive(Default)]
pub(crate) struct Notices {
    list: Vec<Notice>,
}

/// Seconds after which a note disappears, and the additional time for each further line, which takes time to read.
const NOTE_SECONDS: f64 = 5.0;
const LINE_SECONDS: f64 = 3.0;
/// The same of a few words about a key.
const GLANCE_SECONDS: f64 = 2.0;
/// Largest number of messages: more would hide the picture.
const MOST: usize = 4;

impl Notices {
    /// Shows an error, and prints it on the terminal too.
    pub fn error(&mut self, topic: &'static str, text: impl Into<String>) {
        let text = text.into();
        let is_known = |notice: &Notice| notice.topic == topic && notice.text == text;
        if !self.list.iter().any(is_known) {
            eprintln!("error: {}", printable(&text));
        }
        self.push(NoticeKind::Error, topic, text, f64::INFINITY);
    }

    pub fn note(&mut self, topic: &'static str, text: impl Into<String>) {
        let text = text.into();
        let further = text.lines().count().saturating_sub(1);
        let seconds = NOTE_SECONDS + LINE_SECONDS * further as f64;
        self.push(NoticeKind::Note, topic, text, seconds);
    }

    /// Shows a few words for a moment.
    pub fn glance(&mut self, topic: &'static str, text: impl Into<String>) {
        self.push(NoticeKind::Note, topic, text.into(), GLANCE_SECONDS);
    }

    /// Removes the error of a topic once it is right again.
    pub fn clear(&mut self, topic: &'static str) {
        self.list.retain(|notice| notice.topic != topic);
    }

    /// Whether there is one of a topic.
    pub fn has(&self, topic: &str) -> bool {
        self.list.iter().any(|notice| notice.topic == topic)
    }

    /// Removes the messages about the scene before, when another one is there. Messages about the machine stay.
    pub fn begin_scene(&mut self) {
        self.list
            .retain(|notice| matches!(notice.topic, "device" | "autosave"));
    }

    fn push(&mut self, kind: NoticeKind, topic: &'static str, text: String, seconds: f64) {
        self.clear(topic);
        self.list.push(Notice {
            kind,
            text,
            since: None,
            topic,
            seconds,
        });
        if self.list.len() > MOST {
            self.list.remove(0);
        }
    }

    /// The text of all that are there, for tests and the log.
    pub fn texts(&self) -> Vec<&str> {
        self.list
            .iter()
            .map(|notice| notice.text.as_str())
            .collect()
    }

    /// Above the lower edge of `area`. While a scene is being built no note grows older: it may tell of what is seen only then.
    pub fn show(&mut self, ctx: &egui::Context, area: egui::Rect, is_building: bool) {
        let now = ctx.input(|input| input.time);
        for notice in &mut self.list {
            if is_building || notice.since.is_none() {
                notice.since = Some(now);
            }
        }
        self.list.retain(|notice| {
            let since = notice.since;
            since.is_none_or(|since| now - since < notice.seconds)
        });
        if self.list.is_empty() {
            return;
        }
        let notes = self.list.iter().filter(|it| it.kind == NoticeKind::Note);
        if let Some(seconds) = notes.map(|it| it.seconds).reduce(f64::min) {
            ctx.request_repaint_after(std::time::Duration::from_secs_f64(seconds));
        }
        let mut dismissed = None;
        egui::Area::new(egui::Id::unique("notices"))
            .anchor(
                Align2::LEFT_BOTTOM,
                egui::vec2(
                    area.left() + 12.0,
                    area.bottom() - ctx.content_rect().bottom() - 12.0,
                ),
            )
            .order(egui::Order::Foreground)
            .show(ctx, |ui| {
                ui.set_max_width((area.width() - 24.0).clamp(200.0, 640.0));
                for (i, notice) in self.list.iter().enumerate() {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        ui.horizontal(|ui| {
                            let color = match notice.kind {
                                NoticeKind::Error => crate::style::ERROR,
                                NoticeKind::Note => ui.visuals().text_color(),
                            };
                            if notice.kind == NoticeKind::Error
                                && ui.small_button("Dismiss").clicked()
                            {
                                dismissed = Some(i);
                            }
                            ui.add(
                                egui::Label::new(RichText::new(&notice.text).color(color)).wrap(),
                            );
                        });
                    });
                }
            });
        if let Some(i) = dismissed {
            self.list.remove(i);
        }
    }
}

/// Text without characters that a terminal would obey: it may hold the contents of a file.
fn printable(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '\n' => out.push(c),
            c if c.is_control() => out.extend(c.escape_default()),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn a_terminal_gets_nothing_to_obey() {
        assert_eq!(printable("a\u{1b}[31mb\nc µ"), "a\\u{1b}[31mb\nc µ");
    }
}
