//! `cargo lab wear`: how much of an object shows its wear, in the light of `hairline render MODEL` and in that of a `[studio]`.
//!
//! The share of the object's pixels that change by 5 of 255 or more when the wear is taken away, in pictures with default options.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_document::description::{Description, Material, Studio};
use hairline_document::wear::Wear;
use hairline_document::{DEFAULT_SAMPLES, Loader, SceneBuilder};
use hairline_editor::presets::MaterialPreset;
use hairline_image::{Display, Image, Output, filter_traced};
use hairline_optics::metal::Metal;

/// Options of `wear`.
#[derive(clap::Args)]
pub struct WearShown {
    /// Models, .glb or .gltf.
    #[arg(required = true)]
    models: Vec<PathBuf>,

    /// Width and height of the pictures.
    #[arg(long, num_args = 2, default_values_t = [320, 180])]
    size_px: Vec<u32>,

    /// Roughness of the materials, in place of their own.
    #[arg(long)]
    roughness: Option<f64>,

    /// Leave out the light of a `[studio]`.
    #[arg(long)]
    alone: bool,

    /// A folder for the pictures.
    #[arg(long)]
    pictures: Option<PathBuf>,
}

impl WearShown {
    /// Measures all, and prints the table.
    pub fn run(self) -> Result<()> {
        println!("| model | material | worn | old | worn, `[studio]` | old, `[studio]` |");
        println!("|---|---|---:|---:|---:|---:|");
        for model in &self.models {
            let name = model.file_stem().unwrap_or_default().to_string_lossy();
            for mut material in materials() {
                material.roughness = self.roughness.unwrap_or(material.roughness);
                let mut row = format!("| {name} | {} |", material.name);
                for is_studio in [false, true].into_iter().take(2 - usize::from(self.alone)) {
                    for wear in [Wear::Worn, Wear::Old] {
                        let share = self.share(model, &material, wear, is_studio)?;
                        row += &format!(" {:.0} % |", 100.0 * share);
                    }
                }
                println!("{row}");
            }
        }
        Ok(())
    }

    fn share(&self, model: &Path, material: &Material, wear: Wear, is_studio: bool) -> Result<f64> {
        let mut description = Description::for_model(model)?;
        description.render.size_px = [self.size_px[0], self.size_px[1]];
        description.scratches.clear();
        description.materials.push(material.clone());
        description.objects[0].material = Some(material.name.clone());
        let folder = model.parent().unwrap_or(Path::new(""));
        let mut builder = SceneBuilder::new();
        let mut build =
            |description: &Description| builder.build(&Loader::default(), description, folder);
        let scene = build(&description)?;
        let (least, most) = scene.objects[0].mesh.bounds_m();
        let bounds_m = (least.as_dvec3(), most.as_dvec3());
        description.light_for_scratches(&scene);
        if is_studio {
            let studio = Studio::default();
            description.lights = studio.lights(&description.camera, bounds_m);
            description.environment = Some(studio.room());
        }
        let without = picture(&build(&description)?);
        let object = description.objects[0].name.clone();
        description.scratches = wear.layers(&object, bounds_m.0.distance(bounds_m.1));
        let scene = build(&description)?;
        let worn = picture(&scene);
        let display = Display {
            exposure_ev: scene.camera.exposure_ev,
            tone_map: scene.render.tone_map,
        };
        if let Some(folder) = &self.pictures {
            std::fs::create_dir_all(folder).context("make the folder for pictures")?;
            let light = if is_studio { "studio" } else { "model" };
            let name = format!("{object} {} {} {light}.png", material.name, wear.name());
            Output::check(folder.join(name))?.write_image(&worn, &display)?;
        }
        Ok(noticed(&worn, &without, &display))
    }
}

fn materials() -> [Material; 3] {
    let metal = |metal| MaterialPreset::Metal(metal).material();
    [
        metal(Metal::StainlessSteel),
        metal(Metal::Gold),
        Material {
            name: "black plastic".to_owned(),
            roughness: 0.06,
            ..MaterialPreset::CarPaint.material()
        },
    ]
}

fn picture(scene: &hairline_scene::Scene) -> Image {
    let options = RenderOptions {
        samples: DEFAULT_SAMPLES,
        shadows: true,
        bounces: 1,
        ..RenderOptions::default()
    };
    let mut image = Prepared::new(scene).render(&options, &|_| {});
    filter_traced(&mut image);
    image
}

/// The share of the first object's pixels that differ.
fn noticed(worn: &Image, without: &Image, display: &Display) -> f64 {
    let objects = worn.traced.iter().flat_map(|found| &found.pixels);
    let (worn, without) = (worn.beauty(), without.beauty());
    let (mut all, mut differ) = (0, 0);
    for ((pixel, a), b) in objects.zip(&worn.rgb).zip(&without.rgb) {
        if pixel.object == 1 {
            all += 1;
            differ += u32::from(display.is_noticed(*a, *b));
        }
    }
    f64::from(differ) / f64::from(all.max(1))
}
