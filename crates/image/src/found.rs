//! Light that rays found in a picture, beside the closed forms. Rays tell which share of a closed form is seen, and which light comes by way of
//! other objects. Pictures of further rays add up here, and the filter works on it ([`crate::filter`]).

use bytemuck::{Pod, Zeroable};

use crate::tone_map::tone_luminance as luminance;

/// Light that rays found in a picture, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Number of rays from each pixel to each source of light.
    pub rounds: u32,
    /// Light of each pixel of the image.
    pub pixels: Vec<FoundPixel>,
}

/// Light that rays found in a pixel. A shader writes the same struct.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FoundPixel {
    /// Light that no ray changes: the background, and that of surfaces that emit. Linear Rec.709 radiance.
    pub rest: [f32; 3],
    /// Perceptual, from 0 to 1.
    pub roughness: f32,
    /// The object that is seen, and 1; 0 for the background; [`Self::SEVERAL_OBJECTS`] on edges.
    pub object: u32,
    /// Light of the base's body.
    pub diffuse: FoundLight,
    /// Light of the base's surface.
    pub specular: FoundLight,
    /// Light of scratches and gratings.
    pub scratches: FoundLight,
}

/// Light that rays found in one layer of a pixel. Linear Rec.709 radiance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FoundLight {
    /// Closed form: the light that is sent where nothing hides a source.
    pub open: [f32; 3],
    /// Light that would be sent if radiance 1 came from all around.
    pub around: [f32; 3],
    /// The mean weight of the rays to sources: `open`, but for noise.
    pub weight: [f32; 3],
    /// The part of `weight` whose rays see their source.
    pub seen: [f32; 3],
    /// Light of other objects: the mean of the rays.
    pub bounced: [f32; 3],
    /// Sums over the rounds of the share of luminance that is seen, and of its square.
    pub share_moments: [f32; 2],
    /// Sums over the rounds of the ratio of luminances of `bounced` and `around`, and of its square.
    pub bounced_moments: [f32; 2],
}

impl FoundLight {
    /// The share of the closed form that is seen, from 0 to 1: the ratio of sums of E. Heitz, S. Hill, M. McGuire, *Combining Analytic Direct
    /// Illumination and Stochastic Shadows*, 2018. It is consistent, never below 0 nor above 1, and exact where all rays or none see their source.
    pub fn share(&self) -> [f32; 3] {
        let of_all = ratio(luminance(self.seen), luminance(self.weight)).unwrap_or(1.0);
        std::array::from_fn(|c| ratio(self.seen[c], self.weight[c]).unwrap_or(of_all))
    }

    /// The light that is left, with that of other objects.
    pub fn light(&self) -> [f32; 3] {
        let left = left(self.open, self.share());
        std::array::from_fn(|c| left[c] + self.bounced[c])
    }

    /// Adds the light of further rounds: `share` is their share of all.
    fn add(&mut self, other: &Self, share: f32) {
        let mix = |a: &mut [f32; 3], b: &[f32; 3]| {
            for c in 0..3 {
                a[c] += (b[c] - a[c]) * share;
            }
        };
        mix(&mut self.open, &other.open);
        mix(&mut self.around, &other.around);
        mix(&mut self.weight, &other.weight);
        mix(&mut self.seen, &other.seen);
        mix(&mut self.bounced, &other.bounced);
        for i in 0..2 {
            self.share_moments[i] += other.share_moments[i];
            self.bounced_moments[i] += other.bounced_moments[i];
        }
    }
}

/// The variance of the mean of so many numbers, from their sum and that of their squares; 0 for one, which tells nothing of it.
pub(crate) fn variance([sum, squares]: [f32; 2], count: u32) -> f32 {
    if count < 2 {
        return 0.0;
    }
    let n = count as f32;
    ((squares - sum * sum / n) / (n * (n - 1.0))).max(0.0)
}

/// Multiplies a closed form by the shares of its channels. A channel below 0, where a colour lies outside of the gamut, takes the share of the
/// luminance of the others, so that the result has no negative luminance. Twin: `found_left`.
pub(crate) fn left(open: [f32; 3], share: [f32; 3]) -> [f32; 3] {
    let bright = open.map(|value| value.max(0.0));
    let bright_left = std::array::from_fn(|c| bright[c] * share[c]);
    match ratio(luminance(bright_left), luminance(bright)) {
        Some(of_bright) => {
            std::array::from_fn(|c| open[c] * if open[c] < 0.0 { of_bright } else { share[c] })
        }
        // No channel is above 0: the linear mask may take more than all of the base.
        None => std::array::from_fn(|c| open[c] * share[c]),
    }
}

/// Ratio of a part to the whole, 0 to 1; none where the whole is nothing.
fn ratio(part: f32, all: f32) -> Option<f32> {
    (all > 0.0).then(|| (part / all).clamp(0.0, 1.0))
}

