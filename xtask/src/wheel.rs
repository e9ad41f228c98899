//! The package for Python: a wheel, tested in an environment that has nothing else.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use clap::Args;

#[derive(Args)]
pub struct Wheel {
    /// Folder for the wheel.
    #[arg(short, long, default_value = "target/wheel")]
    output: PathBuf,
    /// The interpreter that it is tested with.
    #[arg(long, default_value = "python3")]
    python: PathBuf,
    /// Compare all scenes with the command line, also those that take long.
    #[arg(long)]
    all_scenes: bool,
}

/// Package that builds it.
pub const MATURIN: &str = "maturin>=1.9,<2";
/// Package that packs it again, with what maturin does not know.
pub const PACKER: &str = "wheel>=0.45";
/// Packages that build and test it.
const TOOLS: [&str; 11] = [
    MATURIN,
    "numpy",
    "pillow",
    "pytest",
    "pytest-xdist",
    "mypy",
    "typing_extensions",
    "distributed",
    "matplotlib",
    "scikit-image",
    "SurfaceTopography>=1.18; python_version >= '3.10'",
];
/// Packages that single tests need, which are skipped where there are none for the interpreter.
const OF_SINGLE_TESTS: [&str; 3] = ["mitsuba", "pyyaml", "usd-core"];

/// Imported modules are compiled at that time.
const QUIETLY: [&str; 6] = [
    "-m",
    "pip",
    "install",
    "--quiet",
    "--no-compile",
    "--disable-pip-version-check",
];

/// The programs of a fresh environment with these packages, in a folder.
pub fn environment(python: &Path, folder: &Path, packages: &[&str]) -> anyhow::Result<PathBuf> {
    let environment = folder.join("environment");
    run(Command::new(python)
        .args(["-m", "venv", "--clear"])
        .arg(&environment))?;
    let programs = environment.join(if cfg!(windows) { "Scripts" } else { "bin" });
    run(Command::new(programs.join("python"))
        .args(QUIETLY)
        .args(packages))?;
    Ok(programs)
}

/// Builds the wheel of `package` into `output` by the maturin of `programs`, in the place of those that were there. `set` says what it is compiled for,
/// if not for this machine.
pub fn build(
    package: &Path,
    programs: &Path,
    output: &Path,
    set: impl FnOnce(&mut Command) -> anyhow::Result<()>,
) -> anyhow::Result<PathBuf> {
    for old in wheels(output)? {
        std::fs::remove_file(old)?;
    }
    let mut maturin = Command::new(programs.join("maturin"));
    maturin
        .args(["build", "--release", "--quiet", "--out"])
        .arg(output)
        .arg("--manifest-path")
        .arg(package.join("Cargo.toml"));
    set(&mut maturin)?;
    run(&mut maturin)?;
    wheels(output)?.pop().context("maturin made no wheel")
}

/// Packs a wheel again, in its place, with what `add` does to its files: its arguments are their folder and that of the licences in it.
pub fn repack(
    wheel: &Path,
    programs: &Path,
    work: &Path,
    time: u64,
    add: impl FnOnce(&Path, &Path) -> anyhow::Result<()>,
) -> anyhow::Result<PathBuf> {
    let unpacked = work.join("unpacked");
    if unpacked.exists() {
        std::fs::remove_dir_all(&unpacked)?;
    }
    let packer = || {
        let mut packer = Command::new(programs.join("python"));
        packer.args(["-m", "wheel"]);
        packer
    };
    run(packer()
        .arg("unpack")
        .arg(wheel)
        .arg("--dest")
        .arg(&unpacked))?;
    let name = wheel.file_name().context("a wheel without a name")?;
    let name = name.to_string_lossy();
    let mut words = name.split('-');
    let (package, version) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
    let files = unpacked.join(format!("{package}-{version}"));
    add(
        &files,
        &files.join(format!("{package}-{version}.dist-info/licenses")),
    )?;
    run(packer()
        .arg("pack")
        .arg(&files)
        .arg("--dest-dir")
        .arg(work)
        .env("SOURCE_DATE_EPOCH", time.to_string()))?;
    Ok(wheel.to_owned())
}

