//! The keys of `[[grating]]`.

use hairline_optics::scratch::DEPTH_MAX_NM;

use super::key::{Bounds, Form, Key, LARGEST_M, linear, log};
use super::place::{MIDDLE, RADII, TILE};
use super::scratches::{AXIS, CENTER_M as AXIS_CENTER_M, DIRECTION};
use super::section::{Choice, Section};

/// `[[grating]]`
pub static GRATING: Section = Section::many("grating", "Grating", "grooves side by side, finer than a pixel, that cover an object.", &[&OBJECT, &NAME, &HIDDEN, &PITCH_UM, &WIDTH_UM, &DEPTH_NM, &JITTER_UM, &THEORY, &SEED, &COVERAGE, &MASK, &TILE_M, &RADIUS_M]).kinds("pattern", &[
    Choice::new("parallel", "All along one direction.", &[&DIRECTION, &JITTER_DEG, &CENTER_M]),
    Choice::new("circular", "Around an axis.", &[&AXIS, &AXIS_CENTER_M, &JITTER_DEG]),
    Choice::new("radial", "Away from an axis.", &[&AXIS, &AXIS_CENTER_M, &JITTER_DEG]),
    Choice::new("spun", "Arcs of one curvature that leave the axis in all directions.", &[&AXIS, &AXIS_CENTER_M, &JITTER_DEG, &CURVATURE_PER_M]),
    Choice::new("swirl", "Around the middles of spots in rows, each over those before it: engine turning. The axis is that along which they are pressed into the surface.", &[&AXIS, &AXIS_CENTER_M, &JITTER_DEG, &SPACING_M]),
    Choice::new("uv", "Along the texture coordinates of the surface.", &[&ALONG, &DIRECTIONS, &JITTER_DEG, &CENTER_M]),
]);

pub static OBJECT: Key = Key::new("object", Form::Text)
    .range_words("name of an object")
    .means("What they cover.");

pub static NAME: Key = Key::new("name", Form::Text)
    .none()
    .range_words("any text")
    .means("For you to know it by.");

pub static HIDDEN: Key = Key::new("hidden", Form::Flag)
    .flag(false)
    .means("As if it were not there.");

pub static PITCH_UM: Key = Key::new("pitch_um", Form::Number)
    .unit("µm")
    .within(0.3, 50.0)
    .means("From one groove to the next: how far apart the orders are. 1.6 is a compact disc, 0.74 a DVD, 30 turned steel.")
    .control("Pitch", log(0.4, 50.0), "From one groove to the next. Fine rows throw wide rainbows far out, coarse ones narrow rainbows close to the highlight. Disc 1.6, DVD 0.74, turned steel 30.");

pub static WIDTH_UM: Key = Key::new("width_um", Form::Number)
    .unit("µm")
    .words("0.4 of the pitch")
    .above_0(50.0)
    .range_words("above 0, up to the pitch")
    .means("Width of each groove: how bright the further orders are.")
    .control("Groove width", log(0.1, 20.0), "How much of the pitch is groove. Half of it gives the brightest first order and no second one; narrow grooves send more light to far orders.");

pub static DEPTH_NM: Key = Key::new("depth_nm", Form::Sizes)
    .unit("nm")
    .number(120.0)
    .within(0.0, DEPTH_MAX_NM)
    .range_words("mean 0 to 2000, spread 0 to 1")
    .means("Depth: how much light goes into orders, and which colours. Normal; the spread is a share of the mean.")
    .control("Depth", linear(20.0, 600.0), "Picks the overall tint, also close to the highlight: each depth favours some wavelengths and cancels others. Very shallow scratches are faint and bluish. Seen or lit aslant they act shallower, so tints shift as things turn.")
    .second("Depth spread", linear(0.0, 0.5), Bounds::Within(0.0, 1.0), "", "How much the depths of grooves differ, as a share of the mean. It weakens the rainbows and adds a white sheen that single grooves send.");

pub static JITTER_UM: Key = Key::new("jitter_um", Form::Number)
    .unit("µm")
    .number(0.0)
    .within(0.0, 50.0)
    .range_words("0 to the pitch")
    .means("Standard deviation of how far a groove is off its place. A tenth of the pitch leaves the first order two thirds of its light; a quarter turns rows into so many single scratches.")
    .control("Displacement", linear(0.0, 5.0), "How far grooves are off their places. A tenth of the pitch keeps two thirds of the first rainbow; at a quarter all grooves shine for themselves.");

