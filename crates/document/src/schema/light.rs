//! The keys of `[[light]]`.

use super::key::{Form, Initial, Key, linear, log};
use super::section::{Choice, Section};

/// The angle that the sun spans as the earth sees it, degrees.
pub const SUN_DEG: f64 = 0.53;

/// `[[light]]`
pub static LIGHT: Section = Section::many("light", "Light", "one of the kinds below.", &[&NAME, &HIDDEN, &EXPOSURE_EV, &TEMPERATURE_K, &COLOR, &BARN_DOORS_DEG, &PICTURE]).kinds("kind", &[
    Choice::new("sphere", "A sphere.", &[&CENTER_M, &RADIUS_M, &CONE_TARGET_M, &RADIANCE, &VISIBLE, &CONE_DEG, &CONE_SOFTNESS]),
    Choice::new("disk", "Flat and round; it faces the target and shines to its side.", &[&CENTER_M, &TARGET_M, &RADIUS_M, &TWO_SIDED, &RADIANCE, &VISIBLE, &CONE_DEG, &CONE_SOFTNESS]),
    Choice::new("rectangle", "It faces the target and shines to its side.", &[&CENTER_M, &TARGET_M, &WIDTH_M, &HEIGHT_M, &ROTATION_DEG, &TWO_SIDED, &RADIANCE, &VISIBLE, &CONE_DEG, &CONE_SOFTNESS]),
    Choice::new("polygon", "Flat; it shines to the side that sees its vertices counter-clockwise.", &[&VERTICES_M, &TWO_SIDED, &RADIANCE, &VISIBLE, &CONE_DEG, &CONE_SOFTNESS]),
    Choice::new("tube", "A straight lamp with round ends, all around: what is within the radius of the line. It lights nothing that is within it.", &[&ENDS_M, &RADIUS_M, &CONE_TARGET_M, &RADIANCE, &VISIBLE, &CONE_DEG, &CONE_SOFTNESS]),
    Choice::new("sun", "A sun stands in one direction for all of the scene: a round lamp 100 km off.", &[&DIRECTION, &ANGLE_DEG, &IRRADIANCE]),
]);

pub static NAME: Key = Key::new("name", Form::Text)
    .none()
    .range_words("any text")
    .means("For you to know the light by.");

pub static HIDDEN: Key = Key::new("hidden", Form::Flag)
    .flag(false)
    .means("Lights nothing, as if it were not there.");

pub static VISIBLE: Key = Key::new("visible", Form::Flag)
    .flag(false)
    .means("Whether the camera sees its shape, as bright as its `radiance`; of flat ones the side that shines. It hides no other light, and is in reflections either way. Not of a sun.");

pub static RADIANCE: Key = Key::new("radiance", Form::Number)
    .unit("W sr⁻¹ m⁻²")
    .number(1.0)
    .at_least_0()
    .means("Brightness of its surface. A smaller light of the same radiance lights less. Not of a sun, which has `irradiance`.")
    .control("Radiance", log(0.01, 1000.0), "Brightness of the light as it is seen. 40 to 200 for small lamps in dim surroundings lets the highlight clip and its scratches glow.");

pub static EXPOSURE_EV: Key = Key::new("exposure_ev", Form::Number)
    .unit("stops")
    .number(0.0)
    .within(-64.0, 64.0)
    .means("The radiance, or the irradiance of a sun, is multiplied by 2^`exposure_ev`.")
    .control(
        "Stops",
        linear(-8.0, 8.0),
        "Each stop doubles the radiance: for balancing lights against one another.",
    );

pub static TEMPERATURE_K: Key = Key::new("temperature_k", Form::Number)
    .unit("K")
    .none()
    .within(1000.0, 40_000.0)
    .means("The colour of a black body: 2700 a warm bulb, 5600 a flash, 6500 daylight. The luminance stays; `color` is a filter before it.")
    .control("Temperature", linear(1800.0, 10_000.0), "Colour of a glowing body: 2700 K for a warm bulb, 5600 K for a flash, 6500 K for daylight. Brightness stays.");

pub static COLOR: Key = Key::new("color", Form::Color)
    .unit("linear RGB")
    .is(Initial::Numbers(&[1.0, 1.0, 1.0]))
    .at_least_0()
    .means("Factor on the radiance; white has the spectrum of daylight (D65).")
    .control("Colour", linear(0.0, 1.0), "Tint of the light. Scratches split what is in it: white light shows every colour, a warm one fewer blues.");

