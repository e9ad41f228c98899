//! Updates: after any edits the scene shows what a fresh one does, and no more was written than had changed.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::common::{Made, Stage, default_limits, plates};
use glam::Vec3;
use hairline_gpu::headless::test_gpu;
use hairline_gpu::{Error, GpuScene, Renderer};
use hairline_image::{Image, Picture};
use hairline_index::ScratchIndex;
use hairline_optics::metal::Metal;
use hairline_scene::{Base, Environment, LightShape, Sampling, Scene, ScratchTables, Texture};
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// A scene with one of everything that shaders are compiled for, so that no edit but the last kind compiles.
fn rich() -> Scene {
    let mut scene = plates().scene();
    scene.render.size_px = [48, 32];
    scene.environment = Some(map(0.3));
    scene.textures = Arc::new(vec![texture(90)]);
    scene.materials[1].base_color_texture = Some(0);
    scene
}

fn map(radiance: f32) -> Environment {
    let map = Picture {
        size_px: [4, 2],
        rgb: (0..8).map(|i| [radiance, 0.1 * i as f32, 0.2]).collect(),
    };
    hairline_sky::from_map(map, 0.0, 1.0, true)
}

fn texture(value: u8) -> Texture {
    Texture {
        size_px: [2, 2],
        levels: vec![
            vec![
                [value, 200, 30, 255],
                [10, value, 30, 255],
                [50; 4],
                [value; 4],
            ],
            vec![[value; 4]],
        ],
        srgb: true,
        sampling: Sampling::default(),
    }
}

fn shift(object: &mut hairline_scene::Object, by_m: Vec3) {
    for position in &mut Arc::make_mut(&mut object.mesh).positions_m {
        *position += by_m;
    }
    if !object.segments.is_empty() {
        for segment in Arc::make_mut(&mut object.segments) {
            segment.start_m += by_m;
            segment.end_m += by_m;
        }
    }
}

fn written(uploaded: &GpuScene) -> BTreeMap<&'static str, u64> {
    uploaded
        .written()
        .iter()
        .map(|w| (w.what, w.bytes))
        .collect()
}

const EDITS: u32 = 12;

/// One of the kinds of edits, by the means that an editor has.
fn edit(made: &mut Made, kind: u32, random: &mut impl Rng) {
    let scene = &mut made.scene;
    let by = random.random_range(-0.02_f32..0.02);
    let mut trees_change = false;
    match kind {
        0 => {
            if let LightShape::Sphere { center_m, .. } = &mut scene.lights[0].shape {
                center_m.x += f64::from(by);
            }
        }
        1 => {
            if let LightShape::Polygon { vertices_m, .. } = &mut scene.lights[1].shape {
                vertices_m[2].z += f64::from(by);
            }
        }
        2 => scene.materials[0].roughness = random.random_range(0.1..0.5),
        3 => {
            let metals = [Metal::Gold, Metal::Copper, Metal::Aluminium];
            let metal = metals[random.random_range(0..metals.len())];
            scene.materials[0].base = Base::Metal(metal.into());
        }
        4 => scene.textures = Arc::new(vec![texture(random.random_range(0..200))]),
        5 => scene.environment = Some(map(random.random_range(0.0..1.0))),
        6 => {
            let last = scene.environment.take().unwrap();
            scene.environment = Some(last.with_up(glam::DVec3::Z, f64::from(by)));
        }
        7 => {
            let object = random.random_range(0..scene.objects.len());
            shift(&mut scene.objects[object], Vec3::new(by, -0.5 * by, 0.0));
            trees_change = true;
        }
        8 => {
            // Thinner.
            for scratch in Arc::make_mut(&mut scene.objects[0].scratches) {
                scratch.profile.width_um *= 0.9;
            }
            trees_change = true;
        }
        9 => {
            let mut copy = scene.objects[1].clone();
            shift(&mut copy, Vec3::new(0.26, 10.0 * by, 0.02));
            scene.objects.insert(1, copy);
            trees_change = true;
        }
        10 if scene.objects.len() > 2 => {
            scene.objects.remove(1);
            trees_change = true;
        }
        _ => {
            // Beyond four lights the shaders are others.
            let light = scene.lights[1].clone();
            if scene.lights.len() < 5 {
                scene.lights.push(light);
            } else {
                scene.lights.truncate(2);
            }
        }
    }
    if trees_change {
        made.index = Arc::new(ScratchIndex::build(&made.scene));
    }
    if [2, 3].contains(&kind) {
        made.tables = Arc::new(ScratchTables::new(&made.scene));
    }
}

fn image(stage: &mut Stage) -> Image {
    let picture = stage.made.render(&mut stage.renderer, &stage.uploaded);
    stage.gpu.block_on(picture).unwrap()
}

fn fresh(stage: &mut Stage) -> Image {
    let renderer: &mut Renderer = &mut stage.renderer;
    let uploaded = stage.gpu.block_on(stage.made.upload(renderer)).unwrap();
    let picture = stage.made.render(renderer, &uploaded);
    stage.gpu.block_on(picture).unwrap()
}

