//! A tile of pixels, its surfaces, and the scratches on them.

use super::TILE_PX;
use super::dark::Darkness;
use super::line::{Line, Reach};
use super::stations::{FlatWeights, Station, Stations};
use super::sums::{AddPiece, TileSums};
use super::weigh::{Flat, LANES, Piece, PixelLanes};
use crate::bundles;
use crate::closed_form::{Picture, Sample, Seen, SeenSurface};
use crate::light_view::LightViews;
use crate::scratches::{Pixel, PixelFrame, Work, gather_reach_m};
use crate::segment_view::{Part, Sides};
use glam::{DVec2, DVec3, Vec3};
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::REACH_STD;
use hairline_optics::mask::ScratchSums;
use hairline_optics::method::{Gather, PixelFilter};
use hairline_optics::spectrum::WAVELENGTH_MEAN_NM;
use pulp::Arch;
use std::f64::consts::SQRT_2;

/// By how much the phase between both edges of a groove changes with a direction's sine, at the wavelength that stands for the visible.
const PHASE_PER_UM: f64 = std::f64::consts::TAU * 1e3 / WAVELENGTH_MEAN_NM;
/// The standard normal distribution at 0.
const PER_ROOT_TAU: f64 = 0.398_942_280_401_432_7;
/// A row of pixels and what lanes read beyond its end.
const STRIDE: usize = TILE_PX + LANES;

/// Segments that are shorter than this share of the footprint's standard deviation have their ends' error functions as a derivative.
const SHORT: f64 = 0.07;
/// A pixel's place on the surface is that of a scratch in the picture if it is within so many standard deviations.
pub(super) const STATION_STD: f64 = 6.0;
/// The reach of stations is this much longer, since pixels between them see the surface from elsewhere.
const MARGIN: f64 = 1.05;
const MARGIN_PX: f64 = 0.05;

/// Where normals turn by less from pixel to pixel, a plane stands for the surface about each place of a scratch.
const FLAT_TURN: f64 = 0.02;
/// Against a plane at less than this cosine, pixels' depths tell too little.
const FLAT_MIN_COS: f64 = 0.05;

/// Where an object's scratches lie that a tile may see.
struct Around {
    lower_m: DVec3,
    upper_m: DVec3,
    /// Of its points along the view axis.
    nearest_m: f64,
    /// How far any of its pixels sees a scratch.
    reach: Reach,
    /// Whether neighbours see it from the same side, and of the same kind.
    is_flat: bool,
}

/// The plane of the triangle that a pixel sees.
#[derive(Clone, Copy, Default)]
struct Facet {
    /// Unit, on either side.
    normal: DVec3,
    /// How the point where a ray meets it moves for a pixel to the right and down, in the surface's frame.
    steps_um: [DVec2; 2],
}

/// Room for a tile, to be filled again and again.
pub(super) struct Tile<'a> {
    picture: &'a Picture<'a>,
    arch: Arch,
    corner: [usize; 2],
    size: [usize; 2],
    /// What pixels see whose scratches are drawn, row by row.
    seen: Vec<Option<SeenSurface>>,
    /// What is seen there: of scratches' pixels alone.
    frames: Vec<PixelFrame>,
    facets: Vec<Facet>,
    views: Vec<LightViews<'a>>,
    /// Sums of what is not drawn: of grids, and of scratches that are added exactly.
    beside: Vec<ScratchSums>,
    lanes: PixelLanes,
    origin_m: DVec3,
    /// Of the object that is drawn.
    darkness: Darkness,
    sums: TileSums,
    /// Taken while a piece is drawn.
    stations: Option<Stations>,
    work: Work,
    single: LightViews<'a>,
}

impl<'a> Tile<'a> {
    pub fn new(picture: &'a Picture<'a>) -> Self {
        let pixels = TILE_PX * TILE_PX;
        let views = || LightViews::new(picture.way.prepared.scene);
        Self {
            picture,
            arch: Arch::new(),
            corner: [0; 2],
            size: [0; 2],
            seen: Vec::with_capacity(pixels),
            frames: vec![PixelFrame::default(); pixels],
            facets: vec![Facet::default(); pixels],
            views: std::iter::repeat_with(views).take(pixels).collect(),
            beside: Vec::with_capacity(pixels),
            lanes: PixelLanes::new(TILE_PX, STRIDE),
            origin_m: DVec3::ZERO,
            darkness: Darkness::default(),
            sums: TileSums::new(TILE_PX, STRIDE),
            stations: None,
            work: Work::default(),
            single: views(),
        }
    }

