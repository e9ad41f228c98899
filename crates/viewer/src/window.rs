//! The window on a screen: its device and its renderer.

mod ready;
mod software;

use eframe::egui_wgpu::RenderState;
use egui::ViewportBuilder;
use hairline_gpu::{AdapterRequest, Gpu, headless};

use crate::app::{Options, Viewer};
use crate::device;
use crate::loss::WindowLoss;
use crate::priority;
use crate::progressive::Backend;

pub use crate::device::Renderer;
pub(crate) use software::SoftwareWindow;

/// Reason why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No display, or no driver that can draw a window.
    #[error("no window could be opened: {0}")]
    NoWindow(String),
    /// The window's graphics device is gone.
    #[error(
        "the window's graphics device was lost ({0}); what was not saved is kept and offered at the next start"
    )]
    Lost(String),
    /// The built-in scene is wrong.
    #[error(transparent)]
    Scene(#[from] hairline_document::Error),
}

/// Size of the window: with a title and a panel beside it, it fits a screen of 1440 x 900.
const SIZE: [f32; 2] = [1360.0, 800.0];

/// Icon in lists of windows.
fn icon() -> egui::IconData {
    let png = include_bytes!("../assets/hairline.png");
    eframe::icon_data::from_png_bytes(png).unwrap_or_default()
}

/// Opens the window and returns when it is closed. `backend` of the options is replaced by what `renderer` asks for.
///
/// # Errors
/// [`Error::NoWindow`], [`Error::Lost`].
pub fn open(options: Options, renderer: Renderer) -> Result<(), Error> {
    open_as(options, renderer, |viewer| Box::new(viewer))
}

/// Opens the window with the viewer inside of another program, such as one that measures its times.
///
/// # Errors
/// [`Error::NoWindow`], [`Error::Lost`].
pub fn open_as(
    options: Options,
    renderer: Renderer,
    app: impl FnOnce(Viewer) -> Box<dyn eframe::App>,
) -> Result<(), Error> {
    if let Some(missing) = ready::missing() {
        return Err(Error::NoWindow(missing));
    }
    let mut native = eframe::NativeOptions {
        viewport: ViewportBuilder::default()
            .with_title("Hairline")
            .with_app_id("hairline")
            .with_inner_size(SIZE)
            .with_icon(icon())
            .with_min_inner_size([720.0, 480.0])
            .with_drag_and_drop(true),
        // The picture is dithered when it is made; for grey panels it would cost a software driver much for nothing.
        dithering: false,
        ..Default::default()
    };
    native.wgpu_options.wgpu_setup = device::setup();
    let loss = WindowLoss::default();
    let watched = loss.clone();
    eframe::run_native(
        "hairline",
        native,
        Box::new(move |context| {
            let state = context.wgpu_render_state.clone();
            let is_software = state.as_ref().is_some_and(device::is_software);
            let backend = backend(state.as_ref(), renderer)?;
            watch(state.as_ref(), &backend, &watched);
            let options = Options { backend, ..options };
            let mut viewer = Viewer::new(&context.egui_ctx, state, options)?;
            viewer.watch(watched);
            if is_software {
                viewer.set_software(SoftwareWindow::new(&context.egui_ctx));
            }
            Ok(app(viewer))
        }),
    )
    .map_err(|error| Error::NoWindow(ready::sentence(&error.to_string())))?;
    match loss.reason() {
        Some(reason) => Err(Error::Lost(reason.to_owned())),
        None => Ok(()),
    }
}

/// Reports to `loss` when the window's device is lost.
fn watch(state: Option<&RenderState>, backend: &Backend, loss: &WindowLoss) {
    let Some(state) = state else { return };
    loss.watch(&state.device);
    let loss = loss.clone();
    match backend {
        // The shared device calls one listener, which reports to the progressive renderer as well.
        Backend::Shared(gpu) => gpu.on_lost(move |reason| loss.tell(reason)),
        _ => state
            .device
            .set_device_lost_callback(move |_, reason| loss.tell(&reason)),
    }
}

/// The window's own device where it is a GPU; else the renderer that was asked for.
fn backend(
    state: Option<&RenderState>,
    renderer: Renderer,
) -> Result<Backend, hairline_gpu::Error> {
    let shared = || -> Option<Gpu> {
        let state = state?;
        // A software driver does one thing after the other: a picture on the window's device would hold the window up.
        if device::is_software(state) {
            return None;
        }
        device::shared(state).ok()
    };
    Ok(match renderer {
        Renderer::Cpu => Backend::Cpu,
        Renderer::Auto => shared().map_or(Backend::Cpu, Backend::Shared),
        Renderer::Gpu => match shared() {
            Some(gpu) => Backend::Shared(gpu),
            None => Backend::Gpu(open_beside()?),
        },
    })
}

/// A device beside the window's. A driver that computes starts its threads here, and on most systems they inherit the priority
/// of the thread that starts them: the window's own driver is to go first.
fn open_beside() -> Result<Gpu, hairline_gpu::Error> {
    let open = || headless::open(&AdapterRequest::default());
    let opened = std::thread::scope(|scope| {
        let opening = scope.spawn(|| {
            priority::lower();
            open()
        });
        opening.join()
    });
    opened.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_icon_is_a_picture_and_the_window_fits_a_small_screen() {
        let icon = icon();
        assert_eq!([icon.width, icon.height], [128, 128]);
        // The icon's corners are transparent, its middle is not.
        assert_eq!((icon.rgba[3], icon.rgba[4 * (64 * 128 + 64) + 3]), (0, 255));
        // A title and a panel of 40 points each.
        const { assert!(SIZE[0] <= 1440.0 - 20.0 && SIZE[1] <= 900.0 - 80.0) };
    }

    #[test]
    fn the_desktop_file_names_the_window_and_the_command() {
        let text = include_str!("../assets/hairline.desktop");
        for line in [
            "Exec=hairline-viewer %f",
            "Icon=hairline",
            "StartupWMClass=hairline",
        ] {
            assert!(text.lines().any(|l| l == line), "{line}");
        }
    }
}
