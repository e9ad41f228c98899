//! Pictures without threads are the same, and no slice of a finer one holds the interface up.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use glam::DVec3;
use hairline_document::Description;
use hairline_fixtures::scenes::oblique_plate;
use hairline_image::{Display, ToneMap};
use hairline_scene::{Camera, Lens, Transport};
use web_time::Instant;

use super::super::{Backend, Frame, Picture, ProgressiveRenderer, Region, SHADOW_SAMPLES, View};

/// A loaded machine is slow.
const PATIENCE: Duration = Duration::from_secs(600);

fn description() -> Arc<Description> {
    Arc::new(
        oblique_plate(300, 0.01)
            .with_lines("width_um = { mean = 4.0, spread = 0.1 }")
            .fov_y_deg(40.0)
            .description(),
    )
}

fn view() -> View {
    View {
        reading: Default::default(),
        region: None,
        camera: Camera {
            position_m: DVec3::new(0.0, -0.21, 0.18),
            target_m: DVec3::ZERO,
            up: DVec3::Z,
            fov_y_rad: 0.7,
            shift_tan: Default::default(),
            exposure_ev: 0.0,
            lens: Lens::default(),
        },
        size_px: [160, 90],
        display: Display {
            exposure_ev: 0.0,
            tone_map: ToneMap::default(),
        },
        filter_std_px: 0.5,
        transport: Transport::DIRECT,
    }
}

/// Lets the progressive renderer work until its picture is the last one. Never waits where it says that there is nothing to do.
fn last_picture(renderer: &mut ProgressiveRenderer) -> Arc<Frame> {
    let start = Instant::now();
    loop {
        assert!(start.elapsed() < PATIENCE, "no picture came");
        let pause = renderer.work();
        if let Some(frame) = renderer.latest()
            && frame.painted.is_final
        {
            return frame;
        }
        std::thread::sleep(pause.unwrap_or(Duration::from_millis(1)));
    }
}

fn pixels(frame: &Frame) -> Vec<egui::Color32> {
    match &frame.picture {
        Picture::Pixels(image) => image.pixels.clone(),
        Picture::Texture(_) => panic!("the CPU renders no texture"),
    }
}

fn wanted(renderer: &ProgressiveRenderer) {
    renderer.set_scene(1, description(), PathBuf::new());
    renderer.set_view(view());
}

#[test]
fn it_paints_what_the_threads_paint() {
    let mut in_turn = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
    wanted(&in_turn);
    let ours = pixels(&last_picture(&mut in_turn));
    let mut threads = ProgressiveRenderer::start(Backend::Cpu, Arc::new(|| {}));
    wanted(&threads);
    let theirs = pixels(&last_picture(&mut threads));
    assert!(ours == theirs, "other pixels");
    let lit = ours.iter().filter(|pixel| pixel.g() > 100).count();
    assert!(lit > 20, "{lit} pixels are bright");
}

#[test]
fn a_finer_picture_comes_in_slices() {
    let mut renderer = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
    renderer.set_scene(1, description(), PathBuf::new());
    renderer.set_view(View {
        size_px: [1280, 720],
        ..view()
    });
    let start = Instant::now();
    let mut slices = 0;
    while renderer
        .latest()
        .is_none_or(|frame| !frame.painted.is_final)
    {
        assert!(start.elapsed() < PATIENCE, "no picture came");
        let pause = renderer.work();
        slices += 1;
        std::thread::sleep(pause.unwrap_or_default());
    }
    // A scene, a coarse picture and four finer ones would be 6, were they painted in one piece each.
    assert!(slices > 7, "{slices} slices");
    assert_eq!(renderer.work(), None);
}

#[test]
fn a_new_view_takes_the_place_of_what_is_being_refined() {
    let mut renderer = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
    wanted(&renderer);
    let still = pixels(&last_picture(&mut renderer));
    let mut moved = view();
    moved.camera.position_m.x += 0.05;
    renderer.set_view(moved);
    // Begun, not done.
    renderer.work();
    renderer.set_view(view());
    let back = last_picture(&mut renderer);
    assert_eq!(back.view.camera, view().camera);
    assert!(
        pixels(&back) == still,
        "what was begun from elsewhere is in it"
    );
}

#[test]
fn a_scene_that_is_forgotten_in_the_middle_of_its_picture_is_followed_by_the_next() {
    let mut renderer = ProgressiveRenderer::start(Backend::Cpu, Arc::new(|| {}));
    renderer.set_scene(1, description(), PathBuf::new());
    renderer.set_view(View {
        size_px: [1280, 720],
        ..view()
    });
    let first = wait_for(&mut renderer, ProgressiveRenderer::latest);
    assert!(!first.painted.is_final, "it has no middle");
    renderer.forget_scene();
    // The next one takes long to build.
    std::thread::sleep(Duration::from_millis(500));
    renderer.set_scene(2, description(), PathBuf::new());
    let next = wait_for(&mut renderer, ProgressiveRenderer::latest);
    assert_eq!(next.built.revision, 2);
}

