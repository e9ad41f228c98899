//! A bright region of a map with what is around it, and the outline that fits it best.
//!
//! By least squares over the region as a flat one, f, which is 1 but where it ends: of an outline with coverage c the best factor is b / w with
//! w = ∫ c² and b = ∫ c f, and the square of what is left falls by b² / w. Outlines climb to the most of that. Their radiance is what the map
//! falls by where they end: the hot middle of a soft box has no edge.

use std::ops::Range;

use glam::{DVec2, DVec3};

use hairline_scene::environment::{Outline, Window};

/// Texels of a region and around it.
pub(super) struct Patch {
    directions: Vec<DVec3>,
    solid_angles: Vec<f64>,
    /// Radiances of the texels above the surroundings.
    radiances: Vec<DVec3>,
    flat: Vec<f64>,
    /// Texels of the region: the first ones.
    region: usize,
    /// The median around it.
    pub surroundings: DVec3,
    texel_rad: f64,
}

/// The part of a region's texels that are darker than where it counts as flat.
const DARK: f64 = 0.25;
/// Steps end at this share of a texel.
const FINEST: f64 = 0.02;
/// Outlines of four corners that are looked at, at most.
const LOOKS_MOST: u32 = 2000;
/// Width, in texels, of the ring about an outline's edge. The radiance at the edge is averaged over its inner half.
const RIM_TEXELS: f64 = 2.0;
/// Widths of edges that are tried.
const EDGE_TEXELS: [f64; 6] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0];
/// A disc is simpler: four corners must tell so many times as much.
const QUAD_BETTER: f64 = 1.01;

impl Patch {
    /// Makes a patch. The first of `radiances` are the `region`'s, and those of `around` the surroundings'.
    pub(super) fn new(
        directions: Vec<DVec3>,
        solid_angles: Vec<f64>,
        mut radiances: Vec<DVec3>,
        region: usize,
        around: Range<usize>,
        texel_rad: f64,
    ) -> Self {
        let channel = |i: usize| {
            let values = radiances[around.clone()].iter().map(|r| r[i]);
            quantile(values.collect(), 0.5)
        };
        let surroundings = DVec3::from_array(std::array::from_fn(channel));
        for radiance in &mut radiances {
            *radiance -= surroundings;
        }
        let values: Vec<f64> = radiances.iter().map(|r| r.element_sum()).collect();
        let full = quantile(values[..region].to_vec(), DARK).max(1e-12);
        Self {
            directions,
            solid_angles,
            flat: values.iter().map(|v| (v / full).clamp(0.0, 1.0)).collect(),
            radiances,
            region,
            surroundings,
            texel_rad,
        }
    }

    /// Subtracts a window from the patch.
    pub(super) fn take_out(&mut self, window: &Window) {
        let covers = window.outline.measure(window.edge_rad);
        let radiance_of_it = DVec3::from(window.radiance);
        for (direction, radiance) in self.directions.iter().zip(&mut self.radiances) {
            *radiance -= radiance_of_it * covers(*direction);
        }
    }

    /// The integrals of the square of an outline's coverage, and of coverage times flatness.
    fn sums(&self, outline: &Outline, edge_rad: f64) -> (f64, f64) {
        let covers = outline.measure(edge_rad);
        let (mut squares, mut light) = (0.0, 0.0);
        for (i, direction) in self.directions.iter().enumerate() {
            let covered = covers(*direction);
            let part = covered * self.solid_angles[i];
            squares += part * covered;
            light += part * self.flat[i];
        }
        (squares, light)
    }

    /// Decrease of the squared error by an outline.
    fn gain(&self, outline: &Outline) -> f64 {
        self.soft_gain(outline, self.texel_rad)
    }

    fn soft_gain(&self, outline: &Outline, edge_rad: f64) -> f64 {
        let (squares, light) = self.sums(outline, edge_rad);
        light.powi(2) / squares.max(1e-12)
    }

    /// Width of the soft edge that suits an outline best, from one texel to a few.
    pub(super) fn edge_rad(&self, outline: &Outline) -> f64 {
        let edges = EDGE_TEXELS.map(|texels| texels * self.texel_rad);
        let gain = |edge_rad: &f64| self.soft_gain(outline, *edge_rad);
        let best = edges.into_iter().max_by(|a, b| gain(a).total_cmp(&gain(b)));
        best.unwrap_or(self.texel_rad)
    }

