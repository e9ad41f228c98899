//! Time of a frame of a real window, from one pass of the interface to the next: the pass, its drawing and the way to the
//! screen, while nothing but the window is busy, while the view turns, and while a layer of 100,000 scratches is laid again
//! and again under a hand on a slider.
//!
//! `xvfb-run -s "-screen 0 1280x800x24" cargo bench -p hairline-viewer-lib --bench window` prints a table. Without a display it
//! says so; with `-- gpu` the GPU renderer paints, be it on a software driver. No statistics crate: what is measured is the
//! pace of an event loop.

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use egui::{ViewportCommand, vec2};
use hairline_document::description::{Amount, Layer};
use hairline_document::navigate;
use hairline_editor::DragKey;
use hairline_editor::presets::LayerPreset;
use hairline_viewer::progressive::Backend;
use hairline_viewer::window::{Renderer, open_as};
use hairline_viewer::{Options, Viewer};

const BUILT_IN: &str = include_str!("../../../crates/console/src/built_in_scene.toml");
const SCRATCHES: u64 = 100_000;
/// Length of scratches, that of the bench `edit`.
const LENGTH_M: f64 = 0.005;
/// Frames of each of the three, after some that are not counted.
const FRAMES: usize = 200;
const UNCOUNTED: usize = 10;
/// Longest time for a slow device to finish the first picture; else it goes on refining it while nothing moves.
const PATIENCE: Duration = Duration::from_secs(30);

fn main() {
    // `cargo test --benches` only wants to see it compile and begin.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let renderer = match std::env::args().any(|argument| argument == "gpu") {
        true => Renderer::Gpu,
        false => Renderer::Auto,
    };
    let options = Options {
        scene: None,
        built_in: BUILT_IN,
        backend: Backend::Cpu,
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    };
    let times: Arc<Mutex<Vec<Times>>> = Arc::default();
    let told = Arc::clone(&times);
    let opened = open_as(options, renderer, |viewer| {
        Box::new(Probe::new(viewer, told))
    });
    if let Err(error) = opened {
        println!("{error}");
    }
    for times in times.lock().expect("no thread panicked").iter() {
        times.print();
    }
}

/// Activity while frames are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scenario {
    /// The picture is finished, and the interface is drawn as fast as possible.
    Still,
    /// The view turns.
    Orbit,
    /// The width of the scratches changes.
    Edit,
}

impl Scenario {
    const ALL: [Self; 3] = [Self::Still, Self::Orbit, Self::Edit];

    fn label(self) -> &'static str {
        match self {
            Self::Still => "nothing moves",
            Self::Orbit => "the view turns",
            Self::Edit => "a width is dragged",
        }
    }
}

struct Times {
    scenario: Scenario,
    what_paints: String,
    passes: Vec<Duration>,
    frames: Vec<Duration>,
    pictures: u64,
}

impl Times {
    fn print(&self) {
        let total: Duration = self.frames.iter().sum();
        println!(
            "\n{}, {}: {} frames, {:.1} a second, {} pictures",
            self.scenario.label(),
            self.what_paints,
            self.frames.len(),
            self.frames.len() as f64 / total.as_secs_f64(),
            self.pictures,
        );
        line("pass of the interface", self.passes.clone());
        line("whole frame", self.frames.clone());
    }
}

fn line(name: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let ms = |share: f64| 1e3 * times[(share * (times.len() - 1) as f64) as usize].as_secs_f64();
    let [median, most, all] = [0.5, 0.95, 1.0].map(ms);
    println!(
        "{name:>24}: median {median:6.1} ms, 95 of 100 below {most:6.1} ms, longest {all:6.1} ms"
    );
}

/// The viewer, with a hand that never rests and a clock.
struct Probe {
    viewer: Viewer,
    told: Arc<Mutex<Vec<Times>>>,
    scenario: usize,
    frame: usize,
    last_start: Option<Instant>,
    passes: Vec<Duration>,
    frames: Vec<Duration>,
    first_picture: u64,
    opened: Instant,
    is_ready: bool,
}

