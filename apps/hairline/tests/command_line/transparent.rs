//! `render --transparent`: alpha against the share of white in the same picture before a white
//! background.

use std::fs::File;
use std::io::BufReader;

use crate::common::{folder_with, hairline, stderr_of};
use hairline_image::{Display, Output, Picture, exr_file};
use image::DynamicImage;
use image::codecs::png::PngDecoder;
use tempfile::TempDir;

/// A disk across a nearer bar, in the light of a map of radiance 1 from everywhere.
const SCENE: &str = r#"
[camera]
position_m = [0.0, -0.3, 0.3]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 40.0
LENS
[render]
size_px = [48, 32]

[environment]
file = "white.exr"

[[material]]
name = "steel"
kind = "metal"
metal = "steel"
roughness = 0.3

[[object]]
name = "disk"
material = "steel"
shape = { disk = { radius_m = 0.07 } }

[[object]]
name = "bar"
material = "steel"
shape = { box = { size_m = [0.4, 0.01, 0.01] } }
translation_m = [0.0, -0.1, 0.15]
rotation_deg = [0.0, 20.0, 10.0]

[[scratches]]
object = "disk"
pattern = "random"
count = 200
"#;

/// A map of one colour takes no time to blur.
fn folder_in_white(scene: &str) -> TempDir {
    let folder = folder_with("scene.toml", scene);
    let white = Picture {
        size_px: [4, 2],
        rgb: vec![[1.0; 3]; 8],
    };
    let map = Output::check(folder.path().join("white.exr")).unwrap();
    map.write_picture(&white, &Display::default()).unwrap();
    folder
}

#[test]
fn alpha_is_what_hides_the_background() {
    let has_gpu = hairline_gpu::headless::test_gpu().is_some();
    for lens in ["", "aperture_mm = 25.0\nfocus_distance_m = 0.42\n"] {
        let folder = folder_in_white(&SCENE.replace("LENS", lens));
        for backend in ["cpu", "gpu"].into_iter().take(1 + usize::from(has_gpu)) {
            let render = |name: &str, flags: &str| {
                let own = format!(
                    "--shadows off --bounces 0 --samples 8 --filter off --backend {backend}"
                );
                hairline(
                    folder.path(),
                    &format!("render scene.toml -o {name} {own} {flags}"),
                )
                .success();
                exr_file::read_image(&folder.path().join(name)).unwrap()
            };
            let seen = render("seen.exr", "");
            let mut alone = render("alone.exr", "--transparent");
            assert_eq!(seen.alpha, None);
            let alpha = alone.alpha.take().unwrap();
            let mut edges = 0;
            let mut sum = 0.0;
            for (i, share) in alpha.iter().enumerate() {
                let hidden = seen.base[i][1] - alone.base[i][1];
                sum += (1.0 - share - hidden).abs();
                edges += usize::from(*share > 0.01 && *share < 0.99);
            }
            // A GPU's rays are less exact, and now and then one passes an edge on its other side.
            let most = if backend == "cpu" { 1e-5 } else { 1e-3 };
            let mean = sum / alpha.len() as f32;
            assert!(mean < most, "{backend} {lens}: {mean}");
            let least = if lens.is_empty() { 60 } else { 200 };
            assert!(edges > least, "{backend} {lens}: {edges} pixels of edges");
            // Before nothing colours are those of the surfaces: both have the same scratches.
            assert_eq!(alone.scratches, seen.scratches);
        }
    }
}

#[test]
fn pictures_and_animations_have_alpha() {
    let folder = folder_in_white(&SCENE.replace("LENS", ""));
    let render = "render scene.toml --transparent --backend cpu --samples 1";
    hairline(folder.path(), &format!("{render} -o a.png")).success();
    let arguments = format!("{render} -o a.apng --frames 2 --turntable 10");
    hairline(folder.path(), &arguments).success();
    let first = |name| {
        let file = BufReader::new(File::open(folder.path().join(name)).unwrap());
        let decoder = PngDecoder::new(file).unwrap();
        DynamicImage::from_decoder(decoder).unwrap().into_rgba8()
    };
    let picture = first("a.png");
    let shares = || picture.pixels().map(|pixel| pixel.0[3]);
    assert!(shares().any(|share| share == 0) && shares().any(|share| share == 255));
    assert_eq!(first("a.apng"), picture);
}

