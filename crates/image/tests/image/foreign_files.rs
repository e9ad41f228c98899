//! EXR files of other software: pixels that are a part of a larger picture, and colours of other primaries.

use exr::prelude::*;
use hairline_image::metrics::compare;
use hairline_image::{Display, Layers, exr_file};
use std::path::Path;

/// A file of named channels with one value each, whose pixels lie in a window of a picture.
struct File<'a> {
    size: (usize, usize),
    at: (i32, i32),
    picture: ((i32, i32), (usize, usize)),
    channels: &'a [(&'a str, f32)],
    primaries: Option<[f32; 8]>,
}

impl File<'_> {
    fn write(&self, path: &Path) {
        let pixels = self.size.0 * self.size.1;
        let channel = |(name, value): &(&str, f32)| {
            AnyChannel::new(*name, FlatSamples::F32(vec![*value; pixels]))
        };
        let channels: Vec<_> = self.channels.iter().map(channel).collect();
        let mut layer = Layer::new(
            self.size,
            LayerAttributes::default(),
            Encoding::FAST_LOSSLESS,
            AnyChannels::sort(channels.into()),
        );
        layer.attributes.layer_position = self.at.into();
        let mut file = exr::prelude::Image::from_layer(layer);
        file.attributes.display_window = IntegerBounds::new(self.picture.0, self.picture.1);
        file.attributes.chromaticities = self.primaries.map(|xy| {
            let [red, green, blue, white] = [0, 2, 4, 6].map(|i| Vec2(xy[i], xy[i + 1]));
            attribute::Chromaticities {
                red,
                green,
                blue,
                white,
            }
        });
        file.write().to_file(path).unwrap();
    }
}

const RGB: [(&str, f32); 3] = [("R", 1.0), ("G", 2.0), ("B", 4.0)];

/// The picture is black where the file has no pixels; pixels outside the picture are not seen.
#[test]
fn pixels_lie_in_the_picture_where_the_file_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.exr");
    for (at, size, corner, seen) in [
        // Within it; from another corner; all of it and more; beyond two of its edges.
        ((1, 1), (2, 1), (0, 0), [(1, 1), (2, 1)].as_slice()),
        ((11, 21), (2, 1), (10, 20), &[(1, 1), (2, 1)]),
        ((-1, 2), (2, 3), (0, 0), &[(0, 2)]),
        ((3, -5), (4, 6), (0, 0), &[(3, 0)]),
        ((9, 9), (2, 2), (0, 0), &[]),
    ] {
        let file = File {
            size,
            at,
            picture: (corner, (4, 3)),
            channels: &RGB,
            primaries: None,
        };
        file.write(&path);
        assert_eq!(exr_file::size_px(&path).unwrap(), [4, 3]);
        assert!(!exr_file::window(&path).unwrap().is_whole());
        let picture = exr_file::read_picture(&path).unwrap();
        assert_eq!(picture.size_px, [4, 3]);
        for (i, rgb) in picture.rgb.iter().enumerate() {
            let is_there = seen.contains(&(i % 4, i / 4));
            let expected = if is_there { [1.0, 2.0, 4.0] } else { [0.0; 3] };
            assert_eq!(*rgb, expected, "{at:?}: {i}");
        }
    }
    let whole = File {
        size: (4, 3),
        at: (0, 0),
        picture: ((0, 0), (4, 3)),
        channels: &RGB,
        primaries: None,
    };
    whole.write(&path);
    assert!(exr_file::window(&path).unwrap().is_whole());
}

/// Files of programs that name every layer. Of several the one that is the whole picture is taken, else the first.
#[test]
fn colours_of_layers_are_read_where_there_are_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("layers.exr");
    for (layers, expected) in [
        (&[("", "rgb", 1.0)][..], Some(1.0)),
        (&[("diffuse.", "RGB", 1.0)], Some(1.0)),
        (
            &[
                ("View Layer.AO.", "RGB", 1.0),
                ("View Layer.Combined.", "RGB", 2.0),
            ],
            Some(2.0),
        ),
        (
            &[("Crypto00.", "rgb", 1.0), ("rgba.", "RGB", 2.0)],
            Some(2.0),
        ),
        (&[("a.", "RGB", 1.0), ("", "RGB", 2.0)], Some(2.0)),
        (&[("CryptoObject00.", "RGB", 1.0)], None),
        (&[("a.", "RG", 1.0), ("b.", "B", 1.0)], None),
        (&[("BA", "RGB", 1.0)], None),
    ] {
        let channel = |(layer, letters, value): &(&str, &str, f32)| {
            let names = letters.chars().map(|letter| format!("{layer}{letter}"));
            names.map(|name| (name, *value)).collect::<Vec<_>>()
        };
        let channels: Vec<_> = layers.iter().flat_map(channel).collect();
        let channels: Vec<_> = channels
            .iter()
            .map(|(name, value)| (name.as_str(), *value))
            .collect();
        let file = File {
            size: (2, 1),
            at: (0, 0),
            picture: ((0, 0), (2, 1)),
            channels: &channels,
            primaries: None,
        };
        file.write(&path);
        let rgb = exr_file::read_picture(&path).ok().map(|it| it.rgb);
        assert_eq!(rgb, expected.map(|it| vec![[it; 3]; 2]), "{layers:?}");
    }
}

