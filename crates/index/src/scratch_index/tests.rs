use super::*;
use glam::Vec3;
use hairline_document::description::{Description, Layer};
use hairline_document::{Loader, SceneBuilder};
use hairline_fixtures::{BALL, DISK, SceneFile};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

/// Two objects. On the first a large layer and two small ones, which share a tree; on the second another small one.
fn description() -> Description {
    let file = SceneFile::seen_from([0.0, -0.3, 0.3])
        .mirror("m")
        .object("a", "m", DISK)
        .object("b", "m", BALL);
    let layer = |file: SceneFile, object: &str, count: u32, seed: u32, width_um: f64| {
        file.random(object, count).with_lines(&format!(
            "seed = {seed}\nlength_m = {{ mean = 0.01, spread = 0.5 }}\nwidth_um = {{ mean = {width_um}, spread = 0.3 }}\n\
             depth_nm = 200.0\ncurvature_per_m = {{ mean = 0.0, spread = 4.0 }}"
        ))
    };
    let file = layer(file, "a", 20_000, 1, 2.0);
    let small = [("b", 2), ("a", 3), ("a", 4)];
    small
        .into_iter()
        .fold(file, |file, (object, seed)| {
            layer(file, object, 300, seed, 3.0)
        })
        .description()
}

fn built(builder: &mut SceneBuilder, description: &Description) -> Scene {
    let scene = builder.build(&Loader::default(), description, Path::new("."));
    scene.unwrap_or_else(|error| panic!("{error}"))
}

fn with_width(mut description: Description, layer: usize, width_um: f64) -> Description {
    if let Layer::Laid(laid) = &mut description.scratches[layer].layer {
        laid.width_um.mean = width_um;
    }
    description
}

/// Number of trees that are grown anew.
fn grown(scene: &Scene, last: (&Scene, &ScratchIndex)) -> usize {
    let shapes = GrooveShapes::new(scene);
    let sources = sources(scene, &shapes, &last.1.deviations, Some(last));
    let sources = sources.iter().flatten();
    sources
        .filter(|source| matches!(source, TreeSource::New { .. }))
        .count()
}

fn assert_same(a: &ScratchIndex, b: &ScratchIndex) {
    assert_eq!(a.tree.nodes, b.tree.nodes);
    assert_eq!(a.tree.segments, b.tree.segments);
    assert_eq!(a.tree.objects, b.tree.objects);
    assert_eq!(a.depth_coherence, b.depth_coherence);
}

#[test]
fn only_the_layer_that_changed_is_grown_and_all_is_as_if_built_anew() {
    let mut builder = SceneBuilder::new();
    let mut scene = built(&mut builder, &description());
    let mut index = ScratchIndex::laid(&scene);
    assert_eq!(grown(&scene, (&scene, &index)), 0);

    let mut hidden = description();
    hidden.scratches[0].hidden = true;
    let mut shorter = description();
    if let Layer::Laid(laid) = &mut shorter.scratches[2].layer {
        laid.length_m.mean = 0.004;
    }
    let mut turned = description();
    turned.scratches.rotate_left(1);
    let mut fewer = description();
    fewer.objects.remove(0);
    fewer.scratches.retain(|layer| layer.object == "b");
    for (description, expected) in [
        (with_width(description(), 2, 4.0), 1),
        (with_width(description(), 0, 4.0), 2),
        (description(), 1),
        (shorter, 1),
        // A layer that lay further back moves to the front.
        (hidden, 1),
        (description(), 1),
        (turned, 0),
        (fewer, 0),
        (description(), 2),
    ] {
        let next = built(&mut builder, &description);
        assert_eq!(grown(&next, (&scene, &index)), expected);
        let rebuilt = ScratchIndex::rebuild(
            &next,
            Pieces::Laid,
            Some((&scene, &index)),
            &Watch::default(),
        );
        index = rebuilt.unwrap();
        assert_same(&index, &ScratchIndex::laid(&next));
        scene = next;
    }
}

#[test]
fn what_pieces_depend_on_is_seen_to_change() {
    let scene = built(&mut SceneBuilder::new(), &description());
    let index = ScratchIndex::laid(&scene);
    type Change = fn(&mut Scene);
    let changes: [(Change, usize); 5] = [
        // The ends of all move with it.
        (|scene| scene.materials[0].coherence_um *= 2.0, 3),
        (|scene| scene.materials[0].roughness += 0.1, 0),
        (
            |scene| {
                Arc::make_mut(&mut scene.objects[0].scratches)[0]
                    .profile
                    .depth_nm += 1.0
            },
            1,
        ),
        (
            |scene| Arc::make_mut(&mut scene.objects[1].scratches)[7].closed ^= true,
            1,
        ),
        (
            |scene| {
                Arc::make_mut(&mut scene.objects[1].segments)[7].start_m.x += 1e-6;
            },
            1,
        ),
    ];
    for (i, (change, expected)) in changes.into_iter().enumerate() {
        let mut changed = scene.clone();
        change(&mut changed);
        assert_eq!(grown(&changed, (&scene, &index)), expected, "{i}");
    }
}

