//! Which scratches of a tile no light can reach, told for the whole of a piece at once and not place by place: where lamps are small
//! most are dark.

use super::tile::STATION_STD;
use crate::closed_form::SeenSurface;
use crate::light_view::LightViews;
use glam::{DVec2, DVec3};
use hairline_optics::band::{BAND_REACH_STD, band_stds};
use std::f64::consts::SQRT_2;

/// How many standard deviations of a pixel's filter a band is shifted by how it moves over it, and its variance likewise (docs/model.md,
/// section 5): a place of a scratch is within [`STATION_STD`] of its pixel, and what it is off along the scratch and across it adds up.
const SHIFT_STDS: f64 = SQRT_2 * STATION_STD;
const VARIANCE_SHARE: f64 = 1.25;

/// Pixels whose normals are no farther apart see a dark scratch alike, but for perspective.
const PLANE_TURN: f64 = 0.01;

/// The bands of all scratches of one direction under an object's pixels, against all lights that these see.
#[derive(Default)]
pub(super) struct Darkness {
    lights: Vec<LightBounds>,
    normals: Bounds,
    has_pixels: bool,
    /// Whether all pixels see as many lights.
    is_known: bool,
}

/// One light from all the pixels.
struct LightBounds {
    /// Component of the sum of the directions to the viewer and to the light's middle in the plane of the surface, world space.
    sum: Bounds,
    /// The same of the light's direction alone.
    axis: Bounds,
    /// Of its cap: the least cosine of the radius, and how far the band's middle line may be off `sum`, at most.
    cos_radius: f64,
    reach: f64,
}

/// A box.
#[derive(Clone, Copy)]
struct Bounds {
    lower: DVec3,
    upper: DVec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self::NONE
    }
}

impl Bounds {
    const NONE: Self = Self {
        lower: DVec3::INFINITY,
        upper: DVec3::NEG_INFINITY,
    };

    fn add(&mut self, at: DVec3) {
        self.lower = self.lower.min(at);
        self.upper = self.upper.max(at);
    }

    /// The range of the component in a direction.
    fn along(&self, direction: DVec3) -> [f64; 2] {
        let middle = 0.5 * (self.lower + self.upper).dot(direction);
        let half = 0.5 * (self.upper - self.lower).dot(direction.abs());
        [middle - half, middle + half]
    }
}

fn largest([low, high]: [f64; 2]) -> f64 {
    low.abs().max(high.abs())
}

impl Darkness {
    /// Before the pixels of an object.
    pub fn clear(&mut self) {
        self.lights.clear();
        self.normals = Bounds::NONE;
        self.has_pixels = false;
        self.is_known = false;
    }

    /// Adds a pixel, with the lights as it sees them.
    pub fn add(&mut self, seen: &SeenSurface, views: &LightViews) {
        if !self.has_pixels {
            let none = || LightBounds {
                sum: Bounds::NONE,
                axis: Bounds::NONE,
                cos_radius: 1.0,
                reach: 0.0,
            };
            self.lights.resize_with(views.views.len(), none);
            self.has_pixels = true;
            self.is_known = true;
        }
        self.is_known &= self.lights.len() == views.views.len();
        let point = &seen.point;
        self.normals.add(point.normal);
        let in_plane = |v: DVec2| point.axis_x * v.x + point.axis_y * v.y;
        let std = band_stds(point.coherence_um).mean;
        // Which light it is, does not matter: all that are seen are among those that are bounded.
        for ((bounds, view), moves) in self.lights.iter_mut().zip(&views.views).zip(&views.moves) {
            let cap = view.bound();
            let axis = in_plane(cap.axis.truncate());
            let moved = moves[0].length().hypot(moves[1].length());
            let reach = cap.sin_radius
                + SHIFT_STDS * moved
                + BAND_REACH_STD * (std * std + VARIANCE_SHARE * moved * moved).sqrt();
            bounds
                .sum
                .add(in_plane(point.wo.truncate()) + axis * cap.cos_radius);
            bounds.axis.add(axis);
            bounds.cos_radius = bounds.cos_radius.min(cap.cos_radius);
            bounds.reach = bounds.reach.max(reach);
        }
    }

    /// Whether no light reaches any scratch of a direction (of unit length, world space) by way of any of the pixels. False if that is
    /// not known.
    pub fn covers(&self, direction: DVec3) -> bool {
        // A pixel takes the part of the direction that is in its own plane, made longer to unit length: components grow.
        let sin = largest(self.normals.along(direction));
        let cos = (1.0 - sin * sin).max(0.0).sqrt();
        self.is_known
            && self.lights.iter().all(|light| {
                let [low, high] = light.sum.along(direction);
                (low > light.reach || high < -light.reach)
                    && largest(light.axis.along(direction)) < light.cos_radius * cos
            })
    }