/// A view so large that a slice is not enough for all of it after a region.
fn wide_view() -> View {
    View {
        size_px: [640, 360],
        ..view()
    }
}

/// A part of the picture with an edge of the plate.
const PART: Region = Region {
    first_px: [60, 24],
    size_px: [50, 30],
};
/// The same of the wide picture.
const WIDE_PART: Region = Region {
    first_px: [240, 96],
    size_px: [200, 120],
};

/// Works until something is there.
fn wait_for<T>(
    renderer: &mut ProgressiveRenderer,
    what: impl Fn(&ProgressiveRenderer) -> Option<T>,
) -> T {
    let start = Instant::now();
    loop {
        assert!(start.elapsed() < PATIENCE, "it did not come");
        let pause = renderer.work();
        if let Some(there) = what(renderer) {
            return there;
        }
        std::thread::sleep(pause.unwrap_or(Duration::from_millis(1)));
    }
}

#[test]
fn a_region_is_finished_before_the_rest_begins() {
    let mut renderer = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
    renderer.set_scene(1, description(), PathBuf::new());
    let shadowed = View {
        transport: Transport {
            shadows: true,
            bounces: 0,
        },
        size_px: [320, 180],
        ..view()
    };
    renderer.set_view(View {
        region: Some(PART),
        ..shadowed
    });
    let part = wait_for(&mut renderer, |renderer| {
        renderer
            .region()
            .filter(|part| part.painted.samples == SHADOW_SAMPLES)
    });
    assert_eq!(part.painted.size_px, PART.size_px);
    let whole = renderer.latest().unwrap();
    assert!(whole.painted.of_samples.is_none(), "{:?}", whole.painted);
    // The rest follows, and then there is one picture.
    let whole = last_picture(&mut renderer);
    assert_eq!(whole.painted.samples, SHADOW_SAMPLES);
    assert!(renderer.region().is_none());
    assert_eq!(renderer.work(), None);
}

#[test]
fn a_region_shows_what_the_whole_picture_has_there() {
    let mut renderer = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
    renderer.set_scene(1, description(), PathBuf::new());
    renderer.set_view(View {
        region: Some(WIDE_PART),
        ..wide_view()
    });
    let part = wait_for(&mut renderer, |renderer| {
        renderer.region().filter(|part| part.painted.samples > 1)
    });
    let whole = pixels(&last_picture(&mut renderer));
    let [x, y] = WIDE_PART.first_px.map(|px| px as usize);
    let [width, height] = WIDE_PART.size_px.map(|px| px as usize);
    let there = (y..y + height).flat_map(|y| whole[y * 640 + x..][..width].to_vec());
    let off = std::iter::zip(there, pixels(&part)).map(|(a, b)| u32::from(a.g().abs_diff(b.g())));
    let mean = f64::from(off.sum::<u32>()) / (width * height) as f64;
    // Samples on edges are others.
    assert!(mean < 2.0, "{mean} codes off");
}

#[test]
fn a_region_that_is_drawn_or_given_up_between_two_pictures_ends_in_the_same_picture() {
    let mut renderer = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
    renderer.set_scene(1, description(), PathBuf::new());
    renderer.set_view(wide_view());
    let alone = pixels(&last_picture(&mut renderer));
    for region in [Some(WIDE_PART), None] {
        let mut moved = wide_view();
        moved.camera.position_m.x += 0.05;
        renderer.set_view(moved);
        wait_for(&mut renderer, |renderer| {
            renderer
                .latest()
                .filter(|frame| frame.view.camera == moved.camera)
        });
        renderer.set_view(View {
            region: Some(WIDE_PART),
            ..wide_view()
        });
        wait_for(&mut renderer, ProgressiveRenderer::region);
        renderer.set_view(View {
            region,
            ..wide_view()
        });
        assert!(pixels(&last_picture(&mut renderer)) == alone, "{region:?}");
    }
}

#[test]
fn a_pause_leaves_the_first_picture_until_it_ends() {
    let mut renderer = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
    renderer.set_paused(true);
    renderer.set_scene(1, description(), PathBuf::new());
    renderer.set_view(wide_view());
    let first = wait_for(&mut renderer, ProgressiveRenderer::latest);
    assert!(!first.painted.is_final);
    for _ in 0..50 {
        renderer.work();
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(renderer.latest().unwrap().number, first.number);
    renderer.set_paused(false);
    assert!(last_picture(&mut renderer).painted.is_final);
}
