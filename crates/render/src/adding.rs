//! A picture from its batches of samples, each rendered in one piece or band by band: the same on both renderers.

use std::ops::Range;

use hairline_cpu::closed_form::TILE_PX;
use hairline_gpu::Error;
use hairline_image::{Image, filter_traced};
use hairline_scene::Scene;

use crate::rows::{GoOn, Piece, Rows};
use crate::task::Task;

/// A picture that was rendered.
pub struct Rendered {
    /// The picture.
    pub image: Image,
    /// Samples of each pixel with shadows, or of each pixel on an edge.
    pub samples: u32,
    /// Number of samples in the task; the picture has fewer if the work was stopped.
    pub wanted: u32,
}

impl Rendered {
    /// Whether the picture has all of its samples.
    pub fn is_whole(&self) -> bool {
        self.samples == self.wanted
    }
}

/// Renders the picture of a scene; none where `go_on` says no before the first of its batches is there.
pub(crate) async fn add_up(
    task: &Task,
    scene: &Scene,
    go_on: GoOn<'_>,
    rows: &mut Rows<'_>,
) -> Result<Option<Rendered>, Error> {
    let size_px = scene.render.size_px;
    let mut piece = Piece {
        samples: task.samples,
        batch: None,
        rows: 0..size_px[1],
    };
    let Some(mut batches) = task.batches(&scene.camera) else {
        let (image, is_whole) = in_bands(size_px, task.band_px, piece, go_on, rows).await?;
        return Ok(Some(Rendered {
            image,
            samples: if is_whole { task.samples } else { 0 },
            wanted: task.samples,
        }));
    };
    let wanted = batches.samples();
    piece.samples = wanted;
    while let Some(batch) = batches.next() {
        let [first, count, all] = [batch.first, batch.count, wanted].map(f64::from);
        let go_on = |share: f64| go_on((first + share * count) / all);
        if !go_on(0.0) {
            break;
        }
        piece.batch = Some(batch);
        match in_bands(size_px, task.band_px, piece.clone(), &go_on, rows).await? {
            (image, true) => batches.add(image),
            (_, false) => break,
        }
    }
    let samples = batches.done();
    Ok(batches.into_image().map(|mut image| {
        if task.is_filtered {
            filter_traced(&mut image);
        }
        image.traced = None;
        Rendered {
            image,
            samples,
            wanted,
        }
    }))
}

/// Renders all rows of a piece, and returns whether they are there.
async fn in_bands(
    size_px: [u32; 2],
    band_px: Option<u32>,
    mut piece: Piece,
    go_on: GoOn<'_>,
    rows: &mut Rows<'_>,
) -> Result<(Image, bool), Error> {
    let Some(band_px) = band_px else {
        return rows.render(piece, go_on).await;
    };
    let mut image = Image::new(size_px);
    for (done, band) in spread(size_px, band_px) {
        if !go_on(done) {
            return Ok((image, false));
        }
        piece.rows = band.clone();
        let (part, _) = rows.render(piece.clone(), &|_| true).await?;
        image.put_rows(band.start, &part);
    }
    Ok((image, true))
}

/// The bands of a picture, whole rows of tiles of `band_px` pixels or a little more, each with the share of those before it. The first of them are
/// all over the picture: they take as long as others, so that the time of the rest is known.
fn spread(size_px: [u32; 2], band_px: u32) -> impl Iterator<Item = (f64, Range<u32>)> + use<> {
    let [width, height] = size_px;
    let rows = (band_px / width.max(1)).max(1).next_multiple_of(TILE_PX);
    let count = height.div_ceil(rows);
    // Near the golden ratio, which leaves no part out for long.
    let nearest = (0.618 * f64::from(count)).round() as u32;
    let stride = (nearest.max(1)..).find(|stride| gcd(*stride, count) == 1);
    let stride = u64::from(stride.unwrap_or(1));
    (0..count).map(move |i| {
        let band = (u64::from(i) * stride % u64::from(count)) as u32;
        let first = band * rows;
        let done = f64::from(i) / f64::from(count);
        (done, first..(first + rows).min(height))
    })
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bands_of_a_picture_are_all_over_it() {
        for size_px in [[1920, 1080], [160, 100], [7, 8], [3000, 1], [640, 2160]] {
            let bands: Vec<_> = spread(size_px, 1 << 13).collect();
            let mut all: Vec<_> = bands.iter().map(|(_, rows)| rows.clone()).collect();
            all.sort_by_key(|rows| rows.start);
            assert!(all.windows(2).all(|two| two[0].end == two[1].start));
            assert_eq!((all[0].start, all[all.len() - 1].end), (0, size_px[1]));
            // Of a tenth of the bands each quarter of the picture has its share.
            let tenth = bands.len() / 10;
            for quarter in 0..4 {
                let of_quarter = |rows: &Range<u32>| rows.start * 4 / size_px[1] == quarter;
                let there = bands[..tenth].iter().filter(|(_, rows)| of_quarter(rows));
                let there = there.count();
                assert!(there >= tenth / 4, "{size_px:?}: {there} of {tenth}");
            }
        }
    }
}