    /// Whether all pixels have nearly one normal.
    pub fn is_plane(&self) -> bool {
        self.normals.lower.distance_squared(self.normals.upper) < PLANE_TURN * PLANE_TURN
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{Prepared, Seen, Way};
    use crate::scratches::{Pixel, Work};
    use crate::segment_view::{Groove, SegmentView};
    use hairline_optics::band::BandPlace;
    use hairline_optics::method::Method;
    use hairline_scene::Scene;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    fn scene(shape: &str) -> Scene {
        let text = format!(
            "[camera]\nposition_m = [0.0, -0.27, 0.22]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 4.0\n\
             [render]\nsize_px = [96, 64]\n\
             [[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n\
             [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {shape}\n\
             [[light]]\nkind = \"sphere\"\ncenter_m = [0.15, 0.3, 0.25]\nradius_m = 0.02\nradiance = 40.0\n\
             [[light]]\nkind = \"polygon\"\nvertices_m = [[-0.3, 0.0, 0.2], [-0.3, 0.02, 0.2], [-0.3, 0.0, 0.22]]\n\
             radiance = 20.0\ntwo_sided = true\n"
        );
        Scene::from_toml(&text, "test", ".").unwrap_or_else(|error| panic!("{error}"))
    }

    /// What the picture shows at a place, with the lights as they are seen from there.
    fn seen_at(way: &Way, scene: &Scene, middle: DVec2, views: &mut LightViews) -> SeenSurface {
        let camera = scene.camera.frame(scene.render.size_px);
        let std_px = scene.render.footprint_std_px(1);
        let Seen::Surface(seen) = way.look(&camera, std_px, middle, &mut views.rays) else {
            panic!("the object fills the picture");
        };
        look_from(&seen, views);
        seen
    }

    fn look_from(seen: &SeenSurface, views: &mut LightViews) {
        views.look_from(&seen.point);
        views.ready_for_scratches(&seen.point);
    }

    /// Random scratches at random pixels of a tile, on a plane and where normals turn: none that is said to be dark is lit, and most
    /// that are dark are said to be.
    #[test]
    fn no_light_reaches_what_is_dark() {
        for (shape, found) in [
            ("{ disk = { radius_m = 0.04 } }", 0.8),
            ("{ sphere = { radius_m = 0.03 } }", 0.1),
        ] {
            let scene = scene(shape);
            let prepared = Prepared::new(&scene);
            let way = Way::new(&prepared, Method::default());
            let mut views = LightViews::new(&scene);
            let mut darkness = Darkness::default();
            let mut pixels = Vec::new();
            for i in 0..6 * 6 {
                let middle = DVec2::new(40.5 + f64::from(i % 6), 24.5 + f64::from(i / 6));
                let seen = seen_at(&way, &scene, middle, &mut views);
                darkness.add(&seen, &views);
                pixels.push(seen);
            }
            let mut random = Pcg64Mcg::seed_from_u64(1);
            let (mut dark, mut told) = (0, 0);
            for _ in 0..2000 {
                let facet = pixels[random.random_range(0..pixels.len())].point.facet;
                let turn = random.random_range(0.0..std::f64::consts::TAU);
                let (x, y) = facet.any_orthonormal_pair();
                let direction = x * turn.cos() + y * turn.sin();
                let mut work = Work::default();
                let light: DVec3 = pixels
                    .iter()
                    .map(|seen| {
                        let point = &seen.point;
                        views.look_from(point);
                        views.ready_for_scratches(point);
                        let pixel = Pixel::new(point);
                        let tangent = point.surface_from_world(direction).truncate().normalize();
                        let groove = Groove {
                            table: &prepared.tables.tables[point.table],
                            width_um: 3.0,
                            depth_nm: 200.0,
                            moved: [0.0; 2],
                            share: 1.0,
                        };
                        let place = BandPlace::new([0.0; 2], 0.0, pixel.frame.window_um2);
                        SegmentView::new(&pixel, tangent, [groove], place)
                            .lights(&pixel, &views, &mut work)
                    })
                    .sum();
                let covered = darkness.covers(direction);
                assert!(!covered || light == DVec3::ZERO, "{shape}: {light}");
                dark += usize::from(light == DVec3::ZERO);
                told += usize::from(covered);
            }
            assert!(
                told as f64 > found * dark as f64,
                "{shape}: {told} of {dark}"
            );
        }
    }

    /// Where a light has set for one of the pixels, nothing is said about any scratch.
    #[test]
    fn lights_that_only_some_pixels_see_are_not_judged() {
        let scene = scene("{ disk = { radius_m = 0.04 } }");
        let prepared = Prepared::new(&scene);
        let way = Way::new(&prepared, Method::default());
        let mut views = LightViews::new(&scene);
        let mut darkness = Darkness::default();
        let mut seen = seen_at(&way, &scene, DVec2::new(48.5, 32.5), &mut views);
        darkness.add(&seen, &views);
        assert_eq!(views.views.len(), 2);
        let directions: Vec<DVec3> = (0..64)
            .map(|i| {
                let (y, x) = (f64::from(i) * std::f64::consts::PI / 64.0).sin_cos();
                DVec3::new(x, y, 0.0)
            })
            .filter(|direction| darkness.covers(*direction))
            .collect();
        assert!(directions.len() > 10);
        let point = &mut seen.point;
        (point.axis_y, point.normal) = (-point.axis_y, -point.normal);
        look_from(&seen, &mut views);
        darkness.add(&seen, &views);
        assert!(views.views.len() < 2);
        assert!(
            directions
                .iter()
                .all(|direction| !darkness.covers(*direction))
        );
    }
}
