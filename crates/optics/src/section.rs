//! The cross section of a groove, and its class under a coherence window (docs/model.md, section 5, "Profiles" and "Wide grooves").
//!
//! A groove of width W has the depth d s(2x/W) at the distance x from its middle.

use spec_math::cephes64::erfc;
use std::f64::consts::{PI, SQRT_2};
use std::sync::Arc;

/// Cross section of a groove, the same on both sides of its middle.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Section {
    /// A floor of one depth between upright walls.
    #[default]
    Rectangle,
    /// Two straight flanks: a sharp tool.
    V,
    /// A parabola, which is what a shallow arc of a circle is: a grain, the tip of a stylus.
    Round,
    /// A round groove with the ridges beside it that a blunt tool pushes up.
    Shoulders,
    /// Depths over the deepest one at equal steps from the middle to the rim, straight lines between them; below 0 above the surface.
    Listed(Arc<[f64]>),
}

/// Share of the half width that the groove between the shoulders has.
const BETWEEN_SHOULDERS: f64 = 0.6;
/// Height of shoulders over the depth. They hold a third of what the groove has lost.
const SHOULDER_HEIGHT: f64 = 0.5;

impl Section {
    /// Depth over the deepest one, at `x` half widths from the middle.
    pub fn depth_share(&self, x: f64) -> f64 {
        let x = x.abs();
        if x >= 1.0 {
            return 0.0;
        }
        match self {
            Self::Rectangle => 1.0,
            Self::V => 1.0 - x,
            Self::Round => 1.0 - x * x,
            Self::Shoulders if x < BETWEEN_SHOULDERS => 1.0 - (x / BETWEEN_SHOULDERS).powi(2),
            Self::Shoulders => {
                let t = (x - BETWEEN_SHOULDERS) / (1.0 - BETWEEN_SHOULDERS);
                -4.0 * SHOULDER_HEIGHT * t * (1.0 - t)
            }
            Self::Listed(depths) => match &depths[..] {
                [] => 0.0,
                [one] => *one,
                depths => {
                    let at = x * (depths.len() - 1) as f64;
                    let i = (at as usize).min(depths.len() - 2);
                    depths[i] + (at - i as f64) * (depths[i + 1] - depths[i])
                }
            },
        }
    }

    /// Slopes over half of the section, in parts as wide, from the middle to the rim: of the depth over the deepest by the distance in half widths. `count`
    /// divides 60. An upright wall has none: at the rim its height leans over the half width, as that of a V.
    pub fn slopes(&self, count: usize) -> Vec<PartSlope> {
        let rim = self.depth_share(1.0_f64.next_down());
        let depth = |step: usize| {
            let x = step as f64 / SLOPE_STEPS as f64;
            let wall = if step == SLOPE_STEPS { 0.0 } else { rim * x };
            self.depth_share(x) - wall
        };
        let steps = SLOPE_STEPS / count;
        let part = |i: usize| {
            let slopes = (i * steps..(i + 1) * steps)
                .map(|step| (depth(step + 1) - depth(step)) * SLOPE_STEPS as f64);
            let mean = |of: fn(f64) -> f64| slopes.clone().map(of).sum::<f64>() / steps as f64;
            PartSlope {
                mean: mean(|slope| slope),
                mean_square: mean(|slope| slope * slope),
            }
        };
        (0..count).map(part).collect()
    }

    /// The parts that a wide groove counts as, side by side.
    ///
    /// The light of a floor comes from its two edges, (46) of docs/model.md, and that of slopes from all of them. Floors wider than the widest class
    /// send what that one does.
    pub fn parts(&self, width_um: f64, coherence_um: f64) -> Parts {
        let shape = GrooveShape {
            section: self.clone(),
            width_class: width_class(width_um / coherence_um),
        };
        let is_floor = *self == Self::Rectangle;
        let widest_um = CLASSES[CLASSES.len() - 1].1 * coherence_um;
        let lit_um = if is_floor {
            width_um.min(widest_um)
        } else {
            width_um
        };
        let count = shape.part_count();
        let offset_um = |i: usize| match is_floor {
            true => (i as f64 - 0.5) * width_um,
            false => ((i as f64 + 0.5) / count as f64 - 0.5) * width_um,
        };
        Parts {
            offsets_um: (0..count).map(offset_um).collect(),
            width_um: lit_um / shape.widths_of_part(),
            lit_um,
        }
    }

    /// Strips of one depth each that stand for the section: the place of the middle over the half width, and the depth over the deepest. All are as
    /// wide. One for a rectangle.
    pub fn strips(&self, count: usize) -> Vec<(f64, f64)> {
        if *self == Self::Rectangle {
            return vec![(0.0, 1.0)];
        }
        (0..count)
            .map(|i| {
                let x = (2 * i + 1) as f64 / count as f64 - 1.0;
                (x, self.depth_share(x))
            })
            .collect()
    }
}

/// Slopes of a part of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartSlope {
    /// Their mean.
    pub mean: f64,
    /// The mean of their squares.
    pub mean_square: f64,
}

/// Straight lines that half a section counts as for its slopes. The feet of shoulders lie between two.
const SLOPE_STEPS: usize = 60;

