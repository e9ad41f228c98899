//! What menus and keys ask of it.

use super::Shows;
use crate::app::Viewer;

/// A wish about how the picture is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReadCommand {
    Probe,
    Histogram,
    /// False colour, or the picture again.
    FalseColor,
    Show(Shows),
    NextView,
    Brighter,
    Darker,
    ResetExposure,
}

/// What a press of a key adds to the exposure of the window.
const EXPOSURE_STEP_EV: f64 = 0.25;
/// It goes no further.
const MOST_EV: f64 = 20.0;

impl Viewer {
    pub(crate) fn read(&mut self, command: ReadCommand) {
        let reading = &mut self.reading;
        match command {
            ReadCommand::Probe => reading.probe.toggle(),
            ReadCommand::Histogram => reading.has_histogram = !reading.has_histogram,
            ReadCommand::FalseColor => {
                reading.shows = match reading.shows {
                    Shows::FalseColor => Shows::Beauty,
                    _ => Shows::FalseColor,
                };
            }
            ReadCommand::Show(shows) => reading.shows = shows,
            ReadCommand::NextView => reading.shows = reading.shows.next(),
            ReadCommand::Brighter => reading.expose(EXPOSURE_STEP_EV),
            ReadCommand::Darker => reading.expose(-EXPOSURE_STEP_EV),
            ReadCommand::ResetExposure => reading.exposure_ev = 0.0,
        }
    }

    /// Whether a switch is on; none for what is no switch.
    pub(crate) fn reads(&self, command: ReadCommand) -> Option<bool> {
        match command {
            ReadCommand::Probe => Some(self.reading.probe.is_on()),
            ReadCommand::Histogram => Some(self.reading.has_histogram),
            ReadCommand::Show(shows) => Some(self.reading.shows == shows),
            ReadCommand::FalseColor => Some(self.reading.shows == Shows::FalseColor),
            _ => None,
        }
    }
}

impl super::ReadingState {
    fn expose(&mut self, by_ev: f64) {
        self.exposure_ev = (self.exposure_ev + by_ev).clamp(-MOST_EV, MOST_EV);
    }
}
