//! What a panel of another program shows: what is known of each number, and what there is to begin with. See `hairline.editing`.

use hairline_editor::grating_presets::GratingPreset;
use hairline_editor::presets::LayerPreset;
use hairline_editor::quantity::Unit;

use hairline_document::description::SECTIONS;
use hairline_document::schema::{Form, Key};
use hairline_document::wear::Wear;
use hairline_editor::ranges::{Range, range, second_range};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::names::named;
use crate::scene::table;
use crate::values::Stock;

/// Label, unit, ends of the slider, what may be typed, whether the slider counts by factors, whether it has whole numbers alone, tooltip.
type Control = (
    &'static str,
    &'static str,
    (f64, f64),
    (f64, f64),
    bool,
    bool,
    &'static str,
);

/// What is known of each number, by its name. Sliders of lengths fit an object of this diagonal.
#[pyfunction]
pub(crate) fn controls(py: Python<'_>, diagonal_m: f64) -> PyResult<Bound<'_, PyDict>> {
    let controls = PyDict::new(py);
    for section in &SECTIONS {
        for key in section.all_keys() {
            let name = format!("{}.{}", section.name, key.name);
            if key.has_sliders() {
                controls.set_item(&name, control(range(key, diagonal_m)))?;
            }
            if key.second.is_some() {
                let second = control(second_range(key, diagonal_m));
                controls.set_item(format!("{name}.{}", second_name(key)), second)?;
            }
        }
    }
    Ok(controls)
}

/// The name of the second of two numbers.
fn second_name(key: &Key) -> &'static str {
    match key.form {
        Form::Sizes => "spread",
        _ => "second",
    }
}

fn control(range: Range) -> Control {
    let ends = |range: std::ops::RangeInclusive<f64>| (*range.start(), *range.end());
    (
        range.label,
        unit(range.unit),
        ends(range.slider),
        ends(range.bounds.ends()),
        range.logarithmic,
        range.is_whole,
        range.tooltip,
    )
}

fn unit(unit: Unit) -> &'static str {
    match unit {
        Unit::None => "",
        Unit::Metre => "m",
        Unit::Micrometre => "µm",
        Unit::Nanometre => "nm",
        Unit::Degree => "°",
        Unit::PerMetre => "1/m",
        Unit::PerSquareMetre => "1/m²",
        Unit::Exposure => "EV",
        Unit::Pixel => "px",
        Unit::Kelvin => "K",
    }
}

/// What there is to begin with.
#[derive(Clone, Copy)]
enum Preset {
    Layer(LayerPreset),
    Grating(GratingPreset),
    Wear(Wear),
}

impl Preset {
    fn all(kind: &str) -> PyResult<Vec<Self>> {
        let kinds = [
            ("scratches", LayerPreset::ALL.map(Self::Layer).to_vec()),
            ("grating", GratingPreset::ALL.map(Self::Grating).to_vec()),
            ("wear", Wear::ALL.map(Self::Wear).to_vec()),
        ];
        named("kind", kind, &kinds)
    }

    fn name(self) -> &'static str {
        match self {
            Self::Layer(preset) => preset.name(),
            Self::Grating(preset) => preset.name(),
            Self::Wear(wear) => wear.name(),
        }
    }

    fn tooltip(self) -> &'static str {
        match self {
            Self::Layer(preset) => preset.tooltip(),
            Self::Grating(preset) => preset.tooltip(),
            Self::Wear(wear) => wear.tooltip(),
        }
    }

    fn tables(self, py: Python<'_>, object: &str, diagonal_m: f64) -> PyResult<Vec<toml::Table>> {
        match self {
            Self::Layer(preset) => Ok(vec![table(py, &preset.layer(object, diagonal_m))?]),
            Self::Grating(preset) => Ok(vec![table(py, &preset.grating(object))?]),
            Self::Wear(wear) => {
                let layers = wear.layers(object, diagonal_m);
                layers.iter().map(|layer| table(py, layer)).collect()
            }
        }
    }
}

/// The names of the presets of a kind, each with what it looks like.
#[pyfunction]
pub(crate) fn presets(kind: &str) -> PyResult<Vec<(&'static str, &'static str)>> {
    let all = Preset::all(kind)?.into_iter();
    Ok(all
        .map(|preset| (preset.name(), preset.tooltip()))
        .collect())
}

/// The tables of a preset for an object of this diagonal.
#[pyfunction]
pub(crate) fn from_preset<'py>(
    py: Python<'py>,
    kind: &str,
    name: &str,
    object: &str,
    diagonal_m: f64,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let all = Preset::all(kind)?.into_iter();
    let all: Vec<_> = all.map(|preset| (preset.name(), preset)).collect();
    let tables = named("name", name, &all)?.tables(py, object, diagonal_m)?;
    let stock = Stock::default();
    tables.iter().map(|table| stock.dict(py, table)).collect()
}
