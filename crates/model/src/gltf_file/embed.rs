//! Files and data URIs that a glTF file names, taken into its one buffer.

use hairline_image::FilePath;
use serde_json::{Value, json};

use super::{GltfFile, push};
use crate::flaw::Flaw;
use crate::mesh_file;

/// Extensions whose views lie in buffers that they name by themselves.
const PACKED_VIEWS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

impl GltfFile {
    /// Length of the binary chunk up to the end of what views use of it.
    pub(super) fn used_length(&self) -> usize {
        let get = |view: &Value, name: &str| view.get(name).and_then(Value::as_u64).unwrap_or(0);
        let end = |view: &Value| match get(view, "buffer") {
            0 => get(view, "byteOffset").saturating_add(get(view, "byteLength")),
            _ => 0,
        };
        let views = self.list("bufferViews").iter();
        let ends = views.flat_map(|view| {
            let packed = PACKED_VIEWS.map(|name| view.get("extensions")?.get(name));
            std::iter::once(end(view)).chain(packed.into_iter().flatten().map(end))
        });
        ends.max().unwrap_or(0) as usize
    }

    /// Takes in all that buffers and images name. Buffers without bytes, which stand for packed ones, stay behind the one with all bytes.
    pub(super) fn embed(&mut self, folder: &FilePath) -> Result<(), Flaw> {
        let has_chunk = !self.bin.is_empty();
        // Number and offset that each buffer gets.
        let mut places = Vec::new();
        let mut kept = Vec::new();
        for (i, buffer) in self.list("buffers").to_vec().into_iter().enumerate() {
            match buffer.get("uri").and_then(Value::as_str) {
                Some(uri) => {
                    let what = format!("buffer {i}");
                    let bytes = mesh_file::resource(uri, folder, &what, &mut Vec::new())?;
                    places.push((0, self.append(&bytes)));
                }
                None if i == 0 && has_chunk => places.push((0, 0)),
                None => {
                    kept.push(buffer);
                    places.push((kept.len(), 0));
                }
            }
        }
        if !places.is_empty() {
            // An empty buffer is none.
            let first = json!({ "byteLength": self.bin.len().max(1) });
            let buffers = std::iter::once(first).chain(kept).collect();
            self.root
                .insert("buffers".to_owned(), Value::Array(buffers));
            if self.bin.is_empty() {
                self.bin.resize(4, 0);
            }
        }
        let views = self.root.get_mut("bufferViews");
        for view in views.and_then(Value::as_array_mut).into_iter().flatten() {
            move_view(view, &places);
            if let Some(extensions) = view.get_mut("extensions") {
                let packed = PACKED_VIEWS.map(|name| extensions.get(name).is_some());
                for (name, _) in PACKED_VIEWS.iter().zip(packed).filter(|it| it.1) {
                    move_view(&mut extensions[*name], &places);
                }
            }
        }
        self.embed_images(folder)
    }

    fn embed_images(&mut self, folder: &FilePath) -> Result<(), Flaw> {
        for i in 0..self.list("images").len() {
            let Some(uri) = self.list("images")[i].get("uri").and_then(Value::as_str) else {
                continue;
            };
            let what = format!("image {i}");
            let bytes = mesh_file::resource(uri, folder, &what, &mut Vec::new())?;
            // The model's own from now on.
            let view = self.view_of(&bytes);
            let views = self.root.entry("bufferViews").or_insert_with(|| json!([]));
            let view = push(views, view);
            if let Some(image) = self.element_mut("images", i).and_then(Value::as_object_mut) {
                image.remove("uri");
                image.insert("bufferView".to_owned(), json!(view));
                if let Some(kind) = kind_of(&bytes) {
                    image.insert("mimeType".to_owned(), json!(kind));
                }
            }
        }
        Ok(())
    }
}

/// Puts a view where its buffer is now.
fn move_view(view: &mut Value, places: &[(usize, usize)]) {
    let number = |view: &Value, name: &str| view.get(name).and_then(Value::as_u64);
    let buffer = number(view, "buffer").and_then(|it| places.get(it as usize));
    if let Some((buffer, offset)) = buffer {
        let before = number(view, "byteOffset").unwrap_or(0) as usize;
        view["buffer"] = json!(buffer);
        if before + offset > 0 {
            view["byteOffset"] = json!(before + offset);
        }
    }
}

/// The kind of a picture by its first bytes.
pub(super) fn kind_of(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xff, 0xd8, ..] => Some("image/jpeg"),
        [b'R', b'I', b'F', b'F', ..] => Some("image/webp"),
        [0xab, b'K', b'T', b'X', ..] => Some("image/ktx2"),
        [b'#', b'?', ..] => Some("image/vnd.radiance"),
        [0x76, 0x2f, 0x31, 0x01, ..] => Some("image/x-exr"),
        _ => None,
    }
}
