//! Where a user's own files go, on systems that have such places.

use std::path::PathBuf;

/// Where settings and lists are kept; none where the system does not say, or has no files.
pub fn config_dir() -> Option<PathBuf> {
    strategy::config_dir()
}

/// Where autosaves are kept: it outlives a restart, and is not a place that systems clean up.
pub fn autosave_dir() -> Option<PathBuf> {
    strategy::data_dir().map(|folder| folder.join("autosave"))
}

#[cfg(not(target_arch = "wasm32"))]
mod strategy {
    use std::path::PathBuf;

    use etcetera::AppStrategy;
    use etcetera::app_strategy::{AppStrategyArgs, choose_native_strategy};

    pub fn config_dir() -> Option<PathBuf> {
        choose_native_strategy(name()).ok().map(|s| s.config_dir())
    }

    pub fn data_dir() -> Option<PathBuf> {
        choose_native_strategy(name()).ok().map(|s| s.data_dir())
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

    pub fn config_dir() -> Option<PathBuf> {
        None
    }

    pub fn data_dir() -> Option<PathBuf> {
        None
    }
}
