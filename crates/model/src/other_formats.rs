//! Models of other formats, made into glTF in memory: whatever reads glTF reads them.

mod creased;
mod obj;
mod statements;
mod stl;
mod translated;

use std::path::PathBuf;

use hairline_image::FilePath;

use crate::flaw::Flaw;
use crate::packed;

pub(crate) use translated::Translated;

/// A format by the ending of a file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OtherFormat {
    /// Wavefront's, with materials in .mtl files.
    Obj,
    /// Of 3D printers: triangles alone.
    Stl,
}

impl OtherFormat {
    /// The format of the file that a path leads into; none of glTF and of unknown ones.
    pub(crate) fn from_path(path: &FilePath) -> Option<Self> {
        let file = packed::file_of(path);
        let ending = file.extension()?;
        let formats = [("obj", Self::Obj), ("stl", Self::Stl)];
        let found = formats
            .iter()
            .find(|(name, _)| ending.eq_ignore_ascii_case(name));
        found.map(|(_, format)| *format)
    }

    /// Makes glTF of a file's bytes.
    pub(crate) fn translated(self, path: &FilePath, bytes: &[u8]) -> Result<Translated, Flaw> {
        match self {
            Self::Obj => obj::translated(bytes, &path.folder()),
            Self::Stl => stl::translated(bytes),
        }
    }

    /// The files that a file names, each with its use; none where it cannot be read.
    pub(crate) fn names(self, path: &FilePath) -> Vec<(String, PathBuf)> {
        match self {
            Self::Obj => obj::names(path).unwrap_or_default(),
            Self::Stl => Vec::new(),
        }
    }

    /// Bytes of a file for each triangle, at least.
    pub(crate) fn bytes_a_triangle(self) -> f64 {
        match self {
            // `f 1 2 3`, and half a vertex.
            Self::Obj => 20.0,
            Self::Stl => 50.0,
        }
    }
}
