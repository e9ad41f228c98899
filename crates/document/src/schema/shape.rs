//! The keys of `shape` of an `[[object]]`.

use super::key::{Bounds, Form, Key, LARGEST_M, linear, log};
use super::section::{Choice, Section};

/// Each is a table of its own: `shape = { disk = { radius_m = 0.1 } }`.
pub static SHAPE: Section = Section::many("shape", "", "a built-in shape.", &[]).kinds("", &[
    Choice::new("plane", "A rectangle in the xy plane that faces +z.", &[&PLANE_SIZE_M]),
    Choice::new("disk", "A disk in the xy plane that faces +z.", &[&RADIUS_M]),
    Choice::new("sphere", "A sphere.", &[&RADIUS_M]),
    Choice::new("box", "A box about the origin.", &[&BOX_SIZE_M, &BOX_ROUNDING_M]),
    Choice::new("cylinder", "Closed, about the origin and the z axis.", &[&RADIUS_M, &HEIGHT_M, &CYLINDER_ROUNDING_M]),
    Choice::new("torus", "A ring about z.", &[&RING_RADIUS_M, &TUBE_RADIUS_M]),
    Choice::new("dome", "A watch glass: the part of a sphere over its rim, which lies in the xy plane. Open below.", &[&RADIUS_M, &DOME_HEIGHT_M]),
    Choice::new("sweep", "A studio's floor, about the origin, which turns up into a wall at its +y end.", &[&PLANE_SIZE_M, &HEIGHT_M, &SWEEP_ROUNDING_M]),
    Choice::new("text", "Letters that stand on the xy plane, read from +z: a logo. Its middle is over the origin.", &[&LINE, &CAPITALS_M, &DEPTH_M]),
    Choice::new("lathe", "A profile turned about the z axis: a plate, a pan, a ring.", &[&PROFILE_M, &SEGMENTS, &SMOOTH]),
]);

/// An edge along each of so many axes.
const fn edges(count: usize) -> Key {
    Key::new("size_m", Form::Numbers(count))
    .unit("m")
    .size()
    .control("Edge", log(0.05, 5.0).sized(), "Length of an edge. With a count, the same scratches spread over more surface; with a density, there are more of them.")
}

const RADIUS: Key = Key::new("radius_m", Form::Number)
    .unit("m")
    .size()
    .control("Radius", log(0.05, 5.0).sized(), "Half its width. With a count, the same scratches spread over more surface; with a density, there are more of them.");

const HEIGHT: Key = Key::new("height_m", Form::Number).unit("m").size().control(
    "Height",
    log(0.05, 5.0).sized(),
    "From its lower to its upper end.",
);

const ROUNDING: Key = Key::new("rounding_m", Form::Number)
    .unit("m")
    .within(0.0, LARGEST_M)
    .control("Rounding", linear(0.0, 0.5).sized(), "Radius of its edges. Rounded edges catch a line of light from almost everywhere; 0 leaves them sharp and dark.");

pub static PLANE_SIZE_M: Key = edges(2).means("Its edges along x and y.");

pub static RADIUS_M: Key = RADIUS.means("Its radius.");

pub static BOX_SIZE_M: Key = edges(3).means("Its edges along x, y and z.");

pub static BOX_ROUNDING_M: Key = ROUNDING
    .number(0.0)
    .range_words("0 to half of the shortest edge")
    .means("Radius of its edges and corners. Each side has the whole texture.");

pub static HEIGHT_M: Key = HEIGHT.means("From its lower to its upper end.");

pub static CYLINDER_ROUNDING_M: Key = ROUNDING
    .number(0.0)
    .range_words("0 to the radius and half of the height")
    .means("Radius of its rims.");

pub static TUBE_RADIUS_M: Key = Key::new("tube_radius_m", Form::Number)
    .unit("m")
    .size()
    .range_words("1e-5 to below `radius_m`")
    .means("The radius of the tube.")
    .control("Tube radius", log(0.01, 1.0).sized(), "Half the thickness of the ring, below its radius. A thin tube draws highlights out to fine lines.");

pub static RING_RADIUS_M: Key = RADIUS.means("From the axis to the middle of the tube.");

pub static DOME_HEIGHT_M: Key = HEIGHT
    .range_words("1e-5 to `radius_m`")
    .means("The height of the top over the rim.");

pub static SWEEP_ROUNDING_M: Key = ROUNDING
    .words("half of the most")
    .range_words("0 to the height and the floor's extent along y")
    .means("Radius of the turn.");

pub static LINE: Key = Key::new("line", Form::Text)
    .range_words("1 to 200 characters")
    .means("The letters. The font is built in, Ubuntu Light: Latin, Greek, Cyrillic.");

pub static CAPITALS_M: Key = HEIGHT.means("The height of capitals, along y.");

pub static DEPTH_M: Key = Key::new("depth_m", Form::Number)
    .unit("m")
    .size()
    .means("The depth of all letters, along z.")
    .control(
        "Depth",
        log(0.01, 1.0).sized(),
        "How far the letters stand out of what they stand on.",
    );

pub static PROFILE_M: Key = Key::new("profile_m", Form::Points(2))
    .unit("m")
    .within(0.0, LARGEST_M)
    .range_words("two or more points `[r, z]`, r from 0 to 1000")
    .means("The profile that is turned.")
    .control("Radius", linear(0.0, 1.0).sized(), "Distance of this point of the outline from the axis. Steps and bends of the outline show as rings of highlight.")
    .second("Height", linear(-1.0, 1.0).sized(), Bounds::Within(-LARGEST_M, LARGEST_M), "m", "Height of this point of the outline along the axis.");

pub static SEGMENTS: Key = Key::new("segments", Form::Whole)
    .number(256.0)
    .within(3.0, 4096.0)
    .means("Facets around.")
    .control("Segments", linear(16.0, 512.0), "Facets around the axis. More: a rounder outline and smoother highlights, and a little more work.");

pub static SMOOTH: Key = Key::new("smooth", Form::Flag)
    .flag(true)
    .means("Rounds the profile where it bends by less than 40 degrees; sharper corners stay.");
