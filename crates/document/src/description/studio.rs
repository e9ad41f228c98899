//! The studio around a scene's objects and the ground under them, which a scene file selects by name.

use hairline_keys::Keyed;

use super::Description;

/// `[studio]`: soft boxes, a lamp and a dim room about the camera's subject. Scene files without `[[light]]` and `[environment]` have one
/// that they do not name, with a ground.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, default)]
pub struct Studio {
    /// As if it were not there.
    #[key(flag(false).omitted().labelled("Hidden", "A hidden studio gives no light at all."))]
    pub hidden: bool,
    /// Factor on all of its radiances.
    #[key(number(1.0).at_least_0().omitted()
        .control("Intensity", log(0.01, 10.0), "Brightness of all of the studio, its lamp and its room among them: reflections and the colours of scratches alike."))]
    pub intensity: f64,
    /// Turns it about the up axis, counter-clockwise seen from above.
    #[key(unit("°").number(0.0).omitted()
        .control("Rotation", linear(-180.0, 180.0), "Turns the soft boxes and the lamp about the vertical, and with them their reflections on metal."))]
    pub rotation_deg: f64,
}

impl Studio {
    /// A scene without a studio.
    pub const NONE: Self = Self {
        hidden: true,
        intensity: 1.0,
        rotation_deg: 0.0,
    };

    pub(super) fn is_none(&self) -> bool {
        *self == Self::NONE
    }
}

/// `[ground]`: a wide floor under all objects.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, default)]
pub struct Ground {
    /// As if it were not there.
    #[key(flag(false).omitted())]
    pub hidden: bool,
    /// Albedo below its gloss.
    #[key(color().is(Initial::Numbers(&[0.1, 0.1, 0.105])).in_range(0.0, 1.0).omitted()
        .control("Colour", linear(0.0, 1.0), "On metals it tints the mirror image and the scratches in it; on coated surfaces it is the body under the coat, which scratches leave as it is. Dark bodies let scratches show."))]
    pub color: [f64; 3],
    /// As that of a material.
    #[key(number(0.55).in_range(0.0, 1.0).omitted()
        .control("Roughness", linear(0.0, 0.6), "How far the polished highlight spreads. 0.05 to 0.15 leaves dark room around it where scratches shine; rougher surfaces drown them. The scratches themselves stay as sharp."))]
    pub roughness: f64,
    /// Where it lies along the up axis.
    #[key(unit("m").words("under the lowest point of all objects").in_range(-1000.0, 1000.0)
        .control("Height", linear(-1.0, 1.0).sized(), "Where the floor lies along the vertical. Just under an object, its shadow touches it; deeper, it floats."))]
    pub height_m: Option<f64>,
    /// Whether the ground is seen by the shadows on it alone. Pictures are transparent then: where it is lit fully alpha is 0, where nothing lights
    /// it black with alpha 1. No object mirrors it.
    #[key(flag(false).omitted()
        .labelled("Shadows only", "Saved pictures have the shadows on the floor alone, as a black with alpha. The window shows no floor then."))]
    pub shadows_only: bool,
}

impl Description {
    /// Whether the scene has a light or an environment of its own, hidden or not.
    pub(super) fn is_lit(&self) -> bool {
        self.environment.is_some() || !self.lights.is_empty()
    }
}
