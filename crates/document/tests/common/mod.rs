//! Scene files and glTF files made in code, shared by several tests.
#![allow(dead_code, reason = "each test file uses a part")]

#[path = "../../../sky/tests/common/asset.rs"]
mod asset;

pub use asset::asset;

/// A scene with a camera, a material called "steel", and the given tables. Without lights it stays dark: it has no studio.
pub fn scene_with(rest: &str) -> String {
    let is_lit = ["[[light]]", "[environment]"]
        .iter()
        .any(|table| rest.contains(table));
    let studio = if is_lit {
        ""
    } else {
        "[studio]\nhidden = true"
    };
    format!(
        r#"[camera]
position_m = [0.0, -0.22, 0.30]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]

[[material]]
name = "steel"
kind = "metal"
metal = "steel"

{rest}
{studio}
"#
    )
}

/// An object called "it" of the given shape.
pub fn object(shape: &str) -> String {
    format!("[[object]]\nname = \"it\"\nshape = {shape}\nmaterial = \"steel\"\n")
}

/// A directory for one test's files.
pub fn temporary_dir() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary directory can be made")
}

/// Builds a binary glTF file: bytes, and the JSON that describes them.
#[derive(Clone, Default)]
pub struct Glb {
    pub bin: Vec<u8>,
    pub views: Vec<String>,
    pub accessors: Vec<String>,
    /// More members of the file's top object, each with a comma before it.
    pub more: String,
}

impl Glb {
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let (offset, length) = (self.bin.len(), bytes.len());
        self.bin.extend_from_slice(bytes);
        while !self.bin.len().is_multiple_of(4) {
            self.bin.push(0);
        }
        let view = format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#);
        self.views.push(view);
        self.views.len() - 1
    }

    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<_> = values
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let view = self.view(&bytes);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let bound = |pick: fn(f32, f32) -> f32| {
            let of = |i: usize| values.iter().map(|v| v[i]).fold(values[0][i], pick);
            (0..N)
                .map(|i| of(i).to_string())
                .collect::<Vec<_>>()
                .join(",")
        };
        self.accessor(format!(
            r#"{{"bufferView":{view},"componentType":5126,"count":{},"type":"{kind}","min":[{}],"max":[{}]}}"#,
            values.len(),
            bound(f32::min),
            bound(f32::max)
        ))
    }

    pub fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<_> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(format!(
            r#"{{"bufferView":{view},"componentType":5123,"count":{},"type":"SCALAR"}}"#,
            values.len()
        ))
    }

    pub fn accessor(&mut self, json: String) -> usize {
        self.accessors.push(json);
        self.accessors.len() - 1
    }

    /// The JSON text, with the buffer at `uri` or, without one, in the binary chunk. `meshes` and `nodes` are the elements of
    /// those arrays; node 0 is the scene.
    pub fn json(&self, meshes: &str, nodes: &str, uri: Option<&str>) -> String {
        let uri = uri.map_or(String::new(), |uri| format!(r#""uri":"{uri}","#));
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],"meshes":[{meshes}],"buffers":[{{{uri}"byteLength":{}}}],"bufferViews":[{}],"accessors":[{}]{}}}"#,
            self.bin.len(),
            self.views.join(","),
            self.accessors.join(","),
            self.more
        )
    }

    pub fn bytes(&self, meshes: &str, nodes: &str) -> Vec<u8> {
        glb_of(&self.json(meshes, nodes, None), &self.bin)
    }
}

pub fn glb_of(json: &str, bin: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    while !json.len().is_multiple_of(4) {
        json.push(b' ');
    }
    let mut glb = b"glTF".to_vec();
    let mut push = |number: usize| glb.extend((number as u32).to_le_bytes());
    push(2);
    push(12 + 8 + json.len() + 8 + bin.len());
    push(json.len());
    glb.extend(b"JSON");
    glb.extend(json);
    glb.extend((bin.len() as u32).to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(bin);
    glb
}

/// The corners and triangles of a unit cube about the origin, corners shared.
pub fn cube() -> (Vec<[f32; 3]>, Vec<u16>) {
    let corner = |i: u16| [0, 1, 2].map(|axis| f32::from(i >> axis & 1) - 0.5);
    let faces: [[u16; 4]; 6] = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces
        .iter()
        .flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])
        .collect();
    ((0..8).map(corner).collect(), triangles)
}

/// A PNG of one colour.
pub fn png(size_px: [u32; 2], rgba: [u8; 4]) -> Vec<u8> {
    let image = image::RgbaImage::from_pixel(size_px[0], size_px[1], image::Rgba(rgba));
    let mut png = std::io::Cursor::new(Vec::new());
    image.write_to(&mut png, image::ImageFormat::Png).unwrap();
    png.into_inner()
}
