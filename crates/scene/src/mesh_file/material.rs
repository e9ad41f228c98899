//! The materials of a glTF file: metallic-roughness, with the textures that they use.

use std::collections::HashMap;
use std::path::Path;

use gltf::Primitive;

use super::flaw::Flaw;
use super::source::{Buffers, resource};
use super::stock::Stock;
use crate::description::DEFAULT_COHERENCE_UM;
use crate::scene::{Base, Material, Texture};
use crate::texture::{self, Channels, texture_bytes};

/// What the primitives' materials become.
pub(super) enum Materials<'a> {
    /// All of them this one.
    One(u32),
    /// The file's own, added to the scene as they are met.
    Own(Own<'a>),
}

pub(super) struct Own<'a> {
    base_dir: &'a Path,
    buffers: &'a Buffers,
    stock: Stock<'a>,
    /// From the file's materials, `None` for its default one, to the scene's.
    indices: HashMap<Option<usize>, u32>,
    /// From the file's images, as sRGB or linear data, to the scene's textures.
    textures: HashMap<(usize, Channels), usize>,
}

impl<'a> Materials<'a> {
    pub(super) fn own(base_dir: &'a Path, buffers: &'a Buffers, stock: Stock<'a>) -> Self {
        Self::Own(Own {
            base_dir,
            buffers,
            stock,
            indices: HashMap::new(),
            textures: HashMap::new(),
        })
    }

    /// The scene's material for a primitive.
    pub(super) fn index(&mut self, primitive: &Primitive) -> Result<u32, Flaw> {
        match self {
            Self::One(index) => Ok(*index),
            Self::Own(own) => own.index(&primitive.material()),
        }
    }
}

/// The texture coordinates that a material's textures use. A vertex has one pair, so they are taken to agree.
pub(super) fn uv_set(material: &gltf::Material) -> u32 {
    let pbr = material.pbr_metallic_roughness();
    let base = pbr.base_color_texture().map(|t| t.tex_coord());
    let rough = pbr.metallic_roughness_texture().map(|t| t.tex_coord());
    let normal = material.normal_texture().map(|t| t.tex_coord());
    let emission = material.emissive_texture().map(|t| t.tex_coord());
    base.or(rough).or(normal).or(emission).unwrap_or(0)
}

impl Own<'_> {
    fn index(&mut self, material: &gltf::Material) -> Result<u32, Flaw> {
        if let Some(&index) = self.indices.get(&material.index()) {
            return Ok(index);
        }
        let converted = self.convert(material)?;
        let index = self.stock.materials.len() as u32;
        self.stock.materials.push(converted);
        self.indices.insert(material.index(), index);
        Ok(index)
    }

    fn convert(&mut self, material: &gltf::Material) -> Result<Material, Flaw> {
        let pbr = material.pbr_metallic_roughness();
        let [r, g, b, _] = pbr.base_color_factor();
        let unit = |x: f32| f64::from(x).clamp(0.0, 1.0);
        let strength = emissive_strength(material);
        let normal_texture = material.normal_texture();
        Ok(Material {
            name: material.name().unwrap_or("glTF default").to_owned(),
            base: Base::MetallicRoughness {
                base_color: [r, g, b].map(unit),
                metallic: unit(pbr.metallic_factor()),
            },
            roughness: unit(pbr.roughness_factor()),
            coherence_um: DEFAULT_COHERENCE_UM,
            emission: material
                .emissive_factor()
                .map(|x| f64::from(x).max(0.0) * strength),
            base_color_texture: self.texture(
                pbr.base_color_texture().map(|t| t.texture()),
                Channels::Color,
            )?,
            metallic_roughness_texture: self.texture(
                pbr.metallic_roughness_texture().map(|t| t.texture()),
                Channels::Linear,
            )?,
            normal_texture: self
                .texture(
                    normal_texture.as_ref().map(|t| t.texture()),
                    Channels::Normals,
                )?
                .zip(normal_texture.map(|t| f64::from(t.scale()))),
            emission_texture: self.texture(
                material.emissive_texture().map(|t| t.texture()),
                Channels::Color,
            )?,
        })
    }

    fn texture(
        &mut self,
        texture: Option<gltf::Texture>,
        channels: Channels,
    ) -> Result<Option<usize>, Flaw> {
        let Some(image) = texture.map(|texture| texture.source()) else {
            return Ok(None);
        };
        let key = (image.index(), channels);
        if let Some(&index) = self.textures.get(&key) {
            return Ok(Some(index));
        }
        let index = self.stock.textures.len();
        let texture = self.read_image(&image, channels)?;
        self.stock.free_bytes -= texture_bytes(texture.size_px);
        self.stock.textures.push(texture);
        self.textures.insert(key, index);
        Ok(Some(index))
    }

    fn read_image(&mut self, image: &gltf::Image, channels: Channels) -> Result<Texture, Flaw> {
        let what = format!("image {}", image.index());
        let with_mips = self.stock.with_mips;
        let free_bytes = self.stock.free_bytes;
        let decode = |bytes: &[u8]| {
            if bytes.starts_with(b"\xabKTX ") {
                let found = format!("its {what} is a KTX image");
                return Err(Flaw::new(
                    found,
                    "export it again with PNG, JPEG or WebP images",
                ));
            }
            texture::decode(bytes, channels, with_mips, free_bytes).map_err(|error| {
                Flaw::new(
                    format!("its {what} cannot be decoded ({error})"),
                    "must be a PNG, JPEG or WebP image",
                )
            })
        };
        match image.source() {
            gltf::image::Source::View { view, .. } => decode(self.buffers.view(&view)?),
            gltf::image::Source::Uri { uri, .. } => {
                decode(&resource(uri, self.base_dir, &what, self.stock.files)?)
            }
        }
    }
}

/// KHR_materials_emissive_strength: a factor on the emission, which is bounded by 1 without it.
fn emissive_strength(material: &gltf::Material) -> f64 {
    material
        .extension_value("KHR_materials_emissive_strength")
        .and_then(|extension| extension.get("emissiveStrength")?.as_f64())
        .filter(|strength| (0.0..=1e6).contains(strength))
        .unwrap_or(1.0)
}
