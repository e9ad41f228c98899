//! A Monte Carlo render reads back to the bit as it was written: a resumed run goes on from there.

use std::fs;
use std::path::Path;

use hairline_image::tone_map::linear_from_srgb;
use hairline_image::{
    Display, Error, Image, Layer, Layers, Noise, Notes, Output, Picture, Referred, exr_file, png,
};

fn noisy_image() -> Image {
    let mut image = Image::new([19, 11]);
    let mut noise = Noise::new(image.size_px, 64);
    for i in 0..image.pixel_count() {
        let x = i as f32;
        image.base[i] = [x, x / 3.0, -x];
        image.scratches[i] = [1e-30 * x, 0.1, 1e30];
        image.density[i] = [0.5; 3];
        image.depth_m[i] = 1.0 / (x + 1.0);
        // The smallest number that there is, and values that 16 bits would not hold.
        noise.beauty[i] = [f32::from_bits(1), x * 1e-12, 1.0 / 3.0];
        noise.base[i] = [x * x, 65_505.0, 1e-9];
        noise.scratches[i] = [0.0, 1.0 / (x + 7.0), 3e38];
        noise.density[i] = [x.sqrt(); 3];
        // Beyond what floating point counts exactly.
        noise.samples[i] = u32::MAX - i as u32;
    }
    image.noise = Some(noise);
    image
}

fn write(path: &Path, image: &Image, notes: &Notes) {
    Output::check(path)
        .unwrap()
        .write_image_with_notes(image, &Display::default(), notes)
        .unwrap();
}

/// Writes named channels of full precision, as other software might.
fn write_channels(path: &Path, size: (usize, usize), names: &[&str]) {
    use exr::prelude::*;
    let list: Vec<AnyChannel<FlatSamples>> = names
        .iter()
        .enumerate()
        .map(|(n, name)| {
            let samples = vec![n as f32 + 0.5; size.0 * size.1];
            AnyChannel::new(*name, FlatSamples::F32(samples))
        })
        .collect();
    let mut layer = exr::prelude::Layer::new(
        size,
        LayerAttributes::default(),
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(list.into()),
    );
    let text = |text: &str| attribute::AttributeValue::Text(Text::new_or_panic(text));
    let other = &mut layer.attributes.other;
    other.insert(Text::new_or_panic("renderer.seed"), text("9"));
    other.insert(
        Text::new_or_panic("hairline.count"),
        attribute::AttributeValue::I32(3),
    );
    other.insert(Text::new_or_panic("hairline."), text("nameless"));
    exr::prelude::Image::from_layer(layer)
        .write()
        .to_file(path)
        .unwrap();
}

#[test]
fn noise_reads_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let image = noisy_image();
    write(&path, &image, &Notes::new());
    let (read, notes) = exr_file::read_image_with_notes(&path).unwrap();
    assert!(notes.is_empty());
    let bits = |image: &Image, layer| -> Vec<[u32; 3]> {
        let variance = image.variance(layer).unwrap();
        variance.iter().map(|v| v.map(f32::to_bits)).collect()
    };
    for layer in [Layer::Beauty, Layer::Base, Layer::Scratches, Layer::Density] {
        assert_eq!(bits(&read, layer), bits(&image, layer), "{}", layer.name());
    }
    assert_eq!(read.variance(Layer::Depth), None);
    let (read, image) = (read.noise.unwrap(), image.noise.unwrap());
    assert_eq!((read.samples, read.batch), (image.samples, 64));
    // And a second time: nothing is lost on the way.
    let again = folder.path().join("b.exr");
    write(&again, &exr_file::read_image(&path).unwrap(), &Notes::new());
    assert_eq!(fs::read(&path).unwrap(), fs::read(&again).unwrap());
    // Without noise there are no channels for it.
    write(&again, &Image::new([4, 4]), &Notes::new());
    assert_eq!(exr_file::read_image(&again).unwrap().noise, None);
}

#[test]
fn a_variance_is_known_from_two_batches_on() {
    let mut noise = Noise::new([5, 1], 16);
    noise.samples = vec![0, 16, 31, 32, 100];
    let known: Vec<bool> = (0..5).map(|i| noise.is_known(i)).collect();
    assert_eq!(known, [false, false, false, true, true]);
    assert_eq!((noise.batches(2), noise.batches(4)), (1, 6));
    noise.batch = 0;
    assert!(!noise.is_known(4), "no batch, no variance");
}

#[test]
fn notes_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let mut notes = Notes::new();
    for (name, text) in [
        ("seed", "18446744073709551615"),
        ("scene", "Kratzer, 傷, émail: 5 µm\nsecond line"),
        ("empty", ""),
        ("a name that is longer than old readers take", "x"),
    ] {
        notes.insert(name.to_owned(), text.to_owned());
    }
    notes.insert("long".to_owned(), "0123456789".repeat(10_000));
    write(&path, &noisy_image(), &notes);
    assert_eq!(exr_file::read_image_with_notes(&path).unwrap().1, notes);
    assert_eq!(Layers::read(&path).unwrap().notes, notes);

    for name in ["", "zero\0byte", &"n".repeat(300)] {
        let notes = Notes::from([(name.to_owned(), "text".to_owned())]);
        let error = Output::check(&path)
            .unwrap()
            .write_image_with_notes(&noisy_image(), &Display::default(), &notes)
            .unwrap_err()
            .to_string();
        assert!(error.contains("a.exr") && error.contains("note"), "{error}");
    }

    // A PNG has no place for them, which is no error.
    write(&folder.path().join("a.png"), &Image::new([2, 2]), &notes);
}

#[test]
fn notes_of_other_software_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_channels(&path, (4, 4), &["R", "G", "B"]);
    let layers = Layers::read(&path).unwrap();
    assert!(!layers.notes.contains_key("renderer.seed"));
    assert!(!layers.notes.contains_key("count") && !layers.notes.contains_key("seed"));
}

