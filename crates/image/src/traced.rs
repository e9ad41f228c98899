//! Light that rays found in a picture, beside the closed forms. Rays tell which share of a closed form is seen, and which light comes by way of
//! other objects. Pictures of further rays add up here, and the filter works on it ([`crate::filter`]).

use bytemuck::{Pod, Zeroable};

use crate::tone_map::tone_luminance as luminance;

/// Light that rays found in a picture, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// Number of rays from each pixel to each source of light.
    pub rounds: u32,
    /// Light of each pixel of the image.
    pub pixels: Vec<TracedPixel>,
}

/// Light that rays found in a pixel. A shader writes the same struct.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TracedPixel {
    /// Light that no ray changes: the background, and that of surfaces that emit. Linear Rec.709 radiance.
    pub rest: [f32; 3],
    /// Perceptual, from 0 to 1.
    pub roughness: f32,
    /// The object that is seen, and 1; 0 for the background; [`Self::SEVERAL_OBJECTS`] on edges.
    pub object: u32,
    /// Light of the base's body.
    pub diffuse: TracedLight,
    /// Light of the base's surface.
    pub specular: TracedLight,
    /// Light of scratches and gratings.
    pub scratches: TracedLight,
}

/// Light that rays found in one layer of a pixel. Linear Rec.709 radiance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TracedLight {
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
    /// Sums over the rounds of x x, x y and y y, the luminances of a round's weight and of the part of it that is seen.
    pub share_moments: [f32; 3],
    /// The same of `around` and of the light of other objects.
    pub bounced_moments: [f32; 3],
}

impl TracedLight {
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
        for i in 0..3 {
            self.share_moments[i] += other.share_moments[i];
            self.bounced_moments[i] += other.bounced_moments[i];
        }
    }
}

/// The variance of a ratio of sums over rounds, from the means of the part and of the whole and from their moments. A round counts for as much as it weighs:
/// what is left of the parts, less the ratio times their wholes, is squared. A round that outweighs the others draws the ratio to itself and leaves
/// little; the jackknife divides by the square of what the whole has without it (B. Efron, C. Stein, *The Jackknife Estimate of Variance*, 1981), here
/// for all rounds by their mean share. 0 for one round, which tells nothing of it.
fn ratio_variance(part: f32, all: f32, [xx, xy, yy]: [f32; 3], rounds: u32) -> f32 {
    if rounds < 2 || !(all > 0.0) {
        return 0.0;
    }
    let (n, ratio) = (rounds as f32, part / all);
    let sum = n * all;
    let left = (yy - 2.0 * ratio * xy + ratio * ratio * xx) / (sum * sum);
    let of_others = (1.0 - xx / (sum * sum)).max(LEAST_OF_OTHERS);
    (left * (1.0 - 1.0 / n) / (of_others * of_others)).max(0.0)
}

/// Least share of the other rounds: with less, one round is all that is known.
const LEAST_OF_OTHERS: f32 = 1e-3;
/// The largest variance of a share: of one that is nothing or all.
const MOST_SHARE_VARIANCE: f32 = 0.25;

/// Multiplies a closed form by the shares of its channels. A channel below 0, where a colour lies outside of the gamut, takes the share of the
/// luminance of the others, so that the result has no negative luminance. Twin: `traced_left`.
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

impl TracedPixel {
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

impl Traced {
    /// Adds the light of further rounds of the same picture.
    pub fn add(&mut self, other: &Self) {
        self.rounds += other.rounds;
        let share = other.rounds as f32 / self.rounds.max(1) as f32;
        for (pixel, other) in self.pixels.iter_mut().zip(&other.pixels) {
            pixel.add(other, share);
        }
    }
}

impl TracedLight {
    /// The variances of the share of luminance that is seen and of the ratio of luminances of `bounced` and `around`, after so many rounds.
    pub(crate) fn variances(&self, rounds: u32) -> [f32; 2] {
        let of_ratio =
            |part, all, moments| ratio_variance(luminance(part), luminance(all), moments, rounds);
        [
            of_ratio(self.seen, self.weight, self.share_moments).min(MOST_SHARE_VARIANCE),
            of_ratio(self.bounced, self.around, self.bounced_moments),
        ]
    }

    /// The variance of [`Self::light`] after so many rounds, by channel. Rays to sources and to objects are drawn apart.
    pub(crate) fn variance(&self, rounds: u32) -> [f32; 3] {
        let [of_share, of_bounced] = self.variances(rounds);
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
            TracedLight {
                open,
                weight,
                seen,
                ..TracedLight::default()
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
        let pixel = |weight: f32| TracedPixel {
            scratches: TracedLight {
                open: [0.1, 0.2, 0.3],
                weight: [weight; 3],
                seen: [weight; 3],
                ..TracedLight::default()
            },
            ..TracedPixel::default()
        };
        let traced = |weight, rounds| Traced {
            rounds,
            pixels: vec![pixel(weight)],
        };
        let mut sum = traced(0.37, 4);
        for (i, rounds) in [4, 8, 16].into_iter().enumerate() {
            sum.add(&traced(0.11 * i as f32 + 0.1, rounds));
        }
        assert_eq!(sum.rounds, 32);
        assert_eq!(sum.pixels[0].light()[1], [0.1, 0.2, 0.3]);
    }

    /// Rounds that all weigh as much, and rounds of which few carry most, as where a lobe seldom meets a lamp.
    #[test]
    fn the_variance_of_a_share_is_that_of_many_trials() {
        const ROUNDS: u32 = 8;
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        for heavy in [1.0, 30.0] {
            let [mut shares, mut squares, mut variances] = [0.0; 3];
            let trials = 4000;
            for _ in 0..trials {
                let mut light = TracedLight::default();
                for _ in 0..ROUNDS {
                    let x = if random() < 0.16 { heavy } else { 1.0 };
                    let y = if random() < 0.5 { x } else { 0.0 };
                    for c in 0..3 {
                        light.weight[c] += x / ROUNDS as f32;
                        light.seen[c] += y / ROUNDS as f32;
                        light.share_moments[c] += [x * x, x * y, y * y][c];
                    }
                }
                let share = f64::from(light.share()[0]);
                shares += share;
                squares += share * share;
                variances += f64::from(light.variances(ROUNDS)[0]);
            }
            let mean = shares / f64::from(trials);
            let told = variances / (squares - shares * mean);
            assert!((0.6..1.2).contains(&told), "{heavy}: {told}");
        }
    }
}