    /// The pixels of a tile, row by row.
    pub fn render(&mut self, corner: [usize; 2], size: [usize; 2]) -> Vec<Sample> {
        (self.corner, self.size) = (corner, size);
        let mut samples = self.look();
        self.sums.clear();
        let mut objects: Vec<u32> = self.seen.iter().flatten().map(|s| s.hit.object).collect();
        objects.sort_unstable();
        objects.dedup();
        for object in objects.into_iter().map(|object| object as usize) {
            if let Some(around) = self.around(object) {
                self.darken(object);
                self.draw(object, &around);
            }
        }
        for (i, seen) in self.seen.iter().enumerate() {
            let Some(seen) = seen else { continue };
            let way = self.picture.way;
            let mut sums = self.sums.of(self.lane(i));
            bundles::add_scaled(&mut sums, &self.beside[i], 1.0);
            let masked = sums.resolve(
                way.method.mask,
                f64::from(way.prepared.scratches.depth_coherence[seen.hit.object as usize]),
            );
            samples[i] = way.shade_surface(&masked, &seen.point, &self.views[i], seen.depth_m);
        }
        samples
    }

    /// Where a pixel is in the arrays of lanes.
    fn lane(&self, pixel: usize) -> usize {
        pixel / self.size[0] * STRIDE + pixel % self.size[0]
    }

    /// Looks through all pixels. Returns those that are done.
    fn look(&mut self) -> Vec<Sample> {
        let [width, height] = self.size;
        let picture = self.picture;
        let way = picture.way;
        let footprint_std_px = way.prepared.scene.render.footprint_std_px(1);
        self.seen.clear();
        self.beside.clear();
        let mut samples = vec![Sample::default(); width * height];
        for (i, sample) in samples.iter_mut().enumerate() {
            let [x, y] = [self.corner[0] + i % width, self.corner[1] + i / width];
            self.beside.push(ScratchSums::default());
            self.seen.push(None);
            let count = picture.samples_at(x, y);
            if count > 1 {
                *sample = picture.pixel(x, y, count, &mut self.single, &mut self.work);
                continue;
            }
            let middle = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let rays = &mut self.single.rays;
            match way.look(&picture.camera, footprint_std_px, middle, rays) {
                Seen::Background(radiance) => *sample = Sample::background(radiance),
                Seen::Surface(mut surface) => {
                    if let Some(alone) = way.alone(&surface.point) {
                        surface.point = alone;
                    }
                    self.seen[i] = Some(surface);
                }
            }
        }
        self.fill_lanes();
        samples
    }

    /// Fills the lanes with what is seen.
    fn fill_lanes(&mut self) {
        let way = self.picture.way;
        self.lanes.object.fill(0);
        let first = self.seen.iter().flatten().next();
        self.origin_m = first.map_or(DVec3::ZERO, |seen| seen.point.position_m);
        for i in 0..self.seen.len() {
            let at = self.lane(i);
            let Some(seen) = &self.seen[i] else { continue };
            let point = &seen.point;
            self.views[i].look_from(point);
            if !way.prepared.is_scratched(&seen.hit) {
                continue;
            }
            self.views[i].ready_for_scratches(point);
            let object = seen.hit.object as usize;
            let mut single_share = 1.0;
            if way.method.gather == Gather::Clusters {
                (self.beside[i], single_share) = bundles::gather_grids(
                    way.prepared,
                    point,
                    object,
                    &self.views[i],
                    &mut self.work,
                );
            }
            if !(single_share > 0.0) {
                continue;
            }
            let normal = point.facet;
            let ray = self.picture.camera.camera_ray(self.middle_px(i));
            let steps_m = self
                .picture
                .camera
                .footprint_axes(ray, seen.depth_m, normal);
            self.facets[i] = Facet {
                normal,
                steps_um: steps_m.map(|step| (point.surface_from_world(step) * 1e6).truncate()),
            };
            self.frames[i] = Pixel::new(point).frame;
            let lanes = &mut self.lanes;
            let at_um = (point.position_m - self.origin_m) * 1e6;
            let put = |arrays: &mut [Vec<f32>; 3], v: DVec3| {
                (0..3).for_each(|axis| arrays[axis][at] = v[axis] as f32);
            };
            lanes.object[at] = seen.hit.object + 1;
            put(&mut lanes.axis_x_um, point.axis_x * 1e6);
            put(&mut lanes.axis_y_um, point.axis_y * 1e6);
            put(&mut lanes.normal, point.normal);
            put(&mut lanes.covariance_um2, self.frames[i].covariance_um2);
            lanes.at_x_um[at] = at_um.dot(point.axis_x) as f32;
            lanes.at_y_um[at] = at_um.dot(point.axis_y) as f32;
            lanes.window_um2[at] = self.frames[i].window_um2 as f32;
            lanes.single_share[at] = single_share as f32;
            lanes.per_depth_m[at] = (1.0 / seen.depth_m) as f32;
        }
    }

