//! Light of other objects by way of scratches, by half of the rays.

use crate::sampling::luminance;
use glam::DVec3;

/// What the rays of a half bring of the light of objects by way of scratches.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ObjectRays {
    weight: DVec3,
    /// The sum of weights times radiances.
    pub brought: DVec3,
    /// By luminance of weights.
    weighed: f64,
    radiance: DVec3,
}

impl ObjectRays {
    pub fn add(&mut self, weight: DVec3, radiance: DVec3) {
        self.weight += weight;
        self.brought += weight * radiance;
        let weighed = luminance(weight).max(0.0);
        self.weighed += weighed;
        self.radiance += weighed * radiance;
    }

    /// The mean radiance from where scratches send light.
    pub fn guess(&self) -> DVec3 {
        if self.weighed > 0.0 {
            self.radiance / self.weighed
        } else {
            DVec3::ZERO
        }
    }

    /// What this half of so many rounds says, where light of radiance 1 from all around would be `open`.
    pub fn light(&self, open: DVec3, guess: DVec3, rounds: u32) -> DVec3 {
        open * guess + (self.brought - guess * self.weight) / f64::from(rounds)
    }
}
