//! Places of tooltips.

use crate::common::{SMALL, click_on, viewer, wait_built};
use egui::accesskit::Role;
use egui::{Key, Order, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

/// Rectangles of the visible layers of this order.
fn shown(harness: &Harness<'static, Viewer>, order: Order) -> Vec<Rect> {
    harness.ctx.memory(|memory| {
        let areas = memory.areas();
        let layers = areas.visible_layer_ids().into_iter();
        layers
            .filter(|layer| layer.order == order)
            .filter_map(|layer| memory.area_rect(layer.id))
            .collect()
    })
}

/// The pointer comes to each entry of the menu that is open; returns how many had a tooltip.
fn tooltips_cover_no_entry(harness: &mut Harness<'static, Viewer>, menu: &str) -> usize {
    let popups = shown(harness, Order::Foreground);
    // Not what a panel has below it: entries begin at the menu's margin.
    let is_in_popup = |rect: &Rect| {
        let begins = |popup: &Rect| {
            let left = rect.left() - popup.left();
            popup.contains_rect(*rect) && left > 4.0
        };
        popups.iter().any(begins)
    };
    let entries: Vec<Rect> = harness
        .query_all_by(|node| node.role() == Role::Button)
        .map(|node| node.rect())
        .filter(is_in_popup)
        .collect();
    assert!(!entries.is_empty(), "{menu}: {entries:?} in {popups:?}");
    let mut count = 0;
    for entry in &entries {
        harness.hover_at(entry.center());
        // Passes are a quarter of a second apart.
        harness.run_steps(6);
        let tooltips = shown(harness, Order::Tooltip);
        count += tooltips.len();
        for tooltip in tooltips {
            let covered = entries.iter().find(|other| other.intersects(tooltip));
            assert_eq!(covered, None, "{menu}: {tooltip:?} of {entry:?}");
        }
    }
    count
}

#[test]
fn they_cover_no_entry_of_a_menu() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    for menu in [
        "File",
        "Edit",
        "View",
        "Help",
        "Add to objects",
        "Add to lights",
        "Add to materials",
    ] {
        click_on(&mut harness, menu);
        let count = tooltips_cover_no_entry(&mut harness, menu);
        let has_them = ["Add to lights", "Add to materials"].contains(&menu);
        assert!(count > 2 || !has_them, "{menu}: {count} tooltips");
        harness.key_press(Key::Escape);
        harness.run_steps(2);
    }
    for (selection, menu) in [
        (Selection::Object(0), "Add scratches…"),
        (Selection::Layer(0), "Replace by a preset…"),
        (Selection::Material(0), "Replace by a preset…"),
    ] {
        harness.state_mut().document_mut().select(selection);
        harness.run_steps(3);
        click_on(&mut harness, menu);
        let count = tooltips_cover_no_entry(&mut harness, menu);
        assert!(count > 2, "{menu}: {count} tooltips");
        harness.key_press(Key::Escape);
        harness.run_steps(2);
        harness.key_press(Key::V);
    }
}
