//! Pictures in bands of the spectrum, three at a time: the CPU renderer draws them.

use anyhow::anyhow;
use hairline_image::BandImage;
use hairline_scene::Scene;

use crate::choice::Backend;
use crate::failure::Failure;
use crate::listener::Listener;
use crate::painter::Painter;
use crate::rows::GoOn;
use crate::task::Task;

/// Renders a scene in bands; `go_on` is told the share that is done.
///
/// # Errors
/// [`Failure::Input`] for bands and colours that [`in_bands`](hairline_document::in_bands) refuses, and for a GPU; [`Failure::Work`] where it is stopped.
pub fn render(
    scene: &Scene,
    bands_nm: &[[f64; 2]],
    backend: Backend,
    task: &Task,
    listener: &dyn Listener,
    go_on: GoOn<'_>,
) -> Result<BandImage, Failure> {
    if backend == Backend::Gpu || task.method.is_some() {
        return Err(Failure::Input(anyhow!(
            "bands of the spectrum are drawn by Hairline's own method on the CPU; leave out --backend gpu and --method"
        )));
    }
    let scenes = hairline_document::in_bands(scene, bands_nm)?;
    let mut picture = BandImage::default();
    let mut first: Option<Painter<'_>> = None;
    for (i, (scene, bands_nm)) in scenes.iter().zip(bands_nm.chunks(3)).enumerate() {
        let painter = match &mut first {
            Some(painter) => {
                painter.take_observer(scene);
                painter
            }
            none => none.insert(Painter::choose(
                scene,
                Backend::Cpu,
                task.clone(),
                listener,
            )?),
        };
        let told = |share: f64| go_on((i as f64 + share) / scenes.len() as f64);
        let rendered = painter.render_now(scene, &told)?;
        if !rendered.is_whole() {
            return Err(Failure::Work(anyhow!(
                "interrupted before all bands were done; there is nothing to write"
            )));
        }
        picture.add(bands_nm, &rendered.image);
    }
    Ok(picture)
}
