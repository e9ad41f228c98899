//! The device's own clock around each pass.

use std::sync::Arc;
use std::time::{Duration, Instant};

use hairline_fixtures::{DISK, SceneFile};
use hairline_gpu::headless::{skip, test_gpu};
use hairline_gpu::{GpuScene, PassTime, RenderOptions, Renderer};
use hairline_index::ScratchIndex;
use hairline_scene::{Scene, ScratchTables};

fn scratched() -> SceneFile {
    SceneFile::seen_from([0.0, -0.22, 0.30])
        .size_px([96, 64])
        .mirror("steel")
        .object("plate", "steel", DISK)
        .random("plate", 1000)
        .with_lines("length_m = 0.02\nwidth_um = 2.0\ndepth_nm = 200.0")
        .sphere([0.0, 0.3, 0.3], 0.05, 9.0)
}

fn upload(renderer: &mut Renderer, scene: &Scene) -> GpuScene {
    let index = Arc::new(ScratchIndex::build(scene));
    let tables = ScratchTables::new(scene);
    let gpu = renderer.gpu().clone();
    gpu.block_on(renderer.upload(scene, &index, &tables, &Default::default()))
        .unwrap()
}

fn render(renderer: &mut Renderer, scene: &Scene, uploaded: &GpuScene, samples: u32) {
    let gpu = renderer.gpu().clone();
    let options = RenderOptions {
        samples,
        ..RenderOptions::default()
    };
    gpu.block_on(renderer.render(scene, uploaded, &options, &|_| {}))
        .unwrap();
}

fn times(renderer: &mut Renderer) -> Option<Vec<PassTime>> {
    let gpu = renderer.gpu().clone();
    gpu.block_on(renderer.pass_times()).unwrap()
}

fn sum(times: &[PassTime]) -> Duration {
    times.iter().map(|pass| pass.time).sum()
}

#[test]
fn passes_take_time_and_not_more_than_has_gone_by() {
    let Some(gpu) = test_gpu() else { return };
    let scene = scratched().scene();
    let mut renderer = gpu.block_on(Renderer::new(gpu)).unwrap();
    let uploaded = upload(&mut renderer, &scene);

    // Nobody has asked.
    render(&mut renderer, &scene, &uploaded, 1);
    assert_eq!(times(&mut renderer), None);

    if !gpu.block_on(renderer.time_passes()).unwrap() {
        return skip("the device has no clock");
    }
    let mut least = Duration::MAX;
    for pictures in [1, 1, 1, 8] {
        let start = Instant::now();
        for _ in 0..pictures {
            render(&mut renderer, &scene, &uploaded, 1);
        }
        let wall = start.elapsed();
        let times = times(&mut renderer).unwrap();
        let names: Vec<&str> = times.iter().map(|pass| pass.name).collect();
        assert!(
            names.contains(&"visibility") && names.contains(&"scratches"),
            "{names:?}"
        );
        for pass in &times {
            assert!(!pass.time.is_zero(), "{} took no time", pass.name);
        }
        // Passes run one after the other, so that their sum is bounded too.
        assert!(sum(&times) < wall, "{times:?} within {wall:?}");
        if pictures == 1 {
            // The least: others may be at work on the machine.
            least = least.min(sum(&times));
        } else {
            // Runs of eight pictures are summed; far less is asked for.
            assert!(sum(&times) > 2 * least, "{times:?} after {least:?}");
        }
    }
    // Times are returned once.
    assert_eq!(times(&mut renderer), Some(Vec::new()));
}
