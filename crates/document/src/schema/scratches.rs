//! The keys of `[[scratches]]`.

use hairline_optics::scratch::DEPTH_MAX_NM;

use super::key::{Bounds, Form, Initial, Key, LARGEST_M, linear, log};
use super::section::{Choice, Section};

/// `[[scratches]]`
pub static SCRATCHES: Section = Section::many("scratches", "Scratches", "a layer on one object.", &[&OBJECT, &MATERIAL, &NODE, &WHERE, &NAME, &HIDDEN, &SOLO, &PROFILE, &STROKES]).kinds("pattern", &[
    Choice::new("random", "Every place and every direction: daily wear, cutlery from a drawer. Around the reflection of a lamp it draws circles of light.", &[&COUNT, &DENSITY_PER_M2, &SEED, &LENGTH_M, &WIDTH_UM, &DEPTH_NM, &BEND_PER_M]),
    Choice::new("parallel", "All along one direction: a brushed panel.", &[&COUNT, &DENSITY_PER_M2, &SEED, &LENGTH_M, &WIDTH_UM, &DEPTH_NM, &DIRECTION, &JITTER_DEG]),
    Choice::new("circular", "Rings and arcs around an axis: a turned pan, a plate wiped in circles. A lamp draws a fan through the centre.", &[&COUNT, &DENSITY_PER_M2, &SEED, &LENGTH_M, &WIDTH_UM, &DEPTH_NM, &AXIS, &CENTER_M, &JITTER_DEG]),
    Choice::new("radial", "Straight away from an axis: the sunburst of a watch dial.", &[&COUNT, &DENSITY_PER_M2, &SEED, &LENGTH_M, &WIDTH_UM, &DEPTH_NM, &AXIS, &CENTER_M, &JITTER_DEG]),
    Choice::new("spun", "Equal arcs that sweep from the axis to the rim, all turning the same way: ground wafers, spiral-brushed watch parts.", &[&COUNT, &DENSITY_PER_M2, &SEED, &LENGTH_M, &WIDTH_UM, &DEPTH_NM, &AXIS, &CENTER_M, &JITTER_DEG, &TOOL_PER_M]),
    Choice::new("swirl", "Arcs around many centres strewn over the surface: the cobweb on a polished or machine-washed car.", &[&COUNT, &DENSITY_PER_M2, &SEED, &LENGTH_M, &WIDTH_UM, &DEPTH_NM, &SWIRL_PER_M]),
    Choice::new("drawn", "Along the strokes of a brush: a rag's way, a child's coin.", &[&LENGTH_M, &WIDTH_UM, &DEPTH_NM, &SEED, &JITTER_DEG]),
    Choice::new("file", "Your own list of straight scratches.", &[&FILE]),
    Choice::new("curve", "A smooth curve through points: an engraved line.", &[&CURVE_POINTS_M, &CLOSED, &LINE_M, &WIDTH_UM, &DEPTH_NM, &SEED]),
    Choice::new("text", "The outlines of letters: a number, a name.", &[&TEXT, &CAPITALS_M, &MIDDLE_M, &READING, &LINE_M, &WIDTH_UM, &DEPTH_NM, &SEED]),
    Choice::new("svg", "The outlines of a drawing: a mark, an ornament.", &[&DRAWING, &EXTENT_M, &MIDDLE_M, &READING, &LINE_M, &WIDTH_UM, &DEPTH_NM, &SEED]),
]);

pub static OBJECT: Key = Key::new("object", Form::Text)
    .range_words("name of an object")
    .means("What they lie on.");

pub static MATERIAL: Key = Key::new("material", Form::Text)
    .words("all of it")
    .range_words("name of a material of the object's file")
    .means("They lie on what is of this material, and end where it ends.");

pub static NODE: Key = Key::new("node", Form::Text)
    .words("all of it")
    .range_words("name of a node of the object's file")
    .means("They lie on this node and on what is below it; with `material` on what is both.");

pub static WHERE: Key = Key::new("where", Form::Table)
    .words("everywhere alike")
    .range_words("see [where](#where)")
    .means("On which places they lie, and how thickly.");

pub static NAME: Key = Key::new("name", Form::Text)
    .none()
    .range_words("any text")
    .means("For you to know the layer by.");

pub static HIDDEN: Key = Key::new("hidden", Form::Flag)
    .flag(false)
    .means("Lays nothing. Other layers stay as they are.");

pub static SOLO: Key = Key::new("solo", Form::Flag)
    .flag(false)
    .means("If any layer of the scene is solo, only solo ones that are not hidden are laid.");

/// Names of cross sections.
pub const PROFILES: [&str; 4] = ["rectangle", "v", "round", "shoulders"];

