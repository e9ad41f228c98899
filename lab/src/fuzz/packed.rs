//! Sound models whose meshes are packed, by Draco and by meshoptimizer: a tube of a few triangles, by the encoders of the crates that
//! unpack them.

use anyhow::{Result, anyhow, ensure};
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, MeshEncoder,
    PointAttribute, PointIndex,
};
use meshopt_rs::index::IndexEncodingVersion;
use meshopt_rs::index::buffer::encode_index_buffer;
use meshopt_rs::index::sequence::encode_index_sequence;
use meshopt_rs::vertex::VertexEncodingVersion;
use meshopt_rs::vertex::buffer::encode_vertex_buffer;

/// The text of a model and the packed data in its binary chunk.
#[derive(Clone)]
pub struct Packed {
    /// One behind the other in the chunk.
    pub pieces: Vec<Vec<u8>>,
    /// Text with the words `OFFSET(i)`, `LENGTH(i)` and `TOTAL` in the place of numbers.
    text: String,
}

impl Packed {
    /// The text, and the chunk.
    pub fn parts(&self) -> (String, Vec<u8>) {
        let mut text = self.text.clone();
        let mut offset = 0;
        for (i, piece) in self.pieces.iter().enumerate() {
            text = text.replace(&format!("OFFSET({i})"), &offset.to_string());
            text = text.replace(&format!("LENGTH({i})"), &piece.len().to_string());
            offset += piece.len();
        }
        let text = text.replace("TOTAL", &offset.to_string());
        (text, self.pieces.concat())
    }
}

const ROUND: u16 = 7;
const HIGH: u16 = 4;
const POINTS: usize = ((ROUND + 1) * HIGH) as usize;

/// A tube with a seam: at it vertices have the same place and other texture coordinates.
struct Tube {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

fn tube() -> Tube {
    let points = (0..HIGH).flat_map(|j| (0..=ROUND).map(move |i| (i, j)));
    let place = |(i, j): (u16, u16)| {
        let turn = f64::from(i % ROUND) / f64::from(ROUND) * std::f64::consts::TAU;
        let (sin, cos) = libm::sincos(turn);
        [cos as f32, sin as f32, f32::from(j) * 0.5]
    };
    let triangles = points.clone().filter(|(i, j)| *i < ROUND && j + 1 < HIGH);
    let corners = |(i, j): (u16, u16)| {
        let (a, b) = (j * (ROUND + 1) + i, (j + 1) * (ROUND + 1) + i);
        [a, a + 1, b, b, a + 1, b + 1].map(u32::from)
    };
    Tube {
        positions: points.clone().map(place).collect(),
        normals: points
            .clone()
            .map(|octahedral| {
                let [x, y, _] = place(octahedral);
                [x, y, 0.0]
            })
            .collect(),
        uvs: points
            .map(|(i, j)| [f32::from(i) / f32::from(ROUND), f32::from(j)])
            .collect(),
        indices: triangles.flat_map(corners).collect(),
    }
}

fn bytes_of<const N: usize>(values: &[[f32; N]]) -> Vec<u8> {
    let bytes = values.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    bytes.collect()
}

/// Models packed with all predictions, with the usual ones, and with none.
pub fn draco() -> Result<Vec<Packed>> {
    [0, 5, 10].map(draco_at).into_iter().collect()
}

fn draco_at(speed: i32) -> Result<Packed> {
    let tube = tube();
    let mut mesh = draco_core::Mesh::new();
    mesh.set_num_points(POINTS);
    mesh.set_num_faces(tube.indices.len() / 3);
    for (i, face) in tube.indices.as_chunks::<3>().0.iter().enumerate() {
        mesh.set_face(FaceIndex(i as u32), face.map(PointIndex));
    }
    let mut options = EncoderOptions::new();
    options.set_compression_level(10 - speed);
    for (id, kind, components, bytes) in [
        (
            0,
            GeometryAttributeType::Position,
            3,
            bytes_of(&tube.positions),
        ),
        (1, GeometryAttributeType::Normal, 3, bytes_of(&tube.normals)),
        (2, GeometryAttributeType::TexCoord, 2, bytes_of(&tube.uvs)),
    ] {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, components, DataType::Float32, false, POINTS);
        attribute.buffer_mut().write(0, &bytes);
        mesh.add_attribute(attribute);
        options.set_attribute_quantization(id, 9);
    }
    let mut buffer = EncoderBuffer::new();
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    encoder
        .encode(&options, &mut buffer)
        .map_err(|error| anyhow!("pack by Draco: {error}"))?;
    let corners = tube.indices.len();
    Ok(Packed {
        pieces: vec![buffer.data().to_vec()],
        text: format!(
            r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
"extensionsUsed": ["KHR_draco_mesh_compression"], "extensionsRequired": ["KHR_draco_mesh_compression"],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}, "indices": 3,
"extensions": {{"KHR_draco_mesh_compression": {{"bufferView": 0, "attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}}}}}}}]}}],
"buffers": [{{"byteLength": TOTAL}}], "bufferViews": [{{"buffer": 0, "byteOffset": OFFSET(0), "byteLength": LENGTH(0)}}],
"accessors": [{{"componentType": 5126, "count": {POINTS}, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 2]}},
{{"componentType": 5126, "count": {POINTS}, "type": "VEC3"}}, {{"componentType": 5126, "count": {POINTS}, "type": "VEC2"}},
{{"componentType": 5123, "count": {corners}, "type": "SCALAR"}}]}}"#
        ),
    })
}

