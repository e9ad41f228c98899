//! Common interface of the parts in the lists of a description: most have a name, and they are copied, moved and removed.

use hairline_document::Description;
use hairline_document::description::{Grating, Light, Look, Material, Object, Scratches};

use super::{ActionError, unique_name};
use crate::Selection;
use crate::selection::{after_removal, after_swap};

/// A part of a description that stands in a list.
pub(crate) trait ListedPart: Clone + 'static {
    /// Name of the kind in errors.
    const WHAT: &'static str;
    /// [`Self::WHAT`] with its article.
    const A_WHAT: &'static str;

    /// Its list in a description.
    fn list(description: &Description) -> &Vec<Self>;
    /// Its list in a description, to change.
    fn list_mut(description: &mut Description) -> &mut Vec<Self>;
    /// The selection of the one at a place.
    fn selection_at(place: usize) -> Selection;
    /// The place, if one of these is selected.
    fn place(selection: Selection) -> Option<usize>;
    /// Name of the part, if it has one.
    fn name(&self) -> Option<&str>;
    /// Sets its name, which is not empty, or removes one that may be missing.
    fn set_name(&mut self, name: Option<String>);
    /// Whether they are listed one after the other, so that they can change places.
    fn is_listed_with(&self, _other: &Self) -> bool {
        true
    }
}

/// The part at a place.
pub(crate) fn get<P: ListedPart>(
    description: &Description,
    index: usize,
) -> Result<&P, ActionError> {
    let part = P::list(description).get(index);
    part.ok_or(ActionError::Missing(P::WHAT))
}

/// The part at a place, to change.
pub(crate) fn get_mut<P: ListedPart>(
    description: &mut Description,
    index: usize,
) -> Result<&mut P, ActionError> {
    let part = P::list_mut(description).get_mut(index);
    part.ok_or(ActionError::Missing(P::WHAT))
}

/// Puts a part in its list, under another name if its own is taken.
pub(super) fn insert<P: ListedPart>(
    description: &mut Description,
    place: usize,
    mut part: P,
) -> Selection {
    if let Some(name) = part.name() {
        let others = P::list(description).iter();
        let name = unique_name(name, others.filter_map(P::name));
        part.set_name(Some(name));
    }
    P::list_mut(description).insert(place, part);
    P::selection_at(place)
}

/// Removes a part from its list. If it was selected, the part in its place is selected then, or the last one.
pub(super) fn remove<P: ListedPart>(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    get::<P>(description, index)?;
    P::list_mut(description).remove(index);
    Ok(match P::place(selection) {
        Some(i) => {
            let left = P::list(description).len();
            after_removal(i, index, left).map_or(Selection::None, P::selection_at)
        }
        None => selection,
    })
}

/// Removes a part that lies on an object. Where it was selected, the next one on the same object is, else the object.
pub(super) fn remove_from_object<P: ListedPart>(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    let removed = get::<P>(description, index)?.clone();
    let object = P::selection_at(index).object(description);
    let after = remove::<P>(description, index, selection)?;
    if selection != P::selection_at(index) {
        return Ok(after);
    }
    let list = P::list(description);
    let is_beside = |i: &usize| list[*i].is_listed_with(&removed);
    // The part in its place, else the nearest one before it.
    let next = (index..list.len()).find(is_beside);
    let next = next.or_else(|| (0..index).rev().find(is_beside));
    Ok(match next {
        Some(i) => P::selection_at(i),
        None => object.map_or(Selection::None, Selection::Object),
    })
}

/// Changes places with the next part up (`by` -1) or down (1) that it is listed with; at the end nothing happens.
pub(super) fn shift<P: ListedPart>(
    description: &mut Description,
    index: usize,
    by: isize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    let part = get::<P>(description, index)?;
    let list = P::list(description);
    let is_listed_with = |i: &usize| part.is_listed_with(&list[*i]);
    let other = match by {
        ..0 => (0..index).rev().find(is_listed_with),
        0 => None,
        1.. => (index + 1..list.len()).find(is_listed_with),
    };
    let Some(other) = other else {
        return Ok(selection);
    };
    P::list_mut(description).swap(index, other);
    Ok(match P::place(selection) {
        Some(i) => P::selection_at(after_swap(i, index, other)),
        None => selection,
    })
}

/// Renames a part to which others refer by name. Returns the old and the new name, for the references.
pub(super) fn rename_known<P: ListedPart>(
    description: &mut Description,
    index: usize,
    name: &str,
) -> Result<[String; 2], ActionError> {
    let old = get::<P>(description, index)?.name().unwrap_or_default();
    let (old, name) = (old.to_owned(), name.trim().to_owned());
    if name.is_empty() {
        return Err(ActionError::EmptyName);
    }
    let mut others = P::list(description).iter().enumerate();
    if others.any(|(i, other)| i != index && other.name() == Some(&name)) {
        let what = P::A_WHAT;
        return Err(ActionError::NameTaken { what, name });
    }
    get_mut::<P>(description, index)?.set_name(Some(name.clone()));
    Ok([old, name])
}

/// The places of the parts that are so.
pub(super) fn places<P: ListedPart>(
    description: &Description,
    is_so: impl Fn(&P) -> bool,
) -> Vec<usize> {
    let parts = P::list(description).iter().enumerate();
    parts
        .filter(|(_, part)| is_so(part))
        .map(|(i, _)| i)
        .collect()
}

macro_rules! part {
    ($part:ty, $what:literal, $a_what:literal, $list:ident, $selection:ident, { $($own:item)* }) => {
        impl ListedPart for $part {
            const WHAT: &'static str = $what;
            const A_WHAT: &'static str = $a_what;

            fn list(description: &Description) -> &Vec<Self> {
                &description.$list
            }
            fn list_mut(description: &mut Description) -> &mut Vec<Self> {
                &mut description.$list
            }
            fn selection_at(place: usize) -> Selection {
                Selection::$selection(place)
            }
            fn place(selection: Selection) -> Option<usize> {
                match selection {
                    Selection::$selection(place) => Some(place),
                    _ => None,
                }
            }
            $($own)*
        }
    };
}

part!(Object, "object", "an object", objects, Object, {
    fn name(&self) -> Option<&str> {
        Some(&self.name)
    }
    fn set_name(&mut self, name: Option<String>) {
        self.name = name.unwrap_or_default();
    }
});

part!(Material, "material", "a material", materials, Material, {
    fn name(&self) -> Option<&str> {
        Some(&self.name)
    }
    fn set_name(&mut self, name: Option<String>) {
        self.name = name.unwrap_or_default();
    }
});

part!(Light, "light", "a light", lights, Light, {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }
    fn set_name(&mut self, name: Option<String>) {
        self.name = name;
    }
});

part!(Look, "look", "a look", looks, Look, {
    fn name(&self) -> Option<&str> {
        Some(&self.name)
    }
    fn set_name(&mut self, name: Option<String>) {
        self.name = name.unwrap_or_default();
    }
});

part!(Grating, "grating", "a grating", gratings, Grating, {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }
    fn set_name(&mut self, name: Option<String>) {
        self.name = name;
    }
    fn is_listed_with(&self, other: &Self) -> bool {
        self.object == other.object
    }
});

part!(Scratches, "layer", "a layer", scratches, Layer, {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }
    fn set_name(&mut self, name: Option<String>) {
        self.name = name;
    }
    // An artist sees the layers of one object at a time.
    fn is_listed_with(&self, other: &Self) -> bool {
        self.object == other.object
    }
});
