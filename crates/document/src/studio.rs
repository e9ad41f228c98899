//! A studio for products, made by code: the positions of its lights about the camera's subject, and the ground under it.

use glam::DVec3;
use hairline_sky::BuiltInMap;

use crate::description::{
    self, Camera, Environment, Light, LightKind, Map, Material, MaterialKind, Object, Shape,
    Studio, Surface, Up,
};
use crate::schema::{LARGEST_M, SMALLEST_M};

/// Radiance of the room around: enough that metal is nowhere black, too little to be seen as a wall.
const ROOM_INTENSITY: f64 = 0.25;
/// The ground's over the set's radius: its rim is out of the picture unless the camera lies low.
const GROUND_RADII: f64 = 40.0;
/// Distance of the ground below the lowest point, over the set's radius: a sheet that lies lowest is not cut by it.
const GAP: f64 = 2e-4;
/// Size of a set, over the visible extent, from which on it is a room: the studio then stands about the camera's target.
const ROOM: f64 = 3.0;
/// Range of the lamp's elevation as seen from the set.
const LAMP_ELEVATION_DEG: std::ops::RangeInclusive<f64> = 25.0..=60.0;

/// Frame of a studio about the objects.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhotoSet {
    /// Middle of the set on the ground.
    base_m: DVec3,
    radius_m: f64,
    /// Axes of the world's floor plan as the camera sees it, and up.
    right: DVec3,
    ahead: DVec3,
    up: DVec3,
    /// Elevation of the camera above the ground.
    elevation_rad: f64,
}

/// A rectangle that shines on the subject of a set. Lengths are in the set's radii, axes to the right, behind and up.
pub(crate) struct SoftBox {
    pub name: &'static str,
    /// Middle of the box.
    pub at: [f64; 3],
    /// Width and height.
    pub size: [f64; 2],
    pub radiance: f64,
    /// Linear Rec.709.
    pub color: [f64; 3],
    /// Direction of the lamp's width.
    pub along: DVec3,
}

impl Studio {
    /// Returns lights that would replace the studio: `bounds_m` is the box around all of the scene's objects.
    pub fn lights(&self, camera: &Camera, bounds_m: (DVec3, DVec3)) -> Vec<Light> {
        PhotoSet::new(camera, bounds_m).lights(self)
    }

    /// Environment of the room, for a scene without one of its own.
    pub fn room(&self) -> Environment {
        Environment {
            map: Map::BuiltIn(BuiltInMap::Overcast),
            rotation_deg: 0.0,
            intensity: ROOM_INTENSITY * self.intensity,
            visible: true,
        }
    }
}

impl PhotoSet {
    /// Makes the studio around a box that contains all objects, for a camera.
    pub(crate) fn new(camera: &Camera, (least, most): (DVec3, DVec3)) -> Self {
        let up = camera.world_up();
        let [eye, target] = [camera.position_m, camera.target_m].map(DVec3::from);
        let view = target - eye;
        let right = view.cross(up);
        // A camera that looks straight down has a right side all the same.
        let right = match right.length() > 1e-6 * view.length() {
            true => right.normalize(),
            false => view.cross(camera.up.into()).normalize_or(DVec3::X),
        };
        let seen_m = view.length() * (0.5 * camera.fov_y_deg.to_radians()).tan();
        let (middle, radius_m) = match 0.5 * least.distance(most) {
            radius_m if radius_m <= ROOM * seen_m => (least.midpoint(most), radius_m),
            _ => (target, seen_m),
        };
        let lowest = least.dot(up).min(most.dot(up));
        let level = lowest.max(middle.dot(up) - radius_m);
        Self {
            base_m: middle + (level - middle.dot(up)) * up,
            radius_m,
            right,
            ahead: up.cross(right),
            up,
            elevation_rad: (-view.dot(up) / view.length()).asin(),
        }
    }

