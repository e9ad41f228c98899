//! The pen: engraved lines, point by point, and the outlines of letters and drawings.

use std::path::Path;

use glam::{DMat4, DVec3};
use hairline_document::Description;
use hairline_document::description::{Distribution, Engraved, Layer, Line, Object, Scratches};

use crate::actions::{layers, list, parts};
use crate::brush::{decimal_step, rounded};
use crate::{ActionError, Selection, paths};

/// Largest error of rounded coordinates, as a share of the largest of them.
const ROUNDING: f64 = 1e-5;
/// Height of letters over the size of their object.
const LETTERS: f64 = 0.06;
/// Extent of a drawing over the size of its object.
const DRAWING: f64 = 0.25;
/// Width of a line over the height of letters, the size of a drawing, the first piece of a curve.
const LINE: f64 = 0.02;

/// A place on an object, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngravingPlace {
    /// The object's place in the description.
    pub object: usize,
    /// A point on its surface.
    pub middle_m: DVec3,
    /// To the right of whoever reads it.
    pub right: DVec3,
    /// The diagonal of the object.
    pub diagonal_m: f64,
}

/// The places of a layer that can be moved by hand, in the object's own frame: the points of a curve, or the middle of letters and drawings. Other
/// layers have none.
pub fn points_m(layer: &Scratches) -> &[[f64; 3]] {
    match &layer.layer {
        Layer::Engraved(engraved) => match &engraved.line {
            Line::Curve { points_m, .. } => points_m,
            Line::Text { center_m, .. } | Line::Svg { center_m, .. } => {
                std::slice::from_ref(center_m)
            }
        },
        _ => &[],
    }
}

/// The points of a layer that is a curve, and whether it is closed.
pub fn curve(layer: &Scratches) -> Option<(&[[f64; 3]], bool)> {
    match &layer.layer {
        Layer::Engraved(engraved) => match &engraved.line {
            Line::Curve { points_m, closed } => Some((points_m, *closed)),
            _ => None,
        },
        _ => None,
    }
}

/// Begins a curve through two points of an object.
///
/// # Errors
/// [`ActionError::Missing`]: no such object.
pub fn begin(
    description: &mut Description,
    object: usize,
    points_m: [DVec3; 2],
) -> Result<Selection, ActionError> {
    let object: &Object = list::get(description, object)?;
    let object_from_world = object.world_from_object().inverse();
    let line = Line::Curve {
        points_m: points_m
            .map(|point_m| short(&object_from_world, point_m))
            .to_vec(),
        closed: false,
    };
    let layer = engraved(object, line, LINE * points_m[0].distance(points_m[1]));
    layers::add(description, layer)
}

/// Goes on with a curve to another point.
///
/// # Errors
/// [`ActionError::Missing`]: no such layer, or no curve.
pub fn add_point(
    description: &mut Description,
    layer: usize,
    point_m: DVec3,
) -> Result<Selection, ActionError> {
    let point = in_object(description, layer, point_m)?;
    let (points_m, _) = curve_mut(description, layer)?;
    points_m.push(point);
    Ok(Selection::Layer(layer))
}

/// Inserts a point into a curve before the one at a place in its order.
///
/// # Errors
/// [`ActionError::Missing`]: no such layer, no curve, or no such place.
pub fn insert_point(
    description: &mut Description,
    layer: usize,
    before: usize,
    point_m: DVec3,
) -> Result<Selection, ActionError> {
    let point = in_object(description, layer, point_m)?;
    let (points_m, _) = curve_mut(description, layer)?;
    if before > points_m.len() {
        return Err(ActionError::Missing("point"));
    }
    points_m.insert(before, point);
    Ok(Selection::Layer(layer))
}

/// Leads a curve back to its first point.
///
/// # Errors
/// [`ActionError::Missing`]: no such layer, or no curve.
pub fn close(description: &mut Description, layer: usize) -> Result<Selection, ActionError> {
    let (_, closed) = curve_mut(description, layer)?;
    *closed = true;
    Ok(Selection::Layer(layer))
}

/// Name of the step that [`move_point`] makes.
pub fn move_label(layer: &Scratches) -> &'static str {
    match &layer.layer {
        Layer::Engraved(engraved) => match engraved.line {
            Line::Curve { .. } => "Move a point",
            Line::Text { .. } => "Move a text",
            Line::Svg { .. } => "Move a drawing",
        },
        _ => "Move",
    }
}

