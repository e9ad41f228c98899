//! What there are small pictures of.

use hairline_editor::presets::{LayerPreset, LightPreset, MaterialPreset, ShapePreset};
use hairline_editor::wear::Wear;
use hairline_scene::environment::BuiltInMap;

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Thumb {
    Layer(LayerPreset),
    Material(MaterialPreset),
    Light(LightPreset),
    Shape(ShapePreset),
    Map(BuiltInMap),
    Wear(Wear),
}
