//! Layers of scratches.

use std::path::Path;

use hairline_document::Description;
use hairline_document::description::LARGEST_SEED;
use hairline_document::description::{Layer, Line, Listed, Object, Pattern, Scratches, standings};

use super::{ActionError, list};
use crate::{Selection, paths};

/// Adds a layer behind the last one of its object, with a seed that no other layer has.
///
/// # Errors
/// [`ActionError::Missing`]: no object of that name.
pub fn add(description: &mut Description, layer: Scratches) -> Result<Selection, ActionError> {
    if !description.objects.iter().any(|o| o.name == layer.object) {
        return Err(ActionError::Missing("object"));
    }
    let last = description
        .scratches
        .iter()
        .rposition(|other| other.object == layer.object);
    Ok(insert(
        description,
        last.map_or(description.scratches.len(), |last| last + 1),
        layer,
    ))
}

/// Adds the scratches of a CSV file to an object; `base_dir` is the scene file's folder.
///
/// # Errors
/// [`ActionError::Missing`]: no such object.
pub fn add_list(
    description: &mut Description,
    object: usize,
    file: &Path,
    base_dir: &Path,
) -> Result<Selection, ActionError> {
    let object = list::get::<Object>(description, object)?.name.clone();
    let file = paths::written(file, base_dir);
    add(
        description,
        Scratches::new(object, Layer::Listed(Listed { file })),
    )
}

/// Adds a copy behind the original, with a seed of its own: equal wear from other scratches.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let copy: Scratches = list::get(description, index).cloned()?;
    Ok(insert(description, index + 1, copy))
}

/// Makes a layer solo, or ends that. While any is solo, the scene shows only those.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn toggle_solo(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let layer: &mut Scratches = list::get_mut(description, index)?;
    layer.solo = !layer.solo;
    Ok(Selection::Layer(index))
}

/// Whether the scene shows a layer: it is not hidden, and solo if any layer is.
pub fn is_shown(description: &Description, index: usize) -> bool {
    standings(&description.scratches)
        .nth(index)
        .is_some_and(|standing| standing.is_shown)
}

/// Title of a layer in a list: its name, else its pattern.
pub fn title(layer: &Scratches) -> &str {
    match (&layer.name, &layer.layer) {
        (Some(name), _) => name,
        (None, Layer::Listed(_)) => "scratches of a file",
        (None, Layer::Brushed(_)) => "drawn scratches",
        (None, Layer::Engraved(engraved)) => match engraved.line {
            Line::Curve { .. } => "curve",
            Line::Text { .. } => "text",
            Line::Svg { .. } => "drawing",
        },
        (None, Layer::Laid(laid)) => match laid.pattern {
            Pattern::Random { .. } => "random scratches",
            Pattern::Parallel { .. } => "parallel scratches",
            Pattern::Circular(_) => "circular scratches",
            Pattern::Radial(_) => "radial scratches",
            Pattern::Spun { .. } => "spun scratches",
            Pattern::Swirl { .. } => "swirls",
        },
    }
}

/// The least seed above every other: it stays new when layers come and go in between.
pub(crate) fn free_seed(description: &Description) -> u64 {
    let seeds = description
        .scratches
        .iter()
        .filter_map(|layer| layer.layer.seed());
    match seeds.clone().max() {
        Some(largest) if largest < LARGEST_SEED => largest + 1,
        Some(_) => (1..)
            .find(|s| !seeds.clone().any(|other| other == *s))
            .unwrap_or(1),
        None => 1,
    }
}

fn insert(description: &mut Description, place: usize, mut layer: Scratches) -> Selection {
    let free = free_seed(description);
    if let Some(seed) = layer.layer.seed_mut() {
        *seed = free;
    }
    list::insert(description, place, layer)
}
