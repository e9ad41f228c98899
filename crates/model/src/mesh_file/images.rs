//! The images of a glTF file as the scene's textures, each once for every way in which it is looked up.

use std::collections::HashMap;

use gltf::texture::{MagFilter, WrappingMode};
use hairline_image::FilePath;

use super::source::{Buffers, resource};
use super::spec_gloss::SpecGloss;
use crate::flaw::Flaw;
use crate::texture::{self, Channels, Texels, texture_bytes};
use crate::texture::{Sampling, Texture, Wrap};

pub(super) struct Images<'a> {
    pub base_dir: &'a FilePath,
    pub buffers: &'a Buffers,
    pub textures: &'a mut Vec<Texture>,
    /// The files that were read.
    pub files: &'a mut Vec<FilePath>,
    /// Memory that is left for textures.
    pub free_bytes: f64,
    /// Whether textures get their mip chains, which take longer than the rest.
    pub with_mips: bool,
    /// Index of the scene's texture for each of the file's images and each way of looking it up.
    pub known: HashMap<(usize, Channels, Sampling), usize>,
}

impl Images<'_> {
    /// The number of a texture of the scene.
    pub(super) fn texture(
        &mut self,
        texture: &gltf::Texture,
        channels: Channels,
        by_other_uvs: bool,
    ) -> Result<usize, Flaw> {
        let image = texture.source();
        let sampling = sampling(texture, by_other_uvs);
        let key = (image.index(), channels, sampling);
        if let Some(&index) = self.known.get(&key) {
            return Ok(index);
        }
        let texels = self.read(&image)?;
        let index = self.add(texels, channels, sampling);
        self.known.insert(key, index);
        Ok(index)
    }

    /// Makes the two textures of the newer material model from those of the older one.
    pub(super) fn spec_gloss(
        &mut self,
        factors: &SpecGloss,
        diffuse: Option<&gltf::Texture>,
        specular: Option<&gltf::Texture>,
        by_other_uvs: bool,
    ) -> Result<[usize; 2], Flaw> {
        let mut read = |texture: Option<&gltf::Texture>| match texture {
            Some(texture) => self.read(&texture.source()).map(Some),
            None => Ok(None),
        };
        let (diffuse_texels, specular_texels) = (read(diffuse)?, read(specular)?);
        let either = diffuse.or(specular);
        let sampling = either.map_or(Sampling::default(), |it| sampling(it, by_other_uvs));
        let [colors, metals] = factors.images(diffuse_texels.as_ref(), specular_texels.as_ref());
        Ok([
            self.add(colors, Channels::Color, sampling),
            self.add(metals, Channels::Linear, sampling),
        ])
    }

    fn add(&mut self, texels: Texels, channels: Channels, sampling: Sampling) -> usize {
        self.free_bytes -= texture_bytes(texels.size_px);
        let made = texture::build_texture(texels, channels, self.with_mips);
        self.textures.push(Texture { sampling, ..made });
        self.textures.len() - 1
    }

    fn read(&mut self, image: &gltf::Image) -> Result<Texels, Flaw> {
        let what = format!("image {}", image.index());
        let free_bytes = self.free_bytes;
        let decode = |bytes: &[u8]| {
            texture::decode(bytes, free_bytes).map_err(|error| {
                Flaw::new(
                    format!("its {what} cannot be decoded ({error})"),
                    "must be a PNG, JPEG, WebP or KTX2 image (ETC1S or UASTC)",
                )
            })
        };
        match image.source() {
            gltf::image::Source::View { view, .. } => decode(self.buffers.view(&view)?),
            gltf::image::Source::Uri { uri, .. } => {
                decode(&resource(uri, self.base_dir, &what, self.files)?)
            }
        }
    }
}

/// Sampling of a texture. Filters that would let it flicker, seen small, are not asked for.
fn sampling(texture: &gltf::Texture, by_other_uvs: bool) -> Sampling {
    let sampler = texture.sampler();
    let wrap = |mode: WrappingMode| match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
        WrappingMode::ClampToEdge => Wrap::Clamp,
    };
    Sampling {
        wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
        is_sharp: sampler.mag_filter() == Some(MagFilter::Nearest),
        by_other_uvs,
    }
}
