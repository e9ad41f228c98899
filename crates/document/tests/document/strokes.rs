//! Scratches along strokes, layers under an eraser, and layers that do not depend on their place in the list.

use std::path::Path;

use crate::common::{object, scene_with};
use glam::{DVec2, DVec3};
use hairline_document::description::*;
use hairline_scene::{Object, Scratch, Segment};

const DISK: &str = "{ disk = { radius_m = 0.08 } }";
const SPHERE: &str = "{ sphere = { radius_m = 0.05 } }";
/// A sheet of 1 mm, closed all around.
const SHEET: &str =
    "{ lathe = { profile_m = [[0.0, -0.001], [0.05, -0.001], [0.05, 0.0], [0.0, 0.0]] } }";

fn built(shape: &str, scratches: Vec<Scratches>) -> Object {
    let text = scene_with(&object(shape));
    let mut it = Description::from_toml(&text, Path::new("test.toml")).unwrap();
    it.scratches = scratches;
    // Through text, so that what is drawn is what is saved.
    let text = it.to_toml().unwrap();
    let mut scene =
        hairline_document::from_toml(&text, "test.toml", ".").unwrap_or_else(|e| panic!("{e}"));
    scene.objects.remove(0)
}

fn brushed() -> Layer {
    let fixed = |mean| Distribution { mean, spread: 0.0 };
    Layer::Brushed(Brushed {
        jitter_deg: 0.0,
        seed: 1,
        length_m: fixed(1e-3),
        width_um: fixed(2.0),
        depth_nm: fixed(100.0),
    })
}

fn scattered(count: u64, seed: u64) -> Layer {
    let Layer::Brushed(Brushed {
        length_m,
        width_um,
        depth_nm,
        ..
    }) = brushed()
    else {
        unreachable!()
    };
    Layer::Laid(Laid {
        pattern: Pattern::Random {
            curvature_per_m: Distribution {
                mean: 0.0,
                spread: 20.0,
            },
        },
        amount: Amount::Count(count),
        seed,
        length_m: Distribution {
            mean: 10.0 * length_m.mean,
            ..length_m
        },
        width_um,
        depth_nm,
    })
}

fn paint(points_m: &[[f64; 3]], radius_m: f64, density_per_m: f64) -> Stroke {
    Stroke {
        points_m: points_m.to_vec(),
        radius_m,
        brush: Brush::Paint {
            density_per_m,
            width: 1.0,
            depth: 1.0,
        },
    }
}

fn erase(points_m: &[[f64; 3]], radius_m: f64) -> Stroke {
    Stroke {
        points_m: points_m.to_vec(),
        radius_m,
        brush: Brush::Erase,
    }
}

fn layer(layer: Layer, strokes: Vec<Stroke>) -> Scratches {
    Scratches {
        strokes,
        ..Scratches::new("it", layer)
    }
}

fn segments<'o>(object: &'o Object, scratch: &Scratch) -> &'o [Segment] {
    &object.segments[scratch.segments.start as usize..scratch.segments.end as usize]
}

fn middle_m(object: &Object, scratch: &Scratch) -> DVec3 {
    let pieces = segments(object, scratch);
    (pieces[0].start_m.as_dvec3() + pieces[pieces.len() - 1].end_m.as_dvec3()) / 2.0
}

fn distance_m(p: DVec3, line: &[[f64; 3]]) -> f64 {
    let points: Vec<_> = line.iter().map(|p| DVec3::from_array(*p)).collect();
    let of_pair = |pair: &[DVec3]| {
        let step = pair[1] - pair[0];
        let share = (p - pair[0]).dot(step) / step.length_squared();
        p.distance(pair[0].lerp(pair[1], share.clamp(0.0, 1.0)))
    };
    let pairs = points.windows(2).map(of_pair);
    pairs.fold(p.distance(points[0]), f64::min)
}

const ANGLE: [[f64; 3]; 3] = [[-0.04, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.03, 0.0]];

