//! Many pictures on a way of the camera, or through a time. The scene is read, sorted and uploaded once, or again where its models move; each file is
//! whole or not there.

use anyhow::anyhow;
use hairline_console::print;
use hairline_image::Animation;
use hairline_render::failure::Failure;
use hairline_render::{Error, FINE_SAMPLES, Motion, Painter, Sequence};
use hairline_scene::Scene;

use super::goals::Goals;
use super::steadiness::Steadiness;
use super::work::Work;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::Progress;
use crate::scene_file::Loaded;

/// Renders and writes all frames. With `--stability` the same frames are rendered with many samples, and how steady both are is printed.
///
/// # Errors
/// [`Failure::Work`] where rendering or writing fails or the user stops it: frames that are whole by then stay.
pub(super) fn run(
    mut loaded: Loaded,
    motion: &Motion,
    goals: &Goals,
    work: &Work<'_>,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    let begin = |path| {
        let (size_px, has_alpha) = (loaded.scene.render.size_px, work.task.is_transparent);
        let (frames, finish) = (motion.frames, &work.writer.finish);
        Animation::begin(path, size_px, frames, goals.fps, has_alpha, finish)
    };
    let sequence = Sequence {
        writer: work.writer.clone(),
        animation: goals.animation.as_deref().map(begin).transpose()?,
    };
    let steady = work.arguments.sequence.stability;
    let mut frames = Frames {
        motion,
        goals,
        sequence,
        interrupt,
        steadiness: steady.then(|| Steadiness::new(work.writer.display)),
        progress: None,
    };
    let camera = loaded.description.camera.clone();
    let is_of_camera = motion.is_of_camera();
    // By its own camera: frames that are seen from about as far away share its pieces of scratches.
    let painter = is_of_camera.then(|| work.painter(&loaded.scene));
    let mut painter = painter.transpose()?;
    for frame in 0..motion.frames {
        if !is_of_camera {
            let mut now = loaded.description.clone();
            motion.move_scene(&mut now, frame);
            loaded.show(&now)?;
        }
        loaded.scene.camera.position_m = motion.position_m(&camera, frame);
        let scene = &loaded.scene;
        let painter = match &mut painter {
            Some(painter) if is_of_camera => painter,
            Some(painter) => {
                painter.take_now(scene)?;
                painter
            }
            none => none.insert(work.painter(scene)?),
        };
        frames.add(frame as usize, scene, painter)?;
    }
    frames.finish()
}

/// Frames on their way to files.
struct Frames<'a> {
    motion: &'a Motion,
    goals: &'a Goals,
    sequence: Sequence,
    interrupt: Interrupt,
    steadiness: Option<Steadiness>,
    /// Progress from the first frame on: messages before it have a line of their own.
    progress: Option<Progress>,
}

impl Frames<'_> {
    fn add(&mut self, frame: usize, scene: &Scene, painter: &mut Painter) -> Result<(), Failure> {
        let interrupt = &self.interrupt;
        let kept = |failure| match failure {
            Failure::Work(error) => Failure::Work(anyhow!("{error:#}; {}", self.goals.kept(frame))),
            input @ Failure::Input(_) => input,
        };
        let interrupted = || kept(Failure::Work(anyhow!("interrupted")));
        if interrupt.is_asked() {
            return Err(interrupted());
        }
        let progress = &*(self.progress).get_or_insert_with(|| Progress::start("rendering"));
        let go_on = interrupt.go_on(progress);
        let done = |share: f64| go_on((frame as f64 + share) / f64::from(self.motion.frames));
        // Share of a frame's time; its reference takes the rest.
        let own = match self.steadiness {
            Some(_) => 1.0 / f64::from(1 + FINE_SAMPLES),
            None => 1.0,
        };
        let (sequence, output) = (&mut self.sequence, self.goals.pictures.get(frame));
        let of_frame = |share| done(own * share);
        let add =
            async |painter: &mut Painter<'_>| sequence.add(painter, scene, output, &of_frame).await;
        let image = match painter.wait(add) {
            Ok(Some(image)) => image,
            Ok(None) => return Err(interrupted()),
            Err(Error::Device(_)) if interrupt.is_asked() => return Err(interrupted()),
            Err(Error::Animation(error)) => return Err(error.into()),
            Err(error) => return Err(kept(error.into())),
        };
        // A reference may take minutes: not for a figure that nobody waits for any more.
        if let Some(steadiness) = &mut self.steadiness
            && !interrupt.is_asked()
        {
            let rest = |share| {
                done(own + (1.0 - own) * share);
            };
            let rendered = painter.wait(async |painter| painter.render_finely(scene, &rest).await);
            let reference = rendered.map_err(|error| kept(error.into()))?;
            let camera = scene.camera.frame(scene.render.size_px);
            steadiness.add(camera, [image, reference]);
        }
        Ok(())
    }

    fn finish(self) -> Result<(), Failure> {
        drop(self.progress);
        if let Some(animation) = self.sequence.animation {
            animation.finish()?;
        }
        if let Some(steadiness) = self.steadiness {
            if self.interrupt.is_asked() {
                return Err(Failure::Work(anyhow!(
                    "interrupted; all frames are whole, and how steady they are is not known"
                )));
            }
            print(&format!("{}\n", steadiness.in_words(FINE_SAMPLES)))?;
        }
        Ok(())
    }
}
