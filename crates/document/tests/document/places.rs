//! Places of an object where scratches lie, and their density: masks, densities, edges, radii.

use std::path::Path;

use crate::common::{Glb, cube, object, scene_with, temporary_dir};
use glam::{DVec2, DVec3};
use hairline_document::{Description, Error};
use hairline_scene::{Object, Segment};
use image::{GrayImage, Luma};

const PLANE: &str = "{ plane = { size_m = [0.2, 0.2] } }";
const BOX: &str = "{ box = { size_m = [0.1, 0.1, 0.1] } }";
const BALL: &str = "{ sphere = { radius_m = 0.05 } }";

/// A scene with one layer of 4000 scratches; line 15 has its `where`.
fn text(shape: &str, place: &str) -> String {
    scene_with(&format!(
        "{}[[scratches]]\nobject = \"it\"\nwhere = {{ {place} }}\npattern = \"random\"\ncount = 4000\nlength_m = 0.01\n",
        object(shape)
    ))
}

fn load(shape: &str, place: &str, dir: &Path) -> Result<Object, Error> {
    let scene = hairline_document::from_toml(&text(shape, place), "test.toml", dir);
    scene.map(|mut scene| scene.objects.remove(0))
}

/// A picture of so many texels either way.
fn picture(dir: &Path, name: &str, size_px: u32, value: impl Fn(u32, u32) -> u8) {
    let picture = GrayImage::from_fn(size_px, size_px, |x, y| Luma([value(x, y)]));
    picture.save(dir.join(name)).unwrap();
}

fn ends_m(segment: &Segment) -> [DVec3; 2] {
    [segment.start_m, segment.end_m].map(|end| end.as_dvec3())
}

fn length_m(segment: &Segment) -> f64 {
    let [start, end] = ends_m(segment);
    start.distance(end)
}

fn middle_m(segment: &Segment) -> DVec3 {
    let [start, end] = ends_m(segment);
    0.5 * (start + end)
}

/// The texture coordinates at a point of a segment's triangle, by areas.
fn uv(object: &Object, segment: &Segment, point_m: DVec3) -> DVec2 {
    let corners = object.mesh.triangles[segment.triangle as usize];
    let [a, b, c] = corners.map(|i| object.mesh.positions_m[i as usize].as_dvec3());
    let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot((b - a).cross(c - a));
    let weights = [
        area(point_m, b, c),
        area(a, point_m, c),
        area(a, b, point_m),
    ];
    let uv = |i: usize| object.mesh.uvs[corners[i] as usize].as_dvec2() * weights[i];
    (uv(0) + uv(1) + uv(2)) / weights.iter().sum::<f64>()
}

/// The length of all scratches, as far as their middles are somewhere.
fn total_m(object: &Object, is_there: impl Fn(&Segment) -> bool) -> f64 {
    let segments = object.segments.iter().filter(|segment| is_there(segment));
    segments.map(length_m).sum()
}

#[test]
fn scratches_end_where_a_mask_does() {
    let dir = temporary_dir();
    // Between the middles of its texels 31 and 32, and 0 and 63 beyond, it is half white.
    picture(
        dir.path(),
        "half.png",
        64,
        |x, _| if x < 32 { 0 } else { 255 },
    );
    let all = load(PLANE, "", dir.path()).unwrap();
    let half = load(PLANE, "mask = \"half.png\"", dir.path()).unwrap();
    for segment in half.segments.iter() {
        for end_m in ends_m(segment) {
            let u = uv(&half, segment, end_m).x;
            assert!(u > 0.5 - 1e-5, "{u}");
        }
    }
    // All the length that lay there remains: 20 m in each half, and a hundredth of a scratch for each that is
    // cut.
    let split = |segment: &Segment| {
        let [a, b] = ends_m(segment).map(|end_m| uv(&all, segment, end_m).x - 0.5);
        match (a > 0.0, b > 0.0) {
            (true, true) => 1.0,
            (false, false) => 0.0,
            _ => a.max(b) / (a.max(b) - a.min(b)),
        }
    };
    let expected: f64 = all.segments.iter().map(|s| split(s) * length_m(s)).sum();
    let found = total_m(&half, |_| true);
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
    assert!(expected > 15.0 && expected < 25.0);
}

