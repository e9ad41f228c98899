//! Light that shows wear.

use crate::common::{self, click_on, description, viewer, wait_built, wait_until};
use egui_kittest::kittest::Queryable;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

/// A few scratches on a ball that mirrors an even sky.
const FAINT: &str = "[camera]\nposition_m = [0, -1, 0.5]\ntarget_m = [0, 0, 0]\nup = [0, 0, 1]\nfov_y_deg = 15\n\
    [environment]\nbuiltin = \"overcast\"\nintensity = 0.01\n[[material]]\nname = \"steel\"\nkind = \"metal\"\nmetal = \"steel\"\n\
    [[object]]\nname = \"ball\"\nshape = { sphere = { radius_m = 0.1 } }\nmaterial = \"steel\"\n\
    [[scratches]]\nobject = \"ball\"\npattern = \"random\"\ncount = 12000\nlength_m = 0.02\nwidth_um = 3.0\ndepth_nm = 150.0\nname = \"wear: hairlines\"\n";

const LIGHT: &str = "Light for the scratches";

#[test]
fn scratches_that_are_hardly_seen_are_offered_other_light() {
    let mut harness = viewer(FAINT);
    wait_built(&mut harness);
    (harness.state_mut().document_mut()).select(Selection::Object(0));
    let noticed = |viewer: &Viewer| {
        viewer
            .renderer()
            .latest()?
            .findings
            .shown
            .map(|it| it.noticed)
    };
    wait_until(&mut harness, "few are noticed", |viewer| {
        noticed(viewer).is_some_and(|share| share < 0.05)
    });
    let before = description(&harness);
    click_on(&mut harness, LIGHT);
    let lit = description(&harness);
    assert!(lit.lights.len() >= 3 && lit.environment != before.environment);
    assert_eq!(lit.scratches, before.scratches);
    wait_until(&mut harness, "more are noticed", |viewer| {
        noticed(viewer).is_some_and(|share| share > 0.1)
    });
    wait_until(&mut harness, "what it did is told", |viewer| {
        let said = viewer.messages().concat();
        said.contains("ight for the scratches shows")
    });
    harness.run_steps(2);
    assert!(harness.query_by_label(LIGHT).is_none(), "it is done");
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

/// Shallow scratches on rough metal: no lamp shows them, and the window says so.
#[test]
fn scratches_that_no_lamp_shows_are_told_of() {
    let text = FAINT
        .replace(
            "metal = \"steel\"\n",
            "metal = \"steel\"\nroughness = 0.5\n",
        )
        .replace("depth_nm = 150.0", "depth_nm = 15.0")
        .replace("count = 12000", "count = 500");
    let mut harness = viewer(text.leak());
    wait_built(&mut harness);
    let before = description(&harness);
    click_on(&mut harness, "Edit");
    click_on(&mut harness, LIGHT);
    wait_until(&mut harness, "what shows is measured", |viewer| {
        let said = viewer.messages().concat();
        said.contains("shows 0 % of them from here")
    });
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn an_object_is_made_of_a_preset_in_one_move() {
    let mut harness = viewer(FAINT);
    wait_built(&mut harness);
    (harness.state_mut().document_mut()).select(Selection::Object(0));
    let before = description(&harness);
    for _ in 0..2 {
        click_on(&mut harness, "Make it of…");
        click_on(&mut harness, "Gold");
        let after = description(&harness);
        // The second time it is there.
        assert_eq!(after.materials.len(), before.materials.len() + 1);
        assert_eq!(after.objects[0].material.as_deref(), Some("gold"));
        assert_eq!(harness.state().document().selection(), Selection::Object(0));
    }
}
