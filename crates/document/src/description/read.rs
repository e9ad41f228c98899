//! Reads parsed TOML to a [`Description`]: its tables, and what one says for another.

use toml::de::{DeTable, DeValue};

use super::camera;
use super::keyed::Keyed;
use super::table::Table;
use super::toml_value::Value;
use super::{Camera, Description, Look, Render, Studio};
use crate::error::Error;

/// Reads a whole scene file.
pub(super) fn description(root: &DeTable) -> Result<Description, Error> {
    let table = Table::open(
        root,
        "",
        &[
            "camera",
            "render",
            "environment",
            "studio",
            "ground",
            "material",
            "object",
            "scratches",
            "grating",
            "light",
            "look",
        ],
    )?;
    let mut description = Description {
        camera: table.required("camera")?,
        render: table.or("render", Render::default())?,
        environment: table.optional("environment")?,
        studio: table.or("studio", Studio::NONE)?,
        ground: table.optional("ground")?,
        materials: table.or("material", Vec::new())?,
        objects: table.or("object", Vec::new())?,
        scratches: table.or("scratches", Vec::new())?,
        gratings: table.or("grating", Vec::new())?,
        lights: table.or("light", Vec::new())?,
        looks: table.or("look", Vec::new())?,
        lights_of: None,
        notes: Vec::new(),
    };
    let size_px = description.render.size_px;
    if let Some(value) = table.get("camera") {
        see_by_lens(&mut description.camera, value, "camera", size_px)?;
    }
    if let Some(DeValue::Array(rows)) = table.get("look").map(|value| value.get_ref()) {
        for (i, (row, look)) in rows.iter().zip(&mut description.looks).enumerate() {
            let row = Table::read_entries(Look::KEYS, row, "look")?;
            if let (Some(value), Some(camera)) = (row.get("camera"), &mut look.camera) {
                see_by_lens(camera, value, &format!("look[{i}].camera"), size_px)?;
            }
        }
    }
    if !description.is_lit() && !table.has("studio") {
        description.studio = Studio::default();
        // Without objects a ground is asked for by name: where it is not, they were forgotten.
        if !description.objects.is_empty() {
            description.ground.get_or_insert_default();
        }
    }
    Ok(description)
}

/// Gives a camera the field of view of the lens in its table, which sees by the picture's shape.
fn see_by_lens(
    camera: &mut Camera,
    value: &Value,
    key: &str,
    size_px: [u32; 2],
) -> Result<(), Error> {
    let table = Table::read_entries(Camera::KEYS, value, key)?;
    if let Some(fov_y_deg) = camera::fov_y_deg(&table, size_px)? {
        camera.fov_y_deg = fov_y_deg;
    }
    Ok(())
}
