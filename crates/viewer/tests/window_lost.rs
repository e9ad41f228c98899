//! A window whose own device is lost, on a display without a screen: it closes, says why, and unsaved work is offered at the next
//! start. Windows want a process's first thread, so that this is a program of its own (`harness = false`).

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use hairline_editor::autosave;
use hairline_viewer::progressive::Backend;
use hairline_viewer::window::{self, Renderer};
use hairline_viewer::{Options, Viewer};

const SCENE: &str = include_str!("common/small_scene.toml");
/// Frames before the scene is changed, and before the device goes.
const CHANGED: u32 = 5;
const LOST: u32 = 20;
/// A folder for autosaves, and whether the device is to go; this program gives them to itself.
const FOLDER: &str = "HAIRLINE_TEST_FOLDER";
const LOSES: &str = "HAIRLINE_TEST_LOSES";

fn main() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        return open(folder.into(), std::env::var_os(LOSES).is_some());
    }
    let server = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1000x700x24"])
        .args(["-nolisten", "tcp"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let Ok(mut server) = server else {
        return skip("no Xvfb");
    };
    let mut number = String::new();
    let said = server.stdout.take().expect("it is piped");
    let said = BufReader::new(said).read_line(&mut number);
    said.expect("Xvfb says its number");
    let display = format!(":{}", number.trim());
    let outcome = std::panic::catch_unwind(|| {
        a_lost_device_ends_the_window(&display);
        a_closed_window_is_no_loss(&display);
    });
    let _ = server.kill();
    let _ = server.wait();
    outcome.expect("see above");
    println!("a window's device that is lost: ok");
}

/// Skips the test, except where drivers are mandatory, as in CI.
fn skip(why: &str) {
    assert!(std::env::var_os("HAIRLINE_REQUIRE_GPU").is_none(), "{why}");
    println!("skipped: {why}");
}

/// Runs this program again, on the display.
fn run(display: &str, folder: &std::path::Path, loses: bool) -> String {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env("DISPLAY", display).env(FOLDER, folder);
    if loses {
        command.env(LOSES, "yes");
    }
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{text}{errors}");
    text
}

fn a_lost_device_ends_the_window(display: &str) {
    let folder = tempfile::tempdir().unwrap();
    let text = run(display, folder.path(), true);
    if text.contains("no window could be opened") {
        return skip(&text);
    }
    assert!(text.contains("device was lost"), "{text}");
    let kept = autosave::pending(&folder.path().join("autosave"));
    assert_eq!(kept.len(), 1, "what was changed is kept");
    let document = kept.into_iter().next().unwrap().recover().unwrap();
    assert_eq!(document.description().camera.exposure_ev, 2.5);
}

fn a_closed_window_is_no_loss(display: &str) {
    let folder = tempfile::tempdir().unwrap();
    let text = run(display, folder.path(), false);
    assert!(
        text.contains("closed") || text.contains("no window"),
        "{text}"
    );
    assert!(autosave::pending(&folder.path().join("autosave")).is_empty());
}

fn open(folder: std::path::PathBuf, loses: bool) {
    let options = Options {
        scene: None,
        built_in: SCENE,
        backend: Backend::Cpu,
        state_dir: Some(folder),
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    };
    let opened = window::open_as(options, Renderer::Cpu, |viewer| {
        Box::new(Unlucky {
            viewer,
            frame: 0,
            loses,
        })
    });
    match opened {
        Ok(()) => println!("closed"),
        Err(error) => println!("{error}"),
    }
}

/// The viewer, with a hand that changes the exposure, and a driver that fails after a while or a user that closes the window.
struct Unlucky {
    viewer: Viewer,
    frame: u32,
    loses: bool,
}

impl eframe::App for Unlucky {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.frame += 1;
        if self.frame == CHANGED && self.loses {
            let document = self.viewer.document_mut();
            document.edit("Exposure", |d| d.camera.exposure_ev = 2.5);
        }
        if self.frame == LOST {
            match (self.loses, frame.wgpu_render_state()) {
                (true, Some(state)) => state.device.destroy(),
                _ => ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close),
            }
        }
        assert!(self.frame < 1000, "the window is still there");
        eframe::App::ui(&mut self.viewer, ui, frame);
        ui.ctx().request_repaint();
    }

    fn on_exit(&mut self) {
        eframe::App::on_exit(&mut self.viewer);
    }
}
