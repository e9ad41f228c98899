//! How programs are compiled that are handed out: on Linux by zig, for machines older than this one; on macOS for both processors; on Windows with
//! Microsoft's library in them. Paths of this machine are not in them, nor is anything that a debugger wants.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Context;

use super::old_machines::GLIBC;
use crate::program::{run, without_paths};

/// Brings a compiler's linker with the symbols of each version of glibc, and what hands it to cargo. maturin knows both.
const ZIG: [&str; 2] = ["ziglang==0.17.1", "cargo-zigbuild==0.24.1"];

const FOR_MACOS: [&str; 2] = ["aarch64-apple-darwin", "x86_64-apple-darwin"];

/// Where things are made.
pub struct Place {
    pub root: PathBuf,
    /// Folders that archives are made of.
    pub work: PathBuf,
    /// Programs of an environment with maturin and, on Linux, zig; or why there are none.
    pub tools: Result<PathBuf, String>,
    /// The time of files in archives.
    pub time: u64,
}

impl Place {
    /// The folder that is compiled in: its own, since build scripts and macros are linked by zig too, and compiling them anew has all compiled anew
    /// that builds for tests made.
    fn build(&self) -> PathBuf {
        self.root.join("target/for-release")
    }
}

/// What this machine's programs are compiled for, as Rust calls it.
pub struct Target(String);

impl Target {
    pub fn of_this_machine() -> anyhow::Result<Self> {
        let asked = Command::new("rustc").arg("-vV").output()?;
        let said = String::from_utf8(asked.stdout)?;
        let host = said.lines().find_map(|line| line.strip_prefix("host: "));
        Ok(Self(host.context("rustc names no host")?.to_owned()))
    }

    /// Its name in names of files.
    pub fn name(&self) -> &str {
        if cfg!(target_os = "macos") {
            "universal-apple-darwin"
        } else {
            &self.0
        }
    }

    pub fn triples(&self) -> Vec<&str> {
        if cfg!(target_os = "macos") {
            FOR_MACOS.to_vec()
        } else {
            vec![&self.0]
        }
    }

    /// Packages for Python that compile for it, beside maturin.
    pub fn packages(&self) -> &'static [&'static str] {
        if cfg!(target_os = "linux") { &ZIG } else { &[] }
    }

    /// Compiles programs and puts them into a folder.
    pub fn build(&self, at: &Place, names: &[&str], folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
        let mut cargo = Command::new("cargo");
        cargo
            .current_dir(&at.root)
            .args(["build", "--release", "--locked"])
            .args(names.iter().flat_map(|name| ["-p", name]))
            .args(self.triples().iter().flat_map(|it| ["--target", it]));
        self.set(&mut cargo, at)?;
        run(&mut cargo)?;
        let each = names.iter().map(|name| {
            let file = format!("{name}{}", env::consts::EXE_SUFFIX);
            let built = self.triples().into_iter();
            let built: Vec<_> = built
                .map(|triple| at.build().join(triple).join("release").join(&file))
                .collect();
            let to = folder.join(&file);
            if let [one] = &built[..] {
                std::fs::copy(one, &to)?;
            } else {
                let mut join = Command::new("lipo");
                run(join.arg("-create").args(built).arg("-output").arg(&to))?;
            }
            Ok(to)
        });
        each.collect()
    }

    /// Has maturin compile as [`Target::build`] does.
    pub fn set_wheel(&self, maturin: &mut Command, at: &Place) -> anyhow::Result<()> {
        let target = match cfg!(target_os = "macos") {
            true => "universal2-apple-darwin",
            false => &self.0,
        };
        maturin.args(["--locked", "--target", target]);
        if cfg!(target_os = "linux") {
            let manylinux = format!("manylinux_{}_{}", GLIBC[0], GLIBC[1]);
            maturin.args(["--compatibility", &manylinux]);
        }
        self.set(maturin, at)
    }

    fn set(&self, command: &mut Command, at: &Place) -> anyhow::Result<()> {
        let mut flags = without_paths(&at.root)?;
        if cfg!(windows) {
            flags.push("-Ctarget-feature=+crt-static".to_owned());
        }
        command
            .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"))
            .env("CARGO_PROFILE_RELEASE_STRIP", "symbols")
            .env("CARGO_TARGET_DIR", at.build())
            .env("SOURCE_DATE_EPOCH", at.time.to_string());
        let triple = self.0.to_uppercase().replace('-', "_");
        let linker = format!("CARGO_TARGET_{triple}_LINKER");
        // One that is set stays: the compiler of an old system, for example.
        if cfg!(target_os = "linux") && env::var_os(&linker).is_none() {
            command.env(linker, self.zig(at)?);
        }
        Ok(())
    }

    /// A linker for the symbols of an old glibc, for programs and wheel alike: what cargo and maturin compile fits both, and is compiled once.
    fn zig(&self, at: &Place) -> anyhow::Result<PathBuf> {
        let tools = at.tools.clone().map_err(anyhow::Error::msg)?;
        let [python, zigbuild] = ["python", "cargo-zigbuild"].map(|it| tools.join(it));
        let (arch, [major, minor]) = (env::consts::ARCH, GLIBC);
        let script = format!(
            "#!/bin/sh\nexport CARGO_ZIGBUILD_ZIG_COMMAND='{}' CARGO_ZIGBUILD_ZIG_COMMAND_ARGS='-m ziglang'\n\
             exec '{}' zig cc -- -g -fno-sanitize=all -target {arch}-linux-gnu.{major}.{minor} \"$@\"\n",
            python.display(),
            zigbuild.display()
        );
        let path = at.build().join("zig-linker");
        std::fs::create_dir_all(at.build())?;
        std::fs::write(&path, script)?;
        run(Command::new("chmod").arg("+x").arg(&path))?;
        Ok(path)
    }
}
