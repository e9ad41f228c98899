//! Engraved lines: one scratch each, on the surface.

use crate::common::{object, scene_with, temporary_dir};
use glam::{DVec3, Vec3};
use hairline_document::description::Description;
use hairline_document::{Arrays, Loader};
use hairline_scene::{Object, Scene, Scratch, Segment};

const PLANE: &str = "{ plane = { size_m = [0.2, 0.2] } }";
const SPHERE: &str = "{ sphere = { radius_m = 0.05 } }";
const BOX: &str = "{ box = { size_m = [0.1, 0.1, 0.1] } }";

/// A square of 20 units about a circle, and a line that is drawn by a transform; a text, which is no shape.
const MARK: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40">
<rect x="10" y="10" width="20" height="20" fill="none" stroke="black"/>
<circle cx="20" cy="20" r="5"/>
<g transform="translate(10 12)"><path d="M 0 0 H 20" stroke="red"/></g>
<text x="1" y="1">a</text>
</svg>"#;

/// An object with an engraved layer, loaded from what is written of what was read.
fn engraved(shape: &str, keys: &str) -> Object {
    loaded(shape, keys).objects.remove(0)
}

fn loaded(shape: &str, keys: &str) -> Scene {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("mark.svg"), MARK).unwrap();
    let path = dir.path().join("scene.toml");
    let text = scene_with(&format!(
        "{}[[scratches]]\nobject = \"it\"\nwidth_um = 8.0\ndepth_nm = 300.0\n{keys}",
        object(shape)
    ));
    let read = Description::from_toml(&text, &path).unwrap_or_else(|e| panic!("{e}"));
    let written = read.to_toml().unwrap();
    assert_eq!(Description::from_toml(&written, &path).unwrap(), read);
    let scene = hairline_document::from_toml(&written, "scene.toml", dir.path());
    scene.unwrap_or_else(|e| panic!("{e}"))
}

fn pieces<'o>(object: &'o Object, scratch: &Scratch) -> &'o [Segment] {
    &object.segments[scratch.segments.start as usize..scratch.segments.end as usize]
}

/// Distance of a point from the nearest end of a piece.
fn distance_m(pieces: &[Segment], point: Vec3) -> f32 {
    let ends = pieces.iter().flat_map(|it| [it.start_m, it.end_m]);
    ends.map(|end| end.distance(point)).fold(f32::MAX, f32::min)
}

#[test]
fn a_curve_is_one_scratch_that_follows_a_ball() {
    let at = |x: f64, y: f64| {
        let z = (0.05f64.powi(2) - x * x - y * y).sqrt();
        DVec3::new(x, y, z)
    };
    let points = [
        at(-0.03, 0.0),
        at(-0.01, 0.015),
        at(0.012, -0.01),
        at(0.03, 0.01),
    ];
    let listed = points.map(|p| format!("{:?}", p.to_array())).join(", ");
    let object = engraved(
        SPHERE,
        &format!("pattern = \"curve\"\npoints_m = [{listed}]"),
    );
    let [scratch] = &object.scratches[..] else {
        panic!("{} scratches", object.scratches.len());
    };
    assert_eq!(
        (scratch.profile.width_um, scratch.profile.depth_nm),
        (8.0, 300.0)
    );
    let pieces = pieces(&object, scratch);
    assert!((50..2000).contains(&pieces.len()), "{}", pieces.len());
    for point in points {
        assert!(distance_m(pieces, point.as_vec3()) < 4e-4);
    }
    for pair in pieces.windows(2) {
        assert_eq!(pair[0].end_m, pair[1].start_m);
        let [a, b] = [pair[0], pair[1]].map(|it| (it.end_m - it.start_m).normalize());
        // A facet of the ball bends by 3 degrees at most, a curve's piece by half a degree.
        assert!(a.dot(b) > 0.998, "{a} {b}");
    }
    // Facets lie below the ball by 0.04 mm at most.
    let heights = pieces.iter().map(|it| it.start_m.length());
    assert!(
        heights
            .into_iter()
            .all(|r| (0.04995..0.050001).contains(&r))
    );
}

