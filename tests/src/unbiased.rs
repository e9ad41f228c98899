//! Shadows and bounces against the path tracer: the scenes of `tests/shadows`, their pictures, the expected pictures, and the errors.

use glam::DVec2;
use hairline_image::metrics::ZTest;
use hairline_image::{Image, Layer, Layers, Noise};
use hairline_index::TriangleIndex;
use hairline_optics::mask::Mask;
use hairline_reference::{BATCH_SAMPLES, Integrator, SceneIndex, Settings};
use hairline_render::failure::Failure;
use hairline_render::{Backend, Painter, Quiet, Task};
use hairline_scene::{Scene, Transport};
use std::ops::ControlFlow;
use std::path::Path;

/// The scenes by the names of their files, and objects outside of the picture that hide light.
pub const SCENES: [(&str, &[&str]); 6] = [
    ("edge", &["board"]),
    ("sheets", &["sheet", "other sheet"]),
    ("slit", &["left board"]),
    ("corner", &[]),
    ("mirrors", &[]),
    ("sky", &[]),
];

/// The layers that light reaches.
pub const LAYERS: [Layer; 2] = [Layer::Base, Layer::Scratches];

/// The mask that is linear in the shares: of both methods it makes the same of a pixel.
const MASK: Mask = Mask::Linear;

/// Loads one of [`SCENES`].
///
/// # Panics
/// Panics where it cannot be loaded.
pub fn scene(name: &str) -> Scene {
    read(name, |text| text)
}

/// Loads the scene with lights and sky brighter by a part.
///
/// # Panics
/// Panics where it cannot be loaded.
pub fn brighter(name: &str, part: f64) -> Scene {
    let factor = 1.0 + part;
    read(name, |text| {
        text.replace("radiance = 10.0", &format!("radiance = {}", 10.0 * factor))
            .replace(
                "[environment]",
                &format!("[environment]\nintensity = {factor}"),
            )
    })
}

/// Removes some objects from a scene.
pub fn without_objects(mut scene: Scene, objects: &[&str]) -> Scene {
    scene
        .objects
        .retain(|object| !objects.contains(&object.name.as_str()));
    scene
}

fn read(name: &str, changed: impl Fn(String) -> String) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shadows");
    let path = folder.join(format!("{name}.toml"));
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    hairline_document::from_toml(&changed(text), name, &folder)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Renders as `hairline render` does, except that fireflies stay.
///
/// # Errors
/// Those of [`Painter::choose`] and [`Painter::render_now`].
pub fn rendered(
    scene: &Scene,
    backend: Backend,
    samples: u32,
    transport: Transport,
) -> Result<Image, Failure> {
    let task = Task {
        mask: MASK,
        is_filtered: false,
        ..Task::new(samples, transport)
    };
    let mut painter = Painter::choose(scene, backend, task, &Quiet)?;
    Ok(painter.render_now(scene, &|_| true)?.image)
}

/// Expected picture with shadows and bounces: that of the path tracer, and as much of the closed form's own error as is seen of the light. With
/// F the closed form and f the path tracer's light where nothing hides anything, s with shadows and b with bounces, that is b + s/f (F - f):
/// (41) of docs/model.md has this mean. All three take the same samples, so that where nothing is hidden no noise is left.
///
/// `open` is F.
pub fn expected(scene: &Scene, open: &Image, bounces: u32, samples: u32) -> Image {
    let parts = SceneIndex::new(scene);
    let mut settings = vec![(false, 0), (true, 0), (true, bounces)];
    settings.dedup();
    let start = |(shadows, bounces)| {
        let settings = Settings {
            mask: MASK,
            shadows,
            bounces,
            ..Settings::default()
        };
        let integrator = Integrator::from_parts(scene, settings, parts.clone());
        let image = integrator.start();
        (integrator, image)
    };
    let mut runs: Vec<_> = settings.into_iter().map(start).collect();
    let mut sums = LAYERS.map(|_| vec![[Sums::default(); 3]; open.pixel_count()]);
    let batches = samples.div_ceil(BATCH_SAMPLES);
    for batch in 0..batches {
        let add = |(integrator, image): &mut (Integrator, Image)| {
            let before = LAYERS.map(|layer| image.layer(layer));
            let samples = (batch + 1) * BATCH_SAMPLES;
            let _ = integrator.run(image, samples, &|_| ControlFlow::Continue(()));
            (before, LAYERS.map(|layer| image.layer(layer)))
        };
        let added: Vec<_> = runs.iter_mut().map(add).collect();
        // Without bounces the last run is that of shadows alone.
        let runs = [&added[0], &added[1], &added[added.len() - 1]];
        // The image has the mean of all batches.
        let n = f64::from(batch);
        for (l, sums) in sums.iter_mut().enumerate() {
            for (i, sums) in sums.iter_mut().enumerate() {
                for (c, sums) in sums.iter_mut().enumerate() {
                    sums.add(runs.map(|(before, after)| {
                        f64::from(after[l][i][c]) * (n + 1.0) - f64::from(before[l][i][c]) * n
                    }));
                }
            }
        }
    }
    let mut image = open.clone();
    let mut noise = Noise::new(image.size_px, BATCH_SAMPLES);
    noise.samples.fill(batches * BATCH_SAMPLES);
    let [base, scratches] = &sums;
    let layers = [
        (base, &mut image.base, &mut noise.base),
        (scratches, &mut image.scratches, &mut noise.scratches),
    ];
    for (sums, values, variances) in layers {
        for (i, sums) in sums.iter().enumerate() {
            for (c, sums) in sums.iter().enumerate() {
                let (mean, variance) = sums.expected(f64::from(values[i][c]), f64::from(batches));
                values[i][c] = mean as f32;
                variances[i][c] = variance as f32;
            }
        }
    }
    image.noise = Some(noise);
    image
}

