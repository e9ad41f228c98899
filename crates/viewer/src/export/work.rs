//! The pictures of an export, one after the other: rendered, written whole, then the next.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use hairline_document::Description;
use hairline_gpu::AdapterKind;
use hairline_image::{Animation, Display, FilePath, Finish, Notes, Output, output};
use hairline_render::{Motion, Painter, Sequence, Task, Writer};
use hairline_scene::{Scene, Transport};
use web_time::Instant;

use crate::jobs::Stop;
use crate::progressive::{Backend, Built, ViewBuilder, Wake};

/// Path of a picture, counted from 0: NAME.png, or with a motion NAME-0001.png and on; NAME.apng and NAME.mp4 have all of them.
pub(super) fn frame_path(path: &Path, motion: Option<Motion>, frame: u32) -> PathBuf {
    match motion {
        Some(Motion { frames, .. }) if !is_animation(path, motion) => {
            output::numbered(path, frame + 1, frames)
        }
        _ => path.to_owned(),
    }
}

/// Whether all pictures go into one file.
pub(super) fn is_animation(path: &Path, motion: Option<Motion>) -> bool {
    motion.is_some() && Animation::is_asked_by(path)
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
    /// The turntable; none: one picture.
    pub motion: Option<Motion>,
    /// Pictures of an animation in a second.
    pub fps: u16,
    /// Path of the export; a turntable's pictures have numbers in their names.
    pub path: PathBuf,
    pub backend: Backend,
}

impl Wish {
    pub fn frames(&self) -> u32 {
        self.motion.map_or(1, |motion| motion.frames)
    }

    /// Path of a picture, counted from 0.
    pub fn frame_path(&self, frame: u32) -> PathBuf {
        frame_path(&self.path, self.motion, frame)
    }