    /// Returns the share of the squared flatness, over the region and what the outline covers besides, that the outline explains: 1 if the
    /// region has its shape.
    pub(super) fn evenness(&self, outline: &Outline) -> f64 {
        let covers = outline.measure(self.texel_rad);
        let (squares, light) = self.sums(outline, self.texel_rad);
        let factor = light / squares.max(1e-12);
        let (mut all, mut left) = (0.0, 0.0);
        for (i, direction) in self.directions.iter().enumerate() {
            let covered = covers(*direction);
            if i < self.region || covered > 0.0 {
                all += self.flat[i].powi(2) * self.solid_angles[i];
                left += (self.flat[i] - covered * factor).powi(2) * self.solid_angles[i];
            }
        }
        1.0 - left / all.max(1e-12)
    }

    /// Difference of radiance between an outline's inside and its surroundings, at an edge of this angle.
    pub(super) fn step(&self, outline: &Outline, edge_rad: f64) -> DVec3 {
        let covers = outline.measure(edge_rad);
        let near = outline.measure(edge_rad + RIM_TEXELS * self.texel_rad);
        let [mut rim, mut all] = [Mean::default(); 2];
        for (i, direction) in self.directions.iter().enumerate() {
            let covered = covers(*direction);
            let weight = self.solid_angles[i];
            if covered == 1.0 && near(*direction) < 1.0 {
                rim.add(self.radiances[i], weight);
            }
            if covered > 0.0 {
                all.add(self.radiances[i] / covered, weight * covered * covered);
            }
        }
        let all = all.get().unwrap_or_default();
        // The rim of an outline of a few texels contains no texel. A window with a bright frame is not as bright as the frame.
        rim.get().unwrap_or(all).min(all).max(DVec3::ZERO)
    }
}

/// Sums and weights.
#[derive(Clone, Copy, Default)]
struct Mean(DVec3, f64);

impl Mean {
    fn add(&mut self, value: DVec3, weight: f64) {
        self.0 += value * weight;
        self.1 += weight;
    }

    fn get(&self) -> Option<DVec3> {
        (self.1 > 0.0).then(|| self.0 / self.1)
    }
}

/// Quantile of the values: the value below which the share lies; 0 if there are none.
fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let at = ((values.len() - 1) as f64 * share) as usize;
    *values.select_nth_unstable_by(at, f64::total_cmp).1
}

/// The outline that fits the region of a patch best; none if the region is wider than a hemisphere's middle.
pub(super) fn best_fit(patch: &Patch) -> Option<Outline> {
    let region = &patch.directions[..patch.region];
    let solid_angles = &patch.solid_angles[..patch.region];
    let toward: DVec3 = region
        .iter()
        .zip(solid_angles)
        .map(|(d, sr)| *d * *sr)
        .sum();
    let middle = toward.try_normalize()?;
    if region.iter().any(|d| d.dot(middle) < 0.4) {
        return None;
    }
    let solid_angle: f64 = solid_angles.iter().sum();
    let disc = best_disc(patch, middle, solid_angle);
    let quad = best_quad(patch, region, middle, solid_angle);
    Some(match quad {
        Some(quad) if quad.1 > QUAD_BETTER * disc.1 => quad.0,
        _ => disc.0,
    })
}

fn best_disc(patch: &Patch, middle: DVec3, solid_angle_sr: f64) -> (Outline, f64) {
    let disc = |direction, radius_rad| Outline::Disc {
        direction,
        radius_rad,
    };
    let radius_rad = (1.0 - solid_angle_sr / std::f64::consts::TAU).acos();
    let mut best = (middle, radius_rad);
    let mut gain = patch.gain(&disc(middle, radius_rad));
    let right = middle.any_orthonormal_vector();
    let down = middle.cross(right);
    let mut step_rad = 0.25 * radius_rad;
    while step_rad > FINEST * patch.texel_rad {
        let mut moved = false;
        for (to, wider) in [
            (right, 0.0),
            (-right, 0.0),
            (down, 0.0),
            (-down, 0.0),
            (DVec3::ZERO, 1.0),
            (DVec3::ZERO, -1.0),
        ] {
            let tried = (
                (best.0 + to * step_rad).normalize(),
                best.1 + wider * step_rad,
            );
            let tried_gain = patch.gain(&disc(tried.0, tried.1));
            if tried.1 > 0.5 * patch.texel_rad && tried_gain > gain {
                (best, gain, moved) = (tried, tried_gain, true);
            }
        }
        if !moved {
            step_rad *= 0.5;
        }
    }
    (disc(best.0, best.1), gain)
}

