//! Parts of a pixel under a normal map. Slopes of bumps are no Gaussian over a pixel: its base is the mean over places of the filter, each of which
//! is seen through a narrower one (docs/model.md, (28e)). Twin: pixel_parts.wgsl.

use crate::prepared::Prepared;
use crate::surface::{BumpSlopes, SeenHit, SurfacePoint, surface_with_bumps};
use glam::{DVec2, DVec3};
use hairline_index::Hit;
use hairline_optics::ggx::ggx_alpha;
use hairline_scene::CameraFrame;

/// Largest number of parts of a pixel.
pub(crate) const MOST_PARTS: usize = 25;

/// Spread of the slopes of a normal map over a pixel, over the alpha of its lobe, from which on it has parts, and from which on it has many.
const PARTS_SPREAD: f64 = 0.25;
const MANY_PARTS_SPREAD: f64 = 0.6;

/// A place of the filter.
struct Place {
    /// Standard deviations of the pixel's filter to the right and down.
    at_std: DVec2,
    weight: f64,
}

/// Number of places along each axis of the filter: 1 where the pixel is a part itself. Odd: an even number has none in the middle, where lights would
/// be 8 to 14 % too faint.
fn places_along(point: &SurfacePoint) -> usize {
    let of_lobe = |slope_std: f64, roughness: f64| {
        let alpha = ggx_alpha(roughness);
        if slope_std > MANY_PARTS_SPREAD * alpha {
            5
        } else if slope_std > PARTS_SPREAD * alpha {
            3
        } else {
            1
        }
    };
    let coat = point.coat.filter(|coat| coat.weight > 0.0);
    let of_coat = coat.map_or(1, |coat| of_lobe(coat.slope_std, coat.roughness));
    of_lobe(point.slope_std, point.roughness).max(of_coat)
}

/// Standard deviation of the filter of each place, over that of the pixel's: with steps of twice that and binomial weights they add up to it.
fn place_std(along: usize) -> f64 {
    1.0 / (along as f64).sqrt()
}

/// All places of a filter.
fn places(along: usize) -> impl Iterator<Item = Place> {
    let middle = 0.5 * (along - 1) as f64;
    let weights: &[f64] = match along {
        3 => &[0.25, 0.5, 0.25],
        _ => &[0.0625, 0.25, 0.375, 0.25, 0.0625],
    };
    (0..along * along).map(move |i| {
        let place = [i % along, i / along];
        let at = DVec2::from(place.map(|i| i as f64));
        Place {
            at_std: 2.0 * place_std(along) * (at - middle),
            weight: weights[place[0]] * weights[place[1]],
        }
    })
}

/// Parts of the surface at a hit that a sample sees through a filter of `std_px`, with their weights; none if one point stands for all.
pub(crate) fn pixel_parts<'a>(
    prepared: &'a Prepared<'a>,
    camera: &CameraFrame,
    hit: &Hit,
    point: &SurfacePoint<'a>,
    std_px: f64,
) -> Vec<(f64, SurfacePoint<'a>)> {
    let along = places_along(point);
    if along == 1 {
        return Vec::new();
    }
    let Prepared { scene, tables, .. } = prepared;
    let mesh = &scene.objects[hit.object as usize].mesh;
    // How the point moves in the plane of a unit normal.
    let axes_m = |position_m: DVec3, normal: DVec3, std_px: f64| {
        let from_camera_m = position_m - camera.position_m;
        let depth_m = from_camera_m.dot(camera.forward);
        let axes = camera.footprint_axes(from_camera_m / depth_m, depth_m, normal);
        axes.map(|axis| axis * std_px)
    };
    let [right_m, down_m] = axes_m(point.position_m, point.facet, std_px);
    let part = |place: Place| {
        let step_m = right_m * place.at_std.x + down_m * place.at_std.y;
        let position_m = point.position_m + step_m;
        let from_camera_m = position_m - camera.position_m;
        // Beyond its edges the triangle goes on.
        let step = mesh.barycentric_step(hit.triangle, step_m);
        let [u, v] = hit.barycentric;
        let hit = Hit {
            distance_m: from_camera_m.length(),
            barycentric: [u + step.x, v + step.y],
            ..*hit
        };
        let std_px = place_std(along) * std_px;
        let narrow = |normal| axes_m(position_m, normal, std_px);
        let seen = SeenHit {
            hit: &hit,
            position_m,
            to_viewer: -from_camera_m.normalize(),
        };
        let part = surface_with_bumps(scene, tables, &seen, narrow, BumpSlopes::Turns);
        (place.weight, part)
    };
    places(along).map(part).collect()
}
