//! The passes over a scene, by the method and the scene's contents.

use crate::bin::BinPasses;
use crate::bindings::Layouts;
use crate::compute_pass::{ComputePass, Recording, Workgroups, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::kind_passes::KindPasses;
use crate::pass_bindings::{
    Edges, EntryPoint, OtherMethod, Resolve, ShadeBase, ShadeGratings, ShareScratches, Surface,
    WithTables,
};
use crate::pipelines::Orders;
use crate::shade_gratings;
use crate::shade_scratches::ShadeScratchesPass;
use crate::sizes::{self, CHUNKS, ENTRIES, GROUPS, SizesPass};
use crate::strip::StripBuffers;
use crate::variant::{RayOrigin, ShadeVariant};

/// Passes that are compiled for a method and a scene's contents.
pub(crate) struct ScenePasses {
    edges: ComputePass<Edges<'static>>,
    /// Sizes by the number of entries, of groups and of chunks.
    pub sizes: [SizesPass; 3],
    surface: ComputePass<Surface<'static>>,
    pub shade: Shade,
    pub resolve: ComputePass<Resolve<'static>>,
}

/// Passes that shade base and scratches.
pub(crate) enum Shade {
    /// Hairline's own method.
    Own {
        base: ComputePass<ShadeBase<'static>>,
        /// Passes for scratches; none where the scene has none.
        scratches: Option<Box<ScratchPasses>>,
        /// Pass for gratings; none where the scene has none.
        gratings: Option<KindPasses<ShadeGratings<'static>>>,
    },
    /// One of others, which does without tile lists.
    Other(ComputePass<WithTables<'static>>),
}

pub(crate) struct ScratchPasses {
    pub bin: BinPasses,
    share: ComputePass<ShareScratches<'static>>,
    pub shade: ShadeScratchesPass,
}

impl ScenePasses {
    /// Passes of tile lists, if scratches are shaded by them.
    pub(crate) fn scratches(&self) -> Option<&ScratchPasses> {
        match &self.shade {
            Shade::Own { scratches, .. } => scratches.as_deref(),
            Shade::Other(_) => None,
        }
    }

    /// Number of chunks of sums that gratings need behind those of scratches, for `groups` groups.
    pub(crate) fn grating_chunks(&self, groups: u32) -> u32 {
        match &self.shade {
            Shade::Own {
                gratings: Some(_), ..
            } => groups,
            _ => 0,
        }
    }

    /// Compiles the passes that the device does not have yet.
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        variant: &ShadeVariant,
    ) -> Result<Self, Error> {
        let mut orders = Orders::new(gpu, layouts, variant);
        let shade = if let Some(other) = &variant.method.other {
            let module = other.module();
            let name = module.name.rsplit('/').next().unwrap_or(module.name);
            Shade::Other(orders.pass(name, EntryPoint::new(module, name)))
        } else {
            Shade::Own {
                base: orders.pass("base", ShadeBase::SHADE_BASE),
                scratches: variant.has.scratches.then(|| {
                    Box::new(ScratchPasses {
                        bin: BinPasses::new(&mut orders),
                        share: orders.pass("share scratches", ShareScratches::SHARE_SCRATCHES),
                        shade: ShadeScratchesPass::new(&mut orders, RayOrigin::ByCamera),
                    })
                }),
                gratings: (variant.has.gratings)
                    .then(|| shade_gratings::kinds(&mut orders, "gratings", &[])),
            }
        };
        let passes = Self {
            sizes: [ENTRIES, GROUPS, CHUNKS]
                .map(|counted| sizes::pass(&mut orders, counted, RayOrigin::ByCamera)),
            edges: orders.pass("edges", Edges::EDGES),
            surface: orders.pass("surface", Surface::SURFACE),
            resolve: orders.pass("resolve", Resolve::RESOLVE),
            shade,
        };
        orders.compile().await?;
        Ok(passes)
    }
}

impl ScenePasses {
    /// Numbers the pixels with edges of so many tiles.
    pub(crate) fn record_edges(
        &self,
        recording: &mut Recording,
        buffers: &StripBuffers,
        film: &Film,
        tiles: u32,
    ) {
        let bound = Edges {
            film: &film.buffer,
            group_starts: &buffers.group_starts,
        };
        self.edges.run(recording, &bound, &in_a_row(tiles));
    }

    /// Finds the surface points of the pixels of so many rows.
    pub(crate) fn record_surface(
        &self,
        recording: &mut Recording,
        buffers: &StripBuffers,
        film: &Film,
        rows: u32,
    ) {
        let bound = Surface {
            visibility: &buffers.visibility,
            points: &buffers.samples.points,
            paints: &buffers.samples.paints,
            group_starts: &buffers.group_starts,
            film: &film.buffer,
        };
        self.surface.run(recording, &bound, &buffers.tiles(rows));
    }

    /// Adds base and scratches of the pixels of so many rows to the film.
    pub(crate) fn record_resolve(
        &self,
        recording: &mut Recording,
        buffers: &StripBuffers,
        film: &Film,
        rows: u32,
    ) {
        let samples = &buffers.samples;
        let bound = Resolve {
            points: &samples.points,
            base_light: &samples.base_light,
            group_starts: &buffers.group_starts,
            chunk_starts: &samples.chunk_starts,
            chunk_sums: &samples.chunk_sums,
            film: &film.buffer,
        };
        self.resolve.run(recording, &bound, &buffers.tiles(rows));
    }
}

impl ScratchPasses {
    /// Finds the samples of the pixels of so many rows of which one has the scratches for all.
    pub(crate) fn record_share(
        &self,
        recording: &mut Recording,
        buffers: &StripBuffers,
        film: &Film,
        rows: u32,
    ) {
        let bound = ShareScratches {
            points: &buffers.samples.points,
            paints: &buffers.samples.paints,
            group_starts: &buffers.group_starts,
            film: &film.buffer,
        };
        self.share.run(recording, &bound, &buffers.tiles(rows));
    }
}

impl Shade {
    /// The light of the base and of gratings; of a method of others, all light.
    pub(crate) fn record(
        &self,
        recording: &mut Recording,
        buffers: &StripBuffers,
        film: &Film,
        groups: &Workgroups,
    ) {
        let (scene, samples) = (recording.scene, &buffers.samples);
        match self {
            Self::Own { base, gratings, .. } => {
                let bound = ShadeBase {
                    points: &samples.points,
                    paints: &samples.paints,
                    base_light: &samples.base_light,
                    film: &film.buffer,
                };
                base.run(recording, &bound, groups);
                if let Some(gratings) = gratings {
                    let sums = &samples.chunk_sums;
                    let bound = shade_gratings::bindings(scene, buffers, film, sums);
                    gratings.run(recording, &bound, groups);
                }
            }
            Self::Other(pass) => {
                let arrays = OtherMethod {
                    points: &samples.points,
                    paints: &samples.paints,
                    base_light: &samples.base_light,
                    chunk_sums: &samples.chunk_sums,
                    film: &film.buffer,
                };
                let tables = &scene.method_tables;
                pass.run(recording, &WithTables { arrays, tables }, groups);
            }
        }
    }
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
