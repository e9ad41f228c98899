//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Renders the coloured, hair-thin scratches of worn surfaces.
#[derive(Debug, Parser)]
#[command(version, after_help = EXIT_CODES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

const EXIT_CODES: &str =
    "Exit codes: 0 done; 1 the work failed; 2 the command line or the scene is wrong.";

/// A subcommand.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to a picture.
    Render(Render),
    /// Show the version, the graphics adapters and what they can do, and the backends available.
    Info,
}

/// `hairline render`
#[derive(Args, Debug)]
pub struct Render {
    /// The scene file (TOML). Without it: the built-in scene.
    pub scene: Option<PathBuf>,
    /// The picture: .png (tone-mapped, sRGB) or .exr (linear, 32-bit float, layers). Without it: the scene's name with .png,
    /// or hairline.png, in the current folder.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// What renders.
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    pub backend: Backend,
    /// Width and height in pixels, in place of the scene's.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Samples for each pixel.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub samples: u32,
    /// Other scratches of the same kinds: added to the seed of each layer.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// Exposure in stops, in place of the scene's: radiances are multiplied by 2^EV before the tone map of a .png.
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = parse_exposure)]
    pub exposure: Option<f64>,
}

/// What renders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// A GPU if there is one, else the CPU renderer; for long work a software graphics driver if it measures faster.
    Auto,
    /// A graphics adapter, be it a GPU or a software driver.
    Gpu,
    /// The CPU renderer: needs no driver.
    Cpu,
}

/// As scene files allow.
const SIDE_MAX_PX: u32 = 16384;

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| {
        text.parse::<u32>()
            .ok()
            .filter(|n| (1..=SIDE_MAX_PX).contains(n))
    };
    text.split_once(['x', 'X'])
        .and_then(|(width, height)| Some([side(width)?, side(height)?]))
        .ok_or_else(|| {
            format!("write WIDTHxHEIGHT, as in 1280x720, with sides from 1 to {SIDE_MAX_PX}")
        })
}

fn parse_exposure(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|ev| ev.abs() <= 100.0)
        .ok_or_else(|| "write a number of stops from -100 to 100, as in -1.5".to_owned())
}
