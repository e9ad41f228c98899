//! The thread of a comparison: a small reference at once, then one as large as a round of samples soon fills, ever less noisy.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;

use egui::{Color32, ColorImage};
use hairline_image::metrics::{ErrorMap, error_map};
use hairline_image::{Display, Image, Layer, Picture, ToneMap, png};
use hairline_index::{Groove, ScratchIndex, SegmentTree, groove_index};
use hairline_reference::{BATCH_SAMPLES, Integrator, SceneIndex, Settings};
use hairline_render::{Painter, Task};
use hairline_scene::{Camera, Scene, Transport};
use web_time::Instant;

use super::figures::Figures;
use crate::jobs::Stop;
use crate::progressive::{Built, Wake};

/// Request for a comparison.
#[derive(Clone)]
pub(super) struct ComparisonRequest {
    pub built: Arc<Built>,
    pub camera: Camera,
    /// Size of the picture in the window: the comparison is no larger, and has its shape.
    pub shown_px: [u32; 2],
    pub filter_std_px: f64,
    pub transport: Transport,
    /// Whether the comparison has the picture's size, however long it takes.
    pub full_size: bool,
}

impl ComparisonRequest {
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.built, &other.built)
            && self.camera == other.camera
            && self.shown_px == other.shown_px
            && self.filter_std_px == other.filter_std_px
            && self.transport == other.transport
            && self.full_size == other.full_size
    }

    /// The reference has the picture's shadows and bounces.
    fn settings(&self) -> Settings {
        Settings {
            shadows: self.transport.shadows,
            bounces: self.transport.bounces,
            ..Settings::default()
        }
    }

    /// The scene in the shape of the window, of at most so many pixels.
    fn scene(&self, most_px: f64) -> Scene {
        let mut scene = self.built.scene.clone();
        scene.camera = self.camera;
        scene.render.filter_std_px = self.filter_std_px;
        scene.render.size_px = scaled(self.shown_px, most_px);
        scene
    }
}

fn scaled(shown_px: [u32; 2], most_px: f64) -> [u32; 2] {
    let shown = shown_px.map(|side| f64::from(side.max(1)));
    let scale = (most_px / (shown[0] * shown[1])).sqrt().min(1.0);
    shown.map(|side| ((side * scale).round() as u32).max(1))
}

/// Largest number of straight pieces of a comparison. A piece takes some 200 bytes in the tree and while it is built: this is
/// 600 MB, built in a few seconds.
const MOST_PIECES: usize = 3_000_000;

/// Reason why there can be no reference of the scene, in words for the artist.
pub(super) fn refusal(built: &Built) -> Option<String> {
    let (_, pieces) = built.scratch_counts();
    (pieces > MOST_PIECES).then(|| {
        format!(
            "The reference keeps each scratch as it lies, and takes at most {} million straight pieces; this scene has \
             {:.1} million. Hide some layers, or run `hairline reference` where there is more memory.",
            MOST_PIECES / 1_000_000,
            pieces as f64 * 1e-6
        )
    })
}

/// The reference's tree, for as long as the scratches stay.
#[derive(Default)]
pub(super) struct ReferenceTree(Option<(Weak<ScratchIndex>, Arc<SegmentTree<Groove>>)>);

impl ReferenceTree {
    fn grooves(&self, built: &Built) -> Option<Arc<SegmentTree<Groove>>> {
        let (scratches, grooves) = self.0.as_ref()?;
        let is_same = scratches.ptr_eq(&Arc::downgrade(&built.scratches));
        is_same.then(|| Arc::clone(grooves))
    }
}

/// A reference and the picture beside it, as far as they have come.
pub(super) struct Comparison {
    /// Counts up.
    pub number: u64,
    pub reference: Picture,
    /// Mean number of samples of the reference's pixels.
    pub samples: f64,
    /// Comparison with the closed form; none at first, since that takes longer than the first samples.
    pub compared: Option<Compared>,
}

