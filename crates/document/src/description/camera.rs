//! The camera as an author writes it.

use glam::{DVec2, DVec3};
use hairline_scene::{Lens, scene};
use serde::Serialize;

use super::ranges::Check;
use super::table::{Read, Table, Value};
use super::{Up, lens};
use crate::error::Error;
use crate::schema::{SMALLEST_M, camera};
use crate::upright::vertical_axis;

/// `[camera]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Camera {
    /// Camera of a model's file, used in place of this one: its name, that of its node, or its number. The exposure and the lens
    /// are of this one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of_file: Option<String>,
    /// The pinhole. Required without `of_file`.
    pub position_m: [f64; 3],
    /// The point in the centre of the picture. Required without `of_file`.
    pub target_m: [f64; 3],
    /// The direction that is up in the picture.
    pub up: [f64; 3],
    /// Vertical field of view, above 0 and below 180. A file may give `focal_length_mm` and `sensor_width_mm` instead.
    pub fov_y_deg: f64,
    /// Width of the film, that is, of the picture; focal lengths and f-stops refer to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensor_width_mm: Option<f64>,
    /// Radiances are multiplied by 2^exposure_ev before the tone map.
    pub exposure_ev: f64,
    /// Diameter of the lens's opening. A file may give `f_stop` beside `focal_length_mm` instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aperture_mm: Option<f64>,
    /// With `aperture_mm`: the distance along the view at which the picture is sharp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focus_distance_m: Option<f64>,
    /// How far the picture is moved across what the lens shows, to the right and up, in heights of the picture; the target is off
    /// its centre by as much the other way.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f64; 2]>,
    /// The axis of the world that points up, for cameras that are rolled or look down.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub world_up: Option<Up>,
}

impl Default for Camera {
    /// At the origin, looking nowhere yet; all other keys as a file that leaves them out.
    fn default() -> Self {
        Self {
            of_file: None,
            position_m: [0.0; 3],
            target_m: [0.0; 3],
            up: camera::UP.initial(),
            fov_y_deg: camera::FOV_Y_DEG.initial(),
            sensor_width_mm: None,
            exposure_ev: camera::EXPOSURE_EV.initial(),
            aperture_mm: None,
            focus_distance_m: None,
            shift: None,
            world_up: None,
        }
    }
}

impl Camera {
    /// This camera, with its lens and its exposure, at the place of another one, with the other's target and field of view.
    pub fn moved_to(&self, place: &Self) -> Self {
        Self {
            of_file: place.of_file.clone(),
            position_m: place.position_m,
            target_m: place.target_m,
            fov_y_deg: place.fov_y_deg,
            ..self.clone()
        }
    }

    /// The axis of the world that points up. Where the camera does not say it, the one nearest to `up`; where it looks straight down, that which
    /// it looks along.
    pub fn world_up(&self) -> DVec3 {
        if let Some(up) = self.world_up {
            return up.axis();
        }
        let view = DVec3::from(self.target_m) - DVec3::from(self.position_m);
        vertical_axis(self.up.into(), view)
    }

    /// Width of the film.
    pub fn sensor_mm(&self) -> f64 {
        self.sensor_width_mm.unwrap_or(lens::full_frame_mm())
    }

    /// Focal length with the camera's field of view, for a picture of this size.
    pub fn focal_length_mm(&self, size_px: [u32; 2]) -> f64 {
        let height_mm = lens::film_height_mm(self.sensor_mm(), size_px);
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
        self.sensor_width_mm = (sensor_mm != lens::full_frame_mm()).then_some(sensor_mm);
        self.see_by(focal_length_mm, size_px);
    }

    /// Opens or closes the lens, as far as openings go.
    pub fn set_f_stop(&mut self, f_stop: f64, size_px: [u32; 2]) {
        let aperture_mm = self.focal_length_mm(size_px) / f_stop;
        self.aperture_mm = Some(camera::APERTURE_MM.bounds.clamp(aperture_mm));
    }

