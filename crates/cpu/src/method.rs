//! The place of a method of others, which shades scratches and the spheres on the base point by point: in the place of stages 3 to 5 and
//! of a part of stage 6. `hairline-published` takes it.

use crate::prepared::Prepared;
use crate::surface::SurfacePoint;
use hairline_index::Hit;
use hairline_optics::ltc::{LobeFresnel, LtcLobe};
use hairline_optics::mask::{Mask, Masked};

pub use crate::base_layer::SphereOnLobe;
pub use crate::gather::gather;
pub use crate::light_view::{LightView, LightViews};

/// A method of shading.
pub trait ShadingMethod: Send + Sync {
    /// Makes ready what the points of a picture look up.
    fn prepare<'a>(&self, prepared: &'a Prepared<'a>, mask: Mask) -> Box<dyn PointShader + 'a>;
}

/// A method that is ready for the points of a picture.
pub trait PointShader: Sync {
    /// Radiance of all scratches under the point's footprint, and the energy that they take from the base.
    fn scratches(&self, point: &SurfacePoint, hit: &Hit, views: &LightViews) -> Masked;

    /// Light that a lobe reflects of a sphere, single scattering, over the sphere's radiance.
    fn base_sphere(&self, lobe: &LtcLobe, of: &LobeFresnel, sphere: &SphereOnLobe) -> [f64; 3];
}
