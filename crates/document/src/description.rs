//! A scene as its author writes it: one type for each table of the scene file, units in the names, defaults filled in.
//!
//! A [`Description`] comes from TOML ([`Description::from_toml`]) or from an editor, is turned into a
//! [`Scene`](hairline_scene::Scene) by [`build`](crate::build()), and is saved by [`Description::to_toml`]; what was
//! saved loads again to an equal description. A field is the one entry of its key: reader, checks, writer, panels and documents are made of it
//! (`#[derive(Keyed)]` of the crate `hairline-keys`). Reading is not done by serde, so that every mistake has its line and a hint; ranges are
//! checked apart from it, so that they hold for descriptions that come from no file.

mod camera;
mod check;
mod derived;
mod distribution;
mod distribution_value;
mod engraved;
mod environment;
mod files;
mod gratings;
pub(crate) mod hint;
mod json;
mod key_value;
mod keyed;
mod laid;
mod lens;
mod light_kind;
mod lights;
mod looks;
mod material;
mod object;
mod overrides;
pub(crate) mod panel;
mod parse;
mod place;
mod ranges;
mod read;
pub(crate) mod references;
mod render;
mod scratches;
mod sections;
mod shapes;
mod strokes;
mod studio;
mod table;
mod toml_value;
pub(crate) mod values;

use std::path::PathBuf;

use serde::Serialize;

pub use camera::Camera;
pub use distribution::Distribution;
pub use engraved::{Engraved, Line};
pub use environment::{Environment, Map};
pub use files::FileUse;
pub use gratings::{Grating, GratingTheory, GroovePattern, UvAxis};
pub use laid::{Amount, Brushed, Laid, Listed, Pattern, PatternAxis};
pub use light_kind::{LightKind, SUN_DEG};
pub use lights::{Cone, Light};
pub use looks::Look;
pub(crate) use material::DEFAULT_COHERENCE_UM;
pub use material::{Brushing, Clearcoat, Cover, Material, MaterialKind, MetalColor, Reflections};
pub use object::{Object, Surface, Up};
pub use overrides::Override;
pub use panel::{Panel, RowValue, Rows};
pub use place::LayerPlaces;
pub use ranges::LARGEST_SEED;
pub use render::Render;
pub use scratches::{Layer, Scratches, Standing, standings};
pub use sections::{SECTIONS, section};
pub use shapes::Shape;
pub use strokes::{Brush, Paint, STROKE_POINTS, Stroke};
pub use studio::{Ground, Studio};
pub use values::profile_names;

/// A whole scene file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// `[camera]`: required.
    pub camera: Camera,
    /// `[render]`: may be left out.
    pub render: Render,
    /// `[environment]`: may be left out; then there is no light but the `lights` and the studio, and without a studio the background is black.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// `[studio]`: may be left out; then there is one where a scene file has neither lights nor an environment.
    #[serde(skip_serializing_if = "Studio::is_none")]
    pub studio: Studio,
    /// `[ground]`: may be left out; then there is one where a scene file has a studio without asking for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<Ground>,
    /// `[[material]]`.
    #[serde(rename = "material", skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<Material>,
    /// `[[object]]`: at least one.
    #[serde(rename = "object", skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<Object>,
    /// `[[scratches]]`: each a layer of scratches on one object; an object may have many.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scratches: Vec<Scratches>,
    /// `[[grating]]`: each a row of grooves on one object; an object may have many.
    #[serde(rename = "grating", skip_serializing_if = "Vec::is_empty")]
    pub gratings: Vec<Grating>,
    /// `[[light]]`.
    #[serde(rename = "light", skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<Light>,
    /// `[[look]]`: other cameras, exposures and lights of the same objects.
    #[serde(rename = "look", skip_serializing_if = "Vec::is_empty")]
    pub looks: Vec<Look>,
    /// The model whose own lights the `lights` were made of, as its object names it. Not part of the file.
    #[serde(skip)]
    pub lights_of: Option<PathBuf>,
    /// Notes on the file for its author, a line each; they are no part of the file.
    #[serde(skip)]
    pub notes: Vec<String>,
}

impl Description {
    /// Whether nothing but objects and shadows is seen in pictures, so that they have an alpha.
    pub fn cuts_out(&self) -> bool {
        let ground = self.ground.as_ref();
        self.render.transparent
            || self.render.behind.is_some()
            || ground.is_some_and(|ground| ground.shadows_only && !ground.hidden)
    }
}
