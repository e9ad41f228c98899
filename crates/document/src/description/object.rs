//! The `[[object]]` tables of a scene file.

use std::path::PathBuf;

use hairline_keys::Keyed;
use hairline_model::mesh_file::Placing;
use serde::{Serialize, Serializer};
use toml::de::DeValue;

use super::key_value::KeyValue;
use super::keyed::Keyed;
use super::overrides::Override;
use super::ranges::{Check, Numbers, Take};
use super::shapes::Shape;
use super::table::Table;
use super::toml_value::{Read, Value};
use super::values::named;
use crate::error::Error;
use crate::schema::{Form, Initial};

/// `[[object]]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(own_reader, check = Object::check_companions)]
pub struct Object {
    /// What scratches call it by.
    #[key(range_words("not empty, no two equal"))]
    pub name: String,
    /// `shape` or `mesh`.
    #[flat]
    pub surface: Surface,
    /// A `mesh` without it keeps the materials of its file; with it, all of the mesh is of this one.
    #[key(words("required for a `shape`").range_words("name of a material"))]
    pub material: Option<String>,
    /// Which axis of the model's file points up. It is turned to the world axis nearest to the camera's `up`, so that the model stands upright.
    #[key(text("y").range_words("`\"y\"`, `\"z\"`; with `mesh` only").omitted())]
    pub up: Up,
    /// Scales the model until its largest extent is this.
    #[key(unit("m").words("as in the file").size().range_words("1e-5 to 1000; with `mesh` only")
        .control("Fitted size", log(0.05, 5.0).sized(), "The largest extent of the model, whatever it is in its file."))]
    pub fit_m: Option<f64>,
    /// The model stands as an animation of its file has it at this time. Without it, it is at rest.
    #[key(unit("s").none().in_range(0.0, 1e6).range_words("0 to 1e6; with `mesh` only")
        .control("Time (s)", linear(0.0, 10.0), "Seconds from the start of the model's animation. Its scratches are laid anew where it stands then."))]
    pub time_s: Option<f64>,
    /// Which animation: its name, or its number from 0 as text.
    #[key(words("the first one").range_words("with `time_s` only"))]
    pub animation: Option<String>,
    /// Other factors for materials of its file, whose maps stay: [below](#gltf-models).
    #[key(none().range_words("a list; with `mesh` and without `material`"))]
    pub overrides: Vec<Override>,
    /// Moves the object, after scale and rotation.
    #[key(unit("m").is(Initial::Numbers(&[0.0, 0.0, 0.0])).in_range(-1000.0, 1000.0)
        .control("Position", linear(-2.0, 2.0).sized(), "Moves the object with its scratches."))]
    pub translation_m: [f64; 3],
    /// Turns it about the world's x axis, then y, then z.
    #[key(unit("°").is(Initial::Numbers(&[0.0, 0.0, 0.0]))
        .control("Rotation", linear(-180.0, 180.0), "Turns the object about the world's x axis, then y, then z. Scratches turn along, so their fans sweep through the light."))]
    pub rotation_deg: [f64; 3],
    /// One number, or three for the object's own axes; negative ones mirror.
    #[key(number(1.0).factor(1e-6, 1e6).range_words("size 1e-6 to 1e6, not 0")
        .control("Scale", log(0.01, 10.0), "Makes the object larger or smaller; scratches keep their own lengths, widths and depths, and cover it less or more densely. Negative mirrors it."))]
    #[by(ScaleFactors)]
    pub scale: [f64; 3],
    /// As if it were not there, nor what lies on it.
    #[key(flag(false).omitted().labelled("Hidden", "As if the object were not there, nor what lies on it."))]
    pub hidden: bool,
}

/// Source of an object's triangles.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(one_of)]
pub enum Surface {
    /// A built-in shape.
    #[key("shape": words("this or `mesh`").range_words("see [shapes](#shapes)"))]
    Shape(Shape),
    /// A model.
    #[key("mesh": words("this or `shape`").range_words("`.gltf`, `.glb`, `.obj` or `.stl`"))]
    Mesh(PathBuf),
}

