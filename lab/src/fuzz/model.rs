//! A sound model, and binary glTF of any.

/// Four corners with normals and texture coordinates, and the indices of four triangles.
pub fn tetrahedron() -> Vec<u8> {
    let corners = [
        [0.0f32, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let normals = [
        [0.577f32, 0.577, 0.577],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let uvs = [[0.0f32, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let indices: [u16; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
    let floats = corners
        .iter()
        .flatten()
        .chain(normals.iter().flatten())
        .chain(uvs.iter().flatten());
    let floats = floats.flat_map(|x| x.to_le_bytes());
    floats
        .chain(indices.iter().flat_map(|x| x.to_le_bytes()))
        .collect()
}

/// The text of a file of the tetrahedron, twice, with an image on it. Without `uri` the buffer is the binary chunk.
pub fn json(uri: Option<&str>, image: &str) -> String {
    let uri = uri.map_or(String::new(), |uri| format!("\"uri\": \"{uri}\", "));
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0, "children": [1], "scale": [1, 1, 2]}}, {{"mesh": 0, "translation": [1, 0, 0], "rotation": [0, 0, 0, 1]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}, "indices": 3, "material": 0, "mode": 4}}]}}],
"materials": [{{"name": "m", "pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}, "metallicFactor": 0.9, "roughnessFactor": 0.4}},
"normalTexture": {{"index": 0, "scale": 0.5}}}}],
"textures": [{{"source": 0}}], "images": [{{"uri": "{image}"}}],
"buffers": [{{{uri}"byteLength": 152}}],
"bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 48}},
{{"buffer": 0, "byteOffset": 96, "byteLength": 32}}, {{"buffer": 0, "byteOffset": 128, "byteLength": 24}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}},
{{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"}},
{{"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"}},
{{"bufferView": 3, "componentType": 5123, "count": 12, "type": "SCALAR"}}]}}"#
    )
}

/// A binary file of a text and a chunk.
pub fn glb(text: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut text = text.to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + bin.len();
    let number = |n: usize| (n as u32).to_le_bytes();
    [
        &b"glTF"[..],
        &number(2),
        &number(length),
        &number(text.len()),
        b"JSON",
        &text,
        &number(bin.len()),
        b"BIN\0",
        &bin,
    ]
    .concat()
}
