//! Moving the camera: a turntable about its target, as the scene file's own camera, so that a view is saved as it is.
//!
//! Pixels count to the right and down, as a pointer moves; `size_px` is the size of the view.

use crate::description::{Camera, Description};
use crate::framing;
use crate::place_light::turn_about;
use crate::schema::{LARGEST_M, SMALLEST_M};
use glam::{DQuat, DVec2, DVec3};

/// A view along `up` has no up, so the poles are kept away from by this: less than a pixel's difference to the eye.
const POLE_RAD: f64 = 1e-3;
/// A drag over the whole height turns by this.
const TURN_PER_HEIGHT_RAD: f64 = std::f64::consts::PI;
/// Factor of one step of a wheel on the distance.
const STEP_FACTOR: f64 = 0.88;
/// The target is never nearer than this, nor farther than that.
const DISTANCES_M: std::ops::RangeInclusive<f64> = 10.0 * SMALLEST_M..=LARGEST_M;
/// Share of the view, on its tighter side, that framed points fill: a margin of 6 % stays on each side.
const FRAMED_SHARE: f64 = 0.88;

/// Turns the camera about its target by a drag: the surface follows the pointer. Goes no further than above and below the
/// target.
pub fn orbit(camera: &mut Camera, drag_px: DVec2, size_px: DVec2) {
    let per_px = TURN_PER_HEIGHT_RAD / size_px.y.max(1.0);
    turn(camera, -drag_px.x * per_px);
    let place = TurntablePosition::new(camera);
    let polar_rad = place.polar_rad - drag_px.y * per_px;
    TurntablePosition { polar_rad, ..place }.give(camera);
}

/// Turns the camera about the axis through its target along `up`, counter-clockwise seen from above, at the same height.
pub fn turn(camera: &mut Camera, angle_rad: f64) {
    let place = TurntablePosition::new(camera);
    TurntablePosition {
        outwards: DQuat::from_axis_angle(place.up, angle_rad) * place.outwards,
        ..place
    }
    .give(camera);
}

/// What a turntable turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Turns {
    /// The camera, about its target.
    #[default]
    Camera,
    /// The objects, before the camera and under the lights.
    Object,
    /// Lights, studio and environment, about objects and camera that stand still.
    Lights,
}

/// Turns a turntable.
pub fn turn_table(scene: &mut Description, turns: Turns, angle_rad: f64) {
    match turns {
        Turns::Camera => turn(&mut scene.camera, angle_rad),
        Turns::Object => turn_surroundings(scene, angle_rad),
        Turns::Lights => {
            turn_lights(scene, angle_rad);
            let rotation_deg = &mut scene.studio.rotation_deg;
            *rotation_deg = (*rotation_deg + angle_rad.to_degrees()) % 360.0;
        }
    }
}

/// Turns camera, lights and environment as [`turn`] does, and the objects alone stay: seen by the camera, these turn, as on a turntable, and the
/// mirror images of lights stand still on a floor.
pub fn turn_surroundings(scene: &mut Description, angle_rad: f64) {
    // A studio stands about the camera.
    turn(&mut scene.camera, angle_rad);
    turn_lights(scene, angle_rad);
}

/// Turns lights and environment about the axis of [`turn`].
fn turn_lights(scene: &mut Description, angle_rad: f64) {
    let middle = DVec3::from(scene.camera.target_m);
    let rotation = DQuat::from_axis_angle(unit_up(&scene.camera), angle_rad);
    for light in &mut scene.lights {
        turn_about(light, middle, rotation);
    }
    if let Some(environment) = &mut scene.environment {
        environment.rotation_deg = (environment.rotation_deg + angle_rad.to_degrees()) % 360.0;
    }
}

/// Moves camera and target by a drag: points at the target's depth follow the pointer exactly.
pub fn pan(camera: &mut Camera, drag_px: DVec2, size_px: DVec2) {
    let axes = Axes::new(camera);
    let m_per_px = 2.0 * half_fov_tan(camera) * axes.distance_m / size_px.y.max(1.0);
    let moved = (axes.up * drag_px.y - axes.right * drag_px.x) * m_per_px;
    shift(camera, moved);
}

