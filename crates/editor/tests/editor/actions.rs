//! Actions: their results are scenes, and the selection stays on the selected part.

use std::path::Path;

use glam::DVec3;
use hairline_document::Description;
use hairline_document::description::{Light, LightKind, Map, Surface};
use hairline_editor::actions::{self, layers, lights, materials, objects, parts};
use hairline_editor::grating_presets::GratingPreset;
use hairline_editor::presets::*;
use hairline_editor::{ActionError, Selection};
use hairline_fixtures::SceneFile;
use hairline_sky::BuiltInMap;

fn scene() -> Description {
    let mut file = SceneFile::seen_from([0.0, 0.0, 1.0]);
    for name in ["steel", "gold", "unused"] {
        file = file.mirror(name);
    }
    for (name, material) in [("a", "steel"), ("b", "gold"), ("c", "gold")] {
        file = file.object(name, material, "disk = { radius_m = 1 }");
    }
    for (i, object) in ["a", "b", "a", "c", "a"].iter().enumerate() {
        file = file.random(object, 1).with_lines(&format!("seed = {i}"));
    }
    for x_m in [0.0, 1.0, 2.0] {
        file = file.sphere([x_m, 0.0, 1.0], 0.1, 1.0);
    }
    file.description()
}

/// Names the selected part by something that survives its moving.
fn what(description: &Description, selection: Selection) -> String {
    match selection {
        Selection::Object(i) => description.objects[i].name.clone(),
        Selection::Material(i) => description.materials[i].name.clone(),
        Selection::Layer(i) => format!("layer {:?}", description.scratches[i].layer.seed()),
        Selection::Light(i) => format!("light {:?}", description.lights[i].kind),
        other => format!("{other:?}"),
    }
}

fn every_selection(description: &Description) -> Vec<Selection> {
    let mut all = vec![
        Selection::None,
        Selection::Camera,
        Selection::Environment,
        Selection::Render,
    ];
    all.extend((0..description.objects.len()).map(Selection::Object));
    all.extend((0..description.materials.len()).map(Selection::Material));
    all.extend((0..description.scratches.len()).map(Selection::Layer));
    all.extend((0..description.lights.len()).map(Selection::Light));
    all
}

#[test]
fn deleting_and_moving_leave_the_selection_on_its_part() {
    type Action = fn(&mut Description, usize, Selection) -> Result<Selection, ActionError>;
    let cases: [(&str, usize, Action); 12] = [
        ("layer", 5, |d, i, s| {
            parts::delete(d, Selection::Layer(i), s)
        }),
        ("layer", 5, |d, i, s| {
            parts::shift(d, Selection::Layer(i), -1, s)
        }),
        ("layer", 5, |d, i, s| {
            parts::shift(d, Selection::Layer(i), 1, s)
        }),
        ("light", 3, |d, i, s| {
            parts::delete(d, Selection::Light(i), s)
        }),
        ("light", 3, |d, i, s| {
            parts::shift(d, Selection::Light(i), -1, s)
        }),
        ("light", 3, |d, i, s| {
            parts::shift(d, Selection::Light(i), 1, s)
        }),
        ("object", 3, objects::delete),
        ("object", 3, |d, i, s| {
            parts::shift(d, Selection::Object(i), -1, s)
        }),
        ("object", 3, |d, i, s| {
            parts::shift(d, Selection::Object(i), 1, s)
        }),
        ("material", 3, materials::delete),
        ("material", 3, |d, i, s| {
            parts::shift(d, Selection::Material(i), -1, s)
        }),
        ("material", 3, |d, i, s| {
            parts::shift(d, Selection::Material(i), 1, s)
        }),
    ];
    for (kind, count, action) in cases {
        for index in 0..count {
            for selection in every_selection(&scene()) {
                let mut description = scene();
                let before = what(&description, selection);
                let Ok(after) = action(&mut description, index, selection) else {
                    assert_eq!(description, scene());
                    continue;
                };
                assert!(
                    after.is_in(&description),
                    "{kind} {index} {selection:?} {after:?}"
                );
                description
                    .check()
                    .and(description.check_references())
                    .unwrap();
                let still_there = every_selection(&description)
                    .into_iter()
                    .any(|s| what(&description, s) == before);
                if still_there {
                    assert_eq!(
                        what(&description, after),
                        before,
                        "{kind} {index} {selection:?}"
                    );
                }
            }
        }
        let mut description = scene();
        assert!(matches!(
            action(&mut description, count, Selection::None),
            Err(ActionError::Missing(_))
        ));
    }
}

