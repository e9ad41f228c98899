//! Transforms of a file's nodes: at rest, or at a time of one of its animations (glTF 2.0, sections 3.5 and 3.11).

use glam::{DMat4, DQuat, DVec3};
use gltf::animation::{Channel, Interpolation, Property};

use super::accessor::read_numbers;
use super::source::Buffers;
use crate::flaw::Flaw;
use crate::text::shown;

/// A time of an animation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment<'p> {
    pub time_s: f64,
    /// Name or number of the animation; without it the first one.
    pub animation: Option<&'p str>,
}

/// The nodes of a file by their numbers.
pub(super) struct Pose(Vec<NodePose>);

struct NodePose {
    parent_from_node: DMat4,
    /// Weights of the node's morph targets, where the animation gives them.
    weights: Option<Vec<f64>>,
}

impl Pose {
    pub(super) fn at_rest(document: &gltf::Document) -> Self {
        let parts = document
            .nodes()
            .map(|node| NodeTransform::from_node(&node).pose());
        Self(parts.collect())
    }

    /// The pose at a time of an animation, by its name or number, or of the first one. Before its first key and after its last one an
    /// animation stands still.
    pub(super) fn sample(
        document: &gltf::Document,
        buffers: &Buffers,
        Moment { time_s, animation }: Moment,
    ) -> Result<Self, Flaw> {
        let mut parts: Vec<NodeTransform> = document
            .nodes()
            .map(|node| NodeTransform::from_node(&node))
            .collect();
        let animation = match animation {
            Some(wanted) => Some(named(document, wanted)?),
            None => document.animations().next(),
        };
        if let Some(animation) = animation {
            for channel in animation.channels() {
                let index = channel.target().node().index();
                let node = &mut parts[index];
                let moves = channel.target().property() != Property::MorphTargetWeights;
                if moves && node.matrix.is_some() {
                    return Err(Flaw::new(
                        format!("its animation moves node {index}, which has a `matrix`"),
                        "must have `translation`, `rotation` and `scale` instead: export it again",
                    ));
                }
                node.animate(&channel, buffers, time_s)?;
            }
        }
        Ok(Self(parts.into_iter().map(NodeTransform::pose).collect()))
    }

    pub(super) fn parent_from_node(&self, node: &gltf::Node) -> DMat4 {
        self.0[node.index()].parent_from_node
    }

    /// The weights of the morph targets of a node's mesh: the animation's, the node's own or the mesh's.
    pub(super) fn weights(&self, node: &gltf::Node) -> Vec<f64> {
        if let Some(weights) = &self.0[node.index()].weights {
            return weights.clone();
        }
        let of_mesh = node.mesh().and_then(|mesh| mesh.weights());
        let weights = node.weights().or(of_mesh).unwrap_or_default();
        weights.iter().copied().map(f64::from).collect()
    }
}

fn named<'d>(document: &'d gltf::Document, wanted: &str) -> Result<gltf::Animation<'d>, Flaw> {
    let is_wanted =
        |it: &gltf::Animation| it.name() == Some(wanted) || wanted.parse() == Ok(it.index());
    document.animations().find(is_wanted).ok_or_else(|| {
        let name = |it: gltf::Animation| it.name().map_or_else(|| it.index().to_string(), shown);
        let known: Vec<_> = document.animations().map(name).collect();
        let right = match known.is_empty() {
            true => "it has none at all".to_owned(),
            false => format!("its animations are {}", known.join(", ")),
        };
        Flaw::new(format!("it has no animation \"{}\"", shown(wanted)), right)
    })
}

/// A node's transform taken apart. A file that animates a node gives it no matrix.
struct NodeTransform {
    matrix: Option<DMat4>,
    translation: DVec3,
    rotation: DQuat,
    scale: DVec3,
    weights: Option<Vec<f64>>,
}

