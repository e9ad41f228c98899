//! Effort of measurements.

use std::time::Duration;

use super::error::Accuracy;
use super::timing::Effort;
use crate::cli;

/// Effort of measurements, and the accuracy of references.
pub struct Thoroughness {
    pub effort: Effort,
    pub accuracy: Accuracy,
}

impl Thoroughness {
    pub fn from_arguments(arguments: &cli::Bench) -> Self {
        let quick = arguments.quick;
        let pick = |thorough: u64, quickly: u64| {
            Duration::from_millis(if quick { quickly } else { thorough })
        };
        let (least, most) = match arguments.repetitions {
            Some(count) => (count as usize, count as usize),
            None if quick => (2, 5),
            None => (3, 25),
        };
        Self {
            effort: Effort {
                cell: pick(8000, 250),
                least,
                most,
            },
            accuracy: Accuracy {
                crop_px: if quick { [48, 27] } else { [96, 54] },
                time: pick(8000, 300),
            },
        }
    }
}
