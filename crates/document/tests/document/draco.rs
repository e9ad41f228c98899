//! KHR_draco_mesh_compression: unpacked meshes against packed ones, by the encoder of the same crate.

use crate::common::{Glb, cube};
use crate::poses::{load, mesh};
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, MeshEncoder,
    PointAttribute, PointIndex,
};
use glam::{Vec2, Vec3, Vec4, vec3};
use hairline_scene::Mesh;

/// An attribute: its type, the numbers of an element, and their bytes.
struct Attribute {
    kind: GeometryAttributeType,
    components: u8,
    data_type: DataType,
    bytes: Vec<u8>,
    /// Bits of each number, where it is rounded.
    bits: Option<i32>,
}

impl Attribute {
    fn floats<const N: usize>(
        kind: GeometryAttributeType,
        values: &[[f32; N]],
        bits: Option<i32>,
    ) -> Self {
        let bytes = values.as_flattened().iter().flat_map(|x| x.to_le_bytes());
        Self {
            kind,
            components: N as u8,
            data_type: DataType::Float32,
            bytes: bytes.collect(),
            bits,
        }
    }

    fn bytes(kind: GeometryAttributeType, values: &[[u8; 4]]) -> Self {
        Self {
            kind,
            components: 4,
            data_type: DataType::Uint8,
            bytes: values.as_flattened().to_vec(),
            bits: None,
        }
    }
}

/// Packed at a speed: from 0, by all predictions, to 10, by none.
fn packed(count: usize, triangles: &[u16], attributes: &[Attribute], speed: i32) -> Vec<u8> {
    let mut mesh = draco_core::Mesh::new();
    mesh.set_num_points(count);
    mesh.set_num_faces(triangles.len() / 3);
    for (i, face) in triangles.as_chunks::<3>().0.iter().enumerate() {
        mesh.set_face(FaceIndex(i as u32), face.map(|v| PointIndex(v.into())));
    }
    let mut options = EncoderOptions::new();
    options.set_compression_level(10 - speed);
    for (it, i) in attributes.iter().zip(0..) {
        let mut attribute = PointAttribute::new();
        let is_normalized = it.kind == GeometryAttributeType::Color;
        attribute.init(it.kind, it.components, it.data_type, is_normalized, count);
        attribute.buffer_mut().write(0, &it.bytes);
        mesh.add_attribute(attribute);
        if let Some(bits) = it.bits {
            options.set_attribute_quantization(i, bits);
        }
    }
    let mut buffer = EncoderBuffer::new();
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    encoder.encode(&options, &mut buffer).unwrap();
    buffer.data().to_vec()
}

