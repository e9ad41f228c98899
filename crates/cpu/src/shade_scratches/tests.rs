//! Lanes against the closed form, and lists against a look at all segments.

use super::*;
use crate::closed_form::RenderOptions;
use crate::light_view::LightViews;
use crate::project::{REACH_MARGIN, ROUNDING_PX, Rows};
use crate::sample_point::SampleView;
use crate::sampling::luminance;
use crate::surface::SurfacePoint;
use crate::visibility::center;
use glam::{DVec2, DVec3, Vec3};
use hairline_fixtures::SceneFile;
use hairline_index::IndexedProfile;
use hairline_optics::band::BandLine;
use hairline_optics::footprint::{Footprint, scratch_share};
use hairline_scene::Scene;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A dish of three cones, whose shading normals are those of its triangles only at its flat bottom.
fn dish() -> Scene {
    let profile = "[[0.0, 0.0], [0.04, 0.0], [0.05, 0.004], [0.066, 0.006]]";
    SceneFile::seen_from([0.0, -0.20, 0.17])
        .looking_at([0.045, 0.0, 0.003])
        .fov_y_deg(9.0)
        .size_px([48, 32])
        .metal("m", "steel")
        .with_lines("roughness = 0.1")
        .object("o", "m", &format!("lathe = {{ profile_m = {profile} }}"))
        .random("o", 4000)
        .with_lines("seed = 3\nlength_m = 0.01\nwidth_um = 3.0\ndepth_nm = 200.0")
        .sphere([0.1, 0.2, 0.3], 0.01, 100.0)
        .scene()
}

/// The share of a segment that the first point of a group sees.
fn share_of(group: &Group, segment: &IndexedSegment, object: u32) -> Option<ScratchShare> {
    let mut seen = SegmentView::default();
    let is_seen = group.see(segment, object, &mut seen);
    is_seen.then(|| seen.share(0, segment.profile))?
}

/// Pairs that a look at all segments of the object finds and project and bin would lose, for each margin.
#[derive(Debug, Default)]
struct Needed {
    pairs: usize,
    share: f64,
    /// Pairs that are not projected at all, and their share.
    dropped: f64,
    /// The margin that the farthest pair needs.
    most: f64,
    /// The share that is lost with margins of 1, 1.1, 1.2 and so on.
    lost: [f64; 16],
}

/// Looks at every `step`-th pixel of every `step`-th row.
fn needed_margin(scene: &Scene, step: usize) -> Needed {
    let prepared = Prepared::new(scene);
    let [width, height] = scene.render.size_px;
    let (picture, _) = prepared.picture(&RenderOptions::default(), 0..height, &|| false);
    let rows = Rows::new(&prepared, &picture.camera, &(0..height), 1);
    let mut needed = Needed::default();
    let pixels = (0..height as usize)
        .step_by(step)
        .flat_map(|y| (0..width as usize).step_by(step).map(move |x| (x, y)));
    for (x, y) in pixels {
        let hit = picture.visibility.hit(x, y).copied();
        let SampleView::Surface { hit, point, .. } = picture.surface(center(x, y), 1, hit) else {
            continue;
        };
        let views = LightViews::new(scene);
        let at = ScratchPoint {
            point: &point,
            object: hit.object,
            at_px: center(x, y),
            views: &views,
            index: 0,
        };
        let group = Group::new(&[at], &[Frame::new(&point)]);
        let object = hit.object as usize;
        let range = prepared.scratches.segment_range(object);
        let coherence_m = f64::from(prepared.scratches.coherence_max_um()[object]) * 1e-6;
        for segment in &prepared.scratches.tree.segments[range.start as usize..range.end as usize] {
            let Some(share) = share_of(&group, segment, hit.object) else {
                continue;
            };
            needed.pairs += 1;
            needed.share += share.segment;
            let Some(projected) = rows.project(segment, coherence_m) else {
                needed.dropped += share.segment;
                continue;
            };
            let [start, end] = [projected.start_px, projected.end_px]
                .map(|px| DVec2::new(px[0].into(), px[1].into()));
            let along = end - start;
            let t = (center(x, y) - start).dot(along) / along.length_squared().max(1e-12);
            let off_px = center(x, y).distance(start + along * t.clamp(0.0, 1.0));
            let reach_px = (f64::from(projected.reach_px) - ROUNDING_PX) / REACH_MARGIN;
            let margin = off_px / reach_px;
            needed.most = needed.most.max(margin);
            for (i, lost) in needed.lost.iter_mut().enumerate() {
                if margin > 1.0 + 0.1 * i as f64 {
                    *lost += share.segment;
                }
            }
        }
    }
    needed
        .lost
        .iter_mut()
        .for_each(|lost| *lost /= needed.share);
    needed.dropped /= needed.share;
    needed
}

