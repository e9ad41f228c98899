//! The pictures of an export, one after the other: rendered, written whole, then the next.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use hairline_document::{Description, description};
use hairline_editor::navigate::{self, Turns};
use hairline_gpu::{AdapterKind, Gpu, GpuScene, Method, RenderOptions, Renderer};
use hairline_image::{
    Animation, Batches, Display, FilePath, Finish, Image, Output, filter_traced, output,
};
use hairline_scene::{Camera, Scene, Transport};
use web_time::Instant;

use crate::jobs::Stop;
use crate::progressive::{Backend, Built, ViewBuilder, Wake, bands};

/// Number of pictures, and the movement of the camera between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion {
    /// One, from the camera's place.
    Still,
    /// Pictures on the way around the target. The step after the last one would complete the angle.
    Turntable {
        frames: u32,
        degrees: f64,
        turns: Turns,
    },
}

impl Motion {
    /// Path of a picture, counted from 0: NAME.png, or NAME-0001.png and on; NAME.apng and NAME.mp4 have all of them.
    pub fn path(self, path: &Path, frame: u32) -> PathBuf {
        match self {
            Self::Turntable { .. } if self.is_animation(path) => path.to_owned(),
            Self::Still => path.to_owned(),
            Self::Turntable { frames, .. } => output::numbered(path, frame + 1, frames),
        }
    }

    /// Whether all pictures go into one file.
    pub fn is_animation(self, path: &Path) -> bool {
        matches!(self, Self::Turntable { .. }) && Animation::is_asked_by(path)
    }
}

/// Request for an export.
#[derive(Clone)]
pub(super) struct Wish {
    /// Description with the export's camera, exposure and filter.
    pub description: Arc<Description>,
    /// Folder from which its paths start.
    pub base_dir: FilePath,
    pub size_px: [u32; 2],
    pub samples: u32,
    /// Shadows and bounces, as the window has them.
    pub transport: Transport,
    /// Whether the background is transparent; the environment is not seen then.
    pub is_transparent: bool,
    pub motion: Motion,
    /// Pictures of an animation in a second.
    pub fps: u16,
    /// Path of the export; a turntable's pictures have numbers in their names.
    pub path: PathBuf,
    pub backend: Backend,
}

impl Wish {
    pub fn frames(&self) -> u32 {
        match self.motion {
            Motion::Still => 1,
            Motion::Turntable { frames, .. } => frames,
        }
    }

    /// Path of a picture, counted from 0.
    pub fn frame_path(&self, frame: u32) -> PathBuf {
        self.motion.path(&self.path, frame)
    }

    /// Whether all pictures go into one file.
    pub fn is_animation(&self) -> bool {
        self.motion.is_animation(&self.path)
    }

    /// Sentence about the pictures that stay where the export ended early.
    pub fn kept(&self, written: u32) -> String {
        let name = |frame: u32| self.frame_path(frame).display().to_string();
        match written {
            _ if self.is_animation() => "No file was written.".to_owned(),
            0 => "No picture was written.".to_owned(),
            1 => format!("{} is complete and stays.", name(0)),
            _ => format!(
                "{written} of {} pictures are complete and stay, up to {}",
                self.frames(),
                name(written - 1)
            ),
        }
    }

    /// Whether its pictures are made at the same cost.
    pub fn costs_as(&self, other: &Self) -> bool {
        self.size_px == other.size_px
            && self.samples == other.samples
            && self.transport == other.transport
            && self.is_transparent == other.is_transparent
            && self.description == other.description
    }

    /// The scene's description in a picture.
    fn at(&self, frame: u32) -> Description {
        let mut moved = Description::clone(&self.description);
        if let Motion::Turntable {
            frames,
            degrees,
            turns,
        } = self.motion
        {
            let angle_rad = f64::from(frame) / f64::from(frames.max(1)) * degrees.to_radians();
            navigate::turn_table(&mut moved, turns, angle_rad);
        }
        moved
    }

    /// Whether a scene is built for each picture.
    fn moves_scene(&self) -> bool {
        match self.motion {
            Motion::Turntable { turns, .. } => turns != Turns::Camera,
            Motion::Still => false,
        }
    }

