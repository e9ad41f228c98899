//! The field of view of a `[camera]` by its lens, as cameras have it.

use super::limits::{FOCAL_LENGTH_MM, SENSOR_WIDTH_MM};
use super::ranges::{found, within};
use super::table::Table;
use crate::error::Error;

/// Of a 35 mm camera.
const FULL_FRAME_MM: f64 = 36.0;
/// `fov_y_deg` beside a lens may be rounded by this.
const ROUNDING_DEG: f64 = 0.05;

/// The keys of a lens.
pub(super) const KEYS: [&str; 2] = ["focal_length_mm", "sensor_width_mm"];

/// What a `[camera]` sees from top to bottom of a picture, if it says so by its lens. The sensor is as wide as the picture.
pub(super) fn fov_y_deg(camera: &Table, [width, height]: [u32; 2]) -> Result<Option<f64>, Error> {
    let Some(focal_length_mm) = camera.optional::<f64>("focal_length_mm")? else {
        return match camera.has("sensor_width_mm") {
            true => Err(Error::new(
                camera.way("sensor_width_mm"),
                "found no `focal_length_mm` that it belongs to",
                "give the camera one, or leave it out",
            )),
            false => Ok(None),
        };
    };
    let sensor_mm = camera.or("sensor_width_mm", FULL_FRAME_MM)?;
    let way = camera.way("focal_length_mm");
    within(&way, focal_length_mm, FOCAL_LENGTH_MM)?;
    within(&camera.way("sensor_width_mm"), sensor_mm, SENSOR_WIDTH_MM)?;
    let height_mm = sensor_mm * f64::from(height) / f64::from(width.max(1));
    let fov_y_deg = 2.0 * (0.5 * height_mm / focal_length_mm).atan().to_degrees();
    match camera.optional::<f64>("fov_y_deg")? {
        Some(given) if (given - fov_y_deg).abs() > ROUNDING_DEG => Err(Error::new(
            camera.way("fov_y_deg"),
            found(given),
            format!(
                "{focal_length_mm} mm before a sensor {sensor_mm} mm wide see {fov_y_deg:.2} degrees of {width} x {height} pixels; \
                 leave out one of them"
            ),
        )),
        given => Ok(given.or(Some(fov_y_deg))),
    }
}
