//! Ranges of the panels' controls, for each number of the scene file: the ends of a slider, the limits of the scene, the scale, and the
//! effect on the look.
//!
//! Hard limits are the scene's own, from [`limits`]; sliders end where looks do, and typing goes on to the hard ones. Where the scene has no
//! limit, typing ends far beyond any use, so that a slip of the hand is refused.

mod parameter;
mod texts;

use std::ops::RangeInclusive;

use hairline_scene::description::limits;

use crate::quantity::Unit;

pub use parameter::Parameter;

/// Range and texts of a control.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Label in a panel.
    pub label: &'static str,
    /// Ends of the slider: good looks lie within.
    pub slider: RangeInclusive<f64>,
    /// Values that may be typed.
    pub hard: RangeInclusive<f64>,
    /// Whether equal ways of the slider are equal factors.
    pub logarithmic: bool,
    /// Unit of the number.
    pub unit: Unit,
    /// Whether it has no digits behind the point.
    pub is_whole: bool,
    /// Description of its effect on the look.
    pub tooltip: &'static str,
}

/// Largest width that the model is right for on any base, micrometres.
const WIDE_UM: f64 = 10.0;
/// Roughness above which a base does not bear wider scratches.
const ROUGH: f64 = 0.1;

/// Hint about scratches of a width, as a mean, on a base of a roughness, where the model is off.
pub fn hint_on_width(width_um: f64, roughness: f64) -> Option<&'static str> {
    (width_um > WIDE_UM && roughness > ROUGH).then_some(
        "Wider than 10 µm on a rough base: the light of these scratches is wrong. On steel of roughness 0.3 it was \
         off by 131 % at 30 µm and by 305 % at 100 µm against the reference.",
    )
}

/// The diagonal of an object that is not known yet: a pan's.
pub(crate) const DEFAULT_DIAGONAL_M: f64 = 0.3;

impl Parameter {
    /// Every parameter.
    pub const ALL: [Self; 94] = [
        Self::CameraPosition,
        Self::CameraTarget,
        Self::CameraUp,
        Self::FieldOfView,
        Self::FocalLength,
        Self::SensorWidth,
        Self::FStop,
        Self::Aperture,
        Self::FocusDistance,
        Self::Exposure,
        Self::PictureSize,
        Self::Filter,
        Self::EnvironmentRotation,
        Self::EnvironmentIntensity,
        Self::StudioRotation,
        Self::StudioIntensity,
        Self::GroundHeight,
        Self::Roughness,
        Self::Clearcoat,
        Self::ClearcoatRoughness,
        Self::Anisotropy,
        Self::AnisotropyDirection,
        Self::Coherence,
        Self::Ior,
        Self::BaseColor,
        Self::Metallic,
        Self::Specular,
        Self::SpecularColor,
        Self::Translation,
        Self::Rotation,
        Self::Scale,
        Self::PlaneSize,
        Self::ShapeRadius,
        Self::ShapeHeight,
        Self::TubeRadius,
        Self::Rounding,
        Self::TextDepth,
        Self::FitSize,
        Self::Time,
        Self::LatheSegments,
        Self::ProfileRadius,
        Self::ProfileHeight,
        Self::Count,
        Self::Density,
        Self::Seed,
        Self::Length,
        Self::LengthSpread,
        Self::Width,
        Self::WidthSpread,
        Self::Depth,
        Self::DepthSpread,
        Self::Curvature,
        Self::CurvatureSpread,
        Self::Jitter,
        Self::Axis,
        Self::AxisCenter,
        Self::Direction,
        Self::Edges,
        Self::EdgeWidth,
        Self::Tile,
        Self::PlaceCenter,
        Self::PlaceInnerRadius,
        Self::PlaceOuterRadius,
        Self::Pitch,
        Self::GrooveWidth,
        Self::GrooveDepthSpread,
        Self::Displacement,
        Self::GrooveAngles,
        Self::SpotSpacing,
        Self::Coverage,
        Self::InnerRadius,
        Self::OuterRadius,
        Self::BrushRadius,
        Self::BrushDensity,
        Self::BrushWidth,
        Self::BrushDepth,
        Self::LightCenter,
        Self::LightTarget,
        Self::LightRadius,
        Self::LightWidth,
        Self::LightHeight,
        Self::LightRotation,
        Self::LightVertex,
        Self::LightEnd,
        Self::SunDirection,
        Self::SunAngle,
        Self::Irradiance,
        Self::LightCone,
        Self::LightSoftness,
        Self::LightDoor,
        Self::Radiance,
        Self::LightExposure,
        Self::LightTemperature,
        Self::LightColor,
    ];