#[test]
fn a_stroke_lays_its_scratches_along_itself() {
    let it = built(
        DISK,
        vec![layer(brushed(), vec![paint(&ANGLE, 0.004, 20_000.0)])],
    );
    // 70 mm with 20 on each.
    assert_eq!(it.scratches.len(), 1400);
    let (mut on_first, mut farthest, mut sideways) = (0, 0.0f64, 0.0);
    for scratch in it.scratches.iter() {
        let middle = middle_m(&it, scratch);
        let off = distance_m(middle, &ANGLE);
        farthest = farthest.max(off);
        sideways += off;
        let pieces = segments(&it, scratch);
        let chord = (pieces[pieces.len() - 1].end_m - pieces[0].start_m).as_dvec3();
        assert!((chord.length() - 1e-3).abs() < 1e-8, "{}", chord.length());
        // Along x or along y, by where it lies.
        let along_x = chord.x.abs() > 0.999 * chord.length();
        let along_y = chord.y.abs() > 0.999 * chord.length();
        assert!(along_x || along_y);
        on_first += usize::from(along_x);
        assert_eq!(
            (scratch.profile.width_um, scratch.profile.depth_nm),
            (2.0, 100.0)
        );
    }
    assert!(farthest < 0.004 + 1e-8, "{farthest}");
    assert_eq!(on_first, 800, "as many as its length has");
    // Uniform over the width: the mean is half the radius, less where the corner is nearer; standard error 0.03 mm.
    let mean = sideways / it.scratches.len() as f64;
    assert!((mean - 0.002).abs() < 2e-4, "{mean}");
}

#[test]
fn dabs_factors_and_jitter() {
    let wide = Stroke {
        brush: Brush::Paint {
            density_per_m: 50_000.0,
            width: 3.0,
            depth: 0.5,
        },
        ..paint(&[[0.01, 0.02, 0.0]], 0.01, 0.0)
    };
    let thin = paint(&[[-0.03, 0.0, 0.0]], 0.002, 0.0);
    let it = built(DISK, vec![layer(brushed(), vec![wide, thin])]);
    // A dab counts as a stroke of its width, and has at least one.
    assert_eq!(it.scratches.len(), 1001);
    let center = DVec3::new(0.01, 0.02, 0.0);
    let mut turns = DVec2::ZERO;
    let mut inner = 0;
    for scratch in &it.scratches[..1000] {
        assert_eq!(
            (scratch.profile.width_um, scratch.profile.depth_nm),
            (6.0, 50.0)
        );
        let off = middle_m(&it, scratch).distance(center);
        assert!(off < 0.01 + 1e-8);
        inner += usize::from(off < 0.005);
        let pieces = segments(&it, scratch);
        let chord = (pieces[pieces.len() - 1].end_m - pieces[0].start_m).as_dvec3();
        // Twice the angle: a scratch has no front.
        turns += DVec2::from_angle(2.0 * chord.y.atan2(chord.x)) / 1000.0;
    }
    // A quarter of the area: standard error 14.
    assert!((inner as f64 - 250.0).abs() < 60.0, "{inner}");
    // Each component's standard error is 0.022.
    assert!(turns.length() < 0.1, "{turns}");

    let Layer::Brushed(mut shaky) = brushed() else {
        unreachable!()
    };
    shaky.jitter_deg = 10.0;
    let line = [[-0.04, 0.0, 0.0], [0.04, 0.0, 0.0]];
    let it = built(
        DISK,
        vec![layer(
            Layer::Brushed(shaky),
            vec![paint(&line, 0.004, 25_000.0)],
        )],
    );
    let squares = it.scratches.iter().map(|scratch| {
        let pieces = segments(&it, scratch);
        let chord = (pieces[pieces.len() - 1].end_m - pieces[0].start_m).as_dvec3();
        (chord.y / chord.x).atan().to_degrees().powi(2)
    });
    let deviation = (squares.sum::<f64>() / it.scratches.len() as f64).sqrt();
    // 2000 of them: a standard error of 0.16.
    assert!((deviation - 10.0).abs() < 0.7, "{deviation}");
}