/// Short scratches in all directions, which cover three tenths of the line if none crosses another, and none leaves it.
#[test]
fn a_wide_line_is_filled() {
    let keys = "pattern = \"curve\"\npoints_m = [[-0.05, 0, 0], [0.05, 0, 0]]\nline_m = 0.001";
    let object = engraved(PLANE, keys);
    let (mut area_m2, mut twice) = (0.0, glam::DVec2::ZERO);
    for scratch in object.scratches.iter() {
        let pieces = pieces(&object, scratch);
        let [start, end] = [pieces[0].start_m, pieces[pieces.len() - 1].end_m];
        for point in [start, end] {
            assert!(
                point.y.abs() < 0.501e-3 && point.x.abs() < 0.0503,
                "{point}"
            );
        }
        let span = (end - start).as_dvec3().truncate();
        area_m2 += 8e-6 * span.length();
        let unit = span.normalize();
        twice += glam::DVec2::new(unit.x * unit.x - unit.y * unit.y, 2.0 * unit.x * unit.y);
    }
    let count = object.scratches.len() as f64;
    assert!(
        (area_m2 / (0.3 * 0.1 * 0.001) - 1.0).abs() < 0.01,
        "{area_m2}"
    );
    assert!(twice.length() / count < 0.03, "{twice}");
}

#[test]
fn a_wide_line_lies_on_a_ball() {
    let keys = "pattern = \"text\"\ntext = \"8\"\nheight_m = 0.02\ncenter_m = [0, 0, 0.05]\nline_m = 0.001";
    let object = engraved(SPHERE, keys);
    assert!(object.scratches.len() > 1000);
    for segment in object.segments.iter() {
        for point in [segment.start_m, segment.end_m] {
            assert!((point.length() - 0.05).abs() < 1e-4, "{point}");
        }
    }
}

#[test]
fn a_straight_line_is_a_piece_for_each_triangle() {
    let object = engraved(
        PLANE,
        "pattern = \"curve\"\npoints_m = [[-0.05, 0.01, 0], [0.05, 0.01, 0]]",
    );
    assert_eq!(object.scratches.len(), 1);
    assert_eq!(object.segments.len(), 2);
}

#[test]
fn a_closed_curve_is_a_ring() {
    let object = engraved(
        PLANE,
        "pattern = \"curve\"\nclosed = true\npoints_m = [[0.03, 0, 0], [0, 0.03, 0], [-0.03, 0, 0], [0, -0.03, 0]]",
    );
    let [scratch] = &object.scratches[..] else {
        panic!("{} scratches", object.scratches.len());
    };
    assert!(scratch.closed);
    let pieces = pieces(&object, scratch);
    assert_eq!(pieces[0].start_m, pieces[pieces.len() - 1].end_m);
    for piece in pieces {
        assert!((piece.start_m.length() - 0.03).abs() < 1e-3);
    }
}

#[test]
fn a_curve_goes_on_behind_a_sharp_edge_and_ends_at_a_rim() {
    let object = engraved(
        BOX,
        "pattern = \"curve\"\npoints_m = [[0.02, 0, 0.05], [0.04, 0.005, 0.05], [0.05, 0.01, 0.04], [0.05, 0.01, 0.02]]",
    );
    let [top, side] = &object.scratches[..] else {
        panic!("{} scratches", object.scratches.len());
    };
    let [top, side] = [top, side].map(|it| pieces(&object, it));
    assert!(top.iter().all(|it| it.end_m.z == 0.05));
    assert!(side.iter().all(|it| it.start_m.x == 0.05));
    let gap_m = top[top.len() - 1].end_m.distance(side[0].start_m);
    assert!(gap_m < 2e-4, "{gap_m}");

    let object = engraved(
        PLANE,
        "pattern = \"curve\"\npoints_m = [[0.0, 0.0, 0], [0.15, 0.03, 0]]",
    );
    let last = object.segments[object.segments.len() - 1].end_m;
    assert!(last.distance(Vec3::new(0.1, 0.02, 0.0)) < 1e-3, "{last}");
}

#[test]
fn a_drawing_is_a_scratch_for_each_outline() {
    let keys = "pattern = \"svg\"\nfile = \"mark.svg\"\nfit_m = 0.04\ncenter_m = [0.03, 0, 0]\ndirection = [0, 1, 0]";
    let object = engraved(PLANE, keys);
    let closed: Vec<bool> = object.scratches.iter().map(|it| it.closed).collect();
    assert_eq!(closed, [true, true, false]);
    let at = |it: &Segment| it.start_m - Vec3::new(0.03, 0.0, 0.0);
    let [square, circle, line] = [0, 1, 2].map(|i| pieces(&object, &object.scratches[i]));
    assert!(
        square
            .iter()
            .all(|it| (at(it).abs().max_element() - 0.02).abs() < 1e-6)
    );
    // The arcs of a circle in SVG are cubic curves, within 0.03 %.
    assert!(
        circle
            .iter()
            .all(|it| (at(it).length() - 0.01).abs() < 5e-6)
    );
    // Two units below the upper side, which is to the left of the way to the right.
    assert!(line.iter().all(|it| (at(it).x + 0.016).abs() < 1e-6));
}

