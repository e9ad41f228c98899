//! Many pictures on a way of the camera. The scene is read, sorted and uploaded once; each file is whole or not there.

use anyhow::anyhow;
use hairline_image::{Animation, Display, Image, Output};

use super::goals::Goals;
use super::motion::Motion;
use super::steadiness::Steadiness;
use crate::console::print;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::Progress;
use crate::scene_file::Loaded;
use hairline_work::backend::{FINE_SAMPLES, Painter, Rendered};
use hairline_work::failure::Failure;

/// Renders all frames; `write` puts a picture in its place. With `stability` the same frames are rendered with many samples, and
/// how steady both are is printed.
///
/// # Errors
/// [`Failure::Work`] where rendering or writing fails or the user stops it: frames that are whole by then stay.
pub fn run(
    loaded: &Loaded,
    motion: &Motion,
    goals: &Goals,
    stability: bool,
    painter: &mut Painter,
    write: &dyn Fn(&Output, &Image) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut scene = loaded.scene.clone();
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    let begin = |path| Animation::begin(path, scene.render.size_px, motion.frames, goals.fps);
    let mut animation = goals.animation.as_deref().map(begin).transpose()?;
    let mut steadiness = stability.then(|| Steadiness::new(display));
    // Of a frame's time, until its reference takes the rest.
    let own = match stability {
        true => 1.0 / f64::from(1 + FINE_SAMPLES),
        false => 1.0,
    };
    let progress = Progress::start("rendering");
    let done = |frame: usize, share: f64| {
        progress.set((frame as f64 + share) / f64::from(motion.frames));
    };
    for frame in 0..motion.frames as usize {
        let kept = |failure| match failure {
            Failure::Work(error) => Failure::Work(anyhow!("{error:#}; {}", goals.kept(frame))),
            input @ Failure::Input(_) => input,
        };
        if interrupt.is_asked() {
            return Err(kept(Failure::Work(anyhow!("interrupted"))));
        }
        scene.camera.position_m = motion.position_m(&loaded.description.camera, frame as u32);
        let is_stopped = || interrupt.is_asked();
        let rendered = painter.render(&scene, &is_stopped, &|share| done(frame, own * share));
        let Rendered { image, .. } = match rendered {
            // A frame of fewer samples would stand out, if there is any.
            _ if interrupt.is_asked() => Err(kept(Failure::Work(anyhow!("interrupted")))),
            rendered => rendered.map_err(kept),
        }?;
        if let Some(output) = goals.pictures.get(frame) {
            write(output, &image).map_err(kept)?;
        }
        if let Some(animation) = &mut animation {
            animation.add(&image.beauty(), &display)?;
        }
        // A reference may take minutes: not for a figure that nobody waits for any more.
        if let Some(steadiness) = &mut steadiness
            && !interrupt.is_asked()
        {
            let rest = |share| done(frame, own + (1.0 - own) * share);
            let reference = painter.render_finely(&scene, &rest).map_err(kept)?;
            let camera = scene.camera.frame(scene.render.size_px);
            steadiness.add(camera, [image, reference]);
        }
    }
    drop(progress);
    if let Some(animation) = animation {
        animation.finish()?;
    }
    if let Some(steadiness) = steadiness {
        if interrupt.is_asked() {
            return Err(Failure::Work(anyhow!(
                "interrupted; all frames are whole, and how steady they are is not known"
            )));
        }
        print(&format!("{}\n", steadiness.in_words(FINE_SAMPLES)))?;
    }
    Ok(())
}