/// A model packed in all modes, and with all filters; attributes by both versions of their coding.
pub fn meshopt() -> Result<Packed> {
    let tube = tube();
    let corners = tube.indices.len();
    let exponential = |x: f32| ((-10 << 24) | ((x * 1024.0) as i32 & 0xff_ffff)).to_le_bytes();
    let flat = |words: [[u8; 4]; 3]| -> [u8; 12] { std::array::from_fn(|i| words[i / 4][i % 4]) };
    let positions: Vec<_> = tube
        .positions
        .iter()
        .map(|it| flat(it.map(exponential)))
        .collect();
    let octahedral = |[x, y, _]: [f32; 3]| {
        let sum = x.abs() + y.abs();
        [x, y].map(|it| (it / sum * 127.0) as i8 as u8)
    };
    let normals: Vec<_> = tube
        .normals
        .iter()
        .map(|normal| {
            let [x, y] = octahedral(*normal);
            [x, y, 127, 0]
        })
        .collect();
    let colors: Vec<_> = (0..POINTS).map(|i| [100 + i as u8, 9, 250, 255]).collect();
    let quaternions = [
        [0, 0, 0, 0, 0, 0, 0xff, 0x7f],
        [9, 0, 0, 8, 255, 255, 0xfd, 0x7f],
    ];
    let uvs: Vec<[u8; 8]> = bytes_of(&tube.uvs).as_chunks().0.to_vec();
    let mut triangles = vec![0; 4096];
    let version = IndexEncodingVersion::V1;
    let used = encode_index_buffer(&mut triangles, &tube.indices, version);
    triangles.truncate(used.ok_or_else(|| anyhow!("pack triangles"))?);
    let mut indices = vec![0; 4096];
    let used = encode_index_sequence(&mut indices, &tube.indices, IndexEncodingVersion::V1);
    ensure!(used > 0, "pack indices");
    indices.truncate(used);
    let pieces = [
        (
            attributes(&positions)?,
            12,
            POINTS,
            "ATTRIBUTES",
            "EXPONENTIAL",
        ),
        (attributes(&normals)?, 4, POINTS, "ATTRIBUTES", "OCTAHEDRAL"),
        (literally(&colors), 4, POINTS, "ATTRIBUTES", "COLOR"),
        (attributes(&quaternions)?, 8, 2, "ATTRIBUTES", "QUATERNION"),
        (literally(&uvs), 8, POINTS, "ATTRIBUTES", "NONE"),
        (triangles, 2, corners, "TRIANGLES", "NONE"),
        (indices, 4, corners, "INDICES", "NONE"),
    ];
    let mut length = 0;
    let mut views = Vec::new();
    for (i, (_, stride, count, mode, filter)) in pieces.iter().enumerate() {
        let bytes = stride * count;
        views.push(format!(
            r#"{{"buffer": 1, "byteOffset": {length}, "byteLength": {bytes}, "extensions": {{"KHR_meshopt_compression":
{{"buffer": 0, "byteOffset": OFFSET({i}), "byteLength": LENGTH({i}), "byteStride": {stride}, "count": {count}, "mode": "{mode}", "filter": "{filter}"}}}}}}"#
        ));
        length += bytes;
    }
    let views = views.join(",\n");
    let attributes = r#""attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2, "TEXCOORD_0": 4}"#;
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0, "extensions": {{"EXT_mesh_gpu_instancing": {{"attributes": {{"ROTATION": 3}}}}}}}}],
"extensionsUsed": ["KHR_meshopt_compression", "EXT_mesh_gpu_instancing"], "extensionsRequired": ["KHR_meshopt_compression"],
"meshes": [{{"primitives": [{{{attributes}, "indices": 5}}, {{{attributes}, "indices": 6}}]}}],
"buffers": [{{"byteLength": TOTAL}}, {{"byteLength": {length}, "extensions": {{"KHR_meshopt_compression": {{"fallback": true}}}}}}],
"bufferViews": [{views}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": {POINTS}, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 2]}},
{{"bufferView": 1, "componentType": 5120, "normalized": true, "count": {POINTS}, "type": "VEC3"}},
{{"bufferView": 2, "componentType": 5121, "normalized": true, "count": {POINTS}, "type": "VEC4"}},
{{"bufferView": 3, "componentType": 5122, "normalized": true, "count": 2, "type": "VEC4"}},
{{"bufferView": 4, "componentType": 5126, "count": {POINTS}, "type": "VEC2"}},
{{"bufferView": 5, "componentType": 5123, "count": {corners}, "type": "SCALAR"}},
{{"bufferView": 6, "componentType": 5125, "count": {corners}, "type": "SCALAR"}}]}}"#
    );
    Ok(Packed {
        pieces: pieces.into_iter().map(|it| it.0).collect(),
        text,
    })
}

/// Packs attributes by version 0 of the coding.
fn attributes<const N: usize>(elements: &[[u8; N]]) -> Result<Vec<u8>> {
    let mut packed = vec![0; 1 << 14];
    let used = encode_vertex_buffer(&mut packed, elements, VertexEncodingVersion::V0);
    packed.truncate(used.ok_or_else(|| anyhow!("pack attributes"))?);
    Ok(packed)
}

/// Packs attributes by version 1, which the crate does not write: all differences of bytes as they are. One block holds the elements.
fn literally<const N: usize>(elements: &[[u8; N]]) -> Vec<u8> {
    let mut packed = vec![0xa1];
    packed.extend([0xff; N].iter().take(N / 4));
    for k in 0..N {
        let mut last = 0_u8;
        for element in elements {
            let difference = element[k].wrapping_sub(last);
            packed.push(difference << 1 ^ (difference as i8 >> 7) as u8);
            last = element[k];
        }
    }
    // The element before the first is of zeros, and so are the ways of its bytes.
    packed.extend(vec![0; (N + N / 4).max(24)]);
    packed
}
