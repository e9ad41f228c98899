//! Every scene in `scenes/` and the built-in one, as `hairline render` shows the middle of their pictures without flags: the GPU against
//! the CPU, layer by layer.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use conformance::middle_of;
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use hairline_document::DEFAULT_SAMPLES;
use hairline_fixtures::{DISK, SceneFile};
use hairline_scene::Scene;

/// Widths of the whole picture and of its middle: a whole picture of that size would have all scratches in each tile.
const WIDTH_PX: u32 = 1280;
const MIDDLE_PX: [u32; 2] = [96, 72];
/// The same where rims and holes are many for few pixels.
const MIDDLE_OF_DISCS_PX: [u32; 2] = [120, 88];
/// The scene that is rendered twice.
const TWICE: &str = "lights";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// A scene of [`ALL`].
pub(super) fn scene(name: &str) -> Scene {
    let path = match name {
        "built_in_scene" => root().join("crates/console/src/built_in_scene.toml"),
        _ => root().join("scenes").join(name).with_extension("toml"),
    };
    hairline_document::load(path).unwrap_or_else(|error| panic!("{error}"))
}

fn middle(name: &str) -> Scene {
    let size_px = match name {
        "disc" | "dvd" => MIDDLE_OF_DISCS_PX,
        _ => MIDDLE_PX,
    };
    middle_of(scene(name), WIDTH_PX, size_px)
}

fn gpu_and_cpu_show_the_same(name: &str) {
    let scene = middle(name);
    let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
        return;
    };
    let cpu = on_the_cpu(&scene, DEFAULT_SAMPLES);
    compare(name, &scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
    // Sums are added up in the same order each time.
    if name == TWICE {
        let again = on_the_gpu(&scene, DEFAULT_SAMPLES);
        assert!(again == Some(gpu), "{name}: two runs differ");
    }
}

/// A test for each scene. Those after the semicolon show nothing that no other test does.
macro_rules! scenes {
    ($($name:ident)*; $($long:ident)*) => {
        pub(super) const ALL: &[&str] = &[$(stringify!($name),)* $(stringify!($long)),*];
        $(
            #[test]
            fn $name() {
                gpu_and_cpu_show_the_same(stringify!($name));
            }
        )*
        $(
            #[test]
            #[ignore = "long: cargo long"]
            fn $long() {
                gpu_and_cpu_show_the_same(stringify!($long));
            }
        )*
    };
}

scenes! {
    bokeh brushed built_in_scene closeup disc drawn dvd groove lid lights mirror pan phone plate profiles record spoon;
    baubles bonnet caseback engraved knife knob lamps lighter movement rings seal sundial sunlit
}

#[test]
fn no_scene_is_left_out() {
    let files = std::fs::read_dir(root().join("scenes")).unwrap();
    for path in files.map(|entry| entry.unwrap().path()) {
        let name = path.file_stem().unwrap().to_string_lossy();
        let is_scene = path.extension().is_some_and(|ending| ending == "toml");
        assert!(!is_scene || ALL.contains(&&*name), "{name}");
    }
}

/// The comparison's largest permitted error is less than that of making one scratch in ten a tenth wider.
#[test]
fn a_wrong_scratch_is_seen() {
    let scene = middle("plate");
    let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
        return;
    };
    let mut wrong = scene.clone();
    let scratches = Arc::make_mut(&mut wrong.objects[0].scratches);
    for scratch in scratches.iter_mut().step_by(10) {
        scratch.profile.width_um *= 1.1;
    }
    let cpu = on_the_cpu(&wrong, DEFAULT_SAMPLES);
    let seen = compare("wrong", &scene, &gpu, &cpu).unwrap_err();
    assert!(seen.contains("scratches"), "{seen}");
}

/// Grooves of several shapes on one object, narrow and wide ones.
#[test]
fn shapes_of_grooves() {
    let scene = SceneFile::seen_from([0.0, -0.02, 0.03])
        .size_px([64, 48])
        .fov_y_deg(6.0)
        .mirror("m")
        .object("plate", "m", DISK)
        .random("plate", 60_000)
        .with_lines(
            "profile = \"shoulders\"\nwidth_um = { mean = 3.0, spread = 0.3 }\nlength_m = 0.004",
        )
        .random("plate", 8000)
        .with_lines("seed = 2\nwidth_um = { mean = 40.0, spread = 0.8 }\nlength_m = 0.004")
        .random("plate", 8000)
        .with_lines("seed = 3\nprofile = [1, 0.6, -0.2, 0]\nwidth_um = 20.0\nlength_m = 0.004")
        .sphere([0.0, 0.02, 0.03], 0.002, 9.0)
        .scene();
    let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
        return;
    };
    let cpu = on_the_cpu(&scene, DEFAULT_SAMPLES);
    compare("shapes of grooves", &scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
}
