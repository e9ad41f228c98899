//! A picture by the closed forms: one ray a sample, no randomness, all cores.
//!
//! The stages are the GPU's. Segments are projected and listed for the whole of the rows in hand; then a tile is a task, from the
//! surface under its pixels to the film.

use crate::bin::TileLists;
use crate::project::project;
use crate::shadows::Shadows;
use crate::tile::{Picture, PictureMethod};
use crate::visibility::Visibility;
use hairline_image::Image;
use hairline_scene::Scene;
use std::ops::Range;

pub use crate::bin::TILE_PX;
pub use crate::counts::Counts;
pub use crate::options::RenderOptions;
pub use crate::prepared::Prepared;

impl Prepared<'_> {
    /// Renders the picture. `progress` is told the share that is done, from any thread.
    pub fn render(&self, options: &RenderOptions, progress: &(dyn Fn(f64) + Sync)) -> Image {
        self.render_rows(options, 0..self.scene.render.size_px[1], progress)
    }

    /// Renders some rows of the picture; the image is as high as they are many. `progress` is told the share that is
    /// done, from any thread.
    pub fn render_rows(
        &self,
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Image {
        self.render_counted(options, rows, progress).0
    }

    /// Renders the rows, and counts the work of their scratches.
    pub fn render_counted(
        &self,
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> (Image, Counts) {
        self.render_unless(&|| false, options, rows, progress)
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// Renders the rows, or returns `None` once `cancelled` says so.
    pub fn render_unless(
        &self,
        cancelled: &(dyn Fn() -> bool + Sync),
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Option<(Image, Counts)> {
        let (image, counts) = self.render_until(cancelled, options, rows, progress);
        Some((image, counts?))
    }

    /// Renders some rows until `cancelled` says so. Tiles that were not done by then are black and empty, and the work is counted only where there are
    /// none.
    pub fn render_until(
        &self,
        cancelled: &(dyn Fn() -> bool + Sync),
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> (Image, Option<Counts>) {
        let mut image = Image::new([self.scene.render.size_px[0], rows.len() as u32]);
        let (picture, counts) = self.picture(options, rows, cancelled);
        // Segments that were cut short would make darker pixels, not fewer.
        let tiles = (!cancelled()).then(|| picture.render(&mut image, progress, cancelled));
        (image, tiles.flatten().map(|tiles| counts + tiles))
    }

    /// Renders those pixels of some rows again that have an edge or a crease. `image` has these rows, of one sample a pixel, and becomes what
    /// [`Self::render_rows`] makes of more. None if it was cancelled, as by [`Self::render_unless`].
    pub fn refine_edges_unless(
        &self,
        cancelled: &(dyn Fn() -> bool + Sync),
        options: &RenderOptions,
        rows: Range<u32>,
        mut image: Image,
    ) -> Option<Image> {
        let (mut picture, _) = self.picture(options, rows, cancelled);
        if cancelled() {
            return None;
        }
        picture.only_edges = true;
        picture.render(&mut image, &|_| {}, cancelled)?;
        Some(image)
    }

    /// The stages before the tiles. Of no use if they were cancelled.
    pub(crate) fn picture(
        &self,
        options: &RenderOptions,
        rows: Range<u32>,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> (Picture<'_>, Counts) {
        let scene = self.scene;
        let size_px = scene.render.size_px;
        let camera = scene.camera.frame_of_batch(size_px, options.batch());
        let mut counts = Counts::default();
        let by = match &options.method {
            None => {
                let projection = project(self, &camera, &rows, options.samples, cancelled);
                counts.segments = projection.looked_at;
                let lists = TileLists::new(projection.segments, size_px[0], &rows);
                counts.entries = lists.len() as u64;
                PictureMethod::Tiles(lists)
            }
            Some(method) => PictureMethod::Other(method.prepare(self, options.mask)),
        };
        let picture = Picture {
            prepared: self,
            camera,
            options: options.clone(),
            rows: rows.start as usize..rows.end as usize,
            only_edges: false,
            visibility: Visibility::new(
                &self.triangles,
                &camera,
                &scene.render,
                &rows,
                options.samples,
            ),
            shadows: (options.shadows && matches!(by, PictureMethod::Tiles(_)))
                .then(|| Shadows::new(self, options)),
            by,
        };
        (picture, counts)
    }
}

/// Renders `scene` at its own size. `progress` is told the share that is done, from any thread.
pub fn render(scene: &Scene, options: &RenderOptions, progress: &(dyn Fn(f64) + Sync)) -> Image {
    Prepared::new(scene).render(options, progress)
}

#[cfg(test)]
mod tests;
