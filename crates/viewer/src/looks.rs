//! The looks of the scene: a strip of their pictures over the lower edge of the picture. A click takes one.

mod picture;

use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use egui::{Align2, Context, Id, Rect, ScrollArea, TextureHandle, TextureOptions, Ui, vec2};
use hairline_document::Description;
use hairline_document::description::Look;
use hairline_editor::{Document, Selection};
use hairline_image::FilePath;

use crate::command::Command;
use crate::jobs::Job;
use crate::platform::HAS_THREADS;
use crate::progressive::ProgressiveRenderer;
use crate::thumbnail::{LOW, Thumbnail};
use picture::SmallPicture;

/// The pictures of the looks.
#[derive(Default)]
pub(crate) struct Looks {
    /// Revision of the document that the rest is of.
    revision: u64,
    /// The scene of each look.
    scenes: Vec<Arc<Description>>,
    /// Whether the scene has each look.
    held: Vec<bool>,
    pictures: Vec<(Arc<Description>, TextureHandle)>,
    making: Option<(Job, Receiver<SmallPicture>)>,
    /// Upper edge of the strip in the last pass, points.
    top: f32,
}

impl Looks {
    /// The part of `area` above the strip, if there is one.
    pub fn above_strip(&self, area: Rect) -> Rect {
        match self.scenes.is_empty() {
            true => area,
            false => area.with_max_y(self.top.clamp(area.top(), area.bottom())),
        }
    }

    /// Takes over the pictures that were made, and makes those that are missing once the picture stands still: they are small.
    fn follow(&mut self, ctx: &Context, document: &Document, renderer: &ProgressiveRenderer) {
        let description = document.description();
        if self.revision != document.revision() {
            self.revision = document.revision();
            let mut without = Description::clone(description);
            let all = std::mem::take(&mut without.looks);
            let scene = |look: &Look| {
                let mut scene = without.clone();
                look.apply(&mut scene);
                scene
            };
            let scenes: Vec<_> = all.iter().map(scene).collect();
            self.held = scenes.iter().map(|scene| *scene == without).collect();
            self.scenes = scenes.into_iter().map(Arc::new).collect();
            self.pictures
                .retain(|(of, _)| self.scenes.iter().any(|scene| scene == of));
            if let Some((job, _)) = self.making.take() {
                job.leave();
            }
        }
        for made in self.making.iter().flat_map(|(_, made)| made.try_iter()) {
            let texture = ctx.load_texture("look", made.pixels, TextureOptions::LINEAR);
            self.pictures.push((made.scene, texture));
        }
        let is_still = || {
            let shown = renderer.latest();
            shown.is_some_and(|it| it.painted.is_final || it.painted.of_samples.is_some())
        };
        self.making.take_if(|(job, _)| job.is_over());
        if HAS_THREADS && self.making.is_none() && !renderer.is_building() && is_still() {
            self.make_missing(ctx, document.base_dir());
        }
    }

    fn make_missing(&mut self, ctx: &Context, base_dir: &FilePath) {
        let is_missing = |scene: &&Arc<_>| !self.pictures.iter().any(|(of, _)| of == *scene);
        let missing: Vec<_> = self.scenes.iter().filter(is_missing).cloned().collect();
        if missing.is_empty() {
            return;
        }
        let (tell, told) = channel();
        let (base_dir, wake) = (base_dir.to_owned(), ctx.clone());
        let work = move |stop: &_| {
            picture::make(missing, &base_dir, stop, &|made| {
                let _ = tell.send(made);
                wake.request_repaint();
            });
        };
        // Without a thread the strip has names alone.
        self.making = Job::start("looks", work).ok().map(|job| (job, told));
    }

    /// Shows the strip, if the scene has looks. `area` is the room for it.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        renderer: &ProgressiveRenderer,
        area: Rect,
    ) -> Clicked {
        self.follow(ui.ctx(), document, renderer);
        let all = &document.description().looks;
        match all.is_empty() {
            true => Clicked::Nothing,
            false => self.strip(ui, all, document.selection(), area),
        }
    }

    /// The look that the scene has, if it has one.
    pub fn held(&self) -> Option<usize> {
        self.held.iter().position(|is_held| *is_held)
    }

    fn strip(&mut self, ui: &mut Ui, all: &[Look], selection: Selection, area: Rect) -> Clicked {
        let corner = area.left_bottom() + vec2(12.0, -12.0);
        let shown = egui::Area::new(Id::unique("looks"))
            .pivot(Align2::LEFT_BOTTOM)
            .fixed_pos(corner)
            .show(ui.ctx(), |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(area.width() - 40.0);
                    let line = ScrollArea::horizontal().id_salt("looks").show(ui, |ui| {
                        ui.horizontal(|ui| self.looks(ui, all, selection, area.height() < LOW))
                    });
                    line.inner.inner
                })
            });
        self.top = shown.response.rect.top();
        shown.inner.inner
    }

    fn looks(&self, ui: &mut Ui, all: &[Look], selection: Selection, is_low: bool) -> Clicked {
        let mut clicked = Clicked::Nothing;
        for (i, look) in all.iter().enumerate() {
            let label = format!("Take {}", look.name);
            let is_held = self.held.get(i) == Some(&true);
            let scene = self.scenes.get(i);
            let mut pictures = self.pictures.iter();
            let response = match is_low {
                true => ui.selectable_label(is_held, &look.name),
                false => Thumbnail {
                    name: &look.name,
                    label: &label,
                    size_px: scene.map_or([16, 9], |scene| picture::size_px(scene)),
                    texture: pictures
                        .find(|(of, _)| Some(of) == scene)
                        .map(|(_, texture)| texture.id()),
                    is_chosen: selection == Selection::Look(i),
                    is_shown: is_held,
                }
                .show(ui),
            };
            let response = response.on_hover_text("Click to give the scene this look");
            if response.clicked() {
                clicked = Clicked::Look(i);
            }
        }
        let keep = ui.button("+").on_hover_text(Command::KeepLook.label());
        ui.ctx().accesskit_node_builder(keep.id, |node| {
            node.set_label(Command::KeepLook.label());
        });
        match keep.clicked() {
            true => Clicked::Keep,
            false => clicked,
        }
    }
}

/// What was clicked in the strip.
pub(crate) enum Clicked {
    Nothing,
    Look(usize),
    /// The look of now is to be kept.
    Keep,
}