    /// Where an object's scratches lie that the tile may see.
    fn around(&self, object: usize) -> Option<Around> {
        let mut around: Option<Around> = None;
        for (i, seen) in self.seen.iter().enumerate() {
            let Some(seen) = seen else { continue };
            if self.lanes.object[self.lane(i)] != object as u32 + 1 {
                continue;
            }
            let point = &seen.point;
            let reach_m = gather_reach_m(point);
            let (low, high) = (point.position_m - reach_m, point.position_m + reach_m);
            let around = around.get_or_insert(Around {
                lower_m: low,
                upper_m: high,
                nearest_m: f64::INFINITY,
                reach: Reach::default(),
                is_flat: true,
            });
            around.lower_m = around.lower_m.min(low);
            around.upper_m = around.upper_m.max(high);
            around.nearest_m = around.nearest_m.min(seen.depth_m);
            around.reach = around.reach.max(self.reach_of(i, seen));
            around.is_flat &= self.is_flat_at(i, seen);
        }
        around
    }

    /// Finds out which scratches of an object are dark.
    fn darken(&mut self, object: usize) {
        self.darkness.clear();
        // An environment shines on all.
        if self.picture.way.prepared.scene.environment.is_some() {
            return;
        }
        for (i, seen) in self.seen.iter().enumerate() {
            let Some(seen) = seen else { continue };
            if self.lanes.object[self.lane(i)] == object as u32 + 1 {
                self.darkness.add(seen, &self.views[i]);
            }
        }
    }

    /// Whether the neighbours to the right and below see nearly the same.
    fn is_flat_at(&self, i: usize, seen: &SeenSurface) -> bool {
        let [width, height] = self.size;
        let right = (i % width + 1 < width).then(|| i + 1);
        let below = (i / width + 1 < height).then(|| i + width);
        let near = right.into_iter().chain(below);
        near.filter_map(|j| self.seen[j].as_ref()).all(|near| {
            let turn = near.point.normal - seen.point.normal;
            near.hit.object != seen.hit.object
                || (turn.length_squared() < FLAT_TURN * FLAT_TURN
                    && near.point.coherence_um == seen.point.coherence_um)
        })
    }

    /// How far a pixel sees scratches, whichever way they run.
    fn reach_of(&self, i: usize, seen: &SeenSurface) -> Reach {
        let point = &seen.point;
        let camera = &self.picture.camera;
        let at = self.middle_px(i);
        let [x, y] = camera.footprint_axes(camera.camera_ray(at), seen.depth_m, point.normal);
        // The side of a pixel on the surface where it is narrowest: the least singular value of its two steps.
        let mean = 0.5 * (x.length_squared() + y.length_squared());
        let product = x.length_squared() * y.length_squared() - x.dot(y) * x.dot(y);
        let narrowest_m2 = product / (mean + (mean * mean - product).max(0.0).sqrt());
        let sigma_m = point.coherence_um * 1e-6;
        let filter = point.footprint_axes_m[0].length_squared() / x.length_squared();
        // Variance across: of the window; at ends: with what smooths them.
        let variances = [0.5, 1.2].map(|v| filter + v * sigma_m * sigma_m / narrowest_m2);
        Reach::new(f64::from(REACH_STD), [1.0; 2], variances)
    }

    /// Standard deviation of the pixel's filter, 0 for a pixel that is a point.
    fn filter_std_px(&self) -> f64 {
        let way = self.picture.way;
        match way.method.footprint {
            PixelFilter::Off => 0.0,
            _ => way.prepared.scene.render.footprint_std_px(1),
        }
    }

    /// The middle of a pixel of the tile in the picture.
    fn middle_px(&self, i: usize) -> DVec2 {
        DVec2::new(
            (self.corner[0] + i % self.size[0]) as f64 + 0.5,
            (self.corner[1] + i / self.size[0]) as f64 + 0.5,
        )
    }

