//! Light that the rays of a sample find in one layer: the share of the closed form that is seen, and the light from other objects
//! (docs/model.md, section 11). In the picture: [`hairline_image::TracedLight`].

use crate::sampling::luminance;
use glam::DVec3;
use hairline_image::TracedLight;
use std::ops::AddAssign;

/// One layer: of a sample, or summed over several.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LayerLight {
    /// Closed form: the light that is sent where nothing hides a source.
    pub open: DVec3,
    /// Light that would be sent if radiance 1 came from all around.
    pub around: DVec3,
    /// The mean weight of the rays: `open`, but for noise.
    pub weight: DVec3,
    /// Mean weight of the rays that see their source.
    pub seen: DVec3,
    /// Light of other objects.
    pub bounced: DVec3,
    /// Sums over rounds of x x, x y and y y, the luminances of a round's weight and of the part of it that is seen.
    share_moments: DVec3,
    /// The same of `around` and of the light of other objects.
    bounced_moments: DVec3,
}

impl LayerLight {
    /// Light of a layer without rays.
    pub fn open(open: DVec3) -> Self {
        Self {
            open,
            ..Self::default()
        }
    }

    /// Multiplies the light by a factor for each channel.
    pub fn times(self, factor: DVec3) -> Self {
        // Of its luminance, squared.
        let of_squares = |rgb: DVec3| match luminance(rgb) {
            0.0 => 1.0,
            all => (luminance(rgb * factor) / all).powi(2),
        };
        Self {
            share_moments: self.share_moments * of_squares(self.weight),
            bounced_moments: self.bounced_moments * of_squares(self.around),
            ..self.scaled(factor)
        }
    }

    /// The light of as many samples as it is said to be of: the rounds are those that they have in all.
    pub(crate) fn for_samples(self, samples: f64) -> Self {
        self.scaled(DVec3::splat(samples))
    }

    fn scaled(self, factor: DVec3) -> Self {
        Self {
            open: self.open * factor,
            around: self.around * factor,
            weight: self.weight * factor,
            seen: self.seen * factor,
            bounced: self.bounced * factor,
            ..self
        }
    }

    /// Sets the light that is sent of radiance 1 from all around, and the light of other objects, of which each round told the mean over that.
    pub(crate) fn with_bounced(self, around: DVec3, bounced: DVec3) -> Self {
        Self {
            around,
            bounced,
            bounced_moments: self.bounced_moments * luminance(around).powi(2),
            ..self
        }
    }

    /// Converts the light to the picture's form.
    pub fn in_picture(&self) -> TracedLight {
        let [open, around, weight, seen, bounced] =
            [self.open, self.around, self.weight, self.seen, self.bounced]
                .map(|rgb| rgb.as_vec3().to_array());
        TracedLight {
            open,
            around,
            weight,
            seen,
            bounced,
            share_moments: self.share_moments.as_vec3().to_array(),
            bounced_moments: self.bounced_moments.as_vec3().to_array(),
        }
    }
}

impl AddAssign for LayerLight {
    fn add_assign(&mut self, other: Self) {
        self.open += other.open;
        self.around += other.around;
        self.weight += other.weight;
        self.seen += other.seen;
        self.bounced += other.bounced;
        self.share_moments += other.share_moments;
        self.bounced_moments += other.bounced_moments;
    }
}

/// The base of a sample.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BaseLight {
    /// Reflected at the surface; scratches take from it.
    pub specular: LayerLight,
    /// Light of the body under it.
    pub diffuse: LayerLight,
}

/// The rays of a layer, round by round.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LayerRays {
    sum: LayerLight,
    /// Weight of the current round.
    weight: DVec3,
    seen: DVec3,
    bounced: DVec3,
    rounds: u32,
}

impl LayerRays {
    pub fn new(open: DVec3, around: DVec3) -> Self {
        Self {
            sum: LayerLight {
                open,
                around,
                ..LayerLight::default()
            },
            ..Self::default()
        }
    }

    /// A ray to a source. Weights add up to the closed form of all sources in the mean.
    pub fn add(&mut self, weight: DVec3, is_seen: bool) {
        self.weight += weight;
        if is_seen {
            self.seen += weight;
        }
    }

    /// Adds the light that a ray brings from another object.
    pub fn bounce(&mut self, light: DVec3) {
        self.bounced += light;
    }

    pub(crate) fn end_round(&mut self) {
        let sum = &mut self.sum;
        sum.weight += self.weight;
        sum.seen += self.seen;
        sum.bounced += self.bounced;
        let moments = |whole: DVec3, part: DVec3| {
            let (x, y) = (luminance(whole), luminance(part));
            DVec3::new(x * x, x * y, y * y)
        };
        sum.share_moments += moments(self.weight, self.seen);
        sum.bounced_moments += moments(sum.around, self.bounced);
        (self.weight, self.seen, self.bounced) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        self.rounds += 1;
    }

    /// The mean over the rounds. Where no ray went to a lit source, `probe` tells whether all of it is seen.
    pub fn light(self, probe: impl FnOnce() -> bool) -> LayerLight {
        let Self {
            mut sum, rounds, ..
        } = self;
        if sum.weight == DVec3::ZERO && sum.open != DVec3::ZERO {
            sum.weight = sum.open;
            if probe() {
                sum.seen = sum.open;
            }
        } else {
            let per_round = 1.0 / f64::from(rounds.max(1));
            sum.weight *= per_round;
            sum.seen *= per_round;
        }
        sum.bounced *= 1.0 / f64::from(rounds.max(1));
        sum
    }
}
