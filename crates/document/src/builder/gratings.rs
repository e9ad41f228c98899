//! The gratings of a scene, with the textures of the pictures that they name.

use std::path::PathBuf;
use std::sync::Arc;

use hairline_model::texture::{self, Channels, Texels, texture_bytes};
use hairline_scene::{Scene, Texture};

use super::Work;
use super::kept::{GroovePictureKind, KeptGroovePicture, KeptSurface};
use super::textures::NewTextures;
use crate::description::references::find;
use crate::description::{self, GroovePattern};
use crate::error::Error;
use crate::grey_map;
use crate::stamp::Stamp;

impl Work<'_> {
    /// Converts the gratings of all objects that are not hidden.
    pub(super) fn gratings(
        &mut self,
        scene: &mut Scene,
        surfaces: &[Arc<KeptSurface>],
        textures: &mut NewTextures,
    ) -> Result<(), Error> {
        let described = self.description;
        // Gratings may share a picture.
        let mut known = Vec::new();
        for (i, grating) in described.gratings.iter().enumerate() {
            if grating.hidden {
                continue;
            }
            let key = format!("grating[{i}]");
            let names = described.objects.iter().map(|o| o.name.as_str());
            let object = find(&grating.object, names, &format!("{key}.object"), "object")?;
            if surfaces[object].is_gone() {
                continue;
            }
            check_uvs(grating, &surfaces[object], &key)?;
            if described.objects[object].hidden {
                continue;
            }
            let mut numbered = |name, kind, file: &Option<PathBuf>| {
                let Some(file) = file else {
                    return Ok(None);
                };
                let alike = |(path, its_kind, _): &&(_, _, _)| (path, its_kind) == (file, &kind);
                if let Some((_, _, number)) = known.iter().find(alike) {
                    return Ok(Some(*number));
                }
                let key_path = format!("{key}.{name}");
                let read = self.groove_picture(&key_path, file, kind, &mut textures.free_bytes)?;
                let number = textures.add(read);
                known.push((file.clone(), kind, number));
                Ok::<_, Error>(Some(number))
            };
            let mask = numbered("mask", GroovePictureKind::Mask, &grating.mask)?;
            let directions = match &grating.pattern {
                GroovePattern::Uv { directions, .. } => {
                    numbered("directions", GroovePictureKind::Directions, directions)?
                }
                _ => None,
            };
            let placed = described.objects[object].world_from_object();
            let grating = grating.in_scene(&placed, mask, directions);
            scene.objects[object].gratings.push(grating);
        }
        Ok(())
    }

    fn groove_picture(
        &mut self,
        key: &str,
        file: &PathBuf,
        kind: GroovePictureKind,
        free_bytes: &mut f64,
    ) -> Result<Arc<Vec<Texture>>, Error> {
        let path = self.base_dir.join(file);
        let stamp = Stamp::read(&path);
        let kept = match self.old.groove_picture(&stamp, kind) {
            Some(kept) => kept,
            None => {
                let read = texture::read(&path, *free_bytes).map_err(|found| {
                    let right = "must be a .png, .jpg or .webp, relative to the scene file";
                    Error::new(key, found, right)
                })?;
                *free_bytes -= texture_bytes(read.size_px);
                KeptGroovePicture {
                    file: stamp,
                    kind,
                    texture: Arc::new(vec![as_texture(read, kind)]),
                }
            }
        };
        let texture = kept.texture.clone();
        self.new.groove_pictures.push(kept);
        Ok(texture)
    }
}

fn as_texture(read: Texels, kind: GroovePictureKind) -> Texture {
    let texels = match kind {
        GroovePictureKind::Directions => read.texels,
        GroovePictureKind::Mask => {
            let grey = |texel: &[u8; 4]| {
                let share = grey_map::share(texel);
                [share, share, share, u8::MAX]
            };
            read.texels.iter().map(grey).collect()
        }
    };
    texture::with_mips(read.size_px, texels, Channels::Linear)
}

/// Refuses a grating that follows texture coordinates on a surface that has none.
fn check_uvs(grating: &description::Grating, on: &KeptSurface, key: &str) -> Result<(), Error> {
    if on.mesh.has_uvs() {
        return Ok(());
    }
    if let GroovePattern::Uv { .. } = grating.pattern {
        return Err(Error::new(
            format!("{key}.pattern"),
            "found \"uv\" for a surface without texture coordinates",
            "take another pattern, such as \"parallel\"",
        ));
    }
    if grating.mask.is_some() && grating.tile_m.is_none() {
        return Err(Error::new(
            format!("{key}.mask"),
            "found a picture for a surface without texture coordinates",
            "add `tile_m`, how wide it is, to lay it on from three sides",
        ));
    }
    Ok(())
}
