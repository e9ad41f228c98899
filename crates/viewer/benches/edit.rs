//! Time from an edit to the picture: a layer of 100,000 scratches on the built-in pan whose width is changed again and again,
//! as by a hand on a slider, then one of 1,000 beside it, and the time of the interface's own passes meanwhile.
//!
//! `cargo bench -p hairline-viewer-lib --bench edit` prints a table. No statistics crate: what is measured spans three threads,
//! and each stage says its own time.

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use hairline_document::description::{Amount, Layer};
use hairline_editor::DragKey;
use hairline_editor::presets::LayerPreset;
use hairline_gpu::{AdapterRequest, headless};
use hairline_viewer::progressive::{Backend, Latency};
use hairline_viewer::{Options, Viewer};

const BUILT_IN: &str = include_str!("../../../crates/console/src/built_in_scene.toml");
const SCRATCHES: u64 = 100_000;
/// Half a kilometre of scratches in all, as on a pan that was scoured for years.
const LENGTH_M: f64 = 0.005;
/// Number of scratches of the layer beside it.
const FEW: u64 = 1000;
const EDITS: usize = 12;

type Stage = fn(&Latency) -> Duration;

fn main() {
    // `cargo test --benches` only wants to see it compile and begin.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    println!(
        "{SCRATCHES} scratches in a third layer of the built-in pan and {FEW} in a fourth; {EDITS} changes of their width"
    );
    measure(Backend::Cpu);
    match headless::open(&AdapterRequest::default()) {
        Ok(gpu) => measure(Backend::Gpu(gpu)),
        Err(error) => println!("no graphics adapter: {error}"),
    }
}

fn measure(backend: Backend) {
    let name = backend.label();
    let mut harness = Harness::builder()
        .with_size([1280.0, 800.0])
        .build_eframe(|context| {
            let options = Options {
                scene: None,
                built_in: BUILT_IN,
                backend,
                state_dir: None,
                native_dialogs: false,
                transport: hairline_scene::Transport::DIRECT,
                examples: &hairline_viewer::examples::Examples::NONE,
            };
            Viewer::new(&context.egui_ctx, None, options).expect("the built-in scene")
        });
    let document = harness.state_mut().document_mut();
    for (count, seed) in [(SCRATCHES, 3), (FEW, 4)] {
        let mut layer = LayerPreset::RandomWear.layer("pan", 0.21);
        if let Layer::Laid(laid) = &mut layer.layer {
            laid.amount = Amount::Count(count);
            laid.length_m.mean = LENGTH_M;
            laid.seed = seed;
        }
        document.edit("Add a layer", |d| d.scratches.push(layer));
    }
    wait_for_picture(&mut harness, &mut Vec::new());
    let segments = harness
        .state()
        .renderer()
        .built()
        .map_or(0, |built| built.scratch_counts().1);
    println!("\n{name}: {segments} straight pieces; medians, and the largest in brackets");
    for (layer, count) in [(2, SCRATCHES), (3, FEW)] {
        println!("edits of the layer of {count}");
        measure_edits(&mut harness, layer);
    }
}

fn measure_edits(harness: &mut Harness<Viewer>, layer: usize) {
    let mut passes = Vec::new();
    let mut latencies: Vec<Latency> = Vec::new();
    for i in 0..EDITS {
        let document = harness.state_mut().document_mut();
        document.drag("Width", DragKey::from_name("bench"), |d| {
            if let Layer::Laid(laid) = &mut d.scratches[layer].layer {
                laid.width_um.mean = 3.0 + 0.1 * i as f64;
            }
        });
        latencies.push(wait_for_picture(harness, &mut passes));
    }
    let stages: [(&str, Stage); 7] = [
        ("waited for the thread", |l| l.build.waited),
        ("scratches laid", |l| l.build.scene),
        ("trees", |l| l.build.index),
        ("tables", |l| l.build.tables),
        ("upload", |l| l.upload),
        ("first picture", |l| l.paint),
        ("edit to picture", |l| l.total),
    ];
    for (stage, time) in stages {
        line(stage, latencies.iter().map(time).collect());
    }
    line("pass of the interface", passes);
}

/// Lets the interface run until the newest description is in the picture. The bench's own copy of a pass's time: tests draw no
/// pixels, so what a window's device takes for its triangles is not in it.
fn wait_for_picture(harness: &mut Harness<Viewer>, passes: &mut Vec<Duration>) -> Latency {
    let start = Instant::now();
    loop {
        let pass = Instant::now();
        harness.step();
        passes.push(pass.elapsed());
        let wanted = harness.state().document().revision();
        if let Some(frame) = harness.state().renderer().latest()
            && let Some(latency) = frame.painted.latency
            && latency.revision == wanted
        {
            return latency;
        }
        assert!(
            start.elapsed() < Duration::from_secs(300),
            "no picture came"
        );
        // A display's rate.
        std::thread::sleep(Duration::from_millis(16));
    }
}

fn line(name: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    let (median, most) = (times[times.len() / 2], times[times.len() - 1]);
    println!("{name:>24}: {:8.1} ms ({:.1})", ms(median), ms(most));
}
