//! `cargo xtask shaders FILE`: every shader module and every compute pass as one JSON file, for a compiler that is not naga
//! (`tests/tint`).

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::Context;
use hairline_gpu::{Method, pipeline_variants, shaders};
use hairline_optics::mask::Mask;
use hairline_published::sine_integral::SineIntegral;
use hairline_published::{PublishedMethod, Structure};
use serde::Serialize;

/// The command's arguments.
#[derive(clap::Args)]
pub struct Shaders {
    /// Path of the JSON.
    file: PathBuf,
}

#[derive(Serialize)]
struct Texts {
    /// Modules, each with the modules that it imports.
    modules: Vec<Module>,
    passes: Vec<Pass>,
}

#[derive(Serialize)]
struct Module {
    name: &'static str,
    text: String,
}

/// An entry point and the values of its overrides.
#[derive(Serialize)]
struct Pass {
    name: String,
    text: String,
    entry: &'static str,
    constants: BTreeMap<&'static str, f64>,
}

impl Shaders {
    /// Writes the file.
    pub fn run(&self) -> anyhow::Result<()> {
        let (mut modules, mut passes) = (Vec::new(), Vec::new());
        let methods = methods();
        let published = hairline_published::shaders::ALL;
        for module in shaders::ALL.iter().chain(published) {
            let text = shaders::compose(&[module]);
            for entry in module.entry_points {
                passes.extend(pipeline_variants(module, &methods).into_iter().map(
                    |(variant, constants)| Pass {
                        name: format!("{}, {variant}", module.name),
                        text: text.clone(),
                        entry,
                        constants: constants.into_iter().collect(),
                    },
                ));
            }
            let name = module.name;
            modules.push(Module { name, text });
        }
        let json = serde_json::to_vec(&Texts { modules, passes })?;
        let file = self.file.display();
        std::fs::write(&self.file, json).with_context(|| format!("{file} cannot be written"))
    }
}

/// Hairline's own method and that of 2018, among them all masks and switches.
fn methods() -> [(&'static str, Method); 3] {
    let lists = PublishedMethod {
        structure: Structure::TriangleLists,
        anti_aliasing: false,
        si: SineIntegral::Exact,
    };
    let by_lists = hairline_published::Method {
        published: Some(lists),
        mask: Mask::Linear,
    };
    [
        ("default", Method::default()),
        ("published", hairline_published::Method::PUBLISHED.on_gpu()),
        ("published by lists, linear mask", by_lists.on_gpu()),
    ]
}