    /// Waits for work on the wish's device, which only a thread may.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn block_on(&self, working: impl Future<Output = ()>) {
        match &self.backend {
            Backend::Cpu => pollster::block_on(working),
            Backend::Gpu(gpu) | Backend::Shared(gpu) => gpu.block_on(working),
        }
    }

    fn scene(&self, built: &Built, camera: &description::Camera) -> Scene {
        let mut scene = built.scene.clone();
        scene.camera = crate::viewport::camera(camera);
        scene.render.size_px = self.size_px;
        scene.render.filter_std_px = self.description.render.filter_std_px;
        match self.is_transparent {
            true => scene.before_nothing(),
            false => scene,
        }
    }

    /// The batches that a picture's samples add up in, if they do. As many as were asked for: elsewhere a lens has 64 at least, and the form
    /// says what fewer look like.
    fn batches(&self, camera: &Camera) -> Option<Batches> {
        match camera.has_lens() {
            true => Some(Batches::new(self.samples)),
            false => self.transport.batches(camera, self.samples),
        }
    }

    fn display(&self) -> Display {
        Display {
            exposure_ev: self.description.camera.exposure_ev,
            tone_map: self.description.render.tone_map,
        }
    }
}

/// Progress of an export.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct State {
    /// Pictures that are whole and in their places.
    pub written: u32,
    /// Share of the picture that is being rendered.
    pub share: f64,
    pub end: Option<End>,
}

/// End of an export.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum End {
    Complete,
    Cancelled,
    Failed(String),
}

/// Report of the job to the window.
#[derive(Clone)]
pub(super) struct Report {
    state: Arc<Mutex<State>>,
    wake: Wake,
}

impl Report {
    pub fn new(wake: Wake) -> Self {
        Self {
            state: Arc::default(),
            wake,
        }
    }

    pub fn state(&self) -> State {
        self.lock().clone()
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tell(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.lock());
        (self.wake)();
    }
}

/// What is known of an export before it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Expected {
    /// Time of one picture.
    pub picture: Option<Duration>,
    /// Whether objects fill the picture, so that nothing of the background is seen.
    pub is_filled: bool,
}

/// Times after which the rest of a picture is guessed from its beginning: the first where the beginning is at least such a share.
const GUESS_AFTER: [Duration; 2] = [Duration::from_secs(6), Duration::from_secs(20)];
const GUESS_FROM: f64 = 0.04;
/// Width and height within which a picture shows whether objects fill it.
const SMALL_PX: u32 = 128;

/// Begins the first picture, and tells how long it will take and what will be seen.
pub(super) async fn rehearse(wish: &Wish, built: &Built, stop: &Stop, tell: &dyn Fn(Expected)) {
    let scene = wish.scene(built, &wish.description.camera);
    let mut small = scene.clone();
    small.render.size_px = fitting(wish.size_px, [SMALL_PX; 2]);
    let expected = Expected {
        picture: None,
        is_filled: wish.is_transparent
            && hairline_cpu::alpha(&small, &built.triangles, 1, 1)
                .iter()
                .all(|share| *share == 1.0),
    };
    tell(expected);
    let built = built.seen_from(&scene);
    let Ok(mut painter) = Painter::open(wish, &built).await else {
        return;
    };
    let start = Instant::now();
    let guess = |share: f64| {
        tell(Expected {
            picture: Some(start.elapsed().div_f64(share)),
            ..expected
        });
    };
    let go_on = |share: f64| {
        if share > 0.0 {
            guess(share);
        }
        let [few, enough] = GUESS_AFTER.map(|time| start.elapsed() > time);
        !(stop.is_asked() || enough || few && share >= GUESS_FROM)
    };
    if let Ok(Some(mut image)) = painter.paint(&built, &scene, wish, &go_on).await {
        filter_traced(&mut image);
        guess(1.0);
    }
}

/// Renders and writes all pictures, or fewer once `stop` is set.
pub(super) async fn run(wish: &Wish, built: &Built, stop: &Stop, report: &Report) {
    let end = match frames(wish, built, stop, report).await {
        Ok(true) => End::Complete,
        Ok(false) => End::Cancelled,
        Err(message) => End::Failed(message),
    };
    report.tell(|state| state.end = Some(end));
}