impl Probe {
    fn new(viewer: Viewer, told: Arc<Mutex<Vec<Times>>>) -> Self {
        Self {
            viewer,
            told,
            scenario: 0,
            frame: 0,
            last_start: None,
            passes: Vec::new(),
            frames: Vec::new(),
            first_picture: 0,
            opened: Instant::now(),
            is_ready: false,
        }
    }

    /// Number of the newest picture, and whether it is the last one of its view.
    fn picture(&self) -> (u64, bool) {
        let frame = self.viewer.renderer().latest();
        frame.map_or((0, false), |frame| {
            let is_newest = frame.built.revision == self.viewer.document().revision();
            (frame.number, frame.painted.is_final && is_newest)
        })
    }

    fn add_layer(&mut self) {
        let mut layer = LayerPreset::RandomWear.layer("pan", 0.21);
        if let Layer::Laid(laid) = &mut layer.layer {
            laid.amount = Amount::Count(SCRATCHES);
            laid.length_m.mean = LENGTH_M;
            laid.seed = 3;
        }
        let add = |d: &mut hairline_document::Description| d.scratches.push(layer);
        self.viewer.document_mut().edit("Add a layer", add);
    }

    fn move_hand(&mut self, scenario: Scenario) {
        let frame = self.frame;
        let document = self.viewer.document_mut();
        match scenario {
            Scenario::Still => {}
            Scenario::Orbit => {
                let step = glam::DVec2::new(if frame % 100 < 50 { 4.0 } else { -4.0 }, 0.0);
                let size = glam::DVec2::new(800.0, 450.0);
                document.drag("Orbit", DragKey::from_name("bench orbit"), |d| {
                    navigate::orbit(&mut d.camera, step, size)
                });
            }
            Scenario::Edit => document.drag("Width", DragKey::from_name("bench"), |d| {
                if let Layer::Laid(laid) = &mut d.scratches[2].layer {
                    laid.width_um.mean = 3.0 + 0.01 * frame as f64;
                }
            }),
        }
    }

    fn end_scenario(&mut self, scenario: Scenario) {
        let (number, _) = self.picture();
        let times = Times {
            scenario,
            what_paints: self.viewer.renderer().backend().label(),
            passes: std::mem::take(&mut self.passes),
            frames: std::mem::take(&mut self.frames),
            pictures: number - self.first_picture,
        };
        if let Ok(mut told) = self.told.lock() {
            told.push(times);
        }
        self.scenario += 1;
        self.frame = 0;
        if Scenario::ALL.get(self.scenario) == Some(&Scenario::Edit) {
            self.add_layer();
        }
    }
}

impl eframe::App for Probe {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let start = Instant::now();
        let last_start = self.last_start.replace(start);
        let ctx = ui.ctx().clone();
        if !self.is_ready {
            ctx.send_viewport_cmd(ViewportCommand::InnerSize(vec2(1280.0, 800.0)));
            self.is_ready = self.picture().1 || self.opened.elapsed() > PATIENCE;
            self.viewer.ui(ui, frame);
            if !self.is_ready {
                ctx.request_repaint_after(Duration::from_millis(100));
                return;
            }
        }
        ctx.request_repaint();
        let Some(&scenario) = Scenario::ALL.get(self.scenario) else {
            ctx.send_viewport_cmd(ViewportCommand::Close);
            return;
        };
        if self.frame == UNCOUNTED {
            self.first_picture = self.picture().0;
        } else if self.frame > UNCOUNTED
            && let Some(last) = last_start
        {
            self.frames.push(start - last);
        }
        self.move_hand(scenario);
        let pass = Instant::now();
        self.viewer.ui(ui, frame);
        if self.frame >= UNCOUNTED {
            self.passes.push(pass.elapsed());
        }
        self.frame += 1;
        if self.frame == UNCOUNTED + FRAMES {
            self.end_scenario(scenario);
        }
    }
}
