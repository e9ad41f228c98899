//! What the programs `hairline` and `hairline-viewer` share: messages, flags, the built-in scene, and which files are scenes.

#![warn(unreachable_pub)]

mod flags;
mod messages;
mod scene_path;
mod view;
mod wayland;

pub use flags::{Backend, EXIT_CODES, Switch, transport};
pub use messages::{print, tell, tell_of_panics};
pub use scene_path::refuse_other_files;
pub use view::View;
pub use wayland::quiet_the_search_for_wayland;

/// The scene that is there without a file, as the text of a scene file.
pub const BUILT_IN: &str = include_str!("built_in_scene.toml");
