//! Engraved lines: one scratch each, on the surface.

use crate::common::{object, scene_with, temporary_dir};
use glam::{DVec3, Vec3};
use hairline_document::description::Description;
use hairline_scene::{Object, Scratch, Segment};

const PLANE: &str = "{ plane = { size_m = [0.2, 0.2] } }";
const SPHERE: &str = "{ sphere = { radius_m = 0.05 } }";
const BOX: &str = "{ box = { size_m = [0.1, 0.1, 0.1] } }";

/// An object with an engraved layer, loaded from what is written of what was read.
fn engraved(shape: &str, keys: &str) -> Object {
    let dir = temporary_dir();
    let path = dir.path().join("scene.toml");
    let text = scene_with(&format!(
        "{}[[scratches]]\nobject = \"it\"\nwidth_um = 8.0\ndepth_nm = 300.0\n{keys}",
        object(shape)
    ));
    let read = Description::from_toml(&text, &path).unwrap_or_else(|e| panic!("{e}"));
    let written = read.to_toml().unwrap();
    assert_eq!(Description::from_toml(&written, &path).unwrap(), read);
    let scene = hairline_document::from_toml(&written, "scene.toml", dir.path());
    scene.unwrap_or_else(|e| panic!("{e}")).objects.remove(0)
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