/// Differences of picture and reference.
pub(super) struct Compared {
    /// Differences in false colours.
    pub errors: Arc<ColorImage>,
    /// Relative errors of the darkest and the brightest colour.
    pub range: [f64; 2],
    pub figures: Figures,
}

/// Report of the thread to the window.
#[derive(Clone)]
pub(super) struct Report {
    newest: Arc<Mutex<Option<Arc<Comparison>>>>,
    wake: Wake,
}

impl Report {
    pub fn new(wake: Wake) -> Self {
        Self {
            newest: Arc::default(),
            wake,
        }
    }

    pub fn newest(&self) -> Option<Arc<Comparison>> {
        lock(&self.newest).clone()
    }

    fn put(&self, shown: Comparison) {
        *lock(&self.newest) = Some(Arc::new(shown));
        (self.wake)();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Pixels of the reference that comes at once.
const FIRST_PX: f64 = 1500.0;
/// Least size of the reference that is refined: with fewer pixels there is nothing to see, with more the noise stays.
const LEAST_PX: f64 = 12_000.0;
const MOST_PX: f64 = 160_000.0;
/// Longest time of a round of one batch for each pixel.
const ROUND: Duration = Duration::from_secs(4);
/// Interval between two pictures in the window.
const REFRESH: Duration = Duration::from_millis(700);
/// Then no eye sees noise any more.
const ENOUGH_SAMPLES: u32 = 1 << 16;

pub(super) fn is_enough(samples: f64) -> bool {
    samples >= f64::from(ENOUGH_SAMPLES)
}

/// Samples of the closed form on edges.
const PICTURE_SAMPLES: u32 = 16;
/// Number of pixels in its first band.
const BAND_PX: u32 = 1 << 12;

/// Adds samples until there are enough or `stop` is set, which is checked within each batch.
pub(super) fn run(
    wanted: &ComparisonRequest,
    stop: &Stop,
    report: &Report,
    kept: &Mutex<ReferenceTree>,
) {
    let built = &wanted.built;
    let earlier = lock(kept).grooves(built);
    let grooves = earlier.unwrap_or_else(|| Arc::new(groove_index::build(&built.scene)));
    lock(kept).0 = Some((Arc::downgrade(&built.scratches), Arc::clone(&grooves)));
    let (triangles, tables) = (Arc::clone(&built.triangles), Arc::clone(&built.tables));
    let parts = SceneIndex::from_parts(&built.scene, triangles, grooves, tables);
    let first = wanted.scene(FIRST_PX);
    let start = Instant::now();
    let Some(coarse) = one_round(&first, wanted.settings(), &parts, stop) else {
        return;
    };
    let seconds_per_px = start.elapsed().as_secs_f64() / coarse.pixel_count() as f64;
    report.put(Comparison {
        number: 1,
        reference: coarse.beauty(),
        samples: f64::from(BATCH_SAMPLES),
        compared: None,
    });
    let most_px = match wanted.full_size {
        true => f64::INFINITY,
        false => (ROUND.as_secs_f64() / seconds_per_px.max(1e-9)).clamp(LEAST_PX, MOST_PX),
    };
    let scene = wanted.scene(most_px);
    refine(wanted, &scene, &parts, &coarse, stop, report);
}

fn refine(
    wanted: &ComparisonRequest,
    scene: &Scene,
    parts: &SceneIndex,
    coarse: &Image,
    stop: &Stop,
    report: &Report,
) {
    let go_on = |_| !stop.is_asked();
    let task = Task {
        // Only what several points of a lens see is filtered, before it is averaged.
        is_filtered: scene.camera.has_lens(),
        band_px: Some(BAND_PX),
        ..Task::new(PICTURE_SAMPLES, wanted.transport)
    };
    let mut painter = Painter::on_cpu(wanted.built.parts(), task);
    let rendered = pollster::block_on(painter.render(scene, &go_on));
    let Some(rendered) = rendered.ok().flatten().filter(|it| it.is_whole()) else {
        return;
    };
    let integrator = Integrator::from_parts(scene, wanted.settings(), parts.clone());
    let mut sampled = Sampled {
        picture: rendered.image,
        reference: integrator.start(),
    };
    let mut number = 1;
    let mut is_complete = false;
    while !is_complete && !stop.is_asked() {
        let start = Instant::now();
        let observe = |_| {
            if stop.is_asked() || start.elapsed() > REFRESH {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let flow = integrator.run(&mut sampled.reference, ENOUGH_SAMPLES, &observe);
        is_complete = flow.is_continue();
        if !stop.is_asked() {
            number += 1;
            report.put(sampled.shown(number, coarse));
        }
    }
}

/// A reference with a batch for each pixel. None if `stop` was asked.
fn one_round(scene: &Scene, settings: Settings, parts: &SceneIndex, stop: &Stop) -> Option<Image> {
    let integrator = Integrator::from_parts(scene, settings, parts.clone());
    let observe = |_| {
        if stop.is_asked() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let mut reference = integrator.start();
    let flow = integrator.run(&mut reference, BATCH_SAMPLES, &observe);
    flow.is_continue().then_some(reference)
}

/// A picture and a reference of the same size.
struct Sampled {
    picture: Image,
    reference: Image,
}

impl Sampled {
    /// Comparison as the window shows it. Pixels without samples have the colours of `coarse`, and no error.
    fn shown(&self, number: u64, coarse: &Image) -> Comparison {
        let size_px = self.reference.size_px;
        let noise = self.reference.noise.as_ref();
        let is_sampled: Vec<bool> = noise.map_or_else(Vec::new, |noise| {
            noise.samples.iter().map(|&n| n > 0).collect()
        });
        let mut reference = self.reference.beauty();
        let ErrorMap {
            picture: errors,
            lowest,
            highest,
        } = error_map(size_px, &self.picture.layer(Layer::Beauty), &reference.rgb);
        let codes = png::quantize(&errors, &AS_IT_IS);
        let mut errors = ColorImage::from_rgb(size_px.map(|side| side as usize), &codes);
        let coarse = coarse.beauty();
        for (i, _) in is_sampled.iter().enumerate().filter(|(_, is)| !**is) {
            reference.rgb[i] = nearest(&coarse, size_px, i);
            errors.pixels[i] = UNKNOWN;
        }
        let figures = Figures::measure(&self.picture, &self.reference, &is_sampled);
        Comparison {
            number,
            reference,
            samples: figures.samples,
            compared: Some(Compared {
                errors: Arc::new(errors),
                range: [lowest, highest],
                figures,
            }),
        }
    }
}

/// Display settings for colours that are tone-mapped already.
const AS_IT_IS: Display = Display {
    exposure_ev: 0.0,
    tone_map: ToneMap::None,
};
/// A colour that the error map does not have.
const UNKNOWN: Color32 = Color32::from_gray(70);

/// Colour of the pixel of a smaller picture at the place of pixel `i` of a picture of `size_px`.
fn nearest(picture: &Picture, size_px: [u32; 2], i: usize) -> [f32; 3] {
    let width = size_px[0].max(1) as usize;
    let at = [i % width, i / width];
    let [x, y] = std::array::from_fn(|axis| {
        let share = (at[axis] as f64 + 0.5) / f64::from(size_px[axis].max(1));
        let side = picture.size_px[axis];
        ((share * f64::from(side)) as u32).min(side - 1)
    });
    picture.pixel(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_has_the_shape_of_the_window_and_is_not_larger() {
        assert_eq!(scaled([1600, 900], 1600.0 * 900.0 / 4.0), [800, 450]);
        assert_eq!(scaled([160, 90], 1e6), [160, 90]);
        assert_eq!(scaled([4000, 1], 100.0), [632, 1]);
    }

    #[test]
    fn a_pixel_without_samples_is_that_of_the_coarse_picture() {
        let mut coarse = Picture::new([2, 1]);
        coarse.rgb[1] = [1.0; 3];
        let row: Vec<f32> = (0..4).map(|i| nearest(&coarse, [4, 1], i)[0]).collect();
        assert_eq!(row, [0.0, 0.0, 1.0, 1.0]);
    }
}