/// `up` of an object with a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// `"y"`
    #[default]
    Y,
    /// `"z"`
    Z,
}

impl Object {
    /// Placing of the file that the object's triangles come from, by its keys.
    pub(crate) fn placing(&self, world_up: glam::DVec3) -> Placing {
        Placing {
            up: self.up.axis(),
            world_up,
            fit_m: self.fit_m,
            time_s: self.time_s,
            animation: self.animation.clone(),
            stands_alone: self.fit_m.is_some(),
        }
    }
}

impl Up {
    /// The axis in the file's frame.
    pub(super) fn axis(self) -> glam::DVec3 {
        match self {
            Self::Y => glam::DVec3::Y,
            Self::Z => glam::DVec3::Z,
        }
    }
}

named! { Up {
    "y" => Y,
    "z" => Z,
} }

/// One number or three.
#[derive(PartialEq)]
struct ScaleFactors([f64; 3]);

impl ScaleFactors {
    /// The number that stands for all three.
    fn one(&self) -> Option<f64> {
        let [x, y, z] = self.0;
        (x == y && y == z).then_some(x)
    }
}

impl From<[f64; 3]> for ScaleFactors {
    fn from(factors: [f64; 3]) -> Self {
        Self(factors)
    }
}

impl From<ScaleFactors> for [f64; 3] {
    fn from(factors: ScaleFactors) -> Self {
        factors.0
    }
}

impl Read for ScaleFactors {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Array(_) => Read::read(value, key).map(Self),
            _ => f64::read(value, key).map(|factor| Self([factor; 3])),
        }
    }
}

impl Numbers for ScaleFactors {
    fn each(&self, take: &mut Take) -> Check {
        match self.one() {
            Some(factor) => factor.each(take),
            None => self.0.each(take),
        }
    }
}

impl Serialize for ScaleFactors {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.one() {
            Some(factor) => factor.serialize(serializer),
            None => self.0.serialize(serializer),
        }
    }
}

impl KeyValue for ScaleFactors {
    const FORM: Form = Form::OneOrNumbers(3);

    fn initial(initial: Initial) -> Option<Self> {
        f64::initial(initial).map(|factor| Self([factor; 3]))
    }

    fn written(&self) -> impl Serialize {
        self
    }
}

impl Object {
    /// Refuses keys without what they belong to.
    fn check_companions(&self, key: &str) -> Check {
        let wrong = |name: &str, found: &str, right: &str| {
            Err(Error::new(format!("{key}.{name}"), found, right))
        };
        if self.animation.is_some() && self.time_s.is_none() {
            let right = "add one, such as `time_s = 0`: an animation is shown at a time";
            return wrong("animation", "found no `time_s` beside it", right);
        }
        if let (Some(_), [_, ..]) = (&self.material, &self.overrides[..]) {
            return wrong(
                "overrides",
                "found `material` beside it, of which all of the mesh is",
                "leave out one of the two",
            );
        }
        match (&self.surface, &self.material) {
            (Surface::Shape(_), None) => Err(Error::new(
                key,
                "`material` is missing",
                "a shape needs one; only a mesh brings its own",
            )),
            _ => Ok(()),
        }
    }
}

impl Read for Object {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read_entries(Self::KEYS, value, key)?;
        let of_meshes = [
            Self::UP,
            Self::FIT_M,
            Self::TIME_S,
            Self::ANIMATION,
            Self::OVERRIDES,
        ];
        let object = Self::read_keys(&table)?;
        let extra = of_meshes.iter().find(|key| table.has(key.name));
        match (&object.surface, extra) {
            (Surface::Shape(_), Some(extra)) => Err(Error::new(
                table.key_path(extra.name),
                "a shape has no such key",
                "it belongs to an object with a `mesh`",
            )),
            _ => Ok(object),
        }
    }
}
