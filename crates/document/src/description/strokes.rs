//! `strokes` of a `[[scratches]]`: the paths of a brush.

use hairline_keys::Keyed;
use serde::ser::SerializeMap;

use super::keyed::Keyed;
use super::panel::{Panel, Rows};
use super::ranges::{Check, check_count};
use super::table::Table;
use crate::error::Error;
use crate::schema::{Entry, Form, Key};

/// One of the `strokes` of a `[[scratches]]`: the path of a brush.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, check = Stroke::check_count)]
pub struct Stroke {
    /// Where the brush went, on or near the surface, in the object's own frame. One point is a dab. A point farther from the object than the object
    /// is large is refused.
    #[key(unit("m").in_range(-1000.0, 1000.0).range_words("1 to 65536 points, ±1000 each"))]
    pub points_m: Vec<[f64; 3]>,
    /// Half of the brush's width; in the world's metres, whatever the object's `scale`.
    #[key(unit("m").size()
        .control("Brush radius", log(2e-3, 0.3).sized(), "Half the width of the band in which scratches are laid or taken away."))]
    pub radius_m: f64,
    /// `density_per_m` with its factors, or `erase`.
    #[flat]
    pub brush: Brush,
}

/// Effect of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Brush {
    /// Lays scratches along the stroke; in layers of pattern `"drawn"` only.
    Paint {
        /// Scratches on each metre of the stroke.
        density_per_m: f64,
        /// Factor on the layer's widths.
        width: f64,
        /// Factor on the layer's depths.
        depth: f64,
    },
    /// `erase = true`: takes away the scratches that the layer laid before, as far as they come within the radius, exactly at the
    /// brush's edge. It does not reach through a sheet: scratches on a surface that faces away from the one under the brush stay.
    Erase,
}

/// The keys of a stroke that lays scratches.
#[derive(Keyed)]
pub struct Paint {
    /// Scratches on each metre of the stroke, at least one in all. A dab has as many as a stroke of its width.
    #[key(unit("1/m").words("this or `erase`").at_least_0()
        .control("Brush density", log(10.0, 10_000.0).sized_by(-1), "Scratches for each metre of a stroke. Few: single marks. Many: a worn track."))]
    #[then(Paint::ERASE)]
    density_per_m: f64,
    /// Factor on the layer's widths; with `density_per_m` only.
    #[key(number(1.0).in_range(0.01, 100.0).omitted()
        .control("Width factor", log(0.25, 4.0), "Factor on the widths of the layer for this stroke. Above 1: bolder, with denser rainbows. Below 1: finer, with wider ones."))]
    width: f64,
    /// Factor on the layer's depths; with `density_per_m` only.
    #[key(number(1.0).in_range(0.01, 100.0).omitted()
        .control("Depth factor", log(0.25, 4.0), "Factor on the depths of the layer for this stroke. It shifts the tint of the stroke against the rest."))]
    depth: f64,
}

impl Paint {
    /// Takes away instead.
    pub const ERASE: &'static Key = &Key::new("erase", Form::Flag)
        .flag(false)
        .means("Takes away instead.");
}

/// Points of one stroke.
pub const STROKE_POINTS: std::ops::RangeInclusive<usize> = 1..=65_536;

impl Stroke {
    fn check_count(&self, key: &str) -> Check {
        let key = format!("{key}.points_m");
        check_count(&key, self.points_m.len(), "points", STROKE_POINTS)
    }

    /// Refuses a stroke that lays scratches in a layer that does not take it.
    pub(super) fn check_layer(&self, paints: bool, key: &str) -> Check {
        match self.brush {
            Brush::Paint { .. } if !paints => Err(Error::new(
                key,
                "found a stroke that lays scratches in a layer of another pattern than `drawn`",
                "must be `erase = true` here; draw in a layer of its own",
            )),
            _ => Ok(()),
        }
    }
}

impl Brush {
    fn paint(self) -> Option<Paint> {
        match self {
            Self::Erase => None,
            Self::Paint {
                density_per_m,
                width,
                depth,
            } => Some(Paint {
                density_per_m,
                width,
                depth,
            }),
        }
    }
}

impl Keyed for Brush {
    const KEYS: &'static [Entry] = Paint::KEYS;

    fn read_keys(table: &Table) -> Result<Self, Error> {
        let keys = [Paint::DENSITY_PER_M, Paint::WIDTH, Paint::DEPTH];
        if table.value(Paint::ERASE)? {
            return match keys.iter().find(|key| table.has(key.name)) {
                None => Ok(Self::Erase),
                Some(extra) => Err(Error::new(
                    table.key_path(extra.name),
                    "an erasing stroke has no such key",
                    "leave it out, or leave out `erase = true`",
                )),
            };
        }
        if !table.has(Paint::DENSITY_PER_M.name) {
            return Err(Error::new(
                table.key(),
                "found neither `density_per_m` nor `erase = true`",
                "must have exactly one of them",
            ));
        }
        let Paint {
            density_per_m,
            width,
            depth,
        } = Keyed::read_keys(table)?;
        Ok(Self::Paint {
            density_per_m,
            width,
            depth,
        })
    }

    fn check_keys(&self, key_path: &str) -> Check {
        self.paint().check_keys(key_path)
    }

    fn write_keys<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        match self.paint() {
            Some(paint) => paint.write_keys(map),
            None => Paint::ERASE.write(&true, map),
        }
    }
}

impl Rows for Brush {
    fn rows(&mut self, _: &mut dyn Panel) {}
}