#[test]
fn a_stroke_stays_on_its_side_of_the_surface() {
    let line = [[-0.03, 0.0, 0.0], [0.03, 0.0, 0.0]];
    let it = built(
        SHEET,
        vec![layer(brushed(), vec![paint(&line, 0.004, 10_000.0)])],
    );
    assert_eq!(it.scratches.len(), 600);
    assert!(
        it.segments
            .iter()
            .all(|s| s.start_m.z == 0.0 && s.end_m.z == 0.0)
    );
    // Half of the brush hangs over the edge, and what it does there is left out.
    let edge = [[-0.03, -0.05, 0.0], [0.03, -0.05, 0.0]];
    let plane = "{ plane = { size_m = [0.1, 0.1] } }";
    let strokes = vec![paint(&edge, 0.004, 10_000.0)];
    let it = built(plane, vec![layer(brushed(), strokes)]);
    // Binomial: a standard deviation of 12.
    assert!(
        it.scratches.len().abs_diff(300) < 60,
        "{}",
        it.scratches.len()
    );
    // On a sphere chords of the stroke lie below the surface.
    let around: Vec<_> = (0..=8)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * 0.3).sin_cos();
            [0.05 * cos, 0.05 * sin, 0.0]
        })
        .collect();
    let it = built(
        SPHERE,
        vec![layer(brushed(), vec![paint(&around, 0.004, 10_000.0)])],
    );
    assert!(it.scratches.len() > 1150, "{}", it.scratches.len());
    for segment in it.segments.iter() {
        assert!((segment.start_m.length() - 0.05).abs() < 1e-4);
    }
}

#[test]
fn erasing_takes_exactly_what_is_within_the_brush() {
    for (name, shape) in [("disk", DISK), ("sphere", SPHERE)] {
        let z = if name == "disk" { 0.0 } else { 0.048 };
        let line = [[-0.02, -0.01, z], [0.0, 0.01, z], [0.02, 0.0, z]];
        let radius_m = 0.006;
        let whole = built(shape, vec![layer(scattered(3000, 1), vec![])]);
        let cut = built(
            shape,
            vec![layer(scattered(3000, 1), vec![erase(&line, radius_m)])],
        );
        // A micrometre is what single precision and left-out slivers need.
        let tolerance_m = 1e-6;
        let mut length_m = 0.0;
        for scratch in cut.scratches.iter() {
            let pieces = segments(&cut, scratch);
            for pair in pieces.windows(2) {
                assert_eq!(pair[0].end_m, pair[1].start_m, "{name}");
            }
            for piece in pieces {
                let (start, end) = (piece.start_m.as_dvec3(), piece.end_m.as_dvec3());
                length_m += start.distance(end);
                for k in 0..=8 {
                    let p = start.lerp(end, f64::from(k) / 8.0);
                    assert!(distance_m(p, &line) > radius_m - tolerance_m, "{name}");
                }
            }
        }
        // All the length outside of the eraser remains, by small steps along the whole layer.
        let mut expected_m = 0.0;
        let mut erased_m = 0.0;
        for piece in whole.segments.iter() {
            let (start, end) = (piece.start_m.as_dvec3(), piece.end_m.as_dvec3());
            const STEPS: u32 = 200;
            for k in 0..STEPS {
                let p = start.lerp(end, (f64::from(k) + 0.5) / f64::from(STEPS));
                // On the sphere the brush reaches the side that faces it alone.
                let is_far = name == "sphere" && piece.normal.z < 0.0;
                let step_m = start.distance(end) / f64::from(STEPS);
                match is_far || distance_m(p, &line) > radius_m {
                    true => expected_m += step_m,
                    false => erased_m += step_m,
                }
            }
        }
        assert!(erased_m > 0.01 * expected_m, "{name}: {erased_m}");
        let error = (length_m - expected_m).abs() / erased_m;
        assert!(error < 1e-3, "{name}: {error}");
        // Scratches that were cut in two are two.
        assert!(cut.scratches.len() != whole.scratches.len());
    }
}

#[test]
fn a_ring_that_is_cut_is_open_and_in_one_piece() {
    let Layer::Laid(mut laid) = scattered(40, 1) else {
        unreachable!()
    };
    laid.pattern = Pattern::Circular(PatternAxis::default());
    laid.length_m.mean = 10.0;
    let layer_with = |strokes| vec![layer(Layer::Laid(laid.clone()), strokes)];
    let whole = built(DISK, layer_with(vec![]));
    assert!(whole.scratches.iter().all(|scratch| scratch.closed));
    // An eraser from outside of the axis to beyond the rim cuts each ring outside of 5 mm once.
    let line = [[0.006, 0.0, 0.0], [0.1, 0.0, 0.0]];
    let cut = built(DISK, layer_with(vec![erase(&line, 0.001)]));
    assert_eq!(cut.scratches.len(), whole.scratches.len());
    let (mut open, mut untouched) = (0, 0);
    for scratch in cut.scratches.iter() {
        let pieces = segments(&cut, scratch);
        if scratch.closed {
            untouched += 1;
            continue;
        }
        open += 1;
        for pair in pieces.windows(2) {
            assert_eq!(pair[0].end_m, pair[1].start_m);
        }
        for end in [pieces[0].start_m, pieces[pieces.len() - 1].end_m] {
            let off = distance_m(end.as_dvec3(), &line) - 0.001;
            assert!(off.abs() < 1e-6, "{off}");
        }
    }
    assert!(open > 30 && untouched + open == 40, "{open} {untouched}");
}

