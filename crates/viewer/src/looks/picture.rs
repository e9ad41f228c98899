//! The small picture of a look, by the CPU, without shadows.

use std::sync::Arc;

use egui::ColorImage;
use hairline_document::Description;
use hairline_image::{Display, FilePath, png};
use hairline_render::{Painter, Task};
use hairline_scene::Transport;
use web_time::Instant;

use crate::jobs::Stop;
use crate::progressive::ViewBuilder;
use crate::thumbnail::HEIGHT;

/// A picture with what it is of.
pub(super) struct SmallPicture {
    pub scene: Arc<Description>,
    pub pixels: ColorImage,
}

/// Samples of a pixel with an edge.
const SAMPLES: u32 = 4;
/// Pixels between two looks at whether to go on.
const BAND_PX: u32 = 1 << 12;

/// Twice as high as it is shown, for dense screens.
pub(super) fn size_px(scene: &Description) -> [u32; 2] {
    let [width, height] = scene.render.size_px.map(|side| f64::from(side.max(1)));
    let high = 2.0 * f64::from(HEIGHT);
    let wide = (high * width / height).clamp(1.0, 4.0 * high);
    [wide, high].map(|side| side.round() as u32)
}

/// Makes a picture of each scene, until `stop` is set. A scene that cannot be built has none.
pub(super) fn make(
    scenes: Vec<Arc<Description>>,
    base_dir: &FilePath,
    stop: &Stop,
    take: &dyn Fn(SmallPicture),
) {
    let mut builder = ViewBuilder::default();
    for scene in scenes {
        let mut small = Description::clone(&scene);
        small.render.size_px = size_px(&scene);
        let cancelled = || stop.is_asked();
        let (small, now) = (Arc::new(small), Instant::now());
        let built = builder.build(&cancelled, 0, now, Arc::clone(&small), base_dir, None);
        let Ok(Some(built)) = built else {
            continue;
        };
        let task = Task {
            has_coarse_lens: true,
            band_px: Some(BAND_PX),
            ..Task::new(SAMPLES, Transport::DIRECT)
        };
        let mut painter = Painter::on_cpu(built.parts(), task);
        let go_on = |_: f64| !stop.is_asked();
        let rendered = pollster::block_on(painter.render(&built.scene, &go_on));
        let Some(rendered) = rendered.ok().flatten().filter(|it| it.is_whole()) else {
            return;
        };
        let display = Display {
            exposure_ev: small.camera.exposure_ev,
            tone_map: small.render.tone_map,
        };
        let size = small.render.size_px.map(|side| side as usize);
        let pixels = ColorImage::from_rgb(size, &png::quantize(&rendered.image.beauty(), &display));
        take(SmallPicture { scene, pixels });
    }
}
