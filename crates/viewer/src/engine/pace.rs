//! How coarse a picture must be to come in time while something moves.

use std::time::Duration;

/// What a picture in motion may take: twenty a second.
const TARGET: Duration = Duration::from_millis(50);
/// Steps of the resolution on each side; small ones, so that a change is not noticed, and few, so that it is rare.
const SCALES: [f64; 7] = [1.0, 0.75, 0.55, 0.4, 0.28, 0.2, 0.14];
/// A finer step is taken only if it would leave this share of the time free, so that the picture does not go to and fro.
const SLACK: f64 = 0.7;

/// Knows from the last pictures what a pixel costs.
#[derive(Debug, Default)]
pub(super) struct Pace {
    seconds_per_px: Option<f64>,
    scale: usize,
}

impl Pace {
    /// A picture of one sample took this long.
    pub fn took(&mut self, size_px: [u32; 2], time: Duration) {
        let pixels = size_px.iter().map(|&side| f64::from(side)).product::<f64>();
        let now = time.as_secs_f64() / pixels.max(1.0);
        // The newest counts as much as all before it: a view from nearer costs something else at once.
        let mean = self.seconds_per_px.map_or(now, |mean| 0.5 * (mean + now));
        self.seconds_per_px = Some(mean);
    }

    /// The size of a picture in motion, of `full_px`.
    pub fn moving_size_px(&mut self, full_px: [u32; 2]) -> [u32; 2] {
        // Nothing is known yet: a small picture soon beats a large one late.
        let seconds_per_px = self.seconds_per_px.unwrap_or(1.5e-6);
        let full = full_px.iter().map(|&side| f64::from(side)).product::<f64>();
        let share = |step: usize| {
            let seconds = seconds_per_px * full * SCALES[step] * SCALES[step];
            seconds / TARGET.as_secs_f64()
        };
        while self.scale + 1 < SCALES.len() && share(self.scale) > 1.0 {
            self.scale += 1;
        }
        while self.scale > 0 && share(self.scale - 1) < SLACK {
            self.scale -= 1;
        }
        scaled(full_px, SCALES[self.scale])
    }
}

/// Half of it on each side, or the size itself if that would be finer than `finest`.
pub(super) fn scaled(full_px: [u32; 2], scale: f64) -> [u32; 2] {
    full_px.map(|side| ((f64::from(side) * scale).round() as u32).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL_PX: [u32; 2] = [1280, 720];

    fn after(pictures: usize, seconds_per_px: f64) -> [u32; 2] {
        let mut pace = Pace::default();
        let mut size_px = pace.moving_size_px(FULL_PX);
        for _ in 0..pictures {
            let pixels = f64::from(size_px[0] * size_px[1]);
            pace.took(size_px, Duration::from_secs_f64(seconds_per_px * pixels));
            size_px = pace.moving_size_px(FULL_PX);
        }
        size_px
    }

    #[test]
    fn a_fast_machine_keeps_the_full_size_and_a_slow_one_keeps_the_time() {
        assert_eq!(after(10, 1e-8), FULL_PX);
        let slow = after(10, 2e-6);
        let seconds = 2e-6 * f64::from(slow[0] * slow[1]);
        assert!(seconds < 0.05 && slow[0] > 100, "{slow:?} takes {seconds}");
    }

    #[test]
    fn a_steady_cost_settles_on_one_size() {
        for cost in [3e-8, 6e-8, 1e-7, 3e-7, 1e-6] {
            assert_eq!(after(6, cost), after(7, cost), "{cost}");
        }
    }

    #[test]
    fn no_size_is_zero() {
        assert_eq!(scaled([1, 3], 0.14), [1, 1]);
    }
}