#[test]
fn strokes_do_not_change_those_before_them() {
    let line = |y: f64| vec![[-0.03, y, 0.0], [0.03, y, 0.0]];
    let first = paint(&line(0.0), 0.004, 10_000.0);
    let second = paint(&line(0.03), 0.004, 10_000.0);
    let away = erase(&line(-0.03), 0.004);
    let across = erase(&[[0.0, -0.05, 0.0], [0.0, 0.05, 0.0]], 0.002);
    let of = |strokes: Vec<Stroke>| built(DISK, vec![layer(brushed(), strokes)]);
    let one = of(vec![first.clone()]);
    for strokes in [
        vec![first.clone(), second.clone()],
        vec![first.clone(), away.clone()],
        vec![first.clone(), away.clone(), second.clone()],
        vec![away, first.clone(), second.clone()],
        // Erasing comes before what it does not touch.
        vec![across.clone(), first.clone()],
    ] {
        let more = of(strokes);
        assert_eq!(more.scratches[..600], one.scratches[..]);
        assert_eq!(more.segments[..one.segments.len()], one.segments[..]);
    }
    // Scratches that are drawn over an erasure stay whole.
    let over = of(vec![first.clone(), across, second]);
    let crossing = |y: f64| {
        over.segments
            .iter()
            .filter(|s| {
                (f64::from(s.start_m.y) - y).abs() < 0.005
                    && s.start_m.x.min(s.end_m.x) < 0.0
                    && s.start_m.x.max(s.end_m.x) > 0.0
            })
            .count()
    };
    assert_eq!(crossing(0.0), 0);
    assert!(crossing(0.03) > 3);
    // A stroke that goes on keeps what it has.
    let longer = paint(
        &[[-0.03, 0.0, 0.0], [0.03, 0.0, 0.0], [0.04, 0.0, 0.0]],
        0.004,
        10_000.0,
    );
    let longer = of(vec![longer]);
    assert_eq!(
        longer.segments[..one.segments.len() - 1],
        one.segments[..one.segments.len() - 1]
    );
}

/// The scratches of one layer, whatever its place in the list.
fn of_layer(object: &Object, layer: u32) -> Vec<(f32, Vec<Segment>)> {
    let own = object.scratches.iter().filter(|s| s.layer == layer);
    own.map(|s| (s.profile.width_um, segments(object, s).to_vec()))
        .collect()
}

#[test]
fn layers_do_not_depend_on_their_place() {
    let of = |seed| layer(scattered(30, seed), vec![]);
    let [a, b, c] = [of(1), of(2), of(3)];
    let abc = built(DISK, vec![a.clone(), b.clone(), c.clone()]);
    let cb = built(DISK, vec![c.clone(), b.clone()]);
    assert_eq!(of_layer(&abc, 1), of_layer(&cb, 1));
    assert_eq!(of_layer(&abc, 2), of_layer(&cb, 0));
    // Layers of one seed differ, and the second stays the second when the first is hidden.
    let hidden = Scratches {
        hidden: true,
        ..a.clone()
    };
    let twice = built(DISK, vec![a.clone(), b.clone(), a.clone()]);
    assert_ne!(of_layer(&twice, 0), of_layer(&twice, 2));
    let second = built(DISK, vec![hidden.clone(), b.clone(), a.clone()]);
    assert_eq!(of_layer(&twice, 2), of_layer(&second, 2));
    assert!(of_layer(&second, 0).is_empty());
    // Solo: that one alone, unless it is hidden; then nothing.
    let alone = Scratches { solo: true, ..b };
    let it = built(DISK, vec![a.clone(), alone.clone(), c]);
    assert_eq!(of_layer(&it, 1), of_layer(&abc, 1));
    assert_eq!(it.scratches.len(), 30);
    let none = Scratches {
        hidden: true,
        ..alone
    };
    assert_eq!(built(DISK, vec![a, none]).scratches.len(), 0);
}
