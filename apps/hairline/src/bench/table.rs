//! The talk's table, for the published method and for ours, cell by cell.

use hairline_cpu::closed_form::Prepared;
use hairline_gpu::Error;
use hairline_scene::Scene;

use super::error::{brightest, crop, errors, rim_of_reflection};
use super::figures::{Cell, TableRow};
use super::methods::BenchMethod;
use super::stage::{Lamps, Stage};
use super::talk::{ZOOMS, talk_ms};
use super::thoroughness::Thoroughness;
use super::timing::by_turns;
use super::worker::{Ready, Worker, counted};
use crate::progress::Progress;
use hairline_render::failure::Failure;

/// Measures all cells, by lamps and zooms of one scene.
pub fn of_the_talk(
    worker: &mut Worker,
    base: Stage,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Vec<Cell>, Failure> {
    // Laid once: the cells differ in camera and lamps.
    let worn = base.build()?;
    let mut cells = Vec::new();
    let groups = TableRow::TALK.len() * ZOOMS.len();
    for (r, row) in TableRow::TALK.into_iter().enumerate() {
        for (z, zoom) in ZOOMS.into_iter().enumerate() {
            let lamps = match row {
                TableRow::Sphere => Lamps::Sphere,
                TableRow::Triangle => Lamps::Triangle,
                TableRow::Intersection | TableRow::Scene => Lamps::None,
            };
            let stage = Stage {
                lamps,
                zoom,
                ..base
            };
            let scene = stage.with_disk_of(&worn)?;
            let middle = (row != TableRow::Intersection).then(|| rim_of_reflection(&scene));
            let group = Group {
                row,
                zoom,
                scene: &scene,
                middle,
            };
            cells.extend(group.measure(worker, thoroughness)?);
            progress.set((r * ZOOMS.len() + z + 1) as f64 / groups as f64);
        }
    }
    Ok(cells)
}

/// Measures the same columns for a scene that somebody else made, at its own size and zoom.
pub fn of_scene(
    worker: &mut Worker,
    scene: &Scene,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Vec<Cell>, Failure> {
    let middle = brightest(scene, thoroughness.accuracy.crop_of(scene));
    let group = Group {
        row: TableRow::Scene,
        zoom: 1.0,
        scene,
        middle: Some(middle),
    };
    let cells = group.measure(worker, thoroughness)?;
    progress.set(1.0);
    Ok(cells)
}

/// The cells of one scene.
struct Group<'a> {
    row: TableRow,
    zoom: f64,
    scene: &'a Scene,
    /// Middle of the crop that errors are judged on; none where nothing is lit.
    middle: Option<glam::DVec2>,
}

impl Group<'_> {
    fn measure(
        &self,
        worker: &mut Worker,
        thoroughness: &Thoroughness,
    ) -> Result<Vec<Cell>, Failure> {
        let Self {
            row, zoom, scene, ..
        } = *self;
        let prepared = Prepared::new(scene);
        let ready: Vec<Result<Ready, Error>> = BenchMethod::ALL
            .iter()
            .map(|method| worker.ready(scene, &prepared, &method.method()))
            .collect();
        let outcomes = by_turns(worker, scene, &prepared, &ready, &thoroughness.effort)?;
        let mut cells: Vec<Cell> = BenchMethod::ALL
            .into_iter()
            .zip(outcomes)
            .map(|(method, outcome)| Cell {
                row,
                zoom,
                way: method,
                outcome,
                error: None,
                talk_ms: talk_ms(row, zoom, method),
                counts: counted(scene, &prepared, method),
            })
            .collect();
        for antialiasing in [false, true] {
            let Some(middle) = self.middle else { break };
            let judged: Vec<usize> = (0..cells.len())
                .filter(|i| BenchMethod::ALL[*i].antialiasing() == antialiasing)
                .collect();
            let crop_px = thoroughness.accuracy.crop_of(scene);
            let crop = crop(scene, middle, crop_px, antialiasing);
            let ready: Vec<_> = judged.iter().map(|i| &ready[*i]).collect();
            let errors = errors(worker, &crop, &ready, &thoroughness.accuracy);
            for (i, error) in judged.into_iter().zip(errors) {
                cells[i].error = error;
            }
        }
        Ok(cells)
    }
}
