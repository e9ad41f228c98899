//! The contents of a view of all.

use glam::DVec3;
use hairline_document::Description;
use hairline_editor::subject::objects;
use hairline_fixtures::{BALL, SceneFile};

fn scene() -> Description {
    let mut file = SceneFile::seen_from([0.0, -1.0, 1.0]).mirror("m");
    for name in ["pan", "lid", "table"] {
        file = file.object(name, "m", BALL);
    }
    file.random("pan", 10).description()
}

fn around(middle: [f64; 3], half: [f64; 3]) -> (DVec3, DVec3) {
    let (middle, half) = (DVec3::from(middle), DVec3::from(half));
    (middle - half, middle + half)
}

#[test]
fn the_ground_and_the_room_do_not_count() {
    let scene = scene();
    let pan = around([0.0; 3], [0.1, 0.1, 0.01]);
    let lid = around([0.3, 0.0, 0.0], [0.1, 0.1, 0.02]);
    let table = around([0.0, 0.0, -0.02], [1.0, 1.0, 0.0]);
    assert_eq!(objects(&scene, &[pan, lid, table]), [0, 1]);
    // Around all, and around the camera.
    let room = around([0.0; 3], [5.0; 3]);
    assert_eq!(objects(&scene, &[pan, lid, room]), [0, 1]);
    // A flat thing as large as the others is one of them, and what is scratched counts whatever it is.
    let leaf = around([0.0, 0.3, 0.0], [0.1, 0.1, 0.0]);
    assert_eq!(objects(&scene, &[pan, lid, leaf]), [0, 1, 2]);
    assert_eq!(objects(&scene, &[table, lid, leaf]), [0, 1, 2]);
    assert_eq!(objects(&scene, &[pan]), [0]);
    assert!(objects(&scene, &[]).is_empty());
}
