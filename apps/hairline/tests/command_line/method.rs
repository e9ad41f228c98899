//! The flags that choose a method: refusals, and the picture's notes.

use crate::common::{SCRATCHED, folder_with, hairline, stderr_of};
use hairline_image::exr_file;

fn folder_with_scene() -> tempfile::TempDir {
    folder_with("scratched.toml", &SCRATCHED)
}

#[test]
fn contradictions_are_2_and_nothing_is_written() {
    let folder = folder_with_scene();
    for (flags, message) in [
        (
            "--si exact",
            "--si exact is a switch of the published method",
        ),
        ("--anti-aliasing off", "add --method published"),
        (
            "--method published --index triangles",
            "needs --anti-aliasing off",
        ),
        ("--method published --si none", "fast, exact"),
        ("--method 2018", "default, published"),
        ("--mask none", "energy, linear, density"),
        ("--gather clusters", "unexpected argument"),
        ("--light-at pixels", "unexpected argument"),
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
    for flags in [
        "",
        "--mask density",
        "--mask linear",
        "--method published --index triangles --anti-aliasing off --si exact",
    ] {
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
    for other in &pictures[1..] {
        assert_ne!(pictures[0].density, other.density);
    }
}

#[test]
fn a_key_without_effect_is_noted_once() {
    let wish = "[render]\ngather = \"clusters\"";
    let folder = folder_with("wish.toml", &SCRATCHED.replacen("[render]", wish, 1));
    let reference = "reference wish.toml -o out.exr --size 8x4 --spp 64";
    let render = "render wish.toml -o out.png --backend cpu --size 8x4";
    for arguments in [render, reference] {
        let text = stderr_of(&hairline(folder.path(), arguments).success());
        let notes: Vec<&str> = text.lines().filter(|l| l.starts_with("note: ")).collect();
        assert_eq!(notes.len(), 1, "{text}");
        assert!(notes[0].contains("wish.toml:") && notes[0].contains("render.gather"));
    }
}
