//! Random scenes of one body against the reference: a few small ones of those that `cargo lab random` judges.

use super::pictures::sampled;
use conformance::random::{judge, scene_file};
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_image::Layers;
use hairline_reference::Settings;
use hairline_scene::Scene;

#[test]
fn random_scenes_are_right() {
    for seed in 5000..5012 {
        let file = scene_file(seed, [33, 21]);
        let scene =
            Scene::from_toml(&file, "random", ".").unwrap_or_else(|e| panic!("{e}\n{file}"));
        let right = sampled(&scene, Settings::default(), 2);
        let found = closed_form::render(&scene, &RenderOptions::default(), &|_| {});
        for layer in judge(&Layers::from(&found), &Layers::from(&right)) {
            println!("{seed}: {layer:?}");
            assert!(layer.off() <= 1.0, "{seed}: {layer:?}\n{file}");
        }
    }
}
