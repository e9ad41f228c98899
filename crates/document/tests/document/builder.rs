//! A builder that keeps unchanged parts builds the same scenes as one that keeps nothing.

use std::cell::{Cell, RefCell};
use std::path::Path;
use std::sync::Arc;

use crate::common::{self, Glb, cube, temporary_dir};
use hairline_document::description::*;
use hairline_document::{Loader, SceneBuilder, Stage};
use hairline_image::{FilePath, Memory};
use hairline_optics::section::Section;
use hairline_scene::Scene;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const HEADER: &str = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n";

/// A disk and a ball with two layers each, a model with a material of its own, a map, and a layer from a list.
fn files_and_scene(dir: &Path) -> Description {
    let (corners, triangles) = cube();
    let mut glb = Glb::default();
    let (positions, indices) = (glb.floats(&corners), glb.indices(&triangles));
    glb.more = r#","materials":[{"name":"own"}]"#.to_owned();
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices},"material":0}}]}}"#
    );
    std::fs::write(dir.join("cube.glb"), glb.bytes(&mesh, r#"{"mesh":0}"#)).unwrap();
    std::fs::write(
        dir.join("list.csv"),
        format!("{HEADER}-0.04,0,0,0.04,0,0,2,100\n"),
    )
    .unwrap();
    let mut map = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
    map.extend((0..8u8).flat_map(|i| [i + 1, 200 - i, 3 * i, 128]));
    std::fs::write(dir.join("map.hdr"), map).unwrap();
    let text = common::scene_with(
        r#"
[environment]
file = "map.hdr"
[[object]]
name = "disk"
shape = { disk = { radius_m = 0.08 } }
material = "steel"
[[object]]
name = "ball"
shape = { sphere = { radius_m = 0.03 } }
material = "steel"
translation_m = [0.0, 0.0, 0.05]
[[object]]
name = "cube"
mesh = "cube.glb"
scale = 0.02
[[scratches]]
object = "disk"
pattern = "swirl"
count = 60
[[scratches]]
object = "ball"
pattern = "random"
count = 50
[[scratches]]
object = "disk"
pattern = "drawn"
jitter_deg = 5.0
strokes = [ { points_m = [[0, 0, 0], [0.03, 0.01, 0]], radius_m = 0.004, density_per_m = 1000.0 } ]
[[scratches]]
object = "cube"
pattern = "random"
count = 40
[[scratches]]
object = "disk"
pattern = "file"
file = "list.csv"
[[light]]
kind = "sphere"
center_m = [0.0, 0.0, 1.0]
radius_m = 0.01
"#,
    );
    Description::from_toml(&text, Path::new("test.toml")).unwrap_or_else(|e| panic!("{e}"))
}

fn assert_equal(a: &Scene, b: &Scene, what: &str) {
    assert_eq!((a.camera, a.render), (b.camera, b.render), "{what}");
    assert_eq!(a.lights, b.lights, "{what}");
    assert_eq!(
        format!("{:?}{:?}", a.materials, a.textures),
        format!("{:?}{:?}", b.materials, b.textures),
        "{what}"
    );
    // Environments share nothing here; looking at them tells.
    let look = |scene: &Scene| {
        let environment = scene.environment.as_ref()?;
        let dir = glam::DVec3::new(0.6, 0.0, 0.8);
        let map = environment.background().rgb.clone();
        Some((environment.radiance(dir), environment.visible(), map))
    };
    assert_eq!(look(a), look(b), "{what}");
    assert_eq!(a.objects.len(), b.objects.len(), "{what}");
    for (a, b) in a.objects.iter().zip(&b.objects) {
        assert_eq!(a.name, b.name, "{what}");
        assert_eq!(a.scratches, b.scratches, "{what}");
        assert_eq!(a.segments, b.segments, "{what}");
        assert_eq!(a.mesh.positions_m, b.mesh.positions_m, "{what}");
        assert_eq!(a.mesh.triangles, b.mesh.triangles, "{what}");
        assert_eq!(
            a.mesh.triangle_materials, b.mesh.triangle_materials,
            "{what}"
        );
        assert_eq!(a.mesh.normals, b.mesh.normals, "{what}");
    }
}

/// Does one random edit, and describes it.
fn edit(it: &mut Description, random: &mut Pcg64, dir: &Path) -> String {
    let layers = it.scratches.len();
    let i = random.random_range(0..layers);
    let point = |random: &mut Pcg64| {
        [0, 1, 2].map(|axis| {
            if axis < 2 {
                random.random_range(-0.05..0.05)
            } else {
                0.0
            }
        })
    };
    let layer = &mut it.scratches[i];
    let kind = random.random_range(0..17);
    match kind {
        0 => layer.hidden ^= true,
        1 => layer.solo ^= true,
        2 => layer.name = Some(format!("layer {}", random.random_range(0..99))),
        3 => it.scratches.swap(i, (i + 1) % layers),
        4 if layers > 3 => drop(it.scratches.remove(i)),
        4 | 5 => {
            let mut copy = it.scratches[i].clone();
            copy.hidden = false;
            it.scratches.push(copy);
        }
        6 => {
            if let Some(seed) = layer.layer.seed_mut() {
                *seed = random.random_range(1..4);
            }
        }
        7 => match &mut layer.layer {
            Layer::Laid(laid) => laid.width_um.mean = random.random_range(1.0..5.0),
            Layer::Brushed(brushed) => brushed.length_m.mean = random.random_range(0.005..0.02),
            Layer::Engraved(_) | Layer::Listed(_) => {}
        },
        8 => layer.strokes.push(Stroke {
            points_m: vec![point(random), point(random)],
            radius_m: 0.01,
            brush: Brush::Erase,
        }),
        9 => {
            if matches!(layer.layer, Layer::Brushed(_)) {
                layer.strokes.push(Stroke {
                    points_m: (0..random.random_range(1..4))
                        .map(|_| point(random))
                        .collect(),
                    radius_m: 0.005,
                    brush: Brush::Paint {
                        density_per_m: 500.0,
                        width: 2.0,
                        depth: 1.0,
                    },
                });
            }
        }
        10 => drop(layer.strokes.pop()),
        11 => {
            let object = random.random_range(0..it.objects.len());
            it.objects[object].rotation_deg[2] += 10.0;
        }
        12 => it.lights[0].hidden ^= true,
        13 => {
            if let Some(environment) = &mut it.environment {
                environment.rotation_deg += 20.0;
                environment.intensity *= 1.5;
                environment.visible ^= true;
            }
        }
        14 => {
            let mut material = it.materials[0].clone();
            material.name = format!("material {}", it.materials.len());
            it.materials.insert(0, material);
        }
        15 => {
            layer.profile = match layer.profile {
                Section::V => Section::Round,
                _ => Section::V,
            };
        }
        _ => {
            let rows = "0,-0.04,0,0.01,0.04,0,3,150\n".repeat(random.random_range(1..9));
            std::fs::write(dir.join("list.csv"), format!("{HEADER}{rows}")).unwrap();
        }
    }
    format!("edit {kind} of layer {i}")
}

#[test]
fn what_is_built_after_edits_is_what_is_built_from_nothing() {
    let dir = temporary_dir();
    let mut it = files_and_scene(dir.path());
    let mut builder = SceneBuilder::new();
    let loader = Loader::default();
    let mut random = Pcg64::seed_from_u64(7);
    let mut done = String::new();
    for step in 0..150 {
        let scene = builder.build(&loader, &it, dir.path());
        let scene = scene.unwrap_or_else(|e| panic!("{e}"));
        // Prefiltering the map takes longer than all else; a few times are enough.
        let mut described = it.clone();
        let with_map = step % 50 == 49;
        if !with_map {
            described.environment = None;
        }
        let mut anew = hairline_document::build(&described, dir.path()).unwrap();
        if !with_map {
            anew.environment = scene.environment.clone();
        }
        assert_equal(&scene, &anew, &format!("step {step}, {done}"));
        done = edit(&mut it, &mut random, dir.path());
    }
}

/// Tells which of the objects share their surfaces, and which their scratches.
fn shared(a: &Scene, b: &Scene) -> ([bool; 3], [bool; 3]) {
    let objects = [0, 1, 2].map(|i| [&a.objects[i], &b.objects[i]]);
    (
        objects.map(|[a, b]| Arc::ptr_eq(&a.mesh, &b.mesh)),
        objects.map(|[a, b]| Arc::ptr_eq(&a.segments, &b.segments)),
    )
}

#[test]
fn what_has_not_changed_is_shared() {
    let dir = temporary_dir();
    let it = files_and_scene(dir.path());
    let mut builder = SceneBuilder::new();
    let laid = RefCell::new(None);
    let loader = Loader {
        progress: &|progress| {
            if progress.stage == Stage::Scratches {
                *laid.borrow_mut() = Some(progress.total);
            }
        },
        ..Loader::default()
    };
    let first = builder.build(&loader, &it, dir.path()).unwrap();
    assert_eq!(laid.take(), Some(60 + 50 + 32 + 40 + 1));
    let mut check = |change: &dyn Fn(&mut Description), meshes, scratches, count| {
        let mut changed = it.clone();
        change(&mut changed);
        let second = builder.build(&loader, &changed, dir.path()).unwrap();
        assert_eq!(shared(&first, &second), (meshes, scratches));
        assert_eq!(laid.take(), count);
        let maps = [&first, &second].map(|scene| scene.environment.as_ref().unwrap());
        assert!(maps[0].same_map(maps[1]));
        assert!(Arc::ptr_eq(&first.textures, &second.textures));
        // Back again, for the next change.
        builder.build(&loader, &it, dir.path()).unwrap();
        assert_eq!(laid.take(), None);
    };
    const ALL: [bool; 3] = [true; 3];
    // Light, material, map: nothing is laid.
    check(&|it| it.lights[0].radiance = 3.0, ALL, ALL, None);
    check(&|it| it.materials[0].roughness = 0.3, ALL, ALL, None);
    check(
        &|it| it.environment.as_mut().unwrap().rotation_deg = 30.0,
        ALL,
        ALL,
        None,
    );
    check(
        &|it| it.scratches[0].name = Some("marks".to_owned()),
        ALL,
        ALL,
        None,
    );
    // Hiding and showing lay nothing either, but put the disk's layers together anew.
    check(
        &|it| it.scratches[0].hidden = true,
        ALL,
        [false, true, true],
        None,
    );
}

#[test]
fn one_changed_layer_is_laid_alone() {
    let dir = temporary_dir();
    let it = files_and_scene(dir.path());
    for (change, meshes, scratches, count) in [
        (
            &(|it: &mut Description| *it.scratches[2].layer.seed_mut().unwrap() = 9)
                as &dyn Fn(&mut Description),
            [true; 3],
            [false, true, true],
            Some(32),
        ),
        // The second in the list, on another object: the later ones have new places, and so new arrays, but are not laid.
        (
            &|it| drop(it.scratches.remove(1)),
            [true; 3],
            [false; 3],
            None,
        ),
        // A moved object is laid anew.
        (
            &|it| it.objects[1].translation_m[0] = 0.01,
            [true, false, true],
            [true, false, true],
            Some(50),
        ),
        // Materials before the file's own shift its numbers, and nothing else.
        (
            &|description| {
                let mut another = description.materials[0].clone();
                another.name = "another".to_owned();
                description.materials.push(another);
            },
            [true, true, false],
            [true; 3],
            None,
        ),
    ] {
        let mut builder = SceneBuilder::new();
        let first = builder.build(&Loader::default(), &it, dir.path()).unwrap();
        let mut changed = it.clone();
        change(&mut changed);
        let laid = Cell::new(None);
        let loader = Loader {
            progress: &|progress| {
                if progress.stage == Stage::Scratches {
                    laid.set(Some(progress.total));
                }
            },
            ..Loader::default()
        };
        let second = builder.build(&loader, &changed, dir.path()).unwrap();
        assert_eq!(shared(&first, &second), (meshes, scratches));
        assert_eq!(laid.get(), count);
    }
}

#[test]
fn a_build_that_fails_or_is_cancelled_changes_nothing() {
    let dir = temporary_dir();
    let it = files_and_scene(dir.path());
    let mut builder = SceneBuilder::new();
    let first = builder.build(&Loader::default(), &it, dir.path()).unwrap();
    let same = |builder: &mut SceneBuilder| {
        let again = builder.build(&Loader::default(), &it, dir.path()).unwrap();
        assert_eq!(shared(&first, &again), ([true; 3], [true; 3]));
    };
    let mut wrong = it.clone();
    wrong.objects[0].translation_m[0] = 0.5;
    wrong.scratches[4].layer = Layer::Listed(Listed {
        file: "gone.csv".into(),
    });
    let error = builder
        .build(&Loader::default(), &wrong, dir.path())
        .unwrap_err();
    assert!(!error.is_cancelled(), "{error}");
    same(&mut builder);

    // Cancelled at the first question, at the second, and so on, until it is done before it is asked often enough.
    let mut all_new = it.clone();
    for object in &mut all_new.objects {
        object.translation_m[0] += 0.5;
    }
    let mut cancelled = 0;
    loop {
        let asked = Cell::new(0);
        let loader = Loader {
            cancelled: &|| asked.replace(asked.get() + 1) >= cancelled,
            ..Loader::default()
        };
        match builder.build(&loader, &all_new, dir.path()) {
            Ok(_) => break,
            Err(error) => assert!(error.is_cancelled(), "{error}"),
        }
        same(&mut builder);
        cancelled += 1;
    }
    // Each object, the map, and each layer twice.
    assert!(cancelled >= 9, "{cancelled}");
}

#[test]
fn a_large_layer_is_given_up_after_a_few_of_its_scratches() {
    let dir = temporary_dir();
    let mut it = files_and_scene(dir.path());
    let Layer::Laid(laid) = &mut it.scratches[0].layer else {
        panic!("no strewn layer");
    };
    laid.amount = Amount::Count(50_000);
    // Stops as soon as it is reported that more scratches are laid than those for the memory's estimate.
    let (laid, asked) = (Cell::new(0), Cell::new(0));
    let loader = Loader {
        progress: &|progress| {
            if progress.stage == Stage::Scratches {
                laid.set(progress.done);
            }
        },
        cancelled: &|| {
            asked.set(asked.get() + 1);
            laid.get() > 1024
        },
        ..Loader::default()
    };
    let error = SceneBuilder::new()
        .build(&loader, &it, dir.path())
        .unwrap_err();
    assert!(error.is_cancelled(), "{error}");
    assert!(laid.get() <= 2048, "{} were laid", laid.get());
    assert!(asked.get() > 10, "asked {} times", asked.get());
}

/// A viewer clones scenes at the display's rate while a light is dragged. 10,000 clones of a copied scene would take
/// minutes.
#[test]
fn clones_are_cheap() {
    let dir = temporary_dir();
    let mut it = files_and_scene(dir.path());
    if let Layer::Laid(laid) = &mut it.scratches[0].layer {
        laid.amount = Amount::Count(20_000);
    }
    let scene = hairline_document::build(&it, dir.path()).unwrap();
    let start = std::time::Instant::now();
    let clones: Vec<_> = (0..10_000).map(|_| scene.clone()).collect();
    let each_us = start.elapsed().as_secs_f64() * 1e6 / clones.len() as f64;
    println!("a clone takes {each_us:.2} us");
    // A busy machine is given a hundred times what it takes.
    assert!(each_us < 200.0, "{each_us} us");
}

/// A hidden object keeps its place, since layers and picks count objects; light, ground and layers are as without it.
#[test]
fn a_hidden_object_is_as_if_it_were_not_there() {
    let dir = temporary_dir();
    let mut it = files_and_scene(dir.path());
    it.lights.clear();
    it.studio.hidden = false;
    it.ground = Some(Default::default());
    let mut builder = SceneBuilder::new();
    let loader = Loader::default();
    let whole = builder.build(&loader, &it, dir.path()).unwrap();
    it.objects[1].hidden = true;
    let place_m = it.objects[1].translation_m;
    it.objects[1].translation_m = [0.0, 0.0, -3.0];
    let hidden = builder.build(&loader, &it, dir.path()).unwrap();
    let own = &hidden.objects[1];
    assert!(own.mesh.triangles.is_empty() && own.segments.is_empty() && own.gratings.is_empty());
    assert!(!hidden.objects[0].segments.is_empty());
    // A change elsewhere leaves it shared.
    it.objects[0].rotation_deg[2] += 10.0;
    let after = builder.build(&loader, &it, dir.path()).unwrap();
    assert!(Arc::ptr_eq(&own.mesh, &after.objects[1].mesh));
    it.objects[1].hidden = false;
    it.objects[1].translation_m = place_m;
    let shown = builder.build(&loader, &it, dir.path()).unwrap();
    assert_eq!(
        shown.objects[1].segments.len(),
        whole.objects[1].segments.len()
    );
    // The ground is as large as what is shown asks for.
    let ground_m = |scene: &Scene| {
        let (low_m, high_m) = scene.objects[3].mesh.bounds_m();
        low_m.distance(high_m)
    };
    assert!(ground_m(&hidden) < 1.01 * ground_m(&whole));
}

/// Models, maps and lists are read from memory as from a disk, and one that is held anew is read anew.
#[test]
fn files_in_memory_make_the_same_scene() {
    let dir = temporary_dir();
    let description = files_and_scene(dir.path());
    let on_disk = hairline_document::build(&description, dir.path()).unwrap();
    let memory = Arc::new(Memory::new(|_, _| {}));
    for (_, file) in description.files() {
        memory.hold(file, &std::fs::read(dir.path().join(file)).unwrap());
    }
    let base_dir = FilePath::new(memory.clone(), "");
    let mut builder = SceneBuilder::new();
    let mut build = || builder.build(&Loader::default(), &description, &base_dir);
    assert_equal(&build().unwrap(), &on_disk, "in memory");
    let longer = format!("{HEADER}-0.05,0,0,0.05,0,0,2,100\n");
    memory.hold(Path::new("list.csv"), longer.as_bytes());
    assert_ne!(
        build().unwrap().objects[0].segments,
        on_disk.objects[0].segments
    );
}

#[test]
fn scenes_of_one_builder_share_what_renderers_compute() {
    let dir = temporary_dir();
    let mut description = files_and_scene(dir.path());
    let mut builder = SceneBuilder::new();
    let mut build =
        |description: &Description| builder.build(&Loader::default(), description, dir.path());
    let first = build(&description).unwrap();
    description.camera.exposure_ev += 1.0;
    let second = build(&description).unwrap();
    assert!(Arc::ptr_eq(&first.tables, &second.tables));
    let other = hairline_document::build(&description, dir.path()).unwrap();
    assert!(!Arc::ptr_eq(&first.tables, &other.tables));
}
