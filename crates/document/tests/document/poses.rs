//! glTF files whose meshes are placed many times, or moved: by nodes, joints and morph targets. The files are made here.

use crate::common::{Glb, cube, scene_with, temporary_dir};
use glam::{Vec3, vec3};
use hairline_scene::{Mesh, Scene};
use std::sync::Arc;

pub fn mesh(bytes: &[u8], keys: &str) -> Arc<Mesh> {
    load(bytes, keys).unwrap().objects[0].mesh.clone()
}

pub fn load(bytes: &[u8], keys: &str) -> Result<Scene, String> {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("it.glb"), bytes).unwrap();
    let text = scene_with(&format!(
        "[[object]]\nname = \"it\"\nmesh = \"it.glb\"\nup = \"z\"\n{keys}"
    ));
    hairline_document::from_toml(&text, "test.toml", dir.path()).map_err(|error| error.to_string())
}

pub fn cube_mesh(glb: &mut Glb, more: &str) -> String {
    let (corners, triangles) = cube();
    let positions = glb.floats(&corners);
    let indices = glb.indices(&triangles);
    format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}{more}}}]}}"#
    )
}

/// A cube's middle.
fn middle(mesh: &Mesh) -> Vec3 {
    let (least, most) = mesh.bounds_m();
    0.5 * (least + most)
}

/// Section 3.5: a node that an animation moves has no matrix.
#[test]
fn an_animation_of_a_node_with_a_matrix_is_refused() {
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let times = glb.floats(&[[1.0], [3.0]]);
    let places = glb.floats(&[[0.0, 0.0, 0.0], [4.0, 0.0, 2.0]]);
    glb.more = format!(
        r#","animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],
          "samplers":[{{"input":{times},"output":{places}}}]}}]"#
    );
    let bytes = glb.bytes(
        &mesh_text,
        r#"{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,9,0,0,1]}"#,
    );
    let error = load(&bytes, "material = \"steel\"\ntime_s = 2.0").unwrap_err();
    assert!(
        error.contains("its animation moves node 0, which has a `matrix`"),
        "{error}"
    );
    // At rest nothing moves it.
    assert!(load(&bytes, "material = \"steel\"").is_ok());
}

