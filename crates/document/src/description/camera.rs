//! The camera as an author writes it.

use glam::{DVec2, DVec3};
use hairline_keys::Keyed;
use hairline_scene::{Lens, scene};

use super::ranges::{Check, found};
use super::table::Table;
use super::{Up, lens};
use crate::error::Error;
use crate::schema::key::log;
use crate::schema::{Form, Key, SMALLEST_M};
use crate::upright::vertical_axis;

/// `[camera]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, check = Camera::check_view)]
pub struct Camera {
    /// Where the camera is.
    #[key(unit("m").in_range(-1000.0, 1000.0)
        .control("Position", linear(-5.0, 5.0).sized(), "Where the camera stands. Scratches flash and change colour as it moves: each shows only to eyes in its own fan."))]
    #[read(position_m)]
    pub position_m: [f64; 3],
    /// The point in the centre of the picture.
    #[key(unit("m").in_range(-1000.0, 1000.0).range_words("±1000 each, not the position")
        .control("Target", linear(-5.0, 5.0).sized(), "The point in the middle of the picture; orbiting turns about it."))]
    #[read(target_m)]
    pub target_m: [f64; 3],
    /// The direction that is up in the picture; any length. Write `[0, 0, 1]` for a z-up scene. If the camera looks straight down along Y or Z, `up`
    /// only turns the picture, unless it is +Y or +Z, which also say the axis of the world that points up. `up = [0, 1, -0.1]` looks down on a y-up
    /// scene as well, with -Z up in the picture.
    #[key(is(Initial::Numbers(&[0.0, 1.0, 0.0])).direction().range_words("not zero, not along the view")
        .control("Up", linear(-1.0, 1.0), "The direction that is up in the picture. Tilt it to roll the camera."))]
    pub up: [f64; 3],
    /// Vertical field of view.
    #[key(unit("°").number(30.0).in_range(0.001, 179.0)
        .control("Field of view", linear(5.0, 90.0), "Small: a long lens, flat, with highlights that spread over much of the surface. Large: a wide lens, with tighter highlights."))]
    #[then(Camera::FOCAL_LENGTH_MM)]
    pub fov_y_deg: f64,
    /// How wide the film is, that is, the picture of `size_px`: what focal lengths and f-stops count by, in this file and in the viewer.
    #[key(unit("mm").number(36.0).in_range(0.1, 1000.0)
        .control("Sensor width", linear(0.005, 0.06), "How wide the film behind the lens is: 36 mm for full frame, 23.5 mm for APS-C, 6 mm for a phone. The focal length stays, so a narrower film sees less."))]
    pub sensor_width_mm: Option<f64>,
    /// Radiances are multiplied by 2^`exposure_ev` before the tone map.
    #[key(unit("stops").number(0.0).in_range(-64.0, 64.0)
        .control("Exposure", linear(-8.0, 8.0), "Each step doubles or halves the brightness. High enough for the core of a highlight to wash out softly, low enough to keep the colours around it."))]
    pub exposure_ev: f64,
    /// Diameter of the lens's opening; none, or 0: a pinhole.
    #[key(unit("mm").none().in_range(0.0, 1000.0)
        .control("Opening", linear(1e-3, 0.1).sized(), "Diameter of the lens's opening: the larger, the sooner things blur before and behind what is in focus. The focal length over the f-stop."))]
    #[read(aperture_mm)]
    #[then(Camera::F_STOP)]
    pub aperture_mm: Option<f64>,
    /// With an opening: how far away things are sharp, along the view.
    #[key(unit("m").words("the distance of the target").in_range(SMALLEST_M, LARGEST_M)
        .control("Focus", linear(0.1, 5.0).sized(), "How far away things are sharp, along the view."))]
    #[read(focus_distance_m)]
    pub focus_distance_m: Option<f64>,
    /// Moves the picture across what the lens shows, to the right and up, as a view camera does: `[0, 0.1]` shows a tenth of the picture's height
    /// more above and less below, and upright lines stay parallel. The target is off the centre by as much the other way.
    #[key(unit("heights of the picture").none().in_range(-10.0, 10.0).range_words("two numbers, ±10 each"))]
    pub shift: Option<[f64; 2]>,
    /// The axis of the world that points up, for a camera that is rolled or looks steeply down: models stand and environments have their top by it,
    /// whatever is up in the picture.
    #[key(words("the axis nearest to `up`"))]
    pub world_up: Option<Up>,
    /// A camera of a model's file in the place of `position_m`, `target_m` and `fov_y_deg`: its name, its node's, or its number from 0. `up` says
    /// which axis the models stand by.
    #[key(none().range_words("name or number"))]
    pub of_file: Option<String>,
}

