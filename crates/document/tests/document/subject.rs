//! The contents of a view of all.

use glam::DVec3;
use hairline_document::Description;
use hairline_document::subject::objects;

use crate::common::scene_with;

fn scene() -> Description {
    let ball = |name: &str| {
        format!(
            "[[object]]\nname = \"{name}\"\nshape = {{ sphere = {{ radius_m = 0.05 }} }}\nmaterial = \"steel\"\n"
        )
    };
    let objects = ["pan", "lid", "table"].map(ball).concat();
    let scratches = "[[scratches]]\nobject = \"pan\"\npattern = \"random\"\ncount = 10\n";
    let text = scene_with(&(objects + scratches));
    Description::from_toml(&text, "scene.toml".as_ref()).unwrap()
}

fn box_corners(middle: [f64; 3], half: [f64; 3]) -> (DVec3, DVec3) {
    let (middle, half) = (DVec3::from(middle), DVec3::from(half));
    (middle - half, middle + half)
}

#[test]
fn the_ground_and_the_room_do_not_count() {
    let scene = scene();
    let pan = box_corners([0.0; 3], [0.1, 0.1, 0.01]);
    let lid = box_corners([0.3, 0.0, 0.0], [0.1, 0.1, 0.02]);
    let table = box_corners([0.0, 0.0, -0.02], [1.0, 1.0, 0.0]);
    assert_eq!(objects(&scene, &[pan, lid, table]), [0, 1]);
    // Around all, and around the camera.
    let room = box_corners([0.0; 3], [5.0; 3]);
    assert_eq!(objects(&scene, &[pan, lid, room]), [0, 1]);
    // A flat thing as large as the others is one of them, and what is scratched counts whatever it is.
    let leaf = box_corners([0.0, 0.3, 0.0], [0.1, 0.1, 0.0]);
    assert_eq!(objects(&scene, &[pan, lid, leaf]), [0, 1, 2]);
    assert_eq!(objects(&scene, &[table, lid, leaf]), [0, 1, 2]);
    assert_eq!(objects(&scene, &[pan]), [0]);
    assert!(objects(&scene, &[]).is_empty());
}
