//! Files: written files read back, and files that cannot be written leave nothing behind.

use std::fs;
use std::io::Write;
use std::path::Path;

use hairline_image::{Display, Error, Format, Image, Output, Picture, exr_file, output, png};

/// Values that a careless conversion would lose: negative, tiny, huge, infinite, with all mantissa bits in use.
fn awkward_image() -> Image {
    let mut image = Image::new([37, 23]);
    let values = [
        0.0,
        -0.0,
        1.0 / 3.0,
        -12.345_678,
        1e-40,
        f32::MIN_POSITIVE,
        65_504.0,
        3.0e38,
        f32::INFINITY,
        std::f32::consts::PI,
    ];
    let value = |n: usize| values[n % values.len()] * (1.0 + (n / values.len()) as f32);
    for i in 0..image.pixel_count() {
        image.base[i] = std::array::from_fn(|c| value(3 * i + c));
        image.scratches[i] = std::array::from_fn(|c| value(5 * i + c + 1));
        image.density[i] = std::array::from_fn(|c| value(7 * i + c + 2));
        image.normal[i] = std::array::from_fn(|c| value(11 * i + c + 3));
        image.depth_m[i] = value(13 * i);
    }
    image
}

fn bits(values: &[[f32; 3]]) -> Vec<[u32; 3]> {
    values.iter().map(|v| v.map(f32::to_bits)).collect()
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn exr_layers_read_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let image = awkward_image();
    Output::check(&path)
        .unwrap()
        .write_image(&image, &Display::default())
        .unwrap();
    let read = exr_file::read_image(&path).unwrap();
    assert_eq!(read.size_px, image.size_px);
    assert_eq!(bits(&read.base), bits(&image.base));
    assert_eq!(bits(&read.scratches), bits(&image.scratches));
    assert_eq!(bits(&read.density), bits(&image.density));
    assert_eq!(bits(&read.normal), bits(&image.normal));
    let depth_bits =
        |image: &Image| -> Vec<u32> { image.depth_m.iter().map(|z| z.to_bits()).collect() };
    assert_eq!(depth_bits(&read), depth_bits(&image));
    let beauty = exr_file::read_picture(&path).unwrap();
    for ((got, base), scratches) in beauty.rgb.iter().zip(&image.base).zip(&image.scratches) {
        for c in 0..3 {
            let sum = base[c] + scratches[c];
            assert!(got[c].to_bits() == sum.to_bits() || (got[c].is_nan() && sum.is_nan()));
        }
    }
}

#[test]
fn exr_names_its_channels_and_primaries() {
    use exr::prelude::{ReadChannels, ReadLayers};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.EXR");
    Output::check(&path)
        .unwrap()
        .write_image(&Image::new([4, 3]), &Display::default())
        .unwrap();
    let file = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(&path)
        .unwrap();
    let names: Vec<String> = file
        .layer_data
        .channel_data
        .list
        .iter()
        .map(|c| c.name.to_string())
        .collect();
    assert_eq!(
        names,
        [
            "B",
            "G",
            "R",
            "base.B",
            "base.G",
            "base.R",
            "density.B",
            "density.G",
            "density.R",
            "depth.Z",
            "normal.X",
            "normal.Y",
            "normal.Z",
            "scratches.B",
            "scratches.G",
            "scratches.R"
        ]
    );
    let primaries = file.attributes.chromaticities.unwrap();
    assert_eq!(primaries.white, exr::math::Vec2(0.3127, 0.3290));
}

#[test]
fn pictures_of_other_programs_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("half.exr");
    exr::prelude::write_rgba_file(&path, 5, 4, |x, y| {
        (
            exr::prelude::f16::from_f32(x as f32),
            exr::prelude::f16::from_f32(y as f32),
            exr::prelude::f16::from_f32(0.5),
            exr::prelude::f16::from_f32(1.0),
        )
    })
    .unwrap();
    let picture = exr_file::read_picture(&path).unwrap();
    assert_eq!(picture.size_px, [5, 4]);
    assert_eq!(picture.pixel(3, 2), [3.0, 2.0, 0.5]);
    let error = exr_file::read_image(&path).unwrap_err().to_string();
    assert!(
        error.contains("base.R") && error.contains("half.exr"),
        "{error}"
    );
}

#[test]
fn damaged_exr_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole.exr");
    Output::check(&path)
        .unwrap()
        .write_image(&awkward_image(), &Display::default())
        .unwrap();
    let whole = fs::read(&path).unwrap();
    let damaged = folder.path().join("damaged.exr");
    for cut in [0, 3, 8, 100, 700, whole.len() / 2, whole.len() - 1] {
        fs::write(&damaged, &whole[..cut]).unwrap();
        let error = exr_file::read_picture(&damaged).unwrap_err().to_string();
        assert!(error.contains("damaged.exr"), "{error}");
    }
    // A wrong byte anywhere is either noticed or lands in the pixels, but never ends the program.
    for at in (0..whole.len()).step_by(97) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0xff;
        fs::write(&damaged, &bytes).unwrap();
        let _ = exr_file::read_picture(&damaged);
    }
    fs::write(&damaged, b"no picture at all").unwrap();
    assert!(matches!(
        exr_file::read_picture(&damaged),
        Err(Error::Unusable { .. })
    ));
    let error = exr_file::read_picture(folder.path().join("none.exr")).unwrap_err();
    assert!(
        error.to_string().contains("there is no such file"),
        "{error}"
    );
}

