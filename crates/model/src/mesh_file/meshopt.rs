//! EXT_meshopt_compression and KHR_meshopt_compression: buffer views that are packed by themselves. The crate meshopt-rs unpacks indices.

mod attributes;
mod filters;

use gltf::buffer::View;
use gltf::json::Value;
use meshopt_rs::index::buffer::decode_index_buffer;
use meshopt_rs::index::sequence::decode_index_sequence;

use crate::flaw::Flaw;

/// The newer one has one more coding and one more filter; both are read under either name.
const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
/// A byte says of 256 elements that four bytes of each stay as they are: no coding packs more into one. Then there is what is held for a few.
const MOST_SHARE: usize = 1024;
const FEW_BYTES: usize = 1 << 16;

/// Whether a buffer says that it only stands for bytes that are packed elsewhere.
pub(super) fn is_stand_in(buffer: &gltf::Buffer) -> bool {
    let is_one = |name: &&str| {
        let fallback = |value: &Value| value.get("fallback").and_then(Value::as_bool);
        buffer.extension_value(name).and_then(fallback) == Some(true)
    };
    NAMES.iter().any(is_one)
}

/// Whether the bytes of a view are packed elsewhere.
pub(super) fn is_packed(view: &View) -> bool {
    NAMES
        .iter()
        .any(|name| view.extension_value(name).is_some())
}

/// Packing of a view.
struct Packing<'v> {
    packed: &'v [u8],
    count: usize,
    stride: usize,
    mode: &'v str,
    filter: &'v str,
}

/// The bytes of a view of a buffer that is a stand-in; `buffers` are all of the file's.
pub(super) fn unpack(view: &View, buffers: &[Option<Vec<u8>>]) -> Result<Vec<u8>, Flaw> {
    let broken = |found: String| {
        let found = format!("its buffer view {} {found}", view.index());
        Flaw::new(
            found,
            "must be packed by meshoptimizer as the extension has it",
        )
    };
    let mut extensions = NAMES.iter().filter_map(|name| view.extension_value(name));
    let packing = extensions
        .next()
        .and_then(|value| Packing::parse(value, buffers));
    let packing = packing.ok_or_else(|| broken("does not say where its bytes are".to_owned()))?;
    let bytes = packing.count.checked_mul(packing.stride);
    if bytes != Some(view.length()) {
        return Err(broken("is not as long as its elements are".to_owned()));
    }
    if view.length() > MOST_SHARE * packing.packed.len() + FEW_BYTES {
        return Err(broken("is longer than what its bytes can hold".to_owned()));
    }
    packing
        .unpacked()
        .map_err(|why| broken(format!("cannot be unpacked ({why})")))
}

impl<'v> Packing<'v> {
    fn parse(value: &'v Value, buffers: &'v [Option<Vec<u8>>]) -> Option<Self> {
        let number = |name: &str| usize::try_from(value.get(name)?.as_u64()?).ok();
        let text = |name: &str| value.get(name).and_then(Value::as_str);
        let start = number("byteOffset").unwrap_or(0);
        let end = start.checked_add(number("byteLength")?)?;
        Some(Self {
            packed: buffers.get(number("buffer")?)?.as_ref()?.get(start..end)?,
            count: number("count")?,
            stride: number("byteStride")?,
            mode: text("mode")?,
            filter: text("filter").unwrap_or("NONE"),
        })
    }

    fn unpacked(&self) -> Result<Vec<u8>, String> {
        match self.mode {
            "ATTRIBUTES" => {
                let mut bytes = attributes::unpacked(self.packed, self.count, self.stride)?;
                filters::apply(self.filter, self.stride, &mut bytes)?;
                Ok(bytes)
            }
            "TRIANGLES" if self.count.is_multiple_of(3) => {
                let mut indices = vec![0_u32; self.count];
                decode_index_buffer(&mut indices, self.packed).map_err(in_words)?;
                self.indices(&indices)
            }
            "INDICES" => {
                let mut indices = vec![0_u32; self.count];
                decode_index_sequence(&mut indices, self.packed).map_err(in_words)?;
                self.indices(&indices)
            }
            mode => Err(format!("{} elements by the mode {mode:?}", self.count)),
        }
    }

    fn indices(&self, indices: &[u32]) -> Result<Vec<u8>, String> {
        let bytes = indices.iter().map(|index| index.to_le_bytes());
        match self.stride {
            2 => Ok(bytes.flat_map(|[a, b, ..]| [a, b]).collect()),
            4 => Ok(bytes.flatten().collect()),
            stride => Err(format!("indices of {stride} bytes")),
        }
    }
}

fn in_words<E: std::fmt::Debug>(error: E) -> String {
    format!("{error:?}")
}
