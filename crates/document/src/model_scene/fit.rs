//! How large a model is shown, and where.

use glam::DVec3;

use crate::probe::MeshSummary;

/// Sizes at which scratches can be seen; other models are shown [`SHOWN_M`] large.
const SIZES_M: std::ops::RangeInclusive<f64> = 0.02..=1.0;
const SHOWN_M: f64 = 0.05;

/// How a model stands in its scene: upright, and at a size at which scratches can be seen.
pub(super) struct Fit {
    /// Largest extent of the model in its file.
    pub extent_m: f64,
    /// What its lengths are multiplied by.
    pub factor: f64,
    /// `fit_m` of its object.
    pub fit_m: Option<f64>,
    /// The point of the file that is moved to the origin.
    middle_m: DVec3,
}

impl Fit {
    pub(super) fn new(summary: &MeshSummary, shown_name: &str, notes: &mut Vec<String>) -> Self {
        let (mut factor, mut fit_m) = (1.0, None);
        let extent_m = summary.extent_m();
        if !SIZES_M.contains(&extent_m) {
            (factor, fit_m) = (SHOWN_M / extent_m, Some(SHOWN_M));
            notes.push(format!(
                "{shown_name} is {} large; it is shown {SHOWN_M} m large (`fit_m`), so that its scratches are seen",
                metres(extent_m)
            ));
        }
        if summary.moved_from.is_some() {
            // Fitted models are moved.
            fit_m.get_or_insert(extent_m);
        }
        Self {
            extent_m,
            factor,
            fit_m,
            middle_m: summary.moved_from.unwrap_or(DVec3::ZERO),
        }
    }

    /// From y up to z up.
    pub(super) fn turned(&self, p: DVec3) -> DVec3 {
        self.factor * DVec3::new(p.x, -p.z, p.y)
    }

    /// A point of the file as the scene has it.
    pub(super) fn placed_m(&self, p: DVec3) -> DVec3 {
        self.turned(p - self.middle_m)
    }
}

fn metres(length_m: f64) -> String {
    match length_m {
        0.01..1000.0 => format!("{length_m:.3} m"),
        _ => format!("{length_m:.1e} m"),
    }
}
