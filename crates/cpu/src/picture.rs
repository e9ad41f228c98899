//! Pictures on lights: look-ups, and how a point sees them. Twin: picture_light.wgsl.

use glam::{DVec2, DVec3};
use hairline_optics::irradiance::irradiance_polygon;
use hairline_optics::ltc::{LobeFresnel, LtcLobe, ltc_small_light, ltc_vector};
use hairline_optics::picture::{
    PICTURE_PARTS, PictureLook, PicturePlane, picture_lod, picture_part_spread, picture_part_uv,
};
use hairline_scene::Texture;

/// A picture on a light, as seen from a point.
#[derive(Clone, Copy)]
pub(crate) struct PictureView<'a> {
    texture: &'a Texture,
    plane: PicturePlane,
    /// Variance of the band about a chord, in direction cosines, at q = 0 and for each q²: the picture on a line in the band's
    /// middle is blurred by it.
    across_variance: [f64; 2],
}

impl<'a> PictureView<'a> {
    /// Makes the plane of a picture on a light; `corners` are the light's, relative to the point, in the frame of its surface.
    pub fn new(texture: &'a Texture, corners: &[DVec3]) -> Self {
        Self {
            texture,
            plane: PicturePlane::from_corners(corners),
            across_variance: [0.0; 2],
        }
    }

    /// The picture for chords that stand for a band, by the band's variance at q = 0 and for each q².
    pub(crate) fn with_across_variance(self, across_variance: [f64; 2]) -> Self {
        Self {
            across_variance,
            ..self
        }
    }

    fn radiance(&self, look: PictureLook) -> DVec3 {
        let size_px = self.texture.size_px.map(f64::from).into();
        picture_radiance(
            self.texture,
            look.uv,
            picture_lod(look.spread, size_px),
            WHOLE,
        )
    }

    /// Mean of the picture in the reflection of a lobe.
    pub(crate) fn on_lobe(&self, lobe: &LtcLobe, of: &LobeFresnel) -> DVec3 {
        self.mean(|part| {
            let vector = ltc_vector(lobe, &part.corners());
            let reflected = ltc_small_light(lobe, of, vector);
            (reflected.into(), part.picture_on_lobe(lobe, vector))
        })
    }

    /// Mean of the picture in the irradiance of a diffuse body.
    pub(crate) fn on_body(&self) -> DVec3 {
        self.mean(|part| {
            let vector = irradiance_polygon(&part.corners());
            (DVec3::splat(vector.z), part.picture_look(vector))
        })
    }

    /// Mean over the parts of the picture, by a weight and a look-up of each.
    fn mean(&self, seen: impl Fn(&PicturePlane) -> (DVec3, PictureLook)) -> DVec3 {
        let size_px = DVec2::from(self.texture.size_px.map(f64::from));
        let share = 1.0 / PICTURE_PARTS as f64;
        let (mut mean, mut weights) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..PICTURE_PARTS * PICTURE_PARTS {
            let (weight, look) = seen(&self.plane.picture_part(i));
            if weight.max_element() > 0.0 {
                let spread = picture_part_spread(look.spread);
                let low = picture_part_uv(i);
                let (uv, lod) = (low + look.uv * share, picture_lod(spread, size_px));
                let range = [low, low + share];
                let radiance = picture_radiance(self.texture, uv, lod, range);
                weights += weight;
                mean += (radiance - mean) * (weight / weights.max(DVec3::splat(1e-300)));
            }
        }
        mean
    }

    /// Colour of the picture for a part of a chord with its middle at q. `directions` are those of the part's ends and its
    /// middle.
    pub(crate) fn on_chord(&self, directions: [DVec3; 3], q: f64) -> DVec3 {
        let [middle, per_q2] = self.across_variance;
        let across_std = (middle + per_q2 * q * q).max(0.0).sqrt();
        self.radiance(self.plane.picture_on_chord(directions, across_std))
    }
}

/// The mean of all of a picture.
pub(crate) fn picture_mean(texture: &Texture) -> DVec3 {
    texture
        .at_level(texture.levels.len() - 1, DVec2::splat(0.5), 0.0)
        .truncate()
}

/// Corners of a whole picture.
pub(crate) const WHOLE: [DVec2; 2] = [DVec2::ZERO, DVec2::ONE];

/// A trilinear look-up that ends at the edges of a range.
pub(crate) fn picture_radiance(
    texture: &Texture,
    uv: DVec2,
    lod: f64,
    [low, high]: [DVec2; 2],
) -> DVec3 {
    let lod = lod.min((texture.levels.len() - 1) as f64);
    let at = |level: f64| {
        let size_px = texture
            .size_px
            .map(|n| f64::from((n >> level as u32).max(1)));
        let half = (0.5 / DVec2::from(size_px)).min(0.5 * (high - low));
        texture
            .at_level(level as usize, uv.clamp(low + half, high - half), 0.0)
            .truncate()
    };
    at(lod.floor()).lerp(at(lod.ceil()), lod.fract())
}
