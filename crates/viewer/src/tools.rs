//! Tools of the left mouse button in the picture.

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
        Pen = "Click on an object to set the points of an engraved line; Enter or a double click ends it. Drag a point to move it, Delete takes it away";
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

/// The tools and how they are set.
pub(crate) struct Toolbox {
    pub tool: Tool,
    /// Settings of the brush by hand; none until then.
    pub brush: Option<BrushSettings>,
    /// Settings that fit the object that it was over last, with its number and the camera that saw it.
    pub fitted: Option<(usize, Camera, BrushSettings)>,
}

impl Default for Toolbox {
    fn default() -> Self {
        Self {
            tool: Tool::Select,
            brush: None,
            fitted: None,
        }
    }
}