impl Default for Camera {
    /// At the origin, looking nowhere yet; all other keys as a file that leaves them out.
    fn default() -> Self {
        Self {
            position_m: [0.0; 3],
            target_m: [0.0; 3],
            up: Self::UP.initial(),
            fov_y_deg: Self::FOV_Y_DEG.initial(),
            sensor_width_mm: None,
            exposure_ev: Self::EXPOSURE_EV.initial(),
            aperture_mm: None,
            focus_distance_m: None,
            shift: None,
            world_up: None,
            of_file: None,
        }
    }
}

/// Keys that other ones are made of.
impl Camera {
    /// The field of view in the words of photographers.
    pub const FOCAL_LENGTH_MM: &'static Key = &Key::new("focal_length_mm", Form::Number)
        .unit("mm")
        .none()
        .in_range(0.1, 10_000.0)
        .means("The field of view in the words of photographers; in place of `fov_y_deg`. Where both are given they must agree within 0.05 degrees.")
        .control("Focal length", log(0.014, 0.3), "The field of view as lenses tell it: 24 mm is wide, 50 mm what the eye is used to, 100 mm and more for details. The f-stop stays.");

    /// The opening in the words of photographers.
    pub const F_STOP: &'static Key = &Key::new("f_stop", Form::Number)
        .none()
        .in_range(0.1, 1000.0)
        .means("The opening in the words of photographers, in place of `aperture_mm`: `focal_length_mm` over this, both needed. Where both are given they must agree within 0.1 %.")
        .control("F-stop", log(1.4, 22.0), "The focal length over the diameter of the opening: 1.4 to 2.8 blurs all but what is in focus, 11 to 22 keeps most of it sharp.");
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
        self.sensor_width_mm
            .unwrap_or(Self::SENSOR_WIDTH_MM.initial())
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
        self.sensor_width_mm =
            (sensor_mm != Self::SENSOR_WIDTH_MM.initial::<f64>()).then_some(sensor_mm);
        self.see_by(focal_length_mm, size_px);
    }

    /// Opens or closes the lens, as far as openings go.
    pub fn set_f_stop(&mut self, f_stop: f64, size_px: [u32; 2]) {
        let aperture_mm = self.focal_length_mm(size_px) / f_stop;
        self.aperture_mm = Some(Self::APERTURE_MM.bounds.clamp(aperture_mm));
    }

    fn see_by(&mut self, focal_length_mm: f64, size_px: [u32; 2]) {
        let fov_y_deg = lens::seen_deg(focal_length_mm, self.sensor_mm(), size_px);
        self.fov_y_deg = Self::FOV_Y_DEG.bounds.clamp(fov_y_deg);
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

    /// Refuses a camera that looks nowhere.
    fn check_view(&self, key: &str) -> Check {
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

fn position_m(table: &Table) -> Result<[f64; 3], Error> {
    place(table, Camera::POSITION_M, [0.0; 3])
}

fn target_m(table: &Table) -> Result<[f64; 3], Error> {
    place(table, Camera::TARGET_M, [1.0; 3])
}

/// A place of the camera; until the file of another camera is read, anywhere.
fn place(table: &Table, key: &Key, anywhere: [f64; 3]) -> Result<[f64; 3], Error> {
    match table.has(Camera::OF_FILE.name) {
        true => table.or(key.name, anywhere),
        false => table.value(key),
    }
}

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
    let fov_y_deg = lens::seen_deg(focal_length_mm, sensor_mm, [width, height]);
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
