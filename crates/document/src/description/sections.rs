//! The tables of the scene file, each by its keys.

use super::keyed::Keyed;
use super::{
    Camera, Cover, Environment, Grating, Ground, LayerPlaces, Light, Look, Material, Object,
    Override, Render, Scratches, Shape, Stroke, Studio,
};
use crate::schema::Section;

/// The table of this name.
///
/// # Panics
/// Where there is none.
pub fn section(name: &str) -> &'static Section {
    let section = SECTIONS.iter().find(|section| section.name == name);
    section.unwrap_or_else(|| panic!("no table is called {name}"))
}

/// All tables of the scene file, and the tables in them.
pub static SECTIONS: [Section; 16] = [
    Section::one(
        "camera",
        "Camera",
        "a pinhole, or a thin lens.",
        Camera::KEYS,
    ),
    Section::one(
        "render",
        "Settings",
        "how the picture is sampled and shown.",
        Render::KEYS,
    ),
    Section::one(
        "environment",
        "Environment",
        "light from all around. Either `file` or `builtin`.",
        Environment::KEYS,
    ),
    Section::one(
        "studio",
        "Studio",
        "soft boxes, a lamp and a dim room around the objects. A scene without lights and environment has one, on a ground; with `hidden` it is in the dark.",
        Studio::KEYS,
    ),
    Section::one(
        "ground",
        "Ground",
        "a wide floor under all objects.",
        Ground::KEYS,
    ),
    Section::many(
        "material",
        "Material",
        "what an object is made of.",
        Material::KEYS,
    )
    .of_kinds(Material::KINDS),
    Section::many(
        "cover",
        "",
        "a clear plate with parallel faces over a metal.",
        Cover::KEYS,
    ),
    Section::many("object", "Object", "a `shape` or a `mesh`.", Object::KEYS),
    Section::many("shape", "", "a built-in shape.", &[]).of_kinds(Shape::KINDS),
    Section::many(
        "overrides",
        "",
        "other factors for a material of a model's file.",
        Override::KEYS,
    ),
    Section::many(
        "scratches",
        "Scratches",
        "a layer on one object.",
        Scratches::KEYS,
    )
    .of_kinds(Scratches::KINDS),
    Section::many(
        "where",
        "",
        "on which places a layer lies, and how thickly.",
        LayerPlaces::KEYS,
    ),
    Section::many("strokes", "", "what a brush did.", Stroke::KEYS),
    Section::many(
        "grating",
        "Grating",
        "grooves side by side, finer than a pixel, that cover an object.",
        Grating::KEYS,
    )
    .of_kinds(Grating::KINDS),
    Section::many("light", "Light", "one of the kinds below.", Light::KEYS).of_kinds(Light::KINDS),
    Section::many(
        "look",
        "Look",
        "another camera, exposure or light of the same objects, by a name.",
        Look::KEYS,
    ),
];
