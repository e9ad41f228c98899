//! Presets that are dragged from their cards onto an object or a part of it in the picture.

use egui::{Align2, Color32, FontId, Painter, Response, Ui, vec2};
use glam::DVec3;
use hairline_document::navigate;
use hairline_scene::Mesh;

use super::lens::Lens;
use super::{Area, Viewport, ink, pick};
use crate::gallery::Thumb;
use crate::parts::{self, ObjectPart};
use crate::progressive::Built;
use crate::workspace::Workspace;

/// Colour of the box around what would be changed.
const TARGET: Color32 = Color32::from_rgb(255, 224, 160);

impl Viewport {
    /// Shows what a dragged preset would change, and gives it to that when the button goes up.
    pub(super) fn take_presets(
        &self,
        ui: &Ui,
        work: &mut Workspace,
        area: &Area,
        response: &Response,
    ) {
        let dropped = response.dnd_release_payload::<Thumb>();
        let hovering = response.dnd_hover_payload::<Thumb>();
        let Some(preset) = dropped.as_deref().or(hovering.as_deref()).copied() else {
            return;
        };
        // The menu that it comes from would hide the object.
        egui::Popup::close_all(ui.ctx());
        let Some(pos) = ui.ctx().pointer_interact_pos() else {
            return;
        };
        let (Some(built), Some(hit)) = (work.renderer.built(), pick::surface(work, area, pos))
        else {
            return;
        };
        let Some(described) = work.document.description().objects.get(hit.object) else {
            return;
        };
        let part = parts::part_with_triangle(&built.scene, described, hit.object, hit.triangle);
        if dropped.is_some() {
            work.give(preset, hit.object, part);
            return;
        }
        let Some(words) = work.given_to(preset, hit.object, &part) else {
            return;
        };
        let painter = ui.painter().with_clip_rect(area.rect);
        let lens = Lens::new(&work.camera(), area);
        let is_part = matches!(preset, Thumb::Material(..) | Thumb::Layer(..));
        let of_part = ObjectPart {
            material: part.material.filter(|_| is_part),
            ..ObjectPart::default()
        };
        if let Some((low_m, high_m)) = bounds_m(&built, hit.object, &of_part) {
            show_box(&painter, &lens, low_m, high_m);
        }
        let at = pos + vec2(14.0, 18.0);
        let font = FontId::proportional(14.0);
        ink::words(&painter, at, Align2::LEFT_TOP, &words, font, Color32::WHITE);
    }
}

/// The box around a part, metres.
fn bounds_m(built: &Built, object: usize, part: &ObjectPart) -> Option<(DVec3, DVec3)> {
    let mesh: &Mesh = &built.scene.objects.get(object)?.mesh;
    let (low_m, high_m) = match &part.material {
        None => mesh.bounds_m(),
        Some(name) => {
            let is_of = |number: &u32| {
                let material = built.scene.materials.get(*number as usize);
                material.is_some_and(|it| it.name == *name)
            };
            let of_part = mesh.triangles.iter().zip(&mesh.triangle_materials);
            let corners = of_part.filter(|(_, number)| is_of(number));
            let points_m = corners.flat_map(|(corners, _)| corners);
            let mut points_m = points_m.map(|i| mesh.positions_m[*i as usize]);
            let first_m = points_m.next()?;
            points_m.fold((first_m, first_m), |(low_m, high_m), point_m| {
                (low_m.min(point_m), high_m.max(point_m))
            })
        }
    };
    Some((low_m.as_dvec3(), high_m.as_dvec3()))
}

/// Draws the edges of a box.
fn show_box(painter: &Painter, lens: &Lens, low_m: DVec3, high_m: DVec3) {
    let corners_m = navigate::corners(low_m, high_m);
    for (i, a) in corners_m.iter().enumerate() {
        for b in &corners_m[i + 1..] {
            // Corners of an edge differ along one axis.
            let is_edge = (*a - *b)
                .to_array()
                .iter()
                .filter(|sign| **sign != 0.0)
                .count()
                == 1;
            if let Some(ends) = lens.segment(*a, *b).filter(|_| is_edge) {
                ink::segment(painter, ends, 1.25, TARGET);
            }
        }
    }
}