/// Moves the camera towards its target by steps of a wheel, away from it for negative ones; each step by the same share, so
/// that it never passes the target.
pub fn dolly(camera: &mut Camera, steps: f64) {
    let axes = Axes::new(camera);
    let distance_m =
        (axes.distance_m * STEP_FACTOR.powf(steps)).clamp(*DISTANCES_M.start(), *DISTANCES_M.end());
    let target = DVec3::from(camera.target_m);
    camera.position_m = (target - axes.forward * distance_m).into();
}

/// Moves the camera towards a point by steps of a wheel, the target along with it: the point stays where it is in the view.
pub fn zoom_to(camera: &mut Camera, point_m: DVec3, steps: f64) {
    let distance_m = Axes::new(camera).distance_m;
    let wanted = distance_m * STEP_FACTOR.powf(steps);
    let factor = wanted.clamp(*DISTANCES_M.start(), *DISTANCES_M.end()) / distance_m;
    for place in [&mut camera.position_m, &mut camera.target_m] {
        *place = (point_m + (DVec3::from(*place) - point_m) * factor).into();
    }
}

/// Zooms to a point of the ground behind or beside the subject of the view: the target keeps its depth in place of coming to the point, as
/// long as it stays before the camera.
pub fn zoom_past(camera: &mut Camera, point_m: DVec3, steps: f64) {
    let target_m = DVec3::from(camera.target_m);
    zoom_to(camera, point_m, steps);
    if let Some(depth_m) = depth_m(camera, target_m) {
        let place = DVec3::from(camera.position_m) + Axes::new(camera).forward * depth_m;
        camera.target_m = place.into();
    }
}

/// Depth of a point before a camera, along its view; none where it can be neither target nor in focus.
pub fn depth_m(camera: &Camera, point_m: DVec3) -> Option<f64> {
    let from_eye = point_m - DVec3::from(camera.position_m);
    let depth_m = from_eye.dot(Axes::new(camera).forward);
    DISTANCES_M.contains(&depth_m).then_some(depth_m)
}

/// The point in the middle of the view that is in focus.
pub fn focused_m(camera: &Camera) -> DVec3 {
    DVec3::from(camera.position_m) + Axes::new(camera).forward * camera.lens().focus_m
}

/// Makes a point the target, and moves the camera along with it: direction and distance stay.
pub fn center_on(camera: &mut Camera, point_m: DVec3) {
    shift(camera, point_m - DVec3::from(camera.target_m));
}

/// Moves the camera so that some points fill the view, without turning it. The target comes to the depth of their middle.
///
/// `aspect` is the view's width over its height. Points without extent are only centred; none change nothing.
pub fn frame_points(camera: &mut Camera, points_m: &[DVec3], aspect: f64) {
    let low = points_m.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points_m
        .iter()
        .copied()
        .fold(DVec3::NEG_INFINITY, DVec3::max);
    if !(low.is_finite() && high.is_finite()) {
        return;
    }
    if low.distance(high) < SMALLEST_M {
        center_on(camera, 0.5 * (low + high));
        return;
    }
    let axes = Axes::new(camera);
    let tan_y = half_fov_tan(camera) * FRAMED_SHARE;
    let tan = DVec2::new(tan_y * aspect.max(1e-3), tan_y);
    let view = framing(points_m, [axes.right, axes.up, axes.forward], tan);
    camera.position_m = view.position_m.into();
    camera.target_m = view.target_m.into();
}

/// The height of the view at the depth of a point, in metres.
pub fn view_height_m(camera: &Camera, point_m: DVec3) -> f64 {
    let axes = Axes::new(camera);
    let depth_m = (point_m - DVec3::from(camera.position_m)).dot(axes.forward);
    let depth_m = if depth_m > 0.0 {
        depth_m
    } else {
        axes.distance_m
    };
    2.0 * half_fov_tan(camera) * depth_m
}

/// The eight corners of a box.
pub fn corners(low_m: DVec3, high_m: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let pick = |axis: usize, bit: usize| match i >> bit & 1 {
            0 => low_m[axis],
            _ => high_m[axis],
        };
        DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    })
}

