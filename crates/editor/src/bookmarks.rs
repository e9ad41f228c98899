//! Views of scenes to come back to, kept from run to run beside the list of recent files.
//!
//! They are no part of the scene file, which stays what every version reads.

use std::path::{Path, PathBuf};

use hairline_document::description::Camera;
use hairline_image::output::write_atomically;
use toml::{Table, Value};

/// Largest number of scenes that are remembered, the latest first.
const MOST_SCENES: usize = 64;

/// A view with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Bookmark {
    /// Name in the list.
    pub name: String,
    /// Camera of the view; its exposure is not used.
    pub camera: Camera,
}

/// The bookmarks of one scene. What cannot be read or stored is forgotten in silence, as the list of recent files is.
#[derive(Clone, Debug, Default)]
pub struct Bookmarks {
    list: Vec<Bookmark>,
    scene: Option<PathBuf>,
    store: Option<PathBuf>,
}

impl Bookmarks {
    /// Bookmarks of a scene without a file; `store` is the file that bookmarks are kept in, if they are kept.
    pub fn new(store: Option<PathBuf>) -> Self {
        Self {
            store,
            ..Self::default()
        }
    }

    /// Replaces the bookmarks by those of another scene.
    pub fn open(&mut self, scene: Option<&Path>) {
        self.scene = scene.map(absolute);
        let stored = self.stored();
        let mine = self
            .scene
            .as_ref()
            .and_then(|scene| stored.iter().find(|(path, _)| path == scene));
        self.list = mine.map_or_else(Vec::new, |(_, list)| list.clone());
    }

    /// The scene was saved under a name: its bookmarks go with it.
    pub fn saved_as(&mut self, scene: &Path) {
        let scene = absolute(scene);
        if self.scene.as_ref() != Some(&scene) {
            self.scene = Some(scene);
            if !self.list.is_empty() {
                self.write();
            }
        }
    }

    /// All bookmarks, in the order of their making.
    pub fn list(&self) -> &[Bookmark] {
        &self.list
    }

    /// Adds a view under a new name, and returns the name.
    pub fn add(&mut self, camera: Camera) -> String {
        let is_taken = |name: &String| self.list.iter().any(|other| other.name == *name);
        let names = (1_usize..).map(|i| format!("View {i}"));
        let name = names.into_iter().find(|name| !is_taken(name));
        let name = name.unwrap_or_default();
        self.list.push(Bookmark {
            name: name.clone(),
            camera,
        });
        self.write();
        name
    }

    /// Forgets one.
    pub fn remove(&mut self, index: usize) {
        if index < self.list.len() {
            self.list.remove(index);
            self.write();
        }
    }

    fn write(&self) {
        let (Some(store), Some(scene)) = (&self.store, &self.scene) else {
            return;
        };
        if let Some(folder) = store.parent() {
            let _ = std::fs::create_dir_all(folder);
        }
        let mut all = self.stored();
        all.retain(|(path, _)| path != scene);
        if !self.list.is_empty() {
            all.insert(0, (scene.clone(), self.list.clone()));
        }
        all.truncate(MOST_SCENES);
        let scenes: Vec<Value> = all.iter().filter_map(scene_value).collect();
        let table = Table::from_iter([("scene".to_owned(), scenes.into())]);
        let _ = write_atomically(store, table.to_string().as_bytes());
    }

