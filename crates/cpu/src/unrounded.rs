//! The light of a picture with all digits, for differences of pictures: an [`hairline_image::Image`] rounds what they would show.

use crate::closed_form::{Prepared, RenderOptions};
use crate::draft::{Draft, DraftLayer};
use crate::tile::{Picture, SIDE, Tile};
use glam::DVec3;
use hairline_index::{ScratchIndex, TriangleIndex};
use hairline_scene::{GrooveShapes, Scene, ScratchTables};
use rayon::prelude::*;
use std::sync::Arc;

/// Light of the base and of the scratches in each pixel, row by row: the closed forms without shadows, by one sample a pixel. Each scratch of a layer
/// counts as many times as `weight` tells of the layer. None once `cancelled` says so.
///
/// `tables` are those of the scene, [smooth](ScratchTables::smooth) where differences are to be derivatives.
pub fn unrounded_light(
    scene: &Scene,
    tables: Arc<ScratchTables>,
    weight: &dyn Fn(u32) -> f64,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<[DVec3; 2]>> {
    let all = Draft::new(scene, &GrooveShapes::new(scene), 1, &|layer| DraftLayer {
        weight: weight(layer),
        is_random: false,
    });
    let triangles = TriangleIndex::build(scene).into();
    let scratches = ScratchIndex::without_trees(scene).into();
    let prepared = Prepared::from_parts(scene, triangles, scratches, tables).with_draft(all.into());
    let rows = 0..scene.render.size_px[1];
    let (picture, _) = prepared.picture(&RenderOptions::default(), rows, cancelled);
    light(&picture, cancelled)
}

fn light<'a>(
    picture: &'a Picture<'a>,
    cancelled: &'a (dyn Fn() -> bool + Sync),
) -> Option<Vec<[DVec3; 2]>> {
    let size_px = picture.camera.size_px.as_uvec2();
    let [width, height] = [size_px.x as usize, size_px.y as usize];
    let columns = width.div_ceil(SIDE);
    let tiles: Option<Vec<_>> = (0..columns * height.div_ceil(SIDE))
        .into_par_iter()
        .map_init(
            || Tile::new(picture, cancelled),
            |tile, i| tile.render(i % columns, i / columns),
        )
        .collect();
    let tiles = tiles?;
    let pixel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let sample = &tiles[y / SIDE * columns + x / SIDE][y % SIDE * SIDE + x % SIDE];
        let sample = sample.unwrap_or_default();
        let base = sample.rest + sample.diffuse.open + sample.specular.open;
        [base, sample.scratches.open]
    };
    Some((0..width * height).map(pixel).collect())
}
