//! The work itself: samples until there are enough, time is up or the user has enough, saved now and then.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use hairline_image::Image;
use hairline_reference::{BATCH_SAMPLES, Integrator};

use crate::failure::Failure;
use crate::listener::Listener;

/// Work for each unit of time spent on saving, so that huge pictures are not mostly saved.
const WORK_PER_SAVING: u32 = 20;

/// Limits of the sampling.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Samples that each pixel should have.
    pub samples: u32,
    /// Time to sample for. The batches that are in progress then are finished.
    pub time: Option<Duration>,
    /// Largest time whose samples a crash or a power cut may lose.
    pub save_every: Duration,
}

/// Number of samples for each pixel if neither a number nor a time is given.
const DEFAULT_SAMPLES: u32 = 1024;

impl Limits {
    /// Samples come in whole batches; with a time alone there are as many as fit in it.
    pub fn new(samples: Option<u32>, time: Option<Duration>, save_every: Duration) -> Self {
        const MOST: u32 = u32::MAX / BATCH_SAMPLES * BATCH_SAMPLES;
        let samples = match (samples, time) {
            (Some(samples), _) => samples.next_multiple_of(BATCH_SAMPLES),
            (None, Some(_)) => MOST,
            (None, None) => DEFAULT_SAMPLES,
        };
        Self {
            samples,
            time,
            save_every,
        }
    }
}

/// Reason why the work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Each pixel has its samples.
    Complete,
    /// [`Limits::time`] has passed.
    TimeUp,
    /// The user stopped it.
    Interrupted,
}

