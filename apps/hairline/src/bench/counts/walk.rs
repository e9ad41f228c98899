//! The way of a pixel without its result: what is read, met and lit. Flat surfaces in z = 0 alone, as the bench's disk is, whose
//! frame is the world's.

use std::ops::Add;

use glam::{DVec2, DVec3, Vec3};
use hairline_index::scratch_index::REACH_STD;
use hairline_index::{IndexedSegment, ScratchIndex, TriangleIndex, TriangleLists, Watch};
use hairline_optics::band::{
    BandFrame, BandLine, Cap, PolygonView, band_lines, band_move, band_reaches, band_stds,
    edge_roots, edge_winding, line_down, moved_band, polygon_facing, sphere_band_extent,
    sphere_cap, sphere_chord,
};
use hairline_optics::footprint::{Footprint, scratch_share};
use hairline_optics::mask::Mask;
use hairline_optics::method::{Chords, Lookup, Method, PixelFilter, Spectrum};
use hairline_optics::published::footprint::{PixelFootprint, published_share};
use hairline_optics::published::polygon::{clip_triangle, triangle_segments};
use hairline_optics::published::sphere::sphere_segments;
use hairline_scene::{CameraFrame, Light, Scene};

use super::tally::Tally;
use super::tile::{self, TILE_PX, TileList};

/// A scene with what finds things in it.
pub struct Counted<'a> {
    scene: &'a Scene,
    camera: CameraFrame,
    triangles: TriangleIndex,
    scratches: ScratchIndex,
    lists: TriangleLists,
    coherence_um: f64,
}

/// Over some pixels.
#[derive(Clone, Copy, Default)]
pub struct Sum {
    pub tally: Tally,
    /// Pixels that see the object.
    pub seen: usize,
    pub looked_at: usize,
}

impl Add for Sum {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            tally: self.tally + other.tally,
            seen: self.seen + other.seen,
            looked_at: self.looked_at + other.looked_at,
        }
    }
}

/// What a pixel's middle sees.
struct Sight {
    triangle: usize,
    /// Its middle, from the picture's upper left corner.
    at_px: DVec2,
    position_m: DVec3,
    /// One standard deviation of the filter to the right and down; zero without a footprint.
    axes_m: [DVec3; 2],
    wo: DVec3,
    distance_m: f64,
    /// Half the box by which the hierarchy is walked.
    reach_m: Vec3,
    /// How far from it the line of a scratch may be that it sees.
    reach_px: f64,
}

impl<'a> Counted<'a> {
    /// Of a scene of one object, with pieces as suit the look-up.
    pub fn new(scene: &'a Scene, lookup: Lookup) -> Self {
        let scratches = ScratchIndex::rebuild(scene, lookup, None, &Watch::default())
            .unwrap_or_else(|| unreachable!("nobody cancels it"));
        Self {
            scene,
            camera: scene.camera.frame(scene.render.size_px),
            triangles: TriangleIndex::build(scene),
            lists: TriangleLists::build(scene, &scratches),
            scratches,
            coherence_um: scene.materials[0].coherence_um,
        }
    }

    /// The pixels of the tile whose first pixel is given.
    pub fn tile(&self, corner: [u32; 2], method: &Method) -> Sum {
        let [width, height] = self.scene.render.size_px;
        let pixels = (0..TILE_PX * TILE_PX)
            .map(|i| [corner[0] + i % TILE_PX, corner[1] + i / TILE_PX])
            .filter(|[x, y]| *x < width && *y < height);
        let looked_at = pixels.clone().count();
        let sights: Vec<Sight> = pixels
            .filter_map(|pixel| self.sight(pixel, method))
            .collect();
        let mut tally = Tally::default();
        let shared = self.tile_list(corner, &sights, method, &mut tally);
        for sight in &sights {
            self.pixel(sight, method, shared.as_ref(), &mut tally);
        }
        Sum {
            tally,
            seen: sights.len(),
            looked_at,
        }
    }

