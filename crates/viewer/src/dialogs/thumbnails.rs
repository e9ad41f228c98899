//! Small pictures of autosaves, made in the background by the CPU.

use std::sync::mpsc::{Receiver, channel};

use egui::{ColorImage, Context, TextureHandle, TextureOptions};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_document::{Loader, SceneBuilder};
use hairline_editor::Document;
use hairline_editor::autosave::Pending;
use hairline_image::{Display, png};
use hairline_index::{Pieces, Watch};

use crate::jobs::{Job, Stop};

/// Width and height of the largest.
const SIZE_PX: [f64; 2] = [160.0, 90.0];

/// The pictures, in the order of the autosaves.
pub(crate) struct Thumbnails {
    job: Option<Job>,
    made: Receiver<(usize, ColorImage)>,
    textures: Vec<Option<TextureHandle>>,
}

impl Thumbnails {
    /// Begins to make them.
    pub fn start(pending: &[Pending], ctx: &Context) -> Self {
        let (tell, made) = channel();
        let (wanted, wake) = (pending.to_vec(), ctx.clone());
        let job = Job::start("thumbnails", move |stop| {
            for (i, entry) in wanted.iter().enumerate() {
                if stop.is_asked() {
                    return;
                }
                // A scene that cannot be read or built has no picture; the reason is shown when it
                // is opened.
                let document = entry.recover().ok();
                let picture = document.and_then(|document| picture(&document, stop));
                if let Some(picture) = picture {
                    let _ = tell.send((i, picture));
                    wake.request_repaint();
                }
            }
        });
        Self {
            job: job.ok(),
            made,
            textures: vec![None; pending.len()],
        }
    }

    /// Picture of an autosave, once it is there.
    pub fn texture(&mut self, i: usize, ctx: &Context) -> Option<TextureHandle> {
        while let Ok((i, picture)) = self.made.try_recv() {
            let name = format!("thumbnail {i}");
            let texture = ctx.load_texture(name, picture, TextureOptions::LINEAR);
            if let Some(place) = self.textures.get_mut(i) {
                *place = Some(texture);
            }
        }
        self.textures.get(i)?.clone()
    }
}

impl Drop for Thumbnails {
    /// Stops the rendering without waiting for it.
    fn drop(&mut self) {
        if let Some(job) = self.job.take() {
            job.leave();
        }
    }
}

fn picture(document: &Document, stop: &Stop) -> Option<ColorImage> {
    let cancelled = || stop.is_asked();
    let loader = Loader {
        cancelled: &cancelled,
        ..Loader::default()
    };
    let description = document.description();
    let mut scene = SceneBuilder::new()
        .build(&loader, description, document.base_dir())
        .ok()?;
    let [width, height] = description.render.size_px.map(f64::from);
    let fitting = (SIZE_PX[0] / width).min(SIZE_PX[1] / height);
    scene.render.size_px = [width, height].map(|side| (side * fitting).round().max(1.0) as u32);
    let watch = Watch {
        cancelled: &cancelled,
        ..Watch::default()
    };
    let image =
        Prepared::watched(&scene, Pieces::Seen, &watch)?.render(&RenderOptions::default(), &|_| {});
    let display = Display {
        exposure_ev: description.camera.exposure_ev,
        tone_map: description.render.tone_map,
    };
    let pixels = png::quantize(&image.beauty(), &display);
    let size = scene.render.size_px.map(|side| side as usize);
    Some(ColorImage::from_rgb(size, &pixels))
}
