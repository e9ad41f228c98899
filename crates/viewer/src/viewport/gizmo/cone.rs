//! The cone of a spot: its visible rims, and their drags.
//!
//! The outer rim is where the light ends, the inner one where it begins to fall off. Both are drawn on the cone at a fixed size on the screen, the
//! inner one nearer to the light: so each can be met where both have one angle.

use egui::{Pos2, Vec2};
use glam::DVec3;
use hairline_document::description::{Cone, Light};
use hairline_document::place_light;

use crate::viewport::lens::Lens;

/// Distance from the light to its rims, points.
const OUTER: f32 = 132.0;
const INNER: f32 = 104.0;
/// Pieces of a rim.
const STEPS: usize = 48;
/// Least movement of a place of a rim, over that of the liveliest one: a smaller one tells little of its angle.
const LIVELY: f32 = 0.6;
/// Angles that are tried for a place of the pointer.
const TRIED: usize = 720;
/// Weight of staying near to the place before, points a radian, where two angles are seen in one place.
const NEARER: f64 = 2.0;

/// Rim of the cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Rim {
    Outer,
    Inner,
}

/// A cone, with its apex in the light's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LightCone {
    apex_m: DVec3,
    axis: DVec3,
    /// Angle from the axis to the outer rim.
    half_rad: f64,
    softness: f64,
}

impl LightCone {
    /// Cone of a light; none without a cone.
    pub fn from_light(light: &Light) -> Option<Self> {
        let cone = light.cone.as_ref()?;
        let apex_m = place_light::center(light);
        let towards = match light.kind.axis() {
            Some(axis) => axis,
            None => DVec3::from(cone.target_m?) - apex_m,
        };
        Some(Self {
            apex_m,
            axis: towards.try_normalize()?,
            half_rad: 0.5 * cone.cone_deg.to_radians(),
            softness: cone.cone_softness,
        })
    }

    fn angle_rad(&self, rim: Rim) -> f64 {
        match rim {
            Rim::Outer => self.half_rad,
            Rim::Inner => self.half_rad * (1.0 - self.softness),
        }
    }

    /// Point of a rim at an angle from the axis and an angle around it.
    fn point_m(&self, lens: &Lens, rim: Rim, angle_rad: f64, around_rad: f64) -> DVec3 {
        let points = match rim {
            Rim::Outer => OUTER,
            Rim::Inner => INNER,
        };
        let reach_m = lens.m_per_point(self.apex_m) * f64::from(points);
        let (across, along) = self.axis.any_orthonormal_pair();
        let (sin, cos) = angle_rad.sin_cos();
        let (y, x) = around_rad.sin_cos();
        self.apex_m + (self.axis * cos + (across * x + along * y) * sin) * reach_m
    }

    fn around_rad(step: usize) -> f64 {
        step as f64 / STEPS as f64 * std::f64::consts::TAU
    }

    /// Outline of a rim on the screen, closed; none if a part of the rim lies behind the eye.
    pub fn rim(&self, lens: &Lens, rim: Rim) -> Option<Vec<Pos2>> {
        let angle_rad = self.angle_rad(rim);
        let point = |step| self.point_m(lens, rim, angle_rad, Self::around_rad(step));
        (0..=STEPS).map(|step| lens.project(point(step))).collect()
    }

    /// The places of a rim that move most on the screen as its angle grows, by their steps: where it is best taken.
    fn lively(&self, lens: &Lens, rim: Rim) -> Vec<(usize, Pos2)> {
        const LITTLE_RAD: f64 = 0.02;
        let angle_rad = self.angle_rad(rim);
        let places: Vec<_> = (0..STEPS)
            .filter_map(|step| {
                let at =
                    |angle| lens.project(self.point_m(lens, rim, angle, Self::around_rad(step)));
                let (now, next) = (at(angle_rad)?, at(angle_rad + LITTLE_RAD)?);
                Some((step, now, now.distance(next)))
            })
            .collect();
        let most = places.iter().map(|place| place.2).fold(0.0, f32::max);
        let lively = places.into_iter().filter(|place| place.2 >= LIVELY * most);
        lively.map(|(step, now, _)| (step, now)).collect()
    }