/// A section under a coherence window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrooveShape {
    /// The section.
    pub section: Section,
    /// Class of the width over the window's standard deviation: 0 for narrow grooves, which the window sees alike all over.
    pub width_class: u8,
}

/// Largest width over the window's standard deviation of a narrow groove.
pub const NARROW: f64 = 0.4;
/// Largest width over the window's standard deviation of each class of wide grooves, and the one that stands for the class.
pub(crate) const CLASSES: [(f64, f64); 5] = [
    (0.7, 0.53),
    (1.2, 0.92),
    (2.0, 1.55),
    (3.4, 2.6),
    (f64::INFINITY, 5.0),
];

impl GrooveShape {
    /// Whether it is wide: its two halves lie apart.
    pub fn is_wide(&self) -> bool {
        self.width_class > 0
    }

    /// Number of parts that a groove counts as: its two edges; for slopes as many as leave no gap between them.
    pub(crate) fn part_count(&self) -> usize {
        match self.width_class {
            0 => 1,
            class if usize::from(class) == CLASSES.len() && self.section != Section::Rectangle => 4,
            _ => 2,
        }
    }

    /// Width of the groove over the width that one part counts as. What a floor takes from the mirror's direction stops growing once it is wider
    /// than the window, and the parts add up to that.
    pub(crate) fn widths_of_part(&self) -> f64 {
        let windows = self.width_in_windows();
        if windows == 0.0 {
            return 1.0;
        }
        let taken = windows * erfc(windows / SQRT_2)
            + (2.0 / PI).sqrt() * (1.0 - (-0.5 * windows * windows).exp());
        self.part_count() as f64 * windows / taken
    }

    /// Width over the window's standard deviation that stands for the class; 0 for a narrow groove.
    pub(crate) fn width_in_windows(&self) -> f64 {
        match self.width_class {
            0 => 0.0,
            class => CLASSES[usize::from(class) - 1].1,
        }
    }
}

/// Factor from the share of a part of a wide groove to that by which it covers other scratches, for each class of widths; 1 for narrow grooves.
///
/// A part has the share that the groove takes from the mirror's direction, and the groove covers its whole width. Of the light that comes from the
/// edges of floors exp(-rho) is left, since an edge within another floor is none; [`ScratchSums::mask_resolve`](crate::mask::ScratchSums::mask_resolve) leaves about
/// exp(-3/2 rho), which is right for narrow grooves: hence two thirds.
pub fn cover_of_part(width_class: u8) -> f64 {
    COVERS[usize::from(width_class)]
}

/// [`cover_of_part`]: 2/3 of the width over what is taken, [`GrooveShape::widths_of_part`].
const COVERS: [f64; 6] = [1.0, 0.8403, 1.015, 1.3858, 2.1804, 4.1777];

/// Parts of a wide groove.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// Distance of each from the groove's middle.
    pub offsets_um: Vec<f64>,
    /// Width of the share of each, by which [`ScratchTable::of_shape`](crate::table::ScratchTable::of_shape) is looked up, too.
    pub width_um: f64,
    /// Width of the groove that sends light.
    pub lit_um: f64,
}

/// Class of a width over the window's standard deviation: 0 for narrow grooves.
pub fn width_class(windows: f64) -> u8 {
    if !(windows > NARROW) {
        return 0;
    }
    let class = CLASSES.iter().position(|(most, _)| windows <= *most);
    class.map_or(CLASSES.len(), |class| class + 1) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_the_section() {
        let all = |section: Section| section.slopes(1)[0];
        // An upright wall leans as a V does.
        let listed = |depths: &[f64]| Section::Listed(depths.into());
        for section in [Section::V, Section::Rectangle, listed(&[1.0, 0.4])] {
            let slope = all(section.clone());
            assert!((slope.mean + 1.0).abs() < 1e-12 && (slope.mean_square - 1.0).abs() < 1e-12);
            assert!(
                section
                    .slopes(12)
                    .iter()
                    .all(|it| (it.mean + 1.0).abs() < 1e-12)
            );
        }
        // The integrals of the squares of 2x, and of 2x/0.36 to 0.6 and 5 (1 - 2t) from there on.
        assert!((all(Section::Round).mean_square - 4.0 / 3.0).abs() < 1e-3);
        let shoulders = 8.0 / 3.6 + 0.4 * 25.0 / 3.0;
        assert!((all(Section::Shoulders).mean_square / shoulders - 1.0).abs() < 3e-3);
        // What lies above the surface at the rim comes down to it.
        assert!((all(listed(&[1.0, -0.5])).mean + 1.0).abs() < 1e-12);
    }

    #[test]
    fn covers_are_two_thirds_of_the_width_over_what_is_taken() {
        for (class, cover) in (0..).zip(COVERS).skip(1) {
            let shape = GrooveShape {
                section: Section::Rectangle,
                width_class: class,
            };
            let exact = 2.0 / 3.0 * shape.widths_of_part() / shape.part_count() as f64;
            assert!((cover - exact).abs() < 1e-4, "{class}: {cover} {exact}");
        }
    }
}