fn update(stage: &mut Stage) -> Result<(), Error> {
    let Stage {
        gpu,
        renderer,
        made,
        uploaded,
    } = stage;
    gpu.block_on(made.update(renderer, uploaded))
}

#[test]
fn after_any_edits_the_picture_is_a_fresh_ones() {
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, rich());
    let mut random = Pcg32::seed_from_u64(5);
    for round in 0..18 {
        // Each kind once, then by chance, one to three at a time.
        let kinds: Vec<u32> = if round < EDITS {
            vec![round]
        } else {
            let count = random.random_range(1..4);
            (0..count).map(|_| random.random_range(0..EDITS)).collect()
        };
        let stale = (round < EDITS).then(|| image(&mut stage));
        for kind in &kinds {
            edit(&mut stage.made, *kind, &mut random);
        }
        update(&mut stage).unwrap();
        let (found, expected) = (image(&mut stage), fresh(&mut stage));
        assert!(found == expected, "{kinds:?}");
        // The comparison would have seen an edit that was not uploaded.
        assert!(
            stale.is_none_or(|stale| stale != expected || round == 10),
            "edit {round} shows nothing"
        );
    }
}

#[test]
fn only_what_changed_is_written() {
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, rich());
    let mut random = Pcg32::seed_from_u64(6);
    let all = written(&stage.uploaded);
    let segments = stage.made.index.tree.segments.len() as u64;
    assert_eq!(all["scratch segments"], 32 * segments);
    assert!(all.len() > 10, "{all:?}");
    let triangles =
        |scene: &Scene, object: usize| 192 * scene.objects[object].mesh.triangles.len() as u64;
    let tree = [("scratch segments", all["scratch segments"])];
    let plate = ("triangles", triangles(&stage.made.scene, 0));
    let with_tree = |rest: &[(&'static str, u64)]| {
        let all = rest.iter().chain(&tree);
        all.copied().collect::<BTreeMap<_, _>>()
    };
    let expected = [
        // Two of 80 bytes, and the four corners of one of them of 16.
        (0, BTreeMap::from([("lights", 224)])),
        (1, BTreeMap::from([("lights", 224)])),
        (2, BTreeMap::from([("materials", all["materials"])])),
        (4, BTreeMap::from([("textures", 20)])),
        (6, BTreeMap::new()),
        (8, with_tree(&[])),
    ];
    for (kind, expected) in expected {
        edit(&mut stage.made, kind, &mut random);
        update(&mut stage).unwrap();
        assert_eq!(written(&stage.uploaded), expected, "edit {kind}");
        update(&mut stage).unwrap();
        assert_eq!(written(&stage.uploaded), BTreeMap::new());
    }
    // The smaller of two objects moves within the larger one's bounds.
    shift(&mut stage.made.scene.objects[0], Vec3::new(0.01, 0.0, 0.0));
    stage.made.index = Arc::new(ScratchIndex::build(&stage.made.scene));
    update(&mut stage).unwrap();
    let found = written(&stage.uploaded);
    assert_eq!(found["triangles"], plate.1);
    // Pieces are straight to rounding, and so it may be others that go straight on: then objects have other nodes.
    let names = found.keys().copied().filter(|name| *name != "objects");
    let names: Vec<_> = names.collect();
    assert_eq!(names, ["scratch segments", "triangles"]);
}

#[test]
fn the_tree_that_rays_walk_stays_where_surfaces_do() {
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, rich());
    let mut random = Pcg32::seed_from_u64(7);
    let writes_tree = |stage: &mut Stage| {
        let scene = &stage.made.scene;
        let added = stage.renderer.add_shadows(&mut stage.uploaded, scene, 0);
        gpu.block_on(added).unwrap();
        written(&stage.uploaded).contains_key("triangle tree")
    };
    assert!(writes_tree(&mut stage));
    for (kind, is_other) in [(0, false), (2, false), (7, true), (1, false)] {
        edit(&mut stage.made, kind, &mut random);
        update(&mut stage).unwrap();
        assert_eq!(writes_tree(&mut stage), is_other, "edit {kind}");
        let seen = image(&mut stage);
        let mut fresh = Stage::new(gpu, stage.made.scene.clone());
        writes_tree(&mut fresh);
        assert!(image(&mut fresh) == seen, "edit {kind}");
    }
}

#[test]
fn a_scene_that_does_not_fit_leaves_the_last_one() {
    let Some(gpu) = default_limits() else { return };
    let mut stage = Stage::new(&gpu, rich());
    let before = image(&mut stage);
    let kept = stage.made.clone();
    // 192 MB of triangles do not fit into 128 MiB.
    let mesh = Arc::make_mut(&mut stage.made.scene.objects[0].mesh);
    mesh.triangles = vec![[0, 1, 2]; 1_000_000];
    mesh.triangle_materials = vec![0; 1_000_000];
    let refusal = update(&mut stage).unwrap_err();
    assert!(matches!(refusal, Error::TooLarge { .. }), "{refusal}");
    stage.made = kept;
    assert!(image(&mut stage) == before);
    update(&mut stage).unwrap();
    assert_eq!(stage.uploaded.written(), []);
    assert!(image(&mut stage) == before);
}