#[test]
fn a_deleted_layer_hands_over_to_a_neighbour_on_its_object() {
    let mut description = scene();
    let mut delete =
        |i| parts::delete(&mut description, Selection::Layer(i), Selection::Layer(i)).unwrap();
    assert_eq!(delete(2), Selection::Layer(3), "seed 4, the next on a");
    assert_eq!(delete(3), Selection::Layer(0), "seed 0, the one before it");
    assert_eq!(delete(0), Selection::Object(0));
}

#[test]
fn layers_move_among_those_of_their_object() {
    let mut description = scene();
    let seeds = |d: &Description| -> Vec<_> {
        d.scratches
            .iter()
            .filter_map(|layer| layer.layer.seed())
            .collect()
    };
    let selection = parts::shift(
        &mut description,
        Selection::Layer(2),
        1,
        Selection::Layer(2),
    )
    .unwrap();
    assert_eq!(
        (seeds(&description), selection),
        (vec![0, 1, 4, 3, 2], Selection::Layer(4))
    );
    parts::shift(&mut description, Selection::Layer(4), 1, Selection::None).unwrap();
    parts::shift(&mut description, Selection::Layer(1), -1, Selection::None).unwrap();
    assert_eq!(
        seeds(&description),
        [0, 1, 4, 3, 2],
        "at the ends nothing happens"
    );
}

#[test]
fn copies_and_new_layers_have_seeds_and_names_of_their_own() {
    let mut description = scene();
    assert_eq!(
        layers::duplicate(&mut description, 0),
        Ok(Selection::Layer(1))
    );
    for preset in LayerPreset::ALL.into_iter().chain(LayerPreset::ALL) {
        let selection = layers::add(&mut description, preset.layer("b", 0.3)).unwrap();
        let Selection::Layer(i) = selection else {
            panic!()
        };
        assert_eq!(description.scratches[i].object, "b");
    }
    let mut seeds: Vec<_> = description
        .scratches
        .iter()
        .map(|l| l.layer.seed())
        .collect();
    let count = seeds.len();
    seeds.sort();
    seeds.dedup();
    assert_eq!(seeds.len(), count);
    let mut names: Vec<_> = description
        .scratches
        .iter()
        .filter_map(|l| l.name.clone())
        .collect();
    assert!(names.contains(&"brushed steel 2".to_owned()));
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
    // Also where the largest seed is taken.
    *description.scratches[0].layer.seed_mut().unwrap() = i64::MAX as u64;
    layers::duplicate(&mut description, 0).unwrap();
    description.check().unwrap();
    assert_eq!(
        layers::add(&mut description, LayerPreset::TurnedPan.layer("x", 0.3)),
        Err(ActionError::Missing("object"))
    );
}

#[test]
fn renaming_takes_references_along() {
    let mut description = scene();
    let name = description.objects[0].name.clone();
    let grating = GratingPreset::CompactDisc.grating(name);
    description.gratings.push(grating);
    objects::rename(&mut description, 0, " pan ").unwrap();
    materials::rename(&mut description, 1, "brass").unwrap();
    description
        .check()
        .and(description.check_references())
        .unwrap();
    assert_eq!(objects::layers(&description, 0), [0, 2, 4]);
    assert_eq!(materials::users(&description, 1), [1, 2]);
    let taken = objects::rename(&mut description, 0, "b").unwrap_err();
    assert_eq!(
        taken.to_string(),
        "there is already an object called \"b\"; choose another name"
    );
    assert_eq!(
        objects::rename(&mut description, 0, "  "),
        Err(ActionError::EmptyName)
    );
    assert_eq!(
        materials::rename(&mut description, 0, "brass").unwrap_err(),
        ActionError::NameTaken {
            what: "a material",
            name: "brass".into()
        }
    );
    // A part may keep its name, and layers and lights may have none.
    materials::rename(&mut description, 1, "brass").unwrap();
    description.scratches[0].name = Some("wear".into());
    assert_eq!(layers::title(&description.scratches[0]), "wear");
    description.scratches[0].name = None;
    description.lights[0].name = None;
    assert_eq!(layers::title(&description.scratches[0]), "random scratches");
    assert_eq!(lights::title(&description.lights[0]), "sphere light");
}