/// Animations hide what they move by a scale of 0: there is nothing to be seen then, and what lies on it waits.
#[test]
fn what_an_animation_scales_to_nothing_is_not_seen() {
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let times = glb.floats(&[[0.0], [1.0]]);
    let sizes = glb.floats(&[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0f32]]);
    glb.more = format!(
        r#","animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"scale"}}}}],
          "samplers":[{{"input":{times},"output":{sizes}}}]}}]"#
    );
    let bytes = glb.bytes(&mesh_text, r#"{"mesh":0}"#);
    let layers = "\n[[scratches]]\nobject = \"it\"\npattern = \"random\"\ncount = 20\n\
        [[grating]]\nobject = \"it\"\npattern = \"uv\"\npitch_um = 2.0\n";
    let keys = |time_s: f64, more: &str| {
        format!(
            "material = \"steel\"\ntime_s = {time_s:?}\n{more}[[light]]\nkind = \"sun\"\ndirection = [0, 0, -1]\n[studio]\n[ground]\n"
        )
    };
    let scene = load(&bytes, &keys(0.0, layers)).unwrap();
    let it = &scene.objects[0];
    assert!(it.mesh.triangles.is_empty() && it.scratches.is_empty() && it.gratings.is_empty());
    assert_eq!(
        scene.notes,
        ["it.glb: it has no surface at 0 s, so it is not seen then"]
    );
    let layers = layers.replace("\"uv\"", "\"parallel\"");
    let scene = load(&bytes, &keys(1.0, &layers)).unwrap();
    let it = &scene.objects[0];
    assert_eq!(
        (
            it.mesh.triangles.len(),
            it.scratches.len(),
            it.gratings.len()
        ),
        (12, 20, 1)
    );
    // At rest it is a mistake.
    let flat = glb.bytes(&mesh_text, r#"{"mesh":0,"scale":[0,0,0]}"#);
    assert!(
        load(&flat, "material = \"steel\"")
            .unwrap_err()
            .contains("zero area")
    );
}

#[test]
fn nodes_move_as_the_first_animation_has_them() {
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let times = glb.floats(&[[1.0], [3.0]]);
    let places = glb.floats(&[[0.0, 0.0, 0.0], [4.0, 0.0, 2.0]]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turns = glb.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half]]);
    glb.more = format!(
        r#","animations":[{{"channels":[
            {{"sampler":0,"target":{{"node":1,"path":"translation"}}}},
            {{"sampler":1,"target":{{"node":0,"path":"rotation"}}}}],
          "samplers":[{{"input":{times},"output":{places}}},{{"input":{times},"output":{turns},"interpolation":"STEP"}}]}}]"#
    );
    let nodes = r#"{"children":[1]},{"mesh":0,"translation":[9,0,0]}"#;
    let bytes = glb.bytes(&mesh_text, nodes);
    // At rest; before the first key; between; on the last, when the parent has turned as well; after it.
    for (keys, place) in [
        ("", vec3(9.0, 0.0, 0.0)),
        ("time_s = 0.0", Vec3::ZERO),
        ("time_s = 2.0", vec3(2.0, 0.0, 1.0)),
        ("time_s = 3.0", vec3(0.0, 4.0, 2.0)),
        ("time_s = 50.0", vec3(0.0, 4.0, 2.0)),
    ] {
        let found = middle(&mesh(&bytes, keys));
        assert!(found.abs_diff_eq(place, 1e-5), "{keys}: {found}");
    }
    let error = load(&bytes, "time_s = -1").unwrap_err();
    assert!(
        error.contains("object[0].time_s: found -1; must be from 0"),
        "{error}"
    );
    // Another one, by its name or its number.
    let one = glb.more.clone();
    glb.more = glb.more.replace(
        r#""animations":["#,
        r#""animations":[{"name":"wave","channels":[],"samplers":[]},"#,
    );
    let bytes = glb.bytes(&mesh_text, nodes);
    for (animation, place) in [("wave", vec3(9.0, 0.0, 0.0)), ("1", vec3(2.0, 0.0, 1.0))] {
        let keys = format!("time_s = 2.0\nanimation = \"{animation}\"");
        let found = middle(&mesh(&bytes, &keys));
        assert!(found.abs_diff_eq(place, 1e-5), "{animation}: {found}");
    }
    let error = load(&bytes, "time_s = 2.0\nanimation = \"run\"").unwrap_err();
    assert!(
        error.contains("no animation \"run\"; its animations are wave, 1"),
        "{error}"
    );
    let error = load(&bytes, "animation = \"wave\"").unwrap_err();
    assert!(
        error.contains("object[0].animation: found no `time_s` beside it"),
        "{error}"
    );
    glb.more = one;
    // A sampler whose numbers are too few.
    glb.more = glb.more.replace(
        &format!(r#""output":{places}"#),
        &format!(r#""output":{times}"#),
    );
    let error = load(&glb.bytes(&mesh_text, nodes), "time_s = 1").unwrap_err();
    assert!(error.contains("must have 3 components"), "{error}");
}

#[test]
fn nodes_move_beside_what_pointers_move() {
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let times = glb.floats(&[[0.0], [1.0]]);
    let places = glb.floats(&[[0.0; 3], [4.0, 0.0, 0.0]]);
    let move_node = r#"{"sampler":0,"target":{"node":0,"path":"translation"}}"#;
    let pointer = r#""path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/x"}}"#;
    for target in [
        pointer.to_owned(),
        format!(r#""node":0,{pointer}"#),
        r#""path":"translation""#.to_owned(),
    ] {
        glb.more = format!(
            r#","animations":[{{"channels":[{{"sampler":0,"target":{{{target}}}}},{move_node}],
                "samplers":[{{"input":{times},"output":{places}}}]}}]"#
        );
        let bytes = glb.bytes(&mesh_text, r#"{"mesh":0}"#);
        let found = middle(&mesh(&bytes, "time_s = 0.5"));
        assert!(found.abs_diff_eq(vec3(2.0, 0.0, 0.0), 1e-5), "{found}");
    }
    // Other errors are refused where the animation is used, and only there.
    glb.more =
        format!(r#","animations":[{{"channels":[{move_node}],"samplers":[{{"input":0}}]}}]"#);
    let bytes = glb.bytes(&mesh_text, r#"{"mesh":0}"#);
    let error = load(&bytes, "time_s = 0.5").unwrap_err();
    assert!(
        error.contains("it is no valid glTF (missing field `output`"),
        "{error}"
    );
    assert!(load(&bytes, "").is_ok());
}

#[test]
fn joints_and_morph_targets_move_vertices() {
    let mut glb = Glb::default();
    // Each corner goes with the joint of its side along x, those of the upper half of z by both.
    let (corners, _) = cube();
    let shares: Vec<[f32; 4]> = corners
        .iter()
        .map(|[x, _, z]| match (*z > 0.0, *x > 0.0) {
            (true, _) => [0.5, 0.5, 0.0, 0.0],
            (_, true) => [0.0, 1.0, 0.0, 0.0],
            _ => [1.0, 0.0, 0.0, 0.0],
        })
        .collect();
    let weights = glb.floats(&shares);
    let numbers = glb.view(&[0, 1, 0, 0].repeat(corners.len()));
    let joints = glb.accessor(format!(
        r#"{{"bufferView":{numbers},"componentType":5121,"count":8,"type":"VEC4"}}"#
    ));
    let moves = glb.floats(&[[0.0, 0.0, 3.0]; 8]);
    let (positions, indices) = {
        let (corners, triangles) = cube();
        (glb.floats(&corners), glb.indices(&triangles))
    };
    let mesh_text = format!(
        r#"{{"weights":[0.5],"primitives":[{{"attributes":{{"POSITION":{positions},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}},
            "indices":{indices},"targets":[{{"POSITION":{moves}}}]}}]}}"#
    );
    let nodes = r#"{"children":[1,2,3]},{"mesh":0,"skin":0,"translation":[100,0,0]},
        {"translation":[-1,0,0]},{"translation":[1,0,0],"scale":[1,2,1]}"#;
    glb.more = r#","skins":[{"joints":[2,3]}]"#.to_owned();
    let moved = mesh(&glb.bytes(&mesh_text, nodes), "");
    // The node's own place does not matter. Morphed by half of 3 first: z from 1 to 2.
    let (least, most) = moved.bounds_m();
    assert!(least.abs_diff_eq(vec3(-1.5, -1.0, 1.0), 1e-5), "{least}");
    assert!(most.abs_diff_eq(vec3(1.5, 1.0, 2.0), 1e-5), "{most}");
    let upper = moved.positions_m.iter().filter(|p| p.z > 1.5);
    // The mean of both joints: not moved along x, one and a half as wide along y.
    assert!(
        upper
            .clone()
            .all(|p| p.abs().abs_diff_eq(vec3(0.5, 0.75, 2.0), 1e-5))
    );
    // Flat normals are those of where it stands now.
    for (triangle, normal) in moved.triangles.iter().zip(moved.normals.chunks(3)) {
        let [a, b, c] = triangle.map(|v| moved.positions_m[v as usize]);
        assert!(normal[0].dot((b - a).cross(c - a).normalize()) > 0.9999);
    }
    // The same without a skin: the morph alone, where the node is.
    glb.more = String::new();
    let nodes = r#"{"mesh":0,"translation":[100,0,0],"weights":[1]}"#;
    let morphed = mesh(&glb.bytes(&mesh_text, nodes), "");
    assert!(middle(&morphed).abs_diff_eq(vec3(100.0, 0.0, 3.0), 1e-4));
    // A joint that is nowhere, and a number that is no joint.
    glb.more = r#","skins":[{"joints":[1]}]"#.to_owned();
    let nodes = r#"{"mesh":0,"skin":0},{}"#;
    let error = load(&glb.bytes(&mesh_text, nodes), "").unwrap_err();
    assert!(
        error.contains("its skin 0 has the joint 1, which is in no scene"),
        "{error}"
    );
    let nodes = r#"{"mesh":0,"skin":0,"children":[1]},{}"#;
    let error = load(&glb.bytes(&mesh_text, nodes), "").unwrap_err();
    assert!(error.contains("refers to joint 1 of 1"), "{error}");
}

