//! Tools of the left mouse button in the picture.

use hairline_editor::brush::BrushSettings;
use hairline_scene::description::Camera;

/// A tool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Tool {
    /// Click selects, drag orbits.
    #[default]
    Select,
    /// Drag lays scratches along the stroke.
    Brush,
    /// Dragging removes scratches of the selected layer.
    Eraser,
    /// Click or drag moves the selected light so that its highlight falls there.
    PlaceLight,
    /// Click keeps the selected layer to the part of the model that is there.
    PickPart,
}

impl Tool {
    pub const ALL: [Self; 5] = [
        Self::Select,
        Self::Brush,
        Self::Eraser,
        Self::PlaceLight,
        Self::PickPart,
    ];

    /// Description for a tooltip.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Select => "Click selects what is there; drag turns the view",
            Self::Brush => "Drag over an object to lay scratches along the stroke",
            Self::Eraser => "Drag over an object to take scratches of the selected layer away",
            Self::PlaceLight => {
                "Click on an object, or drag over it: the selected light moves so that its highlight falls there"
            }
            Self::PickPart => {
                "Click on a part of an object: the selected layer of scratches lies on that part alone"
            }
        }
    }
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
