//! Mapping of a material's images onto its surface: the set of texture coordinates, and KHR_texture_transform.

use glam::Vec2;
use gltf::json::Value;
use gltf::material::Material;

use super::{anisotropy, coat, spec_gloss, specular};

const NAME: &str = "KHR_texture_transform";

/// Mapping from a vertex's texture coordinates to a place of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvMapping {
    /// Index of the set of texture coordinates.
    pub set: u32,
    offset: [f64; 2],
    rotation_rad: f64,
    scale: [f64; 2],
}

impl UvMapping {
    pub(super) fn new(set: u32, transform: Option<&Value>) -> Self {
        let number = |value: &Value| value.as_f64().filter(|x| x.is_finite());
        let pair = |name: &str, or: f64| {
            let values = transform.and_then(|it| it.get(name));
            [0, 1].map(|i| values.and_then(|it| number(it.get(i)?)).unwrap_or(or))
        };
        let other_set = transform.and_then(|it| it.get("texCoord")?.as_u64());
        let rotation = transform.and_then(|it| number(it.get("rotation")?));
        Self {
            set: other_set.and_then(|set| set.try_into().ok()).unwrap_or(set),
            offset: pair("offset", 0.0),
            rotation_rad: rotation.unwrap_or(0.0),
            scale: pair("scale", 1.0),
        }
    }

    /// Mapping of a use of a texture.
    pub(super) fn from_texture(texture: &gltf::texture::Info) -> Self {
        Self::new(texture.tex_coord(), texture.extension_value(NAME))
    }

    /// Scaled, then turned, then moved: turned counter-clockwise as one sees an image whose v runs down.
    pub(super) fn place(&self, uv: [f32; 2]) -> Vec2 {
        let (sine, cosine) = libm::sincos(self.rotation_rad);
        let [u, v] = [0, 1].map(|i| f64::from(uv[i]) * self.scale[i]);
        let [x, y] = self.offset;
        Vec2::new(
            (cosine * u + sine * v + x) as f32,
            (cosine * v - sine * u + y) as f32,
        )
    }
}

/// Mappings of a material's images. The first one is that of the normal map, or of its coat's where it has none, since tangents follow it. A
/// vertex has two pairs of coordinates; images with a third mapping use the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct UvMappings {
    pub first: Option<UvMapping>,
    pub second: Option<UvMapping>,
}

impl UvMappings {
    pub(super) fn from_material(material: &Material) -> Self {
        let mut mappings = Self::default();
        for mapping in all(material) {
            mappings.add(mapping);
        }
        mappings
    }

    fn add(&mut self, mapping: UvMapping) {
        if self.first.is_none() {
            self.first = Some(mapping);
        } else if self.second.is_none() && self.first != Some(mapping) {
            self.second = Some(mapping);
        }
    }

    /// Whether an image uses the second mapping.
    pub(super) fn is_second(&self, mapping: UvMapping) -> bool {
        self.second == Some(mapping)
    }
}

/// Mappings of all images that are read.
fn all(material: &Material) -> Vec<UvMapping> {
    let pbr = material.pbr_metallic_roughness();
    let normal = material
        .normal_texture()
        .map(|it| UvMapping::new(it.tex_coord(), it.extension_value(NAME)));
    let rest = [
        pbr.base_color_texture(),
        pbr.metallic_roughness_texture(),
        material.emissive_texture(),
    ];
    let rest = rest.iter().flatten().map(UvMapping::from_texture);
    let occlusion = material.occlusion_texture();
    let rest = rest.chain(occlusion.as_ref().map(of_occlusion));
    let older = material.extension_value(spec_gloss::NAME);
    let older = spec_gloss::TEXTURES
        .into_iter()
        .filter_map(|name| of_json(older?.get(name)?));
    let of_extensions = coat::uses(material).into_iter();
    let of_extensions = of_extensions.chain([anisotropy::texture(material)]);
    let of_extensions = of_extensions.chain(specular::uses(material));
    let of_extensions = of_extensions.flatten().filter_map(of_json);
    let normal_of_coat = coat::normals(material).and_then(of_json);
    normal
        .or(normal_of_coat)
        .into_iter()
        .chain(rest)
        .chain(older)
        .chain(of_extensions)
        .chain(normal_of_coat)
        .collect()
}

/// Mapping of a use of a texture within an extension.
pub(super) fn of_json(texture: &Value) -> Option<UvMapping> {
    texture.get("index")?;
    let set = texture.get("texCoord").and_then(Value::as_u64);
    let transform = texture.get("extensions").and_then(|it| it.get(NAME));
    Some(UvMapping::new(
        set.and_then(|set| set.try_into().ok()).unwrap_or(0),
        transform,
    ))
}

/// The way of an occlusion map.
pub(super) fn of_occlusion(texture: &gltf::material::OcclusionTexture) -> UvMapping {
    UvMapping::new(texture.tex_coord(), texture.extension_value(NAME))
}

/// The way of a normal map.
pub(super) fn of_normals(texture: &gltf::material::NormalTexture) -> UvMapping {
    UvMapping::new(texture.tex_coord(), texture.extension_value(NAME))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_scaled_then_turned_then_moved() {
        let transform = r#"{"offset":[0.5,0.25],"rotation":1.5707963267948966,"scale":[2,4]}"#;
        let transform: Value = gltf::json::deserialize::from_str(transform).unwrap();
        let mapping = UvMapping::new(0, Some(&transform));
        // A quarter turn takes u to -v and v to u.
        for (uv, place) in [
            ([0.0, 0.0], [0.5, 0.25]),
            ([1.0, 0.0], [0.5, -1.75]),
            ([0.0, 1.0], [4.5, 0.25]),
        ] {
            assert!(mapping.place(uv).abs_diff_eq(place.into(), 1e-6), "{uv:?}");
        }
        assert_eq!(
            UvMapping::new(3, None).place([0.25, 7.0]),
            Vec2::new(0.25, 7.0)
        );
    }
}
