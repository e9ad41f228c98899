//! References: the names that tables call one another by.

use hairline_model::text::shown;

use super::Description;
use super::hint::nearest;
use crate::error::Error;

impl Description {
    /// Refuses names of materials and objects that the scene does not have.
    ///
    /// # Errors
    /// The first such name, and where.
    pub fn check_references(&self) -> Result<(), Error> {
        let materials = self.materials.iter().map(|m| m.name.as_str());
        for (i, object) in self.objects.iter().enumerate() {
            if let Some(name) = &object.material {
                let key = format!("object[{i}].material");
                find(name, materials.clone(), &key, "material")?;
            }
        }
        let objects = self.objects.iter().map(|o| o.name.as_str());
        for (i, scratches) in self.scratches.iter().enumerate() {
            let key = format!("scratches[{i}].object");
            find(&scratches.object, objects.clone(), &key, "object")?;
        }
        self.check_gratings()
    }

    /// Refuses gratings on objects that the scene does not have.
    pub(crate) fn check_gratings(&self) -> Result<(), Error> {
        let objects = self.objects.iter().map(|o| o.name.as_str());
        for (i, grating) in self.gratings.iter().enumerate() {
            let key = format!("grating[{i}].object");
            find(&grating.object, objects.clone(), &key, "object")?;
        }
        Ok(())
    }
}

/// The index of the table called `name`.
pub(crate) fn find<'n>(
    name: &str,
    names: impl Iterator<Item = &'n str> + Clone,
    key: &str,
    table: &str,
) -> Result<usize, Error> {
    names
        .clone()
        .position(|other| other == name)
        .ok_or_else(|| {
            let right = match (nearest(name, names.clone()), names.count()) {
                (Some(near), _) => format!("did you mean \"{}\"?", shown(near)),
                (None, 0) => format!("there is no `[[{table}]]` in the scene; add one"),
                (None, _) => format!("must be the name of a `[[{table}]]`"),
            };
            let found = format!("found no {table} called \"{}\"", shown(name));
            Error::new(key, found, right)
        })
}
