//! Linear images with layers, EXR and PNG files, tone mapping, metrics.

/// The curve from linear radiance to the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ToneMap {
    /// Khronos PBR Neutral.
    #[default]
    Neutral,
    /// AgX.
    Agx,
    /// The ACES filmic curve.
    Aces,
    /// Clamped, no curve.
    None,
}