    /// Reads the store anew: another window may have written to it.
    fn stored(&self) -> Vec<(PathBuf, Vec<Bookmark>)> {
        let table: Option<Table> = self
            .store
            .as_ref()
            .and_then(|store| std::fs::read_to_string(store).ok()?.parse().ok());
        let scenes = table
            .as_ref()
            .and_then(|table| table.get("scene")?.as_array());
        let scenes = scenes.into_iter().flatten();
        scenes.filter_map(read_scene).collect()
    }
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

fn scene_value((path, list): &(PathBuf, Vec<Bookmark>)) -> Option<Value> {
    let views: Vec<Value> = list.iter().map(view_value).collect();
    let table = Table::from_iter([
        ("path".to_owned(), path.to_str()?.into()),
        ("view".to_owned(), views.into()),
    ]);
    Some(table.into())
}

fn view_value(Bookmark { name, camera }: &Bookmark) -> Value {
    let vector = |v: [f64; 3]| Value::from(v.to_vec());
    Table::from_iter([
        ("name".to_owned(), name.clone().into()),
        ("position_m".to_owned(), vector(camera.position_m)),
        ("target_m".to_owned(), vector(camera.target_m)),
        ("up".to_owned(), vector(camera.up)),
        ("fov_y_deg".to_owned(), camera.fov_y_deg.into()),
    ])
    .into()
}

fn read_scene(value: &Value) -> Option<(PathBuf, Vec<Bookmark>)> {
    let table = value.as_table()?;
    let views = table.get("view")?.as_array()?;
    let path = PathBuf::from(table.get("path")?.as_str()?);
    Some((path, views.iter().filter_map(read_view).collect()))
}

fn read_view(value: &Value) -> Option<Bookmark> {
    let table = value.as_table()?;
    let number = |value: &Value| value.as_float().filter(|number| number.is_finite());
    let vector = |key: &str| -> Option<[f64; 3]> {
        let numbers = table.get(key)?.as_array()?;
        let numbers: Option<Vec<f64>> = numbers.iter().map(number).collect();
        numbers?.try_into().ok()
    };
    Some(Bookmark {
        name: table.get("name")?.as_str()?.to_owned(),
        camera: Camera {
            position_m: vector("position_m")?,
            target_m: vector("target_m")?,
            up: vector("up")?,
            fov_y_deg: number(table.get("fov_y_deg")?).filter(|fov| (0.0..180.0).contains(fov))?,
            ..Camera::default()
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(x: f64) -> Camera {
        Camera {
            position_m: [x, -0.5, 0.25],
            target_m: [0.0, 0.1, 0.0],
            up: [0.0, 0.0, 1.0],
            fov_y_deg: 30.0,
            ..Camera::default()
        }
    }

    #[test]
    fn bookmarks_belong_to_their_scene_and_last() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("config/views.toml");
        let [a, b] = ["a.toml", "b \"quoted\".toml"].map(|name| folder.path().join(name));
        let mut bookmarks = Bookmarks::new(Some(store.clone()));
        bookmarks.open(Some(&a));
        assert_eq!(bookmarks.add(camera(0.1)), "View 1");
        assert_eq!(bookmarks.add(camera(0.2)), "View 2");
        let of_a = bookmarks.list().to_vec();
        bookmarks.open(Some(&b));
        assert!(bookmarks.list().is_empty());
        bookmarks.add(camera(0.3));
        // Another window.
        let mut other = Bookmarks::new(Some(store.clone()));
        other.open(Some(&a));
        assert_eq!(other.list(), of_a);
        other.remove(0);
        assert_eq!(other.add(camera(0.4)), "View 1");
        let mut again = Bookmarks::new(Some(store));
        again.open(Some(&b));
        assert_eq!(again.list()[0].camera, camera(0.3));
    }

    #[test]
    fn a_scene_without_a_file_takes_them_along_when_it_is_saved() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("views.toml");
        std::fs::write(&store, "scene = [3, { path = \"x\" }]").unwrap();
        let mut bookmarks = Bookmarks::new(Some(store.clone()));
        bookmarks.open(None);
        bookmarks.add(camera(0.5));
        let path = folder.path().join("new.toml");
        bookmarks.saved_as(&path);
        let mut again = Bookmarks::new(Some(store));
        again.open(Some(&path));
        assert_eq!(again.list(), bookmarks.list());
        // Nowhere to be kept.
        let mut lost = Bookmarks::default();
        lost.open(Some(&path));
        lost.add(camera(1.0));
        assert_eq!(lost.list().len(), 1);
    }
}
