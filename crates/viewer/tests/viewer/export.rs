//! Pictures and turntables to files: whole or not at all, whatever happens meanwhile.

use crate::common;

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_document::navigate;
use hairline_document::{Description, Loader};
use hairline_gpu::{Method, headless};
use hairline_image::metrics::layer_difference;
use hairline_image::tone_map::srgb_from_linear;
use hairline_image::{Display, Image, Layer, exr_file, png};
use hairline_scene::Scene;
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};

/// Pictures that are soon done.
const TINY: &str = concat!(
    include_str!("../common/small_scene.toml"),
    "\n[render]\nsize_px = [48, 32]\n"
);
/// Pictures that take a moment.
const MODEST: &str = concat!(
    include_str!("../common/small_scene.toml"),
    "\n[render]\nsize_px = [160, 100]\n"
);

/// Number of samples with which the dialog begins.
const SAMPLES: u32 = hairline_document::DEFAULT_SAMPLES;

fn viewer(scene: &'static str) -> Harness<'static, Viewer> {
    let mut harness = common::viewer(scene);
    common::wait_built(&mut harness);
    harness
}

fn type_path(harness: &mut Harness<'static, Viewer>, path: &Path) {
    let text = path.display().to_string();
    harness
        .get_by_role_and_label(Role::TextInput, "File")
        .set_text_value_accesskit(&text);
    harness.run_steps(3);
}

pub fn save_picture(harness: &mut Harness<'static, Viewer>, path: &Path) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(3);
    type_path(harness, path);
    common::click_on(harness, "Save the picture");
}

fn export_turntable(harness: &mut Harness<'static, Viewer>, path: &Path, frames: u32) {
    common::click_on(harness, "File");
    common::click_on(harness, "Export a turntable…");
    type_path(harness, path);
    harness
        .get_by_role_and_label(Role::SpinButton, "Pictures")
        .set_value_accesskit(f64::from(frames));
    harness.run_steps(3);
    common::click_on(harness, "The camera");
    common::click_on(harness, "Export");
}

pub fn wait_exported(harness: &mut Harness<'static, Viewer>) {
    common::wait_until(harness, "the export ends", |viewer| !viewer.is_exporting());
}

/// Renders the scene by the CPU renderer, turned by so many degrees.
fn rendered(text: &str, turned_deg: f64) -> (Image, Display) {
    let mut description = Description::from_toml(text, Path::new("test")).unwrap();
    navigate::turn(&mut description.camera, turned_deg.to_radians());
    let scene: Scene = Loader::default()
        .build(&description, Path::new(""))
        .unwrap();
    let options = RenderOptions {
        samples: SAMPLES,
        ..RenderOptions::default()
    };
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    (closed_form::render(&scene, &options, &|_| {}), display)
}

/// Image as a file of radiance holds it.
fn in_a_file(image: Image) -> Image {
    Image { ..image }
}

fn codes_of(path: &Path) -> Vec<u8> {
    let picture = png::read_picture(path).unwrap();
    let codes = picture.rgb.iter().flatten();
    codes
        .map(|&linear| (255.0 * srgb_from_linear(linear)).round() as u8)
        .collect()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_picture_is_what_the_renderer_makes() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer(TINY);
    let (image, display) = rendered(TINY, 0.0);
    assert!(image.scratches.iter().flatten().sum::<f32>() > 0.0);

    let path = folder.path().join("a.png");
    save_picture(&mut harness, &path);
    wait_exported(&mut harness);
    let right = png::quantize(&image.beauty(), &display);
    assert_eq!(codes_of(&path), right);
    let said = harness.state().messages().concat();
    assert!(said.contains("a.png"), "{said}");

    let path = folder.path().join("a.exr");
    save_picture(&mut harness, &path);
    wait_exported(&mut harness);
    // Bit for bit: the file holds the floats as they are, and bands of rows change none.
    assert_eq!(exr_file::read_image(&path).unwrap(), in_a_file(image));
    assert_eq!(names(folder.path()), ["a.exr", "a.png"]);
}

#[test]
fn a_picture_of_a_gpu_is_what_its_renderer_makes() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let text = (common::bare_disk().random("disk", 200))
        .with_lines("length_m = 0.05")
        .size_px([48, 32])
        .to_string();
    let options = Options {
        scene: None,
        built_in: text.clone().leak(),
        backend: Backend::Gpu(gpu.clone()),
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    };
    let mut harness = common::viewer_in(options, [760.0, 600.0], 0.25);
    // Else both would compile the same shaders, side by side.
    common::wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    let path = folder.path().join("a.exr");
    save_picture(&mut harness, &path);
    wait_exported(&mut harness);
    let found = exr_file::read_image(&path).unwrap();
    let scene = hairline_document::from_toml(&text, "test", "").unwrap();
    let options = hairline_gpu::RenderOptions {
        samples: SAMPLES,
        ..Default::default()
    };
    let right = headless::render(gpu, &scene, &Method::default(), &options, &|_| {}).unwrap();
    for layer in [Layer::Beauty, Layer::Scratches, Layer::Depth] {
        let difference = layer_difference(&found, &right, layer, None);
        // Tiles are those of a band, and segments that a pixel barely sees are added in another order.
        assert!(
            difference.relative_rms() < 1e-3,
            "{layer:?}: {difference:?}"
        );
        assert!(difference.reference_rms > 0.0);
    }
    assert_eq!(names(folder.path()), ["a.exr"]);
}