#[test]
fn png_holds_the_displayed_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let mut picture = Picture::new([16, 8]);
    for (i, rgb) in picture.rgb.iter_mut().enumerate() {
        *rgb = [i as f32 / 127.0, 0.5, 0.0];
    }
    let display = Display {
        exposure_ev: 0.0,
        tone_map: hairline_image::ToneMap::None,
    };
    Output::check(&path)
        .unwrap()
        .write_picture(&picture, &display)
        .unwrap();
    let read = png::read_picture(&path).unwrap();
    assert_eq!(read.size_px, picture.size_px);
    for (a, b) in read.rgb.iter().zip(&picture.rgb) {
        for c in 0..3 {
            // One code, half from rounding and half from the dither, is at most 0.009 in linear terms.
            assert!((a[c] - b[c]).abs() < 0.009, "{a:?} {b:?}");
        }
        assert_eq!(a[2], 0.0, "black stays black under the dither");
    }
    let mut brighter = display;
    brighter.exposure_ev = 1.0;
    assert_eq!(
        brighter.apply([0.25; 3]),
        display.apply([0.5; 3]),
        "one stop is a factor of two"
    );
}

#[test]
fn endings_choose_the_format() {
    assert_eq!(
        Format::from_ending(Path::new("a/b.PNG")).unwrap(),
        Format::Png
    );
    assert_eq!(
        Format::from_ending(Path::new("b.exr")).unwrap(),
        Format::Exr
    );
    for name in ["picture", "a.jpg", ".png", "a.exr.gz", ""] {
        let error = Format::from_ending(Path::new(name))
            .unwrap_err()
            .to_string();
        assert!(error.contains(".png") && error.contains(".exr"), "{error}");
    }
}

#[test]
fn unwritable_outputs_are_named_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("folder.png")).unwrap();
    fs::write(folder.path().join("file"), b"").unwrap();
    let before = names_in(folder.path());
    for (name, reason) in [
        ("missing/a.png", "no folder"),
        ("folder.png", "it is a folder"),
        ("file/a.png", "a file where a folder is needed"),
    ] {
        let error = Output::check(folder.path().join(name))
            .unwrap_err()
            .to_string();
        assert!(error.contains(name) && error.contains(reason), "{error}");
    }
    assert_eq!(names_in(folder.path()), before);
}

#[cfg(unix)]
#[test]
fn special_files_are_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("null.png");
    std::os::unix::fs::symlink("/dev/null", &link).unwrap();
    let error = Output::check(&link).unwrap_err().to_string();
    assert!(error.contains("not a regular file"), "{error}");
}

#[cfg(unix)]
#[test]
fn links_stay_links() {
    let folder = tempfile::tempdir().unwrap();
    let (target, link) = (
        folder.path().join("target.png"),
        folder.path().join("link.png"),
    );
    fs::write(&target, b"old").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    output::write_atomically(&link, b"new").unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"new");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
}

#[cfg(unix)]
#[test]
fn a_read_only_file_is_respected() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.png");
    fs::write(&path, b"old").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    if fs::OpenOptions::new().write(true).open(&path).is_ok() {
        let line = "skipped: a_read_only_file_is_respected: this user may write read-only files\n";
        // Not eprintln: the test harness hides what it prints unless the test fails.
        let _ = std::io::stderr().write_all(line.as_bytes());
        return;
    }
    let error = Output::check(&path).unwrap_err().to_string();
    assert!(error.contains("permission denied"), "{error}");
    assert!(output::write_atomically(&path, b"new").is_err());
    assert_eq!(fs::read(&path).unwrap(), b"old");
}

#[test]
fn checking_and_writing_leave_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let output = Output::check(&path).unwrap();
    assert_eq!(names_in(folder.path()), [""; 0], "a check leaves nothing");
    output
        .write_picture(&Picture::new([2, 2]), &Display::default())
        .unwrap();
    output
        .write_picture(&Picture::new([3, 3]), &Display::default())
        .unwrap();
    assert_eq!(names_in(folder.path()), ["a.png"]);
    assert_eq!(png::read_picture(&path).unwrap().size_px, [3, 3]);
}

#[cfg(unix)]
#[test]
fn new_files_have_ordinary_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let ordinary = folder.path().join("ordinary");
    fs::write(&ordinary, b"").unwrap();
    let path = folder.path().join("a.png");
    output::write_atomically(&path, b"").unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&ordinary));
}