#[test]
fn hidden_and_solo_decide_what_is_shown() {
    let mut description = scene();
    let shown = |d: &Description| {
        (0..5)
            .filter(|&i| layers::is_shown(d, i))
            .collect::<Vec<_>>()
    };
    parts::toggle_hidden(&mut description, Selection::Layer(1)).unwrap();
    assert_eq!(shown(&description), [0, 2, 3, 4]);
    layers::toggle_solo(&mut description, 1).unwrap();
    layers::toggle_solo(&mut description, 3).unwrap();
    assert_eq!(shown(&description), [3]);
    layers::toggle_solo(&mut description, 3).unwrap();
    parts::toggle_hidden(&mut description, Selection::Layer(1)).unwrap();
    assert_eq!(shown(&description), [1]);
    parts::toggle_hidden(&mut description, Selection::Light(2)).unwrap();
    assert!(description.lights[2].hidden);
    assert_eq!(shown(&description)[..], [1]);
}

#[test]
fn objects_come_with_material_and_go_with_their_layers() {
    let mut description = scene();
    let selection = objects::duplicate(&mut description, 0).unwrap();
    assert_eq!(selection, Selection::Object(1));
    assert_eq!(description.objects[1].name, "a 2");
    assert_eq!(objects::layers(&description, 1).len(), 3);
    objects::delete(&mut description, 0, Selection::None).unwrap();
    assert_eq!(
        objects::layers(&description, 0).len(),
        3,
        "the copy's layers stay"
    );
    objects::delete(&mut description, 0, Selection::None).unwrap();
    objects::delete(&mut description, 0, Selection::None).unwrap();
    assert_eq!(
        objects::delete(&mut description, 0, Selection::None),
        Err(ActionError::LastObject("c".into()))
    );

    let folder = Path::new("/a/scenes");
    let selection = objects::add_mesh(&mut description, Path::new("/a/models/c.glb"), folder);
    assert_eq!(selection, Selection::Object(1));
    assert_eq!(description.objects[1].name, "c 2");
    assert_eq!(
        description.objects[1].surface,
        Surface::Mesh("../models/c.glb".into())
    );
    assert_eq!(description.objects[1].material, None);
    actions::set_environment(
        &mut description,
        Some(Map::File("/a/maps/x.hdr".into())),
        folder,
    );
    description.environment.as_mut().unwrap().rotation_deg = 30.0;
    actions::set_environment(&mut description, Some(Map::File("y.exr".into())), folder);
    let environment = description.environment.as_ref().unwrap();
    assert_eq!(
        (&environment.map, environment.rotation_deg),
        (&Map::File("y.exr".into()), 30.0)
    );
    let studio = Map::BuiltIn(BuiltInMap::Studio);
    actions::set_environment(&mut description, Some(studio.clone()), folder);
    let environment = description.environment.as_ref().unwrap();
    assert_eq!(
        (&environment.map, environment.rotation_deg),
        (&studio, 30.0)
    );
    actions::set_environment(&mut description, None, folder);
    assert_eq!(description.environment, None);

    // A shape in a scene without materials brings one.
    description.materials.clear();
    description.objects.clear();
    description.scratches.clear();
    for preset in ShapePreset::ALL {
        objects::add_shape(&mut description, preset.shape(0.2), None).unwrap();
    }
    assert_eq!(description.materials.len(), 1);
    description
        .check()
        .and(description.check_references())
        .unwrap();
}

#[test]
fn presets_are_legal_for_objects_of_any_size() {
    for diagonal_m in [0.0, 1e-3, 0.03, 0.3, 5.0, 1e4, f64::NAN] {
        let mut description = scene();
        for preset in LayerPreset::ALL {
            layers::add(&mut description, preset.layer("a", diagonal_m)).unwrap();
        }
        for preset in MaterialPreset::all() {
            materials::add(&mut description, preset.material());
        }
        for preset in LightPreset::ALL {
            for up in [DVec3::Y, DVec3::Z, DVec3::ZERO] {
                let target = DVec3::new(0.1, 0.2, 0.3);
                let light = preset.light(target, up, diagonal_m);
                shines_on(&light, target);
                lights::add(&mut description, light);
            }
        }
        description.check().unwrap();
        let text = description.to_toml().unwrap();
        assert_eq!(
            Description::from_toml(&text, Path::new("test")).unwrap(),
            description
        );
    }
    // All metals, each once.
    let mut names: Vec<_> = MaterialPreset::all().map(MaterialPreset::name).collect();
    assert_eq!(names.len(), hairline_optics::metal::Metal::ALL.len() + 4);
    names.sort();
    names.dedup();
    assert_eq!(names.len(), hairline_optics::metal::Metal::ALL.len() + 4);
}

fn shines_on(light: &Light, target: DVec3) {
    let LightKind::Polygon { .. } = light.kind else {
        return;
    };
    let towards = (target - hairline_document::place_light::center(light)).normalize();
    let facing = light.kind.axis().unwrap();
    assert!(facing.dot(towards) > 1.0 - 1e-9, "{light:?}");
}
