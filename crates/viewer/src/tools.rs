//! Tools of the left mouse button in the picture.

use glam::DVec3;
use hairline_document::description::Camera;
use hairline_editor::brush::BrushSettings;

hairline_image::listed! {
    /// A tool.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub(crate) enum Tool {
        /// Click selects, drag orbits.
        #[default]
        Select = "Click selects what is there; drag turns the view";
        /// Drag lays scratches along the stroke.
        Brush = "Drag over an object to lay scratches along the stroke";
        /// Dragging removes scratches of the selected layer.
        Eraser = "Drag over an object to take scratches of the selected layer away";
        /// Clicks set the points of an engraved line.
        Pen = "Click on an object to set the points of an engraved line; Enter or a click on its last point ends it. A click on a finished line inserts a point, a drag moves one, Delete takes it away";
        /// Click or drag moves the selected light so that its highlight falls there.
        PlaceLight = "Click on an object, or drag over it: the selected light moves so that its highlight falls there";
        /// Click keeps the selected layer to the part of the model that is there.
        PickPart = "Click on a part of an object: the selected layer of scratches lies on that part alone";
        /// Drag draws the region that is rendered first.
        Region = "Drag over a part of the picture: it is rendered before the rest. A click gives it up";
        /// Click reads a scratch; drag measures along the surface.
        Measure = "Click on a scratch to read it; drag over a surface to measure along it";
    }
    /// Description for a tooltip.
    fn hint;
}

/// The step that makes a line of two points.
pub(crate) const BEGIN_LINE: &str = "Engrave a line";

/// A point that is no line yet: its object, and its place in world space.
pub(crate) type LonePoint = (usize, DVec3);

/// The tools and how they are set.
pub(crate) struct Toolbox {
    pub tool: Tool,
    /// Settings of the brush by hand; none until then.
    pub brush: Option<BrushSettings>,
    /// Settings that fit the object that it was over last, with its number and the camera that saw it.
    pub fitted: Option<(usize, Camera, BrushSettings)>,
    /// The point that the pen has set alone.
    pub begun: Option<LonePoint>,
    /// The first point of the line that the pen has made last: with its second one undone it is alone again.
    pub first: Option<LonePoint>,
}

impl Toolbox {
    /// The lone point of the pen in hand.
    pub fn lone_point(&self) -> Option<LonePoint> {
        self.begun.filter(|_| self.tool == Tool::Pen)
    }

    /// Takes the lone point away; whether there was one.
    pub fn take_lone_point(&mut self) -> bool {
        let was_there = self.lone_point().is_some();
        self.begun = None;
        was_there
    }
}

impl Default for Toolbox {
    fn default() -> Self {
        Self {
            tool: Tool::Select,
            brush: None,
            fitted: None,
            begun: None,
            first: None,
        }
    }
}
