//! How long each pass over a scene takes on the device, the least of several pictures:
//! `cargo run --release -p conformance --example passes -- SCENE.toml [scratches] [off] [N]`.
//!
//! `hairline bench` measures the same beside the published method and the truth; this is for somebody who works on a shader.

use std::collections::BTreeMap;
use std::error::Error;
use std::time::Duration;

use hairline_gpu::{AdapterRequest, RenderOptions, Renderer, headless};
use hairline_optics::method::{LightAt, Method, PixelFilter};
use hairline_reference::closed_form::Prepared;
use hairline_scene::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("which scene?")?;
    let mut method = Method {
        light_at: LightAt::Pixels,
        ..Method::default()
    };
    let mut count = 7;
    for argument in arguments {
        match argument.as_str() {
            "scratches" => method.light_at = LightAt::Scratches,
            "off" => method.footprint = PixelFilter::Off,
            number => count = number.parse()?,
        }
    }
    let scene = Scene::load(&file)?;
    method.gather = scene.render.gather;
    let gpu = headless::open(&AdapterRequest::default())?;
    let prepared = Prepared::new(&scene);
    let mut renderer = gpu.block_on(Renderer::new(&gpu))?;
    let (index, tables) = (prepared.scratches(), prepared.tables());
    let uploaded = gpu.block_on(renderer.upload(&scene, index, tables, &method))?;
    if !gpu.block_on(renderer.time_passes())? {
        return Err("this device has no clock".into());
    }
    let mut least: BTreeMap<&str, Duration> = BTreeMap::new();
    for _ in 0..count {
        let options = RenderOptions::default();
        gpu.block_on(renderer.render(&scene, &uploaded, &options, &|_| {}))?;
        for pass in gpu.block_on(renderer.pass_times())?.unwrap_or_default() {
            let least = least.entry(pass.name).or_insert(Duration::MAX);
            *least = pass.time.min(*least);
        }
    }
    let sum: Duration = least.values().sum();
    for (name, time) in least {
        print!("{name} {:.1}  ", time.as_secs_f64() * 1e3);
    }
    println!("in all {:.1} ms", sum.as_secs_f64() * 1e3);
    Ok(())
}
