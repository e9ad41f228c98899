//! One of the scenes of `cargo lab unbiased`, in fewer pixels: noise explains how far few rays are from the path tracer, and not what a
//! wrong light or a missing object makes.

use conformance::unbiased::{
    LAYERS, SCENES, brighter, expected, interior_mask, layer_error, rendered, scene,
    without_objects,
};
use hairline_image::Image;
use hairline_image::metrics::Verdict;
use hairline_render::Backend;
use hairline_scene::{Scene, Transport};

fn picture(scene: &Scene, samples: u32, transport: Transport) -> Image {
    rendered(scene, Backend::Cpu, samples, transport).unwrap_or_else(|error| panic!("{error}"))
}

fn small(mut scene: Scene) -> Scene {
    scene.render.size_px = scene.render.size_px.map(|side| side / 2);
    scene
}

#[test]
fn noise_explains_what_few_rays_differ_by_and_no_fault() {
    check(&[64, 512], 256);
}

#[test]
#[ignore = "long: cargo long"]
fn noise_explains_what_few_rays_differ_by_from_a_better_reference() {
    check(&[64, 128, 512], 512);
}

/// Checks pictures by some numbers of rays, the fewest first and eight times as many last, against so many samples of the path tracer.
fn check(numbers: &[u32], reference: u32) {
    for (name, bounces) in [("edge", 0)] {
        let right = small(scene(name));
        let shadows = Transport {
            shadows: true,
            bounces,
        };
        let open = picture(&right, 256, Transport::DIRECT);
        let expected = expected(&right, &open, bounces, reference);
        let of_number = |samples: &u32| picture(&right, *samples, shadows);
        let images: Vec<Image> = numbers.iter().map(of_number).collect();
        let bright = picture(&small(brighter(name, 0.03)), numbers[0], shadows);
        let occluders = SCENES
            .iter()
            .find(|(n, _)| *n == name)
            .map_or(&[][..], |it| it.1);
        let bare = picture(
            &without_objects(right.clone(), occluders),
            numbers[0],
            shadows,
        );
        let inside = interior_mask(&right);
        for layer in LAYERS {
            let of = |image| layer_error(image, &expected, &open, layer, &inside);
            for (samples, image) in numbers.iter().zip(&images) {
                let found = of(image);
                println!("{name}, {bounces}, {}, {samples}: {found:?}", layer.name());
                assert_ne!(found.z.verdict, Verdict::MoreThanNoise, "{name}");
                assert!(found.off.abs() < 4.0 * found.off_std, "{name}");
            }
            // A quarter, or less.
            let [few, many] = [0, images.len() - 1].map(|i| of(&images[i]).rms);
            assert!(many < 0.45 * few, "{name}: {few} {many}");
            let bright = of(&bright);
            println!("{name}, too bright, {}: {bright:?}", layer.name());
            assert_eq!(bright.z.verdict, Verdict::MoreThanNoise, "{name}");
            if !occluders.is_empty() {
                assert_eq!(of(&bare).z.verdict, Verdict::MoreThanNoise, "{name}");
            }
        }
    }
}
