//! Values of flags that several commands have.

use anyhow::anyhow;
use clap::ValueEnum;
use hairline_render::BouncesWithoutShadows;
use hairline_render::failure::Failure;
use hairline_scene::Transport;

/// The last line of a program's help.
pub const EXIT_CODES: &str =
    "Exit codes: 0 done; 1 the work failed; 2 the command line or the scene is wrong.";

/// A flag that is on or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// Yes.
    On,
    /// No.
    Off,
}

/// Renderer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    #[default]
    /// A GPU if there is one, else the CPU renderer.
    Auto,
    /// A graphics adapter, be it a GPU or a software driver.
    Gpu,
    /// The CPU renderer: needs no driver.
    Cpu,
}

impl From<Backend> for hairline_render::Backend {
    fn from(flag: Backend) -> Self {
        match flag {
            Backend::Auto => Self::Auto,
            Backend::Gpu => Self::Gpu,
            Backend::Cpu => Self::Cpu,
        }
    }
}

/// Transport of light by the flags `--shadows` and `--bounces`, else the default.
///
/// # Errors
/// [`Failure::Input`] where there are bounces without shadows.
pub fn transport(shadows: Option<Switch>, bounces: Option<u32>) -> Result<Transport, Failure> {
    let shadows = shadows.map(|switch| switch == Switch::On);
    hairline_render::transport(shadows, bounces).map_err(|BouncesWithoutShadows| {
        let bounces = bounces.unwrap_or(0);
        Failure::Input(anyhow!(
            "--bounces {bounces}: without shadows the light that an object hides would be counted beside its own; add --shadows on"
        ))
    })
}