    /// Whether all pictures go into one file.
    pub fn is_animation(&self) -> bool {
        is_animation(&self.path, self.motion)
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

    /// The scene built anew for a picture: none where the one before serves, or once `stop` is set.
    fn build(
        &self,
        views: &mut ViewBuilder,
        frame: u32,
        stop: &Stop,
    ) -> Result<Option<Built>, hairline_document::Error> {
        let Some(motion) = self.motion.filter(|it| frame > 0 && !it.is_of_camera()) else {
            return Ok(None);
        };
        let mut now = Description::clone(&self.description);
        motion.move_scene(&mut now, frame);
        let (cancelled, asked) = (|| stop.is_asked(), Instant::now());
        views.build(&cancelled, 0, asked, now.into(), &self.base_dir, None)
    }

    /// The built scene in a picture.
    fn scene(&self, built: &Built, frame: u32) -> Scene {
        let camera = &self.description.camera;
        let turned = self.motion.map(|motion| motion.turned(camera, frame));
        let mut scene = built.scene.clone();
        scene.camera = crate::viewport::camera(turned.as_ref().unwrap_or(camera));
        scene.render.size_px = self.size_px;
        scene.render.filter_std_px = self.description.render.filter_std_px;
        scene
    }

    /// Settings of the rendering. As many samples as were asked for: elsewhere a lens has 64 at least, and the form says what fewer look like.
    fn task(&self) -> Task {
        let band_px = match self.backend.gpu().map(|gpu| gpu.adapter.kind) {
            None => CPU_BAND_PX,
            Some(AdapterKind::Software) => SOFTWARE_BAND_PX,
            Some(_) => HARDWARE_BAND_PX,
        };
        Task {
            is_transparent: self.is_transparent,
            has_coarse_lens: true,
            band_px: Some(band_px),
            ..Task::new(self.samples, self.transport)
        }
    }

    /// Renderer of the export, of the same kind as the window's painter. The window's pieces of scratches serve nearer views, too: it has its own.
    async fn open(
        &self,
        built: &Built,
        scene: &Scene,
        task: Task,
    ) -> Result<Painter<'static>, hairline_gpu::Error> {
        let parts = built.parts().seen_from(scene);
        Painter::open(self.backend.gpu(), scene, parts, task, None).await
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

    fn tell_share(&self, share: f64) {
        if self.lock().share != share {
            self.tell(|state| state.share = share);
        }
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
pub(super) async fn rehearse(
    wish: &Wish,
    built: &Built,
    stop: &Stop,
    tell: &(dyn Fn(Expected) + Sync),
) {
    let mut scene = wish.scene(built, 0);
    if wish.is_transparent {
        scene = scene.before_nothing();
    }
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
    let task = Task {
        is_transparent: false,
        ..wish.task()
    };
    let opening = wish.open(built, &scene, task);
    let Ok(mut painter) = opening.await else {
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
    if let Ok(Some(rendered)) = painter.render(&scene, &go_on).await
        && rendered.is_whole()
    {
        guess(1.0);
    }
}

/// Renders and writes all pictures, or fewer once `stop` is set.
pub(super) async fn run(wish: &Wish, built: &Built, stop: &Stop, report: &Report) {
    let end = match frames(wish, built, stop, report).await {
        Ok(true) => End::Complete,
        Ok(false) => End::Cancelled,
        Err(error) => End::Failed(error.to_string()),
    };
    report.tell(|state| state.end = Some(end));
}

/// False if it was stopped.
async fn frames(
    wish: &Wish,
    built: &Built,
    stop: &Stop,
    report: &Report,
) -> Result<bool, Box<dyn Error>> {
    let mut painter = wish.open(built, &wish.scene(built, 0), wish.task()).await?;
    let backdrop = wish.description.backdrop(&wish.base_dir)?;
    let begin = |finish: &Finish| {
        let (path, has_alpha) = (wish.base_dir.with_path(&wish.path), wish.is_transparent);
        Animation::begin(
            path,
            wish.size_px,
            wish.frames(),
            wish.fps,
            has_alpha,
            finish,
        )
    };
    let writer = Writer {
        display: wish.display(),
        finish: Finish {
            is_deep: wish.description.render.png_bits == 16,
            behind: backdrop.map(Arc::new),
        },
        notes: Notes::new(),
    };
    let animation = wish.is_animation().then(|| begin(&writer.finish));
    let mut sequence = Sequence {
        animation: animation.transpose()?,
        writer,
    };
    let mut views = ViewBuilder::default();
    for frame in 0..wish.frames() {
        // Before the work: the folder may have gone meanwhile.
        let check = || Output::check(wish.base_dir.with_path(wish.frame_path(frame)));
        let output = (!wish.is_animation()).then(check).transpose()?;
        let turned = wish.build(&mut views, frame, stop)?;
        let scene = wish.scene(turned.as_ref().unwrap_or(built), frame);
        if let Some(turned) = turned {
            painter
                .take(&scene, turned.parts().seen_from(&scene))
                .await?;
        }
        let go_on = |share: f64| {
            report.tell_share(share);
            !stop.is_asked()
        };
        let adding = sequence.add(&mut painter, &scene, output.as_ref(), &go_on);
        if adding.await?.is_none() {
            return Ok(false);
        }
        report.tell(|state| {
            state.written += 1;
            state.share = 0.0;
        });
    }
    sequence.animation.map_or(Ok(()), Animation::finish)?;
    Ok(true)
}

/// Pixels of a band on the CPU.
const CPU_BAND_PX: u32 = 1 << 13;
/// Pixels between two looks at whether to go on, on a driver that computes on the CPU; with all their samples.
const SOFTWARE_BAND_PX: u32 = 1 << 13;
/// Pixels between two looks on a GPU.
const HARDWARE_BAND_PX: u32 = 1 << 19;

/// The largest size of the shape of `scene_px` within `within_px`.
pub(super) fn fitting(scene_px: [u32; 2], within_px: [u32; 2]) -> [u32; 2] {
    let [width, height] = scene_px.map(|side| f64::from(side.max(1)));
    let scale = (f64::from(within_px[0]) / width).min(f64::from(within_px[1]) / height);
    [width, height].map(|side| ((side * scale).round() as u32).max(1))
}