#[test]
fn a_walk_goes_through_all_trees_of_its_object_and_no_other() {
    let scene = built(&mut SceneBuilder::new(), &description());
    let index = ScratchIndex::laid(&scene);
    for object in 0..2 {
        let all: Vec<IndexedSegment> = effective_segments(&scene, &scene.objects[object]).to_vec();
        for i in 0..50 {
            let reach = Vec3::splat(1e-4 * (1 + i) as f32);
            let middle = all[i * 37 % all.len()].start_m;
            let mut found = Vec::new();
            index.tree.gather(object, middle, reach, |i| {
                found.push(index.tree.segments[i])
            });
            let (lower, upper) = (middle - reach, middle + reach);
            let is_near = |s: &&IndexedSegment| {
                let (low, high) = (s.start_m.min(s.end_m), s.start_m.max(s.end_m));
                low.cmple(upper).all() && high.cmpge(lower).all()
            };
            let near: Vec<_> = all.iter().filter(is_near).collect();
            assert!(near.iter().all(|s| found.contains(s)));
            assert!(found.iter().all(|s| all.contains(s)));
            assert!(found.len() < all.len() / 2);
        }
    }
}

#[test]
fn the_work_is_told_and_can_be_given_up() {
    let scene = built(&mut SceneBuilder::new(), &description());
    let told = Mutex::new(Vec::new());
    let asked = AtomicUsize::new(0);
    let run = |patience: usize| {
        told.lock().unwrap().clear();
        asked.store(0, Ordering::Relaxed);
        let watch = Watch {
            progress: &|share| told.lock().unwrap().push(share),
            cancelled: &|| asked.fetch_add(1, Ordering::Relaxed) >= patience,
        };
        ScratchIndex::rebuild(&scene, Pieces::Laid, None, &watch)
    };
    assert!(run(usize::MAX).is_some());
    let told = told.lock().unwrap().clone();
    let is_share = |share: &f64| (0.0..=1.0).contains(share);
    assert!(told.iter().all(is_share), "{told:?}");
    assert_eq!(told.iter().copied().fold(0.0, f64::max), 1.0);
    let count = asked.load(Ordering::Relaxed);
    assert!(count > 5, "{count}");
    for patience in 0..count {
        assert!(run(patience).is_none(), "{patience}");
    }
}

/// The segments of an object stand side by side, in the order of the objects.
#[test]
fn the_range_of_an_object_holds_its_segments() {
    let scene = built(&mut SceneBuilder::new(), &description());
    let index = ScratchIndex::laid(&scene);
    let mut end = 0;
    for object in 0..2 {
        let range = index.segment_range(object);
        assert_eq!(range.start, end);
        end = range.end;
        let all = effective_segments(&scene, &scene.objects[object]);
        assert_eq!(range.len(), all.len());
        let own = &index.tree.segments[range.start as usize..range.end as usize];
        assert!(own.iter().step_by(97).all(|s| all.contains(s)));
    }
    assert_eq!(end as usize, index.tree.segments.len());
    let coherence_um = scene.materials[0].coherence_um as f32;
    assert_eq!(index.coherence_max_um(), [coherence_um; 2]);
}

/// Scratches that are cut at the edges of triangles in one plane are whole again, up to the length of a piece; where the surface
/// bends nothing is joined across an edge.
#[test]
fn straight_pieces_are_one_and_bent_ones_are_not() {
    let of = |shape: &str| {
        SceneFile::seen_from([0.0, -0.3, 0.3])
            .mirror("m")
            .object("a", "m", shape)
            .random("a", 500)
            .with_lines("seed = 1\nlength_m = 0.01\nwidth_um = 3.0\ndepth_nm = 200.0")
            .scene()
    };
    // Rings of 1 mm: a scratch of 10 mm is cut a dozen times.
    let rings: Vec<String> = (0..=40)
        .map(|i| format!("[{}, 0.0]", f64::from(i) * 1e-3))
        .collect();
    let flat = of(&format!("lathe = {{ profile_m = [{}] }}", rings.join(", ")));
    let pieces = effective_segments(&flat, &flat.objects[0]);
    assert!(
        flat.objects[0].segments.len() > 4000,
        "{}",
        flat.objects[0].segments.len()
    );
    // 4 mm at most: three of them make 10 mm, or four with what is left at cuts.
    assert!(pieces.len() < 2000, "{}", pieces.len());
    assert!(
        pieces
            .iter()
            .all(|s| s.start_m.distance(s.end_m) <= 4.001e-3)
    );
    assert_length(&pieces, &flat.objects[0]);

    // Two triangles of a sphere's grid make a flat cell, and no two cells lie in one plane: put together across their edge, pieces
    // of 0.25 mm that turn by 0.25/30 would be shorter by 9e-6.
    let bent = of("sphere = { radius_m = 0.03 }");
    let pieces = effective_segments(&bent, &bent.objects[0]);
    assert!(pieces.len() < bent.objects[0].segments.len());
    assert_length(&pieces, &bent.objects[0]);
}

/// The pieces are as long as all segments of 500 scratches together: ends move inwards by 20 um over the root of pi each.
fn assert_length(pieces: &[IndexedSegment], object: &Object) {
    let length = |ends: [glam::Vec3; 2]| ends[0].as_dvec3().distance(ends[1].as_dvec3());
    let all: f64 = pieces.iter().map(|s| length([s.start_m, s.end_m])).sum();
    let whole = object.segments.iter();
    let whole: f64 = whole.map(|s| length([s.start_m, s.end_m])).sum();
    let ends = 500.0 * 2.0 * 20e-6 / std::f64::consts::PI.sqrt();
    assert!(
        (all - whole + ends).abs() < 1e-6 * whole,
        "{all} {whole} {ends}"
    );
}
