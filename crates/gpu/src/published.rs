//! What the method of 2018 and its parts look up: the wavelengths of each material, the triangles of each light, and the
//! scratches of each triangle. Where a method has no use for a texture, a single texel takes its place, since no binding may
//! be empty.

use hairline_index::{ScratchIndex, TriangleLists};
use hairline_optics::method::{Chords, Lookup, Method, Spectrum};
use hairline_optics::published::polygon::triangulate;
use hairline_scene::{Light, Scene, ScratchTables};
use wgpu::TextureFormat;

use crate::device::Gpu;
use crate::error::Error;
use crate::rows::ROW_TEXELS;
use crate::textures;

/// Columns beyond the wavelengths. Twin: published_lights.wgsl.
const LIGHT_TRIANGLE_COLUMNS: usize = 64;

/// A row of wavelengths for each scratch table: weights in the three channels, wavelength in um. In columns of their own
/// beside them the triangles of the lights, each as three vertices counted from its light's first. Triangle i of a light
/// has the place of its vertex i; a polygon has two places more than triangles.
pub(crate) async fn wavelengths(
    gpu: &Gpu,
    scene: &Scene,
    tables: &ScratchTables,
    method: &Method,
) -> Result<wgpu::TextureView, Error> {
    let what = "wavelengths";
    if method.is_default_path() {
        return none(gpu, what, TextureFormat::Rgba32Float).await;
    }
    let (count, spectra) = match method.spectrum {
        Spectrum::Wavelengths { count, .. } => (count, tables.published_spectra(count)),
        Spectrum::Table => (0, Vec::new()),
    };
    let triangles = match method.chords {
        Chords::Steps => light_triangles(scene),
        Chords::Roots => Vec::new(),
    };
    let width = count + LIGHT_TRIANGLE_COLUMNS;
    let height = spectra
        .len()
        .max(triangles.len().div_ceil(LIGHT_TRIANGLE_COLUMNS))
        .max(1);
    let size = [width as u32, height as u32];
    let texture = textures::texture(gpu, what, size, 1, 1, TextureFormat::Rgba32Float).await?;
    let mut texels = vec![[0.0_f32; 4]; width * height];
    for (row, spectrum) in spectra.iter().enumerate() {
        for (texel, w) in texels[row * width..].iter_mut().zip(&spectrum.wavelengths) {
            let [r, g, b] = w.weight;
            *texel = [r, g, b, w.wavelength_um].map(|x| x as f32);
        }
    }
    for (i, [a, b, c]) in triangles.into_iter().enumerate() {
        let (row, column) = (i / LIGHT_TRIANGLE_COLUMNS, i % LIGHT_TRIANGLE_COLUMNS);
        texels[row * width + count + column] = [a, b, c, 0].map(|corner| corner as f32);
    }
    textures::write(gpu, &texture, 0, 0, size, bytemuck::cast_slice(&texels));
    Ok(texture.create_view(&Default::default()))
}

/// One triangle for each vertex of each polygon; those that a polygon does not need are empty.
fn light_triangles(scene: &Scene) -> Vec<[usize; 3]> {
    let of_light = |light: &Light| match light {
        Light::Sphere { .. } => Vec::new(),
        Light::Polygon { vertices_m, .. } => {
            let mut triangles = triangulate(vertices_m);
            triangles.resize(vertices_m.len(), [0; 3]);
            triangles
        }
    };
    scene.lights.iter().flat_map(of_light).collect()
}

/// Where each triangle's list begins and the last one ends, then the lists.
pub(crate) async fn triangle_lists(
    gpu: &Gpu,
    scene: &Scene,
    index: &ScratchIndex,
    method: &Method,
) -> Result<wgpu::TextureView, Error> {
    let what = "triangle lists";
    if method.lookup != Lookup::Triangles {
        return none(gpu, what, TextureFormat::R32Uint).await;
    }
    let lists = TriangleLists::build(scene, index);
    let first = lists.starts.len();
    let count = first + lists.segments.len();
    let allowed = u64::from(ROW_TEXELS) * u64::from(gpu.limits().max_texture_dimension_2d);
    if count as u64 > allowed {
        return Err(gpu.too_large(what, count as u64, allowed, "entries"));
    }
    let mut words: Vec<u32> = lists
        .starts
        .iter()
        .map(|start| start + first as u32)
        .collect();
    words.extend(&lists.segments);
    words.resize(count.next_multiple_of(ROW_TEXELS as usize), 0);
    let size = [ROW_TEXELS, (words.len() / ROW_TEXELS as usize) as u32];
    let texture = textures::texture(gpu, what, size, 1, 1, TextureFormat::R32Uint).await?;
    textures::write(gpu, &texture, 0, 0, size, bytemuck::cast_slice(&words));
    Ok(texture.create_view(&Default::default()))
}

async fn none(gpu: &Gpu, what: &str, format: TextureFormat) -> Result<wgpu::TextureView, Error> {
    let texture = textures::texture(gpu, what, [1, 1], 1, 1, format).await?;
    Ok(texture.create_view(&Default::default()))
}
