//! Whatever was done: undo leads back to where it began, redo to where it ended, and every state on the way saves and loads.

use crate::seeded;
use std::path::Path;
use std::sync::Arc;

use glam::{DMat4, DVec2, dvec3};
use hairline_document::Description;
use hairline_document::description::{Layer, Map};
use hairline_document::{navigate, place_light};
use hairline_editor::actions::{self, ActionError, layers, lights, materials, objects, parts};
use hairline_editor::brush::{BrushSettings, Recorder, apply_stroke};
use hairline_editor::presets::{LayerPreset, LightPreset, MaterialPreset, ShapePreset};
use hairline_editor::{Document, DragKey, Selection};
use hairline_fixtures::SceneFile;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

fn scene() -> Description {
    SceneFile::seen_from([0.0, -1.0, 1.0])
        .metal("steel", "steel")
        .object("plate", "steel", "disk = { radius_m = 0.1 }")
        .laid("plate", "circular", 100)
        .sphere([0.0, 0.5, 0.5], 0.02, 1.0)
        .description()
}

/// One thing that an artist does: which, on what, by how much.
type Deed = (u8, usize, f64);

fn deeds() -> impl Strategy<Value = Vec<Deed>> {
    prop::collection::vec((0..28_u8, 0..6_usize, -1.0..1.0), 1..40)
}

/// Does it, as a panel would: on a part that may not be there, which is then refused.
fn perform(document: &mut Document, (deed, i, by): Deed) {
    let up_or_down = if by < 0.0 { -1 } else { 1 };
    let mut apply = |action: &dyn Fn(&mut Description, Selection) -> Result<Selection, _>| {
        let _ = document.apply("action", action);
    };
    match deed {
        0 => apply(&|d, _| layers::duplicate(d, i)),
        1 => apply(&|d, s| parts::delete(d, Selection::Layer(i), s)),
        2 => apply(&|d, s| parts::shift(d, Selection::Layer(i), up_or_down, s)),
        3 => apply(&|d, _| parts::toggle_hidden(d, Selection::Layer(i))),
        4 => apply(&|d, _| layers::toggle_solo(d, i)),
        5 => apply(&|d, _| {
            let object = d.objects[i % d.objects.len()].name.clone();
            layers::add(d, LayerPreset::ALL[i].layer(object, 0.2 + 0.1 * by))
        }),
        6 => apply(&|d, _| {
            let layer = d.scratches.get_mut(i);
            layer.ok_or(ActionError::Missing("layer"))?.name = (by >= 0.0).then(|| "wear".into());
            Ok(Selection::Layer(i))
        }),
        7 => apply(&|d, _| {
            Ok(lights::add(
                d,
                LightPreset::ALL[i % LightPreset::ALL.len()].light(
                    dvec3(by, 0.0, 0.0),
                    dvec3(0.0, 0.0, 1.0),
                    0.3,
                ),
            ))
        }),
        8 => apply(&|d, s| parts::delete(d, Selection::Light(i), s)),
        9 => apply(&|d, _| parts::duplicate(d, Selection::Light(i))),
        10 => apply(&|d, s| parts::shift(d, Selection::Light(i), up_or_down, s)),
        11 => apply(&|d, _| {
            Ok(materials::add(
                d,
                MaterialPreset::all().nth(i).unwrap().material(),
            ))
        }),
        12 => apply(&|d, s| materials::delete(d, i, s)),
        13 => apply(&|d, _| materials::rename(d, i, if by < 0.0 { "steel" } else { "other" })),
        14 => apply(&|d, _| objects::add_shape(d, ShapePreset::ALL[i % 4].shape(0.2), Some(i))),
        15 => apply(&|d, _| {
            Ok(objects::add_mesh(
                d,
                Path::new("models/pan.glb"),
                Path::new(""),
            ))
        }),
        16 => apply(&|d, s| objects::delete(d, i, s)),
        17 => apply(&|d, _| objects::duplicate(d, i)),
        18 => apply(&|d, _| objects::rename(d, i, if by < 0.0 { "plate" } else { "pan" })),
        19 => apply(&|d, _| {
            let file = (by > -0.5).then(|| Map::File("studio.hdr".into()));
            Ok(actions::set_environment(d, file, Path::new("")))
        }),
        20 => {
            let size_px = DVec2::new(640.0, 480.0);
            for k in 0..3 {
                let drag_px = DVec2::new(by * 100.0, f64::from(k) * by);
                document.drag("orbit", DragKey(1), |d| {
                    navigate::orbit(&mut d.camera, drag_px, size_px)
                });
            }
            // Another deed, undo or drag may end it instead.
            if i > 2 {
                document.end_drag();
            }
        }
        21 => document.drag("exposure", DragKey(2), |d| d.camera.exposure_ev = by * 4.0),
        22 => document.drag("width", DragKey(3), |d| {
            if let Some(Layer::Laid(laid)) = d.scratches.get_mut(i).map(|s| &mut s.layer) {
                laid.width_um.mean = 3.0 + by;
            }
        }),
        23 => document.drag("light", DragKey(4), |d| {
            if let Some(light) = d.lights.get_mut(i) {
                place_light::place_highlight(
                    light,
                    dvec3(0.0, -1.0, 1.0),
                    dvec3(by, 0.0, 0.0),
                    dvec3(0.0, 0.0, 1.0),
                );
            }
        }),
        24 => {
            let settings = BrushSettings {
                erase: by < -0.3,
                ..BrushSettings::for_view(0.2, 0.2)
            };
            let mut recorder = Recorder::new(settings, DMat4::IDENTITY);
            for k in 0..20 {
                let t = f64::from(k) / 20.0;
                recorder.add(dvec3(0.1 * t, 0.05 * (t * 7.0 * by).sin(), 0.0));
            }
            let stroke = recorder.finish().unwrap();
            let _ = document.apply("stroke", |d, s| apply_stroke(d, s, stroke));
        }
        25 => document.select(
            [
                Selection::Layer(i),
                Selection::Object(i),
                Selection::Light(i),
                Selection::Material(i),
                Selection::Camera,
                Selection::None,
            ][i],
        ),
        26 => {
            document.undo();
        }
        _ => {
            document.redo();
        }
    }
}

