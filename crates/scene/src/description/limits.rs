//! Ranges of numbers that `check` accepts, as constants, so that an editor's controls stop where scenes do.
//!
//! Where a range starts at 0, [`Description::check`](super::Description::check) may want more than 0; the constant says so.

use std::ops::RangeInclusive;

/// Largest coordinate: beyond it single precision leaves less than a coherence width between neighbouring coordinates.
pub const LARGEST_M: f64 = 1e3;
/// Smaller things than this are lost between the coordinates of single precision, and below the model's scale.
pub const SMALLEST_M: f64 = 1e-5;

/// Coordinates of points.
pub const COORDINATE_M: RangeInclusive<f64> = -LARGEST_M..=LARGEST_M;
/// Components of directions; at least one must not be 0.
pub const DIRECTION: RangeInclusive<f64> = -1e6..=1e6;
/// Radii and edges of shapes and lights.
pub const SIZE_M: RangeInclusive<f64> = SMALLEST_M..=LARGEST_M;

/// `camera.fov_y_deg`
pub const FOV_Y_DEG: RangeInclusive<f64> = 0.001..=179.0;
/// `camera.focal_length_mm`
pub const FOCAL_LENGTH_MM: RangeInclusive<f64> = 0.1..=10_000.0;
/// `camera.sensor_width_mm`
pub const SENSOR_WIDTH_MM: RangeInclusive<f64> = 0.1..=1000.0;
/// `camera.f_stop`
pub const F_STOP: RangeInclusive<f64> = 0.1..=1000.0;
/// `camera.aperture_mm`
pub const APERTURE_MM: RangeInclusive<f64> = 0.0..=1000.0;
/// Both numbers of `camera.shift`
pub const SHIFT: RangeInclusive<f64> = -10.0..=10.0;
/// `light.rotation_deg`
pub const ROTATION_DEG: RangeInclusive<f64> = -360.0..=360.0;
/// `light.cone_deg`
pub const CONE_DEG: RangeInclusive<f64> = 0.1..=360.0;
/// `light.angle_deg`: narrower, single precision would not tell one edge of it from the other.
pub const SUN_ANGLE_DEG: RangeInclusive<f64> = 0.01..=90.0;
/// `light.barn_doors_deg`
pub const BARN_DOOR_DEG: RangeInclusive<f64> = 0.0..=90.0;
/// `light.temperature_k`
pub const TEMPERATURE_K: RangeInclusive<f64> = 1000.0..=40_000.0;
/// `camera.exposure_ev`, `light.exposure_ev`
pub const EXPOSURE_EV: RangeInclusive<f64> = -64.0..=64.0;
/// `render.size_px`, either way.
pub const PICTURE_PX: RangeInclusive<f64> = 1.0..=16_384.0;
/// `render.filter_std_px`
pub const FILTER_STD_PX: RangeInclusive<f64> = 0.1..=10.0;

/// `material.roughness`
pub const ROUGHNESS: RangeInclusive<f64> = 0.0..=1.0;
/// `material.clearcoat`
pub const CLEARCOAT: RangeInclusive<f64> = 0.0..=1.0;
/// `material.specular`, and each number of `material.specular_color`
pub const SPECULAR: RangeInclusive<f64> = 0.0..=1.0;
/// `material.anisotropy`
pub const ANISOTROPY: RangeInclusive<f64> = 0.0..=1.0;
/// `material.coherence_um`
pub const COHERENCE_UM: RangeInclusive<f64> = 1.0..=1000.0;
/// `material.ior`
pub const IOR: RangeInclusive<f64> = 1.0..=4.0;
/// `material.metallic`
pub const METALLIC: RangeInclusive<f64> = 0.0..=1.0;
/// Channels of `material.base_color`.
pub const BASE_COLOR: RangeInclusive<f64> = 0.0..=1.0;

/// `object.time_s`
pub const TIME_S: RangeInclusive<f64> = 0.0..=1e6;
/// Sizes of the factors of `object.scale`, which may be negative.
pub const SCALE: RangeInclusive<f64> = 1e-6..=1e6;
/// `segments` of a lathe.
pub const LATHE_SEGMENTS: RangeInclusive<f64> = 3.0..=4096.0;
/// `rounding_m` of shapes.
pub const ROUNDING_M: RangeInclusive<f64> = 0.0..=LARGEST_M;
/// Radii of a lathe's profile.
pub const PROFILE_RADIUS_M: RangeInclusive<f64> = 0.0..=LARGEST_M;

/// Mean of `scratches.length_m`, above 0.
pub const SCRATCH_LENGTH_M: RangeInclusive<f64> = 0.0..=LARGEST_M;
/// Mean of `scratches.width_um`, above 0.
pub const SCRATCH_WIDTH_UM: RangeInclusive<f64> = 0.0..=100.0;
/// Mean of `scratches.depth_nm`, above 0.
pub const SCRATCH_DEPTH_NM: RangeInclusive<f64> = 0.0..=2000.0;
/// Spread of a log-normal quantity.
pub const LOG_NORMAL_SPREAD: RangeInclusive<f64> = 0.0..=3.0;
/// Mean of `scratches.curvature_per_m`: a scratch that turns within a coherence width is no straight groove to the model.
pub const CURVATURE_PER_M: RangeInclusive<f64> = -1e4..=1e4;
/// Spread of `scratches.curvature_per_m`.
pub const CURVATURE_SPREAD_PER_M: RangeInclusive<f64> = 0.0..=1e4;
/// `grating.pitch_um`: beyond, grooves are scratches of their own.
pub const PITCH_UM: RangeInclusive<f64> = 0.3..=50.0;
/// Spread of `grating.depth_nm`, a share of the mean.
pub const GRATING_DEPTH_SPREAD: RangeInclusive<f64> = 0.0..=1.0;
/// `grating.coverage`
pub const COVERAGE: RangeInclusive<f64> = 0.0..=1.0;
/// `scratches.jitter_deg`, `grating.jitter_deg`
pub const JITTER_DEG: RangeInclusive<f64> = 0.0..=90.0;
/// `scratches.where.edges`
pub const EDGES: RangeInclusive<f64> = 0.0..=1.0;
/// `scratches.seed`: TOML's integers end there.
pub const LARGEST_SEED: u64 = i64::MAX as u64;
/// `width` and `depth` of a stroke: factors on its layer's sizes.
pub const STROKE_FACTOR: RangeInclusive<f64> = 0.01..=100.0;
/// Points of one stroke.
pub const STROKE_POINTS: RangeInclusive<usize> = 1..=65_536;

/// Characters of a text.
pub const TEXT_MOST: usize = 200;
