//! The field of view of a `[camera]` and its opening by its lens, as cameras have it.

use super::Camera;
use super::ranges::found;
use super::table::Table;
use crate::error::Error;

/// The table that has the keys of a lens.
const SECTION: &str = "camera";
/// `fov_y_deg` beside a lens may be rounded by this.
const ROUNDING_DEG: f64 = 0.05;

/// `aperture_mm` beside an f-stop may be rounded by this share.
const ROUNDING: f64 = 1e-3;

/// Reads the vertical field of view of a `[camera]` that states it by its lens. The sensor is as wide as the picture.
pub(super) fn fov_y_deg(camera: &Table, [width, height]: [u32; 2]) -> Result<Option<f64>, Error> {
    let Some(focal_length_mm) = camera.value::<Option<f64>>(Camera::FOCAL_LENGTH_MM)? else {
        return Ok(None);
    };
    let sensor_mm = camera.value(Camera::SENSOR_WIDTH_MM)?;
    Camera::FOCAL_LENGTH_MM.check(SECTION, &focal_length_mm)?;
    Camera::SENSOR_WIDTH_MM.check(SECTION, &sensor_mm)?;
    let fov_y_deg = seen_deg(focal_length_mm, sensor_mm, [width, height]);
    match camera.optional::<f64>("fov_y_deg")? {
        Some(given) if (given - fov_y_deg).abs() > ROUNDING_DEG => Err(Error::new(
            camera.key_path("fov_y_deg"),
            found(given),
            format!(
                "{focal_length_mm} mm before a sensor {sensor_mm} mm wide see {fov_y_deg:.2} degrees of {width} x {height} pixels; \
                 leave out one of them"
            ),
        )),
        given => Ok(given.or(Some(fov_y_deg))),
    }
}

/// The diameter of the opening of a `[camera]`, if it has one: as it is, or by its f-stop.
pub(super) fn aperture_mm(camera: &Table) -> Result<Option<f64>, Error> {
    let given = camera.optional::<f64>("aperture_mm")?;
    let Some(f_stop) = camera.optional::<f64>("f_stop")? else {
        return Ok(given);
    };
    Camera::F_STOP.check(SECTION, &f_stop)?;
    let Some(focal_length_mm) = camera.optional::<f64>("focal_length_mm")? else {
        return Err(Error::new(
            camera.key_path("f_stop"),
            "found no `focal_length_mm` that it belongs to",
            "give the camera one, or `aperture_mm` in place of the f-stop",
        ));
    };
    let aperture_mm = focal_length_mm / f_stop;
    match given {
        Some(given) if (given / aperture_mm - 1.0).abs() > ROUNDING => Err(Error::new(
            camera.key_path("aperture_mm"),
            found(given),
            format!(
                "{focal_length_mm} mm at f/{f_stop} have an opening of {aperture_mm:.3} mm; leave out one of them"
            ),
        )),
        given => Ok(given.or(Some(aperture_mm))),
    }
}

/// Distance of focus of a `[camera]` that has an opening.
pub(super) fn focus_distance_m(camera: &Table) -> Result<Option<f64>, Error> {
    let given = camera.optional("focus_distance_m")?;
    if given.is_some() && !camera.has("aperture_mm") && !camera.has("f_stop") {
        return Err(Error::new(
            camera.key_path("focus_distance_m"),
            "found no opening that it belongs to",
            "give the camera an `aperture_mm` or an `f_stop`, or leave it out: all is in focus then",
        ));
    }
    Ok(given)
}

/// Width of the film of a 35 mm camera.
pub(super) fn full_frame_mm() -> f64 {
    Camera::SENSOR_WIDTH_MM.initial()
}

/// Height of a film that is `sensor_mm` wide and has the shape of the picture.
pub(super) fn film_height_mm(sensor_mm: f64, [width, height]: [u32; 2]) -> f64 {
    sensor_mm * f64::from(height) / f64::from(width.max(1))
}

/// Vertical field of view of a lens before such a film.
pub(super) fn seen_deg(focal_length_mm: f64, sensor_mm: f64, size_px: [u32; 2]) -> f64 {
    let height_mm = film_height_mm(sensor_mm, size_px);
    2.0 * (0.5 * height_mm / focal_length_mm).atan().to_degrees()
}
