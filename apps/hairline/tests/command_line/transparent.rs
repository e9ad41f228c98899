//! `render --transparent`: alpha against the share of white in the same picture before a white
//! background.

use std::fs::File;
use std::io::BufReader;

use crate::common::{folder_with, hairline};
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
    let map = Output::check(&folder.path().join("white.exr")).unwrap();
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
