//! The viewer: it is started from the command line, and ends with the picture of `hairline render`, to the last bit.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use hairline_document::{DEFAULT_TRANSPORT, Description};
use hairline_image::Display;
use hairline_viewer::progressive::{Backend, Picture, ProgressiveRenderer, View};

use crate::common::{folder_with, hairline, stderr_of};

/// A scratched disk before a bright wall: in its mirror few rays find much.
const SCENE: &str = r#"
camera = { position_m = [0.0, -0.3, 0.2], target_m = [0.0, 0.02, 0.01], up = [0.0, 0.0, 1.0], fov_y_deg = 40.0 }
render = { size_px = [40, 28] }
material = [
    { name = "steel", kind = "metal", metal = "steel", roughness = 0.3 },
    { name = "paint", kind = "dielectric", base_color = [0.8, 0.6, 0.4], roughness = 0.4 },
]
object = [
    { name = "disk", shape = { disk = { radius_m = 0.1 } }, material = "steel" },
    { name = "ball", shape = { sphere = { radius_m = 0.02 } }, material = "paint", translation_m = [0.0, 0.02, 0.03] },
]
scratches = [{ object = "disk", pattern = "random", count = 80, width_um = { mean = 4.0, spread = 0.1 } }]
light = [{ kind = "sphere", center_m = [0.05, 0.1, 0.1], radius_m = 0.004, radiance = 900.0 }]
"#;

const PATIENCE: Duration = Duration::from_secs(600);

#[test]
fn a_view_that_stands_still_is_the_picture_that_is_rendered() {
    let folder = folder_with("scene.toml", SCENE);
    let render = |name: &str, flags: &str| {
        let arguments = format!("render scene.toml --backend cpu --samples 64 -o {name} {flags}");
        hairline(folder.path(), &arguments).success();
        let picture = image::open(folder.path().join(name)).unwrap();
        picture.to_rgb8().into_raw()
    };
    let rendered = render("rendered.png", "");
    let unfiltered = render("unfiltered.png", "--filter off");

    let description = Description::from_toml(SCENE, "scene.toml".as_ref()).unwrap();
    let renderer = ProgressiveRenderer::start(Backend::Cpu, Arc::new(|| {}));
    renderer.set_scene(1, Arc::new(description.clone()), PathBuf::new());
    let start = Instant::now();
    let waited = || {
        assert!(start.elapsed() < PATIENCE, "no picture came");
        std::thread::sleep(Duration::from_millis(5));
    };
    let built = loop {
        match renderer.built() {
            Some(built) => break built,
            None => waited(),
        }
    };
    renderer.set_view(View {
        camera: built.scene.camera,
        size_px: description.render.size_px,
        display: Display {
            exposure_ev: description.camera.exposure_ev,
            tone_map: description.render.tone_map,
        },
        filter_std_px: description.render.filter_std_px,
        transport: DEFAULT_TRANSPORT,
        reading: Default::default(),
        region: None,
    });
    let frame = loop {
        match renderer.latest() {
            Some(frame) if frame.painted.is_final => break frame,
            _ => waited(),
        }
    };
    let Picture::Pixels(pixels) = &frame.picture else {
        panic!("the CPU paints pixels");
    };
    let shown: Vec<u8> = (pixels.pixels.iter())
        .flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()])
        .collect();
    // The window's rays come in other batches, each with its own samples on edges.
    let off = |other: &[u8]| {
        let pairs = shown.iter().zip(other);
        let squares = pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2));
        (squares.sum::<f64>() / shown.len() as f64).sqrt()
    };
    let (same, unlike) = (off(&rendered), off(&unfiltered));
    assert!(same < 3.0 && same < unlike, "{same} {unlike}");
}

/// A folder with the program, and with what lies beside it.
#[cfg(unix)]
fn installed(viewer: Option<&str>) -> tempfile::TempDir {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(
        env!("CARGO_BIN_EXE_hairline"),
        folder.path().join("hairline"),
    )
    .unwrap();
    if let Some(script) = viewer {
        let path = folder.path().join("hairline-viewer");
        std::fs::write(&path, script).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder
}

#[test]
#[cfg(unix)]
fn the_viewer_beside_it_is_started_with_all_arguments() {
    let folder = installed(Some("#!/bin/sh\necho \"$# $*\"\nexit 3\n"));
    for (arguments, expected) in [
        (&[][..], "0 \n"),
        (&["view"], "0 \n"),
        (
            &["view", "my scene.toml", "--backend", "cpu", "--shadows=off"],
            "4 my scene.toml --backend cpu --shadows=off\n",
        ),
    ] {
        let mut program = assert_cmd::Command::new(folder.path().join("hairline"));
        program.args(arguments).assert().code(3).stdout(expected);
    }
    // What the viewer would refuse is refused here.
    let mut program = assert_cmd::Command::new(folder.path().join("hairline"));
    let refused = program.args(["view", "--backend", "tpu"]).assert().code(2);
    assert!(stderr_of(&refused).contains("auto, gpu, cpu"));
}

#[test]
#[cfg(unix)]
fn without_a_viewer_beside_it_a_sentence_says_how_to_get_one() {
    let folder = installed(None);
    for arguments in [&[][..], &["view", "scene.toml"]] {
        let mut program = assert_cmd::Command::new(folder.path().join("hairline"));
        let text = stderr_of(&program.args(arguments).assert().code(1));
        assert!(
            text.contains("cargo build --release -p hairline-viewer") && text.lines().count() == 1,
            "{text}"
        );
    }
}
