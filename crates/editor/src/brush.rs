//! The brush: from a drag over a surface to a stroke of the scene file.
//!
//! Strokes are thinned after D. H. Douglas and T. K. Peucker, *Algorithms for the reduction of the number of points required
//! to represent a digitized line or its caricature* (1973), so that a scene file stays small.

use glam::{DMat4, DVec3};
use hairline_document::Description;
use hairline_document::description::{Brush, Layer, Stroke};
use hairline_document::description::{Paint, STROKE_POINTS};
use hairline_document::schema::{LARGEST_M, SMALLEST_M};

use crate::actions::{layers, objects};
use crate::{ActionError, Selection, presets};

/// Least distance between two points of a drag, as a share of the radius.
const LEAST_SPACING: f64 = 1.0 / 8.0;
/// Largest distance between two points of a drag, as a share of the radius; points are inserted where it is larger.
const MOST_SPACING: f64 = 1.0 / 2.0;
/// Largest distance of a simplified stroke from the pointer's path, as a share of the radius.
const STRAYING: f64 = 1.0 / 20.0;
/// Largest error of rounded coordinates, as a share of the radius.
const ROUNDING: f64 = 1.0 / 500.0;

/// Radius of a new brush as a share of the view's height: some 15 points of a usual window.
const SHARE_OF_VIEW: f64 = 0.025;
/// Largest radius of a new brush, as a share of the object's diagonal.
const MOST_OF_OBJECT: f64 = 0.06;

/// Settings of the brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushSettings {
    /// Half of the brush's width, in the world.
    pub radius_m: f64,
    /// Scratches on each metre of a stroke.
    pub density_per_m: f64,
    /// Factor on the layer's widths.
    pub width: f64,
    /// Factor on the layer's depths.
    pub depth: f64,
    /// Takes scratches away instead; the three above do not matter then.
    pub erase: bool,
}

impl BrushSettings {
    /// Settings for an object whose bounding box has this diagonal, at a depth where the view is `view_height_m` high: large enough to be seen
    /// in the view, and small on the object. Enough scratches for a stroke that is seen at once.
    pub fn for_view(view_height_m: f64, diagonal_m: f64) -> Self {
        let on_screen_m = SHARE_OF_VIEW * view_height_m;
        let radius_m = on_screen_m
            .min(MOST_OF_OBJECT * diagonal_m)
            .clamp(SMALLEST_M, LARGEST_M);
        Self {
            radius_m: two_digits(radius_m),
            density_per_m: two_digits(90.0 / radius_m),
            width: 1.0,
            depth: 1.0,
            erase: false,
        }
    }
}

/// Collects the points of one drag.
#[derive(Clone, Debug)]
pub struct Recorder {
    settings: BrushSettings,
    object_from_world: DMat4,
    /// The largest factor from the object's lengths to the world's.
    scale: f64,
    path_m: Vec<DVec3>,
}

impl Recorder {
    /// Begins a stroke on an object. `world_from_object` places it; see
    /// [`Object::world_from_object`](hairline_document::description::Object::world_from_object).
    pub fn new(settings: BrushSettings, world_from_object: DMat4) -> Self {
        let axes = [
            world_from_object.x_axis,
            world_from_object.y_axis,
            world_from_object.z_axis,
        ];
        let scale = axes
            .iter()
            .map(|axis| axis.truncate().length())
            .fold(0.0, f64::max);
        Self {
            settings,
            object_from_world: world_from_object.inverse(),
            scale,
            path_m: Vec::new(),
        }
    }

    /// The next point under the pointer, on the surface, in the world. Says whether the stroke has grown.
    ///
    /// Where the pointer leaves the object or jumps to another part of it, [`Self::finish`] and begin anew: between two
    /// points the stroke runs straight.
    pub fn add(&mut self, point_m: DVec3) -> bool {
        if !point_m.is_finite() {
            return false;
        }
        let Some(&last) = self.path_m.last() else {
            self.path_m.push(point_m);
            return true;
        };
        let radius_m = self.settings.radius_m;
        let distance_m = last.distance(point_m);
        if !(distance_m >= LEAST_SPACING * radius_m) {
            return false;
        }
        let parts = (distance_m / (MOST_SPACING * radius_m)).ceil().max(1.0);
        // A jump over thousands of widths is no stroke; it needs no points in between.
        let parts = if parts < 4096.0 { parts as u32 } else { 1 };
        for i in 1..=parts {
            let t = f64::from(i) / f64::from(parts);
            self.path_m.push(last.lerp(point_m, t));
        }
        true
    }

    /// Path of the stroke until now, in the world, for a preview.
    pub fn path_m(&self) -> &[DVec3] {
        &self.path_m
    }

