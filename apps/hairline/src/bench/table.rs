//! The talk's table, for the published method and for ours, cell by cell.

use hairline_gpu::Error;
use hairline_optics::method::{Lookup, Method, PixelFilter};
use hairline_scene::Scene;

use super::Thoroughness;
use super::by_lookup::ByLookup;
use super::error::{brightest, crop, errors, rim_of_reflection};
use super::figures::{Cell, CellError, Columns, Outcome, Row, Way, Whose};
use super::stage::{Lamps, Stage};
use super::talk::{ZOOMS, talk_ms};
use super::timing::by_turns;
use super::worker::{Ready, Worker};
use crate::failure::Failure;
use crate::progress::Progress;

/// The published method's way through the table's columns, and ours: with its own look-up and, without anti-aliasing, by
/// those of the columns as well, so that look-ups can be told from the rest.
pub fn ways(ours: &Method) -> Vec<Way> {
    let published = Columns::ALL.map(|columns| Way {
        whose: Whose::Published,
        method: Method {
            footprint: if columns.antialiasing() {
                PixelFilter::Published
            } else {
                PixelFilter::Off
            },
            lookup: columns.published_lookup(),
            ..Method::PUBLISHED
        },
    });
    let own = |footprint, lookup| Way {
        whose: Whose::Ours,
        method: Method {
            footprint,
            lookup,
            ..*ours
        },
    };
    let mut ways = published.to_vec();
    for lookup in [ours.lookup, Lookup::Bvh, Lookup::Triangles] {
        let way = own(PixelFilter::Off, lookup);
        if !ways.contains(&way) {
            ways.push(way);
        }
    }
    ways.push(own(ours.footprint, ours.lookup));
    ways
}

/// All cells, by lamps and zooms of one scene.
pub fn of_the_talk(
    worker: &mut Worker,
    base: Stage,
    ours: &Method,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Vec<Cell>, Failure> {
    // Laid once: the cells differ in camera and lamps.
    let worn = base.build()?;
    let mut cells = Vec::new();
    let groups = Row::TALK.len() * ZOOMS.len();
    for (r, row) in Row::TALK.into_iter().enumerate() {
        for (z, zoom) in ZOOMS.into_iter().enumerate() {
            let lamps = match row {
                Row::Sphere => Lamps::Sphere,
                Row::Triangle => Lamps::Triangle,
                Row::Intersection | Row::Scene => Lamps::None,
            };
            let stage = Stage {
                lamps,
                zoom,
                ..base
            };
            let scene = stage.of(&worn)?;
            let middle = rim_of_reflection(&scene);
            let crop_px = crop_px(thoroughness, base.size_px);
            let crops = (row != Row::Intersection).then(|| Crops::new(&scene, middle, crop_px));
            let group = Group {
                row,
                zoom,
                scene: &scene,
                crops,
            };
            cells.extend(group.measure(worker, &ways(ours), thoroughness)?);
            progress.set((r * ZOOMS.len() + z + 1) as f64 / groups as f64);
        }
    }
    Ok(cells)
}

/// The same columns for a scene that somebody else made, at its own size and zoom.
pub fn of_scene(
    worker: &mut Worker,
    scene: &Scene,
    ours: &Method,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Vec<Cell>, Failure> {
    let crop_px = crop_px(thoroughness, scene.render.size_px);
    let group = Group {
        row: Row::Scene,
        zoom: 1.0,
        scene,
        crops: Some(Crops::new(scene, brightest(scene, crop_px), crop_px)),
    };
    let cells = group.measure(worker, &ways(ours), thoroughness)?;
    progress.set(1.0);
    Ok(cells)
}

/// A part of the picture, and not all of it.
fn crop_px(thoroughness: &Thoroughness, size_px: [u32; 2]) -> [u32; 2] {
    let most = thoroughness.accuracy.crop_px;
    [0, 1].map(|i| most[i].min(size_px[i].div_ceil(2)))
}

/// The crop that errors are judged on, with points for pixels and with pixels.
struct Crops {
    point: Scene,
    filtered: Scene,
}

impl Crops {
    fn new(scene: &Scene, middle: glam::DVec2, crop_px: [u32; 2]) -> Self {
        Self {
            point: crop(scene, middle, crop_px, false),
            filtered: crop(scene, middle, crop_px, true),
        }
    }
}

/// The cells of one scene.
struct Group<'a> {
    row: Row,
    zoom: f64,
    scene: &'a Scene,
    crops: Option<Crops>,
}

impl Group<'_> {
    fn measure(
        &self,
        worker: &mut Worker,
        ways: &[Way],
        thoroughness: &Thoroughness,
    ) -> Result<Vec<Cell>, Failure> {
        let prepared = ByLookup::new(self.scene, ways.iter().map(|way| way.method.lookup));
        let ready: Vec<Result<Ready, Error>> = ways
            .iter()
            .map(|way| worker.ready(self.scene, &prepared, &way.method))
            .collect();
        let outcomes = by_turns(worker, self.scene, &prepared, &ready, &thoroughness.effort)?;
        let mut cells: Vec<Cell> = ways
            .iter()
            .zip(outcomes)
            .map(|(way, outcome)| self.cell(way, outcome))
            .collect();
        if let Some(crops) = &self.crops {
            for (antialiasing, crop) in [(false, &crops.point), (true, &crops.filtered)] {
                let judged: Vec<usize> = (0..ways.len())
                    .filter(|i| ways[*i].antialiasing() == antialiasing)
                    .collect();
                let ready: Vec<_> = judged.iter().map(|i| &ready[*i]).collect();
                let errors: Vec<Option<CellError>> =
                    errors(worker, crop, &ready, &thoroughness.accuracy);
                for (i, error) in judged.into_iter().zip(errors) {
                    cells[i].error = error;
                }
            }
        }
        Ok(cells)
    }

    fn cell(&self, way: &Way, outcome: Outcome) -> Cell {
        let columns = Columns::ALL.into_iter().find(|columns| {
            way.whose == Whose::Published
                && columns.antialiasing() == way.antialiasing()
                && columns.published_lookup() == way.method.lookup
        });
        let talk = columns.and_then(|columns| talk_ms(self.row, self.zoom, columns));
        Cell::new(self.row, self.zoom, way, outcome, talk)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_are_the_talks_and_ours_beside_them() {
        let ways = ways(&Method::default());
        let of = |whose| ways.iter().filter(move |w| w.whose == whose);
        let lookups = |whose| of(whose).map(|w| (w.antialiasing(), w.lookup())).collect();
        let published: Vec<(bool, &str)> = lookups(Whose::Published);
        assert_eq!(
            published,
            [(false, "bvh"), (false, "triangles"), (true, "bvh")]
        );
        let ours: Vec<(bool, &str)> = lookups(Whose::Ours);
        assert_eq!(
            ours,
            [
                (false, "tiles"),
                (false, "bvh"),
                (false, "triangles"),
                (true, "tiles")
            ]
        );
        assert!(of(Whose::Ours).all(|w| w.method.is_default_path()));
    }
}
