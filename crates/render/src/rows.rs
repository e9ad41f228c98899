//! Rows of a picture by either renderer.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_gpu::Error;
use hairline_image::{Batch, Image};
use hairline_scene::Scene;

use crate::on_gpu::OnGpu;

/// Progress and cancelling in one: it is told the share that is done, and says whether the work goes on. It is called from any thread.
pub type GoOn<'a> = &'a (dyn Fn(f64) -> bool + Sync);

/// Some of a picture's samples in some of its rows.
#[derive(Clone)]
pub(crate) struct Piece {
    /// Samples of the picture.
    pub samples: u32,
    /// Those of the piece; none: all.
    pub batch: Option<Batch>,
    pub rows: Range<u32>,
}

/// Rows of a scene's picture.
pub(crate) enum Rows<'s> {
    Cpu(Box<Prepared<'s>>, RenderOptions),
    Gpu(&'s mut OnGpu, &'s Scene),
}

impl Rows<'_> {
    /// Renders a piece, and returns whether all of it is there. A GPU finishes what it begins.
    pub(crate) async fn render(
        &mut self,
        piece: Piece,
        go_on: GoOn<'_>,
    ) -> Result<(Image, bool), Error> {
        let (prepared, options) = match self {
            Self::Cpu(prepared, options) => (prepared, options),
            Self::Gpu(on_gpu, scene) => {
                let options = hairline_gpu::RenderOptions {
                    samples: piece.samples,
                    batch: piece.batch,
                    ..Default::default()
                };
                let progress = |share| {
                    go_on(share);
                };
                let OnGpu { renderer, uploaded } = on_gpu;
                let rows = piece.rows;
                let rendering = renderer.render_rows(scene, uploaded, &options, rows, &progress);
                return Ok((rendering.await?, true));
            }
        };
        (options.samples, options.batch) = (piece.samples, piece.batch);
        let done_bits = AtomicU64::new(0);
        let is_stopped = || !go_on(f64::from_bits(done_bits.load(Ordering::Relaxed)));
        let progress = |share: f64| done_bits.store(share.to_bits(), Ordering::Relaxed);
        let (image, counts) = prepared.render_until(&is_stopped, options, piece.rows, &progress);
        Ok((image, counts.is_some()))
    }
}