#[test]
fn a_turntable_goes_round() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer(TINY);
    export_turntable(&mut harness, &folder.path().join("t.exr"), 3);
    wait_exported(&mut harness);
    assert_eq!(
        names(folder.path()),
        ["t-0001.exr", "t-0002.exr", "t-0003.exr"]
    );
    for (i, name) in names(folder.path()).iter().enumerate() {
        let found = exr_file::read_image(&folder.path().join(name)).unwrap();
        let (expected, _) = rendered(TINY, 120.0 * i as f64);
        assert_eq!(found, in_a_file(expected), "{name}");
    }
    let (first, _) = rendered(TINY, 0.0);
    assert_ne!(first, rendered(TINY, 120.0).0, "the camera does turn");
}

/// The objects turn before the camera and under the lights, if nothing else is asked for.
#[test]
fn a_turntable_turns_the_objects() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer(TINY);
    common::click_on(&mut harness, "File");
    common::click_on(&mut harness, "Export a turntable…");
    type_path(&mut harness, &folder.path().join("t.exr"));
    harness
        .get_by_role_and_label(Role::SpinButton, "Pictures")
        .set_value_accesskit(3.0);
    harness.run_steps(3);
    common::click_on(&mut harness, "Export");
    wait_exported(&mut harness);
    for (i, name) in names(folder.path()).iter().enumerate() {
        let found = exr_file::read_image(&folder.path().join(name)).unwrap();
        let mut turned = Description::from_toml(TINY, Path::new("test")).unwrap();
        navigate::turn_surroundings(&mut turned, (120.0 * i as f64).to_radians());
        let scene = Loader::default().build(&turned, Path::new("")).unwrap();
        let options = RenderOptions {
            samples: SAMPLES,
            ..RenderOptions::default()
        };
        let right = closed_form::render(&scene, &options, &|_| {});
        assert_eq!(found, in_a_file(right), "{name}");
        assert_eq!(
            found == in_a_file(rendered(TINY, 120.0 * i as f64).0),
            i == 0
        );
    }
}

/// Beforehand: the time, and that nothing would be transparent.
#[test]
fn the_form_says_how_long_it_takes_and_where_nothing_is_transparent() {
    let mut harness = viewer(TINY);
    const FILLED: &str = "No pixel will be transparent";
    for (height_m, is_filled) in [(0.5, false), (0.1, true)] {
        let document = harness.state_mut().document_mut();
        document.edit("by the test", |d| {
            d.camera.position_m = [0.0, -0.001, height_m];
            d.camera.target_m = [0.0; 3];
        });
        common::wait_built(&mut harness);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
        harness.run_steps(3);
        common::wait_for_text(&mut harness, "It takes about");
        common::click_on(&mut harness, "Transparent background");
        common::wait_for_text(&mut harness, "It takes about");
        assert_eq!(harness.query_by_label_contains(FILLED).is_some(), is_filled);
        common::click_on(&mut harness, "Transparent background");
        assert!(harness.query_by_label_contains(FILLED).is_none());
        common::click_on(&mut harness, "Cancel");
        assert!(!harness.state().renderer().is_resting());
    }
}

/// Checks that there are only whole pictures, numbered without a gap; returns their number.
fn whole_pictures(folder: &Path) -> usize {
    let names = names(folder);
    for (i, name) in names.iter().enumerate() {
        assert_eq!(*name, format!("t-{:04}.png", i + 1), "{names:?}");
        assert_eq!(codes_of(&folder.join(name)).len(), 3 * 160 * 100);
    }
    names.len()
}