    fn sight(&self, pixel: [u32; 2], method: &Method) -> Option<Sight> {
        let at = DVec2::new(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
        let ray = self.camera.camera_ray(at);
        let hit = self
            .triangles
            .intersect(self.camera.position_m, ray.normalize())?;
        let depth_m = hit.distance_m / ray.length();
        let filter_px = match method.footprint {
            PixelFilter::Off => 0.0,
            PixelFilter::Gaussian | PixelFilter::Published => self.scene.render.filter_std_px,
        };
        let steps_m = self.camera.footprint_axes(ray, depth_m, DVec3::Z);
        let axes_m = steps_m.map(|axis| axis * filter_px);
        let sigma_m = 1e-6 * self.coherence_um;
        let [ax, ay] = axes_m;
        let variance = ax * ax + ay * ay + DVec3::splat(0.7 * sigma_m * sigma_m);
        Some(Sight {
            triangle: hit.triangle as usize,
            at_px: at,
            position_m: self.camera.position_m + ray * depth_m,
            axes_m,
            wo: -ray.normalize(),
            distance_m: hit.distance_m,
            reach_m: (variance.map(f64::sqrt) * f64::from(REACH_STD)).as_vec3(),
            reach_px: tile::reach_px(steps_m, filter_px, self.coherence_um),
        })
    }

    /// The segments that a tile's one walk finds for all its pixels, drawn; None for look-ups without tiles.
    fn tile_list(
        &self,
        corner: [u32; 2],
        sights: &[Sight],
        method: &Method,
        tally: &mut Tally,
    ) -> Option<TileList> {
        let tiles = method.lookup == Lookup::Tiles && method.is_default_path();
        if !tiles || sights.is_empty() {
            return None;
        }
        let (mut lower, mut upper) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut reach_px = 0.0_f64;
        for sight in sights {
            let at = sight.position_m.as_vec3();
            lower = lower.min(at - sight.reach_m);
            upper = upper.max(at + sight.reach_m);
            reach_px = reach_px.max(sight.reach_px);
        }
        let corner_px = DVec2::new(f64::from(corner[0]), f64::from(corner[1]));
        let middle_px = corner_px + 0.5 * f64::from(TILE_PX);
        let mut entries = Vec::new();
        let mut projected = 0.0;
        self.walk(lower, upper, tally, |index| {
            projected += 1.0;
            let segment = &self.scratches.tree.segments[index];
            if touches(segment, lower, upper) {
                entries.extend(tile::entry(
                    &self.camera,
                    index,
                    segment,
                    middle_px,
                    reach_px,
                ));
            }
        });
        let list = TileList { entries, reach_px };
        tally.projected += projected;
        tally.entries += list.entries.len() as f64;
        // Into all pixels of the tile, whether they see the object or not.
        let pixels = (0..TILE_PX * TILE_PX)
            .map(|i| corner_px + 0.5 + DVec2::new(f64::from(i % TILE_PX), f64::from(i / TILE_PX)));
        for at_px in pixels {
            let drawn = list.entries.iter().filter(|e| list.touches(e, at_px));
            tally.drawn += drawn.count() as f64;
        }
        Some(list)
    }

    fn walk(&self, lower: Vec3, upper: Vec3, tally: &mut Tally, mut found: impl FnMut(usize)) {
        let tree = &self.scratches.tree;
        let range = tree.objects[0].clone();
        let mut at = range.start;
        while at < range.end {
            let node = &tree.nodes[at as usize];
            tally.nodes += 1.0;
            if node.min_m.cmple(upper).all() && node.max_m.cmpge(lower).all() {
                node.segments().for_each(&mut found);
                at += 1;
            } else {
                at = node.skip;
            }
        }
    }

    fn pixel(&self, sight: &Sight, method: &Method, shared: Option<&TileList>, tally: &mut Tally) {
        let mut segments: Vec<usize> = Vec::new();
        match (shared, method.lookup) {
            (Some(list), _) => {
                // Those whose bit is set.
                let near = list.entries.iter();
                let near = near.filter(|entry| list.touches(entry, sight.at_px));
                segments.extend(near.map(|entry| entry.segment));
            }
            (None, Lookup::Triangles) => {
                let list = self.lists.of(sight.triangle);
                tally.entries += list.len() as f64;
                segments.extend(list.iter().map(|s| *s as usize));
            }
            (None, _) => {
                let at = sight.position_m.as_vec3();
                let (lower, upper) = (at - sight.reach_m, at + sight.reach_m);
                self.walk(lower, upper, tally, |segment| segments.push(segment));
            }
        }
        tally.weighed += segments.len() as f64;
        let mut kept = 0;
        for segment in segments {
            let segment = &self.scratches.tree.segments[segment];
            if let Some(view) = self.view(sight, segment, method) {
                kept += 1;
                // What the base pays; the density asks for no spectrum.
                if let (Spectrum::Wavelengths { count, .. }, true) =
                    (method.spectrum, method.mask != Mask::Density)
                {
                    tally.wavelengths += count as f64;
                }
                for light in self.scene.all_lights() {
                    self.pair(sight, &view, light, method, tally);
                }
            }
        }
        tally.kept += f64::from(kept);
        if kept > 0 {
            tally.lights += self.scene.all_lights().count() as f64;
        }
    }

    /// Across its line, whatever its ends.
    fn reaches(&self, sight: &Sight, segment: &IndexedSegment) -> bool {
        View::new(sight, segment).is_some_and(|view| {
            let variance = view.variance_um2(self.coherence_um);
            view.offset_um.powi(2) <= f64::from(REACH_STD).powi(2) * variance
        })
    }

    /// A segment that the pixel sees a share of.
    fn view(&self, sight: &Sight, segment: &IndexedSegment, method: &Method) -> Option<View> {
        let view = View::new(sight, segment)?;
        if !self.reaches(sight, segment) {
            return None;
        }
        let [ax, ay] = view.axes_um;
        let (width_um, blur_um) = (f64::from(segment.width_um), f64::from(segment.blur_um));
        let (start, end) = (view.start_um, view.end_um);
        let sigma = self.coherence_um;
        let share = match method.footprint {
            PixelFilter::Gaussian | PixelFilter::Off => {
                let footprint = Footprint {
                    across_um2: ax.y * ax.y + ay.y * ay.y,
                    along_um2: ax.x * ax.x + ay.x * ay.x,
                    cross_um2: ax.x * ax.y + ay.x * ay.y,
                };
                scratch_share(
                    width_um,
                    view.offset_um,
                    start,
                    end,
                    blur_um,
                    footprint,
                    sigma,
                )
                .segment
            }
            PixelFilter::Published => {
                let pixel = PixelFootprint {
                    right_um: 12f64.sqrt() * ax.truncate(),
                    down_um: 12f64.sqrt() * ay.truncate(),
                };
                published_share(width_um, view.offset_um, start, end, blur_um, pixel, sigma).share
            }
        };
        (share > 0.0).then_some(view)
    }

    fn pair(&self, sight: &Sight, view: &View, light: &Light, method: &Method, tally: &mut Tally) {
        let (center_m, radius_m) = light.bounding_sphere();
        let center_m = center_m - sight.position_m;
        let bound = sphere_cap(center_m, radius_m).turned(view.frame);
        if method.chords == Chords::Steps {
            tally.pairs += 1.0;
            let count = self.steps(sight, view, light, bound);
            if count > 0 {
                tally.lit += 1.0;
                tally.lines += 1.0;
                look_up(2.0 * count as f64, method, tally);
            }
            return;
        }
        // Lights below the horizon, and those that shine to the other side, are left out before any segment is asked.
        if center_m.z <= -radius_m {
            return;
        }
        let polygon = Polygon::of(sight, light);
        if polygon.as_ref().is_some_and(|p| p.facing == 0.0) {
            return;
        }
        tally.pairs += 1.0;
        let distance_m = center_m.length().max(radius_m);
        let per = (1e-6 / sight.distance_m, 1e-6 / distance_m);
        let moves = view
            .axes_um
            .map(|axis| band_move(0.0, axis, view.wo, per.0, bound.axis, per.1));
        let across_um = view.axes_um.map(|axis| axis.y);
        let variance = view.variance_um2(self.coherence_um);
        let stds = band_stds(self.coherence_um);
        let band = moved_band(stds, moves, across_um, view.offset_um, variance);
        let wo = view.wo + band.shift * DVec3::X;
        let (lowest, highest) = sphere_band_extent(wo, bound);
        if !band_reaches(lowest, highest, band.stds) {
            return;
        }
        tally.lit += 1.0;
        let Some(polygon) = polygon else {
            let lines = band_lines(wo.x, lowest, highest, band.stds);
            tally.lines += lines.count as f64;
            for i in 0..lines.count {
                let line = BandLine::new(wo, lines.band_line(i).0);
                let wraps = sphere_chord(line, bound).wraps;
                look_up(if wraps { 4.0 } else { 2.0 }, method, tally);
            }
            return;
        };
        // The outline itself may be out of reach though its cap is not.
        let (lowest, highest) = polygon.view().band_extent(view.frame, wo);
        let lines = band_lines(wo.x, lowest, highest, band.stds);
        tally.lines += lines.count as f64;
        for i in 0..lines.count {
            let line = BandLine::new(wo, lines.band_line(i).0);
            look_up(polygon.look_ups(view.frame, line), method, tally);
        }
    }

    /// Segments of the band's middle line by the talk's steps.
    fn steps(&self, sight: &Sight, view: &View, light: &Light, cap: Cap) -> usize {
        match light {
            Light::Sphere { .. } => sphere_segments(view.wo, cap).count,
            Light::Polygon { vertices_m, .. } => {
                let relative = |i: usize| vertices_m[i] - sight.position_m;
                // Those of the bench are triangles.
                let clipped = clip_triangle([relative(0), relative(1), relative(2)]);
                clipped
                    .triangles()
                    .map(|corners| corners.map(|c| view.frame.band_from_surface(c)))
                    .map(|corners| triangle_segments(view.wo, corners).count)
                    .sum()
            }
        }
    }
}

/// So many values of the antiderivative: by the table, or by a sine integral for each wavelength.
fn look_up(count: f64, method: &Method, tally: &mut Tally) {
    match method.spectrum {
        Spectrum::Wavelengths {
            count: wavelengths, ..
        } => tally.sine_integrals += count * wavelengths as f64,
        Spectrum::Table => tally.table += count,
    }
}

/// A polygonal light as seen from a point.
struct Polygon {
    directions: Vec<DVec3>,
    away: DVec3,
    facing: f64,
}

impl Polygon {
    fn of(sight: &Sight, light: &Light) -> Option<Self> {
        let Light::Polygon {
            vertices_m,
            two_sided,
            ..
        } = light
        else {
            return None;
        };
        let relative = || vertices_m.iter().map(|v| *v - sight.position_m);
        let (away, facing) = polygon_facing(relative(), *two_sided);
        Some(Self {
            directions: relative().map(DVec3::normalize_or_zero).collect(),
            away,
            facing,
        })
    }

