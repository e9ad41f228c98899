//! The table of faults, `tests/mutants.toml`.

use std::path::Path;

use anyhow::Context;
use serde::Deserialize;

/// The table: its rows have the numbers 1, 2 and so on.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
    pub mutant: Vec<Mutant>,
}

/// A fault.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Mutant {
    pub name: String,
    pub file: String,
    /// Text that the file has once outside of its tests: an expression in Rust, any text in WGSL.
    pub from: String,
    /// The text with the fault, of the same type.
    pub to: String,
    /// Name of the test program: that of its file or folder, or that of the library whose unit tests it has.
    pub program: String,
    /// Filters, each of which matches a test's name; a test of one of them must fail.
    pub tests: Vec<String>,
    /// What a user would see.
    pub why: String,
}

impl Table {
    pub fn read(root: &Path) -> anyhow::Result<Self> {
        let text = std::fs::read_to_string(root.join("tests/mutants.toml"))?;
        toml::from_str(&text).context("tests/mutants.toml")
    }
}
