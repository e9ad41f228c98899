//! Good places to start from.

use hairline_optics::metal::Metal;
use hairline_scene::description::{Material, MaterialKind, MetalColor};

/// Polished stainless steel.
pub fn plain_steel() -> Material {
    Material {
        name: "steel".to_owned(),
        kind: MaterialKind::Metal(MetalColor::Measured(Metal::StainlessSteel)),
        roughness: 0.06,
        coherence_um: 20.0,
    }
}