/// Moves one of the [`points_m`] of a layer; one that is not there stays.
pub fn move_point(description: &mut Description, layer: usize, point: usize, to_m: DVec3) {
    let Ok(to) = in_object(description, layer, to_m) else {
        return;
    };
    let Layer::Engraved(engraved) = &mut description.scratches[layer].layer else {
        return;
    };
    match &mut engraved.line {
        Line::Curve { points_m, .. } => {
            if let Some(place) = points_m.get_mut(point) {
                *place = to;
            }
        }
        Line::Text { center_m, .. } | Line::Svg { center_m, .. } => *center_m = to,
    }
}

/// Takes a point of a curve away. With one point left the layer goes, and with two the curve is open.
///
/// # Errors
/// [`ActionError::Missing`]: no such layer, no curve, or no such point.
pub fn remove_point(
    description: &mut Description,
    layer: usize,
    point: usize,
) -> Result<Selection, ActionError> {
    let selection = Selection::Layer(layer);
    let (points_m, closed) = curve_mut(description, layer)?;
    if point >= points_m.len() {
        return Err(ActionError::Missing("point"));
    }
    points_m.remove(point);
    *closed &= points_m.len() > 2;
    match points_m.len() {
        0 | 1 => parts::delete(description, selection, selection),
        _ => Ok(selection),
    }
}

/// Engraves a text.
///
/// # Errors
/// [`ActionError::Missing`]: no such object.
pub fn add_text(
    description: &mut Description,
    place: &EngravingPlace,
) -> Result<Selection, ActionError> {
    let height_m = LETTERS * place.diagonal_m;
    add(description, place, height_m, |center_m, direction| {
        Line::Text {
            text: "No. 1".to_owned(),
            height_m: rounded(height_m, decimal_step(0.1 * height_m)),
            center_m,
            direction,
        }
    })
}

/// Engraves the outlines of an SVG file; `base_dir` is the scene file's folder.
///
/// # Errors
/// [`ActionError::Missing`]: no such object.
pub fn add_drawing(
    description: &mut Description,
    place: &EngravingPlace,
    file: &Path,
    base_dir: &Path,
) -> Result<Selection, ActionError> {
    let fit_m = DRAWING * place.diagonal_m;
    add(description, place, fit_m, |center_m, direction| Line::Svg {
        file: paths::written(file, base_dir),
        fit_m: rounded(fit_m, decimal_step(0.1 * fit_m)),
        center_m,
        direction,
    })
}

fn add(
    description: &mut Description,
    place: &EngravingPlace,
    size_m: f64,
    line: impl FnOnce([f64; 3], [f64; 3]) -> Line,
) -> Result<Selection, ActionError> {
    let object: &Object = list::get(description, place.object)?;
    let object_from_world = object.world_from_object().inverse();
    let right = object_from_world
        .transform_vector3(place.right)
        .normalize_or(DVec3::X);
    let right = right.to_array().map(|x| rounded(x, -4));
    let layer = engraved(
        object,
        line(short(&object_from_world, place.middle_m), right),
        LINE * size_m,
    );
    layers::add(description, layer)
}

/// An engraved layer to begin with: one that is seen from all sides, as a single scratch is not.
fn engraved(object: &Object, line: Line, line_m: f64) -> Scratches {
    let [width_um, depth_nm] = [2.0, 200.0].map(|mean| Distribution { mean, spread: 0.1 });
    let engraved = Engraved {
        line_m: rounded(line_m, decimal_step(0.1 * line_m)),
        ..Engraved::new(line, width_um, depth_nm)
    };
    Scratches::new(object.name.clone(), Layer::Engraved(engraved))
}

fn curve_mut(
    description: &mut Description,
    layer: usize,
) -> Result<(&mut Vec<[f64; 3]>, &mut bool), ActionError> {
    let layer: &mut Scratches = list::get_mut(description, layer)?;
    if let Layer::Engraved(engraved) = &mut layer.layer
        && let Line::Curve { points_m, closed } = &mut engraved.line
    {
        return Ok((points_m, closed));
    }
    Err(ActionError::Missing("curve"))
}

/// A point of the world in the frame of a layer's object.
fn in_object(
    description: &Description,
    layer: usize,
    point_m: DVec3,
) -> Result<[f64; 3], ActionError> {
    let object = Selection::Layer(layer).object(description);
    let object: &Object = list::get(description, object.ok_or(ActionError::Missing("layer"))?)?;
    Ok(short(&object.world_from_object().inverse(), point_m))
}

/// A point without digits that nobody sees, in a file that people read.
fn short(object_from_world: &DMat4, point_m: DVec3) -> [f64; 3] {
    let point = object_from_world.transform_point3(point_m);
    let step = decimal_step(ROUNDING * point.abs().max_element());
    point.to_array().map(|x| rounded(x, step))
}
