//! Placing a light by where its highlight is to fall: a click puts it there, a drag moves it along.

use egui::{PointerButton, Response};
use glam::DVec3;
use hairline_document::description::Light;
use hairline_document::place_light::{center, extent_m, place_highlight, set_distance_m};
use hairline_editor::quantity::Unit;
use hairline_editor::{DragKey, Selection};

use super::pick::Picked;
use super::{Area, Viewport, pick};
use crate::progressive::Built;
use crate::tools::Tool;
use crate::workspace::Workspace;

/// Distance that a light keeps from an obstacle, over the free distance.
const MARGIN: f64 = 0.02;
/// Distances from its highlight that are tried for a light, over the one that it had: nearer, then farther.
const SHARES: [f64; 11] = [1.0, 0.85, 0.7, 0.55, 0.4, 0.3, 0.2, 0.1, 1.3, 1.8, 2.5];
/// Distance between a surface and the start of a ray that leaves it, relative to the distance to the light, so that the ray does not meet
/// the surface itself.
const OFF_SURFACE: f64 = 1e-4;

impl Viewport {
    /// Makes the highlight of the selected light follow the pointer, if the drag `is_free` for it.
    pub(super) fn place_by_drag(
        &mut self,
        work: &mut Workspace,
        area: &Area,
        response: &Response,
        is_free: bool,
    ) {
        let is_tool = work.toolbox.tool == Tool::PlaceLight;
        if response.drag_started_by(PointerButton::Primary) {
            self.is_placing = is_tool && is_free;
        }
        let pos = self.drag_pos(response).filter(|_| self.is_placing);
        if let Some(hit) = pos.and_then(|pos| pick::surface(work, area, pos)) {
            place_light(work, &hit);
        }
        self.is_placing &= response.dragged_by(PointerButton::Primary);
    }
}

/// Moves the selected light so that its highlight falls on a place. It stands clear of what is in its way.
pub(super) fn place_light(work: &mut Workspace, hit: &Picked) {
    let Selection::Light(i) = work.selection() else {
        let text = "Select a light first: it is moved so that its highlight falls where you click.";
        work.notices.error("place", text);
        return;
    };
    // The whole drag starts from the light's first place, so that its distance does not shrink from one obstacle to the next.
    let before = work.document.before_drag();
    let start = before.unwrap_or(work.document.description()).lights.get(i);
    let (Some(start), Some(built)) = (start.cloned(), work.renderer.built()) else {
        return;
    };
    let mut light = start;
    place_highlight(&mut light, work.eye_m(), hit.point_m, hit.normal);
    let wanted_m = center(&light).distance(hit.point_m);
    let name = |object: usize| match work.document.description().objects.get(object) {
        Some(object) => format!("\"{}\"", object.name),
        None => "The ground".to_owned(),
    };
    match stand_clear(&mut light, &built, hit) {
        Placement::AsFar => work.notices.clear("place"),
        Placement::Elsewhere(object) => {
            let [now, wanted] = [center(&light).distance(hit.point_m), wanted_m]
                .map(|m| Unit::Metre.shown(m).text(m));
            let text = format!(
                "{} is in the way: the light stands {now} from its highlight in place of {wanted}.",
                name(object)
            );
            work.notices.note("place", text);
        }
        Placement::Nowhere(object) => {
            let text = format!(
                "{} is in the way, and leaves no room for the light in that direction: it stays where it was.",
                name(object)
            );
            work.notices.note("place", text);
            return;
        }
    }
    work.document
        .drag("Place light", DragKey::from_name(("place light", i)), |d| {
            d.lights[i] = light;
        });
}

/// Place where a light came to stand. Objects are counted as those that were built.
enum Placement {
    /// The light is as far from its highlight as before.
    AsFar,
    /// Nearer or farther, for an object is in the way.
    Elsewhere(usize),
    /// Nowhere in its direction: an object is in the way.
    Nowhere(usize),
}

/// Brings a light nearer to its highlight, or farther from it, until nothing is in its way: it is neither inside of an object nor below the
/// ground.
fn stand_clear(light: &mut Light, built: &Built, highlight: &Picked) -> Placement {
    let offset = center(light) - highlight.point_m;
    let wanted_m = offset.length();
    let (Some(towards), None) = (offset.try_normalize(), light.kind.sunbeam()) else {
        return Placement::AsFar;
    };
    let off = highlight.normal * (OFF_SURFACE * wanted_m);
    let met = built
        .triangles
        .intersect_solid(highlight.point_m + off, towards);
    let reach_m = extent_m(light);
    let most_m = met.map_or(f64::INFINITY, |hit| {
        hit.distance_m * (1.0 - MARGIN) - reach_m
    });
    let mut in_the_way = met.map(|hit| hit.object as usize);
    for share in SHARES {
        let distance_m = share * wanted_m.min(most_m);
        if !(reach_m..=most_m).contains(&distance_m) {
            continue;
        }
        let mut moved = light.clone();
        set_distance_m(&mut moved, highlight.point_m, distance_m);
        match touched(&moved, built) {
            Some(object) => in_the_way = in_the_way.or(Some(object)),
            None if distance_m == wanted_m => return Placement::AsFar,
            None => {
                *light = moved;
                return in_the_way.map_or(Placement::AsFar, Placement::Elsewhere);
            }
        }
    }
    in_the_way.map_or(Placement::AsFar, Placement::Nowhere)
}

/// An object that a part of a light is inside of or behind, seen from the light's middle.
fn touched(light: &Light, built: &Built) -> Option<usize> {
    let middle = center(light);
    let corners_m = light.kind.corners_m();
    let ends_m = match corners_m.is_empty() {
        // Round ones reach alike to all sides.
        true => {
            let reach = DVec3::splat(extent_m(light));
            let sides = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * reach);
            sides
                .into_iter()
                .flat_map(|side| [middle + side, middle - side])
                .collect()
        }
        false => corners_m,
    };
    ends_m.into_iter().find_map(|end_m| {
        let offset = end_m - middle;
        let towards = offset.try_normalize()?;
        let hit = built.triangles.intersect_solid(middle, towards)?;
        (hit.distance_m < offset.length()).then_some(hit.object as usize)
    })
}
