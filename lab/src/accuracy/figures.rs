//! Figures that all parts measured.

use serde::Serialize;

use super::cost::Cost;
use super::interference::Interference;
use super::masks::MaskFigures;
use super::scenes::SceneFigures;
use super::sweeps::SweepFigures;

/// Figures of all parts. A part is None if it was never measured.
#[derive(Serialize)]
pub struct Figures {
    pub scenes: Option<Vec<SceneFigures>>,
    pub sweeps: Option<Vec<SweepFigures>>,
    pub masks: Option<MaskFigures>,
    pub interference: Option<Interference>,
    pub cost: Option<Cost>,
}
