//! Pass: the light of gratings, and the energy that they take of the mirror's direction.
//!
//! Inputs: frame, scene, tables, gratings, surface points and materials. Output: for each group of samples one more chunk of sums, behind those of
//! all lists. One workgroup a group; one dispatch for each kind of light, and for as many lights as there is room for.

use crate::kind_passes::KindPasses;
use crate::pipelines::Orders;
use crate::shaders;
use crate::variant::Constant;

/// The passes; with `PICKS` they pick gratings in place of lighting them.
pub(crate) fn kinds(orders: &mut Orders, name: &'static str, more: &[Constant]) -> KindPasses {
    let module = (&shaders::SHADE_GRATINGS, "shade_gratings");
    KindPasses::new(orders, name, module, more)
}
