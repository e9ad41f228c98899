//! The keys of `[camera]`.

use super::key::{Form, Initial, Key, LARGEST_M, SMALLEST_M, linear, log};
use super::section::Section;

/// `[camera]`
pub static CAMERA: Section = Section::one(
    "camera",
    "Camera",
    "a pinhole, or a thin lens.",
    &[
        &POSITION_M,
        &TARGET_M,
        &UP,
        &FOV_Y_DEG,
        &FOCAL_LENGTH_MM,
        &SENSOR_WIDTH_MM,
        &EXPOSURE_EV,
        &APERTURE_MM,
        &F_STOP,
        &FOCUS_DISTANCE_M,
        &SHIFT,
        &WORLD_UP,
        &OF_FILE,
    ],
);

pub static POSITION_M: Key = Key::new("position_m", Form::Numbers(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .means("Where the camera is.")
    .control("Position", linear(-5.0, 5.0).sized(), "Where the camera stands. Scratches flash and change colour as it moves: each shows only to eyes in its own fan.");

pub static TARGET_M: Key = Key::new("target_m", Form::Numbers(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .range_words("±1000 each, not the position")
    .means("The point in the centre of the picture.")
    .control(
        "Target",
        linear(-5.0, 5.0).sized(),
        "The point in the middle of the picture; orbiting turns about it.",
    );

pub static UP: Key = Key::new("up", Form::Numbers(3))
    .is(Initial::Numbers(&[0.0, 1.0, 0.0]))
    .direction()
    .range_words("not zero, not along the view")
    .means("The direction that is up in the picture; any length. Write `[0, 0, 1]` for a z-up scene. If the camera looks straight down along Y or Z, `up` only turns the picture, unless it is +Y or +Z, which also say the axis of the world that points up. `up = [0, 1, -0.1]` looks down on a y-up scene as well, with -Z up in the picture.")
    .control("Up", linear(-1.0, 1.0), "The direction that is up in the picture. Tilt it to roll the camera.");

pub static FOV_Y_DEG: Key = Key::new("fov_y_deg", Form::Number)
    .unit("°")
    .number(30.0)
    .within(0.001, 179.0)
    .means("Vertical field of view.")
    .control("Field of view", linear(5.0, 90.0), "Small: a long lens, flat, with highlights that spread over much of the surface. Large: a wide lens, with tighter highlights.");

pub static FOCAL_LENGTH_MM: Key = Key::new("focal_length_mm", Form::Number)
    .unit("mm")
    .none()
    .within(0.1, 10_000.0)
    .means("The field of view in the words of photographers; in place of `fov_y_deg`. Where both are given they must agree within 0.05 degrees.")
    .control("Focal length", log(0.014, 0.3), "The field of view as lenses tell it: 24 mm is wide, 50 mm what the eye is used to, 100 mm and more for details. The f-stop stays.");

pub static SENSOR_WIDTH_MM: Key = Key::new("sensor_width_mm", Form::Number)
    .unit("mm")
    .number(36.0)
    .within(0.1, 1000.0)
    .means("How wide the film is, that is, the picture of `size_px`: what focal lengths and f-stops count by, in this file and in the viewer.")
    .control("Sensor width", linear(0.005, 0.06), "How wide the film behind the lens is: 36 mm for full frame, 23.5 mm for APS-C, 6 mm for a phone. The focal length stays, so a narrower film sees less.");

pub static EXPOSURE_EV: Key = Key::new("exposure_ev", Form::Number)
    .unit("stops")
    .number(0.0)
    .within(-64.0, 64.0)
    .means("Radiances are multiplied by 2^`exposure_ev` before the tone map.")
    .control("Exposure", linear(-8.0, 8.0), "Each step doubles or halves the brightness. High enough for the core of a highlight to wash out softly, low enough to keep the colours around it.");

pub static APERTURE_MM: Key = Key::new("aperture_mm", Form::Number)
    .unit("mm")
    .none()
    .within(0.0, 1000.0)
    .means("Diameter of the lens's opening; none, or 0: a pinhole.")
    .control("Opening", linear(1e-3, 0.1).sized(), "Diameter of the lens's opening: the larger, the sooner things blur before and behind what is in focus. The focal length over the f-stop.");

pub static F_STOP: Key = Key::new("f_stop", Form::Number)
    .none()
    .within(0.1, 1000.0)
    .means("The opening in the words of photographers, in place of `aperture_mm`: `focal_length_mm` over this, both needed. Where both are given they must agree within 0.1 %.")
    .control("F-stop", log(1.4, 22.0), "The focal length over the diameter of the opening: 1.4 to 2.8 blurs all but what is in focus, 11 to 22 keeps most of it sharp.");

pub static FOCUS_DISTANCE_M: Key = Key::new("focus_distance_m", Form::Number)
    .unit("m")
    .words("the distance of the target")
    .within(SMALLEST_M, LARGEST_M)
    .means("With an opening: how far away things are sharp, along the view.")
    .control(
        "Focus",
        linear(0.1, 5.0).sized(),
        "How far away things are sharp, along the view.",
    );

pub static SHIFT: Key = Key::new("shift", Form::Numbers(2))
    .unit("heights of the picture")
    .none()
    .within(-10.0, 10.0)
    .range_words("two numbers, ±10 each")
    .means("Moves the picture across what the lens shows, to the right and up, as a view camera does: `[0, 0.1]` shows a tenth of the picture's height more above and less below, and upright lines stay parallel. The target is off the centre by as much the other way.");

pub static WORLD_UP: Key = Key::new("world_up", Form::Name(&["y", "z"]))
    .words("the axis nearest to `up`")
    .means("The axis of the world that points up, for a camera that is rolled or looks steeply down: models stand and environments have their top by it, whatever is up in the picture.");

pub static OF_FILE: Key = Key::new("of_file", Form::Text)
    .none()
    .range_words("name or number")
    .means("A camera of a model's file in the place of `position_m`, `target_m` and `fov_y_deg`: its name, its node's, or its number from 0. `up` says which axis the models stand by.");
