//! Pass: the light of gratings, and the energy that they take of the mirror's direction.
//!
//! Inputs: frame, scene, tables, gratings, surface points and materials. Output: for each group of samples one more chunk of sums, behind those of
//! all lists. One workgroup a group; one dispatch for each kind of light, and for as many lights as there is room for.

use crate::film::Film;
use crate::kind_passes::KindPasses;
use crate::pass_bindings::ShadeGratings;
use crate::pipelines::Orders;
use crate::scene_data::SceneData;
use crate::strip::StripBuffers;
use crate::variant::Constant;

/// The passes; with `PICKS` they pick gratings in place of lighting them.
pub(crate) fn kinds(
    orders: &mut Orders,
    name: &'static str,
    more: &[Constant],
) -> KindPasses<ShadeGratings<'static>> {
    KindPasses::new(orders, name, ShadeGratings::SHADE_GRATINGS, more)
}

/// Bindings of a pass that writes sums, or picks.
pub(crate) fn bindings<'a>(
    scene: &'a SceneData,
    buffers: &'a StripBuffers,
    film: &'a Film,
    grating_words: &'a wgpu::Buffer,
) -> ShadeGratings<'a> {
    ShadeGratings {
        points: &buffers.samples.points,
        paints: &buffers.samples.paints,
        gratings: scene.buffers.gratings(),
        chunk_starts: &buffers.samples.chunk_starts,
        grating_words,
        film: &film.buffer,
        range: &scene.light_ranges.buffer,
    }
}