impl NodeTransform {
    fn from_node(node: &gltf::Node) -> Self {
        let mut parts = Self {
            matrix: None,
            translation: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
            weights: None,
        };
        match node.transform() {
            gltf::scene::Transform::Matrix { matrix } => {
                let matrix = matrix.map(|column| column.map(f64::from));
                parts.matrix = Some(DMat4::from_cols_array_2d(&matrix));
            }
            gltf::scene::Transform::Decomposed {
                translation,
                rotation,
                scale,
            } => {
                parts.translation = translation.map(f64::from).into();
                parts.rotation = unit(rotation.map(f64::from));
                parts.scale = scale.map(f64::from).into();
            }
        }
        parts
    }

    fn pose(self) -> NodePose {
        let of_parts =
            || DMat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation);
        NodePose {
            parent_from_node: self.matrix.unwrap_or_else(of_parts),
            weights: self.weights,
        }
    }

    fn animate(&mut self, channel: &Channel, buffers: &Buffers, time_s: f64) -> Result<(), Flaw> {
        let sampler = channel.sampler();
        let output = sampler.output();
        let values: Vec<f32> = match channel.target().property() {
            Property::Translation | Property::Scale => {
                read_numbers::<3>(&output, buffers)?.into_flattened()
            }
            Property::Rotation => read_numbers::<4>(&output, buffers)?.into_flattened(),
            Property::MorphTargetWeights => read_numbers::<1>(&output, buffers)?.into_flattened(),
        };
        let times = read_numbers::<1>(&sampler.input(), buffers)?.into_flattened();
        let interpolation = sampler.interpolation();
        let keys = Keys::new(&times, &values, interpolation).ok_or_else(|| {
            let found = format!(
                "its animation {} has a sampler of {} times and {} numbers",
                channel.animation().index(),
                times.len(),
                values.len()
            );
            Flaw::new(found, "must have as many values as times, all finite")
        })?;
        let is_turn = channel.target().property() == Property::Rotation;
        let value = keys.sample(time_s, is_turn);
        match (channel.target().property(), value.as_slice()) {
            (Property::Translation, &[x, y, z]) => self.translation = DVec3::new(x, y, z),
            (Property::Scale, &[x, y, z]) => self.scale = DVec3::new(x, y, z),
            (Property::Rotation, &[x, y, z, w]) => self.rotation = unit([x, y, z, w]),
            (Property::MorphTargetWeights, weights) => self.weights = Some(weights.to_vec()),
            // No key of this property has that many numbers.
            _ => return Err(Flaw::new("its animation is broken", "export it again")),
        }
        Ok(())
    }
}

/// A rotation. Exporters round, and a zero quaternion has no direction.
pub(super) fn unit(quaternion: [f64; 4]) -> DQuat {
    let rotation = DQuat::from_array(quaternion);
    match rotation.length() > 1e-6 {
        true => rotation.normalize(),
        false => DQuat::IDENTITY,
    }
}

/// The keys of a sampler.
struct Keys<'a> {
    times: &'a [f32],
    values: &'a [f32],
    /// Numbers of one value.
    width: usize,
    interpolation: Interpolation,
}

impl<'a> Keys<'a> {
    fn new(times: &'a [f32], values: &'a [f32], interpolation: Interpolation) -> Option<Self> {
        // A cubic key has its value between two tangents.
        let parts = match interpolation {
            Interpolation::CubicSpline => 3,
            Interpolation::Linear | Interpolation::Step => 1,
        };
        let numbers = parts * times.len();
        let is_whole =
            numbers > 0 && values.len() >= numbers && values.len().is_multiple_of(numbers);
        let is_finite = times.iter().chain(values).all(|x| x.is_finite());
        (is_whole && is_finite).then(|| Self {
            times,
            values,
            width: values.len() / numbers,
            interpolation,
        })
    }

