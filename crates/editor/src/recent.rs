//! The files that were opened or saved last, kept from run to run.

use std::path::{Path, PathBuf};

use hairline_image::output::write_atomically;

/// Largest number of files that are kept.
const MOST: usize = 12;

/// A list of recent files. What cannot be read or stored is forgotten in silence: it is never worth a message.
#[derive(Clone, Debug, Default)]
pub struct Recent {
    files: Vec<PathBuf>,
    store: Option<PathBuf>,
}

impl Recent {
    /// The list that is stored in a file, or an empty one that will be.
    pub fn load(store: impl Into<PathBuf>) -> Self {
        let store = store.into();
        Self {
            files: stored(&store),
            store: Some(store),
        }
    }

    /// Puts a file first and stores the list. What another window has added meanwhile is kept.
    pub fn add(&mut self, file: &Path) {
        let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        if let Some(store) = &self.store {
            let known = stored(store);
            if !known.is_empty() {
                self.files = known;
            }
        }
        self.files.retain(|other| *other != file);
        self.files.insert(0, file);
        self.files.truncate(MOST);
        self.write();
    }

    /// Files that are still there, the latest first.
    pub fn list(&self) -> Vec<PathBuf> {
        let files = self.files.iter();
        files.filter(|file| file.is_file()).cloned().collect()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.files.clear();
        self.write();
    }

    fn write(&self) {
        let Some(store) = &self.store else {
            return;
        };
        if let Some(folder) = store.parent() {
            let _ = std::fs::create_dir_all(folder);
        }
        let names = self.files.iter().filter_map(|file| file.to_str());
        let list: Vec<toml::Value> = names.map(|name| name.to_owned().into()).collect();
        let table = toml::Table::from_iter([("files".to_owned(), list.into())]);
        let _ = write_atomically(store, table.to_string().as_bytes());
    }
}

fn stored(store: &Path) -> Vec<PathBuf> {
    let table: Option<toml::Table> = std::fs::read_to_string(store)
        .ok()
        .and_then(|text| text.parse().ok());
    let files = table
        .as_ref()
        .and_then(|table| table.get("files")?.as_array());
    let names = files.into_iter().flatten().filter_map(|name| name.as_str());
    names.take(MOST).map(PathBuf::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_is_first_and_lasts() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("config/hairline/recent.toml");
        let scenes: Vec<_> = (0..15)
            .map(|i| folder.path().join(format!("{i}.toml")))
            .collect();
        let mut recent = Recent::load(&store);
        for scene in &scenes {
            std::fs::write(scene, "").unwrap();
            recent.add(scene);
        }
        recent.add(&scenes[10]);
        let mut expected: Vec<_> = scenes[3..].to_vec();
        expected.reverse();
        expected.retain(|scene| *scene != scenes[10]);
        expected.insert(0, scenes[10].clone());
        assert_eq!(recent.list(), expected);
        std::fs::remove_file(&scenes[12]).unwrap();
        expected.retain(|scene| *scene != scenes[12]);
        assert_eq!(Recent::load(&store).list(), expected);

        // Another window's file is not lost, nor is a forgotten list brought back.
        let mut other = Recent::load(&store);
        other.add(&scenes[0]);
        recent.add(&scenes[1]);
        assert_eq!(recent.list()[..2], [scenes[1].clone(), scenes[0].clone()]);
        recent.clear();
        assert!(Recent::load(&store).list().is_empty());
    }

    #[test]
    fn a_broken_store_is_no_failure() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("recent.toml");
        let scene = folder.path().join("a.toml");
        std::fs::write(&scene, "").unwrap();
        for text in ["files = 3", "files = [1, \"", "\u{0}"] {
            std::fs::write(&store, text).unwrap();
            let mut recent = Recent::load(&store);
            assert!(recent.list().is_empty());
            recent.add(&scene);
            assert_eq!(Recent::load(&store).list(), std::slice::from_ref(&scene));
        }
        // A folder in the place of the store: nothing can be kept, but this run has its list.
        let mut recent = Recent::load(folder.path());
        recent.add(&scene);
        assert_eq!(recent.list(), std::slice::from_ref(&scene));
        assert!(Recent::default().list().is_empty());
    }
}