    fn see_by(&mut self, focal_length_mm: f64, size_px: [u32; 2]) {
        let fov_y_deg = lens::seen_deg(focal_length_mm, self.sensor_mm(), size_px);
        self.fov_y_deg = camera::FOV_Y_DEG.bounds.clamp(fov_y_deg);
    }

    /// Shift of the picture at unit depth.
    pub fn shift_tan(&self) -> DVec2 {
        let height_tan = 2.0 * (0.5 * self.fov_y_deg.to_radians()).tan();
        height_tan * DVec2::from(self.shift.unwrap_or_default())
    }

    /// Thin lens of the camera.
    pub fn lens(&self) -> Lens {
        let [position, target] = [self.position_m, self.target_m].map(DVec3::from);
        Lens {
            radius_m: 0.5e-3 * self.aperture_mm.unwrap_or(0.0),
            focus_m: self
                .focus_distance_m
                .unwrap_or_else(|| position.distance(target)),
        }
    }

    /// Converts it to a camera of a scene.
    pub fn in_scene(&self) -> scene::Camera {
        scene::Camera {
            position_m: self.position_m.into(),
            target_m: self.target_m.into(),
            up: self.up.into(),
            fov_y_rad: self.fov_y_deg.to_radians(),
            shift_tan: self.shift_tan(),
            exposure_ev: self.exposure_ev,
            lens: self.lens(),
        }
    }

    pub(super) fn check_at(&self, key: &str) -> Check {
        camera::POSITION_M.check(key, &self.position_m)?;
        camera::TARGET_M.check(key, &self.target_m)?;
        camera::UP.check(key, &self.up)?;
        camera::EXPOSURE_EV.check(key, &self.exposure_ev)?;
        camera::FOV_Y_DEG.check(key, &self.fov_y_deg)?;
        camera::SENSOR_WIDTH_MM.check(key, &self.sensor_width_mm)?;
        camera::APERTURE_MM.check(key, &self.aperture_mm)?;
        camera::FOCUS_DISTANCE_M.check(key, &self.focus_distance_m)?;
        camera::SHIFT.check(key, &self.shift)?;
        let [position, target, up] = [self.position_m, self.target_m, self.up].map(DVec3::from);
        let view = target - position;
        if view.length() < SMALLEST_M {
            return Err(Error::new(
                format!("{key}.target_m"),
                "found the camera's own position",
                "must be another point, for the camera to look at",
            ));
        }
        // The picture's right direction is their cross product; below this angle it is made of rounding.
        const LEAST_ANGLE_RAD: f64 = 1e-6;
        if view.normalize().cross(up.normalize()).length() < LEAST_ANGLE_RAD {
            return Err(Error::new(
                format!("{key}.up"),
                "found the direction of view",
                "must be another direction",
            ));
        }
        Ok(())
    }
}

impl Read for Camera {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::of(&camera::CAMERA, value, key)?;
        let of_file: Option<String> = table.value(&camera::OF_FILE)?;
        // Until the file is read, anywhere.
        let [position_m, target_m] = match of_file {
            Some(_) => [
                table.or(camera::POSITION_M.name, [0.0; 3])?,
                table.or(camera::TARGET_M.name, [1.0; 3])?,
            ],
            None => [
                table.value(&camera::POSITION_M)?,
                table.value(&camera::TARGET_M)?,
            ],
        };
        Ok(Self {
            of_file,
            position_m,
            target_m,
            up: table.value(&camera::UP)?,
            fov_y_deg: table.value(&camera::FOV_Y_DEG)?,
            exposure_ev: table.value(&camera::EXPOSURE_EV)?,
            sensor_width_mm: table.value(&camera::SENSOR_WIDTH_MM)?,
            aperture_mm: lens::aperture_mm(&table)?,
            focus_distance_m: lens::focus_distance_m(&table)?,
            shift: table.value(&camera::SHIFT)?,
            world_up: table.value(&camera::WORLD_UP)?,
        })
    }
}
