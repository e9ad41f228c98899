//! The materials of a glTF file: metallic-roughness, and the changes by its extensions.

use std::collections::HashMap;

use gltf::json::Value;
use gltf::{Document, Primitive};

use super::anisotropy;
use super::coat;
use super::cutout::{self, cutout};
use super::extension_texture::{self, both_used};
use super::images::Images;
use super::spec_gloss::{self, SpecGloss};
use super::specular;
use super::uv::{self, UvMapping, UvMappings};
use crate::flaw::Flaw;
use crate::material::DEFAULT_COHERENCE_UM;
use crate::material::{Base, GLTF_DIELECTRIC_F0, Material, Specular};
use crate::mesh::Mesh;
use crate::texture::Channels;

/// Mapping of the primitives' materials to the scene's.
pub(super) enum Materials<'a> {
    /// One material of the scene for all primitives.
    One(u32),
    /// The file's own, added to the scene as they are met.
    Own(FileMaterials<'a>),
}

pub(super) struct FileMaterials<'a> {
    document: &'a Document,
    images: Images<'a>,
    materials: &'a mut Vec<Material>,
    /// Index in the scene of each of the file's materials; `None` is its default one.
    indices: HashMap<Option<usize>, u32>,
}

impl<'a> Materials<'a> {
    pub(super) fn own(
        document: &'a Document,
        images: Images<'a>,
        materials: &'a mut Vec<Material>,
    ) -> Self {
        Self::Own(FileMaterials {
            document,
            images,
            materials,
            indices: HashMap::new(),
        })
    }

    /// Removes the cutouts of those materials, from number `first` on, whose alpha is 1 all over a mesh.
    pub(super) fn forget_whole(&mut self, first: usize, mesh: &Mesh) {
        if let Self::Own(own) = self {
            cutout::forget_whole(own.materials, first, own.images.textures, mesh);
        }
    }

    /// The scene's material for a primitive.
    pub(super) fn index(&mut self, primitive: &Primitive) -> Result<u32, Flaw> {
        match self {
            Self::One(index) => Ok(*index),
            Self::Own(own) => own.index(&primitive.material()),
        }
    }
}

