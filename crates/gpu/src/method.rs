//! The method by which a scene is shaded: Hairline's own, or one of others, whose pass takes the place of stages 3 to 6.
//! `hairline-published` is one.

use std::fmt::Debug;
use std::sync::Arc;

use glam::DVec3;
use hairline_index::{Pieces, ScratchIndex};
use hairline_optics::mask::Mask;
use hairline_scene::{Light, Scene, ScratchTables};

use crate::shaders::Module;
use crate::{host, lights};

pub use crate::rows::ROW_TEXELS;

/// The method of a scene on the device.
#[derive(Clone, Debug, Default)]
pub struct Method {
    /// Energy that the base loses to the scratches.
    pub mask: Mask,
    /// A method in the place of Hairline's own.
    pub other: Option<Arc<dyn ShadingMethod>>,
}

impl Method {
    /// Pieces of scratches that it takes: methods of others know no arcs.
    pub fn pieces(&self) -> Pieces {
        match self.other {
            None => Pieces::Seen,
            Some(_) => Pieces::Laid,
        }
    }
}

/// A pass that shades base and scratches of each sample; gratings and shadows are left out.
///
/// Pipelines are kept by its [`Debug`] text, which therefore holds all of its switches.
pub trait ShadingMethod: Debug + Send + Sync {
    /// Module of the pass, whose bindings are those of `other_method.wgsl` and then its tables. Its entry point has the name of its file. A
    /// workgroup takes a group of samples and fills their `base_light` and one chunk of `chunk_sums`.
    fn module(&self) -> &'static Module;

    /// Values of the constants that its modules leave open.
    fn constants(&self) -> Vec<(&'static str, f64)>;

    /// Textures that its modules bind in group 3 behind the arrays of a strip, in the order of their numbers.
    fn tables(&self, of: &TableSource<'_>) -> Vec<Table>;
}

/// A scene whose tables are to be made.
pub struct TableSource<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Index of its scratches.
    pub index: &'a ScratchIndex,
    /// Tables of its materials.
    pub tables: &'a ScratchTables,
    /// Origin of positions on the device.
    pub(crate) origin_m: DVec3,
}

impl<'a> TableSource<'a> {
    /// The tree over the scratches, as `scratch_node` of rows.wgsl reads it.
    pub fn scratch_nodes(&self) -> Vec<[u32; 4]> {
        bytemuck::cast_slice(&host::nodes(self.index, self.origin_m)).to_vec()
    }

    /// Lights in the order that they have on the device, each with the number of its places among the vertices.
    pub fn lights(&self) -> Vec<(&'a Light, usize)> {
        let lights = lights::sorted(self.scene).into_iter();
        lights.map(|light| (light, lights::places(light))).collect()
    }
}

/// A texture that a method's pass reads.
pub struct Table {
    /// Name for messages and for [`crate::Written`].
    pub what: &'static str,
    /// Texels in a row: [`ROW_TEXELS`] where `row_texel` of texels.wgsl finds them.
    pub width: u32,
    /// Texels row by row; zeros fill the last one.
    pub texels: Texels,
}

/// Texels of a [`Table`].
pub enum Texels {
    /// Of a `texture_2d<f32>`.
    Floats(Vec<[f32; 4]>),
    /// Of a `texture_2d<u32>`.
    Integers(Vec<[u32; 4]>),
    /// Of a `texture_2d<u32>` with one channel.
    Words(Vec<u32>),
}