/// Samples, and hands the image to `save` now and then and at the end. An image without a single sample is not saved; where some pixels have none,
/// `save` gets their neighbours' light in them.
///
/// # Errors
/// What `save` says at the end. Before that it is a warning: there may be room by the next time.
pub fn sample(
    integrator: &Integrator,
    image: &mut Image,
    limits: &Limits,
    interrupted: &(dyn Fn() -> bool + Sync),
    listener: &dyn Listener,
    save: &dyn Fn(&Image) -> Result<(), Failure>,
) -> Result<End, Failure> {
    let start = Instant::now();
    let mut work = limits.save_every;
    loop {
        let since_save = Instant::now();
        let is_time_up = || limits.time.is_some_and(|limit| start.elapsed() >= limit);
        let observe = |share: f64| {
            let of_time = limits.time.map_or(0.0, |limit| {
                start.elapsed().as_secs_f64() / limit.as_secs_f64()
            });
            listener.set(share.max(of_time));
            if interrupted() || is_time_up() || since_save.elapsed() >= work {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let flow = integrator.run(image, limits.samples, &observe);

        let count = Count::new(image);
        let end = if flow.is_continue() || count.least >= limits.samples {
            Some(End::Complete)
        } else if interrupted() {
            Some(End::Interrupted)
        } else if is_time_up() {
            Some(End::TimeUp)
        } else {
            None
        };
        let saving = Instant::now();
        listener.say("saving");
        let saved = match count {
            Count { mean: 0.0, .. } => Ok(()),
            Count { least: 0, .. } => save(&filled(image)),
            _ => save(image),
        };
        match (end, saved) {
            (Some(end), saved) => return saved.map(|()| end),
            (None, Ok(())) => {}
            (None, Err(failure)) => listener.warn(&format!("{failure}; going on")),
        }
        listener.say("sampling");
        work = limits.save_every.max(saving.elapsed() * WORK_PER_SAVING);
    }
}

/// The picture with the light of the nearest pixel where there is no sample yet, which stays said.
fn filled(image: &Image) -> Image {
    let mut filled = image.clone();
    let [width, height] = image.size_px.map(|side| side as usize);
    let samples = image.noise.as_ref().map_or(&[][..], |noise| &noise.samples);
    let mut is_known: Vec<bool> = samples.iter().map(|n| *n > 0).collect();
    let mut nearest: VecDeque<usize> = (0..samples.len()).filter(|i| is_known[*i]).collect();
    while let Some(from) = nearest.pop_front() {
        let (x, y) = (from % width, from / width);
        let beside = [
            (x > 0).then(|| from - 1),
            (x + 1 < width).then_some(from + 1),
            (y > 0).then(|| from - width),
            (y + 1 < height).then_some(from + width),
        ];
        for to in beside.into_iter().flatten() {
            if !std::mem::replace(&mut is_known[to], true) {
                filled.base[to] = filled.base[from];
                filled.scratches[to] = filled.scratches[from];
                filled.density[to] = filled.density[from];
                nearest.push_back(to);
            }
        }
    }
    filled
}

/// Samples of a picture's pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Count {
    /// The poorest pixel's.
    pub least: u32,
    /// Mean over all pixels.
    pub mean: f64,
}

impl Count {
    /// Counts the samples of an image; none if it does not state them.
    pub fn new(image: &Image) -> Self {
        let samples = image.noise.as_ref().map_or(&[][..], |n| &n.samples);
        let sum: u64 = samples.iter().map(|&n| u64::from(n)).sum();
        Self {
            least: samples.iter().copied().min().unwrap_or(0),
            mean: sum as f64 / samples.len().max(1) as f64,
        }
    }

    /// Share of `samples` for each pixel that is done.
    pub fn share_of(self, samples: u32) -> f64 {
        self.mean / f64::from(samples.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Quiet;
    use hairline_fixtures::scenes::scratched_plate;
    use hairline_reference::Settings;
    use hairline_scene::Scene;
    use std::cell::Cell;
    use std::sync::atomic::{AtomicBool, Ordering};

    fn never() -> bool {
        false
    }

    const SAMPLES: u32 = 8 * BATCH_SAMPLES;

    /// A scratched disk under a lamp.
    fn scene() -> Scene {
        scratched_plate().scene()
    }

    /// Saves whenever it may.
    fn limits() -> Limits {
        Limits {
            samples: SAMPLES,
            time: None,
            save_every: Duration::ZERO,
        }
    }

    fn uninterrupted(integrator: &Integrator) -> Image {
        let mut image = integrator.start();
        let flow = integrator.run(&mut image, SAMPLES, &|_| ControlFlow::Continue(()));
        assert!(flow.is_continue());
        assert_eq!(Count::new(&image).mean, f64::from(SAMPLES));
        image
    }

    #[test]
    fn what_was_stopped_goes_on_to_the_same_picture() {
        let scene = scene();
        let integrator = Integrator::new(&scene, Settings::default());
        let mut image = integrator.start();
        let interrupt = AtomicBool::new(false);
        let saved = Cell::new(0);
        let stop_at_third = |image: &Image| {
            saved.set(saved.get() + 1);
            assert!(Count::new(image).mean > 0.0);
            if saved.get() == 3 {
                interrupt.store(true, Ordering::Relaxed);
            }
            Ok(())
        };
        let end = sample(
            &integrator,
            &mut image,
            &limits(),
            &|| interrupt.load(Ordering::Relaxed),
            &Quiet,
            &stop_at_third,
        );
        assert_eq!(end.unwrap(), End::Interrupted);
        assert_eq!(saved.get(), 4, "and once more at the end");
        let count = Count::new(&image);
        assert!(
            count.mean > f64::from(count.least) && count.least < SAMPLES,
            "the hard case has pixels with more samples than others: {count:?}"
        );

        let whole = uninterrupted(&integrator);
        assert_ne!(image, whole);
        let end = sample(&integrator, &mut image, &limits(), &never, &Quiet, &|_| {
            Ok(())
        });
        assert_eq!(end.unwrap(), End::Complete);
        assert_eq!(image, whole, "bit for bit");
    }

    /// Each quarter has samples, and the pixels between them show their neighbours.
    #[test]
    fn what_is_stopped_in_its_first_round_has_no_black_part() {
        // Large enough that its parts' counts do not hang on which of the threads is faster.
        let mut scene = scene();
        scene.render.size_px = [96, 64];
        let integrator = Integrator::new(&scene, Settings::default());
        let mut image = integrator.start();
        let saved = Cell::new(None);
        let polls = std::sync::atomic::AtomicUsize::new(0);
        let quarter = image.pixel_count() / 4;
        let interrupted = || polls.fetch_add(1, Ordering::Relaxed) > quarter;
        let save = |image: &Image| {
            saved.set(Some(image.clone()));
            Ok(())
        };
        let limits = Limits {
            save_every: Duration::from_secs(60),
            ..limits()
        };
        let end = sample(
            &integrator,
            &mut image,
            &limits,
            &interrupted,
            &Quiet,
            &save,
        );
        assert_eq!(end.unwrap(), End::Interrupted);
        let saved = saved.take().unwrap();
        let samples = &saved.noise.as_ref().unwrap().samples;
        assert_eq!(samples, &image.noise.as_ref().unwrap().samples);
        let mut whole = integrator.start();
        let _ = integrator.run(&mut whole, BATCH_SAMPLES, &|_| ControlFlow::Continue(()));
        for part in 0..4 {
            let pixels = part * quarter..(part + 1) * quarter;
            let begun = samples[pixels.clone()].iter().filter(|n| **n > 0).count();
            assert!(
                (quarter / 8..quarter / 2).contains(&begun),
                "{part}: {begun}"
            );
            let light =
                |image: &Image| -> f32 { image.base[pixels.clone()].iter().flatten().sum() };
            let ratio = light(&saved) / light(&whole);
            // Of so few samples a highlight has many or none.
            assert!(ratio > 0.01, "{part}: {ratio}");
        }
    }

    #[test]
    fn time_is_a_limit() {
        let scene = scene();
        let integrator = Integrator::new(&scene, Settings::default());
        let mut image = integrator.start();
        let limits = Limits {
            samples: u32::MAX / BATCH_SAMPLES * BATCH_SAMPLES,
            time: Some(Duration::from_millis(50)),
            save_every: Duration::from_secs(60),
        };
        let saved = Cell::new(0);
        let save = |_: &Image| {
            saved.set(saved.get() + 1);
            Ok(())
        };
        let start = Instant::now();
        let end = sample(&integrator, &mut image, &limits, &never, &Quiet, &save);
        assert_eq!(end.unwrap(), End::TimeUp);
        assert_eq!(saved.get(), 1);
        // Generous: the machine may have other work.
        assert!(start.elapsed() < Duration::from_secs(10));
    }

    /// A full disk an hour before the end may have room again by then.
    #[test]
    fn saving_may_fail_before_the_end_but_not_at_it() {
        let scene = scene();
        let integrator = Integrator::new(&scene, Settings::default());
        let fail = || Err(Failure::Work(anyhow::anyhow!("the disk is full")));
        let saved = Cell::new(0);
        let once = |_: &Image| {
            saved.set(saved.get() + 1);
            if saved.get() == 1 { fail() } else { Ok(()) }
        };
        let mut image = integrator.start();
        let end = sample(&integrator, &mut image, &limits(), &never, &Quiet, &once);
        assert_eq!(end.unwrap(), End::Complete);
        assert!(saved.get() > 1);

        let mut image = integrator.start();
        let end = sample(&integrator, &mut image, &limits(), &never, &Quiet, &|_| {
            fail()
        });
        assert!(end.is_err());
    }
}
