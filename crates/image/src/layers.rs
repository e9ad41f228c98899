//! Layers of a render in a file, as a comparison works on them.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::exr_file::contents::Contents;
use crate::exr_file::names::{channel_names, variance_channel_names};
use crate::exr_file::{Notes, Window};
use crate::metrics::Estimate;
use crate::{Display, Error, Image, Layer, Picture, png, tone_map};

/// Reference of a picture's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Referred {
    /// The scene: linear radiance, without bounds (EXR).
    Scene,
    /// The display: linear too, but a tone curve and the display's range are in it (PNG).
    Display,
}

/// One layer with the variances of its noise, where they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldLayer {
    /// Kind of the layer.
    pub layer: Layer,
    /// Values of the layer, three a pixel; depth has the same in all three.
    pub values: Vec<[f32; 3]>,
    /// The variance of each value, if the layer is an estimate.
    pub variance: Option<Vec<[f32; 3]>>,
}

/// The layers that one file or one render has, all of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Reference of the beauty's numbers.
    pub referred: Referred,
    /// Layers in the order of [`Layer::ALL`]. Never empty when read from a file.
    pub held: Vec<HeldLayer>,
    /// Complete batches that each pixel's variances come from; `None` where nothing says so, and variances are then
    /// taken as exact.
    pub batches: Option<Vec<u32>>,
    /// Notes in the file on its making.
    pub notes: Notes,
    /// Window of the file, where it holds a part of its picture.
    pub window: Option<Window>,
}

