//! `cargo xtask mutate`: whether the tests find the faults of `tests/mutants.toml`.
//!
//! One build of a copy of the workspace has all faults in it, and the environment variable `HAIRLINE_MUTANT` chooses one of them at run
//! time (mutant schemata: R. Untch, A. Offutt, M. Harrold, *Mutation Analysis Using Mutant Schemata*, 1993). A row takes a run of its tests,
//! and no build.

mod copy;
mod programs;
mod table;

use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail, ensure};
use clap::Args;

use copy::{faulty_texts, write_copy};
use table::{Mutant, Table};

#[derive(Args)]
pub struct Mutate {
    /// Tries this row alone; may be given several times.
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Prints the rows and tries none.
    #[arg(long)]
    list: bool,
}

impl Mutate {
    pub fn run(self) -> anyhow::Result<()> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .canonicalize()?;
        let Table { mutant: all } = Table::read(&root)?;
        if let Some(name) = self.only.iter().find(|n| all.iter().all(|m| m.name != **n)) {
            bail!("found `{name}`; must be the name of a row: `cargo xtask mutate --list`");
        }
        let rows: Vec<(usize, &Mutant)> = (1..)
            .zip(&all)
            .filter(|(_, row)| self.only.is_empty() || self.only.contains(&row.name))
            .collect();
        if self.list {
            rows.iter()
                .for_each(|(_, row)| println!("{}: {} ({})", row.name, row.why, row.file));
            return Ok(());
        }
        let target = env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
        let copy = root.join("target/mutants/source");
        write_copy(&root, &copy, &faulty_texts(&root, &all)?)?;

        let mut filters: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for (_, row) in &rows {
            let tests = row.tests.iter().map(String::as_str);
            filters.entry(&row.program).or_default().extend(tests);
        }
        let programs =
            programs::build(&copy, &target, &filters.keys().copied().collect::<Vec<_>>())?;
        let program = |name: &str| {
            let found = programs.get(name);
            found.with_context(|| format!("cargo made no test program `{name}`"))
        };
        for (name, filters) in &filters {
            let filters: Vec<&str> = filters.iter().copied().collect();
            let found = program(name)?.run(&root, &filters, 0)?;
            ensure!(found.ending.is_none(), "{name} without a fault: {found:?}");
            for filter in filters {
                let is_run = found.passed.iter().any(|test| test.contains(filter));
                ensure!(is_run, "`{filter}` matches no test of {name}");
            }
        }

        let mut survivors = Vec::new();
        println!("| row | file | fault | program | tests that failed | s |");
        println!("|---|---|---|---|---|---|");
        for (number, row) in rows {
            let tests: Vec<&str> = row.tests.iter().map(String::as_str).collect();
            let found = program(&row.program)?.run(&root, &tests, number)?;
            if found.failed.is_empty() {
                survivors.push(row.name.as_str());
            }
            let failed = match (&found.ending, found.failed.is_empty()) {
                (Some(ending), true) => format!("**none, but {ending}**"),
                (None, true) => "**none**".to_owned(),
                _ => found.failed.join(", "),
            };
            let code = |text: &str| {
                let words: Vec<&str> = text.split_whitespace().collect();
                words.join(" ").replace('|', "\\|")
            };
            println!(
                "| {} | {} | `{}` → `{}` | {} | {failed} | {:.0} |",
                row.name,
                row.file,
                code(&row.from),
                code(&row.to),
                row.program,
                found.seconds
            );
        }
        ensure!(
            survivors.is_empty(),
            "no test finds: {}",
            survivors.join(", ")
        );
        Ok(())
    }
}
