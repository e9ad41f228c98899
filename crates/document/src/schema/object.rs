//! The keys of `[[object]]`.

use super::key::{Form, Initial, Key, linear, log};
use super::section::Section;

/// `[[object]]`
pub static OBJECT: Section = Section::many(
    "object",
    "Object",
    "a `shape` or a `mesh`.",
    &[
        &NAME,
        &SHAPE,
        &MESH,
        &MATERIAL,
        &UP,
        &FIT_M,
        &TIME_S,
        &ANIMATION,
        &OVERRIDES,
        &TRANSLATION_M,
        &ROTATION_DEG,
        &SCALE,
        &HIDDEN,
    ],
);

pub static NAME: Key = Key::new("name", Form::Text)
    .range_words("not empty, no two equal")
    .means("What scratches call it by.");

pub static SHAPE: Key = Key::new("shape", Form::Table)
    .words("this or `mesh`")
    .range_words("see [shapes](#shapes)")
    .means("A built-in shape.");

pub static MESH: Key = Key::new("mesh", Form::File)
    .words("this or `shape`")
    .range_words("`.gltf`, `.glb`, `.obj` or `.stl`")
    .means("A model.");

pub static MATERIAL: Key = Key::new("material", Form::Text)
    .words("required for a `shape`")
    .range_words("name of a material")
    .means("A `mesh` without it keeps the materials of its file; with it, all of the mesh is of this one.");

pub static UP: Key = Key::new("up", Form::Name(&["y", "z"]))
    .text("y")
    .range_words("`\"y\"`, `\"z\"`; with `mesh` only")
    .means("Which axis of the model's file points up. It is turned to the world axis nearest to the camera's `up`, so that the model stands upright.");

pub static FIT_M: Key = Key::new("fit_m", Form::Number)
    .unit("m")
    .words("as in the file")
    .size()
    .range_words("1e-5 to 1000; with `mesh` only")
    .means("Scales the model until its largest extent is this.")
    .control(
        "Fitted size",
        log(0.05, 5.0).sized(),
        "The largest extent of the model, whatever it is in its file.",
    );

pub static TIME_S: Key = Key::new("time_s", Form::Number)
    .unit("s")
    .none()
    .within(0.0, 1e6)
    .range_words("0 to 1e6; with `mesh` only")
    .means("The model stands as an animation of its file has it at this time. Without it, it is at rest.")
    .control("Time (s)", linear(0.0, 10.0), "Seconds from the start of the model's animation. Its scratches are laid anew where it stands then.");

pub static ANIMATION: Key = Key::new("animation", Form::Text)
    .words("the first one")
    .range_words("with `time_s` only")
    .means("Which animation: its name, or its number from 0 as text.");

pub static OVERRIDES: Key = Key::new("overrides", Form::Tables)
    .none()
    .range_words("a list; with `mesh` and without `material`")
    .means("Other factors for materials of its file, whose maps stay: [below](#gltf-models).");

pub static TRANSLATION_M: Key = Key::new("translation_m", Form::Numbers(3))
    .unit("m")
    .is(Initial::Numbers(&[0.0, 0.0, 0.0]))
    .within(-1000.0, 1000.0)
    .means("Moves the object, after scale and rotation.")
    .control(
        "Position",
        linear(-2.0, 2.0).sized(),
        "Moves the object with its scratches.",
    );

pub static ROTATION_DEG: Key = Key::new("rotation_deg", Form::Numbers(3))
    .unit("°")
    .is(Initial::Numbers(&[0.0, 0.0, 0.0]))
    .means("Turns it about the world's x axis, then y, then z.")
    .control("Rotation", linear(-180.0, 180.0), "Turns the object about the world's x axis, then y, then z. Scratches turn along, so their fans sweep through the light.");

pub static SCALE: Key = Key::new("scale", Form::OneOrNumbers(3))
    .number(1.0)
    .factor(1e-6, 1e6)
    .range_words("size 1e-6 to 1e6, not 0")
    .means("One number, or three for the object's own axes; negative ones mirror.")
    .control("Scale", log(0.01, 10.0), "Makes the object larger or smaller; scratches keep their own lengths, widths and depths, and cover it less or more densely. Negative mirrors it.");

pub static HIDDEN: Key = Key::new("hidden", Form::Flag)
    .flag(false)
    .means("As if it were not there, nor what lies on it.");
