//! Scenes and the way to a picture that several tests take.

#![allow(dead_code, reason = "each test uses a part")]

use std::sync::Arc;

use hairline_fixtures::{DISK, SceneFile};
use hairline_gpu::headless::{self, test_gpu};
use hairline_gpu::{AdapterRequest, Canvas, Error, Gpu, GpuScene, Method, RenderOptions, Renderer};
use hairline_image::Image;
use hairline_index::ScratchIndex;
use hairline_scene::{Scene, ScratchTables};

/// The rim of a plate with scratches on a table, under a lamp and a tube; so near that no pixel sees many scratches.
pub fn plates() -> SceneFile {
    SceneFile::seen_from([0.0, -0.22, 0.30])
        .looking_at([0.0, -0.075, 0.0])
        .fov_y_deg(6.0)
        .size_px([97, 64])
        .metal("steel", "steel")
        .with_lines("roughness = 0.2")
        .part("[[material]]\nname = \"wood\"\nkind = \"dielectric\"")
        .with_lines("base_color = [0.4, 0.3, 0.2]\nroughness = 0.6")
        .object("plate", "steel", DISK)
        .object("table", "wood", "plane = { size_m = [0.5, 0.5] }")
        .with_lines("translation_m = [0.0, 0.0, -0.01]")
        .random("plate", 1000)
        .with_lines("seed = 3\nlength_m = 0.03\nwidth_um = 3.0\ndepth_nm = 200.0")
        .sphere([0.02, 0.3, 0.3], 0.02, 40.0)
        .polygon(&TUBE_M, 3.0)
}

const TUBE_M: [[f64; 3]; 4] = [
    [-0.2, 0.3, 0.2],
    [0.2, 0.3, 0.2],
    [0.2, 0.25, 0.3],
    [-0.2, 0.25, 0.3],
];

/// Scene that `hairline render` shows without a file.
pub const BUILT_IN: &str = include_str!("../../../../crates/console/src/built_in_scene.toml");

pub fn scene(text: &str) -> Scene {
    hairline_document::from_toml(text, "test", ".").unwrap_or_else(|error| panic!("{error}"))
}

/// Opens a device of its own with the limits of a browser; none where tests have no adapter.
pub fn default_limits() -> Option<Gpu> {
    test_gpu()?;
    let request = AdapterRequest {
        default_limits: true,
        ..Default::default()
    };
    Some(headless::open(&request).unwrap())
}

/// A scene with its trees and tables, as an editor keeps it.
#[derive(Clone)]
pub struct Made {
    pub scene: Scene,
    pub index: Arc<ScratchIndex>,
    pub tables: Arc<ScratchTables>,
    pub method: Method,
}

impl Made {
    pub fn new(scene: Scene) -> Self {
        Self {
            index: Arc::new(ScratchIndex::build(&scene)),
            tables: Arc::new(ScratchTables::new(&scene)),
            method: Method::default(),
            scene,
        }
    }

    pub async fn upload(&self, renderer: &mut Renderer) -> Result<GpuScene, Error> {
        renderer
            .upload(&self.scene, &self.index, &self.tables, &self.method)
            .await
    }

    pub async fn update(
        &self,
        renderer: &mut Renderer,
        uploaded: &mut GpuScene,
    ) -> Result<(), Error> {
        renderer
            .update(
                uploaded,
                &self.scene,
                &self.index,
                &self.tables,
                &self.method,
            )
            .await
    }

    pub async fn render(
        &self,
        renderer: &mut Renderer,
        uploaded: &GpuScene,
    ) -> Result<Image, Error> {
        let options = Default::default();
        renderer
            .render(&self.scene, uploaded, &options, &|_| {})
            .await
    }
}

/// A renderer with a scene.
pub struct Stage {
    pub gpu: Gpu,
    pub renderer: Renderer,
    pub made: Made,
    pub uploaded: GpuScene,
}

impl Stage {
    pub fn new(gpu: &Gpu, scene: Scene) -> Self {
        let made = Made::new(scene);
        let mut renderer = gpu.block_on(Renderer::new(gpu)).unwrap();
        let uploaded = gpu.block_on(made.upload(&mut renderer)).unwrap();
        Self {
            gpu: gpu.clone(),
            renderer,
            made,
            uploaded,
        }
    }

    pub fn canvas(&self, size_px: [u32; 2], submission_px: u32) -> Canvas {
        let canvas = self.renderer.canvas(size_px, submission_px);
        self.gpu.block_on(canvas).unwrap()
    }

    /// Adds one step to one band, and waits until it is there.
    pub fn accumulate(
        &mut self,
        canvas: &mut Canvas,
        band: usize,
        step: u32,
        samples: u32,
    ) -> Result<(), Error> {
        let Self {
            gpu,
            renderer,
            made,
            uploaded,
        } = self;
        let (scene, uploaded) = (&made.scene, &*uploaded);
        let options = options(samples);
        gpu.block_on(async {
            renderer
                .accumulate(scene, uploaded, canvas, band, step, &options)
                .await?;
            renderer.settle(scene, uploaded, canvas, &options).await
        })
    }

    /// Adds the steps up to `end` of those for `samples` to all bands.
    pub fn paint(&mut self, canvas: &mut Canvas, end: u32, samples: u32) {
        for band in 0..canvas.bands() {
            for step in canvas.steps(band)..end {
                self.accumulate(canvas, band, step, samples).unwrap();
            }
        }
    }
}

/// Options with this number of samples.
pub fn options(samples: u32) -> RenderOptions {
    RenderOptions {
        samples,
        ..Default::default()
    }
}