/// False if it was stopped.
async fn frames(wish: &Wish, built: &Built, stop: &Stop, report: &Report) -> Result<bool, String> {
    let mut seen = built.seen_from(&wish.scene(built, &wish.at(0).camera));
    let opened = Painter::open(wish, &seen).await;
    let mut painter = opened.map_err(|error| error.to_string())?;
    let backdrop = wish.description.backdrop(&wish.base_dir);
    let finish = Finish {
        is_deep: wish.description.render.png_bits == 16,
        behind: (backdrop.map_err(|error| error.to_string())?).map(Arc::new),
    };
    let begin = || {
        Animation::begin(
            wish.base_dir.at(&wish.path),
            wish.size_px,
            wish.frames(),
            wish.fps,
            wish.is_transparent,
            &finish,
        )
    };
    let animation = wish.is_animation().then(begin).transpose();
    let mut animation = animation.map_err(|error| error.to_string())?;
    let mut views = ViewBuilder::default();
    for frame in 0..wish.frames() {
        // Before the work: the folder may have gone meanwhile.
        let output = match animation {
            Some(_) => None,
            None => {
                let output = Output::check(wish.base_dir.at(wish.frame_path(frame)));
                Some(output.map_err(|error| error.to_string())?.finished(&finish))
            }
        };
        let go_on = |share: f64| {
            report.tell(|state| state.share = share);
            !stop.is_asked()
        };
        let now = wish.at(frame);
        let camera = now.camera.clone();
        let turned = match wish.moves_scene() && frame > 0 {
            true => {
                let cancelled = || stop.is_asked();
                let (now, asked) = (Arc::new(now), Instant::now());
                let built = views.build(&cancelled, 0, asked, now, &wish.base_dir, None);
                match built.map_err(|error| error.to_string())? {
                    None => return Ok(false),
                    built => built,
                }
            }
            false => None,
        };
        let own = turned.as_ref().unwrap_or(built);
        let scene = wish.scene(own, &camera);
        if turned.is_some() || !seen.scratches.serves(&scene.camera, scene.render.size_px) {
            seen = own.seen_from(&scene);
            let taken = painter.take(&seen, wish.transport).await;
            taken.map_err(|error| error.to_string())?;
        }
        let image = painter
            .paint(&seen, &scene, wish, &go_on)
            .await
            .map_err(|error| error.to_string())?;
        let Some(mut image) = image else {
            return Ok(false);
        };
        filter_traced(&mut image);
        if stop.is_asked() {
            return Ok(false);
        }
        if wish.is_transparent {
            let batches = wish.batches(&scene.camera);
            let all = batches.map_or(wish.samples, |it| it.samples());
            let (triangles, shadows) = (&seen.triangles, wish.transport.shadows);
            let is_stopped = || stop.is_asked();
            let alpha =
                hairline_cpu::picture_alpha(&scene, triangles, [all; 2], shadows, &is_stopped);
            image.alpha = Some(alpha);
        }
        let written = match (&mut animation, &output) {
            (Some(animation), _) => animation.add(&image, &wish.display()),
            (None, Some(output)) => output.write_image(&image, &wish.display()),
            (None, None) => Ok(()),
        };
        written.map_err(|error| error.to_string())?;
        report.tell(|state| {
            state.written += 1;
            state.share = 0.0;
        });
    }
    let finished = animation.map_or(Ok(()), Animation::finish);
    finished.map_err(|error| error.to_string())?;
    Ok(true)
}

/// Pixels of the first band on the CPU.
const CPU_BAND_PX: u32 = 1 << 13;
/// Pixels between two looks at whether to go on, on a driver that computes on the CPU; with all their samples.
const SOFTWARE_BAND_PX: u32 = 1 << 13;
/// Pixels between two looks on a GPU.
const HARDWARE_BAND_PX: u32 = 1 << 19;

/// Renderer of the export: of the same kind as the window's painter, but one of its own.
enum Painter {
    Cpu,
    Gpu {
        renderer: Box<Renderer>,
        uploaded: Box<GpuScene>,
        band_px: u32,
    },
}

impl Painter {
    async fn open(wish: &Wish, built: &Built) -> Result<Self, hairline_gpu::Error> {
        match &wish.backend {
            Backend::Cpu => Ok(Self::Cpu),
            Backend::Gpu(gpu) | Backend::Shared(gpu) => {
                Self::on_gpu(gpu, built, wish.transport).await
            }
        }
    }

