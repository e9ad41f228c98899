//! Many scratches, each one or added up: chosen in the panel, kept in the scene, and what the window, the comparison's picture and
//! the export then show.

use std::path::Path;
use std::sync::Arc;

use crate::common::{self, description, viewer_of, wait_until};
use egui::accesskit::Role;
use egui::{Color32, Key, Modifiers};
use egui_kittest::{Harness, kittest::Queryable};
use hairline_editor::Selection;
use hairline_gpu::headless;
use hairline_image::metrics::layer_difference;
use hairline_image::{Image, Layer, exr_file, png};
use hairline_optics::method::{Gather, Method};
use hairline_reference::closed_form::{self, RenderOptions};
use hairline_scene::Scene;
use hairline_viewer::engine::{Backend, Frame, Picture};
use hairline_viewer::{Options, Viewer};

/// A disk of scratches from so far away that its pixels are wider than the finest cells, of 8 mm. The scratches are all alike, so that the
/// grids are soon built.
const FAR: &str = r#"
[camera]
position_m = [0.0, -4.0, 4.0]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 30.0

[render]
size_px = [160, 100]
filter_std_px = 2.0

[[material]]
name = "steel"
kind = "metal"
metal = "steel"
roughness = 0.3

[[object]]
name = "disk"
shape = { disk = { radius_m = 0.08 } }
material = "steel"

[[scratches]]
object = "disk"
pattern = "random"
count = 3000
length_m = 0.02
width_um = 4.0
depth_nm = 200.0

[[light]]
kind = "sphere"
center_m = [0.2, 1.4, 1.8]
radius_m = 0.1
radiance = 60.0
"#;

/// Of an exported picture.
const SAMPLES: u32 = 16;

fn opened(backend: Backend) -> Harness<'static, Viewer> {
    let options = Options {
        scene: None,
        built_in: FAR,
        backend,
        state_dir: None,
        native_dialogs: false,
    };
    // No larger than its panels need: software drivers paint every pixel many times.
    let mut harness = viewer_of(options, [800.0, 440.0]);
    common::wait_built(&mut harness);
    harness.state_mut().document_mut().select(Selection::Render);
    harness.run_steps(3);
    harness
}

fn choose(harness: &mut Harness<'static, Viewer>, option: &str) {
    harness
        .get_by_role_and_label(Role::ComboBox, "Many scratches")
        .click();
    harness.run_steps(3);
    harness.get_by_label(option).click();
    harness.run_steps(3);
}

/// The last picture of the document as it is now, which gathers so. It is waited for: the painter may still show an older one when the
/// newest description has been built.
fn last_frame(harness: &mut Harness<'static, Viewer>, gather: Gather) -> Arc<Frame> {
    wait_until(harness, "the final picture", |viewer| {
        let newest = viewer.document().revision();
        let latest = viewer.engine().latest();
        latest.is_some_and(|frame| frame.painted.is_final && frame.built.revision == newest)
    });
    let frame = harness.state().engine().latest().unwrap();
    assert_eq!(frame.built.scene.render.gather, gather);
    frame
}

fn pixels(frame: &Frame) -> Vec<Color32> {
    match &frame.picture {
        Picture::Pixels(image) => image.pixels.clone(),
        Picture::Texture(_) => panic!("a window's own device has no part in this"),
    }
}

/// What the CPU renderer makes of what a frame shows.
fn rendered(frame: &Frame, gather: Gather) -> Vec<Color32> {
    let mut scene = frame.built.scene.clone();
    scene.camera = frame.view.camera;
    scene.render.size_px = frame.view.size_px;
    scene.render.filter_std_px = frame.view.filter_std_px;
    let image = closed_form::render(&scene, &options(gather), &|_| {});
    let codes = png::quantize(&image.beauty(), &frame.view.display);
    let colors = codes.chunks_exact(3);
    colors
        .map(|rgb| Color32::from_rgb(rgb[0], rgb[1], rgb[2]))
        .collect()
}

fn options(gather: Gather) -> RenderOptions {
    RenderOptions {
        samples: SAMPLES,
        method: method(gather),
    }
}

fn method(gather: Gather) -> Method {
    Method {
        gather,
        ..Method::fastest()
    }
}

fn exported(harness: &mut Harness<'static, Viewer>, path: &Path) -> Image {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::TextInput, "File")
        .set_text_value_accesskit(&path.display().to_string());
    harness.run_steps(3);
    common::click_on(harness, "Save the picture");
    wait_until(harness, "the export ends", |viewer| !viewer.is_exporting());
    exr_file::read_image(path).unwrap()
}