    /// Draws an object's scratches.
    fn draw(&mut self, object: usize, around: &Around) {
        let picture = self.picture;
        let tree = &picture.way.prepared.scratches.tree;
        let (lower_m, upper_m) = (around.lower_m.as_vec3(), around.upper_m.as_vec3());
        let corner = DVec2::new(self.corner[0] as f64, self.corner[1] as f64);
        tree.walk(object, lower_m, upper_m, |segments| {
            for segment in &tree.segments[segments] {
                let ends = [segment.start_m, segment.end_m];
                let touches = ends[0].min(ends[1]).cmple(upper_m).all()
                    && ends[0].max(ends[1]).cmpge(lower_m).all();
                if !touches {
                    continue;
                }
                let line = Line::new(
                    &picture.camera,
                    corner,
                    ends.map(|end| end.as_dvec3()),
                    0.5 * around.nearest_m,
                );
                if let Some(line) = line {
                    self.draw_piece(object, segment, line, around);
                }
            }
        });
    }

    fn draw_piece(&mut self, object: usize, segment: &IndexedSegment, line: Line, around: &Around) {
        let Some(inside) = line.inside(self.size, around.reach) else {
            return;
        };
        let mut stations = self.stations.take().unwrap_or_default();
        // Beyond its ends a scratch is as at them.
        let inside = inside.map(|place| place.clamp(0.0, line.length_px));
        let along = (segment.end_m - segment.start_m).as_dvec3();
        if self.darkness.covers(along.normalize_or_zero()) {
            let is_plane = self.darkness.is_plane();
            stations.place_dark(inside, is_plane, |place| {
                self.station(object, segment, &line, place, true)
            });
        } else {
            stations.place(inside, |place| {
                self.station(object, segment, &line, place, false)
            });
        }
        if stations.is_empty() {
            self.add_exactly(object, segment, line, around.reach);
        } else {
            let reach = stations.reach();
            let flat = around.is_flat.then(|| self.flat(segment, &line, &stations));
            let piece = self.piece(object, segment, stations.are_short(), flat.flatten());
            self.arch.dispatch(AddPiece {
                sums: &mut self.sums,
                pixels: &self.lanes,
                piece: &piece,
                line,
                reach: Reach {
                    across_px: reach.across_px * MARGIN + MARGIN_PX,
                    ends_px: reach.ends_px * MARGIN + MARGIN_PX,
                },
                stations: &mut stations,
                size: self.size,
                stride: STRIDE,
            });
        }
        self.stations = Some(stations);
    }

    /// Pixel by pixel, where no station is seen: the object shows in a part of the tile only.
    fn add_exactly(&mut self, object: usize, segment: &IndexedSegment, line: Line, reach: Reach) {
        let way = self.picture.way;
        let environment = way.prepared.scene.environment.as_ref();
        let crossing = line.crossing(self.size[0], reach);
        for y in line.rows(self.size[1], reach) {
            let [begin, end] = crossing.columns(y);
            for x in begin..end {
                let i = y as usize * self.size[0] + x as usize;
                let at = self.lane(i);
                if self.lanes.object[at] != object as u32 + 1 {
                    continue;
                }
                let Some(surface) = &self.seen[i] else {
                    continue;
                };
                let pixel = Pixel {
                    point: &surface.point,
                    frame: self.frames[i],
                };
                let Some(seen) = pixel.see(segment) else {
                    continue;
                };
                let table = &way.prepared.tables.tables[surface.point.table];
                let radiance =
                    seen.radiance(&pixel, table, &self.views[i], environment, &mut self.work);
                let mut single = ScratchSums::default();
                seen.add(&pixel, table, radiance, &mut single);
                let share = f64::from(self.lanes.single_share[at]);
                bundles::add_scaled(&mut self.beside[i], &single, share);
            }
        }
    }

    fn piece(
        &self,
        object: usize,
        segment: &IndexedSegment,
        is_short: bool,
        flat: Option<Flat>,
    ) -> Piece {
        let local = |v: Vec3| (v.as_dvec3() - self.origin_m).as_vec3().to_array();
        Piece {
            object: object as u32 + 1,
            start_m: local(segment.start_m),
            end_m: local(segment.end_m),
            normal: segment.normal.to_array(),
            width_um: segment.width_um,
            blur_um2: segment.blur_um * segment.blur_um,
            is_short,
            flat,
        }
    }