impl FileMaterials<'_> {
    fn index(&mut self, material: &gltf::Material) -> Result<u32, Flaw> {
        if let Some(&index) = self.indices.get(&material.index()) {
            return Ok(index);
        }
        let mut converted = self.convert(material)?;
        if let Some(extension) = material.extension_value(spec_gloss::NAME) {
            self.take_spec_gloss(extension, material, &mut converted)?;
        }
        let index = self.materials.len() as u32;
        self.materials.push(converted);
        self.indices.insert(material.index(), index);
        Ok(index)
    }

    fn convert(&mut self, material: &gltf::Material) -> Result<Material, Flaw> {
        let pbr = material.pbr_metallic_roughness();
        let [r, g, b, a] = pbr.base_color_factor();
        let unit = |x: f32| f64::from(x).clamp(0.0, 1.0);
        let strength = emissive_strength(material);
        let metallic = unit(pbr.metallic_factor());
        let is_unlit = material.extension_value("KHR_materials_unlit").is_some();
        // The images of the newer model are for programs that do not know the older one.
        let is_older = material.extension_value(spec_gloss::NAME).is_some();
        let [of_color, of_metal] = [pbr.base_color_texture(), pbr.metallic_roughness_texture()]
            .map(|texture| used(texture.filter(|_| !is_older)));
        let mappings = UvMappings::from_material(material);
        let mut look = |texture: Option<(gltf::Texture, UvMapping)>, channels| match texture {
            Some((texture, mapping)) => {
                let by_other_uvs = mappings.is_second(mapping);
                self.images
                    .texture(&texture, channels, by_other_uvs)
                    .map(Some)
            }
            None => Ok(None),
        };
        let normals = material.normal_texture();
        let occlusion = material.occlusion_texture();
        let coat = coat::coat(material).filter(|_| !is_unlit);
        let of_coat = coat::uses(material).map(|used| used.filter(|_| coat.is_some()));
        let [of_weight, of_roughness] = both_used(self.document, of_coat, "clear coat")?;
        let normals_of_coat = coat::normals(material).filter(|_| coat.is_some());
        let of_normals = extension_texture::used(self.document, normals_of_coat, "clear coat")?;
        let of_specular = specular::uses(material).map(|used| used.filter(|_| !is_unlit));
        let [of_specular, of_specular_color] =
            both_used(self.document, of_specular, "specular reflection")?;
        let anisotropy = anisotropy::anisotropy(material).filter(|_| !is_unlit);
        let of_anisotropy = anisotropy.and_then(|_| anisotropy::texture(material));
        let of_anisotropy = extension_texture::used(self.document, of_anisotropy, "anisotropy")?;
        Ok(Material {
            name: material.name().unwrap_or("glTF default").to_owned(),
            base: Base::MetallicRoughness {
                base_color: [r, g, b].map(unit),
                metallic,
            },
            roughness: unit(pbr.roughness_factor()),
            coherence_um: DEFAULT_COHERENCE_UM,
            emission: material
                .emissive_factor()
                .map(|x| f64::from(x).max(0.0) * strength),
            base_color_texture: look(of_color, Channels::Color)?,
            metallic_roughness_texture: look(of_metal, Channels::Linear)?,
            normal_texture: look(
                normals
                    .as_ref()
                    .map(|it| (it.texture(), uv::of_normals(it))),
                Channels::Normals,
            )?
            .zip(normals.map(|it| f64::from(it.scale()))),
            emission_texture: look(used(material.emissive_texture()), Channels::Color)?,
            occlusion_texture: look(
                occlusion
                    .as_ref()
                    .map(|it| (it.texture(), uv::of_occlusion(it))),
                Channels::Linear,
            )?
            .zip(occlusion.map(|it| unit(it.strength()))),
            dielectric_f0: specular::f0(material),
            specular: specular::specular(material),
            specular_textures: [
                look(of_specular, Channels::Linear)?,
                look(of_specular_color, Channels::Color)?,
            ],
            is_unlit,
            cutout: cutout(material, unit(a)),
            coat_textures: [
                look(of_weight, Channels::Linear)?,
                look(of_roughness, Channels::Linear)?,
            ],
            coat_normal_texture: look(of_normals, Channels::Normals)?
                .zip(normals_of_coat.map(coat::normal_scale)),
            coat,
            anisotropy,
            anisotropy_texture: look(of_anisotropy, Channels::Linear)?,
        })
    }

    /// Replaces a material's properties of the newer model by those of the older one.
    fn take_spec_gloss(
        &mut self,
        extension: &Value,
        material: &gltf::Material,
        converted: &mut Material,
    ) -> Result<(), Flaw> {
        let factors = SpecGloss::read(extension);
        let texture = |name: &str| {
            let index = extension.get(name)?.get("index")?.as_u64()?;
            self.document.textures().nth(usize::try_from(index).ok()?)
        };
        let (diffuse, specular) = (
            texture("diffuseTexture"),
            texture("specularGlossinessTexture"),
        );
        converted.dielectric_f0 = GLTF_DIELECTRIC_F0;
        converted.specular = Specular::default();
        converted.specular_textures = [None; 2];
        converted.cutout = cutout(material, f64::from(factors.diffuse[3]));
        if diffuse.is_none() && specular.is_none() {
            let metal = factors.metal();
            converted.base = Base::MetallicRoughness {
                base_color: metal.base_color.map(f64::from),
                metallic: f64::from(metal.metallic),
            };
            converted.roughness = f64::from(metal.roughness);
            return Ok(());
        }
        // Both images use the mapping of the first.
        let mapping = spec_gloss::TEXTURES
            .into_iter()
            .find_map(|name| uv::of_json(extension.get(name)?));
        let by_other_uvs =
            mapping.is_some_and(|mapping| UvMappings::from_material(material).is_second(mapping));
        let images =
            self.images
                .spec_gloss(&factors, diffuse.as_ref(), specular.as_ref(), by_other_uvs)?;
        converted.base = Base::MetallicRoughness {
            base_color: [1.0; 3],
            metallic: 1.0,
        };
        converted.roughness = 1.0;
        converted.base_color_texture = Some(images[0]);
        converted.metallic_roughness_texture = Some(images[1]);
        Ok(())
    }
}

/// Texture of a slot, and its mapping.
fn used<'a>(info: Option<gltf::texture::Info<'a>>) -> Option<(gltf::Texture<'a>, UvMapping)> {
    info.map(|info| (info.texture(), UvMapping::from_texture(&info)))
}

/// KHR_materials_emissive_strength: a factor on the emission, which is bounded by 1 without it.
fn emissive_strength(material: &gltf::Material) -> f64 {
    let extension = material.extension_value("KHR_materials_emissive_strength");
    extension
        .and_then(|it| it.get("emissiveStrength")?.as_f64())
        .filter(|strength| (0.0..=1e6).contains(strength))
        .unwrap_or(1.0)
}
