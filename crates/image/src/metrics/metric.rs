//! The figures of a comparison by their names.

use super::{LayerComparison, Verdict};

crate::listed! {
    /// A figure of one layer.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Metric {
        /// Root mean square difference.
        Rms = "rms";
        /// Root mean square of the difference over that of the reference.
        RelativeRms = "relative-rms";
        /// Relative mean squared error.
        RelativeMse = "relmse";
        /// The largest difference of a value.
        Max = "max";
        /// Mean FLIP.
        Flip = "flip";
        /// 95th percentile of FLIP.
        Flip95 = "flip95";
        /// Peak signal-to-noise ratio in decibels: the larger the better.
        Psnr = "psnr";
        /// The rms difference that noise does not explain.
        RmsBeyondNoise = "rms-beyond-noise";
        /// Root mean square beyond noise, over that of the reference.
        RelativeRmsBeyondNoise = "relative-rms-beyond-noise";
        /// Mean squared z-score.
        Z2 = "z2";
    }
    /// The name on the command line, in JSON and in Python.
    fn name;
}

impl Metric {
    /// Whether a larger figure means a smaller difference.
    pub fn larger_is_better(self) -> bool {
        self == Self::Psnr
    }

    /// The figure, where the layer has one.
    pub fn value(self, layer: &LayerComparison) -> Option<f64> {
        match self {
            Self::Rms => Some(layer.difference.rms),
            Self::RelativeRms => Some(layer.difference.relative_rms()),
            Self::RelativeMse => Some(layer.relative_mse),
            Self::Max => Some(layer.difference.max_abs),
            Self::Flip => layer.flip.as_ref().map(|flip| flip.mean),
            Self::Flip95 => layer.flip.as_ref().map(|flip| flip.percentile_95),
            Self::Psnr => layer.psnr.map(|psnr| psnr.db),
            Self::RmsBeyondNoise => layer.beyond_noise.map(|noise| noise.rms()),
            Self::RelativeRmsBeyondNoise => layer.beyond_noise.map(|noise| noise.relative_rms()),
            Self::Z2 => layer
                .z_test
                .filter(|test| test.verdict != Verdict::TooFewValues)
                .map(|test| test.mean_z2),
        }
    }

    /// Reason why a layer that was compared may lack the figure.
    pub fn why_missing(self) -> &'static str {
        match self {
            Self::RmsBeyondNoise | Self::RelativeRmsBeyondNoise | Self::Z2 => {
                "the files do not say how noisy they are, or of too few values"
            }
            _ => "this layer is no picture for a display",
        }
    }
}
