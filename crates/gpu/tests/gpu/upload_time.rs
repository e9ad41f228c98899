//! Time of an upload, by stage: printed, not judged.

use std::time::Instant;

use crate::common::{BUILT_IN, Made, scene};
use hairline_gpu::Renderer;
use hairline_gpu::headless::test_gpu;

#[test]
#[ignore = "a measurement: cargo test --release -p hairline-gpu --test gpu -- --ignored --nocapture"]
fn a_layer_of_a_hundred_thousand_scratches() {
    let Some(gpu) = test_gpu() else { return };
    let layer = r#"
[[scratches]]
object = "pan"
pattern = "random"
count = 100000
seed = 9
length_m = 0.02
width_um = 2.0
depth_nm = 200.0
"#;
    let start = Instant::now();
    let scene = scene(&format!("{BUILT_IN}{layer}"));
    let built = Instant::now();
    let mut made = Made::new(scene);
    let indexed = Instant::now();
    println!(
        "scene {:?}, index and tables {:?}; {} segments",
        built - start,
        indexed - built,
        made.index.tree.segments.len()
    );
    let mut renderer = gpu.block_on(Renderer::new(gpu)).unwrap();
    let mut uploaded = gpu.block_on(made.upload(&mut renderer)).unwrap();
    for kind in ["all", "index", "light", "nothing"] {
        for _ in 0..3 {
            if kind == "index" {
                made.index = std::sync::Arc::new(made.index.as_ref().clone());
            }
            if kind == "light" {
                let light = made.scene.lights.remove(0);
                made.scene.lights.push(light);
            }
            gpu.block_on(gpu.finished()).unwrap();
            let start = Instant::now();
            if kind == "all" {
                uploaded = gpu.block_on(made.upload(&mut renderer)).unwrap();
            } else {
                gpu.block_on(made.update(&mut renderer, &mut uploaded))
                    .unwrap();
            }
            let recorded = start.elapsed();
            gpu.block_on(gpu.finished()).unwrap();
            let bytes: u64 = uploaded.written().iter().map(|w| w.bytes).sum();
            println!(
                "{kind}: {recorded:?}, done after {:?}, {bytes} bytes",
                start.elapsed()
            );
        }
    }
    println!("{:?}", uploaded.written());
}