impl FoundPixel {
    /// Stands for the object where samples see several.
    pub const SEVERAL_OBJECTS: u32 = u32::MAX;

    /// The layers of [`Image`](crate::Image) that it says: base and scratches.
    pub fn light(&self) -> [[f32; 3]; 2] {
        let (diffuse, specular) = (self.diffuse.light(), self.specular.light());
        let base = std::array::from_fn(|c| self.rest[c] + (diffuse[c] + specular[c]));
        [base, self.scratches.light()]
    }

    /// Divides the sum over the samples of a pixel by their number; `covered` of them see a surface. Each sample has rays of its own, so the sums
    /// for the noise add up.
    #[must_use]
    pub fn mean(mut self, samples: f32, covered: f32) -> Self {
        let layers = [&mut self.diffuse, &mut self.specular, &mut self.scratches];
        let sums = layers.into_iter().flat_map(|light| {
            [
                &mut light.open,
                &mut light.around,
                &mut light.weight,
                &mut light.seen,
                &mut light.bounced,
            ]
        });
        for sum in sums.chain([&mut self.rest]) {
            *sum = sum.map(|v| v / samples);
        }
        self.roughness /= covered.max(1.0);
        self
    }

    fn add(&mut self, other: &Self, share: f32) {
        for c in 0..3 {
            self.rest[c] += (other.rest[c] - self.rest[c]) * share;
        }
        self.diffuse.add(&other.diffuse, share);
        self.specular.add(&other.specular, share);
        self.scratches.add(&other.scratches, share);
    }
}

impl Found {
    /// Adds the light of further rounds of the same picture.
    pub fn add(&mut self, other: &Self) {
        self.rounds += other.rounds;
        let share = other.rounds as f32 / self.rounds.max(1) as f32;
        for (pixel, other) in self.pixels.iter_mut().zip(&other.pixels) {
            pixel.add(other, share);
        }
    }
}

impl FoundLight {
    /// The variance of [`Self::light`] after so many rounds, by channel. Rays to sources and to objects are drawn apart.
    pub(crate) fn variance(&self, rounds: u32) -> [f32; 3] {
        let of_share = variance(self.share_moments, rounds);
        let of_bounced = variance(self.bounced_moments, rounds);
        std::array::from_fn(|c| {
            self.open[c] * self.open[c] * of_share + self.around[c] * self.around[c] * of_bounced
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_a_saturated_colour_is_light() {
        let open = [-0.1, 0.35, 0.48];
        assert_eq!(left(open, [1.0; 3]), open);
        assert_eq!(left(open, [1.0, 0.0, 0.0]), [0.0; 3]);
        for share in [[1.0, 0.2, 0.0], [1.0, 0.0, 0.3], [0.0, 1.0, 0.1]] {
            let left = left(open, share);
            assert!(luminance(left) > 0.0 && left[0] >= open[0], "{left:?}");
        }
        assert_eq!(left([-0.1; 3], [1.0; 3]), [-0.1; 3]);
        // The red of a channel by itself would be left alone.
        assert!(luminance([open[0], 0.0, 0.0]) < 0.0);
    }

    #[test]
    fn light_lies_between_nothing_and_the_closed_form() {
        let open = [2.0, 3.0, 4.0];
        let of = |weight, seen| {
            FoundLight {
                open,
                weight,
                seen,
                ..FoundLight::default()
            }
            .light()
        };
        let weight = [0.1, 0.7, 0.3];
        assert_eq!(of(weight, weight), open);
        assert_eq!(of(weight, [0.0; 3]), [0.0; 3]);
        assert_eq!(of([0.0; 3], [0.0; 3]), open);
        // Colours out of gamut have weights below 0: the other channels speak for them.
        assert_eq!(of([-0.1, 0.5, 0.5], [-0.1, 0.25, 0.25])[1], 1.5);
        let wrong = of([1.0, 1.0, 1.0], [-0.1, 0.5, 1.5]);
        assert_eq!(wrong, [0.0, 1.5, 4.0]);
    }

    #[test]
    fn what_all_rounds_see_stays_to_the_bit() {
        let pixel = |weight: f32| FoundPixel {
            scratches: FoundLight {
                open: [0.1, 0.2, 0.3],
                weight: [weight; 3],
                seen: [weight; 3],
                ..FoundLight::default()
            },
            ..FoundPixel::default()
        };
        let found = |weight, rounds| Found {
            rounds,
            pixels: vec![pixel(weight)],
        };
        let mut sum = found(0.37, 4);
        for (i, rounds) in [4, 8, 16].into_iter().enumerate() {
            sum.add(&found(0.11 * i as f32 + 0.1, rounds));
        }
        assert_eq!(sum.rounds, 32);
        assert_eq!(sum.pixels[0].light()[1], [0.1, 0.2, 0.3]);
    }
}
