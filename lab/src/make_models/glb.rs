//! Writes binary glTF 2.0 (Khronos Group, "glTF 2.0 Specification", 2021, section 4).

use std::io::Cursor;

use anyhow::{Context, Result};
use glam::DVec3;
use image::{ImageFormat, RgbImage};
use serde_json::{Value, json};

use super::spoon::MeshPart;

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// A file in the making.
pub struct Glb {
    /// The JSON, but for the lists that this type keeps.
    pub root: Value,
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
}

/// Optional contents of a part in the file.
pub struct PartContents {
    /// Whether its tangents are written.
    pub tangents: bool,
}

impl Default for Glb {
    fn default() -> Self {
        Self {
            root: json!({ "asset": { "version": "2.0", "generator": "cargo lab make-models" } }),
            binary: Vec::new(),
            views: Vec::new(),
            accessors: Vec::new(),
            images: Vec::new(),
        }
    }
}

impl Glb {
    /// Embeds a picture as PNG.
    pub fn image(&mut self, name: &str, image: &RgbImage) -> Result<()> {
        let mut bytes = Cursor::new(Vec::new());
        image
            .write_to(&mut bytes, ImageFormat::Png)
            .with_context(|| format!("encode {name}"))?;
        let view = self.view(&bytes.into_inner(), None);
        self.images
            .push(json!({ "name": name, "bufferView": view, "mimeType": "image/png" }));
        Ok(())
    }

    /// Stores a part's vertices and triangles; returns the primitive for a mesh.
    pub fn primitive(&mut self, part: &MeshPart, material: usize, uses: PartContents) -> Value {
        let positions: Vec<[f32; 3]> = part
            .positions_mm
            .iter()
            .map(|p| p.as_vec3().to_array())
            .collect();
        let normals: Vec<[f32; 3]> = part
            .normals
            .iter()
            .map(|n| n.as_vec3().to_array())
            .collect();
        let uvs: Vec<[f32; 2]> = part.uvs.iter().map(|uv| uv.as_vec2().to_array()).collect();
        let low = part
            .positions_mm
            .iter()
            .copied()
            .fold(DVec3::INFINITY, DVec3::min);
        let high = part
            .positions_mm
            .iter()
            .copied()
            .fold(DVec3::NEG_INFINITY, DVec3::max);

        let position = self.floats("VEC3", &positions);
        self.accessors[position]["min"] = json!(low.as_vec3().to_array());
        self.accessors[position]["max"] = json!(high.as_vec3().to_array());
        let mut attributes = json!({
            "POSITION": position,
            "NORMAL": self.floats("VEC3", &normals),
            "TEXCOORD_0": self.floats("VEC2", &uvs),
        });
        if uses.tangents {
            let tangents: Vec<[f32; 4]> = part
                .tangents
                .iter()
                .map(|t| t.extend(1.0).as_vec4().to_array())
                .collect();
            attributes["TANGENT"] = json!(self.floats("VEC4", &tangents));
        }
        let indices: Vec<u8> = part
            .triangles
            .as_flattened()
            .iter()
            .flat_map(|&i| {
                u16::try_from(i)
                    .expect("a part has fewer than 65536 vertices")
                    .to_le_bytes()
            })
            .collect();
        let view = self.view(&indices, Some(ELEMENT_ARRAY_BUFFER));
        let indices = self.accessor(view, UNSIGNED_SHORT, "SCALAR", part.triangles.len() * 3);
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    /// The file's bytes.
    pub fn finish(mut self) -> Result<Vec<u8>> {
        pad(&mut self.binary, 0);
        self.root["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        self.root["bufferViews"] = Value::from(self.views);
        self.root["accessors"] = Value::from(self.accessors);
        self.root["images"] = Value::from(self.images);
        let mut text = serde_json::to_vec(&self.root).context("encode the JSON")?;
        pad(&mut text, b' ');
        let mut file = Vec::new();
        let length = 12 + 8 + text.len() + 8 + self.binary.len();
        for word in [u32::from_le_bytes(*b"glTF"), 2, length as u32] {
            file.extend(word.to_le_bytes());
        }
        for (kind, chunk) in [(*b"JSON", &text), (*b"BIN\0", &self.binary)] {
            file.extend((chunk.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(chunk);
        }
        Ok(file)
    }

    fn floats<const N: usize>(&mut self, kind: &str, rows: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = rows
            .as_flattened()
            .iter()
            .flat_map(|f| f.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        self.accessor(view, FLOAT, kind, rows.len())
    }

    fn accessor(&mut self, view: usize, component: u32, kind: &str, count: usize) -> usize {
        self.accessors.push(
            json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }),
        );
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        pad(&mut self.binary, 0);
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.binary.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }
}

/// Chunks and accessors start at multiples of four bytes.
fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), with);
}
