//! Directions of grooves on a surface.

/// Mean and spread of directions.
#[derive(Clone, Copy, Debug)]
pub struct GrooveDirections {
    /// Mean, from x.
    pub mean_rad: f64,
    /// Standard deviation; infinite where all directions are as frequent.
    pub std_rad: f64,
}
