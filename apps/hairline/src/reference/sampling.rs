//! The work itself: samples until there are enough, time is up or the user has enough, with what there is saved now and then.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use hairline_image::Image;
use hairline_reference::monte_carlo::Integrator;

use crate::failure::Failure;
use crate::progress::Progress;
use crate::reference::interrupt::Interrupt;

/// What a crash or a power cut may cost.
const SAVE_EVERY: Duration = Duration::from_secs(60);

/// Work for each unit of time spent on saving, so that huge pictures are not mostly saved.
const WORK_PER_SAVING: u32 = 20;

/// How far to go.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Samples that each pixel should have.
    pub samples: u32,
    /// Time to sample for. The batches that are in progress then are finished.
    pub time: Option<Duration>,
}

/// Why the work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Each pixel has its samples.
    Complete,
    /// [`Limits::time`] has passed.
    TimeUp,
    /// The user stopped it.
    Interrupted,
}

/// Samples, and hands the image to `save` every minute and at the end. An image without a single sample is not saved.
///
/// # Errors
/// What `save` says at the end. Before that it is a warning: there may be room by the next time.
pub fn sample(
    integrator: &Integrator,
    image: &mut Image,
    limits: &Limits,
    interrupt: &Interrupt,
    save: &dyn Fn(&Image) -> Result<(), Failure>,
) -> Result<End, Failure> {
    let start = Instant::now();
    let progress = Progress::start_from("sampling", Count::of(image).share_of(limits.samples));
    let mut work = SAVE_EVERY;
    loop {
        let since_save = Instant::now();
        let is_time_up = || limits.time.is_some_and(|limit| start.elapsed() >= limit);
        let observe = |share: f64| {
            let of_time = limits.time.map_or(0.0, |limit| {
                start.elapsed().as_secs_f64() / limit.as_secs_f64()
            });
            progress.set(share.max(of_time));
            if interrupt.is_asked() || is_time_up() || since_save.elapsed() >= work {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let flow = integrator.run(image, limits.samples, &observe);

        let count = Count::of(image);
        let end = if flow.is_continue() || count.least >= limits.samples {
            Some(End::Complete)
        } else if interrupt.is_asked() {
            Some(End::Interrupted)
        } else if is_time_up() {
            Some(End::TimeUp)
        } else {
            None
        };
        let saving = Instant::now();
        progress.say("saving");
        let saved = if count.mean > 0.0 { save(image) } else { Ok(()) };
        match (end, saved) {
            (Some(end), saved) => return saved.map(|()| end),
            (None, Ok(())) => {}
            (None, Err(failure)) => progress.warn(&format!("{failure}; going on")),
        }
        progress.say("sampling");
        work = SAVE_EVERY.max(saving.elapsed() * WORK_PER_SAVING);
    }
}

/// How many samples the pixels of a picture have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Count {
    /// The poorest pixel's.
    pub least: u32,
    /// Over all pixels.
    pub mean: f64,
}

impl Count {
    /// Of an image that says nothing of its samples: none.
    pub fn of(image: &Image) -> Self {
        let samples = image.noise.as_ref().map_or(&[][..], |n| &n.samples);
        let sum: u64 = samples.iter().map(|&n| u64::from(n)).sum();
        Self {
            least: samples.iter().copied().min().unwrap_or(0),
            mean: sum as f64 / samples.len().max(1) as f64,
        }
    }

    fn share_of(self, samples: u32) -> f64 {
        self.mean / f64::from(samples.max(1))
    }
}
