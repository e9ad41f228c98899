//! Look-up tables of the method of 2018: the wavelengths of each material, the triangles of each light, and the scratches of
//! each triangle. For Hairline's own method a single texel takes the place of each, since no binding may be empty.

use hairline_index::TriangleLists;
use hairline_index::method::Structure;
use hairline_published::polygon::triangulate;
use hairline_published::spectrum::PUBLISHED_WAVELENGTHS;
use hairline_scene::{Light, LightShape, Scene};
use wgpu::TextureFormat;

use crate::error::Error;
use crate::lights;
use crate::rows::ROW_TEXELS;
use crate::source::Source;
use crate::transfer::{TexturePosition, Transfer};

/// Columns beyond the wavelengths. Twin: published_lights.wgsl.
const LIGHT_TRIANGLE_COLUMNS: usize = 64;

/// The two textures.
pub(crate) struct Published {
    pub wavelengths: wgpu::TextureView,
    pub triangle_lists: wgpu::TextureView,
    is_empty: bool,
}

impl Published {
    /// `last`, where there was nothing to look up and is nothing now; else all of it anew.
    pub(crate) async fn upload(
        transfer: &mut Transfer<'_>,
        source: &Source<'_>,
        last: Option<&Self>,
    ) -> Result<Self, Error> {
        let is_empty = source.method.published.is_none();
        if let Some(last) = last.filter(|last| is_empty && last.is_empty) {
            return Ok(Self {
                wavelengths: last.wavelengths.clone(),
                triangle_lists: last.triangle_lists.clone(),
                is_empty,
            });
        }
        Ok(Self {
            wavelengths: wavelengths(transfer, source).await?,
            triangle_lists: triangle_lists(transfer, source).await?,
            is_empty,
        })
    }
}

/// A row of wavelengths for each scratch table: weights in the three channels, wavelength in um. In columns of their own
/// beside them the triangles of the lights, each as three vertices counted from its light's first. Triangle i of a light
/// has the place of its vertex i; a polygon has two places more than triangles.
async fn wavelengths(
    transfer: &mut Transfer<'_>,
    source: &Source<'_>,
) -> Result<wgpu::TextureView, Error> {
    let Source {
        scene,
        tables,
        method,
        ..
    } = source;
    let what = "wavelengths";
    if method.published.is_none() {
        return none(transfer, what, TextureFormat::Rgba32Float).await;
    }
    let count = PUBLISHED_WAVELENGTHS;
    let spectra = tables.published_spectra(count);
    let triangles = light_triangles(scene);
    let width = count + LIGHT_TRIANGLE_COLUMNS;
    let height = spectra
        .len()
        .max(triangles.len().div_ceil(LIGHT_TRIANGLE_COLUMNS))
        .max(1);
    let size = [width as u32, height as u32];
    let texture = transfer
        .texture(what, size, 1, 1, TextureFormat::Rgba32Float)
        .await?;
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
    transfer.write_texture(
        what,
        &texture,
        TexturePosition::default(),
        size,
        bytemuck::cast_slice(&texels),
    );
    Ok(texture.create_view(&Default::default()))
}

/// One triangle for each place among the vertices of the lights; those that a polygon does not need are empty.
fn light_triangles(scene: &Scene) -> Vec<[usize; 3]> {
    let of_light = |light: &Light| match &light.shape {
        LightShape::Sphere { .. } => Vec::new(),
        // Shaders know them; the places are those of the ends.
        LightShape::Tube { .. } => vec![[0; 3]; 2],
        LightShape::Polygon { vertices_m, .. } => {
            let mut triangles = triangulate(vertices_m);
            triangles.resize(lights::places(light), [0; 3]);
            triangles
        }
    };
    lights::sorted(scene)
        .into_iter()
        .flat_map(of_light)
        .collect()
}

/// Uploads the start of each triangle's list and the end of the last one, then the lists.
async fn triangle_lists(
    transfer: &mut Transfer<'_>,
    source: &Source<'_>,
) -> Result<wgpu::TextureView, Error> {
    let Source {
        scene,
        index,
        method,
        ..
    } = source;
    let what = "triangle lists";
    if method.published.map(|m| m.structure) != Some(Structure::TriangleLists) {
        return none(transfer, what, TextureFormat::R32Uint).await;
    }
    let lists = TriangleLists::build(scene, index);
    let first = lists.starts.len();
    let count = first + lists.segments.len();
    let allowed = u64::from(ROW_TEXELS) * u64::from(transfer.gpu.limits().max_texture_dimension_2d);
    if count as u64 > allowed {
        return Err(transfer
            .gpu
            .too_large(what, count as u64, allowed, "entries"));
    }
    let mut words: Vec<u32> = lists
        .starts
        .iter()
        .map(|start| start + first as u32)
        .collect();
    words.extend(&lists.segments);
    words.resize(count.next_multiple_of(ROW_TEXELS as usize), 0);
    let size = [ROW_TEXELS, (words.len() / ROW_TEXELS as usize) as u32];
    let texture = transfer
        .texture(what, size, 1, 1, TextureFormat::R32Uint)
        .await?;
    transfer.write_texture(
        what,
        &texture,
        TexturePosition::default(),
        size,
        bytemuck::cast_slice(&words),
    );
    Ok(texture.create_view(&Default::default()))
}

async fn none(
    transfer: &Transfer<'_>,
    what: &str,
    format: TextureFormat,
) -> Result<wgpu::TextureView, Error> {
    let texture = transfer.texture(what, [1, 1], 1, 1, format).await?;
    Ok(texture.create_view(&Default::default()))
}
