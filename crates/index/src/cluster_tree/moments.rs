//! What segments add up to: the one scratch that stands for them, how far they stray from it, and where to part them.

use super::ClusterNode;
use crate::scratch_index::IndexedSegment;
use glam::{DMat3, DVec3};

/// Tangents are parted until their angles' standard deviation is below this, whatever the places: 1/55 of a half circle for
/// even ones.
const TURN_FIRST_RAD: f64 = 0.0165;
/// A bundle may be as many times longer than wide.
const BUNDLE_ASPECT: f64 = 8.0;
/// Normals that agree less than this in the mean are parted before all else.
const NORMALS_AGREE: f64 = 0.9;

/// Sums over segments, weighted by width times length.
pub(super) struct Moments {
    weight_um2: f64,
    center_m: DVec3,
    /// Covariance of the segments' middles.
    places_m2: DMat3,
    /// Mean of t t'.
    tangents: DMat3,
    normal: DVec3,
    normals: DMat3,
    length2_um2: f64,
    blur2_um2: f64,
    widths: [f64; 2],
    depths: [f64; 2],
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

fn middle_m(segment: &IndexedSegment) -> DVec3 {
    0.5 * (segment.start_m.as_dvec3() + segment.end_m.as_dvec3())
}

fn along_m(segment: &IndexedSegment) -> DVec3 {
    segment.end_m.as_dvec3() - segment.start_m.as_dvec3()
}

/// The unit eigenvector of the largest eigenvalue of a positive matrix, by squaring it.
fn principal(matrix: DMat3) -> DVec3 {
    let mut m = matrix;
    for _ in 0..8 {
        let size = m.x_axis.x + m.y_axis.y + m.z_axis.z;
        if !(size > 0.0) {
            return DVec3::X;
        }
        m *= 1.0 / size;
        m = m * m;
    }
    let columns = [m.x_axis, m.y_axis, m.z_axis];
    let longest = columns
        .into_iter()
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    longest.unwrap_or(DVec3::X).normalize_or(DVec3::X)
}

impl Moments {
    pub(super) fn new(segments: &[IndexedSegment]) -> Self {
        let origin_m = middle_m(&segments[0]);
        let mut sums = Self {
            weight_um2: 0.0,
            center_m: DVec3::ZERO,
            places_m2: DMat3::ZERO,
            tangents: DMat3::ZERO,
            normal: DVec3::ZERO,
            normals: DMat3::ZERO,
            length2_um2: 0.0,
            blur2_um2: 0.0,
            widths: [0.0; 2],
            depths: [0.0; 2],
        };
        for segment in segments {
            let along = along_m(segment);
            let length_um = along.length() * 1e6;
            let (width_um, depth_nm) = (segment.width_um as f64, segment.depth_nm as f64);
            let weight = width_um * length_um;
            let place = middle_m(segment) - origin_m;
            let normal = segment.normal.as_dvec3();
            sums.weight_um2 += weight;
            sums.center_m += weight * place;
            sums.places_m2 += outer(place) * weight;
            sums.tangents += outer(along.normalize_or(DVec3::X)) * weight;
            sums.normal += weight * normal;
            sums.normals += outer(normal) * weight;
            sums.length2_um2 += weight * length_um * length_um;
            sums.blur2_um2 += weight * (segment.blur_um as f64).powi(2);
            for (sum, value) in [(&mut sums.widths, width_um), (&mut sums.depths, depth_nm)] {
                sum[0] += weight * value;
                sum[1] += weight * value * value;
            }
        }
        let per_weight = 1.0 / sums.weight_um2.max(1e-30);
        let offset = sums.center_m * per_weight;
        Self {
            weight_um2: sums.weight_um2,
            center_m: origin_m + offset,
            places_m2: sums.places_m2 * per_weight - outer(offset),
            tangents: sums.tangents * per_weight,
            normal: sums.normal * per_weight,
            normals: sums.normals * per_weight,
            length2_um2: sums.length2_um2 * per_weight,
            blur2_um2: sums.blur2_um2 * per_weight,
            widths: mean_and_std(sums.widths, per_weight),
            depths: mean_and_std(sums.depths, per_weight),
        }
    }

