//! Measures the time of a picture: warm-up, as many rows as fit the effort, repetitions in turn, median and quartiles.
//!
//! Methods take turns (A B A B), so that a machine that grows warm or busy does so for all of them alike. All of a group render the
//! same rows.

use std::collections::BTreeMap;
use std::ops::Range;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use hairline_cpu::closed_form::{Prepared, TILE_PX};
use hairline_gpu::Error;
use hairline_scene::Scene;

use super::figures::{Outcome, Spread, Timing};
use super::worker::{Elapsed, PictureRows, Ready, Worker};
use hairline_work::failure::Failure;

/// Time that a measurement may take.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Time of all runs of one method in one cell; half of it for one run, though the least number of them then takes longer.
    pub cell: Duration,
    /// Repetitions at least, whatever they take.
    pub least: usize,
    /// Repetitions at most.
    pub most: usize,
}

impl Effort {
    /// Whether the least number of runs would take too long, given the time of a strip.
    fn is_exceeded_by(&self, strip: Duration) -> bool {
        let least = strip * STRIPS_LEAST * self.least as u32;
        least > LONG.max(self.cell.mul_f64(TOO_LONG))
    }
}

/// Rows of a strip at most.
const STRIP_ROWS_MAX: u32 = 64;
/// Strips at least: fewer would not know the picture.
const STRIPS_LEAST: u32 = 5;
/// A cell is refused whose strips would take so many times the effort, and longer than [`LONG`].
const TOO_LONG: f64 = 20.0;
/// Time up to which nothing is refused.
const LONG: Duration = Duration::from_secs(30);
/// Number of times that a strip is timed before its cell is refused: a machine that is busy with something else may stand still for
/// seconds.
const TRIES: usize = 4;

/// Rows of a strip: a row of tiles for each thread. Software drivers deal workgroups out in runs, so that in a lower strip the
/// threads at the picture's sides, where nothing is to be seen, would wait for those in its middle.
fn strip_rows() -> u32 {
    (TILE_PX * rayon::current_num_threads() as u32).min(STRIP_ROWS_MAX)
}

/// Times the same picture by several methods.
pub fn by_turns(
    worker: &mut Worker,
    scene: &Scene,
    prepared: &Prepared,
    ready: &[Result<Ready, Error>],
    effort: &Effort,
) -> Result<Vec<Outcome>, Failure> {
    let height = scene.render.size_px[1];
    let mut runs: Vec<Runs> = ready.iter().map(|_| Runs::default()).collect();
    let mut rows = PictureRows::Whole;
    let mut time = |ready: &Ready, rows: &PictureRows| worker.time(scene, prepared, ready, rows);
    for (ready, runs) in ready.iter().zip(&mut runs) {
        let strip = match ready {
            Err(error) => Err(refusal(error)?),
            Ok(ready) => match warm_up(&mut |rows| Ok(time(ready, rows)?.wall), height, effort) {
                Err(error) => Err(refusal(&error)?),
                Ok(strip) => Ok(strip),
            },
        };
        match strip {
            Err(refusal) => runs.refused = Some(refusal),
            Ok(strip) if effort.is_exceeded_by(strip) => {
                runs.refused = Some(format!(
                    "too slow to measure here: {} rows took {:.1} s",
                    strip_rows(),
                    strip.as_secs_f64()
                ));
            }
            Ok(strip) => {
                // A dispatch for each strip costs a software driver something: as few as can be, or the whole picture.
                let room_s = effort.cell.as_secs_f64() / 2.0;
                let strips = (room_s / strip.as_secs_f64().max(1e-9)) as u32;
                if strips < height.div_ceil(strip_rows()) {
                    rows = fewer(&rows, height, strips.max(STRIPS_LEAST));
                }
            }
        }
    }
    let start = Instant::now();
    let measured = runs.iter().filter(|r| r.refused.is_none()).count();
    let end = effort.cell * measured as u32;
    for repetition in 0..effort.most {
        if repetition >= effort.least && start.elapsed() > end {
            break;
        }
        for (ready, runs) in ready.iter().zip(&mut runs) {
            if let (Ok(ready), None) = (ready, &runs.refused) {
                match time(ready, &rows) {
                    Ok(elapsed) => runs.push(&elapsed),
                    Err(error) => runs.refused = Some(refusal(&error)?),
                }
            }
        }
    }
    let of_rows = (rows_of(&rows, height), height);
    Ok(runs.into_iter().map(|runs| runs.outcome(of_rows)).collect())
}

/// Reason why a cell has no time, where a device is too small for it; other errors are no measurement.
fn refusal(error: &Error) -> Result<String, Failure> {
    match error {
        Error::TooLarge { .. } | Error::OutOfMemory { .. } | Error::IterationBudget { .. } => {
            Ok(error.to_string())
        }
        _ => Err(Failure::Work(anyhow!("{error}"))),
    }
}

