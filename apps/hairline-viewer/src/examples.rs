//! The examples in the menu File: the scenes of this repository, with what they name and a sheet of small pictures.
//!
//! The pictures are those of `docs/pictures`. The test below says when the sheet is out of date, and
//! `HAIRLINE_WRITE=1 cargo test --release -p hairline-viewer --bin hairline-viewer sheet` makes it anew.

use hairline_viewer::examples::{Example, Examples};

macro_rules! scenes {
    ($($name:literal)*) => {
        &[$(Example {
            name: $name,
            text: include_str!(concat!("../../../scenes/", $name, ".toml")),
        }),*]
    };
}

macro_rules! files {
    ($($name:literal)*) => {
        &[$((
            $name,
            include_bytes!(concat!("../../../scenes/", $name)) as &[u8],
        )),*]
    };
}

pub(crate) static EXAMPLES: Examples = Examples {
    scenes: scenes! {
        "baubles" "bokeh" "bonnet" "brushed" "caseback" "closeup" "disc" "drawn" "dvd" "engraved" "groove" "knife" "knob"
        "lamps" "lid" "lighter" "lights" "mirror" "movement" "pan" "phone" "plate" "record" "rings"
        "seal" "spoon" "sundial" "sunlit"
    },
    files: files! {
        "maps/around_diamonds.png"
        "maps/between_petals.png"
        "maps/diamonds.png"
        "maps/evening.hdr"
        "maps/petal_directions.png"
        "maps/petals.png"
        "maps/soft_box.png"
        "models/knife.glb"
        "models/spoon.glb"
    },
    sheet: include_bytes!("../assets/examples.jpg"),
};

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::{Path, PathBuf};

    use hairline_document::Description;
    use hairline_viewer::examples::{COLUMNS, PICTURE_PX};
    use image::imageops::FilterType;
    use image::{RgbImage, imageops};

    use super::*;

    const HINT: &str = "out of date: HAIRLINE_WRITE=1 cargo test --release -p hairline-viewer --bin hairline-viewer sheet";

    fn root() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
    }

    /// The sheet that the pictures of the documents make.
    fn sheet() -> RgbImage {
        let [width, height] = PICTURE_PX;
        let rows = (EXAMPLES.scenes.len() as u32).div_ceil(COLUMNS);
        let mut sheet = RgbImage::new(COLUMNS * width, rows * height);
        for (i, example) in (0..).zip(EXAMPLES.scenes) {
            let picture = root().join(format!("docs/pictures/{}.png", example.name));
            let picture = image::open(&picture).unwrap();
            let small = picture.resize_to_fill(width, height, FilterType::Triangle);
            let [x, y] = [i % COLUMNS * width, i / COLUMNS * height];
            imageops::replace(&mut sheet, &small.to_rgb8(), x.into(), y.into());
        }
        sheet
    }

    #[test]
    fn the_sheet_has_the_pictures_of_the_documents() {
        let made = sheet();
        if std::env::var_os("HAIRLINE_WRITE").is_some() {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/examples.jpg");
            let file = std::fs::File::create(path).unwrap();
            let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(file, 85);
            made.write_with_encoder(encoder).unwrap();
            return;
        }
        let there = image::load_from_memory(EXAMPLES.sheet).unwrap().to_rgb8();
        assert_eq!(there.dimensions(), made.dimensions(), "{HINT}");
        let off = std::iter::zip(there.as_raw(), made.as_raw());
        let sum: u64 = off.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        let mean = sum as f64 / made.as_raw().len() as f64;
        assert!(mean < 4.0, "{mean} codes off: {HINT}");
    }

    #[test]
    fn all_scenes_with_a_picture_are_examples_and_all_that_they_name_is_there() {
        let mut named = BTreeSet::new();
        for example in EXAMPLES.scenes {
            let read = Description::from_toml(example.text, Path::new(example.name)).unwrap();
            let files = read.files().into_iter();
            named.extend(files.map(|(_, file)| file.to_str().unwrap().to_owned()));
        }
        let there = EXAMPLES.files.iter().map(|(name, _)| (*name).to_owned());
        assert_eq!(named, there.collect());
        let scenes = std::fs::read_dir(root().join("scenes")).unwrap();
        let scenes = scenes.filter(|entry| {
            let path = entry.as_ref().unwrap().path();
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            let picture = root().join(format!("docs/pictures/{name}.png"));
            path.extension().is_some_and(|ending| ending == "toml") && picture.exists()
        });
        assert_eq!(EXAMPLES.scenes.len(), scenes.count());
    }
}
