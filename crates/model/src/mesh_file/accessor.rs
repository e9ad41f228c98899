//! Typed reading of buffers, every index checked.

use gltf::Accessor;
use gltf::accessor::DataType;
use gltf::accessor::sparse::{IndexType, Sparse};

use super::source::Buffers;
use crate::flaw::Flaw;

/// Largest number of elements of accessors without a buffer, which are all zero and cost the file
/// nothing.
const MOST_ELEMENTS: usize = 1 << 28;

/// Elements of N numbers. Integers that the file calls normalised become numbers in [0, 1] or [-1, 1].
pub(super) fn read_numbers<const N: usize>(
    accessor: &Accessor,
    buffers: &Buffers,
) -> Result<Vec<[f32; N]>, Flaw> {
    let normalized = accessor.normalized();
    read(accessor, buffers, N, |bytes, data_type| {
        let size = data_type.size();
        std::array::from_fn(|i| number(&bytes[i * size..], data_type, normalized))
    })
}

/// Vertex indices.
pub(super) fn read_indices(accessor: &Accessor, buffers: &Buffers) -> Result<Vec<u32>, Flaw> {
    if accessor.data_type() == DataType::F32 {
        let found = format!("its accessor {} has fractions as indices", accessor.index());
        return Err(Flaw::new(found, "must be whole numbers"));
    }
    read(accessor, buffers, 1, |bytes, data_type| {
        index(bytes, data_type)
    })
}

fn read<T: Clone>(
    accessor: &Accessor,
    buffers: &Buffers,
    components: usize,
    decode: impl Fn(&[u8], DataType) -> T,
) -> Result<Vec<T>, Flaw> {
    let what = format!("its accessor {}", accessor.index());
    let data_type = accessor.data_type();
    if accessor.dimensions().multiplicity() != components {
        return Err(Flaw::new(
            format!("{what} has {:?} elements", accessor.dimensions()),
            format!("must have {components} components"),
        ));
    }
    let count = accessor.count();
    if count > MOST_ELEMENTS {
        return Err(Flaw::new(
            format!("{what} has {count} elements"),
            format!("must have at most {MOST_ELEMENTS}"),
        ));
    }
    let size = components * data_type.size();
    let mut elements = match accessor.view() {
        Some(view) => elements(&view, accessor.offset(), count, size, buffers, &what)?
            .map(|bytes| decode(bytes, data_type))
            .collect(),
        None => vec![decode(&vec![0; size], data_type); count],
    };
    if let Some(sparse) = accessor.sparse() {
        for (place, value) in replaced(&sparse, size, buffers, &what)? {
            let element = elements.get_mut(place).ok_or_else(|| {
                Flaw::new(
                    format!("{what} replaces element {place} of {count}"),
                    "must exist",
                )
            })?;
            *element = decode(value, data_type);
        }
    }
    Ok(elements)
}

/// The elements of a sparse accessor: the place and the bytes of each.
fn replaced<'b>(
    sparse: &Sparse,
    size: usize,
    buffers: &'b Buffers,
    what: &str,
) -> Result<impl Iterator<Item = (usize, &'b [u8])> + use<'b>, Flaw> {
    let (indices, values) = (sparse.indices(), sparse.values());
    let index_type = match indices.index_type() {
        IndexType::U8 => DataType::U8,
        IndexType::U16 => DataType::U16,
        IndexType::U32 => DataType::U32,
    };
    let places = elements(
        &indices.view(),
        indices.offset(),
        sparse.count(),
        index_type.size(),
        buffers,
        what,
    )?;
    let values = elements(
        &values.view(),
        values.offset(),
        sparse.count(),
        size,
        buffers,
        what,
    )?;
    let places = places.map(move |place| index(place, index_type) as usize);
    Ok(places.zip(values))
}

/// The bytes of `count` elements of a view, each at least `size` long.
fn elements<'b>(
    view: &gltf::buffer::View,
    offset: usize,
    count: usize,
    size: usize,
    buffers: &'b Buffers,
    what: &str,
) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, Flaw> {
    let bytes = buffers.view(view)?;
    let stride = view.stride().unwrap_or(size);
    let end = match count.checked_sub(1) {
        Some(last) => last
            .checked_mul(stride)
            .and_then(|start| start.checked_add(offset)?.checked_add(size)),
        None => Some(0),
    };
    if stride < size || end.is_none_or(|end| end > bytes.len()) {
        return Err(Flaw::new(
            format!("{what} reaches beyond its buffer view"),
            "must end within it",
        ));
    }
    Ok((0..count).map(move |i| &bytes[offset + i * stride..][..size]))
}

fn index(bytes: &[u8], data_type: DataType) -> u32 {
    match data_type {
        DataType::I8 | DataType::U8 => bytes[0].into(),
        DataType::I16 | DataType::U16 => u16::from_le_bytes([bytes[0], bytes[1]]).into(),
        DataType::U32 | DataType::F32 => {
            u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
        }
    }
}

/// Normalised integers as in the specification, section 3.11.
fn number(bytes: &[u8], data_type: DataType, normalized: bool) -> f32 {
    let (value, largest) = match data_type {
        DataType::F32 => {
            let bits = index(bytes, data_type);
            return f32::from_bits(bits);
        }
        DataType::I8 => (f32::from(bytes[0] as i8), 127.0),
        DataType::U8 => (f32::from(bytes[0]), 255.0),
        DataType::I16 => (f32::from(index(bytes, data_type) as u16 as i16), 32767.0),
        DataType::U16 => (f32::from(index(bytes, data_type) as u16), 65535.0),
        DataType::U32 => (index(bytes, data_type) as f32, u32::MAX as f32),
    };
    match normalized {
        true => (value / largest).max(-1.0),
        false => value,
    }
}
