//! Every scene in `scenes/`: the GPU against the CPU's closed form, layer by layer.

use std::path::{Path, PathBuf};

use conformance::two_renderers::{at_test_size, compare, on_the_cpu, on_the_gpu};
use hairline_scene::Scene;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
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
        let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let scene = at_test_size(scene);
        let Some(gpu) = on_the_gpu(&scene, 1) else {
            return;
        };
        let name = path.file_stem().unwrap().to_string_lossy();
        failures.extend(compare(&name, &scene, &gpu, &on_the_cpu(&scene, 1)).err());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