impl Layers {
    /// Reads a file by its contents, whatever its name: any EXR, with all layers that Hairline knows by name (the
    /// beauty from R, G and B in Rec.709, or from X, Y and Z, or from Y), or a PNG, whose sRGB codes become a linear beauty,
    /// multiplied by its alpha.
    ///
    /// # Errors
    /// [`Error::CannotRead`]; [`Error::Unusable`] for other formats, for files without any layer, and where layers
    /// differ in size.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let mut start = Vec::with_capacity(8);
        File::open(path)
            .and_then(|file| file.take(8).read_to_end(&mut start))
            .map_err(|e| Error::cannot_read(path, &e))?;
        if start.starts_with(b"\x76\x2f\x31\x01") {
            Self::from_exr(path, &Contents::read(&path.into())?)
        } else if start.starts_with(b"\x89PNG\r\n\x1a\n") {
            let (picture, alpha) = png::read_with_alpha(path)?;
            let mut layers = Self::of_displayed(picture);
            layers.hold_alpha(alpha);
            Ok(layers)
        } else {
            Err(Error::Unusable {
                path: path.to_owned(),
                reason: "neither an EXR nor a PNG file".to_owned(),
            })
        }
    }

    /// Wraps a picture that is tone-mapped already.
    pub fn of_displayed(picture: Picture) -> Self {
        Self {
            size_px: picture.size_px,
            referred: Referred::Display,
            held: vec![HeldLayer {
                layer: Layer::Beauty,
                values: picture.rgb,
                variance: None,
            }],
            batches: None,
            notes: Notes::new(),
            window: None,
        }
    }

    fn hold_alpha(&mut self, alpha: Option<Vec<f32>>) {
        self.held.extend(alpha.map(|alpha| HeldLayer {
            layer: Layer::Alpha,
            values: alpha.into_iter().map(|a| [a; 3]).collect(),
            variance: None,
        }));
    }

    /// A layer, if it is there.
    pub fn get(&self, layer: Layer) -> Option<&HeldLayer> {
        self.held.iter().find(|held| held.layer == layer)
    }

    /// Layer with its variances and samples, as the metrics take it.
    pub fn estimate(&self, layer: Layer) -> Option<Estimate<'_>> {
        let held = self.get(layer)?;
        Some(Estimate {
            values: &held.values,
            variance: held.variance.as_deref(),
            batches: self.batches.as_deref(),
        })
    }

    /// Returns the beauty as a display shows it, as linear values in [0, 1]: tone-mapped unless that is done already. Alpha
    /// stays; the other layers and the noise are left out: they mean nothing after the curve. Empty if there is no beauty.
    pub fn displayed(&self, display: &Display) -> Self {
        let alpha = self.get(Layer::Alpha).map(|held| &held.values);
        let shown = |(i, &rgb): (usize, &[f32; 3])| {
            // Files have colours multiplied by alpha; the curve applies to the colours alone.
            let share = alpha.map_or(1.0, |alpha| alpha[i][0]);
            if !(share > 0.0) {
                return [0.0; 3];
            }
            let shown = display.apply(rgb.map(|c| c / share));
            shown.map(|code| tone_map::linear_from_srgb(code) * share)
        };
        let values = match (self.get(Layer::Beauty), self.referred) {
            (None, _) => Vec::new(),
            (Some(beauty), Referred::Display) => beauty.values.clone(),
            (Some(beauty), Referred::Scene) => {
                beauty.values.iter().enumerate().map(shown).collect()
            }
        };
        let mut shown = Self::of_displayed(Picture {
            size_px: self.size_px,
            rgb: values,
        });
        shown.held.retain(|held| !held.values.is_empty());
        shown.held.extend(self.get(Layer::Alpha).cloned());
        shown.notes = self.notes.clone();
        shown.window = self.window;
        shown
    }

    fn from_exr(path: &Path, file: &Contents) -> Result<Self, Error> {
        let mut held = Vec::new();
        let mut size_px: Option<[u32; 2]> = None;
        for layer in Layer::ALL {
            let picture = match layer {
                Layer::Beauty => file.beauty(),
                _ => file.find(channel_names(layer)),
            };
            let Some(picture) = picture else { continue };
            let expected = *size_px.get_or_insert(picture.size_px);
            if picture.size_px != expected {
                return Err(Error::Unusable {
                    path: path.to_owned(),
                    reason: format!(
                        "the layer {} has {} x {} pixels, another {} x {}",
                        layer.name(),
                        picture.size_px[0],
                        picture.size_px[1],
                        expected[0],
                        expected[1]
                    ),
                });
            }
            held.push(HeldLayer {
                layer,
                variance: variance_channel_names(layer)
                    .and_then(|names| file.find(names))
                    .filter(|variance| variance.size_px == expected)
                    .map(|variance| variance.rgb),
                values: picture.rgb,
            });
        }
        let Some(size_px) = size_px else {
            return Err(Error::Unusable {
                path: path.to_owned(),
                reason: "no channels R, G and B, nor base.R, scratches.R, density.R, depth.Z or normal.X \
                         with their fellows: nothing to look at"
                    .to_owned(),
            });
        };
        let pixels = held[0].values.len();
        let batches = file
            .samples()
            .filter(|(samples, batch)| samples.len() == pixels && *batch > 0)
            .map(|(samples, batch)| samples.iter().map(|n| n / batch).collect());
        Ok(Self {
            size_px,
            referred: Referred::Scene,
            held,
            batches,
            notes: file.notes.clone(),
            window: file.window(),
        })
    }
}

impl From<&Image> for Layers {
    /// All layers of a render.
    fn from(image: &Image) -> Self {
        Self {
            size_px: image.size_px,
            referred: Referred::Scene,
            held: Layer::ALL
                .into_iter()
                .filter(|layer| *layer != Layer::Alpha || image.alpha.is_some())
                .map(|layer| HeldLayer {
                    layer,
                    values: image.layer(layer),
                    variance: image.variance(layer).map(<[_]>::to_vec),
                })
                .collect(),
            batches: image
                .noise
                .as_ref()
                .map(|noise| (0..noise.samples.len()).map(|i| noise.batches(i)).collect()),
            notes: Notes::new(),
            window: None,
        }
    }
}
