//! The files that a scene names. Whoever asks for them asks here: a key that takes a file is added in one place.

use std::path::PathBuf;

use super::{Description, GroovePattern, Layer, Line, Map, Surface};

/// Use of a file in a scene; numbers are those of the tables that name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileUse {
    /// The map of `[environment]`.
    Map,
    /// The picture behind the objects.
    Behind,
    /// The mesh of an `[[object]]`.
    Mesh(usize),
    /// The list of a layer of `[[scratches]]`.
    ScratchList(usize),
    /// The drawing of a layer of `[[scratches]]`.
    Drawing(usize),
    /// A picture of where the scratches of a layer are.
    ScratchPicture(usize),
    /// A picture of a `[[grating]]`.
    GratingPicture(usize),
    /// The picture of a `[[light]]`.
    LightPicture(usize),
    /// The map of the environment of a `[[look]]`, or the picture of one of its lights.
    Look(usize),
}

/// One walk, to be read and to be changed.
macro_rules! walk {
    ($description:expr, $iter:ident, $($mutable:tt)?) => {{
        let mut files = Vec::new();
        if let Some(environment) = &$($mutable)? $description.environment
            && let Map::File(file) = &$($mutable)? environment.map
        {
            files.push((FileUse::Map, file));
        }
        let behind = $description.render.behind.$iter();
        files.extend(behind.map(|file| (FileUse::Behind, file)));
        for (i, object) in $description.objects.$iter().enumerate() {
            if let Surface::Mesh(file) = &$($mutable)? object.surface {
                files.push((FileUse::Mesh(i), file));
            }
        }
        for (i, scratches) in $description.scratches.$iter().enumerate() {
            match &$($mutable)? scratches.layer {
                Layer::Listed(listed) => {
                    files.push((FileUse::ScratchList(i), &$($mutable)? listed.file));
                }
                Layer::Engraved(engraved) => {
                    if let Line::Svg { file, .. } = &$($mutable)? engraved.line {
                        files.push((FileUse::Drawing(i), file));
                    }
                }
                Layer::Laid(_) | Layer::Brushed(_) => {}
            }
            let place = &$($mutable)? scratches.place;
            let pictures = place.mask.$iter().chain(place.density.$iter());
            files.extend(pictures.map(|file| (FileUse::ScratchPicture(i), file)));
        }
        for (i, grating) in $description.gratings.$iter().enumerate() {
            let mask = grating.mask.$iter();
            files.extend(mask.map(|file| (FileUse::GratingPicture(i), file)));
            if let GroovePattern::Uv { directions, .. } = &$($mutable)? grating.pattern {
                let directions = directions.$iter();
                files.extend(directions.map(|file| (FileUse::GratingPicture(i), file)));
            }
        }
        for (i, light) in $description.lights.$iter().enumerate() {
            let picture = light.picture.$iter();
            files.extend(picture.map(|file| (FileUse::LightPicture(i), file)));
        }
        for (i, look) in $description.looks.$iter().enumerate() {
            if let Some(environment) = &$($mutable)? look.environment
                && let Map::File(file) = &$($mutable)? environment.map
            {
                files.push((FileUse::Look(i), file));
            }
            let pictures = look.lights.$iter();
            let pictures = pictures.flat_map(|light| light.picture.$iter());
            files.extend(pictures.map(|file| (FileUse::Look(i), file)));
        }
        files
    }};
}

impl Description {
    /// All files that the description names, with the paths as written.
    pub fn files(&self) -> Vec<(FileUse, &PathBuf)> {
        walk!(self, iter,)
    }

    /// [`Self::files`] as mutable paths.
    pub fn files_mut(&mut self) -> Vec<(FileUse, &mut PathBuf)> {
        walk!(self, iter_mut, mut)
    }
}
