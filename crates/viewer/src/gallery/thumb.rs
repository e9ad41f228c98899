//! Subjects of small pictures.

use hairline_editor::grating_presets::GratingPreset;
use hairline_editor::presets::{LayerPreset, LightPreset, MaterialPreset, ShapePreset};
use hairline_editor::wear::Wear;
use hairline_sky::BuiltInMap;

/// Subject of a small picture. Presets of surfaces are shown on the kind of object that they are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Thumb {
    Layer(LayerPreset, StandIn),
    Material(MaterialPreset, StandIn),
    Light(LightPreset),
    Shape(ShapePreset),
    Map(BuiltInMap),
    Wear(Wear, StandIn),
    Grating(GratingPreset, StandIn),
}

impl Thumb {
    /// Every subject, in the order of the sheet.
    pub fn all() -> impl Iterator<Item = Self> {
        let on = |form: StandIn| {
            let layers = LayerPreset::ALL.map(|p| Self::Layer(p, form)).into_iter();
            layers
                .chain(MaterialPreset::all().map(move |p| Self::Material(p, form)))
                .chain(Wear::ALL.map(|p| Self::Wear(p, form)))
                .chain(GratingPreset::ALL.map(|p| Self::Grating(p, form)))
        };
        let lights = LightPreset::ALL.map(Self::Light).into_iter();
        lights
            .chain(ShapePreset::ALL.map(Self::Shape))
            .chain(BuiltInMap::ALL.map(Self::Map))
            .chain(StandIn::ALL.into_iter().flat_map(on))
    }

    /// Name of the preset in a menu, if it can be given to an object.
    pub fn given_name(self) -> Option<&'static str> {
        match self {
            Self::Layer(preset, _) => Some(preset.name()),
            Self::Material(preset, _) => Some(preset.name()),
            Self::Wear(wear, _) => Some(wear.name()),
            Self::Grating(preset, _) => Some(preset.name()),
            Self::Light(_) | Self::Shape(_) | Self::Map(_) => None,
        }
    }
}

/// Shape in the place of an object, of the kind that decides where scratches on it are seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum StandIn {
    /// A plate, a lid, a dial.
    #[default]
    Flat,
    /// A ball, a ring, a body without a long side.
    Round,
    /// A bottle, a cup.
    Tall,
}

impl StandIn {
    pub const ALL: [Self; 3] = [Self::Flat, Self::Round, Self::Tall];

    /// The stand-in for a box with these sides, `height` among them, in one unit.
    pub fn for_box(sides: [f64; 3], height: f64) -> Self {
        let [least, middle, most] = {
            let mut sorted = sides;
            sorted.sort_by(f64::total_cmp);
            sorted
        };
        match () {
            () if least < 0.35 * middle => Self::Flat,
            () if height == most && most > 1.3 * middle => Self::Tall,
            () => Self::Round,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::StandIn;

    #[test]
    fn boxes_have_the_stand_ins_of_what_is_in_them() {
        let plate = [0.2, 0.2, 0.02];
        assert_eq!(StandIn::for_box(plate, 0.02), StandIn::Flat);
        // A mirror that stands.
        assert_eq!(StandIn::for_box([0.2, 0.01, 0.4], 0.4), StandIn::Flat);
        assert_eq!(StandIn::for_box([0.1, 0.1, 0.1], 0.1), StandIn::Round);
        assert_eq!(StandIn::for_box([0.07, 0.07, 0.3], 0.3), StandIn::Tall);
        // A bottle that lies.
        assert_eq!(StandIn::for_box([0.07, 0.3, 0.07], 0.07), StandIn::Round);
    }
}
