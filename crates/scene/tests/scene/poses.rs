//! glTF files whose meshes are packed, placed many times, or moved: by nodes, joints and morph targets. The files are made here.

use crate::common::{Glb, cube, glb_of, scene_with, temporary_dir};
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, MeshEncoder,
    PointAttribute, PointIndex,
};
use glam::{Vec3, vec3};
use hairline_scene::{Mesh, Scene};
use meshopt_rs::index::IndexEncodingVersion;
use meshopt_rs::index::buffer::encode_index_buffer;
use meshopt_rs::vertex::VertexEncodingVersion;
use meshopt_rs::vertex::buffer::encode_vertex_buffer;
use std::sync::Arc;

fn mesh(bytes: &[u8], keys: &str) -> Arc<Mesh> {
    load(bytes, keys).unwrap().objects[0].mesh.clone()
}

fn load(bytes: &[u8], keys: &str) -> Result<Scene, String> {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("it.glb"), bytes).unwrap();
    let text = scene_with(&format!(
        "[[object]]\nname = \"it\"\nmesh = \"it.glb\"\nup = \"z\"\n{keys}"
    ));
    Scene::from_toml(&text, "test.toml", dir.path()).map_err(|error| error.to_string())
}

fn cube_mesh(glb: &mut Glb, more: &str) -> String {
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
    // What is broken otherwise is refused where it is wanted, and only there.
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
    // Where the node stands does not matter. Morphed by half of 3 first: z from 1 to 2.
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

fn volume_m3(mesh: &Mesh) -> f32 {
    let of_corners = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.positions_m[v as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    mesh.triangles.iter().map(of_corners).sum()
}

/// The corners of the cube, and its triangles as Draco takes them.
fn draco_cube() -> (Vec<[f32; 3]>, draco_core::Mesh) {
    let (corners, triangles) = cube();
    let mut packed = draco_core::Mesh::new();
    packed.set_num_points(corners.len());
    packed.set_num_faces(triangles.len() / 3);
    for (i, face) in triangles.as_chunks::<3>().0.iter().enumerate() {
        packed.set_face(FaceIndex(i as u32), face.map(|v| PointIndex(v.into())));
    }
    (corners.to_vec(), packed)
}

/// Packed by Draco, with 12 bits to each number of the attributes that are rounded.
fn encoded(packed: draco_core::Mesh, rounded: &[i32]) -> Vec<u8> {
    let mut options = EncoderOptions::new();
    for &attribute in rounded {
        options.set_attribute_int(attribute, "quantization_bits", 12);
    }
    let mut buffer = EncoderBuffer::new();
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(packed);
    encoder.encode(&options, &mut buffer).unwrap();
    buffer.data().to_vec()
}

/// The cube packed by Draco, by the encoder of the same crate: 12 bits to a coordinate.
fn packed_cube() -> Vec<u8> {
    let (corners, mut packed) = draco_cube();
    let mut positions = PointAttribute::new();
    positions.init(
        GeometryAttributeType::Position,
        3,
        DataType::Float32,
        false,
        corners.len(),
    );
    let bytes: Vec<u8> = corners
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    positions.buffer_mut().write(0, &bytes);
    packed.add_attribute(positions);
    encoded(packed, &[0])
}

/// A cube's corners, triangles and joints, each of which has all of a vertex: what Draco packs of a skinned model.
fn packed_limb() -> Vec<u8> {
    let (corners, mut packed) = draco_cube();
    let mut add = |kind, components, data_type, bytes: &[u8]| {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, components, data_type, false, corners.len());
        attribute.buffer_mut().write(0, bytes);
        packed.add_attribute(attribute);
    };
    let floats = |values: Vec<f32>| {
        values
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect::<Vec<_>>()
    };
    let positions = floats(corners.iter().flatten().copied().collect());
    let joints: Vec<u8> = corners
        .iter()
        .flat_map(|[x, ..]| [u8::from(*x > 0.0), 0, 0, 0])
        .collect();
    let shares = floats([1.0, 0.0, 0.0, 0.0].repeat(corners.len()));
    add(
        GeometryAttributeType::Position,
        3,
        DataType::Float32,
        &positions,
    );
    add(GeometryAttributeType::Generic, 4, DataType::Uint8, &joints);
    add(
        GeometryAttributeType::Generic,
        4,
        DataType::Float32,
        &shares,
    );
    encoded(packed, &[0, 2])
}

#[test]
fn packed_joints_move_vertices() {
    let file = |attributes: &str| {
        let mut glb = Glb::default();
        let view = glb.view(&packed_limb());
        let bound = r#""min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]"#;
        for accessor in [
            &format!(r#"{{"componentType":5126,"count":8,"type":"VEC3",{bound}}}"#),
            r#"{"componentType":5121,"count":8,"type":"VEC4"}"#,
            r#"{"componentType":5126,"count":8,"type":"VEC4"}"#,
            r#"{"componentType":5123,"count":36,"type":"SCALAR"}"#,
        ] {
            glb.accessor(accessor.to_owned());
        }
        let mesh_text = format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}},"indices":3,
                "extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{view},"attributes":{{{attributes}}}}}}}}}]}}"#
        );
        glb.more = r#","skins":[{"joints":[1,2]}],"extensionsUsed":["KHR_draco_mesh_compression"],
            "extensionsRequired":["KHR_draco_mesh_compression"]"#
            .to_owned();
        let nodes = r#"{"mesh":0,"skin":0,"children":[1,2]},{"translation":[-1,0,0]},{"translation":[2,0,0]}"#;
        glb.bytes(&mesh_text, nodes)
    };
    let moved = mesh(&file(r#""POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2"#), "");
    let (least, most) = moved.bounds_m();
    assert!(least.abs_diff_eq(vec3(-1.5, -0.5, -0.5), 1e-3), "{least}");
    assert!(most.abs_diff_eq(vec3(2.5, 0.5, 0.5), 1e-3), "{most}");
    let error = load(&file(r#""POSITION":0,"JOINTS_0":1,"WEIGHTS_0":7"#), "").unwrap_err();
    let found = "its WEIGHTS_0 is to be attribute 7 of what Draco packs, which is not there";
    assert!(error.contains(found), "{error}");
}

/// A file with a packed cube.
fn packed_file(packed: &[u8]) -> Vec<u8> {
    let mut glb = Glb::default();
    let view = glb.view(packed);
    let bound = r#""min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]"#;
    let positions = glb.accessor(format!(
        r#"{{"componentType":5126,"count":8,"type":"VEC3",{bound}}}"#
    ));
    let indices = glb.accessor(r#"{"componentType":5123,"count":36,"type":"SCALAR"}"#.to_owned());
    let mesh_text = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices},
            "extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{view},"attributes":{{"POSITION":0}}}}}}}}]}}"#
    );
    glb.more = r#","extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"]"#.to_owned();
    glb.bytes(&mesh_text, r#"{"mesh":0}"#)
}

#[test]
fn packed_meshes_are_unpacked() {
    let packed = packed_cube();
    let unpacked = mesh(&packed_file(&packed), "");
    assert_eq!(unpacked.triangles.len(), 12);
    let (least, most) = unpacked.bounds_m();
    assert!(least.abs_diff_eq(Vec3::splat(-0.5), 3e-4), "{least}");
    assert!(most.abs_diff_eq(Vec3::splat(0.5), 3e-4), "{most}");
    let volume = volume_m3(&unpacked);
    assert!((volume - 1.0).abs() < 2e-3, "{volume}");
    // Bytes of it changed one by one: a message or another shape, and no panic.
    for i in 0..packed.len() {
        let mut damaged = packed.clone();
        damaged[i] ^= 0x5a;
        if let Err(error) = load(&packed_file(&damaged), "") {
            assert!(error.contains("object[0]"), "{error}");
        }
    }
    let mut other = packed.clone();
    other[0] = b'X';
    let error = load(&packed_file(&other), "").unwrap_err();
    assert!(
        error.contains("its primitive 0 cannot be unpacked"),
        "{error}"
    );
}

/// The cube with positions and triangles packed by meshoptimizer's codings, by the encoder of the same crate. `damage` may change the packed bytes.
fn meshopt_file(damage: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    edited_meshopt_file(damage, |text| text)
}

/// The same with its text edited.
fn edited_meshopt_file(damage: impl Fn(&mut Vec<u8>), edit: impl Fn(String) -> String) -> Vec<u8> {
    let (corners, triangles) = cube();
    let indices: Vec<u32> = triangles.iter().map(|index| u32::from(*index)).collect();
    let mut glb = Glb::default();
    let mut at = 0;
    let mut pack = |glb: &mut Glb, mut packed: Vec<u8>, stride: usize, count: usize, mode: &str| {
        damage(&mut packed);
        let (offset, length) = (glb.bin.len(), packed.len());
        glb.bin.extend(packed);
        let bytes = stride * count;
        glb.views.push(format!(
            r#"{{"buffer":1,"byteOffset":{at},"byteLength":{bytes},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,
                "byteOffset":{offset},"byteLength":{length},"byteStride":{stride},"count":{count},"mode":"{mode}"}}}}}}"#
        ));
        at += bytes;
        glb.views.len() - 1
    };
    let mut packed = vec![0; 4096];
    let used = encode_vertex_buffer(&mut packed, &corners, VertexEncodingVersion::V0).unwrap();
    let positions = pack(&mut glb, packed[..used].into(), 12, 8, "ATTRIBUTES");
    let mut packed = vec![0; 4096];
    let used = encode_index_buffer(&mut packed, &indices, IndexEncodingVersion::V0).unwrap();
    let triangles = pack(&mut glb, packed[..used].into(), 2, 36, "TRIANGLES");
    let bound = r#""min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]"#;
    glb.accessor(format!(
        r#"{{"bufferView":{positions},"componentType":5126,"count":8,"type":"VEC3",{bound}}}"#
    ));
    glb.accessor(format!(
        r#"{{"bufferView":{triangles},"componentType":5123,"count":36,"type":"SCALAR"}}"#
    ));
    glb.more = r#","extensionsUsed":["EXT_meshopt_compression"],"extensionsRequired":["EXT_meshopt_compression"]"#.to_owned();
    let mesh_text = r#"{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}"#;
    let json = glb.json(mesh_text, r#"{"mesh":0}"#, None);
    let stand_in = format!(
        r#"}},{{"byteLength":{at},"extensions":{{"EXT_meshopt_compression":{{"fallback":true}}}}}}],"bufferViews""#
    );
    glb_of(
        &edit(json.replace(r#"}],"bufferViews""#, &stand_in)),
        &glb.bin,
    )
}

#[test]
fn views_packed_by_meshoptimizer_are_unpacked() {
    let unpacked = mesh(&meshopt_file(|_| {}), "");
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let plain = mesh(&glb.bytes(&mesh_text, r#"{"mesh":0}"#), "");
    assert_eq!(unpacked.bounds_m(), plain.bounds_m());
    assert_eq!(volume_m3(&unpacked), volume_m3(&plain));
    // By the newer name of the extension, and where a buffer without bytes does not say that it is a stand-in.
    for [from, to] in [
        ["EXT_meshopt", "KHR_meshopt"],
        [r#""fallback":true"#, r#""fallback":false"#],
    ] {
        let again = mesh(
            &edited_meshopt_file(|_| {}, |text| text.replace(from, to)),
            "",
        );
        assert_eq!(again.bounds_m(), plain.bounds_m());
    }
    let error = load(&meshopt_file(|packed| packed[0] = 0xa1), "").unwrap_err();
    assert!(error.contains("version 1 of the coding"), "{error}");
    let error = load(&meshopt_file(|packed| packed[0] = 0), "").unwrap_err();
    assert!(
        error.contains("its buffer view 0 cannot be unpacked (InvalidHeader)"),
        "{error}"
    );
    let error = load(&meshopt_file(|packed| packed.truncate(9)), "").unwrap_err();
    assert!(
        error.contains("its buffer view 0 cannot be unpacked"),
        "{error}"
    );
}

mod damaged {
    use super::{load, meshopt_file, packed_cube, packed_file};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]
        /// Bytes of a packed mesh changed, and its end cut off: a message or another shape; no panic, and no memory for what is not there.
        #[test]
        fn packed_meshes_end_in_a_message_or_a_shape(
            changed in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
            kept in 0.0..2.0f64,
        ) {
            let mut packed = packed_cube();
            for (at, byte) in changed {
                let at = at.index(packed.len());
                packed[at] = byte;
            }
            packed.truncate((kept.min(1.0) * packed.len() as f64) as usize);
            if let Err(error) = load(&packed_file(&packed), "") {
                prop_assert!(error.contains("object[0]"), "{error}");
            }
        }

        #[test]
        fn packed_views_do_too(
            changed in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
            kept in 0.0..2.0f64,
        ) {
            let damaged = meshopt_file(|packed| {
                for (at, byte) in &changed {
                    let at = at.index(packed.len());
                    packed[at] = *byte;
                }
                packed.truncate((kept.min(1.0) * packed.len() as f64) as usize);
            });
            if let Err(error) = load(&damaged, "") {
                prop_assert!(error.contains("object[0]"), "{error}");
            }
        }
    }
}