#[test]
fn scratches_are_as_thick_as_a_picture_is_light() {
    let dir = temporary_dir();
    picture(dir.path(), "shares.png", 256, |x, _| {
        if x < 128 { 64 } else { 255 }
    });
    let all = load(PLANE, "", dir.path()).unwrap();
    let some = load(PLANE, "density = \"shares.png\"", dir.path()).unwrap();
    let count = |object: &Object, is_left: bool| {
        let middles = object.scratches.iter().map(|scratch| {
            let segments = &object.segments;
            let first = &segments[scratch.segments.start as usize];
            let last = &segments[scratch.segments.end as usize - 1];
            let middle_m = 0.5 * (first.start_m + last.end_m).as_dvec3();
            uv(object, first, middle_m).x
        });
        middles.filter(|u| (*u < 0.5) == is_left).count() as f64
    };
    // Chances of 64 in 255: 2000 draws scatter by a hundredth. Those on the border's texel may go either way.
    let share = count(&some, true) / count(&all, true);
    assert!((share - 64.0 / 255.0).abs() < 0.04, "{share}");
    assert!(count(&all, false) - count(&some, false) < 10.0);
    // The scratches are some of those without the mask.
    for segment in some.segments.iter() {
        assert!(all.segments.contains(segment));
    }
}

#[test]
fn edges_wear_first() {
    let dir = temporary_dir();
    // Distance of a middle from the nearest edge of the box.
    let off_m = |segment: &Segment| {
        let mut beside = middle_m(segment).abs().to_array();
        beside.sort_by(f64::total_cmp);
        0.05 - beside[1]
    };
    let object = |place: &str| load(BOX, place, dir.path()).unwrap();
    // Short ones do not carry what edges have far into the flat.
    let near = |object: &Object| total_m(object, |s| off_m(s) < 0.005);
    let flat = |object: &Object| total_m(object, |s| off_m(s) > 0.02);
    let (all, half, only) = (
        object(""),
        object("edges = 0.5, edge_width_m = 0.01"),
        object("edges = 1.0, edge_width_m = 0.01"),
    );
    assert_eq!(flat(&only), 0.0);
    // Half of 14 m, which 1000 scratches scatter by 3 %.
    let share = flat(&half) / flat(&all);
    assert!((share - 0.5).abs() < 0.05, "{share}");
    // Near edges most stay: (1 - d²)^1.5 is 0.87 in the mean of that half, and scratches reach over.
    let share = near(&only) / near(&all);
    assert!(share > 0.7 && share < 0.95, "{share}");
    // A ball of radius 50 mm has none; it bends by a share of 1.5 x 1 / 50 all over.
    let ball = load(BALL, "edges = 1.0, edge_width_m = 0.001", dir.path()).unwrap();
    let share = ball.scratches.len() as f64 / 4000.0;
    assert!((share - 0.03).abs() < 0.015, "{share}");
}

#[test]
fn radii_part_scratches_into_those_inside_and_those_outside() {
    let dir = temporary_dir();
    let of = |place: &str| load(PLANE, place, dir.path()).unwrap();
    let center_m = DVec3::new(0.02, 0.01, 0.0);
    let inside = of("radius_m = [0.0, 0.03], center_m = [0.02, 0.01, 0.0]");
    let outside = of("radius_m = [0.03, 10.0], center_m = [0.02, 0.01, 0.0]");
    let ring = of("radius_m = [0.03, 0.05], center_m = [0.02, 0.01, 0.0]");
    for (object, least_m, most_m) in [
        (&inside, 0.0, 0.03),
        (&outside, 0.03, 1.0),
        (&ring, 0.03, 0.05),
    ] {
        for end_m in object.segments.iter().flat_map(ends_m) {
            let radius_m = end_m.distance(center_m);
            assert!((least_m - 1e-6..=most_m + 1e-6).contains(&radius_m));
        }
    }
    let sum_m = total_m(&inside, |_| true) + total_m(&outside, |_| true);
    let all_m = total_m(&of(""), |_| true);
    assert!((sum_m / all_m - 1.0).abs() < 1e-5, "{sum_m} {all_m}");
    // In proportion to its area: pi 3² of 20² cm².
    let share = total_m(&inside, |_| true) / all_m;
    assert!((share - 0.0707).abs() < 0.01, "{share}");
}