impl Wheel {
    pub fn run(self) -> anyhow::Result<()> {
        ensure!(
            cfg!(target_os = "linux"),
            "made on Linux alone; docs/python.md says how elsewhere"
        );
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .canonicalize()?;
        let package = root.join("crates/python");
        std::fs::create_dir_all(&self.output)?;
        let output = self.output.canonicalize()?;
        let programs = environment(&self.python, &output, &TOOLS)?;
        let python = || Command::new(programs.join("python"));
        if let Err(error) = run(python().args(QUIETLY).args(OF_SINGLE_TESTS)) {
            println!("tests that need them are skipped: {error}");
        }

        let make = || -> anyhow::Result<PathBuf> {
            let wheel = build(&package, &programs, &output, |_| Ok(()))?;
            run(python().args(QUIETLY).arg("--no-deps").arg(&wheel))?;
            Ok(wheel)
        };
        let check_types = || {
            let cache = format!("--cache-dir={}", output.join("types").display());
            let types = ["-m", "mypy", &cache];
            run(python().current_dir(&package).args(types))
        };
        let (wheel, types) = run_both(make, check_types)?;
        let (wheel, ()) = (wheel?, types?);
        // The stubs agree with the compiled part.
        let stubs = ["-m", "mypy.stubtest", "hairline._hairline", "--concise"];
        run(python()
            .current_dir(&package)
            .args(stubs)
            .args(["--mypy-config-file", "pyproject.toml"]))?;

        // Another folder than the sources, so that the installed package is tested.
        let program = crate::program::build(&root, "hairline")?;
        let tests = |which: &[&str]| {
            run(python()
                .current_dir(&output)
                .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
                // Most of a test runs on one core.
                .args(["-n", "auto", "--dist", "worksteal"])
                .args(which)
                .arg(package.join("tests"))
                .env("HAIRLINE_PROGRAM", &program)
                .env("HAIRLINE_REPOSITORY", &root)
                .env(
                    "HAIRLINE_ALL_SCENES",
                    if self.all_scenes { "1" } else { "" },
                ))
        };
        let notebooks = || {
            run(python()
                .current_dir(&output)
                .arg(root.join("docs/notebooks/run.py")))
        };
        // A cluster's tests mostly wait for workers.
        let cluster = "test_cluster or test_documents";
        let (others, cluster) = run_both(
            || tests(&["-k", &format!("not ({cluster})")]),
            || tests(&["-k", cluster]).and_then(|()| notebooks()),
        )?;
        others.and(cluster)?;
        let bytes = std::fs::metadata(&wheel)?.len();
        println!("{}: {:.1} MB", wheel.display(), bytes as f64 / 1e6);
        Ok(())
    }
}

/// Runs both at once: each waits for one core at times, and for the disk.
fn run_both<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> anyhow::Result<(A, B)> {
    std::thread::scope(|scope| {
        let a = scope.spawn(a);
        let b = b();
        let a = a.join().map_err(|_| anyhow::anyhow!("a thread panicked"))?;
        Ok((a, b))
    })
}

fn wheels(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let paths = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let paths: Vec<PathBuf> = paths.collect::<std::io::Result<_>>()?;
    let is_wheel = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "whl");
    Ok(paths.into_iter().filter(is_wheel).collect())
}

/// Runs a command and prints its output once it is done, since other commands may run at the same
/// time.
pub fn run(command: &mut Command) -> anyhow::Result<()> {
    let done = command.output().with_context(|| format!("{command:?}"))?;
    let said = [done.stdout, done.stderr].concat();
    print!("{}", String::from_utf8_lossy(&said));
    ensure!(done.status.success(), "{command:?}: {}", done.status);
    Ok(())
}
