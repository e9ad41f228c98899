//! A direction of a light's chords, drawn in proportion to the light that the scratch sends from there.

/// Halvings of an interval that find a place: to 1e-7 of its length, finer than a fringe of the widest scratches.
const HALVINGS: u32 = 24;

/// The parts of a line that a light covers, as intervals of q.
#[derive(Clone, Debug, Default)]
pub struct DrawnChord {
    /// (low, high), ascending, with the light that the scratch sends from there.
    intervals: Vec<(f64, f64, f64)>,
    total: f64,
}

impl DrawnChord {
    /// Finds the intervals between roots, given with the sign with which the antiderivative counts there, in any order. The
    /// `antiderivative` rises with q.
    pub fn find(
        &mut self,
        roots: impl Iterator<Item = (f64, f64)>,
        antiderivative: impl Fn(f64) -> f64,
    ) {
        let Self { intervals, total } = self;
        intervals.clear();
        intervals.extend(roots.map(|(sign, q)| (q, q, sign)));
        intervals.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        // Below q lie all lights whose upper roots lie above it.
        let (mut covered, mut kept) = (0.0, 0);
        *total = 0.0;
        for i in 0..intervals.len() {
            covered -= intervals[i].2;
            let (low, high) = (
                intervals[i].0,
                intervals.get(i + 1).map_or(0.0, |next| next.0),
            );
            if covered > 0.5 && i + 1 < intervals.len() && high > low {
                let sent = (antiderivative(high) - antiderivative(low)).max(0.0);
                *total += sent;
                intervals[kept] = (low, high, sent);
                kept += 1;
            }
        }
        intervals.truncate(kept);
    }

    /// (low, high) of each, ascending.
    pub fn intervals(&self) -> impl Iterator<Item = (f64, f64)> {
        self.intervals.iter().map(|&(low, high, _)| (low, high))
    }

    /// Light that the scratch sends from all intervals.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// The q below which the share `u` of the total comes from, as a short interval about it; none where nothing comes.
    pub fn draw(&self, antiderivative: impl Fn(f64) -> f64, u: f64) -> Option<(f64, f64)> {
        if !(self.total > 0.0) {
            return None;
        }
        let mut left = u * self.total;
        let last = self.intervals.len() - 1;
        for (i, &(mut low, mut high, sent)) in self.intervals.iter().enumerate() {
            if left > sent && i < last {
                left -= sent;
                continue;
            }
            let target = antiderivative(low) + left;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if antiderivative(middle) < target {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            return Some((low, high));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_follow_the_antiderivative_and_stay_on_what_is_covered() {
        // A density of 2 + q over [-1, -0.5] and [0.25, 0.75].
        let rise = |q: f64| 2.0 * q + 0.5 * q * q;
        let roots = [(1.0, 0.75), (-1.0, -1.0), (1.0, -0.5), (-1.0, 0.25)];
        let mut chord = DrawnChord::default();
        chord.find(roots.into_iter(), rise);
        let lower = rise(-0.5) - rise(-1.0);
        let upper = rise(0.75) - rise(0.25);
        assert!((chord.total() - lower - upper).abs() < 1e-12);
        for i in 0..1000 {
            let u = (f64::from(i) + 0.5) / 1000.0;
            let (low, high) = chord.draw(rise, u).unwrap();
            let q = 0.5 * (low + high);
            let below = if q < 0.0 {
                assert!((-1.0..=-0.5).contains(&q));
                rise(q) - rise(-1.0)
            } else {
                assert!((0.25..=0.75).contains(&q));
                lower + rise(q) - rise(0.25)
            };
            assert!((below / chord.total() - u).abs() < 1e-6, "{u} {q}");
        }
        chord.find([].into_iter(), rise);
        assert!(chord.draw(rise, 0.5).is_none());
    }
}
