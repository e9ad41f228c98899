//! Surfaces and lights that a click in the picture meets.

use crate::common;
use egui::{Rect, vec2};
use glam::DVec3;
use hairline_editor::Selection;

#[test]
fn a_click_on_the_disk_selects_it_and_one_beside_it_nothing() {
    let mut harness = common::viewer(common::SMALL);
    common::wait_built(&mut harness);
    let picture = common::picture(&harness);
    common::click_at(&mut harness, picture.center() + egui::vec2(0.0, 60.0));
    assert_eq!(harness.state().document().selection(), Selection::Object(0));
    // Clicks a moment apart are no double click.
    harness.run_steps(60);
    common::click_at(
        &mut harness,
        picture.left_bottom() + egui::vec2(20.0, -20.0),
    );
    assert_eq!(harness.state().document().selection(), Selection::None);
}

#[test]
fn a_double_click_where_the_disks_centre_is_seen_looks_at_its_centre() {
    let mut harness = common::viewer(common::SMALL);
    common::wait_built(&mut harness);
    let description = common::description(&harness);
    // The scene's own picture lies in the middle of the area, as large as fits.
    let area = common::picture(&harness);
    let [width, height] = description.render.size_px.map(|side| side as f32);
    let fitting = (area.width() / width).min(area.height() / height);
    let frame = Rect::from_center_size(area.center(), vec2(width, height) * fitting);
    let picture = description
        .camera
        .in_scene()
        .frame(description.render.size_px);
    let seen = picture.pixel_of(DVec3::ZERO).expect("the disk is in view");
    let at = frame.min + vec2(seen.x as f32, seen.y as f32) * fitting;
    common::double_click_at(&mut harness, at);
    let target_m = DVec3::from(harness.state().camera().target_m);
    // Half a pixel is 0.3 mm there; a hundredth of one is what rounding to the screen's single precision leaves.
    assert!(target_m.length() < 1e-5, "{target_m} instead of the origin");
}

/// Two squares beside each other, 10 cm wide: the right one is a node "clasp" of a material "gold". A camera "front" stands before them.
/// A lamp for a model: where there is none, a studio is made, whose surroundings take seconds to blur.
pub(crate) const LAMP: &str =
    "[[light]]\nkind = \"sphere\"\ncenter_m = [0, 0, 0.4]\nradius_m = 0.01\n";

pub(crate) fn two_squares(dir: &std::path::Path) {
    let corners = [[-0.1, 0.0], [0.0, 0.0], [0.0, 0.1], [-0.1, 0.1]];
    let right = corners.map(|[x, y]| [x + 0.1, y]);
    let floats = corners.into_iter().chain(right);
    let floats = floats.flat_map(|[x, y]| [x as f32, y as f32 - 0.05, 0.0]);
    let mut bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    bytes.extend([0u16, 1, 2, 0, 2, 3].into_iter().flat_map(u16::to_le_bytes));
    std::fs::write(dir.join("a.bin"), bytes).unwrap();
    let accessor = |offset: u32| {
        format!(
            r#"{{"bufferView":0,"byteOffset":{offset},"componentType":5126,"count":4,"type":"VEC3","min":[-0.1,-0.1,0],"max":[0.1,0.1,0]}}"#
        )
    };
    let mesh = |i: u32| {
        format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{i}}},"indices":2,"material":{i}}}]}}"#
        )
    };
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0,1,2]}}],
        "nodes":[{{"name":"strap","mesh":0}},{{"name":"clasp","mesh":1}},{{"name":"front","camera":0,"translation":[0,0,0.5]}}],
        "cameras":[{{"type":"perspective","perspective":{{"yfov":0.5,"znear":0.1}}}}],
        "meshes":[{},{}],"materials":[{{"name":"steel"}},{{"name":"gold"}}],"buffers":[{{"uri":"a.bin","byteLength":108}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":12}}],
        "accessors":[{},{},{{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}}]}}"#,
        mesh(0),
        mesh(1),
        accessor(0),
        accessor(48)
    );
    std::fs::write(dir.join("a.gltf"), text).unwrap();
}

#[test]
fn a_click_keeps_a_layer_to_the_part_that_is_there() {
    let dir = tempfile::tempdir().unwrap();
    two_squares(dir.path());
    let scene = dir.path().join("a.toml");
    let text = "[camera]\nposition_m = [0, 0, 0.4]\ntarget_m = [0, 0, 0]\nup = [0, 1, 0]\n\
        [[object]]\nname = \"it\"\nmesh = \"a.gltf\"\n\
        [[scratches]]\nobject = \"it\"\npattern = \"random\"\ncount = 50\nlength_m = 0.02\n";
    std::fs::write(&scene, format!("{text}{LAMP}")).unwrap();
    let mut harness = common::viewer_of_file(&scene);
    let document = harness.state_mut().document_mut();
    document.select(Selection::Layer(0));
    harness.run_steps(3);
    common::click_on(&mut harness, "Pick a part…");
    let middle = common::picture(&harness).center();
    common::click_at(&mut harness, middle + vec2(40.0, 10.0));
    common::wait_built(&mut harness);
    let layer = common::description(&harness).scratches[0].clone();
    assert_eq!(layer.material.as_deref(), Some("gold"));
    assert_eq!(layer.node.as_deref(), Some("clasp"));
    // The layer stays selected, and is laid on the right square alone.
    assert_eq!(harness.state().document().selection(), Selection::Layer(0));
    common::wait_until(&mut harness, "the layer lies on the right", |viewer| {
        viewer.renderer().built().is_some_and(|built| {
            let segments = &built.scene.objects[0].segments;
            !segments.is_empty() && segments.iter().all(|it| it.start_m.x > -1e-5)
        })
    });
}
