//! The bytes that a glTF file refers to: its own binary chunk, other files, data URIs.

use std::collections::HashMap;

use gltf::Gltf;
use gltf::buffer::View;
use hairline_image::FilePath;

use super::meshopt;
use super::stock::FILE_SHARE;
use crate::flaw::Flaw;
use crate::reading::{self, FileKind};
use crate::text::shown;

/// The file's buffers, each at least as long as the file says.
pub(super) struct Buffers {
    /// Some have no bytes: they only stand for some that are packed elsewhere, or are not used.
    whole: Vec<Option<Vec<u8>>>,
    /// The views that were packed by themselves.
    unpacked: HashMap<usize, Vec<u8>>,
}

impl Buffers {
    pub(super) fn read(
        gltf: &Gltf,
        base_dir: &FilePath,
        files: &mut Vec<FilePath>,
    ) -> Result<Self, Flaw> {
        let read = |buffer: gltf::Buffer| {
            let what = format!("buffer {}", buffer.index());
            let bytes = match buffer.source() {
                gltf::buffer::Source::Uri(_) if meshopt::is_stand_in(&buffer) => return Ok(None),
                gltf::buffer::Source::Uri(uri) => resource(uri, base_dir, &what, files)?,
                // The chunk belongs to the first one; others have no bytes.
                gltf::buffer::Source::Bin => match &gltf.blob {
                    Some(blob) if buffer.index() == 0 => blob.clone(),
                    _ => return Ok(None),
                },
            };
            if bytes.len() < buffer.length() {
                return Err(Flaw::new(
                    format!(
                        "its {what} is cut off: {} of {} bytes are there",
                        bytes.len(),
                        buffer.length()
                    ),
                    "must be whole; export or copy the file again",
                ));
            }
            Ok(Some(bytes))
        };
        let buffers = gltf.document.buffers().map(read);
        let whole = buffers.collect::<Result<Vec<_>, _>>()?;
        let is_packed =
            |view: &View| whole[view.buffer().index()].is_none() && meshopt::is_packed(view);
        // Stand-ins for packed bytes were counted before the file was read.
        let stand_ins = gltf
            .document
            .buffers()
            .filter(|it| whole[it.index()].is_none());
        let mut free: usize = stand_ins
            .map(|it| it.length())
            .fold(0, usize::saturating_add);
        let mut unpacked = HashMap::new();
        for view in gltf.document.views().filter(is_packed) {
            free = free.checked_sub(view.length()).ok_or_else(|| {
                let found = format!(
                    "its buffer view {} and those before it are longer unpacked than their buffers are",
                    view.index()
                );
                Flaw::new(found, "must lie in their buffers, beside each other")
            })?;
            unpacked.insert(view.index(), meshopt::unpack(&view, &whole)?);
        }
        Ok(Self { whole, unpacked })
    }

    /// The bytes of a view.
    pub(super) fn view(&self, view: &View) -> Result<&[u8], Flaw> {
        if let Some(bytes) = self.unpacked.get(&view.index()) {
            return Ok(bytes);
        }
        let buffer = view.buffer().index();
        let bytes = self.whole[buffer].as_ref().ok_or_else(|| {
            Flaw::new(
                format!("its buffer {buffer} has neither a `uri` nor a binary chunk"),
                "must have one of them",
            )
        })?;
        let end = view.offset().checked_add(view.length());
        end.and_then(|end| bytes.get(view.offset()..end))
            .ok_or_else(|| {
                Flaw::new(
                    format!("its buffer view {} reaches beyond its buffer", view.index()),
                    "must end within it",
                )
            })
    }
}

/// Whether a URI is its own contents. Schemes have no case (RFC 3986, section 3.1).
pub(crate) fn is_data(uri: &str) -> bool {
    (uri.get(..5)).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"))
}

/// Reads a URI of a glTF file: a data URI or a file beside it, which is added to `files`.
pub(crate) fn resource(
    uri: &str,
    base_dir: &FilePath,
    what: &str,
    files: &mut Vec<FilePath>,
) -> Result<Vec<u8>, Flaw> {
    if is_data(uri) {
        let (head, data) = uri.split_once(',').unwrap_or((uri, ""));
        let head = head.to_ascii_lowercase();
        let bytes = unescaped(data);
        if !head.ends_with(";base64") {
            return Ok(bytes);
        }
        // Texts that were broken into lines keep their ends; base64 has no white space.
        let mut data = String::from_utf8_lossy(&bytes).into_owned();
        data.retain(|c| !c.is_ascii_whitespace());
        // The gltf crate decodes what follows `;base64,`, in small letters.
        let uri = format!("{head},{data}");
        return gltf::buffer::Data::from_source(gltf::buffer::Source::Uri(&uri), None)
            .map(|data| data.0)
            .map_err(|error| {
                Flaw::new(
                    format!("the data URI of its {what} cannot be decoded ({error})"),
                    "must be base64",
                )
            });
    }
    let right = "must be a file, by a path relative to the glTF file";
    let name = percent_decoded(uri);
    // Start of a path of Windows, on any system.
    let has_drive = name.get(1..3).is_some_and(|it| it == ":\\" || it == ":/");
    if uri.contains("://") || uri.starts_with("file:") || name.starts_with(['/', '\\']) || has_drive
    {
        return Err(Flaw::new(
            format!("its {what} is at \"{}\"", shown(uri)),
            right,
        ));
    }
    let path = resolve_uri(uri, base_dir);
    files.push(path.clone());
    reading::read(&path, FileKind::File, FILE_SHARE).map_err(|error| {
        let found = format!(
            "its {what}, \"{}\", cannot be read ({error})",
            path.display()
        );
        Flaw::new(found, right)
    })
}

/// The file that a URI names. Where there is none: names that exporters left unescaped, and backslashes of Windows between folders.
pub(super) fn resolve_uri(uri: &str, base_dir: &FilePath) -> FilePath {
    let name = percent_decoded(uri);
    let others = [uri, &name.replace('\\', "/")].map(|name| base_dir.join(name));
    let path = base_dir.join(name);
    let is_there = |path: &FilePath| path.open().is_ok();
    let other = others.into_iter().find(|it| *it != path && is_there(it));
    match is_there(&path) {
        true => path,
        false => other.unwrap_or(path),
    }
}

/// `%20` and the like, RFC 3986, section 2.1. What is no escape stays.
fn percent_decoded(uri: &str) -> String {
    String::from_utf8(unescaped(uri)).unwrap_or_else(|_| uri.to_owned())
}

fn unescaped(uri: &str) -> Vec<u8> {
    let bytes = uri.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let escaped = (bytes[i] == b'%')
            .then(|| uri.get(i + 1..i + 3))
            .flatten()
            .and_then(|hex| u8::from_str_radix(hex, 16).ok());
        decoded.push(escaped.unwrap_or(bytes[i]));
        i += if escaped.is_some() { 3 } else { 1 };
    }
    decoded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_are_decoded_and_the_rest_stays() {
        for (uri, path) in [
            ("a%20b.bin", "a b.bin"),
            ("caf%C3%A9.png", "café.png"),
            ("100%.bin", "100%.bin"),
            ("%zz%4", "%zz%4"),
            ("%ff.bin", "%ff.bin"),
            ("%é", "%é"),
        ] {
            assert_eq!(percent_decoded(uri), path);
        }
    }
}
