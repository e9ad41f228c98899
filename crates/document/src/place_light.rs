//! Lights that are moved, turned and sized by hand, or placed so that their highlight lies at a given point.

use glam::{DQuat, DVec3};
use hairline_scene::vector_area_m2;

use crate::description::{Light, LightKind};
use crate::schema::{LARGEST_M, SMALLEST_M};

/// The middle of a light: of a polygon the centroid of its area, of a sun far off.
pub fn center(light: &Light) -> DVec3 {
    match &light.kind {
        LightKind::Sphere { center_m, .. }
        | LightKind::Disk { center_m, .. }
        | LightKind::Rectangle { center_m, .. } => (*center_m).into(),
        LightKind::Tube { ends_m, .. } => {
            let [a, b] = ends_m.map(DVec3::from);
            a.midpoint(b)
        }
        LightKind::Polygon { vertices_m, .. } => centroid(&points(vertices_m)),
        LightKind::Sun { .. } => light.kind.middle_m(),
    }
}

/// Moves a light; a sun stays where it is.
pub fn translate(light: &mut Light, delta_m: DVec3) {
    each_point(light, |point| point + delta_m);
}

/// Turns a light about its middle, a sun about the scene; a sphere stays as it is.
pub fn rotate(light: &mut Light, axis: DVec3, angle_rad: f64) {
    let Some(axis) = axis.try_normalize() else {
        return;
    };
    turn(light, DQuat::from_axis_angle(axis, angle_rad));
}

/// Largest distance of a light's points from its middle; 0 for a sun.
pub fn extent_m(light: &Light) -> f64 {
    let middle = center(light);
    match &light.kind {
        LightKind::Sphere { radius_m, .. } => *radius_m,
        LightKind::Tube { ends_m, radius_m } => radius_m + middle.distance(ends_m[0].into()),
        LightKind::Sun { .. } => 0.0,
        kind => (kind.corners_m().iter())
            .map(|v| v.distance(middle))
            .fold(0.0, f64::max),
    }
}

/// Scales a light about its middle, as far as lights may be small or large. What it radiates per area stays, so a larger one
/// lights more. A sun stays as it is.
pub fn resize(light: &mut Light, factor: f64) {
    if light.kind.sunbeam().is_some() {
        return;
    }
    let middle = center(light);
    let extent_m = extent_m(light);
    // Corners stay within the coordinates that scenes have.
    let largest_m = (LARGEST_M - middle.abs().max_element()).max(SMALLEST_M);
    let wanted_m = (extent_m * factor).clamp(SMALLEST_M, largest_m);
    if !wanted_m.is_finite() || !(extent_m > 0.0) {
        return;
    }
    let factor = wanted_m / extent_m;
    let scale = |point: &mut [f64; 3]| {
        let arm = DVec3::from(*point) - middle;
        *point = (middle + arm * factor).into();
    };
    match &mut light.kind {
        LightKind::Sphere { radius_m, .. } | LightKind::Disk { radius_m, .. } => {
            *radius_m = (*radius_m * factor).clamp(SMALLEST_M, LARGEST_M);
        }
        LightKind::Tube { ends_m, radius_m } => {
            *radius_m = (*radius_m * factor).clamp(SMALLEST_M, LARGEST_M);
            // Shorter, its ends would be one.
            if ends_m.map(DVec3::from)[0].distance(middle) * factor >= SMALLEST_M {
                ends_m.iter_mut().for_each(scale);
            }
        }
        LightKind::Rectangle {
            width_m, height_m, ..
        } => {
            for side_m in [width_m, height_m] {
                *side_m = (*side_m * factor).clamp(SMALLEST_M, LARGEST_M);
            }
        }
        LightKind::Polygon { vertices_m, .. } => vertices_m.iter_mut().for_each(scale),
        LightKind::Sun { .. } => {}
    }
}

