//! Settings of the interface, kept from run to run.

use std::path::PathBuf;

use hairline_image::output::write_atomically;

/// Settings. What cannot be read or stored is forgotten in silence, as with [`Recent`](crate::recent::Recent).
#[derive(Clone, Debug, Default)]
pub struct Settings {
    high_contrast: bool,
    store: Option<PathBuf>,
}

impl Settings {
    /// Settings that are stored in a file, or the usual ones; without a file they last for this run.
    pub fn load(store: Option<PathBuf>) -> Self {
        let text = store
            .as_ref()
            .and_then(|it| std::fs::read_to_string(it).ok());
        let table: Option<toml::Table> = text.and_then(|text| text.parse().ok());
        let high_contrast = table.and_then(|table| table.get("high_contrast")?.as_bool());
        Self {
            high_contrast: high_contrast.unwrap_or(false),
            store,
        }
    }

    /// Whether texts and controls are white on black.
    pub fn high_contrast(&self) -> bool {
        self.high_contrast
    }

    /// Sets whether they are, and stores it.
    pub fn set_high_contrast(&mut self, high_contrast: bool) {
        self.high_contrast = high_contrast;
        let Some(store) = &self.store else {
            return;
        };
        if let Some(folder) = store.parent() {
            let _ = std::fs::create_dir_all(folder);
        }
        let text = format!("high_contrast = {high_contrast}\n");
        let _ = write_atomically(store, text.as_bytes());
    }
}
