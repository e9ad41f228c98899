//! Pictures in bands of the spectrum, three at a time: the CPU renderer draws them.

use anyhow::anyhow;
use hairline_image::BandImage;
use hairline_scene::Scene;

use crate::backend::{Backend, Painter, Task};
use crate::failure::Failure;
use crate::listener::Listener;

/// Renders a scene in bands; `progress` is told the share that is done.
///
/// # Errors
/// [`Failure::Input`] for bands and colours that [`in_bands`](hairline_document::in_bands) refuses, and for a GPU; [`Failure::Work`] where it is stopped.
pub fn render(
    scene: &Scene,
    bands_nm: &[[f64; 2]],
    task: Task,
    listener: &dyn Listener,
    is_stopped: &(dyn Fn() -> bool + Sync),
    progress: &(dyn Fn(f64) + Sync),
) -> Result<BandImage, Failure> {
    if task.backend == Backend::Gpu || task.method.is_some() {
        return Err(Failure::Input(anyhow!(
            "bands of the spectrum are drawn by Hairline's own method on the CPU; leave out --backend gpu and --method"
        )));
    }
    let scenes = hairline_document::in_bands(scene, bands_nm)?;
    let task = Task {
        backend: Backend::Cpu,
        ..task
    };
    let mut picture = BandImage::default();
    let mut first: Option<Painter<'_>> = None;
    for (i, (scene, bands_nm)) in scenes.iter().zip(bands_nm.chunks(3)).enumerate() {
        let shared = first.as_ref().and_then(|first| first.seen_by(scene));
        let mut painter = match shared {
            Some(painter) => painter,
            None => Painter::open(scene, task.clone(), listener)?,
        };
        let told = |share: f64| progress((i as f64 + share) / scenes.len() as f64);
        let rendered = painter.render(scene, is_stopped, &told)?;
        if rendered.samples < rendered.wanted {
            return Err(Failure::Work(anyhow!(
                "interrupted before all bands were done; there is nothing to write"
            )));
        }
        picture.add(bands_nm, &rendered.image);
        first.get_or_insert(painter);
    }
    Ok(picture)
}