/// A turntable of which some pictures are done, and by far not all.
fn begun(folder: &Path) -> Harness<'static, Viewer> {
    let mut harness = viewer(MODEST);
    export_turntable(&mut harness, &folder.join("t.png"), 2000);
    let second: PathBuf = folder.join("t-0002.png");
    common::wait_until(&mut harness, "two pictures", |_| second.exists());
    assert!(harness.state().is_exporting());
    harness
}

#[test]
fn cancelling_leaves_whole_pictures_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = begun(folder.path());
    assert!(harness.state().renderer().is_resting());
    common::click_on(&mut harness, "Cancel the export");
    // The window answers before the thread has ended.
    assert!(!harness.state().is_exporting());
    assert!(harness.query_by_label("Cancel the export").is_none());
    common::wait_until(&mut harness, "the number of pictures", |viewer| {
        let written = whole_pictures(folder.path());
        assert!((2..2000).contains(&written));
        let count = format!("{written} of 2000 pictures are complete and stay");
        viewer.messages().concat().contains(&count)
    });
    assert!(!harness.state().renderer().is_resting());
}

#[test]
fn a_turntable_is_one_file_that_plays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turn.apng");
    let mut harness = viewer(TINY);
    export_turntable(&mut harness, &path, 3);
    wait_exported(&mut harness);
    assert_eq!(names(folder.path()), ["turn.apng"]);
    // acTL holds the number of frames.
    let bytes = std::fs::read(&path).unwrap();
    let at = bytes.windows(4).position(|it| it == b"acTL").unwrap();
    assert_eq!(bytes[at + 4..at + 8], 3_u32.to_be_bytes());
    // fcTL holds the time of a frame, behind five numbers of four bytes.
    let at = bytes.windows(4).position(|it| it == b"fcTL").unwrap();
    assert_eq!(bytes[at + 24..at + 28], [0, 1, 0, 30]);
    let first = png::read_picture(&path).unwrap();
    assert_eq!(first.size_px, [48, 32]);
    let said = harness.state().messages().concat();
    assert!(said.contains("turn.apng"), "{said}");
}

#[test]
fn closing_the_window_leaves_whole_pictures_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    drop(begun(folder.path()));
    let written = whole_pictures(folder.path());
    assert!((2..2000).contains(&written));
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(
        whole_pictures(folder.path()),
        written,
        "the thread has ended"
    );
}

#[test]
fn a_path_that_cannot_be_written_is_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "no folder").unwrap();
    let mut harness = viewer(TINY);
    for (path, word) in [
        ("missing/a.png", "there is no folder"),
        ("file/a.png", "file"),
        ("a.gif", ".png"),
    ] {
        save_picture(&mut harness, &folder.path().join(path));
        assert!(!harness.state().is_exporting(), "{path}");
        let said = harness.state().messages().concat();
        assert!(said.contains(word), "{path}: {said}");
        // The question stays, so that the path can be mended.
        common::click_on(&mut harness, "Cancel");
    }
    export_turntable(&mut harness, &folder.path().join("a.gif"), 3);
    let said = harness.state().messages().concat();
    assert!(
        said.contains("a.gif: end it in .png or .exr for numbered pictures"),
        "{said}"
    );
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn the_form_says_what_a_png_has() {
    let mut harness = viewer(TINY);
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| d.render.png_bits = 16);
    common::wait_built(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(3);
    let remark = "PNG: with the look of the window, 16 bits a channel.";
    assert!(harness.query_by_label_contains(remark).is_some());
}

#[test]
fn a_picture_that_cannot_be_written_ends_the_export_with_a_message() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("t-0003.exr")).unwrap();
    let mut harness = viewer(TINY);
    export_turntable(&mut harness, &folder.path().join("t.exr"), 5);
    wait_exported(&mut harness);
    let said = harness.state().messages().concat();
    assert!(said.contains("it is a folder"), "{said}");
    assert!(
        said.contains("2 of 5 pictures are complete and stay"),
        "{said}"
    );
    let right = ["t-0001.exr", "t-0002.exr", "t-0003.exr"];
    assert_eq!(names(folder.path()), right);
}

#[test]
fn the_scene_may_change_meanwhile() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer(TINY);
    export_turntable(&mut harness, &folder.path().join("t.exr"), 8);
    harness.run_steps(2);
    // A view from above differs from the export's camera.
    common::key(&mut harness, Key::Num5);
    wait_exported(&mut harness);
    let last = exr_file::read_image(&folder.path().join("t-0008.exr")).unwrap();
    assert_eq!(last, in_a_file(rendered(TINY, 7.0 * 45.0).0));
}

