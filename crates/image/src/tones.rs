//! Means of a pixel's samples for a display.
//!
//! The linear mean of an edge between a lamp's mirror image and black metal is white as soon as one sample of it is: such edges look ragged however
//! many samples there are. A display must average what it shows of each sample. L / (1 + L) stands for its curve (E. Reinhard et al., *Photographic
//! Tone Reproduction for Digital Images*, 2002): its mean adds up over samples and batches, as the linear mean does.

use bytemuck::{Pod, Zeroable};

/// Tones of a picture. No file holds them: files of radiance have linear means.
#[derive(Clone, Debug, PartialEq)]
pub struct Tones {
    /// Factor on luminances before they are compressed: 2^exposure of the scene.
    pub gain: f32,
    /// Tone of each pixel of the image.
    pub pixels: Vec<Tone>,
}

/// Tone of a pixel: two means over its samples. A shader writes the same struct.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Tone {
    /// Rec.709 luminance, as rays found it: no filter changes it.
    pub luminance: f32,
    /// g L / (1 + g L), g being the gain and L a luminance.
    pub compressed: f32,
}

/// Curve from 0 to 1 that stands for a display's. Twin: `tone_compressed`.
fn compressed(luminance: f32, gain: f32) -> f32 {
    let exposed = gain * luminance.max(0.0);
    exposed / (1.0 + exposed)
}

/// Share above which a display shows white alone; 32 bits hold no finer difference.
const WHITE: f32 = 0.9999;

impl Tone {
    /// Tone of one sample.
    pub fn of_sample(luminance: f32, gain: f32) -> Self {
        Self {
            luminance,
            compressed: compressed(luminance, gain),
        }
    }

    /// Share of the pixel's linear mean that a display shows, from 0 to 1; 1 where all samples are alike. Twin: `tone_share`.
    pub fn share(&self, gain: f32) -> f32 {
        let exposed = gain * self.luminance;
        if exposed <= 0.0 || self.compressed >= WHITE {
            return 1.0;
        }
        let shown = self.compressed / (1.0 - self.compressed);
        (shown / exposed).min(1.0)
    }
}

impl Tones {
    /// Adds the tones of further samples, whose share of all samples is `share`.
    pub fn add(&mut self, other: &Self, share: f32) {
        for (tone, other) in self.pixels.iter_mut().zip(&other.pixels) {
            tone.luminance += (other.luminance - tone.luminance) * share;
            tone.compressed += (other.compressed - tone.compressed) * share;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(luminances: &[f32], gain: f32) -> Tone {
        let mut tones = Tones {
            gain,
            pixels: vec![Tone::default()],
        };
        for (i, &luminance) in luminances.iter().enumerate() {
            let sample = Tones {
                gain,
                pixels: vec![Tone::of_sample(luminance, gain)],
            };
            tones.add(&sample, 1.0 / (i + 1) as f32);
        }
        tones.pixels[0]
    }

    #[test]
    fn samples_that_are_alike_are_shown_as_they_are() {
        for luminance in [0.0, 1e-6, 0.3, 20.0, 500.0, 1e9] {
            for gain in [0.01, 1.0, 8.0] {
                let share = mean(&[luminance; 5], gain).share(gain);
                assert!((share - 1.0).abs() < 2e-3, "{luminance} {gain}: {share}");
            }
        }
    }

    #[test]
    fn an_edge_of_a_lamp_is_half_way_to_white() {
        // A lamp of 1000 and black show as 1 and 0, so their mean shows as 1/2, as a luminance of 1 does.
        let tone = mean(&[1000.0, 0.0], 1.0);
        let shown = tone.luminance * tone.share(1.0);
        assert!((shown - 1.0).abs() < 0.01, "{shown}");
        // And one of 0.02 and 0.04, far from white, as its mean.
        let tone = mean(&[0.02, 0.04], 1.0);
        assert!((tone.share(1.0) - 1.0).abs() < 4e-3);
    }
}