    fn view(&self) -> PolygonView<'_> {
        PolygonView {
            directions: &self.directions,
            away: self.away,
            facing: self.facing,
        }
    }

    /// Values of the antiderivative on a line: two for each pair of roots, and for the whole arc where it holds straight down.
    fn look_ups(&self, frame: BandFrame, line: BandLine) -> f64 {
        let turned = |d: &DVec3| frame.band_from_surface(*d);
        let corners: Vec<DVec3> = self.directions.iter().map(turned).collect();
        let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
        let (mut rises, mut falls, mut winding) = (0, 0, 0.0);
        let down = line_down(line);
        for (a, b) in edges() {
            let roots = edge_roots(line, *a, *b);
            rises += i32::from(roots.rising.is_some());
            falls += i32::from(roots.falling.is_some());
            winding += edge_winding(down, *a, *b);
        }
        let around = winding.abs() > std::f64::consts::PI;
        let wraps = around && down.dot(frame.band_from_surface(self.away)) > 0.0;
        2.0 * f64::from(rises.max(falls) + i32::from(wraps))
    }
}

/// Whether a segment's own box touches the box.
fn touches(segment: &IndexedSegment, lower: Vec3, upper: Vec3) -> bool {
    let (start, end) = (segment.start_m, segment.end_m);
    start.min(end).cmple(upper).all() && start.max(end).cmpge(lower).all()
}

/// A segment as seen from a point.
struct View {
    frame: BandFrame,
    wo: DVec3,
    offset_um: f64,
    start_um: f64,
    end_um: f64,
    axes_um: [DVec3; 2],
}

impl View {
    fn new(sight: &Sight, segment: &IndexedSegment) -> Option<Self> {
        let local_um = |v: Vec3| (v.as_dvec3() - sight.position_m) * 1e6;
        let (start, end) = (local_um(segment.start_m), local_um(segment.end_m));
        let frame = BandFrame {
            tangent: (end - start).truncate().try_normalize()?,
        };
        let (start, end) = (frame.band_from_surface(start), frame.band_from_surface(end));
        Some(Self {
            frame,
            wo: frame.band_from_surface(sight.wo),
            offset_um: 0.5 * (start.y + end.y),
            start_um: start.x,
            end_um: end.x,
            axes_um: sight.axes_m.map(|a| frame.band_from_surface(a) * 1e6),
        })
    }

    /// The footprint's variance across the segment, and the window's with it.
    fn variance_um2(&self, coherence_um: f64) -> f64 {
        let [ax, ay] = self.axes_um;
        ax.y * ax.y + ay.y * ay.y + 0.5 * coherence_um * coherence_um
    }
}
