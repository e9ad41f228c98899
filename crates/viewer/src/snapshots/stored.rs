//! Snapshots beside the scene's file: `plate.snapshots` beside `plate.toml`, with a scene file and a picture for each.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use egui::ColorImage;
use hairline_document::Description;
use hairline_editor::document::rebased;
use hairline_image::output::write_atomically;
use image::{ExtendedColorType, ImageEncoder};

/// The folder of a scene's snapshots.
pub(super) fn folder(scene: &Path) -> PathBuf {
    // The name of earlier versions.
    let older = scene.with_extension("looks");
    match older.is_dir() {
        true => older,
        false => scene.with_extension("snapshots"),
    }
}

/// A look as it is read.
pub(super) struct Stored {
    pub name: String,
    pub description: Arc<Description>,
}

/// The looks in a folder, the oldest first. What cannot be read is passed over.
pub(super) fn read(folder: &Path) -> Vec<Stored> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let scenes = paths.filter(|path| path.extension() == Some(OsStr::new("toml")));
    let mut looks: Vec<_> = scenes
        .filter_map(|path| {
            let text = std::fs::read_to_string(&path).ok()?;
            Some(Stored {
                name: path.file_stem()?.to_str()?.to_owned(),
                description: Arc::new(Description::from_toml(&text, &path).ok()?),
            })
        })
        .collect();
    // Snapshot 10 comes after Snapshot 9.
    looks.sort_by(|a, b| (a.name.len(), &a.name).cmp(&(b.name.len(), &b.name)));
    looks
}

/// The pictures of looks, with their names, as they are read in the background.
pub(super) fn read_pictures(
    folder: &Path,
    names: Vec<String>,
    wake: egui::Context,
) -> Receiver<(String, Arc<ColorImage>)> {
    let (tell, told) = channel();
    let folder = folder.to_owned();
    let work = move || {
        for name in names {
            let picture = std::fs::read(picture_path(&folder, &name)).ok();
            let picture = picture.and_then(|bytes| image::load_from_memory(&bytes).ok());
            if let Some(picture) = picture {
                let size = [picture.width() as usize, picture.height() as usize];
                let pixels = ColorImage::from_rgb(size, picture.into_rgb8().as_raw());
                let _ = tell.send((name, Arc::new(pixels)));
                wake.request_repaint();
            }
        }
    };
    // Without a thread the looks are there, without pictures.
    let _ = std::thread::Builder::new()
        .name("looks".to_owned())
        .spawn(work);
    told
}

/// Writes a look; the paths in its description start from `base_dir`.
///
/// # Errors
/// Why it cannot be written.
pub(super) fn write(
    folder: &Path,
    name: &str,
    description: &Description,
    base_dir: &Path,
) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let text = rebased(description, base_dir, folder).to_toml();
    let text = text.map_err(|error| error.to_string())?;
    write_atomically(scene_path(folder, name), text.as_bytes()).map_err(|error| error.to_string())
}

/// Writes the picture of a look, in the background.
pub(super) fn write_picture(folder: &Path, name: &str, pixels: Arc<ColorImage>) {
    let (folder, name) = (folder.to_owned(), name.to_owned());
    let work = move || {
        let mut png = Vec::new();
        let size = pixels.size.map(|side| side as u32);
        let encoder = image::codecs::png::PngEncoder::new(&mut png);
        let encoded =
            encoder.write_image(pixels.as_raw(), size[0], size[1], ExtendedColorType::Rgba8);
        // A look without a picture is a look.
        if encoded.is_ok() {
            let _ = write_atomically(picture_path(&folder, &name), &png);
        }
        // The look may have been deleted meanwhile.
        if !scene_path(&folder, &name).exists() {
            remove(&folder, &name);
        }
    };
    let _ = std::thread::Builder::new()
        .name("look".to_owned())
        .spawn(work);
}

/// Removes a look, and the folder with the last one.
pub(super) fn remove(folder: &Path, name: &str) {
    let _ = std::fs::remove_file(scene_path(folder, name));
    let _ = std::fs::remove_file(picture_path(folder, name));
    let _ = std::fs::remove_dir(folder);
}

fn scene_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.toml"))
}

fn picture_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.png"))
}