#[test]
fn letters_stand_upright_along_their_line() {
    let keys = "pattern = \"text\"\ntext = \"No. 1\"\nheight_m = 0.01";
    let object = engraved(PLANE, keys);
    // N, two of o, the dot, 1.
    assert_eq!(object.scratches.len(), 5);
    assert!(object.scratches.iter().all(|it| it.closed));
    let n = pieces(&object, &object.scratches[0]);
    let [low, high] =
        [f32::min, f32::max].map(|pick| n.iter().map(|it| it.start_m.y).reduce(pick).unwrap());
    assert!(
        (low + 0.005).abs() < 1e-6 && (high - 0.005).abs() < 1e-6,
        "{low} {high}"
    );
    let middle = |i: usize| {
        let it = pieces(&object, &object.scratches[i]);
        it.iter().map(|it| it.start_m.x).sum::<f32>() / it.len() as f32
    };
    assert!(middle(0) < middle(1) && middle(3) < middle(4));
}

#[test]
fn a_line_of_text_goes_around_a_cylinder() {
    let keys = "pattern = \"text\"\ntext = \"AAAAAAAAAAAAAAAAAAAA\"\nheight_m = 0.01\ncenter_m = [0.03, 0, 0]\ndirection = [0, 1, 0]";
    let object = engraved("{ cylinder = { radius_m = 0.03, height_m = 0.1 } }", keys);
    let is_behind = |it: &Segment| it.start_m.x < -0.01;
    assert!(object.segments.iter().any(is_behind));
    for it in &object.segments[..] {
        let radius_m = it.start_m.truncate().length();
        assert!((radius_m - 0.03).abs() < 5e-5, "{radius_m}");
        assert!(it.start_m.z.abs() < 0.00501);
    }
}

/// The places far below the plane of the drawing are straight below it, not along the edges of facets.
#[test]
fn a_large_drawing_on_a_ball_is_whole() {
    let keys = "pattern = \"svg\"\nfile = \"mark.svg\"\nfit_m = 0.05\ncenter_m = [0, -0.05, 0]\ndirection = [1, 0, 0]";
    let object = engraved(SPHERE, keys);
    let closed: Vec<bool> = object.scratches.iter().map(|it| it.closed).collect();
    assert_eq!(closed, [true, true, false]);
    for it in pieces(&object, &object.scratches[1]) {
        let radius_m = it.start_m.x.hypot(it.start_m.z);
        assert!((radius_m - 0.0125).abs() < 1e-5, "{radius_m}");
        assert!(it.start_m.y < 0.0);
    }
}

#[test]
fn what_is_not_laid_is_told() {
    for (keys, note) in [
        (
            "pattern = \"curve\"\npoints_m = [[0.12, 0, 0], [0.13, 0.01, 0]]",
            Some(
                "scratches[0]: the curve lays no scratch: it lies off the object, or its points are one place",
            ),
        ),
        (
            "pattern = \"curve\"\npoints_m = [[0.01, 0, 0], [0.01, 0, 0]]",
            Some(
                "scratches[0]: the curve lays no scratch: it lies off the object, or its points are one place",
            ),
        ),
        (
            "pattern = \"text\"\ntext = \"No. 1\"\nheight_m = 0.05\ncenter_m = [0.09, 0, 0]",
            Some("scratches[0]: 2 of 5 outlines lie off the object"),
        ),
        (
            "pattern = \"text\"\ntext = \"No. 1\"\nheight_m = 0.01",
            None,
        ),
    ] {
        let notes = loaded(PLANE, keys).notes;
        assert_eq!(notes.first().map(String::as_str), note, "{keys}");
    }
}

/// What a program holds in the place of a file is engraved as the file is.
#[test]
fn drawings_in_memory_are_engraved() {
    let keys = "pattern = \"svg\"\nfile = \"mark.svg\"\nfit_m = 0.04";
    let layer = format!("[[scratches]]\nobject = \"it\"\n{keys}\n");
    let text = scene_with(&(object(PLANE) + &layer));
    let mut arrays = Arrays::default();
    arrays.insert_drawing("mark.svg", MARK.as_bytes());
    let loader = Loader {
        arrays: &arrays,
        ..Loader::default()
    };
    let dir = temporary_dir();
    let held = loader.from_toml(&text, "scene.toml", dir.path()).unwrap();
    assert_eq!(held.objects[0].segments, engraved(PLANE, keys).segments);
}
