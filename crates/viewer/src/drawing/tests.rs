//! What is drawn is what egui draws.

use eframe::egui_wgpu::{Renderer, RendererOptions};
use egui::{Color32, ColorImage, TextureOptions, pos2, vec2};
use hairline_gpu::Gpu;
use hairline_gpu::headless::test_gpu;

use super::*;

const SIZE_PX: [u32; 2] = [320, 200];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Rounding of colours between corners, and of a filter that works with eight bits.
const TOLERANCE: u8 = 2;

/// Text, shapes with and without alpha, a clipped part, and an image that is stretched.
fn interface(ui: &mut egui::Ui, image: &egui::TextureHandle) {
    egui::Panel::left("left").show(ui, |ui| {
        ui.heading("Äiou 0123");
        let _ = ui.button("a button");
        ui.add(egui::Slider::new(&mut 0.3, 0.0..=1.0));
        egui::ScrollArea::vertical()
            .max_height(30.0)
            .show(ui, |ui| ui.label("one\ntwo\nthree\nfour"));
    });
    let painter = ui.painter();
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let at = Rect::from_min_size(pos2(170.3, 20.0), vec2(100.0, 90.0));
    painter.image(image.id(), at, whole, Color32::WHITE);
    painter.circle_filled(
        pos2(200.0, 120.0),
        30.0,
        Color32::from_rgba_unmultiplied(200, 40, 90, 100),
    );
}

/// What is to be drawn.
struct Drawn {
    primitives: Vec<ClippedPrimitive>,
    images: TexturesDelta,
    pixels_per_point: f32,
}

impl Drop for Drawn {
    fn drop(&mut self) {
        // egui wants to be told.
        self.images.clear();
    }
}

/// The interface's triangles and images.
fn output(pixels_per_point: f32) -> Drawn {
    let ctx = egui::Context::default();
    ctx.set_zoom_factor(pixels_per_point);
    let pixels = (0..64).map(|i| Color32::from_rgb(4 * i, 255 - 3 * i, (i * 37) % 255));
    let image = ColorImage::new([8, 8], pixels.collect());
    let image = ctx.load_texture("image", image, TextureOptions::LINEAR);
    let size = SIZE_PX.map(|side| side as f32 / pixels_per_point);
    let input = egui::RawInput {
        screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), size.into())),
        ..Default::default()
    };
    let mut output = ctx.run_ui(input, |ui| interface(ui, &image));
    let primitives = ctx.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point);
    let mut images = std::mem::take(&mut output.textures_delta);
    // Not yet: it is still to be drawn.
    images.free.clear();
    assert_eq!(output.pixels_per_point, pixels_per_point);
    Drawn {
        primitives,
        images,
        pixels_per_point,
    }
}

fn screen(pixels_per_point: f32) -> ScreenDescriptor {
    ScreenDescriptor {
        size_in_pixels: SIZE_PX,
        pixels_per_point,
    }
}

fn by_egui(gpu: &Gpu, of: &Drawn) -> Vec<u8> {
    let options = RendererOptions {
        dithering: false,
        ..Default::default()
    };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let mut renderer = Renderer::new(device, FORMAT, options);
    for (&id, deltas) in &of.images.set {
        for delta in deltas {
            renderer.update_texture(device, queue, id, delta);
        }
    }
    let screen = screen(of.pixels_per_point);
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.update_buffers(device, queue, &mut encoder, &of.primitives, &screen);
    drawn(gpu, encoder, |pass| {
        renderer.render(pass, &of.primitives, &screen)
    })
}

fn by_us(gpu: &Gpu, of: &Drawn) -> Vec<u8> {
    let mut drawing = Device::new(&gpu.device, FORMAT);
    drawing.images = of.images.clone();
    drawing.primitives = of.primitives.clone();
    drawing.prepare(&gpu.device, &gpu.queue, &screen(of.pixels_per_point));
    let encoder = gpu.device.create_command_encoder(&Default::default());
    drawn(gpu, encoder, |pass| drawing.draw(pass))
}

/// The pixels that `draw` leaves on grey.
fn drawn(
    gpu: &Gpu,
    mut encoder: wgpu::CommandEncoder,
    draw: impl FnOnce(&mut wgpu::RenderPass<'static>),
) -> Vec<u8> {
    let [width, height] = SIZE_PX;
    let size = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = target.create_view(&Default::default());
    let grey = wgpu::Color {
        r: 0.5,
        g: 0.5,
        b: 0.5,
        a: 1.0,
    };
    let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            resolve_target: None,
            depth_slice: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(grey),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    });
    let mut pass = pass.forget_lifetime();
    draw(&mut pass);
    drop(pass);
    let bytes = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * width * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    // Rows of 1280 bytes are whole multiples of the 256 that a copy wants.
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * width),
        rows_per_image: None,
    };
    let into = wgpu::TexelCopyBufferInfo {
        buffer: &bytes,
        layout,
    };
    encoder.copy_texture_to_buffer(target.as_image_copy(), into, size);
    gpu.queue.submit([encoder.finish()]);
    bytes
        .slice(..)
        .map_async(wgpu::MapMode::Read, |mapped| mapped.unwrap());
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .unwrap();
    let seen = bytes.slice(..).get_mapped_range().unwrap();
    seen.to_vec()
}

fn differing(a: &[u8], b: &[u8]) -> usize {
    let pairs = std::iter::zip(a, b);
    pairs.filter(|(a, b)| a.abs_diff(**b) > TOLERANCE).count()
}

#[test]
fn it_draws_what_egui_draws() {
    let Some(gpu) = test_gpu() else { return };
    for pixels_per_point in [1.0, 1.5] {
        let mut of = output(pixels_per_point);
        let theirs = by_egui(gpu, &of);
        assert_eq!(differing(&theirs, &by_us(gpu, &of)), 0);
        // All kinds of things are in the picture, and would be missed.
        for missing in 0..of.primitives.len() {
            let primitive = of.primitives.remove(missing);
            let count = differing(&theirs, &by_us(gpu, &of));
            assert!(count > 10, "{missing} is not to be seen");
            of.primitives.insert(missing, primitive);
        }
    }
}

#[test]
fn what_is_freed_is_drawn_once_more() {
    let Some(gpu) = test_gpu() else { return };
    let mut of = output(1.0);
    let kept = by_us(gpu, &of);
    let ids: Vec<_> = of.images.set.keys().copied().collect();
    of.images.free.extend(ids);
    assert_eq!(differing(&kept, &by_us(gpu, &of)), 0);
}
