//! Choice of how coarse a picture must be to come in time while something moves.

use std::time::Duration;

/// Coarseness of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    /// Share of the full size, on each side.
    pub scale: f64,
    /// Ratio of all scratches to those that are drawn, each of which stands for so many.
    pub thin: u32,
}

const fn level(scale: f64, thin: u32) -> Level {
    Level { scale, thin }
}

/// Levels of a renderer that draws all scratches: small steps, so that a change is not noticed, and few, so that it is rare.
pub(super) const WHOLE: Coarseness = Coarseness {
    levels: &[
        level(1.0, 1),
        level(0.75, 1),
        level(0.55, 1),
        level(0.4, 1),
        level(0.28, 1),
        level(0.2, 1),
        level(0.14, 1),
    ],
    target: Duration::from_millis(50),
    first_seconds_per_px: 1.5e-6,
    segment_px: 0.0,
};

/// Levels of a renderer that can draw a few scratches in place of all: the time of a coarse picture depends on its scratches
/// more than on its pixels.
pub(super) const THINNED: Coarseness = Coarseness {
    levels: &[
        level(1.0, 1),
        level(0.75, 1),
        level(0.55, 1),
        level(0.4, 2),
        level(0.28, 4),
        level(0.2, 4),
        level(0.14, 4),
        level(0.14, 8),
        level(0.1, 8),
        level(0.1, 16),
        level(0.08, 32),
    ],
    // Ten a second, with the 40 ms that a software driver takes for the window between them.
    target: Duration::from_millis(50),
    first_seconds_per_px: 1e-5,
    segment_px: 0.03,
};

/// Levels of coarseness of a renderer.
#[derive(Debug, PartialEq)]
pub(super) struct Coarseness {
    /// Levels from the finest to the coarsest.
    levels: &'static [Level],
    /// Longest time of a picture in motion.
    target: Duration,
    /// Seconds a pixel that are assumed before anything is known: a small picture soon beats a large one late.
    first_seconds_per_px: f64,
    /// Cost of a straight piece of a scratch, in pixels.
    segment_px: f64,
}

impl Coarseness {
    /// Whether scratches are left out.
    pub fn thins(&self) -> bool {
        self.levels.iter().any(|level| level.thin > 1)
    }
}

/// Share of the time that a finer step must leave free, so that the picture does not go to and fro.
const SLACK: f64 = 0.7;

/// Choice of the level by the cost of a pixel in the last pictures.
#[derive(Debug)]
pub(super) struct Pace {
    kind: &'static Coarseness,
    seconds_per_px: Option<f64>,
    at: usize,
}

impl Pace {
    pub fn new(kind: &'static Coarseness) -> Self {
        Self {
            kind,
            seconds_per_px: None,
            at: 0,
        }
    }

    /// A picture of one sample took this long, of a scene with so many pieces of scratches.
    pub fn took(&mut self, size_px: [u32; 2], thin: u32, segments: usize, time: Duration) {
        let now = time.as_secs_f64() / self.work_px(size_px, thin, segments).max(1.0);
        // The newest counts as much as all before it: a view from nearer costs something else at once.
        let mean = self.seconds_per_px.map_or(now, |mean| 0.5 * (mean + now));
        self.seconds_per_px = Some(mean);
    }

    /// A picture was given up after this long.
    pub fn gave_up(&mut self, size_px: [u32; 2], thin: u32, segments: usize, time: Duration) {
        let least = time.as_secs_f64() / self.work_px(size_px, thin, segments).max(1.0);
        // Nobody knows how far it was: the next is to come for certain.
        self.seconds_per_px = Some(3.0 * least.max(self.seconds_per_px.unwrap_or(0.0)));
    }

    /// Whether nothing coarser than the last level is left.
    pub fn is_at_coarsest(&self) -> bool {
        self.at + 1 == self.kind.levels.len()
    }