hairline_image::listed! {
    /// Direction to look from.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Viewpoint {
        /// The direction in which glTF models look: +z if y is up; -y if z is up.
        Front = "Front";
        /// Opposite to the front.
        Back = "Back";
        /// The left side of the front view.
        Left = "Left";
        /// The right side of the front view.
        Right = "Right";
        /// The direction of `up`; the front is at the bottom of the picture.
        Top = "Top";
        /// The direction opposite to `up`.
        Bottom = "Bottom";
        /// The front, the right and above at once.
        ThreeQuarter = "Three-quarter";
    }
    /// Name in a menu.
    fn name;
}

/// Moves the camera to a viewpoint, at the same distance from the same target.
pub fn look_from(camera: &mut Camera, viewpoint: Viewpoint) {
    let up = unit_up(camera);
    let front = front_of(up);
    let right = up.cross(front);
    const QUARTER_RAD: f64 = std::f64::consts::FRAC_PI_2;
    let (outwards, polar_rad) = match viewpoint {
        Viewpoint::Front => (front, QUARTER_RAD),
        Viewpoint::Back => (-front, QUARTER_RAD),
        Viewpoint::Left => (-right, QUARTER_RAD),
        Viewpoint::Right => (right, QUARTER_RAD),
        Viewpoint::Top => (front, 0.0),
        Viewpoint::Bottom => (front, std::f64::consts::PI),
        Viewpoint::ThreeQuarter => ((front + 0.7 * right).normalize(), 1.0),
    };
    TurntablePosition {
        up,
        outwards,
        polar_rad,
        distance_m: Axes::new(camera).distance_m,
    }
    .give(camera);
}

/// Position of the camera on the turntable.
#[derive(Clone, Copy)]
struct TurntablePosition {
    /// Unit.
    up: DVec3,
    /// Unit, level: from the axis to the camera.
    outwards: DVec3,
    /// Angle from `up` to the direction from the target to the camera.
    polar_rad: f64,
    distance_m: f64,
}

impl TurntablePosition {
    fn new(camera: &Camera) -> Self {
        let axes = Axes::new(camera);
        let up = unit_up(camera);
        let to_camera = -axes.forward;
        let level = to_camera - up * to_camera.dot(up);
        Self {
            up,
            outwards: level.try_normalize().unwrap_or_else(|| front_of(up)),
            polar_rad: level.length().atan2(to_camera.dot(up)),
            distance_m: axes.distance_m,
        }
    }

    fn give(self, camera: &mut Camera) {
        let polar_rad = self
            .polar_rad
            .clamp(POLE_RAD, std::f64::consts::PI - POLE_RAD);
        let (sin, cos) = polar_rad.sin_cos();
        let to_camera = self.up * cos + self.outwards * sin;
        camera.position_m = (DVec3::from(camera.target_m) + to_camera * self.distance_m).into();
    }
}

/// The directions of a view.
struct Axes {
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    distance_m: f64,
}

impl Axes {
    fn new(camera: &Camera) -> Self {
        let way = DVec3::from(camera.target_m) - DVec3::from(camera.position_m);
        let forward = way.normalize_or(DVec3::NEG_Z);
        let right = forward
            .cross(unit_up(camera))
            .try_normalize()
            .unwrap_or_else(|| forward.any_orthonormal_vector());
        Self {
            forward,
            right,
            up: right.cross(forward),
            distance_m: way.length().max(SMALLEST_M),
        }
    }
}

fn unit_up(camera: &Camera) -> DVec3 {
    DVec3::from(camera.up).normalize_or(DVec3::Y)
}

/// The level direction that is the front: +z of glTF, whose up is y, and -y where z is up.
fn front_of(up: DVec3) -> DVec3 {
    let front = match up.abs().max_position() {
        1 => DVec3::Z,
        _ => DVec3::NEG_Y,
    };
    (front - up * front.dot(up)).normalize_or(up.any_orthonormal_vector())
}

fn half_fov_tan(camera: &Camera) -> f64 {
    (0.5 * camera.fov_y_deg.to_radians()).tan()
}

fn shift(camera: &mut Camera, by_m: DVec3) {
    for place in [&mut camera.position_m, &mut camera.target_m] {
        *place = (DVec3::from(*place) + by_m).into();
    }
}
