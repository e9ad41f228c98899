//! Small pictures of the choices: presets, materials, lights, shapes, environments, grades of wear.
//!
//! Each is rendered once by the CPU renderer, in the background and only when a menu that shows it is open; until then its place
//! is empty.

mod cards;
mod scenes;
mod thumb;

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use egui::{ColorImage, TextureHandle, TextureId, TextureOptions};

pub(crate) use cards::{SIDE, card, cards, metal_swatches};
pub(crate) use thumb::{StandIn, Thumb};

/// Width and height of a picture.
const SIDE_PX: u32 = 96;

/// Pictures that the thread and the window exchange.
#[derive(Default)]
struct Desk {
    /// Pictures that are still to be rendered, each with the pass of the interface that showed its place last.
    wanted: Vec<(u64, Thumb)>,
    /// Pictures that are rendered and not yet textures; none where it failed.
    done: Vec<(Thumb, Option<ColorImage>)>,
    is_working: bool,
}

/// The pictures that there are.
#[derive(Default)]
pub(crate) struct Gallery {
    desk: Arc<Mutex<Desk>>,
    /// Textures of the pictures; none while one is not there yet, or where it failed.
    pictures: HashMap<Thumb, Option<TextureHandle>>,
}

fn lock(desk: &Mutex<Desk>) -> MutexGuard<'_, Desk> {
    desk.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Gallery {
    /// The picture, if it is there; else it is asked for.
    pub fn texture(&mut self, ctx: &egui::Context, thumb: Thumb) -> Option<TextureId> {
        self.take(ctx);
        let pass = ctx.cumulative_pass_nr();
        let mut desk = lock(&self.desk);
        if let Some(picture) = self.pictures.get(&thumb) {
            if picture.is_none()
                && let Some(wanted) = desk.wanted.iter_mut().find(|wanted| wanted.1 == thumb)
            {
                wanted.0 = pass;
            }
            return picture.as_ref().map(TextureHandle::id);
        }
        self.pictures.insert(thumb, None);
        desk.wanted.push((pass, thumb));
        if !desk.is_working {
            let (desk_of_thread, wake) = (Arc::downgrade(&self.desk), ctx.clone());
            let thread = std::thread::Builder::new().name("gallery".to_owned());
            // Nobody waits for its end: a window that closes leaves it alone. Without a thread there are no pictures; the menus
            // are there all the same.
            desk.is_working = thread.spawn(move || work(&desk_of_thread, &wake)).is_ok();
        }
        None
    }

    /// Whether pictures are being rendered, for tests.
    pub fn is_working(&self) -> bool {
        lock(&self.desk).is_working
    }

    /// Number of pictures, for tests.
    pub fn count(&self) -> usize {
        self.pictures.values().flatten().count()
    }

    fn take(&mut self, ctx: &egui::Context) {
        let done = std::mem::take(&mut lock(&self.desk).done);
        for (thumb, image) in done {
            let texture = image
                .map(|image| ctx.load_texture(format!("{thumb:?}"), image, TextureOptions::LINEAR));
            self.pictures.insert(thumb, texture);
        }
    }
}

/// Renders the pictures that are wanted until there are none left, or the gallery is closed: in one thread, since a menu can wait
/// and the picture in the window cannot.
fn work(desk: &Weak<Mutex<Desk>>, wake: &egui::Context) {
    crate::priority::lower();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .start_handler(|_| crate::priority::lower())
        .build();
    let mut studio = scenes::Studio::default();
    while let Some(thumb) = desk.upgrade().and_then(|desk| next(&desk)) {
        let image = match &pool {
            Ok(pool) => pool.install(|| studio.picture(thumb, SIDE_PX)),
            Err(_) => None,
        };
        let Some(desk) = desk.upgrade() else { return };
        lock(&desk).done.push((thumb, image));
        wake.request_repaint();
    }
}

/// Picture to be rendered next: of those that were seen last the first that was asked for. None ends the work.
fn next(desk: &Mutex<Desk>) -> Option<Thumb> {
    let mut desk = lock(desk);
    let newest = desk.wanted.iter().map(|(pass, _)| *pass).max();
    let place = desk
        .wanted
        .iter()
        .position(|(pass, _)| Some(*pass) == newest);
    let thumb = place.map(|place| desk.wanted.remove(place).1);
    desk.is_working = thumb.is_some();
    thumb
}
