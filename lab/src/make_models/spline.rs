//! Curves through points.

/// The natural cubic spline through points: its curvature is continuous, so reflections in a surface made from it have
/// no kinks.
pub struct Spline {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Second derivatives at the points.
    bend: Vec<f64>,
}

impl Spline {
    /// A spline through `points`, in rising order of x.
    pub fn new(points: &[[f64; 2]]) -> Self {
        let x: Vec<f64> = points.iter().map(|p| p[0]).collect();
        let y: Vec<f64> = points.iter().map(|p| p[1]).collect();
        let n = x.len();
        let slope = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
        // Thomas's algorithm on the rows of the inner points.
        let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
        for i in 1..n - 1 {
            let (before, after) = (x[i] - x[i - 1], x[i + 1] - x[i]);
            let pivot = 2.0 * (before + after) - before * upper[i - 1];
            upper[i] = after / pivot;
            right[i] = (6.0 * (slope(i) - slope(i - 1)) - before * right[i - 1]) / pivot;
        }
        let mut bend = vec![0.0; n];
        for i in (1..n - 1).rev() {
            bend[i] = right[i] - upper[i] * bend[i + 1];
        }
        Self { x, y, bend }
    }

    /// The value at `x`, which is kept between the first point and the last.
    pub fn evaluate(&self, x: f64) -> f64 {
        let n = self.x.len();
        let x = x.clamp(self.x[0], self.x[n - 1]);
        let i = self.x[1..n - 1].partition_point(|&knot| knot <= x);
        let step = self.x[i + 1] - self.x[i];
        let (a, b) = ((self.x[i + 1] - x) / step, (x - self.x[i]) / step);
        let cubic = (a * a * a - a) * self.bend[i] + (b * b * b - b) * self.bend[i + 1];
        a * self.y[i] + b * self.y[i + 1] + cubic * step * step / 6.0
    }
}

/// 0 below `from`, 1 above `to`, and between them the quintic whose curvature is continuous.
pub fn smooth_step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}
