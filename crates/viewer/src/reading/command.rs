//! Commands of menus and keys for reading the picture.

use super::{ReadingState, Shows};

/// A command about how the picture is read.
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

/// Step of the window's exposure by a press of a key.
const EXPOSURE_STEP_EV: f64 = 0.25;
/// Largest exposure of the window, either way.
const MOST_EV: f64 = 20.0;

impl ReadingState {
    pub fn run(&mut self, command: ReadCommand) {
        match command {
            ReadCommand::Probe => self.probe.toggle(),
            ReadCommand::Histogram => self.has_histogram = !self.has_histogram,
            ReadCommand::FalseColor => {
                self.shows = match self.shows {
                    Shows::FalseColor => Shows::Beauty,
                    _ => Shows::FalseColor,
                };
            }
            ReadCommand::Show(shows) => self.shows = shows,
            ReadCommand::NextView => self.shows = self.shows.next(),
            ReadCommand::Brighter => self.expose(EXPOSURE_STEP_EV),
            ReadCommand::Darker => self.expose(-EXPOSURE_STEP_EV),
            ReadCommand::ResetExposure => self.exposure_ev = 0.0,
        }
    }

    /// Whether a switch is on; none for commands that are no switch.
    pub fn is_on(&self, command: ReadCommand) -> Option<bool> {
        match command {
            ReadCommand::Probe => Some(self.probe.is_on()),
            ReadCommand::Histogram => Some(self.has_histogram),
            ReadCommand::Show(shows) => Some(self.shows == shows),
            ReadCommand::FalseColor => Some(self.shows == Shows::FalseColor),
            _ => None,
        }
    }

    fn expose(&mut self, by_ev: f64) {
        self.exposure_ev = (self.exposure_ev + by_ev).clamp(-MOST_EV, MOST_EV);
    }
}