/// Moves a light so that an eye sees the middle of its mirror image at a point of a surface. It keeps its distance to the
/// point and its size; a flat light is turned to face the point, by the shortest way. A sun shines from that side.
///
/// The side of the surface is the one that the eye is on. Nothing happens where the point is the eye or the light's middle.
pub fn place_highlight(light: &mut Light, eye_m: DVec3, point_m: DVec3, normal: DVec3) {
    let (Some(wo), Some(normal)) = ((eye_m - point_m).try_normalize(), normal.try_normalize())
    else {
        return;
    };
    // Even in the normal: the side does not matter.
    let wi = 2.0 * wo.dot(normal) * normal - wo;
    if let LightKind::Sun { direction, .. } = &mut light.kind {
        *direction = rounded(-wi);
        return;
    }
    let middle = center(light);
    let distance_m = middle.distance(point_m);
    if !(distance_m > 0.0) {
        return;
    }
    translate(light, point_m + wi * distance_m - middle);
    face(light, point_m);
}

/// Brings a light nearer to a point, or farther from it, in the direction in which it stands. Nothing happens where its middle is the point.
pub fn set_distance_m(light: &mut Light, point_m: DVec3, distance_m: f64) {
    let middle = center(light);
    if let Some(way) = (middle - point_m).try_normalize() {
        translate(light, point_m + way * distance_m - middle);
    }
}

/// Turns a flat light about its middle, by the shortest way, until it faces a point. Others stay as they are.
fn face(light: &mut Light, point_m: DVec3) {
    let Some(normal) = light.kind.axis() else {
        return;
    };
    let Some(towards) = (point_m - center(light)).try_normalize() else {
        return;
    };
    let two_sided = light.kind.is_two_sided();
    let towards = match two_sided && normal.dot(towards) < 0.0 {
        true => -towards,
        false => towards,
    };
    turn(light, DQuat::from_rotation_arc(normal, towards));
}

/// A unit direction without digits that nobody sees, for a file that people read.
fn rounded(direction: DVec3) -> [f64; 3] {
    // Not -0.
    ((direction * 1e6).round() / 1e6 + 0.0).into()
}

fn turn(light: &mut Light, rotation: DQuat) {
    turn_about(light, center(light), rotation);
}

/// Turns a light about a point.
pub(crate) fn turn_about(light: &mut Light, middle: DVec3, rotation: DQuat) {
    if let (Some(beam), LightKind::Sun { direction, .. }) = (light.kind.sunbeam(), &mut light.kind)
    {
        *direction = rounded(rotation * beam);
        return;
    }
    let corners_m = light.kind.corners_m();
    each_point(light, |point| middle + rotation * (point - middle));
    if let [a, b, ..] = corners_m[..] {
        light.kind.lay_width_along(rotation * (b - a));
    }
}

fn each_point(light: &mut Light, change: impl Fn(DVec3) -> DVec3) {
    let change = |point: &mut [f64; 3]| *point = change((*point).into()).into();
    let target = light.cone.as_mut().and_then(|cone| cone.target_m.as_mut());
    target.into_iter().for_each(change);
    match &mut light.kind {
        LightKind::Sphere { center_m, .. } => change(center_m),
        LightKind::Disk {
            center_m, target_m, ..
        }
        | LightKind::Rectangle {
            center_m, target_m, ..
        } => [center_m, target_m].into_iter().for_each(change),
        LightKind::Tube { ends_m, .. } => ends_m.iter_mut().for_each(change),
        LightKind::Polygon { vertices_m, .. } => vertices_m.iter_mut().for_each(change),
        LightKind::Sun { .. } => {}
    }
}

fn points(vertices_m: &[[f64; 3]]) -> Vec<DVec3> {
    vertices_m.iter().map(|&v| v.into()).collect()
}

fn centroid(vertices: &[DVec3]) -> DVec3 {
    let total = vector_area_m2(vertices);
    let weighted: DVec3 = fan(vertices)
        .map(|(middle, area)| middle * area.dot(total))
        .sum();
    let centroid = weighted / total.length_squared();
    match centroid.is_finite() {
        true => centroid,
        false => vertices.iter().sum::<DVec3>() / vertices.len().max(1) as f64,
    }
}

/// The triangles of a fan from the first vertex: the middle of each and its vector area, which is turned where the polygon
/// is not convex.
fn fan(vertices: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    vertices.windows(2).map(|edge| {
        let [a, b, c] = [vertices[0], edge[0], edge[1]];
        ((a + b + c) / 3.0, (b - a).cross(c - a) / 2.0)
    })
}
