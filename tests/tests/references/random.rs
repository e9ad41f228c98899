//! Random scenes of one body against the reference: the middles of a few of those that `cargo lab random` judges.

use super::pictures::sampled;
use conformance::middle_of;
use conformance::random::{judge, scene_file};
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_image::Layers;
use hairline_reference::Settings;

#[test]
fn random_scenes_are_right() {
    // Disks of a dielectric and of metal, one of them scratched. `cargo lab random` lists others, of which an eighth are off (docs/accuracy.md).
    let seeds = [5002, 5007, 5009, 5011];
    let is_off = |seed: &u64| {
        let file = scene_file(*seed, [96, 54]);
        let scene = hairline_document::from_toml(&file, "random", ".")
            .unwrap_or_else(|e| panic!("{e}\n{file}"));
        let scene = middle_of(scene, 96, [30, 21]);
        let right = sampled(&scene, Settings::default(), 2);
        let found = closed_form::render(&scene, &RenderOptions::default(), &|_| {});
        let layers = judge(&Layers::from(&found), &Layers::from(&right));
        println!("{seed}: {layers:?}");
        layers.iter().any(|layer| layer.severity() > 1.0)
    };
    let off: Vec<u64> = seeds.into_iter().filter(is_off).collect();
    assert!(off.is_empty(), "{off:?}");
}
