//! Every scene in `scenes/` and the built-in one, as `hairline render` shows the middle of their pictures without flags: the GPU against
//! the CPU, layer by layer.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use conformance::middle_of;
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use hairline_scene::{DEFAULT_SAMPLES, Scene};

/// Of the whole picture, and of its middle: whole pictures so small would see all scratches in each tile.
const WIDTH_PX: u32 = 1280;
const MIDDLE_PX: [u32; 2] = [120, 88];
/// Scenes that are rendered twice.
const TWICE: [&str; 2] = ["lights", "spoon"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

fn load(path: &Path) -> Scene {
    let scene = Scene::load(path).unwrap_or_else(|error| panic!("{error}"));
    middle_of(scene, WIDTH_PX, MIDDLE_PX)
}

#[test]
fn gpu_and_cpu_show_the_same() {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(root().join("scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .chain([root().join("apps/hairline/src/built_in_scene.toml")])
        .collect();
    paths.sort();
    let mut failures = Vec::new();
    for path in paths {
        let scene = load(&path);
        let start = std::time::Instant::now();
        let name = path.file_stem().unwrap().to_string_lossy();
        let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
            return;
        };
        println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
        let cpu = on_the_cpu(&scene, DEFAULT_SAMPLES);
        failures.extend(compare(&name, &scene, &gpu, &cpu).err());
        // Sums are added up in the same order each time.
        if TWICE.contains(&&*name) && on_the_gpu(&scene, DEFAULT_SAMPLES) != Some(gpu) {
            failures.push(format!("{name}: two runs differ"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// What the comparison would let pass is less than one scratch of ten that is a tenth wider.
#[test]
fn a_wrong_scratch_is_seen() {
    let scene = load(&root().join("scenes/plate.toml"));
    let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
        return;
    };
    let mut wrong = scene.clone();
    let scratches = Arc::make_mut(&mut wrong.objects[0].scratches);
    for scratch in scratches.iter_mut().step_by(10) {
        scratch.width_um *= 1.1;
    }
    let cpu = on_the_cpu(&wrong, DEFAULT_SAMPLES);
    let seen = compare("wrong", &scene, &gpu, &cpu).unwrap_err();
    assert!(seen.contains("scratches"), "{seen}");
}
