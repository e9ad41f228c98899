//! KHR_draco_mesh_compression: a primitive whose vertices and triangles are packed together. The crate draco-core unpacks them.

use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};
use gltf::accessor::DataType;
use gltf::json::Value;
use gltf::{Document, Primitive, Semantic};

use super::source::Buffers;
use crate::flaw::Flaw;

pub(super) const NAME: &str = "KHR_draco_mesh_compression";
/// A few bytes may stand for any number of points. So many more than the accessors say are taken for an oversight of an exporter; those of
/// the accessors were counted before the file was read.
const MOST_SHARE: u64 = 4;
const FEW_POINTS: u64 = 1 << 16;
/// Largest memory held for a point or a face while it is unpacked.
const MOST_POINT_BYTES: u64 = 1 << 10;

/// A primitive unpacked.
pub(super) struct Unpacked {
    mesh: Mesh,
    /// The numbers of the attributes by their names in the file.
    attributes: Vec<(String, u32)>,
}

impl Unpacked {
    /// Unpacks a primitive; none where it is not packed.
    pub(super) fn unpack(
        document: &Document,
        primitive: &Primitive,
        buffers: &Buffers,
    ) -> Result<Option<Self>, Flaw> {
        let Some(extension) = primitive.extension_value(NAME) else {
            return Ok(None);
        };
        let broken = |found: String| {
            let found = format!("its primitive {} {found}", primitive.index());
            Flaw::new(found, "must be packed by Draco as the extension has it")
        };
        let view = extension
            .get("bufferView")
            .and_then(Value::as_u64)
            .and_then(|index| document.views().nth(usize::try_from(index).ok()?))
            .ok_or_else(|| broken("names no buffer view".to_owned()))?;
        let corners = primitive.indices().map_or(0, |it| it.count());
        let points = primitive
            .get(&Semantic::Positions)
            .map_or(0, |it| it.count());
        let most = MOST_SHARE * corners.max(points) as u64 + FEW_POINTS;
        let limits = DecodeLimits::default()
            .with_max_points(most)
            .with_max_faces(most)
            .with_max_decoded_bytes(MOST_POINT_BYTES * most);
        let mut packed = DecoderBuffer::new(buffers.view(&view)?).with_limits(limits);
        let mut mesh = Mesh::new();
        MeshDecoder::new()
            .decode(&mut packed, &mut mesh)
            .map_err(|error| broken(format!("cannot be unpacked ({error})")))?;
        let attributes = extension.get("attributes").and_then(Value::as_object);
        let number = |(name, id): (&String, &Value)| {
            let id = u32::try_from(id.as_u64()?).ok()?;
            Some((name.clone(), id))
        };
        let attributes = attributes.into_iter().flatten().filter_map(number);
        Ok(Some(Self {
            mesh,
            attributes: attributes.collect(),
        }))
    }

    /// One element a vertex; none of an attribute that is not packed.
    pub(super) fn numbers<const N: usize>(
        &self,
        semantic: &Semantic,
        accessor: &gltf::Accessor,
    ) -> Result<Option<Vec<[f32; N]>>, Flaw> {
        let name = semantic.to_string();
        let known = self.attributes.iter().find(|(known, _)| *known == name);
        let Some((_, id)) = known else {
            return Ok(None);
        };
        let attribute = self.mesh.attribute_by_unique_id(*id).ok_or_else(|| {
            Flaw::new(
                format!(
                    "its {name} is to be attribute {id} of what Draco packs, which is not there"
                ),
                "must be packed by Draco as the extension has it",
            )
        })?;
        let mut numbers = attribute.read_f32s(self.mesh.num_points(), N);
        // The accessor says what they are.
        let largest = match accessor.data_type() {
            DataType::I8 => 127.0,
            DataType::U8 => 255.0,
            DataType::I16 => 32767.0,
            DataType::U16 => 65535.0,
            DataType::U32 => u32::MAX as f32,
            DataType::F32 => 1.0,
        };
        if accessor.normalized() {
            numbers
                .iter_mut()
                .for_each(|x| *x = (*x / largest).max(-1.0));
        }
        Ok(Some(numbers.as_chunks().0.to_vec()))
    }

    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        let faces = self.mesh.faces().iter();
        faces.map(|face| face.map(|point| point.0)).collect()
    }
}