/// A file of a packed primitive. Of each attribute its name, what its accessor says besides the count, and its number in Draco.
fn file(
    packed: &[u8],
    [count, corners]: [usize; 2],
    attributes: &[(&str, &str, u32)],
    nodes: &str,
    more: &str,
) -> Vec<u8> {
    let mut glb = Glb::default();
    let view = glb.view(packed);
    let [mut named, mut numbered] = [Vec::new(), Vec::new()];
    for (name, kind, number) in attributes {
        let accessor = glb.accessor(format!(r#"{{"count":{count},{kind}}}"#));
        named.push(format!(r#""{name}":{accessor}"#));
        numbered.push(format!(r#""{name}":{number}"#));
    }
    let indices = glb.accessor(format!(
        r#"{{"componentType":5123,"count":{corners},"type":"SCALAR"}}"#
    ));
    let mesh_text = format!(
        r#"{{"primitives":[{{"attributes":{{{}}},"indices":{indices},
            "extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{view},"attributes":{{{}}}}}}}}}]}}"#,
        named.join(","),
        numbered.join(",")
    );
    glb.more = format!(
        r#","extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"]{more}"#
    );
    glb.bytes(&mesh_text, nodes)
}

const POSITIONS: &str = r#""componentType":5126,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]"#;

/// The cube with 12 bits to a coordinate.
fn packed_cube() -> Vec<u8> {
    let (corners, triangles) = cube();
    let positions = Attribute::floats(GeometryAttributeType::Position, &corners, Some(12));
    packed(8, &triangles, &[positions], 5)
}

fn cube_file(packed: &[u8]) -> Vec<u8> {
    let attributes = [("POSITION", POSITIONS, 0)];
    file(packed, [8, 36], &attributes, r#"{"mesh":0}"#, "")
}

/// A tube with a seam, at which vertices have the same place and other texture coordinates; the places and directions of its points.
struct Tube {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    colors: Vec<[u8; 4]>,
    triangles: Vec<u16>,
}

impl Tube {
    const ROUND: u16 = 7;
    const HIGH: u16 = 4;

    fn new() -> Self {
        let mut tube = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            colors: Vec::new(),
            triangles: Vec::new(),
        };
        for j in 0..Self::HIGH {
            for i in 0..=Self::ROUND {
                let turn = f32::from(i % Self::ROUND) / f32::from(Self::ROUND);
                let (sin, cos) = (std::f32::consts::TAU * turn).sin_cos();
                let (u, v) = (
                    f32::from(i) / f32::from(Self::ROUND),
                    f32::from(j * j) / 9.0,
                );
                tube.positions
                    .push([cos, sin * (1.0 - 0.5 * v), 1.5 * v - 0.7]);
                tube.normals
                    .push(vec3(cos, sin, v - 0.4).normalize().to_array());
                tube.uvs.push([3.0 * u - 1.0, v]);
                tube.colors
                    .push([(37 * i) as u8, 255 - j as u8, 128, (7 + i * j) as u8]);
                let (a, b) = (j * (Self::ROUND + 1) + i, (j + 1) * (Self::ROUND + 1) + i);
                if i < Self::ROUND && j + 1 < Self::HIGH {
                    tube.triangles.extend([a, a + 1, b, b, a + 1, b + 1]);
                }
            }
        }
        tube
    }

    /// The number of the vertex at a place with these texture coordinates, and how far it is off in both.
    fn nearest(&self, position: Vec3, uv: Vec2) -> (usize, [f32; 2]) {
        let off = |i: usize| {
            let at = Vec3::from(self.positions[i]);
            let away = (position - at).abs().max_element();
            [away, (uv - Vec2::from(self.uvs[i])).abs().max_element()]
        };
        let nearest = (0..self.positions.len()).map(|i| (i, off(i)));
        let sum = |it: &(usize, [f32; 2])| it.1[0] + it.1[1];
        nearest.min_by(|a, b| sum(a).total_cmp(&sum(b))).unwrap()
    }
}

/// Triangles in order, each turned so that its least vertex comes first.
fn sorted(triangles: impl Iterator<Item = [usize; 3]>) -> Vec<[usize; 3]> {
    let from_least = |mut triangle: [usize; 3]| {
        let least = (0..3).min_by_key(|i| triangle[*i]).unwrap();
        triangle.rotate_left(least);
        triangle
    };
    let mut triangles: Vec<_> = triangles.map(from_least).collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn packed_attributes_are_those_that_were_packed() {
    let tube = Tube::new();
    let (count, corners) = (tube.positions.len(), tube.triangles.len());
    let attributes = [
        Attribute::floats(GeometryAttributeType::Position, &tube.positions, Some(12)),
        Attribute::floats(GeometryAttributeType::Normal, &tube.normals, Some(10)),
        Attribute::floats(GeometryAttributeType::TexCoord, &tube.uvs, Some(11)),
        Attribute::bytes(GeometryAttributeType::Color, &tube.colors),
    ];
    let of_file = [
        ("POSITION", POSITIONS, 0),
        ("NORMAL", r#""componentType":5126,"type":"VEC3""#, 1),
        ("TEXCOORD_0", r#""componentType":5126,"type":"VEC2""#, 2),
        (
            "COLOR_0",
            r#""componentType":5121,"normalized":true,"type":"VEC4""#,
            3,
        ),
    ];
    // Half a step of the largest extent of each, 2 and 3; of normals a step of the two coordinates on the octahedron, whose
    // middle is drawn out by the square root of 3.
    let (position_step, uv_step) = (2.0 / 4095.0, 3.0 / 2047.0);
    let normal_step = 2.0 / 1023.0 * 3_f32.sqrt();
    for speed in [0, 3, 5, 7, 10] {
        let packed = packed(count, &tube.triangles, &attributes, speed);
        let bytes = file(&packed, [count, corners], &of_file, r#"{"mesh":0}"#, "");
        let mesh: &Mesh = &mesh(&bytes, "");
        let vertex = |&v: &u32| {
            let v = v as usize;
            let (i, [away, uv_away]) = tube.nearest(mesh.positions_m[v], mesh.uvs[v]);
            assert!(away < 0.51 * position_step, "speed {speed}: {away}");
            assert!(uv_away < 0.51 * uv_step, "speed {speed}: {uv_away}");
            let away = mesh.normals[v].distance(Vec3::from(tube.normals[i]));
            assert!(away < normal_step, "speed {speed}: {away}");
            let color = Vec4::from(tube.colors[i].map(|code| f32::from(code) / 255.0));
            assert_eq!(mesh.colors[v], color, "speed {speed}");
            i
        };
        let unpacked = sorted(mesh.triangles.iter().map(|it| it.each_ref().map(vertex)));
        let triangles = tube.triangles.as_chunks::<3>().0.iter();
        let expected = sorted(triangles.map(|it| it.map(usize::from)));
        assert_eq!(unpacked, expected, "speed {speed}");
    }
}

#[test]
fn packed_joints_move_vertices() {
    let (corners, triangles) = cube();
    let joints: Vec<_> = corners
        .iter()
        .map(|[x, ..]| [u8::from(*x > 0.0), 0, 0, 0])
        .collect();
    let shares = [[1.0, 0.0, 0.0, 0.0]; 8];
    let attributes = [
        Attribute::floats(GeometryAttributeType::Position, &corners, Some(12)),
        Attribute::bytes(GeometryAttributeType::Generic, &joints),
        Attribute::floats(GeometryAttributeType::Generic, &shares, Some(12)),
    ];
    let packed = packed(8, &triangles, &attributes, 5);
    let file = |weights: u32| {
        let attributes = [
            ("POSITION", POSITIONS, 0),
            ("JOINTS_0", r#""componentType":5121,"type":"VEC4""#, 1),
            (
                "WEIGHTS_0",
                r#""componentType":5126,"type":"VEC4""#,
                weights,
            ),
        ];
        let nodes = r#"{"mesh":0,"skin":0,"children":[1,2]},{"translation":[-1,0,0]},{"translation":[2,0,0]}"#;
        let skins = r#","skins":[{"joints":[1,2]}]"#;
        file(&packed, [8, 36], &attributes, nodes, skins)
    };
    let (least, most) = mesh(&file(2), "").bounds_m();
    assert!(least.abs_diff_eq(vec3(-1.5, -0.5, -0.5), 1e-3), "{least}");
    assert!(most.abs_diff_eq(vec3(2.5, 0.5, 0.5), 1e-3), "{most}");
    let error = load(&file(7), "").unwrap_err();
    let found = "its WEIGHTS_0 is to be attribute 7 of what Draco packs, which is not there";
    assert!(error.contains(found), "{error}");
}

#[test]
fn damaged_packed_meshes_end_in_a_message_or_a_shape() {
    let packed = packed_cube();
    for i in 0..packed.len() {
        let mut damaged = packed.clone();
        damaged[i] ^= 0x5a;
        if let Err(error) = load(&cube_file(&damaged), "") {
            assert!(error.contains("object[0]"), "{error}");
        }
    }
    let mut other = packed;
    other[0] = b'X';
    let error = load(&cube_file(&other), "").unwrap_err();
    assert!(
        error.contains("its primitive 0 cannot be unpacked"),
        "{error}"
    );
}

mod damaged {
    use super::{cube_file, load, packed_cube};
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
            if let Err(error) = load(&cube_file(&packed), "") {
                prop_assert!(error.contains("object[0]"), "{error}");
            }
        }
    }
}