    /// The node without its place in a tree.
    pub(super) fn node(&self, segments: &[IndexedSegment]) -> ClusterNode {
        let axis = principal(self.tangents);
        let turn2 = (1.0 - axis.dot(self.tangents * axis)).max(0.0);
        let middles_along_um2 = axis.dot(self.places_m2 * axis).max(0.0) * 1e12;
        let all_um2 = trace(self.places_m2).max(0.0) * 1e12;
        let across_um2 = (all_um2 - middles_along_um2).max(0.0) + self.length2_um2 / 12.0 * turn2;
        // Middles that are spread evenly and segments of one length make a trapezoid: an interval of the longer of the two,
        // smoothed by the shorter one.
        let (a, b) = (self.length2_um2, 12.0 * middles_along_um2);
        let ragged_um2 = a.min(b) / 12.0;
        let (mut radius_m, mut half_m, mut cos) = (0f64, 0f64, 1f64);
        for segment in segments {
            for end in [segment.start_m, segment.end_m] {
                let v = end.as_dvec3() - self.center_m;
                let along = v.dot(axis);
                half_m = half_m.max(along.abs());
                radius_m = radius_m.max((v - along * axis).length_squared());
            }
            cos = cos.min(along_m(segment).normalize_or(axis).dot(axis).abs());
        }
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let normals_agree = self.normal.length() >= NORMALS_AGREE;
        ClusterNode {
            center_m: self.center_m.as_vec3(),
            axis: axis.as_vec3(),
            // What rounding to single precision may move.
            radius_m: (radius_m.sqrt() * (1.0 + 1e-6) + 1e-7) as f32,
            half_m: (half_m * (1.0 + 1e-6) + 1e-7) as f32,
            spread: [(sin + 1e-6).min(1.0) as f32, (cos - 1e-6).max(0.0) as f32],
            normal: self.normal.normalize_or(DVec3::Z).as_vec3(),
            stray_um: if normals_agree {
                (across_um2 + ragged_um2).sqrt() as f32
            } else {
                f32::INFINITY
            },
            turn_rad: turn2.sqrt() as f32,
            weight_um2: self.weight_um2 as f32,
            length_um: a.max(b).sqrt() as f32,
            blur_um: (self.blur2_um2 + ragged_um2).sqrt() as f32,
            across_um2: across_um2 as f32,
            width_um: self.widths[0] as f32,
            depth_nm: self.depths[0] as f32,
            width_std_um: self.widths[1] as f32,
            depth_std_nm: self.depths[1] as f32,
            turn_rad2: turn2 as f32,
            ..ClusterNode::default()
        }
    }

    /// Where to part segments whose node this is.
    pub(super) fn split(&self, node: &ClusterNode) -> Split {
        if self.normal.length() < NORMALS_AGREE {
            return Split::Normal(principal(
                self.normals
                    - outer(self.normal) * if self.normal.length() > 0.3 { 1.0 } else { 0.0 },
            ));
        }
        let axis = node.axis.as_dvec3();
        let turn = (node.turn_rad2 as f64).sqrt();
        let across = DMat3::IDENTITY - outer(axis);
        let places = across * self.places_m2 * across;
        let side = principal(places);
        let across_um = side.dot(places * side).max(0.0).sqrt() * 1e6;
        let along_um = axis.dot(self.places_m2 * axis).max(0.0).sqrt() * 1e6 / BUNDLE_ASPECT;
        let turned_um = (self.length2_um2 / 12.0).sqrt() * turn;
        if turn > TURN_FIRST_RAD || turned_um > across_um.max(along_um) {
            Split::Turn {
                axis,
                side: principal(across * self.tangents * across),
            }
        } else if across_um > along_um {
            Split::Place(side)
        } else {
            Split::Place(axis)
        }
    }
}

fn mean_and_std(sums: [f64; 2], per_weight: f64) -> [f64; 2] {
    let mean = sums[0] * per_weight;
    [mean, (sums[1] * per_weight - mean * mean).max(0.0).sqrt()]
}

fn trace(m: DMat3) -> f64 {
    m.x_axis.x + m.y_axis.y + m.z_axis.z
}

/// By what segments are parted.
#[derive(Clone, Copy, Debug)]
pub(super) enum Split {
    Normal(DVec3),
    Turn { axis: DVec3, side: DVec3 },
    Place(DVec3),
}

impl Split {
    pub(super) fn key(&self, segment: &IndexedSegment) -> f64 {
        match self {
            Self::Normal(direction) => segment.normal.as_dvec3().dot(*direction),
            Self::Turn { axis, side } => {
                let along = along_m(segment).normalize_or(*axis);
                along.dot(*side) * 1f64.copysign(along.dot(*axis))
            }
            Self::Place(direction) => middle_m(segment).dot(*direction),
        }
    }
}
