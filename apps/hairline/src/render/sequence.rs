//! Many pictures on a way of the camera, or through a time. The scene is read, sorted and uploaded once, or again where its models move; each file is
//! whole or not there.

use anyhow::anyhow;
use hairline_console::print;
use hairline_image::{Animation, Display, Image, Output};
use hairline_scene::Scene;

use super::goals::Goals;
use super::motion::Motion;
use super::steadiness::Steadiness;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::{Progress, Terminal};
use crate::scene_file::Loaded;
use hairline_render::backend::{FINE_SAMPLES, Painter, Rendered, Task};
use hairline_render::failure::Failure;
use hairline_render::{Listener, Quiet};

/// Renders all frames; `write` puts a picture in its place. With `stability` the same frames are rendered with many samples, and
/// how steady both are is printed.
///
/// # Errors
/// [`Failure::Work`] where rendering or writing fails or the user stops it: frames that are whole by then stay.
pub fn run(
    loaded: &mut Loaded,
    motion: &Motion,
    goals: &Goals,
    stability: bool,
    (task, terminal): (Task, &Terminal),
    write: &dyn Fn(&Output, &Image) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let scene = &loaded.scene;
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    let begin = |path| {
        let size_px = scene.render.size_px;
        let has_alpha = task.is_transparent;
        let (frames, finish) = (motion.frames, &loaded.finish);
        Animation::begin(path, size_px, frames, goals.fps, has_alpha, finish)
    };
    let mut frames = Frames {
        motion,
        goals,
        display,
        write,
        interrupt: Interrupt::listen().map_err(cannot_listen)?,
        animation: goals.animation.as_deref().map(begin).transpose()?,
        steadiness: stability.then(|| Steadiness::new(display)),
        progress: None,
    };
    let camera = loaded.description.camera.clone();
    let place = |frame: usize| motion.position_m(&camera, frame as u32);
    if motion.is_of_camera() {
        let mut moved = loaded.scene.clone();
        let mut painter = Painter::open(&loaded.scene, task.clone(), terminal)?;
        for frame in 0..motion.frames as usize {
            moved.camera.position_m = place(frame);
            frames.add(frame, &moved, &mut painter)?;
        }
        return frames.finish();
    }
    for frame in 0..motion.frames as usize {
        let mut now = loaded.description.clone();
        motion.move_scene(&mut now, frame as u32);
        loaded.show(&now)?;
        loaded.scene.camera.position_m = place(frame);
        // The renderer is reported once.
        let listener: &dyn Listener = if frame == 0 { terminal } else { &Quiet };
        let mut painter = Painter::open(&loaded.scene, task.clone(), listener)?;
        frames.add(frame, &loaded.scene, &mut painter)?;
    }
    frames.finish()
}

/// Writer of the frames.
struct Frames<'a> {
    motion: &'a Motion,
    goals: &'a Goals,
    display: Display,
    write: &'a dyn Fn(&Output, &Image) -> Result<(), Failure>,
    interrupt: Interrupt,
    animation: Option<Animation>,
    steadiness: Option<Steadiness>,
    /// Progress from the first frame on: messages before it have a line of their own.
    progress: Option<Progress>,
}

impl Frames<'_> {
    fn add(&mut self, frame: usize, scene: &Scene, painter: &mut Painter) -> Result<(), Failure> {
        let kept = |failure| match failure {
            Failure::Work(error) => Failure::Work(anyhow!("{error:#}; {}", self.goals.kept(frame))),
            input @ Failure::Input(_) => input,
        };
        let interrupt = &self.interrupt;
        if interrupt.is_asked() {
            return Err(kept(Failure::Work(anyhow!("interrupted"))));
        }
        let progress = &*(self.progress).get_or_insert_with(|| Progress::start("rendering"));
        let done =
            |share: f64| progress.set((frame as f64 + share) / f64::from(self.motion.frames));
        // Share of a frame's time; its reference takes the rest.
        let own = match self.steadiness {
            Some(_) => 1.0 / f64::from(1 + FINE_SAMPLES),
            None => 1.0,
        };
        let is_stopped = || interrupt.is_asked();
        let rendered = painter.render(scene, &is_stopped, &|share| done(own * share));
        let Rendered { image, .. } = match rendered {
            // A frame of fewer samples would stand out, if there is any.
            _ if interrupt.is_asked() => Err(kept(Failure::Work(anyhow!("interrupted")))),
            rendered => rendered.map_err(kept),
        }?;
        if let Some(output) = self.goals.pictures.get(frame) {
            (self.write)(output, &image).map_err(kept)?;
        }
        if let Some(animation) = &mut self.animation {
            animation.add(&image, &self.display)?;
        }
        // A reference may take minutes: not for a figure that nobody waits for any more.
        if let Some(steadiness) = &mut self.steadiness
            && !interrupt.is_asked()
        {
            let rest = |share| done(own + (1.0 - own) * share);
            let reference = painter.render_finely(scene, &rest).map_err(kept)?;
            let camera = scene.camera.frame(scene.render.size_px);
            steadiness.add(camera, [image, reference]);
        }
        Ok(())
    }

    fn finish(self) -> Result<(), Failure> {
        drop(self.progress);
        if let Some(animation) = self.animation {
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