pub static PROFILE: Key = Key::new("profile", Form::NameOrNumbers(&PROFILES))
    .text(PROFILES[0])
    .within(-1.0, 1.0)
    .range_words("one of these names, or 2 to 64 numbers of ±1, not all 0")
    .means("Cross section of the grooves: `\"rectangle\"`, a flat floor, which shows the purest colours; `\"v\"`, two straight flanks, of a sharp point; `\"round\"`, of a grain or a stylus; `\"shoulders\"`, round with ridges beside it, which a blunt point pushes up in soft metal. Or the depths over `depth_nm` at equal steps from the middle to the rim, below 0 above the surface: `[1, 0.7, 0, -0.3, 0]`. Width is that of all of it.");

pub static STROKES: Key = Key::new("strokes", Form::Tables)
    .none()
    .range_words("see [strokes](#strokes)")
    .means("What a brush or an eraser did.");

pub static COUNT: Key = Key::new("count", Form::Whole)
    .words("this or `density_per_m2`")
    .at_least_0()
    .range_words("whole, 0 or more")
    .means("How many.")
    .control("Count", log(10.0, 100_000.0), "Number of scratches. More: a denser, brighter sheen, and a polished highlight that loses the light they take. A higher count keeps the first ones in their place.");

pub static DENSITY_PER_M2: Key = Key::new("density_per_m2", Form::Number)
    .unit("1/m²")
    .words("this or `count`")
    .at_least_0()
    .means("How many on each square metre of the object.")
    .control("Density", log(10.0, 100_000.0).sized_by(-2), "Scratches for each square metre: a larger object gets more of them. More: a denser, brighter sheen, less light left in the polished highlight.");

pub static SEED: Key = Key::new("seed", Form::Whole)
    .number(1.0)
    .at_least_0()
    .range_words("whole, below 2^63")
    .means("The same seed gives the same scratches; a higher `count` keeps those there are and adds to them. Layers of different seeds do not depend on one another or on their order; of layers of one seed on one object (hidden ones count) each draws anew.")
    .control("Seed", linear(0.0, 1000.0), "Another number lays other scratches of the same kind, or puts the grooves of a grating in other places, as seen from nearby. Layers with different numbers do not repeat one another.");

pub static LENGTH_M: Key = Key::new("length_m", Form::Sizes)
    .unit("m")
    .sizes(0.02, 0.5)
    .above_0(LARGEST_M)
    .range_words("mean above 0, up to 1000; spread 0 to 3")
    .means("Length along the surface.")
    .control("Length", log(1e-3, 2.0).sized(), "Mean length. Long scratches draw unbroken arcs of colour across the surface; short ones break them into dashes and glitter.")
    .second("Length spread", linear(0.0, 1.5), Bounds::Within(0.0, 3.0), "", "How much lengths differ. 0 looks machined; 0.5 and above mixes long strokes with nicks, as wear does.");

pub static WIDTH_UM: Key = Key::new("width_um", Form::Sizes)
    .unit("µm")
    .sizes(1.5, 0.3)
    .above_0(100.0)
    .range_words("mean above 0, up to 100; spread 0 to 3")
    .means("Width of the groove: how far its colours fan out.")
    .control("Width", linear(0.5, 10.0), "Wider scratches: brighter, and the rainbow starts closer to the highlight and its colours lie denser. Narrow ones spread it far out; below 2 µm little more than its first tint is seen.")
    .second("Width spread", linear(0.0, 0.6), Bounds::Within(0.0, 3.0), "", "How much widths differ. Small: rainbows of all scratches agree and their bands stay apart. Large: bands blur into one another, further out first.");

pub static DEPTH_NM: Key = Key::new("depth_nm", Form::Sizes)
    .unit("nm")
    .sizes(200.0, 0.2)
    .above_0(DEPTH_MAX_NM)
    .range_words("mean above 0, up to 2000; spread 0 to 3")
    .means("Depth of the groove: which colours it favours.")
    .control("Depth", linear(20.0, 600.0), "Picks the overall tint, also close to the highlight: each depth favours some wavelengths and cancels others. Very shallow scratches are faint and bluish. Seen or lit aslant they act shallower, so tints shift as things turn.")
    .second("Depth spread", linear(0.0, 0.5), Bounds::Within(0.0, 3.0), "", "How much depths differ. Up to 0.15 scratches share a tint and colours stay clean; above 0.2 tints mix to straw and white.");

pub static DIRECTION: Key = Key::new("direction", Form::Numbers(3))
    .is(Initial::Numbers(&[1.0, 0.0, 0.0]))
    .direction()
    .means("Along what the scratches run, laid flat on the surface.")
    .control("Direction", linear(-1.0, 1.0), "Where the scratches run, in the object's own frame. Lamps are drawn out into streaks across it.");

pub static AXIS: Key = Key::new("axis", Form::Numbers(3))
    .is(Initial::Numbers(&[0.0, 0.0, 1.0]))
    .direction()
    .means("Direction of the axis.")
    .control(
        "Axis",
        linear(-1.0, 1.0),
        "The direction that the pattern turns about, in the object's own frame.",
    );

