//! Bytes and arrays of numbers of a glTF file: views and accessors.

use serde_json::{Value, json};

use super::GltfFile;
use super::embed::kind_of;
use crate::flaw::Flaw;

const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const TYPES: [&str; 4] = ["SCALAR", "VEC2", "VEC3", "VEC4"];

impl GltfFile {
    /// Adds bytes to the buffer, and returns where they begin. Numbers of eight bytes may lie there.
    pub(super) fn append(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(8), 0);
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        offset
    }

    /// Adds a view of bytes, and returns its number.
    pub fn push_view(&mut self, bytes: &[u8]) -> usize {
        let view = self.view_of(bytes);
        self.push("bufferViews", view)
    }

    /// Adds bytes to the buffer, and returns a view of them.
    pub(super) fn view_of(&mut self, bytes: &[u8]) -> Value {
        if self.list("buffers").is_empty() {
            self.root.insert("buffers".to_owned(), json!([{}]));
        }
        let offset = self.append(bytes);
        json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() })
    }

    /// Adds numbers, so many an element, and returns their accessor. Positions of vertices need `bounds`.
    pub fn push_floats(&mut self, values: &[f32], width: usize, bounds: bool) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|it| it.to_le_bytes()).collect();
        let mut accessor = self.accessor(&bytes, FLOAT, values.len(), width);
        if bounds {
            let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                let column = |c: usize| values.iter().skip(c).step_by(width).copied();
                (0..width).filter_map(|c| column(c).reduce(pick)).collect()
            };
            accessor["min"] = json!(bound(f32::min));
            accessor["max"] = json!(bound(f32::max));
        }
        self.push("accessors", accessor)
    }

    /// Adds whole numbers, one an element, and returns their accessor.
    pub fn push_wholes(&mut self, values: &[u32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|it| it.to_le_bytes()).collect();
        let accessor = self.accessor(&bytes, UNSIGNED_INT, values.len(), 1);
        self.push("accessors", accessor)
    }

    fn accessor(&mut self, bytes: &[u8], kind: u32, count: usize, width: usize) -> Value {
        let view = self.push_view(bytes);
        json!({
            "bufferView": view, "componentType": kind, "count": count / width, "type": TYPES[width - 1],
        })
    }

    /// The bytes of a view.
    ///
    /// # Errors
    /// There is none, or it reaches beyond the buffer.
    pub fn view(&self, number: usize) -> Result<&[u8], Flaw> {
        let views = self.list("bufferViews");
        let view = views
            .get(number)
            .ok_or_else(|| missing("buffer view", number, views.len()))?;
        let get = |name: &str| view.get(name).and_then(Value::as_u64).unwrap_or(0) as usize;
        let start = get("byteOffset");
        let end = start.checked_add(get("byteLength"));
        end.filter(|_| get("buffer") == 0)
            .and_then(|end| self.bin.get(start..end))
            .ok_or_else(|| {
                let found = format!("its buffer view {number} reaches beyond its buffer");
                Flaw::new(found, "must end within it")
            })
    }

    /// The numbers of an accessor of single precision, so many an element.
    ///
    /// # Errors
    /// There is none, or it holds something else.
    pub fn floats(&self, number: usize, width: usize) -> Result<Vec<f32>, Flaw> {
        let accessors = self.list("accessors");
        let accessor = accessors
            .get(number)
            .ok_or_else(|| missing("accessor", number, accessors.len()))?;
        let get = |name: &str| accessor.get(name).and_then(Value::as_u64);
        let kind = accessor.get("type").and_then(Value::as_str);
        if get("componentType") != Some(FLOAT.into()) || kind != Some(TYPES[width - 1]) {
            let found = format!("its accessor {number} holds other numbers");
            let right = format!("must be {} of FLOAT", TYPES[width - 1]);
            return Err(Flaw::new(found, right));
        }
        let view = get("bufferView").ok_or_else(|| {
            let found = format!("its accessor {number} has no buffer view");
            Flaw::new(found, "must have one")
        })?;
        let start = get("byteOffset").unwrap_or(0) as usize;
        let length = (get("count").unwrap_or(0) as usize).checked_mul(4 * width);
        let end = length.and_then(|length| start.checked_add(length));
        let bytes = self.view(view as usize)?;
        let bytes = end.and_then(|end| bytes.get(start..end)).ok_or_else(|| {
            let found = format!("its accessor {number} reaches beyond its buffer view");
            Flaw::new(found, "must end within it")
        })?;
        let (numbers, _) = bytes.as_chunks::<4>();
        Ok(numbers.iter().map(|it| f32::from_le_bytes(*it)).collect())
    }

    /// Adds a file's bytes, and returns what names them: their name, their view and their kind.
    pub fn push_resource(&mut self, name: &str, bytes: &[u8]) -> Value {
        let view = self.push_view(bytes);
        let mut resource = json!({ "name": name, "bufferView": view });
        if let Some(kind) = kind_of(bytes) {
            resource["mimeType"] = json!(kind);
        }
        resource
    }
}

fn missing(what: &str, number: usize, count: usize) -> Flaw {
    Flaw::new(
        format!("it has no {what} {number}"),
        format!("must be below {count}"),
    )
}