/// Project and bin keep every pair with a share.
#[test]
fn lists_hold_what_has_a_share() {
    let needed = needed_margin(&dish(), 1);
    assert!(needed.pairs > 5000, "{needed:?}");
    assert!(
        needed.dropped == 0.0 && needed.most < REACH_MARGIN,
        "{needed:?}"
    );
}

/// The figures at [`REACH_MARGIN`].
#[test]
#[ignore = "takes a minute: prints what margins the scenes need"]
fn margins_of_scenes() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    for (name, height) in [
        ("crates/console/src/built_in_scene.toml", 720),
        ("crates/console/src/built_in_scene.toml", 90),
        ("scenes/spoon.toml", 720),
        ("scenes/spoon.toml", 90),
        ("scenes/pan.toml", 720),
        ("scenes/plate.toml", 360),
    ] {
        let mut scene = hairline_document::load(format!("{root}/{name}")).unwrap();
        scene.render.size_px = [height * 16 / 9, height];
        println!(
            "{name} {height}: {:.5?}",
            needed_margin(&scene, height as usize / 12)
        );
    }
}

/// Segments and footprints of all sizes, in a frame that is turned and moved.
#[test]
fn lanes_see_the_closed_forms_share() {
    let scene = dish();
    let prepared = Prepared::new(&scene);
    let (picture, _) = prepared.picture(&RenderOptions::default(), 0..32, &|| false);
    let hit = picture.visibility.hit(24, 16).copied();
    let SampleView::Surface { point, .. } = picture.surface(center(24, 16), 1, hit) else {
        panic!("the dish is in the middle");
    };
    let views = LightViews::new(&scene);
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut uniform = |low: f64, high: f64| random.random_range(low..high);
    let mut seen = 0;
    for _ in 0..4000 {
        let size_m = 10f64.powf(uniform(-5.0, -3.0));
        let mut plane = || point.axis_x * uniform(-1.0, 1.0) + point.axis_y * uniform(-1.0, 1.0);
        let point = SurfacePoint {
            footprint_axes_m: [plane() * size_m, plane() * size_m],
            ..point
        };
        let (a, b) = (plane() * 3.0 * size_m, plane() * 3.0 * size_m);
        let segment = IndexedSegment {
            start_m: (point.position_m + a).as_vec3(),
            end_m: (point.position_m + b).as_vec3(),
            normal: point.normal.as_vec3(),
            profile: IndexedProfile::rectangle(3.0, 200.0),
            turn_rad: 0.0,
            blur_um: 16.0,
        };
        // Single precision, as the index has it.
        let local = |v: Vec3| {
            point
                .surface_from_world(v.as_dvec3() - point.position_m)
                .truncate()
                * 1e6
        };
        let (start, end) = (local(segment.start_m), local(segment.end_m));
        let t = (end - start).normalize();
        let axes = point
            .footprint_axes_m
            .map(|v| point.surface_from_world(v).truncate() * 1e6);
        let moments =
            |a: DVec2, b: DVec2| -> f64 { axes.iter().map(|v| v.dot(a) * v.dot(b)).sum() };
        let n = t.perp();
        let footprint = Footprint {
            across_um2: moments(n, n),
            along_um2: moments(t, t),
            cross_um2: -moments(n, t),
        };
        let offset_um = end.perp_dot(start) / end.distance(start);
        let expected = |cross_um2: f64| {
            let footprint = Footprint {
                cross_um2,
                ..footprint
            };
            let (low, high) = (start.dot(t), end.dot(t));
            scratch_share(
                3.0,
                offset_um,
                low,
                high,
                16.0,
                footprint,
                point.coherence_um,
            )
            .segment
        };
        // n' Sigma t by the signs of the closed form: the offset is that of the point from the line.
        let expected = expected(-footprint.cross_um2);
        let at = ScratchPoint {
            point: &point,
            object: 0,
            at_px: DVec2::ZERO,
            views: &views,
            index: 0,
        };
        let group = Group::new(&[at], &[Frame::new(&point)]);
        let share = share_of(&group, &segment, 0);
        let share = share.map_or(0.0, |share| share.segment);
        seen += usize::from(share > 0.0);
        // Beyond the reach there is nothing: less than 5e-4 of the window's middle.
        let middle = 3.0 / (footprint.across_um2 + 0.5 * point.coherence_um.powi(2)).sqrt();
        let room = if share > 0.0 {
            1e-6 * expected
        } else {
            1e-3 * middle
        };
        assert!(
            (share - expected).abs() <= room,
            "{share} {expected} {middle}"
        );
    }
    assert!(seen > 1000, "{seen}");
    assert!(point.normal.distance(DVec3::Z) < 2.0);
}

