//! `overrides` of an `[[object]]`: other factors for materials of its file, whose maps stay.

use hairline_keys::Keyed;
use hairline_optics::metal::Metal;
use hairline_scene::{Base, Material};

use super::ranges::Check;
use crate::error::Error;

/// One of `overrides`: other factors for a material of a model's file. Its maps stay, and multiply these factors.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, check = Override::check_metal)]
pub struct Override {
    /// Whose factors they are.
    #[key(range_words("name of a material of the file"))]
    pub material: String,
    /// Factor on the roughness map; without a map the roughness.
    #[key(words("as in the file").in_range(0.0, 1.0)
        .control("Roughness", linear(0.0, 0.6), "How far the polished highlight spreads. 0.05 to 0.15 leaves dark room around it where scratches shine; rougher surfaces drown them. The scratches themselves stay as sharp."))]
    pub roughness: Option<f64>,
    /// Factor on the metallic map.
    #[key(words("as in the file; 1 with `metal`").in_range(0.0, 1.0)
        .control("Metallic", linear(0.0, 1.0), "0: a painted surface with weak, white reflections. 1: bare metal, whose reflections and scratches are bright and take its colour."))]
    pub metallic: Option<f64>,
    /// Factor on the base colour map.
    #[key(color().words("as in the file").in_range(0.0, 1.0)
        .control("Colour", linear(0.0, 1.0), "On metals it tints the mirror image and the scratches in it; on coated surfaces it is the body under the coat, which scratches leave as it is. Dark bodies let scratches show."))]
    pub base_color: Option<[f64; 3]>,
    /// In the place of `base_color` and of the file's factors: the colour that the metal's measured refractive index gives, metallic.
    #[key(none().range_words("a metal's name").form(Form::Text))]
    pub metal: Option<Metal>,
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

    fn check_metal(&self, key: &str) -> Check {
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