/// Makes the driver compile, and measures a strip in the middle. Some drivers compile a pass once it has something to do, which may be
/// at the picture's edge: all of it is rendered where half the effort suffices.
fn warm_up(
    wall: &mut impl FnMut(&PictureRows) -> Result<Duration, Error>,
    height: u32,
    effort: &Effort,
) -> Result<Duration, Error> {
    let strip = strips(height, 1);
    wall(&strip)?;
    let mut least = wall(&strip)?;
    if least * height.div_ceil(strip_rows()) <= effort.cell / 2 {
        wall(&PictureRows::Whole)?;
        least = wall(&strip)?;
    }
    for _ in 1..TRIES {
        if effort.is_exceeded_by(least) {
            least = least.min(wall(&strip)?);
        }
    }
    Ok(least)
}

/// The smaller part of the picture: the rows until now, or `count` strips.
fn fewer(rows: &PictureRows, height: u32, count: u32) -> PictureRows {
    match rows {
        PictureRows::Strips(so_far) if so_far.len() as u32 <= count => rows.clone(),
        _ => strips(height, count),
    }
}

/// Strips of the picture, `count` of them, spread evenly; the whole picture if they would cover it.
fn strips(height: u32, count: u32) -> PictureRows {
    strips_of(strip_rows(), height, count)
}

fn strips_of(strip_rows: u32, height: u32, count: u32) -> PictureRows {
    if count * strip_rows >= height {
        return PictureRows::Whole;
    }
    let strip = |i: u32| -> Range<u32> {
        let middle = f64::from(height) * (f64::from(i) + 0.5) / f64::from(count);
        let first = middle as u32 - (strip_rows / 2).min(middle as u32);
        // Strips begin at a tile's edge.
        let first = first - first % TILE_PX;
        first..(first + strip_rows).min(height)
    };
    PictureRows::Strips((0..count).map(strip).collect())
}

fn rows_of(rows: &PictureRows, height: u32) -> u32 {
    match rows {
        PictureRows::Whole => height,
        PictureRows::Strips(strips) => strips.iter().map(|rows| rows.end - rows.start).sum(),
    }
}

/// The repetitions of one method, in milliseconds.
#[derive(Default)]
struct Runs {
    wall: Vec<f64>,
    device: Vec<f64>,
    passes: BTreeMap<&'static str, Vec<f64>>,
    refused: Option<String>,
}

impl Runs {
    fn push(&mut self, elapsed: &Elapsed) {
        self.wall.push(milliseconds(elapsed.wall));
        if let Some(passes) = &elapsed.passes {
            let sum = passes.iter().map(|pass| pass.time).sum();
            self.device.push(milliseconds(sum));
            for pass in passes {
                let times = self.passes.entry(pass.name).or_default();
                times.push(milliseconds(pass.time));
            }
        }
    }

    fn outcome(self, (rows, of_rows): (u32, u32)) -> Outcome {
        if let Some(refused) = self.refused {
            return Outcome::Refused(refused);
        }
        let scale = f64::from(of_rows) / f64::from(rows.max(1));
        let spread = |values: &[f64]| {
            let scaled: Vec<f64> = values.iter().map(|v| scale * v).collect();
            Spread::from_values(&scaled)
        };
        Outcome::Timing(Timing {
            wall_ms: spread(&self.wall),
            // Device times are reported only if every run has one.
            device_ms: (self.device.len() == self.wall.len()).then(|| spread(&self.device)),
            passes_ms: self
                .passes
                .iter()
                .map(|(name, times)| (*name, spread(times).median))
                .collect(),
            repetitions: self.wall.len(),
            rows,
            of_rows,
        })
    }
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_lie_in_order_and_within_the_picture() {
        for (height, rows) in [(1, 8), (36, 8), (54, 16), (720, 32), (1080, 64)] {
            for count in 1..200 {
                match strips_of(rows, height, count) {
                    PictureRows::Whole => assert!(count * rows >= height),
                    PictureRows::Strips(strips) => {
                        assert_eq!(strips.len() as u32, count);
                        assert!(strips.windows(2).all(|w| w[0].end <= w[1].start));
                        assert!(strips.iter().all(|s| s.end <= height));
                        assert!(strips.iter().all(|s| s.end - s.start == rows));
                    }
                }
            }
        }
    }

    #[test]
    fn some_rows_are_scaled_to_all_and_say_so() {
        let mut runs = Runs::default();
        for ms in [10, 12, 11] {
            runs.push(&Elapsed {
                wall: Duration::from_millis(ms),
                passes: None,
            });
        }
        let outcome = runs.outcome((40, 720));
        assert!(outcome.scaled());
        assert!((outcome.ms().unwrap().median - 11.0 * 18.0).abs() < 1e-9);
    }
}