#[test]
fn a_part_of_the_noise_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.exr");
    let layered = [
        "R",
        "G",
        "B",
        "base.R",
        "base.G",
        "base.B",
        "scratches.R",
        "scratches.G",
        "scratches.B",
        "density.R",
        "density.G",
        "density.B",
        "normal.X",
        "normal.Y",
        "normal.Z",
        "depth.Z",
    ];
    write_channels(&path, (4, 4), &layered);
    assert_eq!(exr_file::read_image(&path).unwrap().noise, None);
    let with_variance = [&layered[..], &["variance.R", "variance.G", "variance.B"]].concat();
    write_channels(&path, (4, 4), &with_variance);
    let error = exr_file::read_image(&path).unwrap_err().to_string();
    for part in ["part.exr", "variance.base.R", "samples"] {
        assert!(error.contains(part), "{error}");
    }
    assert!(!error.contains("channels variance.R"), "{error}");
    // A comparison takes what there is: a variance without a count of samples is taken at its word.
    let layers = Layers::read(&path).unwrap();
    assert_eq!(
        layers
            .get(Layer::Beauty)
            .unwrap()
            .variance
            .as_ref()
            .unwrap()
            .len(),
        16
    );
    assert_eq!(layers.get(Layer::Base).unwrap().variance, None);
    assert_eq!(layers.batches, None);
}

#[test]
fn layers_are_those_of_the_render() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let image = noisy_image();
    write(&path, &image, &Notes::new());
    let read = Layers::read(&path).unwrap();
    assert_eq!(read, Layers::from(&image));
    // All but alpha.
    assert_eq!(read.held.len(), Layer::ALL.len() - 1);
    assert_eq!(read.batches.as_ref().unwrap()[0], u32::MAX / 64);
    assert_eq!(read.referred, Referred::Scene);
    let estimate = read.estimate(Layer::Density).unwrap();
    assert_eq!(
        estimate.variance_at(9, 0),
        Some((3.0, f64::from(u32::MAX / 64 - 1)))
    );
}

#[test]
fn layers_of_odd_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let held = |name: &str| -> Vec<Layer> {
        let layers = Layers::read(&path(name)).unwrap();
        layers.held.iter().map(|held| held.layer).collect()
    };
    write_channels(&path("grey.exr"), (5, 3), &["Y"]);
    assert_eq!(held("grey.exr"), [Layer::Beauty]);
    write_channels(
        &path("scratches.exr"),
        (5, 3),
        &["scratches.R", "scratches.G", "scratches.B"],
    );
    assert_eq!(held("scratches.exr"), [Layer::Scratches]);
    // A layer without one of its channels is no layer.
    write_channels(
        &path("half.exr"),
        (5, 3),
        &["R", "G", "B", "base.R", "base.G", "depth.Z"],
    );
    assert_eq!(held("half.exr"), [Layer::Beauty, Layer::Depth]);

    write_channels(&path("strange.exr"), (5, 3), &["P", "Q"]);
    fs::write(path("text.png"), "no picture").unwrap();
    fs::write(path("cut.png"), b"\x89PNG\r\n\x1a\n").unwrap();
    fs::write(path("empty.exr"), "").unwrap();
    for (name, what) in [
        ("strange.exr", "R, G and B"),
        ("text.png", "neither an EXR nor a PNG"),
        ("cut.png", "not a PNG"),
        ("empty.exr", "neither"),
        ("none.exr", "there is no such file"),
    ] {
        let error = Layers::read(&path(name)).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(what), "{error}");
    }
    assert!(matches!(
        Layers::read(folder.path()),
        Err(Error::CannotRead { .. })
    ));
}

#[test]
fn png_of_8_and_16_bits() {
    let folder = tempfile::tempdir().unwrap();
    // The format is found by the contents, whatever the name.
    let path = folder.path().join("picture.exr");
    let codes: Vec<u16> = (0..12).map(|n| n * 5000).collect();
    let save = |picture: image::DynamicImage| {
        picture
            .save_with_format(&path, image::ImageFormat::Png)
            .unwrap();
        Layers::read(&path).unwrap()
    };
    let deep = image::ImageBuffer::<image::Rgb<u16>, _>::from_raw(2, 2, codes.clone()).unwrap();
    let layers = save(deep.into());
    assert_eq!(
        (layers.size_px, layers.referred),
        ([2, 2], Referred::Display)
    );
    let values = &layers.get(Layer::Beauty).unwrap().values;
    for (value, code) in values.iter().flatten().zip(&codes) {
        let linear = linear_from_srgb(f32::from(*code) / 65535.0);
        assert!((value - linear).abs() < 1e-6, "{value} {linear}");
    }
    let shallow = image::RgbImage::from_raw(1, 1, vec![0, 128, 255]).unwrap();
    let layers = save(shallow.into());
    let [black, middle, white] = layers.get(Layer::Beauty).unwrap().values[0];
    assert_eq!((black, white), (0.0, 1.0));
    assert!((middle - 0.215_86).abs() < 1e-5, "{middle}");
    // Grey is spread over three; what is transparent is black, and says so.
    let layers = save(
        image::GrayAlphaImage::from_raw(2, 1, vec![255, 0, 255, 255])
            .unwrap()
            .into(),
    );
    let seen = vec![[0.0; 3], [1.0; 3]];
    assert_eq!(layers.get(Layer::Beauty).unwrap().values, seen);
    assert_eq!(layers.get(Layer::Alpha).unwrap().values, seen);
    assert_eq!(
        png::read_picture(&path).unwrap(),
        Picture {
            size_px: [2, 1],
            rgb: seen
        }
    );
}
