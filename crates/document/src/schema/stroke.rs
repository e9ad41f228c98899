//! The keys of `strokes` of a `[[scratches]]`.

use super::key::{Form, Key, log};
use super::section::Section;

/// `strokes` of a `[[scratches]]`
pub static STROKES: Section = Section::many(
    "strokes",
    "",
    "what a brush did.",
    &[&POINTS_M, &RADIUS_M, &DENSITY_PER_M, &ERASE, &WIDTH, &DEPTH],
);

pub static POINTS_M: Key = Key::new("points_m", Form::Points(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .range_words("1 to 65536 points, ±1000 each")
    .means("Where the brush went, on or near the surface, in the object's own frame. One point is a dab. A point farther from the object than the object is large is refused.");

pub static RADIUS_M: Key = Key::new("radius_m", Form::Number)
    .unit("m")
    .size()
    .means("Half of the brush's width; in the world's metres, whatever the object's `scale`.")
    .control(
        "Brush radius",
        log(2e-3, 0.3).sized(),
        "Half the width of the band in which scratches are laid or taken away.",
    );

pub static DENSITY_PER_M: Key = Key::new("density_per_m", Form::Number)
    .unit("1/m")
    .words("this or `erase`")
    .at_least_0()
    .means("Scratches on each metre of the stroke, at least one in all. A dab has as many as a stroke of its width.")
    .control("Brush density", log(10.0, 10_000.0).sized_by(-1), "Scratches for each metre of a stroke. Few: single marks. Many: a worn track.");

pub static ERASE: Key = Key::new("erase", Form::Flag)
    .flag(false)
    .means("Takes away instead.");

pub static WIDTH: Key = Key::new("width", Form::Number)
    .number(1.0)
    .within(0.01, 100.0)
    .means("Factor on the layer's widths; with `density_per_m` only.")
    .control("Width factor", log(0.25, 4.0), "Factor on the widths of the layer for this stroke. Above 1: bolder, with denser rainbows. Below 1: finer, with wider ones.");

pub static DEPTH: Key = Key::new("depth", Form::Number)
    .number(1.0)
    .within(0.01, 100.0)
    .means("Factor on the layer's depths; with `density_per_m` only.")
    .control("Depth factor", log(0.25, 4.0), "Factor on the depths of the layer for this stroke. It shifts the tint of the stroke against the rest.");
