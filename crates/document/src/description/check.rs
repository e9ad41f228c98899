//! Checks of the ranges of numbers, whoever wrote them.

use std::collections::HashSet;

use hairline_model::text::shown;

use super::keyed::Keyed;
use super::ranges::{Check, each};
use super::{Description, Grating, Scratches};
use crate::error::Error;

impl Description {
    /// Refuses values out of range. References between tables are checked where they are resolved.
    ///
    /// # Errors
    /// What is out of range, and where.
    pub fn check(&self) -> Result<(), Error> {
        self.camera.check_keys("camera")?;
        self.render.check_keys("render")?;
        if let Some(environment) = &self.environment {
            environment.check_keys("environment")?;
        }
        self.studio.check_keys("studio")?;
        if let Some(ground) = &self.ground {
            ground.check_keys("ground")?;
        }
        each("material", &self.materials, Keyed::check_keys)?;
        unique("material", self.materials.iter().map(|m| m.name.as_str()))?;
        if self.objects.is_empty() && self.ground.is_none() {
            let right = "must have at least one `[[object]]`, or a `[ground]`";
            return Err(Error::new("object", "found no object", right));
        }
        each("object", &self.objects, Keyed::check_keys)?;
        unique("object", self.objects.iter().map(|o| o.name.as_str()))?;
        check_layers(&self.scratches)?;
        check_gratings(&self.gratings)?;
        each("light", &self.lights, Keyed::check_keys)?;
        each("look", &self.looks, Keyed::check_keys)?;
        unique("look", self.looks.iter().map(|look| look.name.as_str()))
    }
}

fn unique<'n>(key: &str, names: impl Iterator<Item = &'n str>) -> Check {
    let mut seen = HashSet::new();
    for (i, name) in names.enumerate() {
        let key_path = format!("{key}[{i}].name");
        if name.is_empty() {
            return Err(Error::new(
                key_path,
                "found an empty name",
                "must not be empty",
            ));
        }
        if !seen.insert(name) {
            let found = format!("found a second {key} called \"{}\"", shown(name));
            return Err(Error::new(key_path, found, "names must differ"));
        }
    }
    Ok(())
}

/// Checks the tables `[[scratches]]`.
pub(super) fn check_layers(layers: &[Scratches]) -> Check {
    each("scratches", layers, Keyed::check_keys)
}

/// Checks the tables `[[grating]]`.
pub(super) fn check_gratings(gratings: &[Grating]) -> Check {
    each("grating", gratings, Keyed::check_keys)
}
