//! Cutouts of the surfaces of a glTF file: `alphaMode`.

use gltf::material::AlphaMode;

use crate::material::{AlphaRule, Cutout, Material};
use crate::mesh::Mesh;
use crate::texture::Texture;

/// An alpha that equals the cutoff is there (glTF 2.0, section 3.9.4), and a code over 255 is no single: far less than a step between codes.
const ROUNDING: f64 = 1e-6;

/// Returns the cutout of a material whose colour has an alpha.
pub(super) fn cutout(material: &gltf::Material, alpha: f64) -> Option<Cutout> {
    let rule = match material.alpha_mode() {
        AlphaMode::Opaque => return None,
        AlphaMode::Mask => {
            let least = f64::from(material.alpha_cutoff().unwrap_or(0.5));
            AlphaRule::AtLeast((least - ROUNDING).max(0.0))
        }
        AlphaMode::Blend => AlphaRule::Share,
    };
    Some(Cutout { alpha, rule })
}

/// Removes the cutouts of materials that are everywhere on their triangles of a mesh, from the material `first` on: many exporters write
/// `BLEND` wherever there is an alpha, and rays take longer through possible cutouts.
pub(super) fn forget_whole(
    materials: &mut [Material],
    first: usize,
    textures: &[Texture],
    mesh: &Mesh,
) {
    let mut least_of_vertices = vec![1.0f32; materials.len()];
    if !mesh.colors.is_empty() {
        for (triangle, material) in mesh.triangles.iter().zip(&mesh.triangle_materials) {
            let least = &mut least_of_vertices[*material as usize];
            for corner in triangle {
                *least = least.min(mesh.colors[*corner as usize].w);
            }
        }
    }
    let materials = materials.iter_mut().zip(least_of_vertices).skip(first);
    for (material, of_vertices) in materials {
        let of_texture = material.base_color_texture.map_or(255, |texture| {
            let texels = textures[texture].levels[0].iter();
            texels.map(|texel| texel[3]).min().unwrap_or(255)
        });
        material.cutout = material.cutout.filter(|cutout| {
            let alpha = cutout.alpha * f64::from(of_texture) / 255.0 * f64::from(of_vertices);
            match cutout.rule {
                AlphaRule::AtLeast(least) => alpha < least,
                AlphaRule::Share => alpha < 1.0,
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Base;
    use crate::texture::Sampling;
    use glam::Vec4;

    #[test]
    fn what_is_clear_nowhere_is_whole() {
        let alpha = |rule, factor, texel, vertex| {
            let cutout = Cutout {
                alpha: factor,
                rule,
            };
            let material = Material {
                base_color_texture: Some(0),
                cutout: Some(cutout),
                ..Material::plain("glass".into(), Base::Mirror, 0.0)
            };
            let textures = [Texture {
                size_px: [2, 1],
                levels: vec![vec![[9, 9, 9, 255], [9, 9, 9, texel]]],
                srgb: true,
                sampling: Sampling::default(),
            }];
            let mesh = Mesh {
                colors: vec![Vec4::ONE, Vec4::ONE, Vec4::new(1.0, 1.0, 1.0, vertex)],
                triangles: vec![[0, 1, 2]],
                triangle_materials: vec![0],
                ..Mesh::default()
            };
            let mut materials = [material];
            forget_whole(&mut materials, 0, &textures, &mesh);
            materials[0].cutout.is_some()
        };
        assert!(!alpha(AlphaRule::Share, 1.0, 255, 1.0));
        assert!(alpha(AlphaRule::Share, 0.9, 255, 1.0));
        assert!(alpha(AlphaRule::Share, 1.0, 254, 1.0));
        assert!(alpha(AlphaRule::Share, 1.0, 255, 0.5));
        assert!(!alpha(AlphaRule::AtLeast(0.5), 1.0, 128, 1.0));
        assert!(alpha(AlphaRule::AtLeast(0.5), 1.0, 128, 0.9));
    }
}