#[test]
fn joints_move_what_was_bound_to_them() {
    let mut glb = Glb::default();
    let positions = glb.floats(&[[3.0, 1.0, 0.0], [5.0, 1.0, 0.0], [3.0, 2.0, 4.0]]);
    let weights = glb.floats(&[[1.0, 0.0, 0.0, 0.0f32]; 3]);
    let numbers = glb.view(&[0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
    let joints = glb.accessor(format!(
        r#"{{"bufferView":{numbers},"componentType":5121,"count":3,"type":"VEC4"}}"#
    ));
    // Column by column: moved by (-3, -1, 0), and halved after a move by (-4, 0, 0).
    #[rustfmt::skip]
    let bytes: Vec<u8> = [
        1.0, 0.0, 0.0, 0.0,  0.0, 1.0, 0.0, 0.0,  0.0, 0.0, 1.0, 0.0,  -3.0, -1.0, 0.0, 1.0,
        0.5, 0.0, 0.0, 0.0,  0.0, 0.5, 0.0, 0.0,  0.0, 0.0, 0.5, 0.0,  -2.0, 0.0, 0.0, 1.0f32,
    ]
    .iter()
    .flat_map(|x| x.to_le_bytes())
    .collect();
    let bind = glb.view(&bytes);
    let bind = glb.accessor(format!(
        r#"{{"bufferView":{bind},"componentType":5126,"count":2,"type":"MAT4"}}"#
    ));
    glb.more = format!(r#","skins":[{{"joints":[2,3],"inverseBindMatrices":{bind}}}]"#);
    let mesh_text = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}"#
    );
    // The first joint makes twice as large, then moves by (0, 8, 0); the second moves by (1, 0, 0).
    let nodes = r#"{"children":[1,2,3]},{"mesh":0,"skin":0},{"scale":[2,2,2],"translation":[0,8,0]},{"translation":[1,0,0]}"#;
    let moved = mesh(&glb.bytes(&mesh_text, nodes), "");
    let expected = [
        vec3(0.0, 8.0, 0.0),
        vec3(1.5, 0.5, 0.0),
        vec3(0.5, 1.0, 2.0),
    ];
    assert_eq!(moved.positions_m[..], expected);
}

/// Scaled, then turned, then moved, then placed by the node; rotations of all kinds that the extension allows.
#[test]
fn instances_are_turned_and_scaled() {
    // Half of the square root of two as floats, as bytes and as pairs of bytes: about z by a quarter, about x by a quarter.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let floats = [[0.0, 0.0, half, half], [half, 0.0, 0.0, half]];
    let kinds: [(u32, Vec<u8>); 3] = [
        (
            5126,
            floats
                .iter()
                .flatten()
                .flat_map(|x| x.to_le_bytes())
                .collect(),
        ),
        // Made unit again: 90 of 127 are more than the half.
        (5120, vec![0, 0, 90, 90, 90, 0, 0, 90]),
        (
            5122,
            [0, 0, -23170, -23170, 23170, 0, 0, 23170_i16]
                .iter()
                .flat_map(|x| x.to_le_bytes())
                .collect(),
        ),
    ];
    let corners = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    for (component, bytes) in kinds {
        let mut glb = Glb::default();
        let positions = glb.floats(&corners);
        let translations = glb.floats(&[[10.0, 0.0, 0.0], [0.0, 20.0, 0.0]]);
        let scales = glb.floats(&[[2.0, 3.0, 5.0], [-1.0, 1.0, 1.0]]);
        let view = glb.view(&bytes);
        let normalized = component != 5126;
        let rotations = glb.accessor(format!(
            r#"{{"bufferView":{view},"componentType":{component},"normalized":{normalized},"count":2,"type":"VEC4"}}"#
        ));
        let node = format!(
            r#"{{"mesh":0,"scale":[1,1,0.5],"translation":[0,0,1],"extensions":{{"EXT_mesh_gpu_instancing":
                {{"attributes":{{"TRANSLATION":{translations},"ROTATION":{rotations},"SCALE":{scales}}}}}}}}}"#
        );
        let mesh_text =
            format!(r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}"#);
        let placed = mesh(&glb.bytes(&mesh_text, &node), "");
        // z to half, and up by one, after (x, y, z) became (-3y + 10, 2x, 5z), and (-x, 20 - z, y), which is mirrored.
        let first = [(10.0, 2.0, 1.0), (4.0, 0.0, 1.0), (10.0, 0.0, 8.5)];
        let second = [(-1.0, 20.0, 1.0), (0.0, 20.0, 2.0), (0.0, 17.0, 1.0)];
        let expected: Vec<Vec3> = first.into_iter().chain(second).map(Vec3::from).collect();
        assert_eq!(placed.positions_m.len(), expected.len());
        for (at, expected) in placed.positions_m.iter().zip(expected) {
            assert!(
                at.abs_diff_eq(expected, 1e-5),
                "{component}: {at}, {expected}"
            );
        }
        // A mirrored one faces outwards as before.
        for (triangle, middle) in placed.triangles.iter().zip([(10.0, 0.0), (0.0, 20.0)]) {
            let [a, b, c] = triangle.map(|v| placed.positions_m[v as usize]);
            let outwards = (b - a).cross(c - a).dot(a - vec3(middle.0, middle.1, 1.0));
            assert!(outwards > 0.0, "{component}");
        }
    }
}