    /// The plane of a piece in the picture.
    fn flat(&self, segment: &IndexedSegment, line: &Line, stations: &Stations) -> Option<Flat> {
        let camera = &self.picture.camera;
        let normal = stations.facet();
        let to_plane_m = normal.dot(segment.start_m.as_dvec3() - camera.position_m);
        let ray = camera.camera_ray(self.middle_px(0));
        let per_m = 1.0 / to_plane_m;
        let distance_m = (segment.start_m.as_dvec3() - camera.position_m).length();
        (to_plane_m.abs() > FLAT_MIN_COS * distance_m).then(|| Flat {
            per_depth_m: (normal.dot(ray) * per_m) as f32,
            steps: [camera.per_px_x, camera.per_px_y].map(|step| (normal.dot(step) * per_m) as f32),
            room: stations.depth_room() as f32,
            length_px: line.length_px as f32,
        })
    }

    /// What a piece sends at a place of its line, as the nearest pixel sees it. Nothing if it `is_dark` to all lights.
    fn station(
        &mut self,
        object: usize,
        segment: &IndexedSegment,
        line: &Line,
        place_px: f64,
        is_dark: bool,
    ) -> Option<Station> {
        let at = line.at(place_px);
        let nearest = |x: f64, size: usize| ((x + 0.5) as usize).min(size - 1);
        let [x, y] = [nearest(at.x, self.size[0]), nearest(at.y, self.size[1])];
        let i = y * self.size[0] + x;
        if self.lanes.object[y * STRIDE + x] != object as u32 + 1 {
            return None;
        }
        let SeenSurface { point, depth_m, .. } = self.seen[i].as_ref()?;
        let pixel = Pixel {
            point,
            frame: self.frames[i],
        };
        let on_line = pixel.line(segment, STATION_STD)?;
        let footprint = on_line.footprint;
        let variances_um2 = [
            footprint.across_um2 + pixel.frame.window_um2,
            footprint.along_um2 + on_line.blur_um * on_line.blur_um,
        ];
        let length_um = on_line.end_um - on_line.start_um;
        let slant = footprint.cross_um2 / variances_um2[0];
        let along_um2 = (variances_um2[1] - footprint.cross_um2 * slant).max(0.0);
        // On the plane that the piece lies in.
        let Facet { normal, steps_um } = self.facets[i];
        let [across, along] =
            [line.along.perp(), line.along].map(|d| steps_um[0] * d.x + steps_um[1] * d.y);
        let tangent = on_line.tangent;
        let [across_um, along_um] = [tangent.perp_dot(across), tangent.dot(along)];
        let skew = (across_um * slant - tangent.dot(across)) / along_um;
        // The place that the pixel sees in the mean. One that is a point sees its own alone.
        let of_pixel = DVec2::new(x as f64, y as f64);
        let pixel_px = line.place_px(of_pixel) - skew * line.aside_px(of_pixel);
        let filter_std_px = self.filter_std_px();
        let place_px = if filter_std_px > 0.0 {
            place_px
        } else {
            pixel_px
        };
        let way = self.picture.way;
        let table = &way.prepared.tables.tables[point.table];
        let (mut radiance, mut sides) = (DVec3::ZERO, Sides::default());
        if !is_dark {
            let step = line.along / filter_std_px.max(1e-9);
            let ahead = step * (place_px - pixel_px);
            let part = Part {
                // The variance of what a normal distribution and an even one over the length have in common, about.
                seen_along: 1.0 / (1.0 + 12.0 * along_um2 / (length_um * length_um)),
                ahead: ahead.to_array(),
            };
            let view = on_line.view(&pixel, table).at(part);
            (radiance, sides) = view.lights_and_sides(&pixel, &self.views[i], step, &mut self.work);
            if let Some(environment) = &way.prepared.scene.environment {
                radiance += view.environment(&pixel, environment);
            }
        }
        let per_std = 1.0 / variances_um2[0].sqrt();
        let has_turn = filter_std_px > 0.0 && way.prepared.scene.environment.is_none();
        Some(Station {
            place_px,
            phase_per_px: has_turn.then_some(PHASE_PER_UM * on_line.width_um * sides.turn),
            radiance,
            energy: on_line.energy(&pixel, table).into(),
            sides,
            reach: Reach::new(f64::from(REACH_STD), [across_um, along_um], variances_um2),
            weights: FlatWeights {
                stds_per_px: across_um * per_std,
                middle: on_line.width_um * per_std * PER_ROOT_TAU,
                skew,
                ends_per_px: along_um / (SQRT_2 * along_um2.sqrt()).max(1e-9),
            },
            facet: normal,
            depth_room: f64::from(REACH_STD) * variances_um2[0].max(variances_um2[1]).sqrt() * 1e-6
                / (depth_m * depth_m),
            is_short: length_um < SHORT * variances_um2[1].sqrt(),
        })
    }
}
