//! The command line from outside: exit codes, messages, and files that are whole or not there.

use std::fs;
use std::path::Path;

use crate::common::{command, folder_with, hairline, names_in, stderr_of, stdout_of};
use hairline_fixtures::scenes::lit_plate;
use hairline_image::{exr_file, png};
use std::sync::LazyLock;

/// A disk under a lamp, without scratches.
static SCENE: LazyLock<String> =
    LazyLock::new(|| lit_plate().exposure_ev(1.0).size_px([64, 36]).to_string());

fn folder_with_scene() -> tempfile::TempDir {
    folder_with("plate.v2.toml", &SCENE)
}

#[test]
fn help_and_version() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in ["--help", "render --help"] {
        let assert = hairline(folder.path(), arguments).success();
        let text = stdout_of(&assert);
        assert!(text.contains("Usage:"), "{text}");
    }
    let assert = hairline(folder.path(), "--version").success();
    let text = stdout_of(&assert);
    assert_eq!(text.trim(), concat!("hairline ", env!("CARGO_PKG_VERSION")));
}

#[test]
fn info_lists_backends() {
    let folder = tempfile::tempdir().unwrap();
    let assert = hairline(folder.path(), "info").success();
    let text = stdout_of(&assert);
    for part in [env!("CARGO_PKG_VERSION"), "adapters", "backends:", "cpu  "] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn wrong_command_lines_are_2() {
    let folder = folder_with_scene();
    let before = names_in(folder.path());
    for (arguments, message) in [
        ("paint", "paint"),
        ("render --size 12", "1280x720"),
        ("render --size 0x5", "1280x720"),
        ("render --size 99999x5", "16384"),
        ("render --samples 0", "from 1 to 1024"),
        ("render --exposure much", "stops"),
        ("render --exposure NaN", "stops"),
        ("render --backend tpu", "auto, gpu, cpu"),
        ("render --seed -1", "--seed"),
        ("render -o picture.jpg", "end it in .png or .exr"),
        ("render -o picture", "end it in .png or .exr"),
        ("render missing.toml", "missing.toml"),
        ("render . -o a.png", "scene file"),
    ] {
        let assert = hairline(folder.path(), arguments).code(2);
        let text = stderr_of(&assert);
        assert!(text.contains(message), "{arguments}: {text}");
        assert_eq!(names_in(folder.path()), before, "{arguments}");
    }
}

#[test]
fn wrong_scenes_are_2_and_named_with_their_line() {
    let folder = folder_with_scene();
    for (from, to, message) in [
        ("roughness", "roughnes", "roughness"),
        ("0.02", "-0.02", "light[0].radius_m"),
        ("\"steel\"\n\n[[light", "\"stele\"\n\n[[light", "steel"),
        ("[camera]", "[camera", "scene.toml"),
    ] {
        fs::write(
            folder.path().join("scene.toml"),
            SCENE.replacen(from, to, 1),
        )
        .unwrap();
        let assert = hairline(folder.path(), "render scene.toml").code(2);
        let text = stderr_of(&assert);
        assert!(
            text.contains("scene.toml:") && text.contains(message),
            "{text}"
        );
        assert!(!folder.path().join("scene.png").exists());
    }
}

#[test]
fn outputs_that_cannot_be_written_are_1_before_the_work() {
    let folder = folder_with_scene();
    fs::create_dir(folder.path().join("taken.png")).unwrap();
    let before = names_in(folder.path());
    for (output, message) in [
        ("nowhere/a.png", "there is no folder"),
        ("taken.png", "it is a folder"),
        ("plate.v2.toml/a.exr", "a file where a folder is needed"),
    ] {
        let arguments = format!("render plate.v2.toml -o {output}");
        let assert = hairline(folder.path(), &arguments).code(1);
        let text = stderr_of(&assert);
        assert!(text.contains(output) && text.contains(message), "{text}");
        assert!(!text.contains("rendering"), "found out too late: {text}");
        assert_eq!(names_in(folder.path()), before);
    }
}

#[test]
fn a_picture_is_named_after_its_scene() {
    let folder = folder_with_scene();
    let assert = hairline(
        folder.path(),
        "render plate.v2.toml --backend cpu --samples 1",
    )
    .success();
    let text = stderr_of(&assert);
    assert_eq!(
        text.lines().count(),
        1,
        "one line and no bar in a pipe: {text}"
    );
    assert!(
        text.starts_with("rendering on the CPU") && text.contains("as asked"),
        "{text}"
    );
    assert_eq!(names_in(folder.path()), ["plate.v2.png", "plate.v2.toml"]);
    let picture = png::read_picture(&folder.path().join("plate.v2.png")).unwrap();
    assert_eq!(picture.size_px, [64, 36]);
    assert!(picture.rgb.iter().flatten().any(|c| *c > 0.1), "black");
}

#[test]
fn flags_change_the_picture() {
    let folder = folder_with_scene();
    hairline(
        folder.path(),
        "render plate.v2.toml --backend cpu --size 40x30 -o a.exr",
    )
    .success();
    let image = exr_file::read_image(&folder.path().join("a.exr")).unwrap();
    assert_eq!(image.size_px, [40, 30]);
    let center = image.index(20, 15);
    // The camera is sqrt(0.22^2 + 0.30^2) m away from the middle of the plate.
    assert!(
        (image.depth_m[center] - 0.372).abs() < 0.003,
        "{}",
        image.depth_m[center]
    );
    assert!(image.normal[center][2] > 0.999);

    // Exposure is for displays: a stop more or less changes the PNG alone.
    let mean = |name: &str| {
        let picture = png::read_picture(&folder.path().join(name)).unwrap();
        picture.rgb.iter().map(|c| f64::from(c[1])).sum::<f64>()
    };
    hairline(
        folder.path(),
        "render plate.v2.toml --backend cpu -o dim.png --exposure -2",
    )
    .success();
    hairline(
        folder.path(),
        "render plate.v2.toml --backend cpu -o bright.png",
    )
    .success();
    assert!(mean("bright.png") > 1.5 * mean("dim.png"));
    hairline(
        folder.path(),
        "render plate.v2.toml --backend cpu --size 40x30 -o b.exr --exposure 5",
    )
    .success();
    assert_eq!(
        exr_file::read_image(&folder.path().join("b.exr")).unwrap(),
        image
    );
}

/// Environment in which a machine has, in effect, no graphics drivers.
const NO_DRIVERS: [(&str, &str); 3] = [
    ("VK_ICD_FILENAMES", "/nonexistent"),
    ("VK_DRIVER_FILES", "/nonexistent"),
    ("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent"),
];

/// Runs on a machine without a display, and returns stderr.
fn stderr_without_display<'a>(
    folder: &Path,
    arguments: &str,
    environment: impl IntoIterator<Item = (&'a str, &'a str)>,
    exit_code: i32,
) -> String {
    let assert = command(folder, arguments)
        .env_remove("XDG_RUNTIME_DIR")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("DISPLAY")
        .envs(environment)
        .assert()
        .code(exit_code);
    stderr_of(&assert)
}