/// Alpha is the share of each pixel that the disk covers, and the free view is exported.
#[test]
fn a_transparent_picture_has_alpha_and_is_taken_from_where_the_window_looks() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer(TINY);
    common::key(&mut harness, egui::Key::Num5);
    let camera = harness.state().camera();
    assert_ne!(camera, common::description(&harness).camera);
    for (name, is_exr) in [("a.exr", true), ("a.png", false)] {
        let path = folder.path().join(name);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
        harness.run_steps(3);
        type_path(&mut harness, &path);
        if is_exr {
            common::click_on(&mut harness, "Transparent background");
        }
        common::click_on(&mut harness, "Save the picture");
        wait_exported(&mut harness);
        let bytes = std::fs::read(&path).unwrap();
        if is_exr {
            // The channel A of floats in the header.
            assert!(bytes.windows(6).any(|window| window == b"A\0\x02\0\0\0"));
            let mut description = Description::from_toml(TINY, Path::new("test")).unwrap();
            description.camera = camera.clone();
            let scene = Loader::default()
                .build(&description, Path::new(""))
                .unwrap();
            let options = RenderOptions {
                samples: SAMPLES,
                ..RenderOptions::default()
            };
            let image = closed_form::render(&scene, &options, &|_| {});
            let mut read = exr_file::read_image(&path).unwrap();
            let alpha = read.alpha.take().unwrap();
            let is_seen = |(share, depth_m): (&f32, &f32)| (*share > 0.0) == (*depth_m > 0.0);
            assert!(alpha.iter().zip(&read.depth_m).all(is_seen));
            assert_eq!(read, in_a_file(image));
        } else {
            assert_eq!(bytes[25], 6, "red, green, blue and alpha");
        }
    }
}

/// The question is asked once, and answered no by Escape and yes by the button; the next export asks
/// again.
#[test]
fn a_picture_that_is_there_is_replaced_only_after_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("done.png");
    std::fs::write(&path, "a finished picture").unwrap();
    let mut harness = viewer(TINY);
    for _ in 0..2 {
        let before = std::fs::read(&path).unwrap();
        save_picture(&mut harness, &path);
        assert!(!harness.state().is_exporting());
        harness.get_by_label_contains("done.png\" is there already");
        common::key(&mut harness, Key::Escape);
        assert!(harness.query_by_label("Replace the file").is_none());
        common::click_on(&mut harness, "Save the picture");
        assert_eq!(std::fs::read(&path).unwrap(), before);
        common::click_on(&mut harness, "Replace the file");
        wait_exported(&mut harness);
        assert_eq!(codes_of(&path).len(), 3 * 48 * 32);
    }
}

#[test]
fn pictures_of_a_turntable_that_are_there_are_counted_before_they_are_replaced() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["t-0002.png", "t-0003.png", "t-0007.png"] {
        std::fs::write(folder.path().join(name), "a finished picture").unwrap();
    }
    let mut harness = viewer(TINY);
    export_turntable(&mut harness, &folder.path().join("t.png"), 3);
    assert!(!harness.state().is_exporting());
    harness.get_by_label_contains("2 of 3 pictures are there already");
    common::click_on(&mut harness, "Replace the pictures");
    wait_exported(&mut harness);
    assert_eq!(
        codes_of(&folder.path().join("t-0003.png")).len(),
        3 * 48 * 32
    );
}

/// A lens takes the given number of samples, and the dialog says how few of them look.
#[test]
fn a_lens_has_the_samples_that_were_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer(TINY);
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| d.camera.aperture_mm = Some(5.0));
    common::wait_built(&mut harness);
    let path = folder.path().join("a.exr");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(3);
    let samples = |harness: &Harness<'static, Viewer>| {
        let node = harness.get_by_role_and_label(Role::SpinButton, "Samples");
        node.accesskit_node().numeric_value()
    };
    assert_eq!(samples(&harness), Some(64.0), "enough for a smooth blur");
    harness
        .get_by_role_and_label(Role::SpinButton, "Samples")
        .set_value_accesskit(4.0);
    harness.run_steps(3);
    harness.get_by_label_contains("4 samples look through 1 point of the lens");
    type_path(&mut harness, &path);
    common::click_on(&mut harness, "Save the picture");
    wait_exported(&mut harness);
    let description = common::description(&harness);
    let scene = Loader::default()
        .build(&description, Path::new(""))
        .unwrap();
    let options = RenderOptions {
        samples: 4,
        ..RenderOptions::default()
    };
    let right = closed_form::render(&scene, &options, &|_| {});
    let found = exr_file::read_image(&path).unwrap();
    let difference = layer_difference(&found, &right, Layer::Beauty, None);
    assert!(difference.relative_rms() < 1e-3, "{difference:?}");
}
