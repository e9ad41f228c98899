//! The attributes and the triangles of a primitive, from buffers or from Draco's packing.

use glam::Vec4;
use gltf::accessor::Dimensions;
use gltf::mesh::Mode;
use gltf::{Document, Primitive, Semantic};

use super::accessor;
use super::draco::Unpacked;
use super::source::Buffers;
use crate::flaw::Flaw;

/// Source of the numbers of a primitive.
pub(super) struct Attributes<'a> {
    pub primitive: &'a Primitive<'a>,
    pub buffers: &'a Buffers,
    unpacked: Option<Unpacked>,
}

impl<'a> Attributes<'a> {
    pub(super) fn read(
        document: &Document,
        primitive: &'a Primitive<'a>,
        buffers: &'a Buffers,
    ) -> Result<Self, Flaw> {
        Ok(Self {
            primitive,
            buffers,
            unpacked: Unpacked::unpack(document, primitive, buffers)?,
        })
    }

    /// The primitive's triangles, all of whose indices are below `count`.
    pub(super) fn triangles(&self, count: usize) -> Result<Vec<[u32; 3]>, Flaw> {
        let primitive = self.primitive;
        let indices = match (&self.unpacked, primitive.indices()) {
            // Strips are packed as the triangles that they are.
            (Some(unpacked), _) => unpacked.triangles().into_flattened(),
            (None, Some(accessor)) => accessor::read_indices(&accessor, self.buffers)?,
            (None, None) => (0..count as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&index| index as usize >= count) {
            return Err(Flaw::new(
                format!(
                    "its primitive {} refers to vertex {index} of {count}",
                    primitive.index()
                ),
                "indices must be below the number of vertices",
            ));
        }
        Ok(match primitive.mode() {
            _ if self.unpacked.is_some() => indices.as_chunks().0.to_vec(),
            Mode::TriangleStrip => indices
                .windows(3)
                .enumerate()
                .map(|(i, w)| match i % 2 {
                    0 => [w[0], w[1], w[2]],
                    _ => [w[0], w[2], w[1]],
                })
                .collect(),
            Mode::TriangleFan => match indices.split_first() {
                Some((&center, rim)) => rim.windows(2).map(|w| [center, w[0], w[1]]).collect(),
                None => Vec::new(),
            },
            _ => indices.as_chunks().0.to_vec(),
        })
    }

    /// Linear factors, with alpha.
    pub(super) fn colors(&self, count: usize) -> Result<Option<Vec<Vec4>>, Flaw> {
        let semantic = Semantic::Colors(0);
        let Some(accessor) = self.primitive.get(&semantic) else {
            return Ok(None);
        };
        let colors: Option<Vec<Vec4>> = match accessor.dimensions() {
            Dimensions::Vec3 => self.matching::<3>(&semantic, count)?.map(|colors| {
                let opaque = |[r, g, b]: [f32; 3]| Vec4::new(r, g, b, 1.0);
                colors.into_iter().map(opaque).collect()
            }),
            _ => self
                .matching::<4>(&semantic, count)?
                .map(|colors| colors.into_iter().map(Vec4::from).collect()),
        };
        let clamped = |colors: Vec<Vec4>| {
            let colors = colors.into_iter();
            colors.map(|it| it.clamp(Vec4::ZERO, Vec4::ONE)).collect()
        };
        Ok(colors.map(clamped))
    }

    /// An attribute with one element for each vertex, if the primitive has it.
    pub(super) fn matching<const N: usize>(
        &self,
        semantic: &Semantic,
        count: usize,
    ) -> Result<Option<Vec<[f32; N]>>, Flaw> {
        match self.any::<N>(semantic)? {
            Some(elements) if elements.len() != count => Err(Flaw::new(
                format!(
                    "its primitive {} has {count} positions but {} elements of {semantic:?}",
                    self.primitive.index(),
                    elements.len()
                ),
                "must have as many of each",
            )),
            elements => Ok(elements),
        }
    }

    pub(super) fn any<const N: usize>(
        &self,
        semantic: &Semantic,
    ) -> Result<Option<Vec<[f32; N]>>, Flaw> {
        let Some(accessor) = self.primitive.get(semantic) else {
            return Ok(None);
        };
        let packed = match &self.unpacked {
            Some(unpacked) => unpacked.numbers::<N>(semantic, &accessor)?,
            None => None,
        };
        let elements = match packed {
            Some(elements) => elements,
            None => accessor::read_numbers::<N>(&accessor, self.buffers)?,
        };
        match elements.iter().flatten().all(|x| x.is_finite()) {
            true => Ok(Some(elements)),
            false => Err(Flaw::new(
                format!("its accessor {} holds infinities or NaN", accessor.index()),
                "all numbers must be finite",
            )),
        }
    }
}
