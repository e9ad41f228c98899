//! Maps in the box, made by code.

use glam::DVec3;
use hairline_image::Picture;
use serde::Serialize;

/// An environment that needs no file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum BuiltInMap {
    /// Soft boxes around and a strip above, in a dark room.
    Studio,
    /// A window with bars in a dim room.
    Window,
    /// A grey sky over dark ground.
    Overcast,
}

/// Width and height in a scene.
pub const SIZE_PX: [u32; 2] = [256, 128];

impl BuiltInMap {
    /// Every map, in the order of a menu.
    pub const ALL: [Self; 3] = [Self::Studio, Self::Window, Self::Overcast];

    /// The map, rows from above: equirectangular linear radiance.
    pub fn picture(self, size_px: [u32; 2]) -> Picture {
        let [width, height] = size_px.map(f64::from);
        let mut picture = Picture::new(size_px);
        for (i, rgb) in picture.rgb.iter_mut().enumerate() {
            let (x, y) = (i as u32 % size_px[0], i as u32 / size_px[0]);
            let azimuth_deg = (f64::from(x) + 0.5) / width * 360.0 - 180.0;
            let elevation_deg = 90.0 - (f64::from(y) + 0.5) / height * 180.0;
            *rgb = self
                .radiance(azimuth_deg, elevation_deg)
                .as_vec3()
                .to_array();
        }
        picture
    }

    fn radiance(self, azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
        let at = |middle: [f64; 2], size: [f64; 2], edge: f64| {
            let away = (azimuth_deg - middle[0] + 540.0).rem_euclid(360.0) - 180.0;
            let inside = |offset: f64, size: f64| step(-edge, edge, 0.5 * size - offset.abs());
            inside(away, size[0]) * inside(elevation_deg - middle[1], size[1])
        };
        match self {
            Self::Studio => {
                let room = DVec3::splat(0.09 + 0.13 * step(-70.0, 70.0, elevation_deg));
                let boxes = [
                    ([0.0, 38.0], [52.0, 40.0], DVec3::new(7.0, 7.0, 7.0)),
                    ([125.0, 25.0], [36.0, 56.0], DVec3::new(4.6, 5.0, 5.6)),
                    ([-120.0, 30.0], [24.0, 60.0], DVec3::new(5.4, 5.0, 4.4)),
                    ([62.0, 58.0], [14.0, 44.0], DVec3::new(3.2, 3.2, 3.2)),
                ];
                let lit = boxes.map(|(middle, size, radiance)| radiance * at(middle, size, 1.2));
                let above = DVec3::splat(2.2) * step(72.0, 76.0, elevation_deg);
                room + lit.into_iter().sum::<DVec3>() + above
            }
            Self::Window => {
                let room =
                    DVec3::new(0.16, 0.138, 0.115) * (0.6 + 0.4 * step(-40.0, 50.0, elevation_deg));
                let floor = DVec3::new(0.05, 0.036, 0.024) * step(-12.0, -30.0, elevation_deg);
                let panes: f64 = [-13.0, 13.0]
                    .into_iter()
                    .flat_map(|x| [8.0, 36.0].map(|y| at([x, y], [23.0, 25.0], 0.8)))
                    .sum();
                // The sky is brighter above.
                let sky =
                    DVec3::new(7.4, 8.6, 10.0) * (0.75 + 0.25 * step(0.0, 50.0, elevation_deg));
                room + floor + sky * panes
            }
            Self::Overcast => {
                // Moon and Spencer, 1942, the standard overcast sky of the CIE.
                let sin = elevation_deg.to_radians().sin();
                let sky = DVec3::new(0.96, 1.0, 1.06) * ((1.0 + 2.0 * sin.max(0.0)) / 3.0);
                let ground = DVec3::new(0.1, 0.095, 0.085);
                ground.lerp(sky, step(-1.5, 1.5, elevation_deg))
            }
        }
    }
}

/// Smooth step from 0 at `from` to 1 at `to`, which may be the smaller one.
fn step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_are_lit_and_close() {
        for map in BuiltInMap::ALL {
            let picture = map.picture([64, 32]);
            let mean: f32 = picture.rgb.iter().flatten().sum::<f32>() / (3.0 * 64.0 * 32.0);
            assert!((0.2..2.0).contains(&mean), "{map:?}: {mean}");
            let values = || picture.rgb.iter().flatten();
            assert!(values().all(|value| *value > 0.0 && value.is_finite()));
            // No seam where the map closes.
            for row in picture.rgb.chunks(64) {
                assert!((row[0][1] - row[63][1]).abs() < 0.2, "{map:?}");
            }
        }
    }
}