    /// Size and thinning of a picture in motion, of `full_px`. One that `begins` a movement is coarser.
    pub fn moving(&mut self, full_px: [u32; 2], segments: usize, begins: bool) -> ([u32; 2], u32) {
        let levels = self.kind.levels;
        let seconds_per_px = self
            .seconds_per_px
            .unwrap_or(self.kind.first_seconds_per_px);
        let share = |at: usize| {
            let Level { scale, thin } = levels[at];
            let work_px = self.work_px(scaled(full_px, scale), thin, segments);
            seconds_per_px * work_px / self.kind.target.as_secs_f64()
        };
        let mut at = self.at;
        while at + 1 < levels.len() && share(at) > 1.0 {
            at += 1;
        }
        while at > 0 && share(at - 1) < SLACK {
            at -= 1;
        }
        self.at = at;
        if begins && self.kind.thins() && at > 0 {
            at = (at + 1).min(levels.len() - 1);
        }
        (scaled(full_px, levels[at].scale), levels[at].thin)
    }

    /// Work for a picture, in pixels with all their scratches.
    fn work_px(&self, size_px: [u32; 2], thin: u32, segments: usize) -> f64 {
        let pixels = size_px.iter().map(|&side| f64::from(side)).product::<f64>();
        // A pixel of a thinned picture sees fewer scratches, of those that are left more.
        let seen = f64::from(thin).powf(-0.4);
        pixels * seen + self.kind.segment_px * segments as f64 / f64::from(thin)
    }
}

/// Size scaled by a factor on each side, at least a pixel.
pub(super) fn scaled(full_px: [u32; 2], scale: f64) -> [u32; 2] {
    full_px.map(|side| ((f64::from(side) * scale).round() as u32).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL_PX: [u32; 2] = [1280, 720];

    fn size_after_pictures(
        kind: &'static Coarseness,
        pictures: usize,
        seconds_per_px: f64,
    ) -> ([u32; 2], u32) {
        let segments = 100_000;
        let mut pace = Pace::new(kind);
        let (mut size_px, mut thin) = pace.moving(FULL_PX, segments, false);
        for _ in 0..pictures {
            let time = seconds_per_px * pace.work_px(size_px, thin, segments);
            pace.took(size_px, thin, segments, Duration::from_secs_f64(time));
            (size_px, thin) = pace.moving(FULL_PX, segments, false);
        }
        (size_px, thin)
    }

    #[test]
    fn a_fast_machine_keeps_the_full_size_and_a_slow_one_keeps_the_time() {
        assert_eq!(size_after_pictures(&WHOLE, 10, 1e-8), (FULL_PX, 1));
        assert_eq!(size_after_pictures(&THINNED, 10, 1e-8), (FULL_PX, 1));
        let (slow, _) = size_after_pictures(&WHOLE, 10, 2e-6);
        let seconds = 2e-6 * f64::from(slow[0] * slow[1]);
        assert!(seconds < 0.05 && slow[0] > 100, "{slow:?} takes {seconds}");
        let (slow, thin) = size_after_pictures(&THINNED, 10, 1e-5);
        assert!(thin > 1 && slow[0] > 100, "{slow:?}, a scratch of {thin}");
    }

    #[test]
    fn a_steady_cost_settles_on_one_size() {
        for kind in [&WHOLE, &THINNED] {
            for cost in [3e-8, 6e-8, 1e-7, 3e-7, 1e-6, 1e-5] {
                assert_eq!(
                    size_after_pictures(kind, 6, cost),
                    size_after_pictures(kind, 7, cost),
                    "{cost}"
                );
            }
        }
    }

    #[test]
    fn what_was_given_up_is_made_coarser() {
        let mut pace = Pace::new(&THINNED);
        let (first_px, first_thin) = pace.moving(FULL_PX, 100_000, false);
        pace.gave_up(first_px, first_thin, 100_000, Duration::from_millis(200));
        let (then_px, _) = pace.moving(FULL_PX, 100_000, false);
        assert!(then_px[0] < first_px[0], "{first_px:?}, then {then_px:?}");
    }

    #[test]
    fn no_size_is_zero() {
        assert_eq!(scaled([1, 3], 0.14), [1, 1]);
    }
}
