//! `cargo lab fuzz N`: mutated inputs of all kinds go through the command line, each in a process of its own with limits of time and
//! memory. A case depends on the seed and its number alone.
//!
//! Not by cargo-fuzz: that needs a nightly compiler, and calls a function again and again in one process, where the command line's limits of time
//! and memory, and the files that it leaves, cannot be judged.

mod case;
mod judge;
mod model;
mod mutate;
mod originals;
mod packed;
mod regressions;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, bail};
use case::{Case, InputKind};
use clap::{Args, ValueEnum};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;

/// Looks for inputs that make `hairline` panic, hang, take too much memory or leave parts of files.
#[derive(Args)]
pub struct Fuzz {
    /// Number of mutated inputs, beside the inputs of earlier findings.
    cases: u64,
    /// Seed of the mutations.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The first case: to run one again, `fuzz 1 --seed S --from CASE`.
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// Inputs of this kind only.
    #[arg(long, value_enum)]
    kind: Option<InputKind>,
    /// Seconds of processor time that a case may take.
    #[arg(long, default_value_t = 20)]
    seconds: u64,
    /// Memory that a case may have, in MiB.
    #[arg(long, default_value_t = 2048)]
    mebibytes: u64,
    /// The program. Without it the one beside this one: `cargo build --release -p hairline` makes it.
    #[arg(long)]
    program: Option<PathBuf>,
    /// Folder where failing inputs are kept.
    #[arg(long, default_value = "target/fuzz")]
    keep: PathBuf,
}

impl Fuzz {
    pub fn run(self) -> Result<()> {
        let program = self.program()?;
        let limits = judge::Limits {
            seconds: self.seconds,
            mebibytes: self.mebibytes,
        };
        let originals = originals::all()?;
        let kinds: Vec<InputKind> = match self.kind {
            Some(kind) => vec![kind],
            None => InputKind::value_variants().to_vec(),
        };
        let case = |number: u64| {
            let mut random =
                Pcg64::seed_from_u64(self.seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
            let kind = kinds[random.random_range(0..kinds.len())];
            let mut case = originals.case(kind, &mut random);
            case.name = format!("seed-{}-case-{number}", self.seed);
            case
        };
        let failures = AtomicUsize::new(0);
        let check = |case: Case| -> Result<()> {
            let folder = tempfile::tempdir().context("make a folder")?;
            let finding = judge::judge(&program, &case, folder.path(), &limits)?;
            if let Some(finding) = finding {
                failures.fetch_add(1, Ordering::Relaxed);
                let kept = self.keep(&case)?;
                println!("{}: {finding}; kept in {}", case.name, kept.display());
            }
            Ok(())
        };
        for case in originals::sound_cases(&originals) {
            let folder = tempfile::tempdir().context("make a folder")?;
            let finding = judge::judge(&program, &case, folder.path(), &limits)?;
            if finding.is_some() || !folder.path().join("out.png").exists() {
                bail!(
                    "{} does not render: {}",
                    case.name,
                    finding.unwrap_or_default()
                );
            }
        }
        if self.kind.is_none() {
            regressions::all().into_par_iter().try_for_each(check)?;
        }
        let numbers = self.from..self.from + self.cases;
        numbers.into_par_iter().map(case).try_for_each(check)?;
        let failures = failures.into_inner();
        println!("{} cases, {failures} failures", self.cases);
        match failures {
            0 => Ok(()),
            _ => bail!("{failures} inputs failed"),
        }
    }

    fn program(&self) -> Result<PathBuf> {
        let beside = || -> Result<PathBuf> {
            let own = std::env::current_exe().context("find this program")?;
            Ok(own.with_file_name(format!("hairline{}", std::env::consts::EXE_SUFFIX)))
        };
        let program = self.program.clone().map_or_else(beside, Ok)?;
        if !program.is_file() {
            bail!(
                "there is no {}; make it by `cargo build --release -p hairline`",
                program.display()
            );
        }
        Ok(std::path::absolute(program)?)
    }

    fn keep(&self, case: &Case) -> Result<PathBuf> {
        let folder = self.keep.join(&case.name);
        case.write(&folder)?;
        Ok(folder)
    }
}
