//! Scratches drawn into the maps of a model: (48) of docs/model.md, after Olano and Baker, *LEAN Mapping*, 2010. Where a scratch is wider than a texel
//! the normal map has its walls; what is finer than a texel widens the roughness.

mod atlas;
mod maps;
mod sums;

use std::sync::Arc;

use hairline_scene::{Base, Material, Texture};

use super::model::PlainModel;
use crate::error::Error;
use crate::loader::Loader;
use atlas::Atlas;
use maps::Maps;

impl PlainModel {
    /// Draws the scratches of all objects into maps of so many texels a side. Each material of an object that has scratches becomes one of its own.
    pub(crate) fn bake(&mut self, loader: &Loader, size_px: u32) -> Result<(), Error> {
        for number in self.objects.clone() {
            let object = &self.scene.objects[number];
            let scratched = object.segments.iter();
            let mut materials: Vec<u32> = scratched
                .map(|piece| object.mesh.triangle_materials[piece.triangle as usize])
                .collect();
            materials.sort_unstable();
            materials.dedup();
            for material in materials {
                loader.go_on()?;
                self.bake_part(number, material, size_px)?;
            }
        }
        self.is_baked = true;
        Ok(())
    }

    fn bake_part(&mut self, number: usize, material: u32, size_px: u32) -> Result<(), Error> {
        let object = &self.scene.objects[number];
        let atlas = Atlas::new(&object.mesh, material, size_px).map_err(|found| {
            let found = format!("object \"{}\" {found}", object.name);
            let right = "must have texture coordinates that do not overlap, for its scratches to be drawn into maps: unwrap the model";
            Error::new(format!("object[{number}]"), found, right)
        })?;
        let own = &self.scene.materials[material as usize];
        let sums = sums::of_scratches(object, &atlas);
        let maps = maps::of_sums(&atlas, sums, own, &self.scene.textures);
        let baked = self.with_maps(own.clone(), maps);
        self.scene.materials.push(baked);
        let last = self.scene.materials.len() as u32 - 1;
        let mesh = Arc::make_mut(&mut self.scene.objects[number].mesh);
        for it in &mut mesh.triangle_materials {
            if *it == material {
                *it = last;
            }
        }
        Ok(())
    }

    /// Scratches lie in the coat, if there is one.
    fn with_maps(&mut self, mut material: Material, maps: Maps) -> Material {
        let textures = Arc::make_mut(&mut self.scene.textures);
        let mut add = |texture: Texture| {
            textures.push(texture);
            textures.len() - 1
        };
        let normal = Some((add(maps.normals), 1.0));
        let roughness = Some(add(maps.roughness));
        if let Some(coat) = &mut material.coat {
            coat.roughness = maps.roughest;
            material.coat_textures[1] = roughness;
            material.coat_normal_texture = normal;
            return material;
        }
        if material.base == Base::Mirror {
            material.base = Base::ColoredMetal {
                base_color: [1.0; 3],
            };
        }
        material.roughness = maps.roughest;
        material.metallic_roughness_texture = roughness;
        material.normal_texture = normal;
        material
    }
}
