//! Arguments of the viewer: `hairline view` hands them to `hairline-viewer`.

use std::path::PathBuf;

use clap::Args;

use crate::{Backend, Switch};

/// Scene and flags of the viewer.
#[derive(Args, Debug, Default)]
pub struct View {
    /// The scene file (TOML), or a model (.glb, .gltf, .obj, .stl), which is shown in a lit scene. Without it: the built-in scene.
    pub scene: Option<PathBuf>,
    /// Renderer. auto: the window's GPU, or the CPU renderer where the window is drawn by a software driver.
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    pub backend: Backend,
    /// Folder for autosaves and the list of recent files, in place of the user's folders.
    #[arg(long, value_name = "FOLDER")]
    pub state_dir: Option<PathBuf>,
    /// Ask for files by a line in the window, not by the system's dialogs.
    #[arg(long)]
    pub plain_dialogs: bool,
    /// Whether objects hide lights and the environment from one another. The window can switch it. [default: on]
    #[arg(long, value_enum)]
    pub shadows: Option<Switch>,
    /// Objects that light may go by on its way besides the one that is seen, with shadows. [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(0..=8))]
    pub bounces: Option<u32>,
}
