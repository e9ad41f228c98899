//! EXT_meshopt_compression and KHR_meshopt_compression: unpacked views against packed ones, and filters against the specification.

use crate::common::{Glb, cube, glb_of};
use crate::poses::{cube_mesh, load, mesh};
use glam::{Vec2, Vec3, Vec4, vec3};
use hairline_scene::Mesh;
use meshopt_rs::index::IndexEncodingVersion;
use meshopt_rs::index::buffer::encode_index_buffer;
use meshopt_rs::index::sequence::encode_index_sequence;
use meshopt_rs::vertex::VertexEncodingVersion;
use meshopt_rs::vertex::buffer::encode_vertex_buffer;

/// A file whose views are packed; their own buffer is a stand-in.
#[derive(Default)]
struct Packed {
    glb: Glb,
    /// The length of the stand-in.
    length: usize,
}

impl Packed {
    fn view(
        &mut self,
        packed: &[u8],
        stride: usize,
        count: usize,
        mode: &str,
        filter: &str,
    ) -> usize {
        let (offset, length) = (self.glb.bin.len(), packed.len());
        self.glb.bin.extend(packed);
        let (at, bytes) = (self.length, stride * count);
        self.length += bytes;
        // Indices and matrices have no stride in a file.
        let of_view = match mode {
            "ATTRIBUTES" => format!(r#","byteStride":{stride}"#),
            _ => String::new(),
        };
        self.glb.views.push(format!(
            r#"{{"buffer":1,"byteOffset":{at},"byteLength":{bytes}{of_view},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,
                "byteOffset":{offset},"byteLength":{length},"byteStride":{stride},"count":{count},"mode":"{mode}","filter":"{filter}"}}}}}}"#
        ));
        self.glb.views.len() - 1
    }

    /// Elements of N bytes, as they stand before the filter.
    fn attributes<const N: usize>(&mut self, elements: &[[u8; N]], filter: &str) -> usize {
        let packed = packed_attributes(elements);
        self.view(&packed, N, elements.len(), "ATTRIBUTES", filter)
    }

    fn indices(&mut self, indices: &[u32], stride: usize, mode: &str) -> usize {
        let packed = packed_indices(indices, mode);
        self.view(&packed, stride, indices.len(), mode, "NONE")
    }

    /// An accessor to a view. `kind` says what its elements are.
    fn accessor(&mut self, view: usize, offset: usize, count: usize, kind: &str) -> usize {
        self.glb.accessor(format!(
            r#"{{"bufferView":{view},"byteOffset":{offset},"count":{count},{kind}}}"#
        ))
    }

    /// The text that the bytes belong to.
    fn text(&mut self, mesh: &str, nodes: &str) -> String {
        self.glb.more = r#","extensionsUsed":["EXT_meshopt_compression"],"extensionsRequired":["EXT_meshopt_compression"]"#.to_owned();
        let text = self.glb.json(mesh, nodes, None);
        let stand_in = format!(
            r#"}},{{"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"fallback":true}}}}}}],"bufferViews""#,
            self.length
        );
        text.replace(r#"}],"bufferViews""#, &stand_in)
    }

    fn bytes(&mut self, mesh: &str, nodes: &str) -> Vec<u8> {
        glb_of(&self.text(mesh, nodes), &self.glb.bin)
    }
}

fn packed_attributes<const N: usize>(elements: &[[u8; N]]) -> Vec<u8> {
    let mut packed = vec![0; 1 << 16];
    let used = encode_vertex_buffer(&mut packed, elements, VertexEncodingVersion::V0).unwrap();
    packed.truncate(used);
    packed
}

fn packed_indices(indices: &[u32], mode: &str) -> Vec<u8> {
    let mut packed = vec![0; 1 << 12];
    let version = IndexEncodingVersion::V1;
    let used = match mode {
        "TRIANGLES" => encode_index_buffer(&mut packed, indices, version).unwrap(),
        _ => encode_index_sequence(&mut packed, indices, version),
    };
    packed.truncate(used);
    packed
}

fn bytes_of<const N: usize, const M: usize>(values: [f32; N]) -> [u8; M] {
    let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.try_into().unwrap()
}

const POSITIONS: &str =
    r#""componentType":5126,"type":"VEC3","min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]"#;

/// The cube packed. `damage` may change the packed bytes.
fn cube_file(damage: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    edited_cube_file([2, 4], ["TRIANGLES"; 2], damage, |text| text)
}

