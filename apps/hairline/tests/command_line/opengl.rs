//! Pictures over OpenGL, for systems without a newer interface. Each is rendered by a process of its own, since a context
//! serves one thread.

use std::path::Path;

use crate::common::{SCRATCHED, command, folder_with, hairline};
use assert_cmd::Command;
use hairline_image::metrics::layer_difference;
use hairline_image::{Layer, exr_file};

/// A command that can use no interface but OpenGL.
fn by_opengl(folder: &Path, arguments: &str) -> Command {
    let mut command = command(folder, arguments);
    command.env("WGPU_BACKEND", "gl");
    command
}

/// The scene has one metal and no texture: arrays of one layer are the special case there.
#[test]
#[ignore = "long: cargo long"]
fn a_picture_is_that_of_the_cpu() {
    // Under the lamp alone, whose shaders are compiled in half the time.
    let lamp_ends = SCRATCHED.rfind("[[light]]").unwrap();
    let folder = folder_with("scratched.toml", &SCRATCHED[..lamp_ends]);
    let info = by_opengl(folder.path(), "info").output().unwrap();
    if !String::from_utf8_lossy(&info.stdout).contains("can render") {
        eprintln!("skipped: no driver renders by way of OpenGL");
        return;
    }
    let render = "render scratched.toml --size 96x64 --samples 1 --shadows off";
    by_opengl(folder.path(), &format!("{render} --backend gpu -o gl.exr"))
        .assert()
        .success();
    hairline(folder.path(), &format!("{render} --backend cpu -o cpu.exr")).success();
    let read = |name| exr_file::read_image_with_notes(&folder.path().join(name)).unwrap();
    let ((gl, _), (cpu, _)) = (read("gl.exr"), read("cpu.exr"));
    for layer in [Layer::Base, Layer::Scratches, Layer::Density] {
        assert!(cpu.layer(layer).iter().flatten().any(|value| *value > 0.0));
        // Seen are 7e-4, by single precision; without its scratches a picture is all off.
        let share = layer_difference(&gl, &cpu, layer, None).relative_rms();
        assert!(share < 2e-3, "{layer:?}: {share}");
    }
}