    async fn on_gpu(
        gpu: &Gpu,
        built: &Built,
        transport: Transport,
    ) -> Result<Self, hairline_gpu::Error> {
        let Built {
            scene,
            scratches,
            tables,
            ..
        } = built;
        let mut renderer = Renderer::new(gpu).await?;
        let method = Method::default();
        let mut uploaded = renderer.upload(scene, scratches, tables, &method).await?;
        if transport.shadows {
            let added = renderer.add_shadows(&mut uploaded, scene, transport.bounces);
            added.await?;
        }
        Ok(Self::Gpu {
            renderer: Box::new(renderer),
            uploaded: Box::new(uploaded),
            band_px: match gpu.adapter.kind {
                AdapterKind::Software => SOFTWARE_BAND_PX,
                _ => HARDWARE_BAND_PX,
            },
        })
    }

    /// Goes on with a scene of other lights, or seen from elsewhere.
    async fn take(
        &mut self,
        built: &Built,
        transport: Transport,
    ) -> Result<(), hairline_gpu::Error> {
        let Self::Gpu {
            renderer, uploaded, ..
        } = self
        else {
            return Ok(());
        };
        let Built {
            scene,
            scratches,
            tables,
            ..
        } = built;
        let method = Method::default();
        renderer
            .update(uploaded, scene, scratches, tables, &method)
            .await?;
        if transport.shadows {
            let added = renderer.add_shadows(uploaded, scene, transport.bounces);
            added.await?;
        }
        Ok(())
    }

    /// Renders a picture; none if `go_on` said no.
    async fn paint(
        &mut self,
        built: &Built,
        scene: &Scene,
        wish: &Wish,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<Option<Image>, hairline_gpu::Error> {
        match self {
            Self::Cpu => {
                let (samples, transport) = (wish.samples, wish.transport);
                let batches = wish.batches(&scene.camera);
                Ok(bands::render(
                    built,
                    scene,
                    samples,
                    transport,
                    batches,
                    CPU_BAND_PX,
                    go_on,
                ))
            }
            Self::Gpu {
                renderer,
                uploaded,
                band_px,
            } => {
                let mut options = RenderOptions {
                    samples: wish.samples,
                    ..Default::default()
                };
                let band_px = *band_px;
                let Some(mut batches) = wish.batches(&scene.camera) else {
                    return on_gpu_in_bands(renderer, uploaded, scene, &options, band_px, go_on)
                        .await;
                };
                options.samples = batches.samples();
                while let Some(batch) = batches.next() {
                    options.batch = Some(batch);
                    let (first, count) = (f64::from(batch.first), f64::from(batch.count));
                    let all = f64::from(options.samples);
                    let go_on = |share: f64| go_on((first + count * share) / all);
                    let part =
                        on_gpu_in_bands(renderer, uploaded, scene, &options, band_px, &go_on);
                    match part.await? {
                        Some(image) => batches.add(image),
                        None => return Ok(None),
                    }
                }
                Ok(batches.into_image())
            }
        }
    }
}

/// Renders a picture on a GPU in bands; none if `go_on` said no.
async fn on_gpu_in_bands(
    renderer: &mut Renderer,
    uploaded: &GpuScene,
    scene: &Scene,
    options: &RenderOptions,
    band_px: u32,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Option<Image>, hairline_gpu::Error> {
    let size_px = scene.render.size_px;
    let mut image = Image::new(size_px);
    for (done, rows) in bands::spread(size_px, band_px) {
        if !go_on(done) {
            return Ok(None);
        }
        let part = renderer.render_rows(scene, uploaded, options, rows.clone(), &|_| {});
        bands::put_rows(&mut image, bands::pixels(size_px, rows), &part.await?);
    }
    Ok(Some(image))
}

/// The largest size of the shape of `scene_px` within `within_px`.
pub(super) fn fitting(scene_px: [u32; 2], within_px: [u32; 2]) -> [u32; 2] {
    let [width, height] = scene_px.map(|side| f64::from(side.max(1)));
    let scale = (f64::from(within_px[0]) / width).min(f64::from(within_px[1]) / height);
    [width, height].map(|side| ((side * scale).round() as u32).max(1))
}
