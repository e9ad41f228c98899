//! Scratches of a surface for the references: every piece with its true ends, and the distance by which its scratch
//! goes on beyond them.

use crate::segment_tree::{SegmentTree, Straight};
use glam::Vec3;
use hairline_scene::{GrooveShapes, Object, Scene, Scratch};

/// A straight piece of a scratch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// World space, metres.
    pub start_m: Vec3,
    /// World space, metres.
    pub end_m: Vec3,
    /// The surface's unit normal.
    pub normal: Vec3,
    /// Width of the opening.
    pub width_um: f32,
    /// Depth of the deepest place.
    pub depth_nm: f32,
    /// Index of its shape in [`GrooveShapes`].
    pub shape: u8,
    /// Length of the scratch before `start_m`; infinite for a closed ring.
    pub before_um: f32,
    /// Length of the scratch after `end_m`; infinite for a closed ring.
    pub after_um: f32,
}

impl Straight for Groove {
    fn ends_m(&self) -> [Vec3; 2] {
        [self.start_m, self.end_m]
    }
}

/// The trees over all pieces of a scene.
pub fn build(scene: &Scene) -> SegmentTree<Groove> {
    let shapes = GrooveShapes::new(scene);
    let objects = scene.objects.iter();
    SegmentTree::build(
        objects.map(|object| grooves(object, |scratch| shapes.index(scene, object, scratch))),
    )
}

fn grooves(object: &Object, shape_of: impl Fn(&Scratch) -> u8) -> Vec<Groove> {
    let mut grooves = Vec::with_capacity(object.segments.len());
    for scratch in object.scratches.iter() {
        let pieces =
            &object.segments[scratch.segments.start as usize..scratch.segments.end as usize];
        let length_um = |p: &hairline_scene::Segment| p.start_m.distance(p.end_m) as f64 * 1e6;
        let whole_um: f64 = pieces.iter().map(length_um).sum();
        let shape = shape_of(scratch);
        let mut before_um = 0.0;
        for piece in pieces {
            let after_um = (whole_um - before_um - length_um(piece)).max(0.0);
            let [before, after] = if scratch.closed {
                [f32::INFINITY; 2]
            } else {
                [before_um as f32, after_um as f32]
            };
            before_um += length_um(piece);
            if piece.start_m != piece.end_m {
                grooves.push(Groove {
                    start_m: piece.start_m,
                    end_m: piece.end_m,
                    normal: piece.normal,
                    width_um: scratch.profile.width_um,
                    depth_nm: scratch.profile.depth_nm,
                    shape,
                    before_um: before,
                    after_um: after,
                });
            }
        }
    }
    grooves
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_scene::{Profile, Segment};
    use std::sync::Arc;

    #[test]
    fn a_piece_knows_how_far_its_scratch_goes_on() {
        let at = |mm: f32| Vec3::new(mm * 1e-3, 0.0, 0.0);
        let pieces = [(0.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 3.5)];
        let segments = pieces.map(|(start, end)| Segment {
            start_m: at(start),
            end_m: at(end),
            normal: Vec3::Z,
            triangle: 0,
        });
        let object = |closed| Object {
            name: "o".into(),
            mesh: Arc::default(),
            scratches: Arc::new(vec![Scratch {
                profile: Profile {
                    width_um: 2.0,
                    depth_nm: 100.0,
                    ..Profile::default()
                },
                layer: 0,
                closed,
                segments: 0..4,
            }]),
            segments: Arc::new(segments.to_vec()),
            parts: Arc::default(),
            gratings: Vec::new(),
            is_lamp: false,
        };
        let open = grooves(&object(false), |_| 0);
        let beyond: Vec<_> = open.iter().map(|g| (g.before_um, g.after_um)).collect();
        let expected = [(0.0, 2500.0), (1000.0, 500.0), (3000.0, 0.0)];
        assert_eq!(beyond.len(), 3, "a piece of no length is no groove");
        for (found, right) in beyond.iter().zip(expected) {
            assert!((found.0 - right.0).abs() < 0.01 && (found.1 - right.1).abs() < 0.01);
        }
        assert!(
            grooves(&object(true), |_| 0)
                .iter()
                .all(|g| g.before_um.is_infinite())
        );
    }
}