#[test]
fn pictures_lie_on_the_three_sides_of_what_has_no_coordinates() {
    let dir = temporary_dir();
    picture(
        dir.path(),
        "half.png",
        64,
        |x, _| if x < 32 { 0 } else { 255 },
    );
    let (positions, triangles) = cube();
    let mut glb = Glb::default();
    let positions = glb.floats(&positions);
    let indices = glb.indices(&triangles);
    let meshes = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
    );
    let glb = glb.bytes(&meshes, r#"{"mesh":0}"#);
    std::fs::write(dir.path().join("cube.glb"), glb).unwrap();
    let load = |place: &str| {
        let text = text(BOX, place).replace(
            &format!("shape = {BOX}"),
            "mesh = \"cube.glb\"\nup = \"z\"\nscale = 0.1",
        );
        hairline_document::from_toml(&text, "test.toml", dir.path())
    };
    let scene = load("mask = \"half.png\", tile_m = 0.25").unwrap();
    assert!(scene.objects[0].segments.len() > 1000);
    for segment in scene.objects[0].segments.iter() {
        // In the object's frame a tile is a quarter of the cube: a dark eighth follows a light one.
        let p = middle_m(segment) / 0.1;
        let along = if segment.normal.x.abs() > 0.9 {
            p.y
        } else {
            p.x
        };
        let at = (along / 0.25).rem_euclid(1.0);
        assert!(at > 0.5 - 1e-4, "{p}");
    }
    let error = load("mask = \"half.png\"").unwrap_err().to_string();
    assert!(
        error.contains("scratches[0].where.mask: found a picture for a surface without texture coordinates; add `tile_m`"),
        "{error}"
    );
}

#[test]
fn places_hold_for_strokes_and_lists_too() {
    let dir = temporary_dir();
    let csv = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n-0.08,0,0,0.08,0,0,4,130\n";
    std::fs::write(dir.path().join("one.csv"), csv).unwrap();
    let stroke = "strokes = [{ points_m = [[-0.08, 0, 0], [0.08, 0, 0]], radius_m = 0.01, density_per_m = 1000.0 }]";
    for layer in [
        "pattern = \"file\"\nfile = \"one.csv\"".to_owned(),
        format!("pattern = \"drawn\"\n{stroke}"),
    ] {
        let text = scene_with(&format!(
            "{}[[scratches]]\nobject = \"it\"\nwhere = {{ radius_m = [0.0, 0.05] }}\n{layer}\n",
            object(PLANE)
        ));
        let scene = hairline_document::from_toml(&text, "test.toml", dir.path()).unwrap();
        let object = &scene.objects[0];
        assert!(!object.segments.is_empty());
        let farthest_m = object.segments.iter().flat_map(ends_m).map(DVec3::length);
        let farthest_m = farthest_m.fold(0.0, f64::max);
        assert!((farthest_m - 0.05).abs() < 1e-6, "{layer}: {farthest_m}");
    }
}

#[test]
fn what_is_saved_loads_again_and_what_is_wrong_is_named() {
    let dir = temporary_dir();
    picture(dir.path(), "a.png", 2, |_, _| 255);
    let all = "mask = \"a.png\", density = \"a.png\", tile_m = 0.05, edges = 0.5, edge_width_m = 0.01, radius_m = [0.0, 0.5], center_m = [0, 0, 0.1]";
    let described = Description::from_toml(&text(BOX, all), "test.toml".as_ref()).unwrap();
    let saved = described.to_toml().unwrap();
    let loaded = Description::from_toml(&saved, "test.toml".as_ref()).unwrap();
    assert_eq!(loaded.scratches, described.scratches);
    assert_eq!(described.scratches[0].place.edge_width_m, Some(0.01));
    assert!(load(BOX, all, dir.path()).is_ok());
    for (place, expected) in [
        (
            "mask = \"b.png\"",
            "test.toml:17: scratches[0].where.mask: ",
        ),
        (
            "edges = 2.0",
            "test.toml:17: scratches[0].where.edges: found 2; must be from 0 to 1",
        ),
        (
            "edge_width_m = 0.01",
            "scratches[0].where.edge_width_m: found it without what it belongs to; belongs to `edges`",
        ),
        (
            "edges = 1.0, edge_width_m = 1e-5",
            "scratches[0].where.edge_width_m: found 0.00001; must be at least 1.73e-4",
        ),
        (
            "tile_m = 0.01",
            "scratches[0].where.tile_m: found it without what it belongs to; belongs to `mask` or `density`",
        ),
        (
            "radius_m = [0.05, 0.02]",
            "scratches[0].where.radius_m: found 0.05 and 0.02; the second must be the greater one",
        ),
        (
            "center_m = [0, 0, 0]",
            "scratches[0].where.center_m: found it without what it belongs to; belongs to `radius_m`",
        ),
        (
            "edge = 0.5",
            "test.toml:17: scratches[0].where.edge: unknown key; did you mean `edges",
        ),
    ] {
        let error = load(BOX, place, dir.path()).unwrap_err().to_string();
        assert!(error.contains(expected), "{place}: {error}");
    }
}
