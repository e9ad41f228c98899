//! The layers of a render, each as a picture.

use hairline_image::{Display, Image, Picture, png};

use super::false_color;

hairline_image::listed! {
    /// Layer or false colour of a render on the screen.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Shows {
        /// The picture.
        #[default]
        Beauty = "Beauty", "The picture";
        /// The picture's exposure in stops from middle grey.
        FalseColor = "False colour", "Exposure in stops from middle grey";
        /// Light off the base and of the background.
        Base = "Base", "Light by way of the base and the background, without scratches";
        /// Light off the scratches.
        Scratches = "Scratches", "Light by way of the scratches alone";
        /// The share of the base's light that the scratches take.
        Density = "Density", "The share of the base's light that scratches take, from none to all";
        /// Normals: red is x, green y, blue z of the world, from -1 to 1.
        Normal = "Normal", "The surface's normal in world space: red x, green y, blue z";
        /// Depths: near is bright; black where there is no surface.
        Depth = "Depth", "Distance along the view: near is bright";
    }
    /// Name in the window.
    fn name;
    /// Description for a hint.
    fn hint;
}

impl Shows {
    /// The one after it; after the last the first.
    pub(crate) fn next(self) -> Self {
        let i = Self::ALL.iter().position(|other| *other == self);
        Self::ALL[i.map_or(0, |i| (i + 1) % Self::ALL.len())]
    }
}

/// Displayed codes of a layer, three bytes a pixel; of depths also the nearest and the farthest, metres.
pub(super) fn pixels(
    image: &Image,
    shows: Shows,
    display: &Display,
) -> (Vec<u8>, Option<[f32; 2]>) {
    let picture = |rgb: &[[f32; 3]]| Picture {
        size_px: image.size_px,
        rgb: rgb.to_vec(),
    };
    let code = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
    let pixels = match shows {
        Shows::Beauty => png::quantize(&image.beauty(), display),
        Shows::FalseColor => false_color::pixels(&image.beauty(), display),
        Shows::Base => png::quantize(&picture(&image.base), display),
        Shows::Scratches => png::quantize(&picture(&image.scratches), display),
        // Data, as they are: half is half of the scale.
        Shows::Density => image.density.iter().flatten().map(|&d| code(d)).collect(),
        Shows::Normal => {
            let codes = image.normal.iter().map(|&normal| match normal {
                [0.0, 0.0, 0.0] => [0; 3],
                normal => normal.map(|n| code(0.5 + 0.5 * n)),
            });
            codes.flatten().collect()
        }
        Shows::Depth => return depths(image),
    };
    (pixels, None)
}

fn depths(image: &Image) -> (Vec<u8>, Option<[f32; 2]>) {
    let seen = || image.depth_m.iter().copied().filter(|z| *z > 0.0);
    let [near, far] = [
        seen().fold(f32::INFINITY, f32::min),
        seen().fold(0.0, f32::max),
    ];
    let span = (far - near).max(f32::MIN_POSITIVE);
    let codes = image.depth_m.iter().map(|&z| match z > 0.0 {
        // The farthest is still told from nothing.
        true => (255.0 - 225.0 * ((z - near) / span).clamp(0.0, 1.0)).round() as u8,
        false => 0,
    });
    let pixels = codes.flat_map(|code| [code; 3]).collect();
    (pixels, (far > 0.0).then_some([near, far]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_layer_shows_what_it_holds() {
        let mut image = Image::new([3, 1]);
        image.base = vec![[0.1; 3], [0.0; 3], [0.0; 3]];
        image.scratches = vec![[0.0; 3], [0.2, 0.0, 0.0], [0.0; 3]];
        image.density = vec![[0.5; 3], [1.0; 3], [0.0; 3]];
        image.normal = vec![[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0; 3]];
        image.depth_m = vec![0.5, 1.5, 0.0];
        let display = Display::default();
        let of = |shows| pixels(&image, shows, &display).0;
        assert_eq!(of(Shows::Normal)[..6], [128, 128, 255, 0, 128, 128]);
        assert_eq!(of(Shows::Density)[..6], [128, 128, 128, 255, 255, 255]);
        let base = of(Shows::Base);
        assert!(base[0] > 50 && base[3] == 0);
        let scratches = of(Shows::Scratches);
        assert!(scratches[0] == 0 && scratches[3] > 50 && scratches[4] == 0);
        let (depth, range_m) = pixels(&image, Shows::Depth, &display);
        assert_eq!((depth[0], depth[3], depth[6]), (255, 30, 0));
        assert_eq!(range_m, Some([0.5, 1.5]));
        let mut shows = Shows::default();
        for _ in Shows::ALL {
            shows = shows.next();
        }
        assert_eq!(shows, Shows::Beauty);
    }
}
