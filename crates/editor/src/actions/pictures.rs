//! Pictures of the scene that a file holds: masks, maps of density and direction, pictures on lights.

use std::path::Path;

use hairline_document::Description;
use hairline_document::description::{FileUse, Grating, GroovePattern, Light, Scratches};

use super::{ActionError, list};
use crate::{Selection, paths};

/// A picture's place in a description: the part by its index, and its key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureOf {
    /// `where.mask` of a `[[scratches]]`.
    LayerMask(usize),
    /// `where.density` of a `[[scratches]]`.
    LayerDensity(usize),
    /// `file` of a `[[scratches]]` that is a drawing.
    Drawing(usize),
    /// `mask` of a `[[grating]]`.
    GratingMask(usize),
    /// `directions` of a `[[grating]]` along texture coordinates.
    GratingDirections(usize),
    /// `picture` of a `[[light]]`.
    Light(usize),
    /// `behind` of `[render]`.
    Behind,
}

/// Names a picture's file, written relative to `base_dir`, the document's.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn set(
    description: &mut Description,
    of: PictureOf,
    file: &Path,
    base_dir: &Path,
) -> Result<Selection, ActionError> {
    let written = paths::written(file, base_dir);
    let file = Some(written.clone());
    Ok(match of {
        PictureOf::LayerMask(i) => {
            list::get_mut::<Scratches>(description, i)?.place.mask = file;
            Selection::Layer(i)
        }
        PictureOf::LayerDensity(i) => {
            list::get_mut::<Scratches>(description, i)?.place.density = file;
            Selection::Layer(i)
        }
        PictureOf::Drawing(i) => {
            let mut files = description.files_mut().into_iter();
            let named = files.find(|(used, _)| *used == FileUse::Drawing(i));
            let (_, place) = named.ok_or(ActionError::Missing("drawing"))?;
            *place = written;
            Selection::Layer(i)
        }
        PictureOf::GratingMask(i) => {
            list::get_mut::<Grating>(description, i)?.mask = file;
            Selection::Grating(i)
        }
        PictureOf::GratingDirections(i) => {
            match &mut list::get_mut::<Grating>(description, i)?.pattern {
                GroovePattern::Uv { directions, .. } => *directions = file,
                _ => return Err(ActionError::Missing("map of directions")),
            }
            Selection::Grating(i)
        }
        PictureOf::Light(i) => {
            list::get_mut::<Light>(description, i)?.picture = file;
            Selection::Light(i)
        }
        // The camera's panel has it.
        PictureOf::Behind => {
            description.render.behind = file;
            Selection::Camera
        }
    })
}