fn best_quad(
    patch: &Patch,
    region: &[DVec3],
    middle: DVec3,
    solid_angle_sr: f64,
) -> Option<(Outline, f64)> {
    let right = middle.any_orthonormal_vector();
    let up = middle.cross(right);
    // Straight edges are straight in the plane that touches the sphere in the middle.
    let half = 0.5 * patch.texel_rad;
    let places: Vec<DVec2> = region
        .iter()
        .flat_map(|d| {
            let at = DVec2::new(d.dot(right), d.dot(up)) / d.dot(middle);
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|corner| at + half * DVec2::from(corner))
        })
        .collect();
    let outline = |places: &[DVec2; 4]| Outline::Quad {
        corners: places.map(|at| (middle + at.x * right + at.y * up).normalize()),
    };
    let mut best: [DVec2; 4] = four_sides(hull(places)).try_into().ok()?;
    let mut gain = patch.gain(&outline(&best));
    let mut step_rad = 0.1 * solid_angle_sr.sqrt();
    let mut looks = 0;
    while step_rad > FINEST * patch.texel_rad && looks < LOOKS_MOST {
        let mut moved = false;
        for (i, j, to) in moves(&best) {
            let mut tried = best;
            tried[i] += step_rad * to;
            if j != i {
                tried[j] += step_rad * to;
            }
            let is_convex =
                (0..4).all(|i| turn(tried[i], tried[(i + 1) % 4], tried[(i + 2) % 4]) > 0.0);
            if !is_convex {
                continue;
            }
            looks += 1;
            let tried_gain = patch.gain(&outline(&tried));
            if tried_gain > gain {
                (best, gain, moved) = (tried, tried_gain, true);
            }
        }
        if !moved {
            step_rad *= 0.5;
        }
    }
    Some((outline(&best), gain))
}

/// Returns the moves of corners that are tried: one along an axis, or two across the edge between them.
fn moves(corners: &[DVec2; 4]) -> impl Iterator<Item = (usize, usize, DVec2)> + use<> {
    let across: [DVec2; 4] = std::array::from_fn(|i| {
        let edge = corners[(i + 1) % 4] - corners[i];
        edge.perp().normalize_or_zero()
    });
    (0..4).flat_map(move |i| {
        let alone = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].map(|to| (i, i, to));
        let edge = [across[i], -across[i]].map(|to| (i, (i + 1) % 4, to));
        alone.into_iter().chain(edge)
    })
}

/// Twice the area of a triangle; positive if it is counter-clockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// The convex hull, counter-clockwise (A. M. Andrew, 1979).
fn hull(mut places: Vec<DVec2>) -> Vec<DVec2> {
    places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |places: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for place in places {
            while let [.., a, b] = chain[..]
                && turn(a, b, place) <= 0.0
            {
                chain.pop();
            }
            chain.push(place);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut places.iter().copied());
    hull.extend(half(&mut places.iter().rev().copied()));
    hull
}

/// A convex polygon cut down to four sides: the side goes whose neighbours, drawn out until they meet, add the least area.
fn four_sides(mut corners: Vec<DVec2>) -> Vec<DVec2> {
    while corners.len() > 4 {
        let n = corners.len();
        let drawn_out = (0..n).filter_map(|i| {
            let [a, b, c, d] = [n - 1, 0, 1, 2].map(|k| corners[(i + k) % n]);
            let (along, back) = (b - a, c - d);
            let times = (d - a).perp_dot(back) / along.perp_dot(back);
            let meet = a + times * along;
            // Sides that part never meet.
            let meets = times >= 1.0 && (meet - d).dot(back) >= back.length_squared();
            let area = (c - b).perp_dot(meet - b).abs();
            (meets && area.is_finite()).then_some((i, meet, area))
        });
        match drawn_out.min_by(|a, b| a.2.total_cmp(&b.2)) {
            Some((i, meet, _)) => {
                corners[i] = meet;
                corners.remove((i + 1) % n);
            }
            None => return Vec::new(),
        }
    }
    corners
}
