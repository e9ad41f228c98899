//! `overrides` of an `[[object]]`: other factors for materials of its file, whose maps stay.

use hairline_optics::metal::Metal;
use hairline_scene::{Base, Material};
use serde::{Serialize, Serializer};

use super::keyed::{Keyed, keyed};
use super::ranges::Check;
use super::table::{Read, Table, Value};
use super::values::serialize_named;
use crate::error::Error;
use crate::schema::overrides;

/// One of `overrides`: other factors for a material of a model's file. Its maps stay, and multiply these factors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Override {
    /// The material's name in the file. Required.
    pub material: String,
    /// Factor on its roughness map, or its roughness. In [0, 1].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roughness: Option<f64>,
    /// Factor on its metallic map, or how metallic it is. In [0, 1].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metallic: Option<f64>,
    /// Factor on its base colour map, or its base colour, linear Rec.709. In [0, 1] each.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_color: Option<[f64; 3]>,
    /// A measured metal: its colour in the place of `base_color`, and metallic unless `metallic` says otherwise.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "name_of")]
    pub metal: Option<Metal>,
}

fn name_of<S: Serializer>(metal: &Option<Metal>, serializer: S) -> Result<S::Ok, S::Error> {
    match metal {
        Some(metal) => serialize_named(metal, serializer),
        None => serializer.serialize_none(),
    }
}

impl Override {
    /// An override of a material that changes nothing yet.
    pub fn new(material: impl Into<String>) -> Self {
        Self {
            material: material.into(),
            roughness: None,
            metallic: None,
            base_color: None,
            metal: None,
        }
    }

    /// Changes a material of the file.
    pub(crate) fn apply(&self, material: &mut Material) {
        if let Some(own) = self.roughness {
            material.roughness = own;
        }
        // Materials of files are all of this kind.
        if let Base::MetallicRoughness {
            base_color,
            metallic,
        } = &mut material.base
        {
            let of_metal = self.metal.map(|metal| metal.reflectance_rgb(1.0));
            *base_color = self.base_color.or(of_metal).unwrap_or(*base_color);
            let of_metal = self.metal.map(|_| 1.0);
            *metallic = self.metallic.or(of_metal).unwrap_or(*metallic);
        }
    }

    /// Refuses values out of range.
    pub(super) fn check_at(&self, key: &str) -> Check {
        self.check_keys(key)?;
        match (self.base_color, self.metal) {
            (Some(_), Some(_)) => Err(Error::new(
                format!("{key}.metal"),
                "found `base_color` beside it",
                "must have one of them at most",
            )),
            _ => Ok(()),
        }
    }
}

keyed! { Override of overrides::OVERRIDES {
    material: overrides::MATERIAL,
    roughness: overrides::ROUGHNESS,
    metallic: overrides::METALLIC,
    base_color: overrides::BASE_COLOR,
    metal: overrides::METAL,
} }