    /// Position of a rim's handle for users of a screen reader, where the rim can be dragged.
    pub fn knob(&self, lens: &Lens, rim: Rim) -> Option<Pos2> {
        let lively = self.lively(lens, rim);
        let right = lively.iter().max_by(|a, b| a.1.x.total_cmp(&b.1.x));
        right.map(|(_, place)| *place)
    }

    /// The rims, and the sides that the eye sees as edges, in pieces.
    pub fn outline(&self, lens: &Lens) -> Vec<[Pos2; 2]> {
        let (Some(apex), Some(outer)) = (lens.project(self.apex_m), self.rim(lens, Rim::Outer))
        else {
            return Vec::new();
        };
        let inner = self.rim(lens, Rim::Inner).filter(|_| self.softness > 0.0);
        let edges = |rim: &[Pos2]| -> Vec<[Pos2; 2]> {
            rim.windows(2).map(|ends| [ends[0], ends[1]]).collect()
        };
        let mut pieces = edges(&outer);
        pieces.extend(inner.into_iter().flat_map(|rim| edges(&rim)));
        let edges = outer[1..].iter().map(|p| *p - apex);
        let middle = edges.fold(Vec2::ZERO, |sum, edge| sum + edge);
        if middle.length() > STEPS as f32 {
            // Distance to the side, as seen from the apex.
            let aside = |p: &Pos2| middle.rot90().dot((*p - apex).normalized());
            let left = outer.iter().min_by(|a, b| aside(a).total_cmp(&aside(b)));
            let right = outer.iter().max_by(|a, b| aside(a).total_cmp(&aside(b)));
            pieces.extend(left.into_iter().chain(right).map(|end| [apex, *end]));
        }
        pieces
    }

    /// The angle of a rim, in radians from the axis, that a drag from one place to another gives it: the place of the rim that was
    /// taken follows the pointer.
    fn dragged_rad(&self, lens: &Lens, rim: Rim, from: Pos2, to: Pos2) -> Option<f64> {
        let before_rad = self.angle_rad(rim);
        let lively = self.lively(lens, rim).into_iter();
        let (taken, _) = lively.min_by(|a, b| a.1.distance(from).total_cmp(&b.1.distance(from)))?;
        let around_rad = Self::around_rad(taken);
        let at = |angle_rad| lens.project(self.point_m(lens, rim, angle_rad, around_rad));
        let wanted = at(before_rad)? + (to - from);
        let most_rad = match rim {
            Rim::Outer => 0.5 * Cone::CONE_DEG.bounds.ends().end().to_radians(),
            Rim::Inner => self.half_rad,
        };
        let angles = (0..=TRIED).map(|i| most_rad * i as f64 / TRIED as f64);
        let far = |angle_rad: f64| {
            let distance = at(angle_rad).map_or(f64::INFINITY, |p| p.distance(wanted).into());
            distance + NEARER * (angle_rad - before_rad).abs()
        };
        angles.min_by(|a, b| far(*a).total_cmp(&far(*b)))
    }

    /// Whole angle of the cone after a drag of its outer rim, degrees.
    pub fn opened_deg(&self, lens: &Lens, from: Pos2, to: Pos2) -> Option<f64> {
        let half_rad = self.dragged_rad(lens, Rim::Outer, from, to)?;
        let (least, most) = Cone::CONE_DEG.bounds.ends().into_inner();
        let deg = 2.0 * half_rad.to_degrees();
        Some(((deg * 10.0).round() / 10.0).clamp(least, most))
    }

    /// Softness after a drag of the inner rim.
    pub fn softened(&self, lens: &Lens, from: Pos2, to: Pos2) -> Option<f64> {
        let inner_rad = self.dragged_rad(lens, Rim::Inner, from, to)?;
        let softness = 1.0 - inner_rad / self.half_rad;
        Some(((softness * 100.0).round() / 100.0).clamp(0.0, 1.0))
    }
}
