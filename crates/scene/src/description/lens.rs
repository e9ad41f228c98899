//! The field of view of a `[camera]` and its opening by its lens, as cameras have it.

use glam::DVec2;

use super::Camera;
use super::ranges::found;
use super::table::Table;
use crate::error::Error;
use crate::scene::Lens;
use crate::schema::camera as keys;

/// The table that has the keys of a lens.
const SECTION: &str = "camera";
/// `fov_y_deg` beside a lens may be rounded by this.
const ROUNDING_DEG: f64 = 0.05;

/// `aperture_mm` beside an f-stop may be rounded by this share.
const ROUNDING: f64 = 1e-3;

/// Reads the vertical field of view of a `[camera]` that states it by its lens. The sensor is as wide as the picture.
pub(super) fn fov_y_deg(camera: &Table, [width, height]: [u32; 2]) -> Result<Option<f64>, Error> {
    let Some(focal_length_mm) = camera.value::<Option<f64>>(&keys::FOCAL_LENGTH_MM)? else {
        return Ok(None);
    };
    let sensor_mm = camera.value(&keys::SENSOR_WIDTH_MM)?;
    keys::FOCAL_LENGTH_MM.check(SECTION, &focal_length_mm)?;
    keys::SENSOR_WIDTH_MM.check(SECTION, &sensor_mm)?;
    let fov_y_deg = seen_deg(focal_length_mm, sensor_mm, [width, height]);
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

/// The diameter of the opening of a `[camera]`, if it has one: as it is, or by its f-stop.
pub(super) fn aperture_mm(camera: &Table) -> Result<Option<f64>, Error> {
    let given = camera.optional::<f64>("aperture_mm")?;
    let Some(f_stop) = camera.optional::<f64>("f_stop")? else {
        return Ok(given);
    };
    keys::F_STOP.check(SECTION, &f_stop)?;
    let Some(focal_length_mm) = camera.optional::<f64>("focal_length_mm")? else {
        return Err(Error::new(
            camera.way("f_stop"),
            "found no `focal_length_mm` that it belongs to",
            "give the camera one, or `aperture_mm` in place of the f-stop",
        ));
    };
    let aperture_mm = focal_length_mm / f_stop;
    match given {
        Some(given) if (given / aperture_mm - 1.0).abs() > ROUNDING => Err(Error::new(
            camera.way("aperture_mm"),
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
            camera.way("focus_distance_m"),
            "found no opening that it belongs to",
            "give the camera an `aperture_mm` or an `f_stop`, or leave it out: all is in focus then",
        ));
    }
    Ok(given)
}

/// Width of the film of a 35 mm camera.
fn full_frame_mm() -> f64 {
    keys::SENSOR_WIDTH_MM.initial()
}

/// Height of a film that is `sensor_mm` wide and has the shape of the picture.
fn film_height_mm(sensor_mm: f64, [width, height]: [u32; 2]) -> f64 {
    sensor_mm * f64::from(height) / f64::from(width.max(1))
}

/// Vertical field of view of a lens before such a film.
fn seen_deg(focal_length_mm: f64, sensor_mm: f64, size_px: [u32; 2]) -> f64 {
    let height_mm = film_height_mm(sensor_mm, size_px);
    2.0 * (0.5 * height_mm / focal_length_mm).atan().to_degrees()
}

impl Camera {
    /// Width of the film.
    pub fn sensor_mm(&self) -> f64 {
        self.sensor_width_mm.unwrap_or(full_frame_mm())
    }

    /// Focal length with the camera's field of view, for a picture of this size.
    pub fn focal_length_mm(&self, size_px: [u32; 2]) -> f64 {
        let height_mm = film_height_mm(self.sensor_mm(), size_px);
        0.5 * height_mm / (0.5 * self.fov_y_deg.to_radians()).tan()
    }

    /// Focal length over opening; none of a pinhole.
    pub fn f_stop(&self, size_px: [u32; 2]) -> Option<f64> {
        let aperture_mm = self.aperture_mm.filter(|mm| *mm > 0.0)?;
        Some(self.focal_length_mm(size_px) / aperture_mm)
    }

    /// Puts on a lens of another focal length, as far as fields of view go. The f-stop stays, as on a zoom lens.
    pub fn set_focal_length_mm(&mut self, focal_length_mm: f64, size_px: [u32; 2]) {
        let f_stop = self.f_stop(size_px);
        self.see_by(focal_length_mm, size_px);
        if let Some(f_stop) = f_stop {
            self.set_f_stop(f_stop, size_px);
        }
    }

    /// Puts a wider or narrower film behind the lens, whose focal length and opening stay.
    pub fn set_sensor_width_mm(&mut self, sensor_mm: f64, size_px: [u32; 2]) {
        let focal_length_mm = self.focal_length_mm(size_px);
        self.sensor_width_mm = (sensor_mm != full_frame_mm()).then_some(sensor_mm);
        self.see_by(focal_length_mm, size_px);
    }

    /// Opens or closes the lens, as far as openings go.
    pub fn set_f_stop(&mut self, f_stop: f64, size_px: [u32; 2]) {
        let aperture_mm = self.focal_length_mm(size_px) / f_stop;
        self.aperture_mm = Some(keys::APERTURE_MM.bounds.clamp(aperture_mm));
    }

    fn see_by(&mut self, focal_length_mm: f64, size_px: [u32; 2]) {
        let fov_y_deg = seen_deg(focal_length_mm, self.sensor_mm(), size_px);
        self.fov_y_deg = keys::FOV_Y_DEG.bounds.clamp(fov_y_deg);
    }

    /// Shift of the picture at unit depth.
    pub fn shift_tan(&self) -> DVec2 {
        let height_tan = 2.0 * (0.5 * self.fov_y_deg.to_radians()).tan();
        height_tan * DVec2::from(self.shift.unwrap_or_default())
    }

    /// Thin lens of the camera.
    pub fn lens(&self) -> Lens {
        let [position, target] = [self.position_m, self.target_m].map(glam::DVec3::from);
        Lens {
            radius_m: 0.5e-3 * self.aperture_mm.unwrap_or(0.0),
            focus_m: self
                .focus_distance_m
                .unwrap_or_else(|| position.distance(target)),
        }
    }
}