/// Sums over the batches of a value: f and b, their squares and their product, and s.
#[derive(Clone, Copy, Default)]
struct Sums {
    open: f64,
    direct: f64,
    all: f64,
    open2: f64,
    all2: f64,
    product: f64,
}

impl Sums {
    fn add(&mut self, [open, direct, all]: [f64; 3]) {
        self.open += open;
        self.direct += direct;
        self.all += all;
        self.open2 += open * open;
        self.all2 += all * all;
        self.product += open * all;
    }

    /// Given F; with the variance.
    fn expected(&self, closed: f64, batches: f64) -> (f64, f64) {
        let share = if self.open == 0.0 {
            0.0
        } else {
            (self.direct / self.open).clamp(0.0, 1.0)
        };
        let mean = (self.all - share * self.open) / batches;
        let squares = self.all2 - 2.0 * share * self.product + share * share * self.open2;
        let variance = (squares - batches * mean * mean) / (batches * (batches - 1.0));
        (mean + share * closed, variance.max(0.0))
    }
}

/// Error of a layer.
#[derive(Clone, Copy, Debug)]
pub struct LayerError {
    /// The error of the picture's mean, over the mean without shadows.
    pub off: f64,
    /// One standard deviation of that, by how much the pixels' errors scatter.
    pub off_std: f64,
    /// Rms error of a pixel over the same, without the noise of the expected picture.
    pub rms: f64,
    /// Z-test of the values by the noise that both pictures state.
    pub z: ZTest,
}

/// Mask of pixels that show one object alone, as far as a pixel's filter reaches. On an outline the path tracer averages over the filter, and
/// the renderers over the pixel: both objects are right there, but not their parts of the pixel.
pub fn interior_mask(scene: &Scene) -> Vec<bool> {
    let size_px = scene.render.size_px;
    let triangles = TriangleIndex::build(scene);
    let camera = scene.camera.frame(size_px);
    let object = |x: i32, y: i32| {
        let ray = camera.camera_ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        let hit = triangles.intersect(camera.position_m, ray.normalize());
        hit.map(|hit| hit.object)
    };
    let [width, height] = size_px.map(|side| side as i32);
    let around = |at: i32| at - FILTER_REACH_PX..=at + FILTER_REACH_PX;
    let is_inside = |x: i32, y: i32| {
        let own = object(x, y);
        around(y).all(|y| around(x).all(|x| object(x, y) == own))
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.map(|(x, y)| is_inside(x, y)).collect()
}

/// Reach of a pixel's filter in pixels, five standard deviations.
const FILTER_REACH_PX: i32 = 3;

/// Compares a layer of a picture of several batches with that of [`expected`], where the picture is [`interior_mask`]; `open` is that without shadows.
///
/// # Panics
/// Where none of the two knows its noise.
pub fn layer_error(
    image: &Image,
    expected: &Image,
    open: &Image,
    layer: Layer,
    inside: &[bool],
) -> LayerError {
    let (a, b) = (Layers::from(image), Layers::from(expected));
    let [a, b] = [&a, &b].map(|held| held.estimate(layer).expect("all layers are there"));
    let pixels = || (0..inside.len()).filter(|i| inside[*i]);
    let sum = |rgb: [f32; 3]| rgb.iter().map(|c| f64::from(*c)).sum::<f64>();
    let errors = || pixels().map(|i| sum(a.values[i]) - sum(b.values[i]));
    let squares: f64 = errors().map(|e| e * e).sum();
    // The channels of a pixel err together.
    let std = |v: [f32; 3]| v.iter().map(|v| f64::from(*v).sqrt()).sum::<f64>();
    let variance = b.variance.expect("the path tracer knows its noise");
    let noise: f64 = pixels().map(|i| std(variance[i]).powi(2)).sum();
    let open = open.layer(layer);
    let all: f64 = pixels().map(|i| sum(open[i])).sum();
    let count = pixels().count() as f64;
    LayerError {
        off: errors().sum::<f64>() / all,
        off_std: squares.sqrt() / all,
        rms: (squares - noise).max(0.0).sqrt() * count.sqrt() / all,
        z: ZTest::compare(image.size_px, &a, &b, Some(inside)).expect("both are estimates"),
    }
}