/// Checks the properties of every state.
fn holds_together(document: &Document) -> Result<(), String> {
    let description = document.description();
    if !document.selection().is_in(description) {
        return Err(format!("{:?} is selected", document.selection()));
    }
    description
        .check()
        .and_then(|()| description.check_references())
        .map_err(|error| error.to_string())?;
    let text = description.to_toml().map_err(|error| error.to_string())?;
    let loaded = Description::from_toml(&text, Path::new("saved")).map_err(|e| e.to_string())?;
    if loaded != **description {
        return Err(format!("loads otherwise:\n{text}"));
    }
    Ok(())
}

/// Does it all; then back to the beginning and forward to the end, by the steps of `undo` and `redo`.
fn round_trip(
    deeds: &[Deed],
    undo: impl Fn(&mut Document) -> bool,
    redo: impl Fn(&mut Document) -> bool,
) -> Result<(), String> {
    let mut document = Document::untitled(scene(), "");
    for &deed in deeds {
        let before = (document.revision(), document.description().clone());
        perform(&mut document, deed);
        let changed = before.1 != *document.description();
        if changed && document.revision() == before.0 {
            return Err("a change without a new revision".to_owned());
        }
        if document.is_modified() != (**document.description() != scene()) {
            return Err("modified is not what differs from the start".to_owned());
        }
        holds_together(&document)?;
    }
    let end = (Arc::clone(document.description()), document.selection());
    // The steps that were undone at the end can be redone.
    let mut steps = 0;
    while undo(&mut document) {
        steps += 1;
        holds_together(&document)?;
    }
    if **document.description() != scene() || document.is_modified() {
        return Err("undoing all is not the beginning".to_owned());
    }
    for _ in 0..steps {
        if !redo(&mut document) {
            return Err("a step cannot be done again".to_owned());
        }
        holds_together(&document)?;
    }
    if *document.description() != end.0 {
        return Err("redoing all is not the end".to_owned());
    }
    Ok(())
}

fn check(
    undo: impl Fn(&mut Document) -> bool,
    redo: impl Fn(&mut Document) -> bool,
) -> Result<(), String> {
    let mut runner = TestRunner::new(seeded(300));
    runner
        .run(&deeds(), |deeds| {
            round_trip(&deeds, &undo, &redo).map_err(TestCaseError::fail)
        })
        .map_err(|error| error.to_string())
}

fn undo(document: &mut Document) -> bool {
    document.undo().is_some()
}

fn redo(document: &mut Document) -> bool {
    document.redo().is_some()
}

#[test]
fn undoing_all_is_the_beginning_and_redoing_all_the_end() {
    check(undo, redo).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_history_that_lost_a_step_is_noticed() {
    // An editor that drops its first step: the last step back is missing.
    let forgetful = |document: &mut Document| {
        let taken = undo(document);
        if taken && document.undo_label().is_none() {
            redo(document);
            return false;
        }
        taken
    };
    let error = check(forgetful, redo).unwrap_err();
    assert!(
        error.contains("undoing all is not the beginning"),
        "{error}"
    );
    // An editor whose redo leads nowhere.
    let error = check(undo, |document| document.redo_label().is_some()).unwrap_err();
    assert!(error.contains("redoing all is not the end"), "{error}");
}
