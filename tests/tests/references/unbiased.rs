//! One of the scenes of `cargo lab unbiased`, in fewer pixels: noise explains how far few rays are from the path tracer, and not what a
//! wrong light or a missing object makes.

use conformance::unbiased::{
    LAYERS, SCENES, brighter, expected, found, inside, rendered, scene, without,
};
use hairline_image::Image;
use hairline_image::metrics::Verdict;
use hairline_scene::{Scene, Transport};
use hairline_work::backend::Backend;

const SAMPLES: [u32; 2] = [64, 512];

fn picture(scene: &Scene, samples: u32, transport: Transport) -> Image {
    rendered(scene, Backend::Cpu, samples, transport).unwrap_or_else(|error| panic!("{error}"))
}

fn small(mut scene: Scene) -> Scene {
    scene.render.size_px = scene.render.size_px.map(|side| side / 2);
    scene
}

#[test]
fn noise_explains_what_few_rays_differ_by_and_no_fault() {
    for (name, bounces) in [("edge", 0)] {
        let right = small(scene(name));
        let shadows = Transport {
            shadows: true,
            bounces,
        };
        let open = picture(&right, 256, Transport::DIRECT);
        let expected = expected(&right, &open, bounces, 256);
        let images = SAMPLES.map(|samples| picture(&right, samples, shadows));
        let bright = picture(&small(brighter(name, 0.03)), SAMPLES[0], shadows);
        let occluders = SCENES
            .iter()
            .find(|(n, _)| *n == name)
            .map_or(&[][..], |it| it.1);
        let bare = picture(&without(right.clone(), occluders), SAMPLES[0], shadows);
        let inside = inside(&right);
        for layer in LAYERS {
            let of = |image| found(image, &expected, &open, layer, &inside);
            for (samples, image) in SAMPLES.iter().zip(&images) {
                let found = of(image);
                println!("{name}, {bounces}, {}, {samples}: {found:?}", layer.name());
                assert_ne!(found.z.verdict, Verdict::MoreThanNoise, "{name}");
                assert!(found.off.abs() < 4.0 * found.off_std, "{name}");
            }
            // A quarter, or less.
            let [few, many] = images.each_ref().map(|image| of(image).rms);
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
