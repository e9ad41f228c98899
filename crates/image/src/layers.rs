//! Whichever layers of a render a file holds: what a comparison works on.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::exr_file::{self, Contents, Notes};
use crate::metrics::Estimate;
use crate::{Display, Error, Image, Layer, Picture, png, tone_map};

/// What the numbers of a picture refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Referred {
    /// The scene: linear radiance, without bounds (EXR).
    Scene,
    /// The display: linear too, but a tone curve and the display's range are in it (PNG).
    Display,
}

/// One layer with what is known of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldLayer {
    /// Which one.
    pub layer: Layer,
    /// Its values, three a pixel; depth has the same in all three.
    pub values: Vec<[f32; 3]>,
    /// The variance of each value, if the layer is an estimate.
    pub variance: Option<Vec<[f32; 3]>>,
}

/// The layers that one file or one render has, all of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    /// Width and height.
    pub size_px: [u32; 2],
    /// What the beauty's numbers refer to.
    pub referred: Referred,
    /// In the order of [`Layer::ALL`]. Never empty when read from a file.
    pub held: Vec<HeldLayer>,
    /// Complete batches that each pixel's variances come from; `None` where nothing says so, and variances are then
    /// taken as exact.
    pub batches: Option<Vec<u32>>,
    /// What the file remembers about its making.
    pub notes: Notes,
}

impl Layers {
    /// Reads a file by its contents, whatever its name: any EXR, with all layers that Hairline knows by name (the
    /// beauty from R, G and B, or from Y), or a PNG, whose sRGB codes become a linear beauty.
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
            Self::from_exr(path, &Contents::read(path)?)
        } else if start.starts_with(b"\x89PNG\r\n\x1a\n") {
            Ok(Self::of_displayed(png::read_picture(path)?))
        } else {
            Err(Error::Unusable {
                path: path.to_owned(),
                reason: "neither an EXR nor a PNG file".to_owned(),
            })
        }
    }

    /// A picture as a display shows it, already tone-mapped.
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
        }
    }

    /// A layer, if it is there.
    pub fn get(&self, layer: Layer) -> Option<&HeldLayer> {
        self.held.iter().find(|held| held.layer == layer)
    }

    /// A layer with all that is known of its noise, as the metrics take it.
    pub fn estimate(&self, layer: Layer) -> Option<Estimate<'_>> {
        let held = self.get(layer)?;
        Some(Estimate {
            values: &held.values,
            variance: held.variance.as_deref(),
            batches: self.batches.as_deref(),
        })
    }

    /// What a display shows of the beauty, as linear values in [0, 1]: tone-mapped unless that is done already. The
    /// other layers and the noise are left out: they mean nothing after the curve. Empty if there is no beauty.
    pub fn displayed(&self, display: &Display) -> Self {
        let values = match (self.get(Layer::Beauty), self.referred) {
            (None, _) => Vec::new(),
            (Some(beauty), Referred::Display) => beauty.values.clone(),
            (Some(beauty), Referred::Scene) => beauty
                .values
                .iter()
                .map(|&rgb| display.apply(rgb).map(tone_map::linear_from_srgb))
                .collect(),
        };
        let mut shown = Self::of_displayed(Picture {
            size_px: self.size_px,
            rgb: values,
        });
        shown.held.retain(|held| !held.values.is_empty());
        shown.notes = self.notes.clone();
        shown
    }

    fn from_exr(path: &Path, file: &Contents) -> Result<Self, Error> {
        let mut held = Vec::new();
        let mut size_px: Option<[u32; 2]> = None;
        for layer in Layer::ALL {
            let picture = file.find(exr_file::channel_names(layer)).or_else(|| {
                let grey = layer == Layer::Beauty;
                grey.then(|| file.find(["Y"; 3])).flatten()
            });
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
                variance: exr_file::variance_channel_names(layer)
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
                .map(|layer| HeldLayer {
                    layer,
                    values: image.layer(layer),
                    variance: image.variance(layer).map(<[_]>::to_vec),
                })
                .into(),
            batches: image
                .noise
                .as_ref()
                .map(|noise| (0..noise.samples.len()).map(|i| noise.batches(i)).collect()),
            notes: Notes::new(),
        }
    }
}