/// Equal pixels in two places of a picture are not equal pictures.
#[test]
fn a_comparison_sees_where_pixels_lie() {
    let folder = tempfile::tempdir().unwrap();
    let layers = |at: (i32, i32)| {
        let path = folder.path().join("part.exr");
        let file = File {
            size: (16, 16),
            at,
            picture: ((0, 0), (32, 32)),
            channels: &RGB,
            primaries: None,
        };
        file.write(&path);
        Layers::read(&path).unwrap()
    };
    let (a, b) = (layers((0, 0)), layers((16, 0)));
    assert_eq!(
        a.window.unwrap().to_string(),
        "its pixels are 16 x 16 from column 0 and row 0 on, of a picture of 32 x 32; the rest of that is black"
    );
    let wide = exr_file::Window {
        at_px: [-2, 0],
        size_px: [40, 32],
        of_px: [32, 32],
    };
    assert_eq!(
        wide.to_string(),
        "its pixels are 40 x 32 from column -2 and row 0 on, of a picture of 32 x 32; what is outside of that is not seen"
    );
    let comparison = compare(&a, &b, &Display::default(), None);
    // Half of all pixels have the colour in one of both.
    let expected = (0.5 * (1.0 + 4.0 + 16.0) / 3.0_f64).sqrt();
    let rms = comparison.layers[0].difference.rms;
    assert!((rms / expected - 1.0).abs() < 1e-6, "{rms}");
}

/// A few chunks of so many pixels would take gigabytes.
#[test]
fn more_pixels_than_a_picture_can_have_are_refused_before_they_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("window.exr");
    let mut layer = Layer::new(
        (16, 16),
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(
            RGB.map(|(name, value)| AnyChannel::new(name, FlatSamples::F32(vec![value; 256])))
                .into_iter()
                .collect(),
        ),
    );
    layer.encoding.blocks = Blocks::ScanLines;
    let file = exr::prelude::Image::from_layer(layer);
    file.write().to_file(&path).unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    let name = b"dataWindow\0box2i\0";
    let at = bytes
        .windows(name.len())
        .position(|part| part == name)
        .unwrap();
    // The first column; the size of the value comes before its four numbers.
    let first = at + name.len() + 4;
    bytes[first..first + 4].copy_from_slice(&(-1_000_000_000_i32).to_le_bytes());
    std::fs::write(&path, bytes).unwrap();
    let error = Layers::read(&path).unwrap_err().to_string();
    assert!(error.contains("1000000016 x 16 pixels"), "{error}");
}

/// Colours are converted by the matrices of ITU-R BT.2087 and IEC 61966-2-1.
#[test]
fn colours_of_other_primaries_are_told_in_rec_709() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("colour.exr");
    let rec_2020 = [0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290];
    let rec_709 = [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290];
    let xyz = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0];
    let named = |names: [&'static str; 3], values: [f32; 3]| {
        [0, 1, 2].map(|i| (names[i], values[i])).to_vec()
    };
    let rgb = |values| named(["R", "G", "B"], values);
    for (channels, primaries, expected) in [
        (rgb([0.5, 0.4, 0.3]), Some(rec_709), [0.5, 0.4, 0.3]),
        (rgb([0.5, 0.4, 0.3]), None, [0.5, 0.4, 0.3]),
        (
            rgb([0.5, 0.4, 0.3]),
            Some(rec_2020),
            [0.5734, 0.3884, 0.2863],
        ),
        // Grey stays grey.
        (rgb([0.5; 3]), Some(rec_2020), [0.5; 3]),
        // White of D65, and a red.
        (rgb([0.9505, 1.0, 1.0891]), Some(xyz), [1.0; 3]),
        (
            named(["X", "Y", "Z"], [0.9505, 1.0, 1.0891]),
            None,
            [1.0; 3],
        ),
        (
            named(["X", "Y", "Z"], [0.4124, 0.2126, 0.0193]),
            None,
            [1.0, 0.0, 0.0],
        ),
    ] {
        let file = File {
            size: (2, 1),
            at: (0, 0),
            picture: ((0, 0), (2, 1)),
            channels: &channels,
            primaries,
        };
        file.write(&path);
        let layers = Layers::read(&path).unwrap();
        for values in [
            exr_file::read_picture(&path).unwrap().rgb,
            layers.held[0].values.clone(),
        ] {
            for (got, expected) in values[0].iter().zip(expected) {
                assert!((got - expected).abs() < 1e-3, "{channels:?}: {values:?}");
            }
        }
    }
}