#[test]
fn it_is_a_step_and_part_of_the_scene() {
    let mut harness = opened(Backend::Cpu);
    assert_eq!(description(&harness).render.gather, Gather::Exact);
    choose(&mut harness, "added up");
    let added_up = description(&harness);
    assert_eq!(added_up.render.gather, Gather::Clusters);
    let text = added_up.to_toml().unwrap();
    assert!(text.contains("gather = \"clusters\""), "{text}");
    common::undo(&mut harness);
    assert_eq!(description(&harness).render.gather, Gather::Exact);
    choose(&mut harness, "added up");
    choose(&mut harness, "each one");
    assert_eq!(description(&harness).render.gather, Gather::Exact);
}

#[test]
fn the_cpus_pictures_follow_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = opened(Backend::Cpu);
    let exact = last_frame(&mut harness, Gather::Exact);
    choose(&mut harness, "added up");
    let added_up = last_frame(&mut harness, Gather::Clusters);
    // Nothing is laid or sorted anew for it.
    assert!(Arc::ptr_eq(
        &exact.built.scratches,
        &added_up.built.scratches
    ));
    assert!(pixels(&exact) == rendered(&exact, Gather::Exact));
    assert!(pixels(&added_up) == rendered(&added_up, Gather::Clusters));
    assert!(pixels(&added_up) != pixels(&exact), "grids are not in use");

    let scene = Scene::from_toml(FAR, "test", "").unwrap();
    let found = exported(&mut harness, &folder.path().join("added up.exr"));
    let right = |gather| closed_form::render(&scene, &options(gather), &|_| {});
    assert_eq!(found, right(Gather::Clusters));
    assert_ne!(found, right(Gather::Exact));

    choose(&mut harness, "each one");
    let again = last_frame(&mut harness, Gather::Exact);
    assert!(pixels(&again) == pixels(&exact));
}

#[test]
fn a_gpus_pictures_follow_it() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut harness = opened(Backend::Gpu(gpu.clone()));
    let exact = last_frame(&mut harness, Gather::Exact);
    choose(&mut harness, "added up");
    let added_up = last_frame(&mut harness, Gather::Clusters);
    assert!(pixels(&added_up) != pixels(&exact), "grids are not in use");

    let scene = Scene::from_toml(FAR, "test", "").unwrap();
    let found = exported(&mut harness, &folder.path().join("added up.exr"));
    let off = |gather| {
        let options = hairline_gpu::RenderOptions {
            samples: SAMPLES,
            ..Default::default()
        };
        let right = headless::render(gpu, &scene, &method(gather), &options, &|_| {}).unwrap();
        layer_difference(&found, &right, Layer::Scratches, None).relative_rms()
    };
    // Bands have tiles of their own, in which scratches are added in another order.
    assert!(off(Gather::Clusters) < 1e-3, "{}", off(Gather::Clusters));
    assert!(off(Gather::Exact) > 1e-2, "{}", off(Gather::Exact));
}

#[test]
fn an_edit_makes_new_grids_and_nothing_else_does() {
    let mut harness = opened(Backend::Cpu);
    choose(&mut harness, "added up");
    let first = last_frame(&mut harness, Gather::Clusters);
    let edit = |harness: &mut Harness<'static, Viewer>,
                change: fn(&mut hairline_scene::Description)| {
        harness
            .state_mut()
            .document_mut()
            .edit("by the test", change);
        harness.run_steps(2);
        let revision = harness.state().document().revision();
        wait_until(harness, "the scene is built", |viewer| {
            let built = viewer.engine().built();
            built.is_some_and(|built| built.revision == revision)
        });
        let built = harness.state().engine().built().unwrap();
        built.bundles().unwrap()
    };
    let before = first.built.bundles().unwrap();
    let light = edit(&mut harness, |d| d.lights[0].radiance *= 0.5);
    assert!(Arc::ptr_eq(&before, &light));
    let metal = edit(&mut harness, |d| d.materials[0].roughness = 0.2);
    assert!(!Arc::ptr_eq(&before, &metal), "spectra are the material's");
    let seed = edit(&mut harness, |d| {
        *d.scratches[0].layer.seed_mut().unwrap() += 1;
    });
    assert!(!Arc::ptr_eq(&metal, &seed));
    let frame = last_frame(&mut harness, Gather::Clusters);
    assert!(frame.built.revision > first.built.revision);
}