#[test]
fn auto_says_what_rendered_in_one_line() {
    let folder = folder_with_scene();
    let text = stderr_without_display(folder.path(), "render plate.v2.toml -o auto.png", [], 0);
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(text.starts_with("rendering on "), "{text}");
    assert!(folder.path().join("auto.png").exists());
}

#[test]
fn a_graphics_driver_renders_the_same_picture() {
    if hairline_gpu::headless::test_gpu().is_none() {
        return;
    }
    let folder = folder_with_scene();
    let render = |backend: &str| {
        let output = format!("{backend}.exr");
        let arguments = format!("render plate.v2.toml --backend {backend} -o {output}");
        let text = stderr_without_display(folder.path(), &arguments, [], 0);
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(text.contains("as asked"), "{text}");
        exr_file::read_image(&folder.path().join(output)).unwrap()
    };
    let (gpu, cpu) = (render("gpu"), render("cpu"));
    let sum = |image: &hairline_image::Image| -> f64 {
        let green = image.base.iter().map(|c| f64::from(c[1]));
        green.sum()
    };
    // Pixels on the rim may see a sample or two more of it.
    assert!(
        (sum(&gpu) / sum(&cpu) - 1.0).abs() < 0.01,
        "{} {}",
        sum(&gpu),
        sum(&cpu)
    );
}

