//! A model and a map that others made: the files beside the repository that are not part of it.

use std::path::{Path, PathBuf};

use conformance::middle_of;
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use hairline_document::DEFAULT_SAMPLES;
use hairline_fixtures::SceneFile;
use hairline_gpu::headless;
use hairline_image::Layer;

/// A monkey's head of steel, 13 cm wide, in a studio with a lamp and a panel.
fn monkey() -> SceneFile {
    const PANEL_M: [[f64; 3]; 4] = [
        [-0.2, 0.15, 0.1],
        [-0.2, -0.05, 0.1],
        [-0.2, -0.05, 0.25],
        [-0.2, 0.15, 0.25],
    ];
    SceneFile::seen_from([0.05, 0.03, 0.30])
        .looking_at([0.0, -0.002, 0.0])
        .up([0.0, 1.0, 0.0])
        .fov_y_deg(24.0)
        .size_px([900, 900])
        .part("[environment]\nfile = \"studio.hdr\"\nintensity = 0.1")
        .metal("steel", "steel")
        .with_lines("roughness = 0.1")
        .part("[[object]]\nname = \"monkey\"\nmesh = \"suzi.glb\"")
        .with_lines("material = \"steel\"\nscale = 0.05")
        .random("monkey", 50_000)
        .with_lines(
            "length_m = { mean = 0.008, spread = 0.4 }\nwidth_um = { mean = 3.0, spread = 0.3 }",
        )
        .with_lines("depth_nm = { mean = 180.0, spread = 0.15 }")
        .sphere([0.1, 0.2, 0.25], 0.02, 300.0)
        .polygon(&PANEL_M, 15.0)
        .with_lines("two_sided = true")
}

/// The folder of these files, relative to the workspace; none, and a line on stderr, without them.
fn assets() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/assets");
    for name in ["suzi.glb", "studio.hdr"] {
        if !folder.join(name).is_file() {
            headless::skip(&format!("no {name} in shared/assets"));
            return None;
        }
    }
    Some(folder)
}

#[test]
fn a_monkey_with_fifty_thousand_scratches_in_a_studio() {
    let Some(folder) = assets() else { return };
    let scene = hairline_document::from_toml(&monkey().to_string(), "monkey.toml", &folder)
        .unwrap_or_else(|error| panic!("{error}"));
    // Seeds at a boundary may leave nothing.
    assert!(scene.objects[0].scratches.len() > 49_900);
    let scene = middle_of(scene, 480, [64, 48]);
    let cpu = on_the_cpu(&scene, DEFAULT_SAMPLES);
    for layer in Layer::ALL {
        let values = cpu.layer(layer);
        assert!(
            values.iter().flatten().all(|value| value.is_finite()),
            "{}",
            layer.name()
        );
    }

    let head: Vec<usize> = (0..cpu.pixel_count())
        .filter(|i| cpu.depth_m[*i] > 0.0)
        .collect();
    assert!(head.len() > cpu.pixel_count() / 8, "{}", head.len());
    // Scratches light up what the studio leaves dark.
    let lit = head
        .iter()
        .filter(|&&i| cpu.scratches[i][1] > 0.25 * cpu.base[i][1])
        .count();
    assert!(lit > head.len() / 10, "{lit} of {}", head.len());
    let coloured = head
        .iter()
        .filter(|&&i| cpu.scratches[i][0].max(cpu.scratches[i][2]) > 1.5 * cpu.scratches[i][1])
        .count();
    assert!(coloured > head.len() / 100, "{coloured} of {}", head.len());

    let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
        return;
    };
    compare("monkey", &scene, &gpu, &cpu).unwrap();
}