/// Seen from a metre above, on 60 pixels of 20 degrees, in the light of a sun from the left alone.
fn seen_from_above(more: &str) -> String {
    format!(
        "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\nfov_y_deg = 20\nworld_up = \"z\"\n\
         [[material]]\nname = \"steel\"\nkind = \"metal\"\nmetal = \"steel\"\n\
         [[light]]\nkind = \"sun\"\ndirection = [1, 0, -1]\nirradiance = 3\n{more}"
    )
}

/// Pixels of a metre on the ground.
fn px_of_m() -> f64 {
    30.0 / 10.0_f64.to_radians().tan()
}

fn area_px2(alpha: &[f32]) -> f64 {
    alpha.iter().copied().map(f64::from).sum()
}

#[test]
fn the_sum_of_alpha_is_the_area_of_a_disk() {
    let disk = "[render]\nsize_px = [60, 60]\ntransparent = true\n\
                [[object]]\nname = \"disk\"\nmaterial = \"steel\"\nshape = { disk = { radius_m = 0.05 } }\n";
    let folder = folder_with("s.toml", &seen_from_above(disk));
    hairline(
        folder.path(),
        "render s.toml -o a.exr --backend cpu --samples 64",
    )
    .success();
    let image = exr_file::read_image(&folder.path().join("a.exr")).unwrap();
    let area = area_px2(&image.alpha.unwrap());
    let right = std::f64::consts::PI * (0.05 * px_of_m()).powi(2);
    assert!((area / right - 1.0).abs() < 0.01, "{area} {right}");
}

/// A ball over the ground throws an ellipse aside: its middle is as far off as the ball is high.
const BALL: &str = "[[object]]\nname = \"ball\"\nmaterial = \"steel\"\ntranslation_m = [0, 0, 0.06]\n\
                    shape = { sphere = { radius_m = 0.02 } }\n";

#[test]
fn a_ground_that_catches_shadows_is_clear_where_it_is_lit() {
    let size = "[render]\nsize_px = [60, 60]\n";
    let by_keys = format!("{size}{BALL}[ground]\nheight_m = 0\nshadows_only = true\n");
    let folder = folder_with("s.toml", &seen_from_above(&by_keys));
    let by_flags = seen_from_above(&format!("{size}{BALL}[ground]\nheight_m = 0\n"));
    std::fs::write(folder.path().join("flags.toml"), by_flags).unwrap();
    let render = |arguments: &str| {
        let own = "--backend cpu --samples 16";
        hairline(folder.path(), &format!("render {arguments} {own}")).success();
    };
    render("s.toml -o a.exr");
    render("flags.toml --shadows-only -o b.exr");
    let read = |name: &str| exr_file::read_image(&folder.path().join(name)).unwrap();
    let image = read("a.exr");
    assert_eq!(read("b.exr"), image);
    let alpha = image.alpha.as_ref().unwrap();
    let at = |x: u32, y: u32| alpha[image.index(x, y)];
    // Far from the shadow, and in its middle.
    assert!(
        at(5, 5) < 1e-6 && at(50, 45) < 1e-6,
        "{} {}",
        at(5, 5),
        at(50, 45)
    );
    let middle = image.index((30.0 + 0.06 * px_of_m()) as u32, 30);
    // The filter of rays takes a little of what lies around.
    assert!(alpha[middle] > 0.97, "{}", alpha[middle]);
    assert_eq!(image.base[middle], [0.0; 3]);
    // The shadow of a ball from 45 degrees is longer by the root of two.
    let px = 0.02 * px_of_m();
    let areas = std::f64::consts::PI * px * px * (2.0_f64.sqrt() + 1.0 / 0.94_f64.powi(2));
    let area = area_px2(alpha);
    assert!((area / areas - 1.0).abs() < 0.03, "{area} {areas}");
    // Alpha of a picture is straight, that of a file of radiance is not: black stays black in both.
    render("s.toml -o a.png --png-bits 16");
    let file = BufReader::new(File::open(folder.path().join("a.png")).unwrap());
    let decoder = PngDecoder::new(file).unwrap();
    let picture = DynamicImage::from_decoder(decoder).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgba16);
    let picture = picture.into_rgba16();
    assert_eq!(picture.get_pixel(5, 5).0, [0; 4]);
    let [r, g, b, a] = picture.get_pixel(middle as u32 % 60, middle as u32 / 60).0;
    assert!([r, g, b] == [0; 3] && a > 63_500, "{a}");
}

