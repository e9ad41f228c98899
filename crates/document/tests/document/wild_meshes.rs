//! Scratches on meshes that nobody would make on purpose: they end, and hold only finite numbers.

use crate::common::{Glb, scene_with, temporary_dir};

/// Triangles between random points, some of them equal, some nearly in line: crossing, sharing edges by threes and more.
fn soup(seed: u32, points: u16, triangles: usize) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 8
    };
    let mut positions: Vec<[f32; 3]> = (0..points)
        .map(|_| [0; 3].map(|_| (next() % 1000) as f32 / 1000.0))
        .collect();
    for i in (3..positions.len()).step_by(5) {
        positions[i] = positions[i - 1];
        positions[i - 2] = [
            positions[i - 3][0],
            positions[i - 3][1],
            positions[i - 3][2] + 1e-5,
        ];
    }
    let indices: Vec<u16> = (0..3 * triangles)
        .map(|_| (next() % u32::from(points)) as u16)
        .collect();
    let mut glb = Glb::default();
    let positions = glb.floats(&positions);
    let indices = glb.indices(&indices);
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
    );
    glb.bytes(&mesh, r#"{"mesh":0}"#)
}

#[test]
fn any_pattern_ends_on_any_mesh() {
    let dir = temporary_dir();
    let path = dir.path().join("it.glb");
    let patterns = ["random", "parallel", "circular", "radial", "spun", "swirl"];
    for seed in 0..40 {
        std::fs::write(&path, soup(seed, 10 + 4 * seed as u16, 60)).unwrap();
        let mut text =
            scene_with("[[object]]\nname = \"it\"\nmesh = \"it.glb\"\nmaterial = \"steel\"");
        for pattern in patterns {
            text += &format!(
                "[[scratches]]\nobject = \"it\"\npattern = \"{pattern}\"\ncount = 100\nlength_m = 2.0\n"
            );
        }
        let scene = hairline_document::from_toml(&text, "test.toml", dir.path())
            .unwrap_or_else(|e| panic!("{e}"));
        let object = &scene.objects[0];
        assert!(object.scratches.len() > 300, "{seed}");
        for segment in object.segments.iter() {
            let finite = segment.start_m.is_finite() && segment.end_m.is_finite();
            assert!(finite && segment.start_m != segment.end_m, "{seed}");
            assert!((segment.normal.length() - 1.0).abs() < 1e-5, "{seed}");
        }
    }
}
