//! The flags that choose a method: what is refused, and what the picture remembers.

mod common;

use common::{SCRATCHED, folder_with, hairline, stderr_of};
use hairline_image::exr_file;

fn folder_with_scene() -> tempfile::TempDir {
    folder_with("scratched.toml", SCRATCHED)
}

#[test]
fn contradictions_are_2_and_nothing_is_written() {
    let folder = folder_with_scene();
    for (flags, message) in [
        ("--wavelengths 8", "--spectrum si-fast or si-exact"),
        ("--wavelengths 7 --spectrum si-fast", "3, 8, 16"),
        ("--index triangles", "needs --footprint off"),
        (
            "--method published --index triangles",
            "needs --footprint off",
        ),
        ("--method 2018", "default, published"),
        ("--spectrum si", "table, si-fast, si-exact"),
        ("--mask none", "energy, linear, density"),
        ("--method published --gather clusters", "default method"),
    ] {
        let arguments = format!("render scratched.toml -o out.exr {flags}");
        let assert = hairline(folder.path(), &arguments).code(2);
        let text = stderr_of(&assert);
        assert!(text.contains(message), "{flags}: {text}");
        assert!(!folder.path().join("out.exr").exists(), "{flags}");
    }
}

#[test]
fn a_picture_remembers_another_method_than_the_default() {
    let folder = folder_with_scene();
    let mut pictures = Vec::new();
    for flags in ["", "--mask density", "--mask linear", "--gather clusters"] {
        let arguments = format!(
            "render scratched.toml -o out.exr --backend cpu --size 32x18 --samples 1 {flags}"
        );
        hairline(folder.path(), &arguments).success();
        let file = folder.path().join("out.exr");
        let (image, notes) = exr_file::read_image_with_notes(&file).unwrap();
        let noted = notes.get("method").map_or("", String::as_str);
        assert_eq!(noted, flags);
        pictures.push(image);
    }
    // The flag reached the renderer.
    assert_ne!(pictures[0].density, pictures[1].density);
    assert_ne!(pictures[0].density, pictures[2].density);
}

#[test]
fn a_scene_says_whether_scratches_are_taken_together_and_a_flag_says_otherwise() {
    let wish = "[render]\ngather = \"clusters\"";
    let folder = folder_with("wish.toml", &SCRATCHED.replacen("[render]", wish, 1));
    for (flags, right) in [
        ("", "--gather clusters"),
        ("--gather clusters", "--gather clusters"),
        ("--gather exact", ""),
        ("--mask density", "--mask density --gather clusters"),
        // Which knows no clusters, and need not be told so.
        ("--method published", "--method published"),
        ("--footprint published", "--footprint published"),
    ] {
        let arguments =
            format!("render wish.toml -o out.exr --backend cpu --size 8x4 --samples 1 {flags}");
        hairline(folder.path(), &arguments).success();
        let (_, notes) = exr_file::read_image_with_notes(&folder.path().join("out.exr")).unwrap();
        let noted = notes.get("method").map_or("", String::as_str);
        assert_eq!(noted, right, "{flags}");
    }
}
