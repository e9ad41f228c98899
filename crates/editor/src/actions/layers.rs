//! Layers of scratches.

use hairline_scene::Description;
use hairline_scene::description::limits::LARGEST_SEED;
use hairline_scene::description::{Layer, Pattern, Scratches};

use super::{ActionError, unique_name};
use crate::Selection;
use crate::selection::{after_removal, after_swap};

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

/// Adds a copy behind the original, with a seed of its own: the same wear, other scratches.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let copy = get(description, index)?.clone();
    Ok(insert(description, index + 1, copy))
}

/// Gives a layer a seed that no other one has: the same wear, other scratches. Layers without a seed stay as they are.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn reseed(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    get(description, index)?;
    let seed = free_seed(description);
    if let Some(own) = description.scratches[index].layer.seed_mut() {
        *own = seed;
    }
    Ok(Selection::Layer(index))
}

/// Removes a layer. Where it was selected, the next one on the same object is, else the object.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn delete(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    let object = get(description, index)?.object.clone();
    description.scratches.remove(index);
    Ok(match selection {
        Selection::Layer(i) if i == index => {
            let on_object = |i: &usize| {
                let layer = description.scratches.get(*i);
                layer.is_some_and(|layer| layer.object == object)
            };
            // Its place is the next layer's now; else the nearest one before it.
            let next = (index..description.scratches.len()).find(on_object);
            match next.or_else(|| (0..index).rev().find(on_object)) {
                Some(i) => Selection::Layer(i),
                None => {
                    let object = description.objects.iter().position(|o| o.name == object);
                    object.map_or(Selection::None, Selection::Object)
                }
            }
        }
        Selection::Layer(i) => after_removal(i, index, description.scratches.len())
            .map_or(Selection::None, Selection::Layer),
        other => other,
    })
}

/// Changes places with the next layer of the same object up (`by` -1) or down (1); at the end nothing happens.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn shift(
    description: &mut Description,
    index: usize,
    by: isize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    let object = &get(description, index)?.object;
    let is_on_it = |i: &usize| description.scratches[*i].object == *object;
    let other = match by {
        ..0 => (0..index).rev().find(is_on_it),
        0 => None,
        1.. => (index + 1..description.scratches.len()).find(is_on_it),
    };
    let Some(other) = other else {
        return Ok(selection);
    };
    description.scratches.swap(index, other);
    Ok(match selection {
        Selection::Layer(i) => Selection::Layer(after_swap(i, index, other)),
        held => held,
    })
}

/// Gives a layer a name; an empty one takes it away.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn rename(
    description: &mut Description,
    index: usize,
    name: &str,
) -> Result<Selection, ActionError> {
    let name = Some(name.trim()).filter(|name| !name.is_empty());
    get_mut(description, index)?.name = name.map(str::to_owned);
    Ok(Selection::Layer(index))
}

/// Hides a layer or shows it again.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn toggle_hidden(
    description: &mut Description,
    index: usize,
) -> Result<Selection, ActionError> {
    let layer = get_mut(description, index)?;
    layer.hidden = !layer.hidden;
    Ok(Selection::Layer(index))
}

/// Makes a layer solo or lets it be one of all again. While any is solo, the scene shows only those.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn toggle_solo(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let layer = get_mut(description, index)?;
    layer.solo = !layer.solo;
    Ok(Selection::Layer(index))
}

/// Whether the scene shows a layer: it is not hidden, and solo if any layer is.
pub fn is_shown(description: &Description, index: usize) -> bool {
    let any_solo = description.scratches.iter().any(|layer| layer.solo);
    let layer = description.scratches.get(index);
    layer.is_some_and(|layer| !layer.hidden && (layer.solo || !any_solo))
}

/// What a list calls a layer: its name, else its pattern.
pub fn title(layer: &Scratches) -> &str {
    match (&layer.name, &layer.layer) {
        (Some(name), _) => name,
        (None, Layer::Listed(_)) => "scratches of a file",
        (None, Layer::Brushed(_)) => "drawn scratches",
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

/// Puts a layer on another object.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn move_to(
    description: &mut Description,
    index: usize,
    object: usize,
) -> Result<Selection, ActionError> {
    get(description, index)?;
    let object = description.objects.get(object);
    let name = &object.ok_or(ActionError::Missing("object"))?.name;
    description.scratches[index].object = name.clone();
    Ok(Selection::Layer(index))
}

/// The least seed above every other: it stays new when layers come and go in between.
pub fn free_seed(description: &Description) -> u64 {
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
    if let Some(name) = &mut layer.name {
        let others = description.scratches.iter();
        *name = unique_name(name, others.filter_map(|other| other.name.as_deref()));
    }
    description.scratches.insert(place, layer);
    Selection::Layer(place)
}

fn get(description: &Description, index: usize) -> Result<&Scratches, ActionError> {
    let layer = description.scratches.get(index);
    layer.ok_or(ActionError::Missing("layer"))
}

fn get_mut(description: &mut Description, index: usize) -> Result<&mut Scratches, ActionError> {
    let layer = description.scratches.get_mut(index);
    layer.ok_or(ActionError::Missing("layer"))
}
