//! Controls for the parts of its object on which a layer of scratches lies, and for its density.

use std::collections::BTreeSet;

use hairline_document::description::{LayerPlaces, Scratches};
use hairline_document::schema::Key;
use hairline_editor::actions::pictures::PictureOf;

use super::form::Form;
use crate::parts::Names;

/// Shows the rows; returns true where a part is to be picked in the picture.
pub(super) fn show(form: &mut Form, layer: &mut Scratches, index: usize, names: Names) -> bool {
    form.section("Where");
    let has_parts = names.materials.len() > 1 || names.nodes.len() > 1;
    if names.materials.len() > 1 || layer.material.is_some() {
        one_of(
            form,
            "On material",
            "Of the model's file: they lie on what is of it, and end where it ends",
            names.materials,
            &mut layer.material,
        );
    }
    if names.nodes.len() > 1 || layer.node.is_some() {
        one_of(
            form,
            "On node",
            "Of the model's file: they lie on it and on what is below it, and end where that ends",
            names.nodes,
            &mut layer.node,
        );
    }
    let picks = has_parts && pick(form);
    places(form, &mut layer.place, index);
    picks
}

fn pick(form: &mut Form) -> bool {
    let mut is_clicked = false;
    form.custom("", "", |ui, _| {
        let button = ui.button("Pick a part…");
        let hint = "The next click in the picture keeps the layer to the part that is there";
        is_clicked = button.on_hover_text(hint).clicked();
        false
    });
    is_clicked
}

fn one_of(
    form: &mut Form,
    label: &str,
    tooltip: &str,
    names: BTreeSet<String>,
    chosen: &mut Option<String>,
) {
    let all = (None, "All of it".to_owned());
    let named = names.into_iter().map(|name| (Some(name.clone()), name));
    form.choice(label, tooltip, std::iter::once(all).chain(named), chosen);
}

fn places(form: &mut Form, place: &mut LayerPlaces, index: usize) {
    form.number(LayerPlaces::EDGES, &mut place.edges);
    match place.edges > 0.0 {
        true => {
            // The scene's default.
            let mut width_m = place.edge_width_m.unwrap_or(0.02 * form.diagonal_m);
            let before_m = width_m;
            form.number(LayerPlaces::EDGE_WIDTH_M, &mut width_m);
            if width_m != before_m {
                place.edge_width_m = Some(width_m);
            }
        }
        false => place.edge_width_m = None,
    }
    form.picture(
        "Mask",
        "A picture, relative to the scene file: scratches lie where it is light, and end where it is dark. None: everywhere",
        &mut place.mask,
        PictureOf::LayerMask(index),
    );
    form.picture(
        "Density map",
        "A picture, relative to the scene file: the lighter it is, the more scratches there are. None: alike everywhere",
        &mut place.density,
        PictureOf::LayerDensity(index),
    );
    tiles(form, place);
    shells(form, place);
    form.rest(place);
}

/// Control for the mapping of the pictures.
fn tiles(form: &mut Form, place: &mut LayerPlaces) {
    if place.files().next().is_none() {
        place.tile_m = None;
        return;
    }
    tile(form, &mut place.tile_m);
}

/// Control for the width of pictures that do not follow texture coordinates.
pub(super) fn tile(form: &mut Form, tile_m: &mut Option<f64>) {
    let texts = [
        "From three sides",
        "Lays the pictures on along the object's own axes, where it has no texture coordinates",
    ];
    let begin_m = 0.25 * form.diagonal_m;
    if let Some(tile_m) = form.optional(texts, tile_m, || begin_m) {
        form.number(LayerPlaces::TILE_M, tile_m);
    }
}

/// Width of the narrowest ring or shell, in the object's size.
const LEAST_RING: f64 = 1e-4;

/// Controls for a least and a greatest distance; returns whether there are any.
pub(super) fn radii(
    form: &mut Form,
    texts: [&str; 2],
    key: &Key,
    radius_m: &mut Option<[f64; 2]>,
    begin_m: [f64; 2],
) -> bool {
    let Some([least, most]) = form.optional(texts, radius_m, || begin_m) else {
        return false;
    };
    form.number(key, least);
    form.second(key, most);
    // The outer one stays the greater.
    *most = most.max(*least + LEAST_RING * form.diagonal_m);
    true
}

fn shells(form: &mut Form, place: &mut LayerPlaces) {
    let texts = [
        "Within radii",
        "Scratches inside of a ball, outside of one, or between two",
    ];
    let begin_m = [0.0, 0.25 * form.diagonal_m];
    if !radii(
        form,
        texts,
        LayerPlaces::RADIUS_M,
        &mut place.radius_m,
        begin_m,
    ) {
        place.center_m = None;
        return;
    }
    let mut center_m = place.center_m.unwrap_or_default();
    form.vector(LayerPlaces::CENTER_M, &mut center_m);
    if place.center_m.is_some() || center_m != [0.0; 3] {
        place.center_m = Some(center_m);
    }
}
