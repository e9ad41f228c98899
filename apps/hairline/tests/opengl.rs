//! Pictures by way of OpenGL, where there is no newer interface. Each is a process of its own: a context serves one thread.

mod common;

use std::path::Path;

use assert_cmd::Command;
use common::{SCRATCHED, folder_with, hairline};
use hairline_image::{Image, Layer, exr_file};

/// Runs in `folder` and is told of no other interface.
fn by_opengl(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::cargo_bin("hairline").unwrap();
    command
        .env("WGPU_BACKEND", "gl")
        .current_dir(folder)
        .args(arguments.split_whitespace());
    command
}

/// Root of the sum of squares of a layer.
fn size(image: &Image, layer: Layer) -> f64 {
    let values = image.layer(layer);
    let squares = values.iter().flatten().map(|v| f64::from(*v).powi(2));
    squares.sum::<f64>().sqrt()
}

/// Of a scene with one metal and no texture: arrays of one layer are the special case there. Both light scratches at pixels, as GPUs do.
#[test]
fn a_picture_is_that_of_the_cpu() {
    // Under the lamp alone, whose shaders are compiled in half the time.
    let lamp_ends = SCRATCHED.rfind("[[light]]").unwrap();
    let folder = folder_with("scratched.toml", &SCRATCHED[..lamp_ends]);
    let info = by_opengl(folder.path(), "info").output().unwrap();
    if !String::from_utf8_lossy(&info.stdout).contains("can render") {
        eprintln!("skipped: no driver renders by way of OpenGL");
        return;
    }
    let render = "render scratched.toml --size 96x64 --samples 1 --light-at pixels";
    by_opengl(folder.path(), &format!("{render} --backend gpu -o gl.exr"))
        .assert()
        .success();
    hairline(folder.path(), &format!("{render} --backend cpu -o cpu.exr")).success();
    let read = |name| exr_file::read_image_with_notes(&folder.path().join(name)).unwrap();
    let ((gl, _), (mut cpu, _)) = (read("gl.exr"), read("cpu.exr"));
    for layer in [Layer::Base, Layer::Scratches, Layer::Density] {
        let whole = size(&cpu, layer);
        assert!(whole > 0.0);
        let off: Vec<_> = cpu
            .layer(layer)
            .iter()
            .zip(gl.layer(layer).iter())
            .map(|(a, b)| [a[0] - b[0], a[1] - b[1], a[2] - b[2]])
            .collect();
        match layer {
            Layer::Base => cpu.base = off,
            Layer::Scratches => cpu.scratches = off,
            _ => cpu.density = off,
        }
        // Seen are 7e-4, by single precision; without its scratches a picture is all off.
        let share = size(&cpu, layer) / whole;
        assert!(share < 2e-3, "{layer:?}: {share}");
    }
}
