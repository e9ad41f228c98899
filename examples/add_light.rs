//! Adds a light to a scene that was loaded, and says how much brighter its scratches are: `cargo run --release --example add_light [SCENE]`.

use glam::DVec3;
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_scene::{Light, Scene};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1);
    let mut scene = hairline_document::load(file.unwrap_or("scenes/plate.toml".into()))?;
    scene.render.size_px = [160, 90];
    let before = mean_of_scratches(&scene);

    // Vertices are counter-clockwise as seen from the side that shines.
    scene.lights.push(Light::polygon(
        vec![
            DVec3::new(-0.3, 0.2, 0.3),
            DVec3::new(0.3, 0.2, 0.3),
            DVec3::new(0.3, 0.1, 0.4),
            DVec3::new(-0.3, 0.1, 0.4),
        ],
        [20.0, 18.0, 15.0],
        true,
    ));
    let after = mean_of_scratches(&scene);
    println!("mean radiance of the scratches: {before:.4?} before, {after:.4?} after");
    Ok(())
}

/// The mean over the layer that the scratches alone make.
fn mean_of_scratches(scene: &Scene) -> [f32; 3] {
    let image = Prepared::new(scene).render(&RenderOptions::default(), &|_| {});
    let count = image.scratches.len() as f32;
    [0, 1, 2].map(|c| image.scratches.iter().map(|rgb| rgb[c]).sum::<f32>() / count)
}
