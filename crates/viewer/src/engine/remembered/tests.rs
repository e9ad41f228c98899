//! Tests that detail, shadows and reflections of a remembered picture bring a picture of another view
//! nearer to its final state.

use std::path::Path;

use glam::DQuat;
use hairline_fixtures::scenes::oblique_plate;
use hairline_fixtures::{DISK, SceneFile};
use hairline_image::{Display, ToneMap};
use hairline_scene::{Camera, DEFAULT_TRANSPORT, Transport};
use web_time::Instant;

use super::super::View;
use super::super::bands::render;
use super::super::build::ViewBuilder;
use super::*;

const FULL_PX: [u32; 2] = [240, 160];

/// A matt plate with scratches and a ball on it, under two lamps, one of them of this radiance.
fn built(builder: &mut ViewBuilder, radiance: f64) -> Arc<Built> {
    with_scratches(builder, radiance, 2000)
}

fn with_scratches(builder: &mut ViewBuilder, radiance: f64, scratches: u32) -> Arc<Built> {
    let description = SceneFile::seen_from([0.0, -0.21, 0.18])
        .metal("steel", "steel")
        .part("[[material]]\nname = \"white\"\nkind = \"dielectric\"")
        .with("ior = 1.5\nroughness = 0.3\nbase_color = [0.6, 0.6, 0.6]")
        .object("plate", "white", DISK)
        .object("ball", "steel", "sphere = { radius_m = 0.03 }")
        .with("translation_m = [0.02, 0.0, 0.03]")
        .random("plate", scratches)
        .sphere([-0.065, 0.20, 0.24], 0.01, 300.0)
        .sphere([0.1, -0.05, 0.2], 0.01, radiance)
        .fov_y_deg(40.0)
        .description();
    let built = builder.build(
        &|| false,
        1,
        Instant::now(),
        Arc::new(description),
        Path::new(""),
    );
    Arc::new(built.unwrap().unwrap())
}

/// Order for the scene's own camera, turned about its target.
fn order(built: &Arc<Built>, degrees: f64) -> Order {
    let camera = built.scene.camera;
    let turn = DQuat::from_axis_angle(camera.up, degrees.to_radians());
    Order {
        built: Arc::clone(built),
        view: View {
            camera: Camera {
                position_m: camera.target_m + turn * (camera.position_m - camera.target_m),
                ..camera
            },
            size_px: FULL_PX,
            display: Display {
                exposure_ev: 0.0,
                tone_map: ToneMap::default(),
            },
            filter_std_px: 0.5,
            transport: DEFAULT_TRANSPORT,
            reading: Default::default(),
        },
    }
}

fn picture(order: &Order, size_px: [u32; 2], transport: Transport) -> Image {
    let mut scene = order.built.scene.clone();
    scene.camera = order.view.camera;
    scene.render.size_px = size_px;
    render(&order.built, &scene, 4, transport, None, 1 << 14, &|_| true).unwrap()
}

/// Mean difference of the shown light, limited to 1 so that a bright highlight does not outweigh the
/// rest.
fn error(a: &Image, b: &Image) -> f64 {
    let shown = |it: &Image, i: usize| {
        (Vec3::from(it.base[i]) + Vec3::from(it.scratches[i])).min(Vec3::ONE)
    };
    let sum: f32 = (0..a.pixel_count())
        .map(|i| (shown(a, i) - shown(b, i)).abs().element_sum())
        .sum();
    f64::from(sum) / a.pixel_count() as f64
}

/// Enlarges a picture: each pixel becomes `times` x `times` pixels.
fn enlarged(image: &Image, times: u32) -> Image {
    let size_px = image.size_px.map(|side| side * times);
    let mut large = Image::new(size_px);
    for i in 0..large.pixel_count() {
        let (x, y) = (i as u32 % size_px[0] / times, i as u32 / size_px[0] / times);
        let from = (y * image.size_px[0] + x) as usize;
        large.base[i] = image.base[from];
        large.scratches[i] = image.scratches[from];
    }
    large
}

fn remembered(order: &Order) -> Remembered {
    let mut shown = picture(order, FULL_PX, order.view.transport);
    let open = shown.open().unwrap();
    hairline_image::filter_found(&mut shown);
    Remembered::new(order, &open, Some(&shown))
}