pub static THEORY: Key = Key::new("theory", Form::Name(&["rigorous", "scalar"]))
    .text("rigorous")
    .means("How bright the orders of a pitch below 4 µm are. `\"rigorous\"` solves Maxwell's equations in the grooves for both polarisations, by the refractive index of the metal (of aluminium where a colour stands for one) or of the plastic. That takes about ten seconds for a grating, once: the result is kept in the user's folder for caches. `\"scalar\"` is the simpler theory that wider grooves have, to compare with. Mirrors and what lies in a clear coat are scalar always.");

pub static JITTER_DEG: Key = Key::new("jitter_deg", Form::Number)
    .unit("°")
    .number(0.0)
    .within(0.0, 90.0)
    .means("Standard deviation of a groove's angle to the pattern: streaks become fans.")
    .control("Angles", linear(0.0, 10.0), "How far grooves stray from the pattern's direction. 0 gives lines of light with hard edges; a degree or more makes soft fans of them.");

pub static SEED: Key = Key::new("seed", Form::Whole)
    .number(1.0)
    .at_least_0()
    .range_words("whole, below 2^63")
    .means("Which groove is off its place by how much, where grooves are seen one by one.")
    .control("Seed", linear(0.0, 1000.0), "Another number lays other scratches of the same kind, or puts the grooves of a grating in other places, as seen from nearby. Layers with different numbers do not repeat one another.");

pub static CURVATURE_PER_M: Key = Key::new("curvature_per_m", Form::Number)
    .unit("1/m")
    .number(20.0)
    .within(-1e4, 1e4)
    .means("One over the radius of the arcs; its sign is the sense of the spiral.")
    .control("Curvature", linear(-50.0, 50.0).sized_by(-1), "One over the radius of the arcs. 0 is straight. Bent scratches turn through many directions, so each lights up over a shorter piece, and more of them light up at once.");

pub static SPACING_M: Key = Key::new("spacing_m", Form::Number)
    .unit("m")
    .number(0.004)
    .size()
    .means("From spot to spot, and from row to row. Metres of the world, whatever the object's `scale`. The radius of a spot is 0.75 of it. Where spots are smaller than a pixel, it shows the mean of all their directions.")
    .control("Spacing", log(0.01, 0.5).sized(), "From one spot of grooves to the next. Each spot lies over those before it, so rows look like scales; lamps draw a line through each.");

pub static ALONG: Key = Key::new("along", Form::Name(&["u", "v"]))
    .text("u")
    .means("Along which texture coordinate they run.");

pub static DIRECTIONS: Key = Key::new("directions", Form::File)
    .none()
    .range_words("`.png`, `.jpg`, `.webp`")
    .means("A picture, relative to the scene file, that turns them, as anisotropy textures of glTF do: red is the part along the coordinate, green that up across it, from -1 (code 0) to 1 (code 255). Middle grey of both is no direction: no grooves.");

pub static COVERAGE: Key = Key::new("coverage", Form::Number)
    .number(1.0)
    .within(0.0, 1.0)
    .means("The share of the surface that the grooves cover.")
    .control(
        "Coverage",
        linear(0.0, 1.0),
        "The share of the surface that the grooves cover. The rest mirrors as the material does.",
    );

pub static MASK: Key = Key::new("mask", Form::File)
    .none()
    .range_words("as `directions`")
    .means("A picture whose values, from 0 (black) to 1 (white), are factors on the coverage: a motif in foil. From afar it is its mean over a pixel.");

pub static TILE_M: Key = TILE
    .range_words("1e-5 to 1000; with `mask`")
    .means("The mask is laid on the object along its own three axes, repeated, so wide; as in [`where`](#where) of scratches.");

pub static RADIUS_M: Key = RADII
    .means("The least and the greatest distance from the axis: grooves inside of a circle, outside of one, or in a ring. For `\"parallel\"` and `\"uv\"`, from `center_m`.")
    .control("Inner radius", linear(0.0, 1.0).sized(), "There are no grooves nearer to the middle than this.")
    .second("Outer radius", linear(0.0, 1.0).sized(), Bounds::Within(0.0, LARGEST_M), "m", "There are no grooves farther from the middle than this.");

pub static CENTER_M: Key = MIDDLE
    .words("origin")
    .means("For `\"parallel\"` and `\"uv\"`, with `radius_m`: the middle of the ball that holds them. The other patterns have theirs.");