    /// Half the diagonal of the box around all objects.
    pub(crate) fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// A large soft box above, a strip on either side, a dim one behind the camera, and a small lamp that colours scratches.
    pub(crate) fn lights(&self, studio: &Studio) -> Vec<Light> {
        let soft_boxes = [
            SoftBox {
                name: "soft box above",
                at: [0.2, 0.1, 3.2],
                size: [3.4, 2.2],
                radiance: 4.0,
                color: [1.0; 3],
                along: DVec3::X,
            },
            SoftBox {
                name: "strip left",
                at: [-3.0, 0.0, 1.7],
                size: [1.2, 2.8],
                radiance: 4.5,
                color: [0.93, 0.97, 1.0],
                along: DVec3::Y,
            },
            SoftBox {
                name: "strip right",
                at: [3.0, 0.7, 1.5],
                size: [0.6, 2.6],
                radiance: 7.0,
                color: [1.0, 0.95, 0.88],
                along: DVec3::Y,
            },
            SoftBox {
                name: "fill",
                at: [1.4, -3.6, 2.8],
                size: [3.0, 2.2],
                radiance: 0.8,
                color: [1.0; 3],
                along: DVec3::X,
            },
        ];
        let mut lights: Vec<Light> = (soft_boxes.iter())
            .map(|soft_box| self.soft_box(studio, soft_box))
            .collect();
        // About where a level surface mirrors it to the camera: its colours lie on what lies flat.
        let (low, high) = LAMP_ELEVATION_DEG.into_inner();
        let elevation_rad = self
            .elevation_rad
            .to_degrees()
            .clamp(low, high)
            .to_radians();
        let (sin, cos) = elevation_rad.sin_cos();
        let center_m = self.world_point_m(studio, 4.1 * DVec3::new(-0.2, cos, sin));
        lights.push(Light {
            name: Some("lamp".to_owned()),
            radiance: 800.0 * studio.intensity,
            color: [1.0, 0.95, 0.88],
            ..Light::new(LightKind::sphere(center_m.into(), 0.05 * self.radius_m))
        });
        lights
    }

    /// Right of, behind and above the set, in its radii.
    fn world_point_m(&self, studio: &Studio, place: DVec3) -> DVec3 {
        let turn = glam::DQuat::from_axis_angle(self.up, studio.rotation_deg.to_radians());
        let offset = place.x * self.right + place.y * self.ahead + place.z * self.up;
        self.base_m + self.radius_m * (turn * offset)
    }

    pub(crate) fn soft_box(&self, studio: &Studio, soft_box: &SoftBox) -> Light {
        let [width, height] = soft_box.size;
        let mut kind = LightKind::Rectangle {
            center_m: self.world_point_m(studio, soft_box.at.into()).into(),
            target_m: self.world_point_m(studio, DVec3::new(0.0, 0.0, 0.4)).into(),
            width_m: width * self.radius_m,
            height_m: height * self.radius_m,
            rotation_deg: 0.0,
            two_sided: false,
        };
        kind.lay_width_along(self.world_point_m(studio, soft_box.along) - self.base_m);
        Light {
            name: Some(soft_box.name.to_owned()),
            radiance: soft_box.radiance * studio.intensity,
            color: soft_box.color,
            ..Light::new(kind)
        }
    }

    /// The ground and its material.
    pub(crate) fn ground(&self, ground: &description::Ground) -> (Object, Material) {
        let level = self.base_m.dot(self.up);
        let height_m = ground.height_m.unwrap_or(level - GAP * self.radius_m);
        let rotation_deg = match self.up {
            DVec3::Y => [-90.0, 0.0, 0.0],
            DVec3::NEG_Y => [90.0, 0.0, 0.0],
            DVec3::X => [0.0, 90.0, 0.0],
            DVec3::NEG_X => [0.0, -90.0, 0.0],
            DVec3::NEG_Z => [180.0, 0.0, 0.0],
            _ => [0.0; 3],
        };
        let object = Object {
            name: "ground".to_owned(),
            surface: Surface::Shape(Shape::Disk {
                radius_m: (GROUND_RADII * self.radius_m).clamp(SMALLEST_M, LARGEST_M),
            }),
            up: Up::default(),
            fit_m: None,
            time_s: None,
            animation: None,
            overrides: Vec::new(),
            material: Some("ground".to_owned()),
            translation_m: (self.base_m + (height_m - level) * self.up).into(),
            rotation_deg,
            scale: [1.0; 3],
            hidden: false,
        };
        let material = Material {
            name: "ground".to_owned(),
            kind: MaterialKind::Dielectric {
                ior: 1.45,
                base_color: ground.color,
            },
            roughness: ground.roughness,
            coherence_um: description::DEFAULT_COHERENCE_UM,
            coat: None,
            cover: None,
            anisotropy: None,
        };
        (object, material)
    }
}