#[test]
fn instances_stand_in_many_places() {
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let places = glb.floats(&[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 5.0, 0.0]]);
    let scales = glb.floats(&[[1.0; 3], [1.0; 3], [2.0, 2.0, 2.0]]);
    glb.more = r#","extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"]"#.to_owned();
    let node = |more: &str| {
        format!(
            r#"{{"mesh":0,"translation":[10,0,0],"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{places}{more}}}}}}}}}"#
        )
    };
    let bytes = glb.bytes(&mesh_text, &node(&format!(r#","SCALE":{scales}"#)));
    let all = mesh(&bytes, "");
    assert_eq!(all.triangles.len(), 36);
    let (least, most) = all.bounds_m();
    assert!(least.abs_diff_eq(vec3(9.0, -0.5, -1.0), 1e-5), "{least}");
    assert!(most.abs_diff_eq(vec3(13.5, 6.0, 1.0), 1e-5), "{most}");
    // The largest of the file is fitted with them.
    let (least, most) = mesh(&bytes, "fit_m = 1").bounds_m();
    assert!(((most - least).max_element() - 1.0).abs() < 1e-5);
    let one = glb.floats(&[[1.0; 3]]);
    let bytes = glb.bytes(&mesh_text, &node(&format!(r#","SCALE":{one}"#)));
    let error = load(&bytes, "").unwrap_err();
    assert!(
        error.contains("its node 0 has instances of unequal number"),
        "{error}"
    );
}

#[test]
fn hidden_nodes_are_not_there() {
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let hidden = r#""extensions":{"KHR_node_visibility":{"visible":false}}"#;
    let nodes = format!(
        r#"{{"mesh":0,"children":[1]}},{{"translation":[9,0,0],"children":[2],{hidden}}},{{"mesh":0}}"#
    );
    assert_eq!(mesh(&glb.bytes(&mesh_text, &nodes), "").triangles.len(), 12);
}
