//! What Rust knows of the shaders of this crate, made of their own text as that of `hairline-gpu` is.

#[path = "../gpu/build/modules.rs"]
mod modules;

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use modules::Shaders;

fn main() -> io::Result<()> {
    let below = "../gpu/shaders";
    for read in ["shaders", below, "../gpu/build/modules.rs"] {
        println!("cargo::rerun-if-changed={read}");
    }
    let shaders = Shaders::read(Path::new("shaders"), "published/", "crate::shaders")?.with_base(
        Shaders::read(Path::new(below), "", "hairline_gpu::shaders")?,
    );
    let arrays = shaders.reflection("other_method").bindings.len();
    let pass = shaders.reflection("shade_published");
    let tables = pass.bindings.iter().skip(arrays).map(|table| &*table.name);
    let output = env::var_os("OUT_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let folder = "env!(\"CARGO_MANIFEST_DIR\"), \"/shaders\"";
    fs::write(output.join("tables.rs"), tables_struct(tables.collect()))?;
    fs::write(output.join("modules.rs"), shaders.rust(folder))
}

/// Rust for a struct with a field for each table that the pass binds.
fn tables_struct(names: Vec<&str>) -> String {
    let fields = names.iter().map(|name| format!("{name}: Table,\n"));
    let values = names.iter().map(|name| format!("self.{name},\n"));
    format!(
        "/// Tables that the pass binds.\nstruct Tables {{\n{}}}\n\
         impl Tables {{\n/// In the order of their bindings.\nfn in_order(self) -> Vec<Table> {{\nvec![\n{}]\n}}\n}}\n",
        fields.collect::<String>(),
        values.collect::<String>(),
    )
}
