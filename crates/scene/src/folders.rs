//! Folders for a user's own files, on systems that have such places.

use std::path::PathBuf;

/// Folder for settings and lists; none where the system does not say, or has no files.
pub fn config_dir() -> Option<PathBuf> {
    strategy::config_dir()
}

/// Folder for what can be computed again; none as above.
pub(crate) fn cache_dir() -> Option<PathBuf> {
    strategy::cache_dir()
}

#[cfg(not(target_arch = "wasm32"))]
mod strategy {
    use std::path::PathBuf;

    use etcetera::AppStrategy;
    use etcetera::app_strategy::{AppStrategyArgs, choose_native_strategy};

    pub(crate) fn config_dir() -> Option<PathBuf> {
        choose_native_strategy(name()).ok().map(|s| s.config_dir())
    }

    pub(crate) fn cache_dir() -> Option<PathBuf> {
        choose_native_strategy(name()).ok().map(|s| s.cache_dir())
    }

    fn name() -> AppStrategyArgs {
        AppStrategyArgs {
            top_level_domain: "org".to_owned(),
            author: "Hairline".to_owned(),
            app_name: "Hairline".to_owned(),
        }
    }
}

#[cfg(target_arch = "wasm32")]
mod strategy {
    use std::path::PathBuf;

    pub(crate) fn config_dir() -> Option<PathBuf> {
        None
    }

    pub(crate) fn cache_dir() -> Option<PathBuf> {
        None
    }
}
