//! Subject of a scene: the objects that a view of the whole scene frames.

use crate::description::Description;
use glam::DVec3;

/// Largest thickness of a ground, as a share of its longest side.
const FLAT: f64 = 0.03;
/// Least size of a ground over the size of all other objects.
const WIDE: f64 = 2.0;

/// The objects that are not the ground that others stand on, nor a room around them and the camera. What has scratches always
/// counts. `boxes_m` are the objects' bounding boxes, in their order; where nothing is left, all count.
pub fn objects(description: &Description, boxes_m: &[(DVec3, DVec3)]) -> Vec<usize> {
    let eye_m = DVec3::from(description.camera.position_m);
    let is_shown = |&i: &usize| description.objects.get(i).is_none_or(|it| !it.hidden);
    let mut subject: Vec<usize> = (0..boxes_m.len()).filter(is_shown).collect();
    // The largest first: of two tables one upon the other, both go.
    let mut by_size = subject.clone();
    by_size.sort_by(|&a, &b| size_m(&boxes_m[b]).total_cmp(&size_m(&boxes_m[a])));
    for i in by_size {
        let own = description.objects.get(i).map(|it| it.name.as_str());
        if (description.scratches.iter()).any(|layer| Some(layer.object.as_str()) == own) {
            continue;
        }
        let others = subject.iter().filter(|&&other| other != i);
        let rest = others
            .map(|&other| boxes_m[other])
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let Some(rest) = rest else { continue };
        let (low_m, high_m) = boxes_m[i];
        let sides = high_m - low_m;
        let is_flat = sides.min_element() <= FLAT * sides.max_element();
        let is_ground = is_flat && size_m(&boxes_m[i]) > WIDE * size_m(&rest);
        let is_room = [eye_m, rest.0, rest.1]
            .iter()
            .all(|point| point.cmpge(low_m).all() && point.cmple(high_m).all());
        if is_ground || is_room {
            subject.retain(|&other| other != i);
        }
    }
    subject
}

fn size_m((low_m, high_m): &(DVec3, DVec3)) -> f64 {
    low_m.distance(*high_m)
}
