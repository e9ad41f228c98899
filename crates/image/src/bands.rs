//! Pictures in bands of the spectrum.
//!
//! Files have the channels of A. Fichet, R. Pacanowski and A. Wilkie, "An OpenEXR Layout for Spectral Images" (JCGT 2021): `S0.405,0nm` is the band with
//! its middle at 405 nm. The layers are `base.S0.405,0nm` and `scratches.S0.405,0nm`.

use std::path::Path;

use exr::prelude::{AnyChannel, FlatSamples, Text, attribute::AttributeValue};

use crate::{Error, Image, exr_file, output};

/// A picture in bands of the spectrum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BandImage {
    /// Width and height.
    pub size_px: [u32; 2],
    /// From one wavelength to a longer one.
    pub bands_nm: Vec<[f64; 2]>,
    /// Light off the base in each band, row by row from the top.
    pub base: Vec<Vec<f32>>,
    /// Light off the scratches in each band.
    pub scratches: Vec<Vec<f32>>,
}

impl BandImage {
    /// Adds bands that are the first channels of a picture.
    pub fn add(&mut self, bands_nm: &[[f64; 2]], image: &Image) {
        self.size_px = image.size_px;
        for (c, band) in bands_nm.iter().enumerate() {
            let channel = |layer: &[[f32; 3]]| layer.iter().map(|it| it[c]).collect();
            self.bands_nm.push(*band);
            self.base.push(channel(&image.base));
            self.scratches.push(channel(&image.scratches));
        }
    }

    /// Writes an .exr: the whole file or none.
    ///
    /// # Errors
    /// [`Error::CannotWrite`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let mut channels = Vec::new();
        let mut add = |name: String, values: Vec<f32>| {
            channels.push(AnyChannel::new(name.as_str(), FlatSamples::F32(values)));
        };
        let layers = self.base.iter().zip(&self.scratches);
        for ([from, to], (base, scratches)) in self.bands_nm.iter().zip(layers) {
            let middle = format!("S0.{:.2}nm", 0.5 * (from + to)).replacen(".", "|", 1);
            let middle = middle.replace('.', ",").replace('|', ".");
            let both = base.iter().zip(scratches).map(|(a, b)| a + b);
            add(middle.clone(), both.collect());
            add(format!("base.{middle}"), base.clone());
            add(format!("scratches.{middle}"), scratches.clone());
        }
        let text = |name: &str, value: String| {
            let value = Text::from_bytes_unchecked(value.bytes().collect());
            (Text::new_or_panic(name), AttributeValue::Text(value))
        };
        let bands = self
            .bands_nm
            .iter()
            .map(|[from, to]| format!("{from}:{to}"));
        let attributes = vec![
            text("spectralLayoutVersion", "1.0".to_owned()),
            text("emissiveUnits", "W.m^-2.sr^-1".to_owned()),
            text("hairlineBandsNm", bands.collect::<Vec<_>>().join(" ")),
        ];
        let encoded = exr_file::encode::encode(self.size_px, channels, attributes);
        let bytes = encoded.map_err(|reason| Error::CannotWrite {
            path: path.to_owned(),
            reason,
        })?;
        output::write_atomically(path, &bytes)
    }
}