    /// Range and texts of its control. Sliders of lengths and curvatures fit the object or the scene whose bounding box has this diagonal.
    pub fn range(self, diagonal_m: f64) -> Range {
        use Parameter as P;
        let d = match diagonal_m.is_finite() && diagonal_m > 0.0 {
            true => diagonal_m.clamp(1e-3, 100.0),
            false => DEFAULT_DIAGONAL_M,
        };
        // Times all exposures of a scene it is still a number of single precision.
        const BRIGHTNESS: RangeInclusive<f64> = 0.0..=1e15;
        // Some thousand turns.
        const TURN_DEG: RangeInclusive<f64> = -1e6..=1e6;
        const DENSITY: RangeInclusive<f64> = 0.0..=1e12;
        // 2^53: beyond it a control's number is no longer the whole number that it shows. The scene's own end is 2^63.
        const LARGEST_EXACT: f64 = 9_007_199_254_740_992.0;
        let (slider, hard) = match self {
            P::CameraPosition | P::CameraTarget => (-5.0 * d..=5.0 * d, limits::COORDINATE_M),
            P::CameraUp | P::Axis | P::Direction | P::SunDirection => {
                (-1.0..=1.0, limits::DIRECTION)
            }
            P::FieldOfView => (5.0..=90.0, limits::FOV_Y_DEG),
            P::FocalLength => (0.014..=0.3, in_metres(limits::FOCAL_LENGTH_MM)),
            P::SensorWidth => (0.005..=0.06, in_metres(limits::SENSOR_WIDTH_MM)),
            P::FStop => (1.4..=22.0, limits::F_STOP),
            P::Aperture => (1e-3 * d..=0.1 * d, in_metres(limits::APERTURE_MM)),
            P::FocusDistance => (0.1 * d..=5.0 * d, limits::SIZE_M),
            P::Exposure => (-8.0..=8.0, limits::EXPOSURE_EV),
            P::PictureSize => (64.0..=4096.0, limits::PICTURE_PX),
            P::Filter => (0.3..=2.0, limits::FILTER_STD_PX),
            P::EnvironmentRotation | P::StudioRotation | P::Rotation => (-180.0..=180.0, TURN_DEG),
            P::EnvironmentIntensity | P::StudioIntensity => (0.01..=10.0, BRIGHTNESS),
            P::Roughness => (0.0..=0.6, limits::ROUGHNESS),
            P::Clearcoat => (0.0..=1.0, limits::CLEARCOAT),
            P::ClearcoatRoughness => (0.0..=0.6, limits::ROUGHNESS),
            P::Anisotropy => (0.0..=1.0, limits::ANISOTROPY),
            P::AnisotropyDirection => (-90.0..=90.0, TURN_DEG),
            P::Coherence => (5.0..=100.0, limits::COHERENCE_UM),
            P::Ior => (1.0..=2.5, limits::IOR),
            P::BaseColor => (0.0..=1.0, limits::BASE_COLOR),
            P::Metallic => (0.0..=1.0, limits::METALLIC),
            P::Specular | P::SpecularColor => (0.0..=1.0, limits::SPECULAR),
            P::Translation => (-2.0 * d..=2.0 * d, limits::COORDINATE_M),
            // Smaller than 1e-6 neither way; 0 lies between and is refused.
            P::Scale => (0.01..=10.0, -*limits::SCALE.end()..=*limits::SCALE.end()),
            P::PlaneSize | P::ShapeRadius | P::ShapeHeight | P::FitSize => {
                (0.05 * d..=5.0 * d, limits::SIZE_M)
            }
            P::TubeRadius | P::TextDepth => (0.01 * d..=d, limits::SIZE_M),
            P::Rounding => (0.0..=0.5 * d, limits::ROUNDING_M),
            P::Time => (0.0..=10.0, limits::TIME_S),
            P::LatheSegments => (16.0..=512.0, limits::LATHE_SEGMENTS),
            P::ProfileRadius => (0.0..=d, limits::PROFILE_RADIUS_M),
            P::ProfileHeight | P::GroundHeight => (-d..=d, limits::COORDINATE_M),
            P::Count => (10.0..=100_000.0, 0.0..=LARGEST_EXACT),
            P::Density => (10.0 / (d * d)..=100_000.0 / (d * d), DENSITY),
            P::Seed => (0.0..=1000.0, 0.0..=LARGEST_EXACT),
            P::Length => (1e-3 * d..=2.0 * d, above_zero(limits::SCRATCH_LENGTH_M)),
            P::LengthSpread => (0.0..=1.5, limits::LOG_NORMAL_SPREAD),
            P::Width => (0.5..=WIDE_UM, above_zero(limits::SCRATCH_WIDTH_UM)),
            P::WidthSpread => (0.0..=0.6, limits::LOG_NORMAL_SPREAD),
            P::Depth => (20.0..=600.0, above_zero(limits::SCRATCH_DEPTH_NM)),
            P::DepthSpread => (0.0..=0.5, limits::LOG_NORMAL_SPREAD),
            P::Curvature => (-50.0 / d..=50.0 / d, limits::CURVATURE_PER_M),
            P::CurvatureSpread => (0.0..=50.0 / d, limits::CURVATURE_SPREAD_PER_M),
            P::Jitter => (0.0..=30.0, limits::JITTER_DEG),
            P::Pitch => (0.4..=50.0, limits::PITCH_UM),
            P::GrooveWidth => (0.1..=20.0, above_zero(0.0..=*limits::PITCH_UM.end())),
            P::GrooveDepthSpread => (0.0..=0.5, limits::GRATING_DEPTH_SPREAD),
            P::Displacement => (0.0..=5.0, 0.0..=*limits::PITCH_UM.end()),
            P::GrooveAngles => (0.0..=10.0, limits::JITTER_DEG),
            P::SpotSpacing => (0.01 * d..=0.5 * d, limits::SIZE_M),
            P::Coverage => (0.0..=1.0, limits::COVERAGE),
            P::Edges => (0.0..=1.0, limits::EDGES),
            P::EdgeWidth => (2e-3 * d..=0.1 * d, limits::SIZE_M),
            P::Tile => (0.02 * d..=2.0 * d, limits::SIZE_M),
            P::InnerRadius | P::OuterRadius | P::PlaceInnerRadius | P::PlaceOuterRadius => {
                (0.0..=d, limits::PROFILE_RADIUS_M)
            }
            P::AxisCenter | P::PlaceCenter => (-d..=d, limits::COORDINATE_M),
            P::BrushRadius => (2e-3 * d..=0.3 * d, limits::SIZE_M),
            P::BrushDensity => (10.0 / d..=10_000.0 / d, DENSITY),
            P::BrushWidth | P::BrushDepth => (0.25..=4.0, limits::STROKE_FACTOR),
            P::LightCenter | P::LightTarget | P::LightVertex | P::LightEnd => {
                (-5.0 * d..=5.0 * d, limits::COORDINATE_M)
            }
            P::LightRadius | P::LightWidth | P::LightHeight => (2e-3 * d..=d, limits::SIZE_M),
            P::SunAngle => (0.1..=10.0, limits::SUN_ANGLE_DEG),
            P::Irradiance => (1e-3..=10.0, BRIGHTNESS),
            P::LightCone => (5.0..=180.0, limits::CONE_DEG),
            P::LightSoftness => (0.0..=1.0, 0.0..=1.0),
            P::LightDoor => (0.0..=90.0, limits::BARN_DOOR_DEG),
            P::LightRotation => (-180.0..=180.0, limits::ROTATION_DEG),
            P::Radiance => (0.01..=1000.0, BRIGHTNESS),
            P::LightExposure => (-8.0..=8.0, limits::EXPOSURE_EV),
            P::LightTemperature => (1800.0..=10_000.0, limits::TEMPERATURE_K),
            P::LightColor => (0.0..=1.0, BRIGHTNESS),
        };
        let text = texts::of(self);
        Range {
            label: text.label,
            // An object may be larger than what a scratch can be.
            slider: clipped(&slider, &hard),
            hard,
            logarithmic: self.is_logarithmic(),
            unit: self.unit(),
            is_whole: self.is_whole(),
            tooltip: text.tooltip,
        }
    }