pub static CENTER_M: Key = Key::new("center_m", Form::Numbers(3))
    .unit("m")
    .is(Initial::Numbers(&[0.0, 0.0, 0.0]))
    .within(-1000.0, 1000.0)
    .means("A point on the axis.")
    .control("Centre", linear(-1.0, 1.0).sized(), "The point that the pattern turns about, in the object's own frame. Fans of light meet there.");

pub static JITTER_DEG: Key = Key::new("jitter_deg", Form::Number)
    .unit("°")
    .number(0.0)
    .within(0.0, 90.0)
    .means("Standard deviation of a scratch's angle to the pattern. A few degrees look made by hand.")
    .control("Jitter", linear(0.0, 30.0), "How far scratches stray from the pattern's direction. 0: fans and streaks with hard edges, as new. A few degrees soften them and look worn.");

const CURVATURE_PER_M: Key = Key::new("curvature_per_m", Form::Sizes)
    .unit("1/m")
    .within(-1e4, 1e4)
    .range_words("mean ±10000, spread 0 to 10000")
    .control("Curvature", linear(-50.0, 50.0).sized_by(-1), "One over the radius of the arcs. 0 is straight. Bent scratches turn through many directions, so each lights up over a shorter piece, and more of them light up at once.")
    .second("Curvature spread", linear(0.0, 50.0).sized_by(-1), Bounds::Within(0.0, 1e4), "1/m", "How much bends differ, to both sides. Some is what makes wear look casual instead of ruled.");

pub static BEND_PER_M: Key = CURVATURE_PER_M
    .number(0.0)
    .means("How much a scratch bends: one over its radius. A mean of 0 with a spread of 4 to 20 bends them both ways.");

pub static TOOL_PER_M: Key = CURVATURE_PER_M
    .number(20.0)
    .means("One over the radius of the tool; its sign is the sense of the spiral.");

pub static SWIRL_PER_M: Key = CURVATURE_PER_M
    .sizes(25.0, 8.0)
    .range_words("mean ±10000, not 0; spread 0 to 10000")
    .means("One over the distance to the centres.");

pub static CURVE_POINTS_M: Key = Key::new("points_m", Form::Points(3))
    .unit("m")
    .within(-1000.0, 1000.0)
    .range_words("2 to 4096 points, ±1000 each; 3 or more with `closed`")
    .means("What the curve goes through, on or near the surface, in the object's own frame. A point farther from the object than the object is large is refused.")
    .control("Point", linear(-1.0, 1.0).sized(), "A point that the curve goes through, in the object's own frame. It is moved onto the surface.");

pub static CLOSED: Key = Key::new("closed", Form::Flag)
    .flag(false)
    .means("The curve comes back to its first point.");

pub static LINE_M: Key = Key::new("line_m", Form::Number)
    .unit("m")
    .number(0.0)
    .within(0.0, 1.0)
    .means("How wide a line is. 0: one scratch, which shows where it runs across the light. Wider: filled with short scratches in all directions, as a marking laser leaves them, which shine from all sides.")
    .control("Line", linear(0.0, 0.02).sized(), "How wide a line is: filled with short scratches in all directions, so that it is seen from everywhere. 0: one scratch of the width below, which shows where it runs across the light.");

pub static TEXT: Key = Key::new("text", Form::Text)
    .range_words("1 to 200 characters")
    .means("What is engraved. The font is built in, Ubuntu Light: Latin, Greek, Cyrillic.");

pub static CAPITALS_M: Key = Key::new("height_m", Form::Number)
    .unit("m")
    .size()
    .means("The height of capitals.")
    .control("Height", log(2e-3, 0.5).sized(), "The height of capitals. In small letters the lines bend quickly, so that they glitter instead of drawing streaks.");

pub static DRAWING: Key = Key::new("file", Form::File)
    .range_words("`.svg`")
    .means("The drawing. All of its shapes are outlined, however they are filled; letters must be paths, and pictures are left out.");

pub static EXTENT_M: Key = Key::new("fit_m", Form::Number)
    .unit("m")
    .size()
    .means("The largest extent of its outlines.")
    .control(
        "Size",
        log(2e-3, 1.0).sized(),
        "The width of the drawing, or its height if that is larger.",
    );

pub static MIDDLE_M: Key = Key::new("center_m", Form::Numbers(3))
    .unit("m")
    .is(Initial::Numbers(&[0.0, 0.0, 0.0]))
    .within(-1000.0, 1000.0)
    .means("Where its middle is, on or near the surface.")
    .control(
        "Middle",
        linear(-1.0, 1.0).sized(),
        "Where its middle is, in the object's own frame. It is moved onto the surface.",
    );

pub static READING: Key = Key::new("direction", Form::Numbers(3))
    .is(Initial::Numbers(&[1.0, 0.0, 0.0]))
    .direction()
    .means("The way from its left to its right, laid flat on the surface.")
    .control(
        "Direction",
        linear(-1.0, 1.0),
        "The way from its left to its right, in the object's own frame.",
    );

pub static FILE: Key = Key::new("file", Form::File)
    .range_words("CSV, UTF-8")
    .means("One straight scratch a row, or a straight piece of one, commas between.");