/// The light that is drawn from each part of the band is that of an integral over directions: it comes from the bright side of a cell, not
/// from all of it alike.
#[test]
fn what_is_drawn_of_an_environment_comes_from_there() {
    const BINS: usize = 12;
    let scene = SceneFile::seen_from([0.0, -0.2, 0.1])
        .size_px([8, 8])
        .mirror("m")
        .object("o", "m", "plane = { size_m = [0.2, 0.2] }")
        .part("[environment]\nbuiltin = \"studio\"")
        .scene();
    let environment = scene.environment.as_ref().unwrap();
    let prepared = Prepared::new(&scene);
    let (picture, _) = prepared.picture(&RenderOptions::default(), 0..8, &|| false);
    let hit = picture.visibility.hit(4, 4).copied();
    let SampleView::Surface { point, .. } = picture.surface(center(4, 4), 1, hit) else {
        panic!("the plane is in the middle");
    };
    let table = &prepared.tables.tables[point.table];
    for (turn_rad, width_um) in [(0.3f64, 1.0), (1.2, 3.0)] {
        let profile = IndexedProfile::rectangle(width_um, 300.0);
        let tangent = DVec2::from_angle(turn_rad);
        let scratch = ScratchLight::new(point.wo, Course::straight(tangent), table, profile);
        let line = BandLine::new(scratch.wo, 0.0);
        let bin = |q: f64| {
            let share = (q - line.q_end()) / (line.q_start() - line.q_end());
            ((share * BINS as f64) as usize).min(BINS - 1)
        };
        // Over the directions between two places of the line, cut fine; `of` is the radiance and the cosine for the groove's depth.
        let integral = |low: f64, high: f64, of: &dyn Fn(DVec3) -> (DVec3, f64)| {
            let steps = 400;
            let at = |i: f64| low + (high - low) * i / f64::from(steps);
            let part = |i: u32| {
                let (radiance, cos) = of(line.direction_at(at(f64::from(i) + 0.5)));
                let row = scratch.row(cos);
                let below = |i: f64| DVec3::from(row.look_up(f64::from(width_um) * at(i)));
                (
                    bin(at(f64::from(i) + 0.5)),
                    luminance(radiance * (below(f64::from(i) + 1.0) - below(f64::from(i)))),
                )
            };
            (0..steps).map(part).collect::<Vec<_>>()
        };
        let world =
            |in_band: DVec3| point.world_from_surface(scratch.frame.surface_from_band(in_band));
        let (mut exact, mut by_cells) = ([0.0; BINS], [0.0; BINS]);
        scratch.for_cells(|cell| {
            let really = |direction: DVec3| {
                let radiance = environment.prefiltered(world(direction), 0.0);
                (radiance, direction.z)
            };
            for (bin, sent) in integral(cell.q_low, cell.q_high, &really) {
                exact[bin] += sent;
            }
            let blur = cell.environment_cell_roughness();
            let blurred = environment.prefiltered(world(cell.direction), blur);
            for (bin, sent) in integral(cell.q_low, cell.q_high, &|_| (blurred, cell.direction.z)) {
                by_cells[bin] += sent;
            }
        });
        let mut drawn = [0.0; BINS];
        let all = scratch.environment(&point, environment);
        let draws = 20_000;
        for i in 0..draws {
            // A lattice: as even as a grid, and fine in each of its numbers.
            let u = (f64::from(i) + 0.5) / f64::from(draws);
            let v = (f64::from(i) * 0.618_033_988_75).fract();
            let one = scratch
                .draw_environment(&point, environment, [u, v])
                .unwrap();
            let q = scratch.frame.band_from_surface(one.direction).y + line.offset;
            drawn[bin(q)] += luminance(all * one.color) / f64::from(draws);
        }
        let sum: f64 = exact.iter().sum();
        let off = |found: &[f64; BINS]| {
            let errors = found.iter().zip(&exact).map(|(a, b)| (a - b).abs() / sum);
            errors.fold(0.0, f64::max)
        };
        let (drawn, by_cells) = (off(&drawn), off(&by_cells));
        println!("{turn_rad} rad, {width_um} um: off by {drawn:.4} of all, cells by {by_cells:.4}");
        assert!(drawn < 0.004 && by_cells > 0.01, "{drawn} {by_cells}");
    }
}
