//! Subjects of small pictures.

use hairline_editor::presets::{LayerPreset, LightPreset, MaterialPreset, ShapePreset};
use hairline_editor::wear::Wear;
use hairline_scene::environment::BuiltInMap;

/// Subject of a small picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Thumb {
    Layer(LayerPreset),
    Material(MaterialPreset),
    Light(LightPreset),
    Shape(ShapePreset),
    Map(BuiltInMap),
    Wear(Wear),
}
