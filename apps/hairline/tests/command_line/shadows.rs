//! `render --shadows on`: what is refused, and that it reaches the picture.

use crate::common::{folder_with, hairline, stderr_of};
use hairline_image::exr_file;

/// A disk under a lamp, and a smaller disk between them.
const SCREENED: &str = r#"
[camera]
position_m = [0.0, -0.3, 0.3]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 20.0

[render]
size_px = [32, 24]

[[material]]
name = "steel"
kind = "metal"
metal = "steel"
roughness = 0.4

[[object]]
name = "table"
material = "steel"
shape = { disk = { radius_m = 0.1 } }

[[object]]
name = "screen"
material = "steel"
shape = { disk = { radius_m = 0.02 } }
translation_m = [0.0, 0.1, 0.1]

[[light]]
kind = "sphere"
center_m = [0.0, 0.3, 0.3]
radius_m = 0.01
radiance = 50.0
"#;

#[test]
fn what_has_no_shadows_refuses_them() {
    let folder = folder_with("screened.toml", SCREENED);
    let arguments = "render screened.toml -o out.exr --shadows on --method published";
    let text = stderr_of(&hairline(folder.path(), arguments).code(2));
    let message = "the published method has no shadows";
    assert!(text.contains(message), "{text}");
    assert!(!folder.path().join("out.exr").exists());
}

#[test]
fn bounces_ask_for_shadows() {
    let folder = folder_with("screened.toml", SCREENED);
    let arguments = "render screened.toml -o out.exr --bounces 1";
    let text = stderr_of(&hairline(folder.path(), arguments).code(2));
    assert!(text.contains("add --shadows on"), "{text}");
    assert!(!folder.path().join("out.exr").exists());
}

#[test]
fn the_screen_lights_the_table_from_below() {
    let folder = folder_with("screened.toml", SCREENED);
    let file = folder.path().join("out.exr");
    let is_there = hairline_gpu::headless::test_gpu().is_some();
    for backend in ["cpu", "gpu"].into_iter().take(1 + usize::from(is_there)) {
        // From the table to the screen's dark side, and from there to the lit table.
        let lit = [0, 2].map(|bounces| {
            let flags =
                format!("--shadows on --samples 64 --bounces {bounces} --backend {backend}");
            hairline(
                folder.path(),
                &format!("render screened.toml -o out.exr {flags}"),
            )
            .success();
            let (image, notes) = exr_file::read_image_with_notes(&file).unwrap();
            assert_eq!(
                notes.get("bounces").map(String::as_str),
                (bounces > 0).then_some("2")
            );
            image.base.iter().map(|p| f64::from(p[1])).sum::<f64>()
        });
        // The same rays otherwise: no noise.
        assert!(lit[1] > lit[0], "{backend}: {lit:?}");
    }
}

#[test]
fn shadows_darken_the_middle_and_are_noted() {
    let folder = folder_with("screened.toml", SCREENED);
    let file = folder.path().join("out.exr");
    // The GPU's where there is a driver.
    let is_there = hairline_gpu::headless::test_gpu().is_some();
    for backend in ["cpu", "gpu"].into_iter().take(1 + usize::from(is_there)) {
        let mut middle = Vec::new();
        for (switch, note) in [("off", None), ("on", Some("on"))] {
            let arguments =
                format!("render screened.toml -o out.exr --shadows {switch} --backend {backend}");
            hairline(folder.path(), &arguments).success();
            let (image, notes) = exr_file::read_image_with_notes(&file).unwrap();
            assert_eq!(notes.get("shadows").map(String::as_str), note);
            middle.push(image.base[image.index(16, 12)][1]);
        }
        assert!(
            middle[0] > 0.0 && middle[1] < 0.1 * middle[0],
            "{backend}: {middle:?}"
        );
    }
}
