//! Pictures of the scene that a file holds: masks, maps of density and direction, pictures on lights.

use std::path::{Path, PathBuf};

use hairline_document::Description;
use hairline_document::description::{Grating, GroovePattern, Light, Scratches};

use super::{ActionError, list};
use crate::{Selection, paths};

/// A picture's place in a description: the part by its index, and its key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureOf {
    /// `where.mask` of a `[[scratches]]`.
    LayerMask(usize),
    /// `where.density` of a `[[scratches]]`.
    LayerDensity(usize),
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
    let (place, selection) = place(description, of)?;
    *place = Some(paths::written(file, base_dir));
    Ok(selection)
}

fn place(
    description: &mut Description,
    of: PictureOf,
) -> Result<(&mut Option<PathBuf>, Selection), ActionError> {
    Ok(match of {
        PictureOf::LayerMask(i) => {
            let layer = list::get_mut::<Scratches>(description, i)?;
            (&mut layer.place.mask, Selection::Layer(i))
        }
        PictureOf::LayerDensity(i) => {
            let layer = list::get_mut::<Scratches>(description, i)?;
            (&mut layer.place.density, Selection::Layer(i))
        }
        PictureOf::GratingMask(i) => {
            let grating = list::get_mut::<Grating>(description, i)?;
            (&mut grating.mask, Selection::Grating(i))
        }
        PictureOf::GratingDirections(i) => {
            match &mut list::get_mut::<Grating>(description, i)?.pattern {
                GroovePattern::Uv { directions, .. } => (directions, Selection::Grating(i)),
                _ => return Err(ActionError::Missing("map of directions")),
            }
        }
        PictureOf::Light(i) => {
            let light = list::get_mut::<Light>(description, i)?;
            (&mut light.picture, Selection::Light(i))
        }
        // The camera's panel has it.
        PictureOf::Behind => (&mut description.render.behind, Selection::Camera),
    })
}