#[test]
fn a_coarse_picture_becomes_sharp_and_has_shadows() {
    let built = built(&mut ViewBuilder::default(), 60.0);
    let before = remembered(&order(&built, 0.0));
    let now = order(&built, 4.0);
    let coarse = picture(&now, FULL_PX.map(|side| side / 8), Transport::DIRECT);
    let truth = picture(&now, FULL_PX, now.view.transport);
    let sharp = before.sharpen(&coarse, &now).unwrap();
    assert_eq!(sharp.size_px, FULL_PX);
    let (coarse, sharp) = (error(&enlarged(&coarse, 8), &truth), error(&sharp, &truth));
    assert!(sharp < 0.5 * coarse, "{sharp}, coarse {coarse}");
}

#[test]
fn closed_forms_get_the_shadows_of_another_view() {
    let built = built(&mut ViewBuilder::default(), 60.0);
    let before = remembered(&order(&built, 0.0));
    let now = order(&built, 4.0);
    let open = picture(&now, FULL_PX, Transport::DIRECT);
    let truth = picture(&now, FULL_PX, now.view.transport);
    let shaded = before.shade(&open, &now).unwrap();
    let (open, shaded) = (error(&open, &truth), error(&shaded, &truth));
    assert!(shaded < 0.4 * open, "{shaded}, without {open}");
}

#[test]
fn other_light_has_detail_and_no_shadows() {
    let mut builder = ViewBuilder::default();
    let first = built(&mut builder, 60.0);
    let before = remembered(&order(&first, 0.0));
    let brighter = order(&built(&mut builder, 120.0), 0.0);
    assert!(before.is_of(&brighter));
    let open = picture(&brighter, FULL_PX, Transport::DIRECT);
    assert!(before.shade(&open, &brighter).is_none());
    let coarse = picture(&brighter, FULL_PX.map(|side| side / 8), Transport::DIRECT);
    let sharp = before.sharpen(&coarse, &brighter).unwrap();
    let (coarse, sharp) = (error(&enlarged(&coarse, 8), &open), error(&sharp, &open));
    assert!(sharp < 0.6 * coarse, "{sharp}, coarse {coarse}");
}

#[test]
fn other_scratches_lie_on_sharp_surfaces() {
    let mut builder = ViewBuilder::default();
    let before = remembered(&order(&built(&mut builder, 60.0), 0.0));
    let fewer = order(&with_scratches(&mut builder, 60.0, 20), 0.0);
    assert!(before.is_of(&fewer));
    let open = picture(&fewer, FULL_PX, Transport::DIRECT);
    let coarse = picture(&fewer, FULL_PX.map(|side| side / 8), Transport::DIRECT);
    let sharp = before.sharpen(&coarse, &fewer).unwrap();
    let (coarse, sharp) = (error(&enlarged(&coarse, 8), &open), error(&sharp, &open));
    assert!(sharp < 0.6 * coarse, "{sharp}, coarse {coarse}");
}

#[test]
fn a_scene_with_other_surfaces_has_nothing_of_it() {
    let mut builder = ViewBuilder::default();
    let before = remembered(&order(&built(&mut builder, 60.0), 0.0));
    let other = oblique_plate(2000, 0.01).description();
    let other = builder.build(&|| false, 2, Instant::now(), Arc::new(other), Path::new(""));
    let other = Arc::new(other.unwrap().unwrap());
    assert!(!before.is_of(&order(&other, 0.0)));
}

#[test]
fn from_the_same_place_each_pixel_is_itself() {
    let built = built(&mut ViewBuilder::default(), 60.0);
    let order = order(&built, 0.0);
    let open = picture(&order, FULL_PX, Transport::DIRECT);
    let kept = Remembered::new(&order, &open, None);
    let warp = Warp::new(&kept.places, &kept.camera, &kept.camera);
    assert!(warp.pixels.iter().enumerate().all(|(i, pixel)| i == *pixel));
}

#[test]
fn what_was_black_becomes_as_bright_as_the_difference() {
    let grey = Vec3::splat;
    assert_eq!(changed(grey(0.2), grey(1e-9), grey(0.5)), grey(0.7));
    assert_eq!(changed(grey(0.2), grey(1.0), grey(0.5)), grey(0.1));
    assert_eq!(changed(grey(0.2), grey(0.0), grey(0.0)), grey(0.2));
    assert!(changed(Vec3::NEG_ONE, Vec3::NEG_ONE, Vec3::ZERO).is_finite());
}