#[cfg(target_os = "linux")]
#[test]
fn no_driver_still_renders() {
    let folder = folder_with_scene();
    // GL could be there without the vendor-neutral library, which the third variable speaks to.
    let environment = || NO_DRIVERS.into_iter().chain([("WGPU_BACKEND", "vulkan")]);
    let arguments = |backend| format!("render plate.v2.toml -o a.png --backend {backend}");
    let picture = folder.path().join("a.png");

    let text = stderr_without_display(folder.path(), &arguments("gpu"), environment(), 1);
    assert!(text.contains("no graphics driver"), "{text}");
    assert!(text.contains("--backend cpu"), "{text}");
    assert!(!picture.exists());

    let text = stderr_without_display(folder.path(), &arguments("auto"), environment(), 0);
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(
        text.starts_with("rendering on the CPU") && text.contains("no graphics driver"),
        "{text}"
    );
    assert!(picture.exists());
}

/// Under an even sky, which takes no time to blur.
#[test]
fn the_documented_scene_renders() {
    let folder = tempfile::tempdir().unwrap();
    let mut sky = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
    sky.extend([128, 128, 128, 129].repeat(8));
    fs::write(folder.path().join("studio.hdr"), sky).unwrap();
    the_documented_scene_is_bright(folder.path(), "--size 32x18 --backend cpu --shadows off");
}

/// With the files that the documentation tells of.
#[test]
#[ignore = "long: cargo long"]
fn the_documented_scene_renders_as_it_stands() {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    let map = assets.join("studio.hdr");
    if !map.exists() {
        hairline_gpu::headless::skip("no studio.hdr in shared/assets");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    fs::copy(map, folder.path().join("studio.hdr")).unwrap();
    the_documented_scene_is_bright(folder.path(), "--size 320x180");
}

fn the_documented_scene_is_bright(folder: &Path, flags: &str) {
    let scene = include_str!("../../../../crates/document/tests/example.toml");
    fs::write(folder.join("scene.toml"), scene).unwrap();
    hairline(folder, &format!("render scene.toml -o a.png {flags}")).success();
    let picture = png::read_picture(&folder.join("a.png")).unwrap();
    let brightest = picture.rgb.iter().flatten().fold(0.0, |a, b| b.max(a));
    assert!(brightest > 0.9, "{brightest}");
}

/// A signal in the middle of the work, minutes before its end, leaves no file behind. Ctrl-C does the same by default, but a process
/// that a script has started in the background ignores it, and so do those that it starts: the test itself may be one.
#[cfg(unix)]
#[test]
fn an_interrupted_render_leaves_no_file() {
    let folder = folder_with_scene();
    let before = names_in(folder.path());
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_hairline"))
        .current_dir(folder.path())
        .args(["render", "plate.v2.toml", "-o", "a.exr", "--backend", "cpu"])
        .args(["--size", "4000x4000", "--samples", "64"])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // The line that says what renders comes when the work begins.
    let mut line = String::new();
    let mut stderr = std::io::BufReader::new(child.stderr.take().unwrap());
    std::io::BufRead::read_line(&mut stderr, &mut line).unwrap();
    assert!(line.starts_with("rendering on"), "{line}");
    let killed = std::process::Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(1), "{status}");
    assert_eq!(names_in(folder.path()), before);
}

/// A process that dies while it writes cannot remove its temporary file: the next one that writes there does. The limit on the size of
/// files kills it at the right moment, as surely as `kill -9` would at some other.
#[cfg(unix)]
#[test]
fn what_a_killed_render_left_is_removed_by_the_next() {
    let folder = folder_with_scene();
    let before = names_in(folder.path());
    let hairline = env!("CARGO_BIN_EXE_hairline");
    let status = std::process::Command::new("sh")
        .current_dir(folder.path())
        .args([
            "-c",
            "ulimit -c 0; ulimit -f 1; exec \"$@\"",
            "sh",
            hairline,
        ])
        .args(["render", "plate.v2.toml", "-o", "a.exr", "--backend", "cpu"])
        .stderr(std::process::Stdio::null())
        .status()
        .unwrap();
    let signal = std::os::unix::process::ExitStatusExt::signal(&status);
    assert!(signal.is_some(), "{status}");
    let left = names_in(folder.path());
    let is_left = |name: &&String| name.starts_with(".hairline-") && name.ends_with(".tmp");
    assert_eq!(left.len(), before.len() + 1, "{left:?}");
    assert_eq!(left.iter().filter(is_left).count(), 1, "{left:?}");

    command(folder.path(), "render plate.v2.toml -o b.png --backend cpu")
        .assert()
        .success();
    let mut expected = [before, vec!["b.png".to_owned()]].concat();
    expected.sort();
    assert_eq!(names_in(folder.path()), expected);
}