pub static CENTER_M: Key = Key::new("center_m", Form::Numbers(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .means("Its middle.")
    .control("Position", linear(-5.0, 5.0).sized(), "Where the light hangs. Around its highlight those scratches light up that run crosswise to the way there.");

const TARGET: Key = Key::new("target_m", Form::Numbers(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .control(
        "Target",
        linear(-5.0, 5.0).sized(),
        "A point that the light faces. Its distance does not matter.",
    );

pub static TARGET_M: Key = TARGET.means("A point before it on its axis: it shines to that side.");

pub static CONE_TARGET_M: Key = TARGET
    .none()
    .range_words("with `cone_deg`, which needs it")
    .means("What the cone points to.");

pub static RADIUS_M: Key = Key::new("radius_m", Form::Number)
    .unit("m")
    .size()
    .means("Its radius.")
    .control("Radius", log(2e-3, 1.0).sized(), "Small lights give pure rainbows and hard-edged glints; large ones overlap the colours to white around the highlight. At the same radiance a larger one also lights more.");

pub static WIDTH_M: Key = Key::new("width_m", Form::Number)
    .unit("m")
    .size()
    .means("From side to side, across the height.")
    .control(
        "Width",
        log(2e-3, 1.0).sized(),
        "From side to side. Narrow lights keep colours pure across their width.",
    );

pub static HEIGHT_M: Key = Key::new("height_m", Form::Number)
    .unit("m")
    .size()
    .means("Along the direction in its plane that is nearest to y; to z, where it faces along y.")
    .control(
        "Height",
        log(2e-3, 1.0).sized(),
        "From lower to upper edge. Long lights fill more scratches with colour.",
    );

pub static ROTATION_DEG: Key = Key::new("rotation_deg", Form::Number)
    .unit("°")
    .number(0.0)
    .within(-360.0, 360.0)
    .means("Turns it about its axis, counter-clockwise as seen from the target.")
    .control(
        "Rotation",
        linear(-180.0, 180.0),
        "Turns the light about its axis, counter-clockwise as seen from its target.",
    );

pub static TWO_SIDED: Key = Key::new("two_sided", Form::Flag)
    .flag(false)
    .means("Whether the other side shines too.");

pub static VERTICES_M: Key = Key::new("vertices_m", Form::Points(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .range_words("3 to 4096 points, ±1000 each")
    .means("Its corners, in one plane and without crossing edges, convex or not. It shines to the side that sees them counter-clockwise.")
    .control("Corner", linear(-5.0, 5.0).sized(), "A corner of the light. Its outline is mirrored in the surface, and scratches draw it out; long, thin shapes keep colours pure across their short side.");

pub static ENDS_M: Key = Key::new("ends_m", Form::Points(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .range_words("two points, ±1000 each")
    .means("The ends of the line.")
    .control("End", linear(-5.0, 5.0).sized(), "An end of the line within the tube. Scratches that run along the tube show colours across it.");

pub static DIRECTION: Key = Key::new("direction", Form::Numbers(3))
    .direction()
    .means("The way that its light goes, of any length.")
    .control(
        "Direction",
        linear(-1.0, 1.0),
        "The way that the light goes, from the sun to the scene. Its length does not matter.",
    );

pub static ANGLE_DEG: Key = Key::new("angle_deg", Form::Number)
    .unit("°")
    .number(SUN_DEG)
    .within(0.01, 90.0)
    .means("The angle that it spans, across; the default is that of the sun. A wider one sends as much.")
    .control("Angle", log(0.1, 10.0), "How wide it is as seen from the scene: the sun 0.53 degrees. A wider one blurs rainbows and the edges of shadows; the scene stays as bright.");

pub static IRRADIANCE: Key = Key::new("irradiance", Form::Number)
    .unit("W m⁻²")
    .number(1.0)
    .at_least_0()
    .means("What falls on a surface that faces it. 683 lux are 1 W m⁻². White paper under 3.14 has radiance 1.")
    .control("Irradiance", log(1e-3, 10.0), "What falls on a surface that faces the sun, W per square metre; 683 lux are 1. White paper under 3.14 is as bright as white gets.");

pub static CONE_DEG: Key = Key::new("cone_deg", Form::Number)
    .unit("°")
    .none()
    .within(0.1, 360.0)
    .means("A spot: the angle of its cone from rim to rim; no light outside. Flat lights point along their own axis. Not with `two_sided`, not of a sun.")
    .control("Cone", linear(5.0, 180.0), "The angle of the cone from rim to rim. Outside of it there is no light.");

pub static CONE_SOFTNESS: Key = Key::new("cone_softness", Form::Number)
    .number(0.1)
    .within(0.0, 1.0)
    .means("With `cone_deg`: the part of the way from rim to axis in which the light falls off, as KHR_lights_punctual has it.")
    .control("Softness", linear(0.0, 1.0), "The part of the way from rim to axis in which the light falls off.");

pub static PICTURE: Key = Key::new("picture", Form::File)
    .none()
    .range_words("`.png`, `.jpg`, `.webp`, `.hdr` or `.exr`")
    .means("Of a rectangle: a picture on the light, upright as seen from the target, relative to the scene file: what a soft box looks like. Its linear values are factors on the radiance; those of `.hdr` and `.exr` are kept in 8 bits relative to the brightest. What is transparent sends no light. Scratches, base, shadows and the camera see it.");

pub static BARN_DOORS_DEG: Key = Key::new("barn_doors_deg", Form::Numbers(4))
    .unit("°")
    .none()
    .within(0.0, 90.0)
    .range_words("four, 0 to 90 each")
    .means("Of a disk or a rectangle: barn doors: the angles between the axis and flaps that end the light, to the left, to the right, above and below as seen from the target. 90 is open. Light falls off in the last tenth of each angle. Not with `two_sided`.")
    .control("Barn door", linear(0.0, 90.0), "The angle between the light's axis and a flap that ends its light: left, right, above and below as seen from its target. 90 is open.");