/// The cube's file twice, with indices of those bytes and modes, and its text edited.
fn edited_cube_file(
    strides: [usize; 2],
    modes: [&str; 2],
    damage: impl Fn(&mut Vec<u8>),
    edit: impl Fn(String) -> String,
) -> Vec<u8> {
    let (corners, triangles) = cube();
    let triangles: Vec<u32> = triangles.into_iter().map(u32::from).collect();
    let corners: Vec<[u8; 12]> = corners.into_iter().map(bytes_of).collect();
    let mut file = Packed::default();
    let mut packed = packed_attributes(&corners);
    damage(&mut packed);
    let view = file.view(&packed, 12, 8, "ATTRIBUTES", "NONE");
    file.accessor(view, 0, 8, POSITIONS);
    for (stride, mode) in strides.into_iter().zip(modes) {
        let mut packed = packed_indices(&triangles, mode);
        damage(&mut packed);
        let view = file.view(&packed, stride, 36, mode, "NONE");
        let component = if stride == 2 { 5123 } else { 5125 };
        file.accessor(
            view,
            0,
            36,
            &format!(r#""componentType":{component},"type":"SCALAR""#),
        );
    }
    let mesh = r#"{"primitives":[{"attributes":{"POSITION":0},"indices":1},{"attributes":{"POSITION":0},"indices":2}]}"#;
    let text = file.text(mesh, r#"{"mesh":0}"#);
    glb_of(&edit(text), &file.glb.bin)
}

/// Corners of each triangle, turned so that the first in the order of its numbers comes first; all sorted.
fn sorted_corners(mesh: &Mesh) -> Vec<[[u32; 3]; 3]> {
    let of = |triangle: &[u32; 3]| {
        let corner = |v: u32| mesh.positions_m[v as usize].to_array().map(f32::to_bits);
        let mut corners = triangle.map(corner);
        let least = (0..3).min_by_key(|i| corners[*i]).unwrap();
        corners.rotate_left(least);
        corners
    };
    let mut triangles: Vec<_> = mesh.triangles.iter().map(of).collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn views_packed_by_meshoptimizer_are_unpacked() {
    let mut glb = Glb::default();
    let mesh_text = cube_mesh(&mut glb, "");
    let plain = mesh(&glb.bytes(&mesh_text, r#"{"mesh":0}"#), "");
    let mut expected = [sorted_corners(&plain), sorted_corners(&plain)].concat();
    expected.sort_unstable();
    for (strides, modes) in [
        ([2, 4], ["TRIANGLES"; 2]),
        ([2, 4], ["INDICES"; 2]),
        ([4, 2], ["TRIANGLES", "INDICES"]),
    ] {
        let unpacked = mesh(&edited_cube_file(strides, modes, |_| {}, |text| text), "");
        assert_eq!(sorted_corners(&unpacked), expected, "{modes:?}");
    }
    // Same with the newer name of the extension, and with a buffer without bytes that does not say that it is a stand-in.
    for [from, to] in [
        ["EXT_meshopt", "KHR_meshopt"],
        [r#""fallback":true"#, r#""fallback":false"#],
    ] {
        let edit = |text: String| text.replace(from, to);
        let again = edited_cube_file([2, 4], ["TRIANGLES"; 2], |_| {}, edit);
        assert_eq!(sorted_corners(&mesh(&again, "")), expected, "{to}");
    }
    let error = |damage: &dyn Fn(&mut Vec<u8>)| load(&cube_file(damage), "").unwrap_err();
    let told = error(&|packed| packed[0] = 0);
    let expected =
        "its buffer view 0 cannot be unpacked (it begins with another byte than its mode has)";
    assert!(told.contains(expected), "{told}");
    let told = error(&|packed| packed.truncate(9));
    let expected = "its buffer view 0 cannot be unpacked (it is cut off)";
    assert!(told.contains(expected), "{told}");
    let longer = |text: String| text.replace(r#"{"byteLength":312,"#, r#"{"byteLength":311,"#);
    let told = load(
        &edited_cube_file([2, 4], ["TRIANGLES"; 2], |_| {}, longer),
        "",
    )
    .unwrap_err();
    let expected =
        "its buffer view 2 and those before it are longer unpacked than their buffers are";
    assert!(told.contains(expected), "{told}");
}

/// Each filter on what a surface has, and the elements of 36 bytes of an interleaved vertex. The numbers are those of appendix B.
#[test]
fn filtered_views_are_what_the_specification_says() {
    let mut file = Packed::default();
    // 2^-1, 3 * 2^-2 and -5 * 2^1.
    let word = |exponent: i32, whole: i32| (exponent << 24 | whole & 0xff_ffff).to_le_bytes();
    let (zero, half, more, less) = (word(0, 0), word(-1, 1), word(-2, 3), word(1, -5));
    let positions = [[zero, zero, half], [more, zero, half], [zero, less, half]];
    let positions = positions.map(|it| it.as_flattened().try_into().unwrap());
    let view = file.attributes::<12>(&positions, "EXPONENTIAL");
    let bounds = r#""componentType":5126,"type":"VEC3","min":[0,-10,0],"max":[1,0,1]"#;
    file.accessor(view, 0, 3, bounds);
    // With 4 bits to a number: 15 is 1. (3, -6, 6) / 9 above, (3, 6, -6) / 9 below, and an axis.
    let normals = [[3, 250, 15, 0], [9, 12, 15, 0], [0, 241, 15, 0]];
    let view = file.attributes::<4>(&normals, "OCTAHEDRAL");
    file.accessor(
        view,
        0,
        3,
        r#""componentType":5120,"normalized":true,"type":"VEC3""#,
    );
    // Luma, chromas and alpha: of 8 bits, of 4 bits, and white.
    let colors = [[100, 100, 0, 0xc0], [7, 254, 1, 13], [255, 0, 0, 0xff]];
    let view = file.attributes::<4>(&colors, "COLOR");
    file.accessor(
        view,
        0,
        3,
        r#""componentType":5121,"normalized":true,"type":"VEC4""#,
    );
    // A quarter of a turn about z, and one about -x: of 16 bits, each times the square root of 2.
    let word = |numbers: [i16; 4]| -> [u8; 8] {
        let bytes: Vec<u8> = numbers.iter().flat_map(|it| it.to_le_bytes()).collect();
        bytes.try_into().unwrap()
    };
    let rotations = [word([0, 0, 32767, 32767]), word([-32767, 0, 0, 32767])];
    let view = file.attributes::<8>(&rotations, "QUATERNION");
    file.accessor(
        view,
        0,
        2,
        r#""componentType":5122,"normalized":true,"type":"VEC4""#,
    );
    // An interleaved vertex: its texture coordinates are behind 28 bytes of something else.
    let others = [[0.25, 0.5], [1.0, -2.0], [0.0, 7.0]];
    let elements = others.map(|[u, v]| bytes_of([9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, u, v]));
    let view = file.attributes::<36>(&elements, "NONE");
    file.accessor(view, 28, 3, r#""componentType":5126,"type":"VEC2""#);
    let view = file.indices(&[0, 1, 2], 2, "INDICES");
    file.accessor(view, 0, 3, r#""componentType":5123,"type":"SCALAR""#);

    let mesh_text = r#"{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":2,"TEXCOORD_0":4},"indices":5}]}"#;
    let node =
        r#"{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"ROTATION":3}}}}"#;
    let unpacked = mesh(&file.bytes(mesh_text, node), "");
    let corners = [
        vec3(0.0, 0.0, 0.5),
        vec3(0.75, 0.0, 0.5),
        vec3(0.0, -10.0, 0.5),
    ];
    let directions = [
        vec3(42.0, -85.0, 85.0),
        vec3(42.0, 85.0, -85.0),
        Vec3::NEG_Y,
    ];
    let about_z = |it: Vec3| vec3(-it.y, it.x, it.z);
    let about_x = |it: Vec3| vec3(it.x, it.z, -it.y);
    // A step of a sixteen-bit quaternion, four times in a rotation, of what is 10 long.
    let near = |a: Vec3, b: Vec3| a.distance(b) < 10.0 * 4.0 / 32767.0;
    for (i, at) in unpacked.positions_m.iter().enumerate() {
        let turned = |it: Vec3| if i < 3 { about_z(it) } else { about_x(it) };
        assert!(near(*at, turned(corners[i % 3])), "{i}: {at}");
        let normal = turned(directions[i % 3].normalize());
        assert!(near(unpacked.normals[i], normal), "{i}: {normal}");
        assert_eq!(unpacked.uvs[i], Vec2::from(others[i % 3]));
    }
    let colors = [[200, 100, 0, 128], [68, 136, 136, 187], [255; 4]];
    let colors = colors.map(|it: [u8; 4]| Vec4::from(it.map(|code| f32::from(code) / 255.0)));
    assert_eq!(unpacked.colors, [colors, colors].concat());
}

mod damaged {
    use super::{cube_file, load};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]
        /// Bytes of packed views changed, and their end cut off: a message or another shape; no panic, and no memory for what is not there.
        #[test]
        fn packed_views_end_in_a_message_or_a_shape(
            changed in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
            kept in 0.0..2.0f64,
        ) {
            let damaged = cube_file(|packed| {
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