    fn is_logarithmic(self) -> bool {
        use Parameter as P;
        matches!(
            self,
            P::EnvironmentIntensity
                | P::StudioIntensity
                | P::FocalLength
                | P::FStop
                | P::Coherence
                | P::Scale
                | P::PlaneSize
                | P::ShapeRadius
                | P::ShapeHeight
                | P::TubeRadius
                | P::TextDepth
                | P::FitSize
                | P::Count
                | P::Density
                | P::Length
                | P::EdgeWidth
                | P::Tile
                | P::Pitch
                | P::GrooveWidth
                | P::SpotSpacing
                | P::BrushRadius
                | P::BrushDensity
                | P::BrushWidth
                | P::BrushDepth
                | P::LightRadius
                | P::LightWidth
                | P::LightHeight
                | P::Radiance
                | P::SunAngle
                | P::Irradiance
        )
    }

    fn unit(self) -> Unit {
        use Parameter as P;
        match self {
            P::CameraPosition
            | P::CameraTarget
            | P::Translation
            | P::PlaneSize
            | P::ShapeRadius
            | P::ShapeHeight
            | P::TubeRadius
            | P::TextDepth
            | P::Rounding
            | P::FitSize
            | P::ProfileRadius
            | P::ProfileHeight
            | P::GroundHeight
            | P::Length
            | P::AxisCenter
            | P::EdgeWidth
            | P::Tile
            | P::PlaceCenter
            | P::PlaceInnerRadius
            | P::PlaceOuterRadius
            | P::InnerRadius
            | P::OuterRadius
            | P::SpotSpacing
            | P::BrushRadius
            | P::LightCenter
            | P::LightTarget
            | P::LightRadius
            | P::LightWidth
            | P::LightHeight
            | P::LightVertex
            | P::LightEnd
            | P::FocalLength
            | P::SensorWidth
            | P::Aperture
            | P::FocusDistance => Unit::Metre,
            P::FieldOfView
            | P::EnvironmentRotation
            | P::StudioRotation
            | P::Rotation
            | P::Jitter
            | P::GrooveAngles
            | P::LightRotation
            | P::LightCone
            | P::LightDoor
            | P::SunAngle => Unit::Degree,
            P::Exposure | P::LightExposure => Unit::Exposure,
            P::LightTemperature => Unit::Kelvin,
            P::PictureSize | P::Filter => Unit::Pixel,
            P::Coherence | P::Width | P::Pitch | P::GrooveWidth | P::Displacement => {
                Unit::Micrometre
            }
            P::Depth => Unit::Nanometre,
            P::Density => Unit::PerSquareMetre,
            P::Curvature | P::CurvatureSpread | P::BrushDensity => Unit::PerMetre,
            _ => Unit::None,
        }
    }

