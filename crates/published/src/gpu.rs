//! The method on the GPU: its pass, and what the pass looks up: the wavelengths of each material, the triangles of each light, and the
//! scratches by the tree or by triangle.

use hairline_gpu::method::{ROW_TEXELS, ShadingMethod, Table, TableSource, Texels};
use hairline_gpu::shaders::Module;
use hairline_optics::lobe_table::LOBE_TABLE_SIZE;
use hairline_scene::{Light, LightShape};

use crate::polygon::triangulate;
use crate::shaders::SHADE_PUBLISHED;
use crate::sine_integral::SineIntegral;
use crate::spectrum::{PUBLISHED_WAVELENGTHS, published_spectra};
use crate::sptd::sptd_table;
use crate::switches::{PublishedMethod, Structure};
use crate::triangle_lists::TriangleLists;

/// Columns beyond the wavelengths. Twin: published_lights.wgsl.
const LIGHT_TRIANGLE_COLUMNS: usize = 64;

include!(concat!(env!("OUT_DIR"), "/tables.rs"));

impl ShadingMethod for PublishedMethod {
    fn module(&self) -> &'static Module {
        &SHADE_PUBLISHED
    }

    fn constants(&self) -> Vec<(&'static str, f64)> {
        vec![
            (
                "PUBLISHED_LISTS",
                (self.structure == Structure::TriangleLists).into(),
            ),
            ("PUBLISHED_ANTI_ALIASING", self.anti_aliasing.into()),
            ("PUBLISHED_FAST_SI", (self.si == SineIntegral::Fast).into()),
        ]
    }

    fn tables(&self, of: &TableSource<'_>) -> Vec<Table> {
        let (lists, nodes) = match self.structure {
            Structure::TriangleLists => (triangle_lists(of), Vec::new()),
            Structure::Bvh => (Vec::new(), of.scratch_nodes()),
        };
        let tables = Tables {
            published_wavelengths: wavelengths(of),
            triangle_lists: Table {
                what: "triangle lists",
                width: ROW_TEXELS,
                texels: Texels::Words(lists),
            },
            scratch_nodes: Table {
                what: "scratch tree",
                width: ROW_TEXELS,
                texels: Texels::Integers(nodes),
            },
            lobe_sptd: Table {
                what: "sphere lobe table",
                width: LOBE_TABLE_SIZE as u32,
                texels: Texels::Floats(sptd_table().texels().to_vec()),
            },
        };
        tables.in_order()
    }
}

/// A row of wavelengths for each scratch table: weights in the three channels, wavelength in um. In columns of their own
/// beside them the triangles of the lights, each as three vertices counted from its light's first. Triangle i of a light
/// has the place of its vertex i; a polygon has two places more than triangles.
fn wavelengths(of: &TableSource<'_>) -> Table {
    let count = PUBLISHED_WAVELENGTHS;
    let spectra = published_spectra(of.tables);
    let triangles = light_triangles(of);
    let width = count + LIGHT_TRIANGLE_COLUMNS;
    let height = spectra
        .len()
        .max(triangles.len().div_ceil(LIGHT_TRIANGLE_COLUMNS));
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
    Table {
        what: "wavelengths",
        width: width as u32,
        texels: Texels::Floats(texels),
    }
}

/// One triangle for each place among the vertices of the lights; those that a polygon does not need are empty.
fn light_triangles(of: &TableSource<'_>) -> Vec<[usize; 3]> {
    let lights = of.lights().into_iter();
    let of_light = |(light, places): (&Light, usize)| {
        let mut triangles = match &light.shape {
            // Shaders know those of a tube.
            LightShape::Sphere { .. } | LightShape::Tube { .. } => Vec::new(),
            LightShape::Polygon { vertices_m, .. } => triangulate(vertices_m),
        };
        triangles.resize(places, [0; 3]);
        triangles
    };
    lights.flat_map(of_light).collect()
}

/// The start of each triangle's list and the end of the last one, then the lists.
fn triangle_lists(of: &TableSource<'_>) -> Vec<u32> {
    let lists = TriangleLists::build(of.scene, of.index);
    let first = lists.starts.len() as u32;
    let starts = lists.starts.iter().map(|start| start + first);
    starts.chain(lists.segments.iter().copied()).collect()
}