    /// The stroke, thinned, in the object's frame; none without a point.
    pub fn finish(self) -> Option<Stroke> {
        let BrushSettings {
            radius_m,
            density_per_m,
            width,
            depth,
            erase,
        } = self.settings;
        let mut straying_m = STRAYING * radius_m;
        let mut path = thinned(&self.path_m, straying_m);
        while path.len() > *STROKE_POINTS.end() {
            straying_m *= 2.0;
            path = thinned(&path, straying_m);
        }
        let step = decimal_step(ROUNDING * radius_m / self.scale);
        let points_m: Vec<[f64; 3]> = path
            .into_iter()
            .map(|point| self.object_from_world.transform_point3(point))
            .filter(|point| point.is_finite())
            .map(|point| point.to_array().map(|x| rounded(x, step)))
            .collect();
        if points_m.is_empty() {
            return None;
        }
        let factor = |x: f64| Paint::WIDTH.bounds.clamp(x);
        Some(Stroke {
            points_m,
            radius_m,
            brush: match erase {
                true => Brush::Erase,
                false => Brush::Paint {
                    density_per_m: density_per_m.max(0.0),
                    width: factor(width),
                    depth: factor(depth),
                },
            },
        })
    }
}

/// Adds a stroke to the scene.
///
/// Paint goes to the selected layer if that is drawn; of a selected object to its first drawn layer that is shown; else to a new layer. The layer is
/// shown then. An eraser works on the selected layer, or on all that are shown of a selected object.
///
/// # Errors
/// [`ActionError::Missing`], where neither a layer nor an object is selected.
pub fn apply_stroke(
    description: &mut Description,
    selection: Selection,
    stroke: Stroke,
) -> Result<Selection, ActionError> {
    let object = selection.object(description);
    let object = object.ok_or(ActionError::Missing("object"))?;
    let shown: Vec<usize> = objects::layers(description, object)
        .into_iter()
        .filter(|&i| layers::is_shown(description, i))
        .collect();
    let is_drawn = |i: &usize| matches!(description.scratches[*i].layer, Layer::Brushed(_));
    match (stroke.brush, selection) {
        (Brush::Erase, Selection::Layer(i)) => description.scratches[i].strokes.push(stroke),
        (Brush::Erase, _) => {
            for i in shown {
                description.scratches[i].strokes.push(stroke.clone());
            }
        }
        (Brush::Paint { .. }, _) => {
            let own = match selection {
                Selection::Layer(i) => Some(i).filter(is_drawn),
                _ => shown.into_iter().find(is_drawn),
            };
            let place = match own {
                Some(i) => Selection::Layer(i),
                None => {
                    let object = description.objects[object].name.clone();
                    layers::add(description, presets::drawn_layer(object, stroke.radius_m))?
                }
            };
            if let Selection::Layer(i) = place {
                description.scratches[i].strokes.push(stroke);
                // A layer that is drawn on becomes visible.
                let has_solo = description.scratches.iter().any(|layer| layer.solo);
                description.scratches[i].hidden = false;
                description.scratches[i].solo |= has_solo;
            }
            return Ok(place);
        }
    }
    Ok(selection)
}

/// The points of a path that are needed to stay within `straying_m` of all. Work is at worst the square of the number of
/// points, so a long scribble is thinned in runs.
fn thinned(path: &[DVec3], straying_m: f64) -> Vec<DVec3> {
    const RUN: usize = 512;
    let mut points = Vec::new();
    let mut from = 0;
    while from + 1 < path.len() {
        let to = (from + RUN).min(path.len() - 1);
        points.extend(thinned_run(&path[from..=to], straying_m));
        // The next run begins with it.
        points.pop();
        from = to;
    }
    points.extend(path.last());
    points
}

fn thinned_run(path: &[DVec3], straying_m: f64) -> Vec<DVec3> {
    let last = path.len() - 1;
    let mut kept = vec![false; path.len()];
    (kept[0], kept[last]) = (true, true);
    let mut spans = vec![(0, last)];
    while let Some((from, to)) = spans.pop() {
        let farthest = (from + 1..to)
            .map(|i| (i, distance_to_segment(path[i], path[from], path[to])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, distance_m)) = farthest
            && distance_m > straying_m
        {
            kept[i] = true;
            spans.extend([(from, i), (i, to)]);
        }
    }
    let points = path.iter().zip(kept);
    points.filter(|(_, kept)| *kept).map(|(p, _)| *p).collect()
}

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    // 0 / 0 for a segment without length.
    let t = if t.is_finite() { t } else { 0.0 };
    p.distance(a + along * t)
}

/// A number that reads well.
fn two_digits(x: f64) -> f64 {
    rounded(x, decimal_step(0.1 * x))
}

/// Exponent of the largest power of ten that is no larger, but not below the smallest step in metres.
pub(crate) fn decimal_step(largest: f64) -> i32 {
    let exponent = largest.log10().floor();
    match exponent.is_finite() {
        true => exponent.clamp(-12.0, 3.0) as i32,
        false => -12,
    }
}

/// `x` as a short decimal number: the nearest multiple of 10^`exponent`.
pub(crate) fn rounded(x: f64, exponent: i32) -> f64 {
    match exponent < 0 {
        true => (x * 10_f64.powi(-exponent)).round() / 10_f64.powi(-exponent),
        false => (x / 10_f64.powi(exponent)).round() * 10_f64.powi(exponent),
    }
}