    fn is_whole(self) -> bool {
        use Parameter as P;
        matches!(self, P::PictureSize | P::LatheSegments | P::Count | P::Seed)
    }
}

fn in_metres(range_mm: RangeInclusive<f64>) -> RangeInclusive<f64> {
    1e-3 * range_mm.start()..=1e-3 * range_mm.end()
}

/// The range without its end at 0, which the scene refuses.
fn above_zero(range: RangeInclusive<f64>) -> RangeInclusive<f64> {
    f64::MIN_POSITIVE..=*range.end()
}

fn clipped(slider: &RangeInclusive<f64>, hard: &RangeInclusive<f64>) -> RangeInclusive<f64> {
    let into = |x: f64| x.clamp(*hard.start(), *hard.end());
    into(*slider.start())..=into(*slider.end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliders_lie_within_the_limits_for_objects_of_any_size() {
        for d in [1e-4, 0.03, 0.3, 4.5, 80.0, f64::NAN, 0.0] {
            for parameter in Parameter::ALL {
                let range = parameter.range(d);
                let (from, to) = (*range.slider.start(), *range.slider.end());
                assert!(from < to, "{parameter:?} at {d}: {range:?}");
                assert!(range.hard.contains(&from) && range.hard.contains(&to));
                assert!(!range.logarithmic || from > 0.0, "{parameter:?}");
            }
        }
    }

    #[test]
    fn tooltips_are_sentences_and_labels_differ_within_a_panel() {
        for parameter in Parameter::ALL {
            let Range { label, tooltip, .. } = parameter.range(0.3);
            assert!(
                tooltip.len() > 30 && tooltip.len() < 320,
                "{parameter:?}: {}",
                tooltip.len()
            );
            assert!(
                tooltip.ends_with('.') && !tooltip.contains('\n'),
                "{parameter:?}"
            );
            assert!(
                label.starts_with(|c: char| c.is_uppercase()),
                "{parameter:?}"
            );
        }
    }
}