    fn sample(&self, time_s: f64, is_turn: bool) -> Vec<f64> {
        let later = self.times.partition_point(|&key| f64::from(key) <= time_s);
        let last = self.times.len() - 1;
        let (low, high) = (later.saturating_sub(1), later.min(last));
        let [start, end] = [low, high].map(|key| f64::from(self.times[key]));
        let span_s = end - start;
        let share = match span_s > 0.0 {
            true => ((time_s - start) / span_s).clamp(0.0, 1.0),
            false => 0.0,
        };
        match self.interpolation {
            Interpolation::Step => self.part(low, 0, 1),
            Interpolation::Linear => {
                let [a, b] = [low, high].map(|key| self.part(key, 0, 1));
                match is_turn {
                    true => turned(&a, &b, share),
                    false => mixed(&[(1.0 - share, &a), (share, &b)]),
                }
            }
            Interpolation::CubicSpline => {
                let [a, b] = [low, high].map(|key| self.part(key, 1, 3));
                let (leaving, coming) = (self.part(low, 2, 3), self.part(high, 0, 3));
                let (s, s2, s3) = (share, share.powi(2), share.powi(3));
                mixed(&[
                    (2.0 * s3 - 3.0 * s2 + 1.0, &a),
                    (span_s * (s3 - 2.0 * s2 + s), &leaving),
                    (3.0 * s2 - 2.0 * s3, &b),
                    (span_s * (s3 - s2), &coming),
                ])
            }
        }
    }

    /// Numbers of one part of a key.
    fn part(&self, key: usize, part: usize, parts: usize) -> Vec<f64> {
        let numbers = &self.values[(key * parts + part) * self.width..][..self.width];
        numbers.iter().copied().map(f64::from).collect()
    }
}

fn mixed(parts: &[(f64, &Vec<f64>)]) -> Vec<f64> {
    let sum = |i: usize| parts.iter().map(|(share, value)| share * value[i]).sum();
    (0..parts[0].1.len()).map(sum).collect()
}

/// Interpolates two rotations by the shorter way.
fn turned(a: &[f64], b: &[f64], share: f64) -> Vec<f64> {
    let rotation = |value: &[f64]| match value {
        &[x, y, z, w] => unit([x, y, z, w]),
        _ => DQuat::IDENTITY,
    };
    rotation(a).slerp(rotation(b), share).to_array().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_met_and_what_is_beyond_stands_still() {
        let times = [1.0, 2.0, 4.0];
        let values = [0.0, 10.0, 30.0];
        let linear = Keys::new(&times, &values, Interpolation::Linear).unwrap();
        for (time_s, value) in [(0.0, 0.0), (1.0, 0.0), (1.5, 5.0), (3.0, 20.0), (9.0, 30.0)] {
            assert_eq!(linear.sample(time_s, false), [value], "{time_s}");
        }
        let step = Keys::new(&times, &values, Interpolation::Step).unwrap();
        assert_eq!(step.sample(3.9, false), [10.0]);
        assert_eq!(step.sample(4.0, false), [30.0]);
    }

    #[test]
    fn a_spline_follows_its_tangents() {
        // The cubic t^3 - 2 t between -1 and 2, whose tangents are 3 t^2 - 2: a spline of one span is it.
        let f = |t: f32| t * t * t - 2.0 * t;
        let slope = |t: f32| 3.0 * t * t - 2.0;
        let key = |t: f32| [slope(t), f(t), slope(t)];
        let values = [key(-1.0), key(2.0)].concat();
        let keys = Keys::new(&[-1.0, 2.0], &values, Interpolation::CubicSpline).unwrap();
        for t in [-1.0, -0.3, 0.5, 1.9_f32] {
            let value = keys.sample(t.into(), false)[0];
            assert!((value - f64::from(f(t))).abs() < 1e-6, "{t}: {value}");
        }
    }

    #[test]
    fn rotations_go_the_shorter_way() {
        let quarter = std::f32::consts::FRAC_1_SQRT_2;
        // Minus a quaternion is the same rotation.
        let values = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -quarter, -quarter];
        let keys = Keys::new(&[0.0, 1.0], &values, Interpolation::Linear).unwrap();
        let half = unit(keys.sample(0.5, true).try_into().unwrap());
        let expected = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_4);
        assert!(half.dot(expected).abs() > 1.0 - 1e-9);
    }
}
