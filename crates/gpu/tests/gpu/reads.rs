//! A frame is drawn without a read from the device. What the device had no room for is drawn again before pixels are read.

use crate::common::{Stage, default_limits, options, plates};
use hairline_gpu::{Canvas, RenderOptions, steps};
use hairline_image::Image;

const SIZE_PX: [u32; 2] = [48, 32];

/// The plates, with shadows and a bounce, in two bands. Its device is its own: others would read, too.
fn stage(filter_std_px: f64) -> Option<(Stage, Canvas)> {
    let gpu = default_limits()?;
    let mut scene = plates().scene();
    scene.render.filter_std_px = filter_std_px;
    let mut stage = Stage::new(&gpu, scene);
    let (renderer, scene) = (&mut stage.renderer, &stage.made.scene);
    let shadows = renderer.add_shadows(&mut stage.uploaded, scene, 1);
    gpu.block_on(shadows).unwrap();
    let canvas = stage.canvas(SIZE_PX, 16 * SIZE_PX[0]);
    assert_eq!(canvas.bands(), 2);
    Some((stage, canvas))
}

/// Draws all steps of all bands. Returns the numbers of reads meanwhile, and until all is there.
fn draw(stage: &mut Stage, canvas: &mut Canvas, options: &RenderOptions) -> [usize; 2] {
    let Stage {
        gpu,
        renderer,
        made,
        uploaded,
    } = stage;
    let (scene, before) = (&made.scene, gpu.reads());
    for step in 0..steps(options.samples) {
        for band in 0..canvas.bands() {
            let step = renderer.accumulate(scene, uploaded, canvas, band, step, options);
            gpu.block_on(step).unwrap();
        }
    }
    let drawn = gpu.reads();
    gpu.block_on(renderer.settle(scene, uploaded, canvas, options))
        .unwrap();
    [drawn - before, gpu.reads() - drawn]
}

fn image(stage: &Stage, canvas: &Canvas) -> Image {
    stage.gpu.block_on(canvas.image()).unwrap()
}

#[test]
fn nothing_is_read_until_pixels_are_asked_for() {
    let Some((mut stage, mut canvas)) = stage(0.5) else {
        return;
    };
    let moving = RenderOptions {
        without_shadows: true,
        ..options(1)
    };
    for (name, options) in [("moving", moving), ("still", options(4))] {
        let [drawn, _] = draw(&mut stage, &mut canvas, &options);
        assert_eq!(drawn, 0, "the first {name} picture");
        // One read tells that there was room for all.
        let reads = draw(&mut stage, &mut canvas, &options);
        assert_eq!(reads, [0, 1], "the second {name} picture");
    }
}

/// The filter is so wide that each pixel has all samples, for which there is no room at first; nor is there for the lists of tiles and of hits.
#[test]
fn a_picture_without_room_is_drawn_again() {
    let Some((mut stage, mut canvas)) = stage(3.0) else {
        return;
    };
    let [drawn, until_settled] = draw(&mut stage, &mut canvas, &options(8));
    assert_eq!(drawn, 0);
    assert!(until_settled > 2, "{until_settled} reads");
    let first = image(&stage, &canvas);
    let reads = draw(&mut stage, &mut canvas, &options(8));
    assert_eq!(reads, [0, 1]);
    assert!(image(&stage, &canvas) == first);
}

#[test]
fn a_picture_that_lacks_steps_is_not_handed_out() {
    let Some((mut stage, mut canvas)) = stage(3.0) else {
        return;
    };
    let Stage {
        gpu,
        renderer,
        made,
        uploaded,
    } = &mut stage;
    let options = options(8);
    let drawn = renderer.accumulate(&made.scene, uploaded, &mut canvas, 0, 0, &options);
    gpu.block_on(drawn).unwrap();
    let unsettled = gpu.block_on(canvas.image());
    assert_eq!(unsettled.err(), Some(hairline_gpu::Error::Unsettled));
}