#[test]
fn a_picture_behind_is_seen_beside_the_objects_and_through_shadows() {
    let scene = format!(
        "[render]\nsize_px = [60, 60]\nbehind = \"sky.png\"\n{BALL}[ground]\nheight_m = 0\nshadows_only = true\n"
    );
    let folder = folder_with("s.toml", &seen_from_above(&scene));
    let render = "render s.toml -o a.png --backend cpu --samples 16";
    let missing = hairline(folder.path(), render).code(2);
    let message = stderr_of(&missing);
    assert!(message.contains("s.toml:16: render.behind"), "{message}");
    let mut sky = image::RgbImage::new(30, 30);
    sky.pixels_mut().for_each(|pixel| pixel.0 = [40, 120, 200]);
    sky.save(folder.path().join("sky.png")).unwrap();
    hairline(folder.path(), render).success();
    let picture = image::open(folder.path().join("a.png")).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgb8);
    let picture = picture.into_rgb8();
    let off = |at: [u8; 3]| (0..3).all(|c| at[c].abs_diff([40, 120, 200][c]) <= 1);
    assert!(
        off(picture.get_pixel(5, 5).0),
        "{:?}",
        picture.get_pixel(5, 5)
    );
    let middle = (30.0 + 0.06 * px_of_m()) as u32;
    assert!(
        picture
            .get_pixel(middle, 30)
            .0
            .iter()
            .all(|code| *code < 30)
    );
    // A file of radiance keeps the alpha in its place.
    hairline(
        folder.path(),
        "render s.toml -o a.exr --backend cpu --samples 16",
    )
    .success();
    let image = exr_file::read_image(&folder.path().join("a.exr")).unwrap();
    assert!(image.alpha.is_some());
}

#[test]
fn what_flags_of_a_cutout_do_not_do_is_told() {
    let scene = format!("[render]\nsize_px = [16, 16]\n{BALL}");
    let folder = folder_with("s.toml", &seen_from_above(&scene));
    let render = |flags: &str| {
        let arguments = format!("render s.toml --backend cpu --samples 1 {flags}");
        hairline(folder.path(), &arguments)
    };
    let refused = |flags: &str| stderr_of(&render(flags).code(2));
    let message = refused("--shadows-only --shadows off");
    assert!(
        message.contains("--shadows-only: nothing is left"),
        "{message}"
    );
    let message = refused("--behind no.png");
    assert!(
        message.contains("error: --behind no.png: ")
            && message.contains("relative to the current folder"),
        "{message}"
    );
    let sky = image::RgbImage::new(4, 4);
    sky.save(folder.path().join("sky.png")).unwrap();
    let told = |flags: &str| stderr_of(&render(flags).success());
    let message = told("--behind sky.png -o a.exr");
    assert!(message.contains("note: a.exr: an .exr has"), "{message}");
    let message = told("--png-bits 16 --frames 2 --turntable 9 -o a.apng");
    assert!(
        message.contains("note: a.apng: animations have 8"),
        "{message}"
    );
}
