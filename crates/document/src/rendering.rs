//! Defaults of every renderer.

use hairline_scene::Transport;

/// Number of samples of a pixel with an edge or a crease, in a finished picture: of the window, of an export and of `hairline render`, by every
/// renderer.
pub const DEFAULT_SAMPLES: u32 = 8;

/// Default of `hairline render`.
pub const DEFAULT_TRANSPORT: Transport = Transport {
    shadows: true,
    bounces: 1,
};
