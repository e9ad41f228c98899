//! Light in which scratches show: small hard lamps whose highlights lie where the colours around them fill most of the visible surface, strips
//! that draw the form, and a dark room.

use std::f64::consts::PI;

use glam::DVec3;
use hairline_optics::ggx::{ggx_alpha, ggx_eval};
use hairline_scene::{Base, Material, Mesh, Scene, Texture};

use crate::description::{Camera, Description, Environment, Ground, Light, LightKind, Studio};
use crate::seen_surface::{SeenPoint, seen_points};
use crate::studio::{PhotoSet, SoftBox};

/// Lamps at most: each takes time, and three highlights fill most shapes.
const LAMPS_MAX: usize = 3;
/// Least share of the visible points that a lamp must add to be worth its time.
const LEAST_GAIN: f64 = 0.02;
/// Scratches are bright where normals are this near to that of a highlight.
const FAN_DEG: f64 = 10.0;
/// Angle of a highlight beyond which another lamp serves.
const APART_DEG: f64 = 16.0;
/// The height of a lamp, at least, as a highlight sees it: lower ones would stand in the ground.
const LEAST_ELEVATION_DEG: f64 = 6.0;
/// Distance of lamps, in radii of the set.
const LAMP_DISTANCE: f64 = 4.1;
const LAMP_RADIUS: f64 = 0.05;
/// Radiance of a lamp over a body that sends back all light: three such lamps make it white.
const LAMP_RADIANCE: f64 = 800.0;
/// Factor on the radiance of a lamp over metals and black bodies, whose light is mirror images alone.
const DARKEST_BODY: f64 = 15.0;
/// Places that are tried, at most.
const PLACES_MAX: usize = 400;
/// The radiance that lamps give to a seen point at most, but for a share of the points: highlights may be white.
const BRIGHT: f64 = 0.75;
const BRIGHT_SHARE: f64 = 0.25;
/// Radiance of the room over that of a studio's room.
const ROOM: f64 = 0.25;

/// Ground under a model: its mirror image is as dark as the room's.
pub(crate) const DARK_GROUND: Ground = Ground {
    hidden: false,
    color: [0.02, 0.02, 0.021],
    roughness: 0.55,
    height_m: None,
    shadows_only: false,
};

impl Description {
    /// Replaces the scene's lights, studio and environment by lights that show its scratches, and darkens its ground plane. `scene` is what it was
    /// built to. Scratched objects count, or all where there are none.
    pub fn light_for_scratches(&mut self, scene: &Scene) {
        let is_scratched = |name: &str| self.scratches.iter().any(|layer| layer.object == name);
        let any = (scene.objects.iter()).any(|object| is_scratched(&object.name));
        let (subject, others): (Vec<_>, Vec<_>) = (scene.objects.iter())
            .filter(|object| !object.is_lamp)
            .partition(|object| is_scratched(&object.name) || !any);
        let meshes: Vec<&Mesh> = (subject.iter().chain(&others))
            .map(|it| &*it.mesh)
            .collect();
        let subject = Subject {
            meshes: &meshes,
            count: subject.len(),
            materials: &scene.materials,
            textures: &scene.textures,
        };
        self.lights = subject.lights(&self.camera, self.render.size_px);
        self.studio = Studio::NONE;
        self.environment = Some(Environment::dark_room());
        if let Some(ground) = &mut self.ground {
            // As bright as lamps for metals are, a grey one would be white.
            let dark = DARK_GROUND.color;
            ground.color = std::array::from_fn(|c| ground.color[c].min(dark[c]));
        }
    }
}

impl Environment {
    /// The room of such lights.
    pub(crate) fn dark_room() -> Self {
        let room = Studio::default().room();
        Self {
            intensity: ROOM * room.intensity,
            ..room
        }
    }
}

/// Meshes and materials that are lit.
pub(crate) struct Subject<'a> {
    /// Meshes in world space.
    pub meshes: &'a [&'a Mesh],
    /// Number of meshes to be lit, the first ones; others may hide lights.
    pub count: usize,
    /// Materials of the meshes.
    pub materials: &'a [Material],
    pub textures: &'a [Texture],
}

impl Subject<'_> {
    /// Lights for the subject; none where there is nothing.
    pub(crate) fn lights(&self, camera: &Camera, size_px: [u32; 2]) -> Vec<Light> {
        let own = self.meshes[..self.count].iter();
        let shown = own.filter(|mesh| !mesh.triangles.is_empty());
        let bounds = shown.map(|mesh| mesh.bounds_m());
        let Some((least, most)) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else {
            return Vec::new();
        };
        let set = PhotoSet::new(camera, (least.as_dvec3(), most.as_dvec3()));
        let seen = seen_points(camera, size_px, self.meshes);
        let seen: Vec<_> = (seen.into_iter())
            .filter(|it| it.mesh < self.count)
            .collect();
        let lamps = Lamps {
            eye_m: camera.position_m.into(),
            up: camera.world_up(),
            distance_m: LAMP_DISTANCE * set.radius_m(),
            meshes: self.meshes,
        };
        let centers_m = lamps.places(&seen);
        let radiance = LAMP_RADIANCE / self.mean_albedo(&seen).max(1.0 / DARKEST_BODY);
        // Faces that mirror a lamp to the eye are brighter than what lies beside a highlight.
        let brighter = self.brighter_points(&seen, &lamps, &centers_m);
        let radiance = radiance.min(BRIGHT / brighter.max(f64::MIN_POSITIVE));
        let lamp = |(i, center_m): (usize, DVec3)| Light {
            name: Some(match i {
                0 => "lamp".to_owned(),
                _ => format!("lamp {}", i + 1),
            }),
            radiance,
            color: [1.0, 0.95, 0.88],
            ..Light::new(LightKind::sphere(center_m.into(), lamps.radius_m()))
        };
        let strip = |name, right, color| SoftBox {
            name,
            at: [right, 1.4, 1.5],
            size: [0.35, 3.2],
            radiance: 3.0,
            color,
            along: DVec3::Y,
        };
        let strips = [
            strip("strip left", -2.8, [0.93, 0.97, 1.0]),
            strip("strip right", 2.8, [1.0, 0.95, 0.88]),
        ];
        (centers_m.into_iter().enumerate().map(lamp))
            .chain(strips.map(|strip| set.soft_box(&Studio::default(), &strip)))
            .collect()
    }

    /// The radiance that [`BRIGHT_SHARE`] of the seen points surpass, for lamps of radiance 1.
    fn brighter_points(&self, seen: &[SeenPoint], lamps: &Lamps<'_>, at_m: &[DVec3]) -> f64 {
        let materials = self.materials.iter();
        let reflectances: Vec<_> = materials.map(|it| self.reflectances(it)).collect();
        let radiance = |point: &SeenPoint| -> f64 {
            let material = point.material as usize;
            let alpha = ggx_alpha(self.materials[material].roughness);
            let [mirrored, body] = reflectances[material];
            let from_lamp = |lamp_m: &DVec3| {
                let (wi, wo, distance_m) = lamps.directions(point, *lamp_m);
                let angular_radius = lamps.radius_m() / distance_m;
                let solid_angle = PI * angular_radius * angular_radius;
                // A mirror image is no brighter than its lamp.
                let image = (solid_angle * ggx_eval(wi, wo, alpha)).min(1.0);
                mirrored * image + body * solid_angle / PI * wi.z.max(0.0)
            };
            at_m.iter().map(from_lamp).sum()
        };
        let mut all: Vec<f64> = seen.iter().map(radiance).collect();
        all.sort_by(|a, b| b.total_cmp(a));
        let nth = (BRIGHT_SHARE * all.len() as f64) as usize;
        all.get(nth).copied().unwrap_or(0.0)
    }

    /// Mean albedo of the visible bodies: what they look like beside the mirror images of the lamps.
    fn mean_albedo(&self, seen: &[SeenPoint]) -> f64 {
        let albedo = |material| {
            let [mirrored, body] = self.reflectances(material);
            body + beside_highlight(material.roughness) * mirrored
        };
        let albedos: Vec<f64> = self.materials.iter().map(albedo).collect();
        let sum: f64 = (seen.iter()).map(|it| albedos[it.material as usize]).sum();
        sum / seen.len().max(1) as f64
    }

    /// The share of light that a metal mirrors, and the albedo of a body. The mirror images in dielectrics are left out.
    fn reflectances(&self, material: &Material) -> [f64; 2] {
        let mean = |rgb: [f64; 3]| rgb.iter().sum::<f64>() / 3.0;
        let of_base = match &material.base {
            Base::Mirror => [1.0, 0.0],
            Base::Metal(metal) => [mean(metal.reflectance_rgb(1.0)), 0.0],
            Base::Covered { metal, cover } => [mean(cover.reflectance_rgb(metal, 1.0)), 0.0],
            Base::ColoredMetal { base_color, .. } => [mean(*base_color), 0.0],
            Base::Dielectric { base_color, .. } => [0.0, mean(*base_color)],
            Base::MetallicRoughness {
                base_color,
                metallic,
            } => [*metallic, 1.0 - metallic].map(|share| share * mean(*base_color)),
        };
        let of_texture = material.base_color_texture.map_or(1.0, |texture| {
            // Linear values from the displayed ones.
            let some = self.textures[texture].some_texels();
            let linear =
                |texel: &[u8; 4]| mean([0, 1, 2].map(|c| (f64::from(texel[c]) / 255.0).powf(2.2)));
            some.clone().map(linear).sum::<f64>() / some.count().max(1) as f64
        });
        of_base.map(|reflectance| reflectance * of_texture)
    }
}

/// The albedo of a white diffuse body that is as bright as a white metal beside its highlight, twice as far off as fans of scratches reach: pi times the BRDF of
/// GGX there (docs/model.md, section 3), without masking.
fn beside_highlight(roughness: f64) -> f64 {
    let alpha2 = roughness.powi(4).max(1e-12);
    let cos2 = (2.0 * FAN_DEG).to_radians().cos().powi(2);
    0.25 * alpha2 / (cos2 * (alpha2 - 1.0) + 1.0).powi(2)
}

/// Search for the places of lamps.
struct Lamps<'a> {
    eye_m: DVec3,
    up: DVec3,
    /// Distance of the lamps from their highlights.
    distance_m: f64,
    /// Meshes that may hide the lamps.
    meshes: &'a [&'a Mesh],
}

impl Lamps<'_> {
    /// Places lamps one after the other, each where the fan around its highlight holds most of the points that the lamps before have left.
    fn places(&self, seen: &[SeenPoint]) -> Vec<DVec3> {
        let [fan_cos, apart_cos] = [FAN_DEG, APART_DEG].map(|angle| angle.to_radians().cos());
        let mut left: Vec<SeenPoint> = seen.to_vec();
        let mut lamps = Vec::new();
        while lamps.len() < LAMPS_MAX {
            let mut places: Vec<(usize, DVec3, DVec3)> = (left.iter())
                .step_by(left.len().div_ceil(PLACES_MAX).max(1))
                .filter_map(|point| {
                    let lamp_m = self.lamp_for(point)?;
                    let held = left
                        .iter()
                        .filter(|it| self.is_near(it, lamp_m, fan_cos))
                        .count();
                    Some((held, lamp_m, point.position_m))
                })
                .collect();
            places.sort_by_key(|(held, ..)| std::cmp::Reverse(*held));
            let is_open = |(_, lamp_m, from_m): &&(usize, DVec3, DVec3)| {
                !is_hidden(self.meshes, *from_m, *lamp_m)
            };
            let Some((held, lamp_m, _)) = places.iter().find(is_open) else {
                break;
            };
            if !lamps.is_empty() && (*held as f64) < LEAST_GAIN * seen.len() as f64 {
                break;
            }
            lamps.push(*lamp_m);
            left.retain(|it| !self.is_near(it, *lamp_m, apart_cos));
        }
        lamps
    }

    fn radius_m(&self) -> f64 {
        LAMP_RADIUS / LAMP_DISTANCE * self.distance_m
    }

    /// Directions from a point to a lamp and to the eye, z along its normal, and the lamp's distance.
    fn directions(&self, point: &SeenPoint, lamp_m: DVec3) -> (DVec3, DVec3, f64) {
        let (x, y) = point.normal.any_orthonormal_pair();
        let local = |to_m: DVec3| {
            let to = (to_m - point.position_m).normalize_or(point.normal);
            DVec3::new(to.dot(x), to.dot(y), to.dot(point.normal))
        };
        let distance_m = lamp_m.distance(point.position_m);
        (
            local(lamp_m),
            local(self.eye_m),
            distance_m.max(self.radius_m()),
        )
    }

    /// Place of the lamp whose highlight lies at a point, or the nearest place above the ground.
    fn lamp_for(&self, point: &SeenPoint) -> Option<DVec3> {
        let to_eye = (self.eye_m - point.position_m).try_normalize()?;
        let to_lamp = 2.0 * to_eye.dot(point.normal) * point.normal - to_eye;
        let (sin, cos) = LEAST_ELEVATION_DEG.to_radians().sin_cos();
        let to_lamp = match to_lamp.dot(self.up) {
            height if height < sin => {
                cos * to_lamp.reject_from(self.up).try_normalize()? + sin * self.up
            }
            _ => to_lamp,
        };
        Some(point.position_m + self.distance_m * to_lamp)
    }

    /// Whether the normal at a point and the one that would mirror a lamp have at least this cosine.
    fn is_near(&self, point: &SeenPoint, lamp_m: DVec3, least_cos: f64) -> bool {
        let to_eye = (self.eye_m - point.position_m).normalize_or_zero();
        let to_lamp = (lamp_m - point.position_m).normalize_or_zero();
        let half = (to_eye + to_lamp).normalize_or_zero();
        to_lamp.dot(point.normal) > 0.0 && half.dot(point.normal) > least_cos
    }
}

/// Whether a triangle lies between a point of a surface and a lamp: all are tried, for a few lamps.
fn is_hidden(meshes: &[&Mesh], from_m: DVec3, lamp_m: DVec3) -> bool {
    let to_lamp = lamp_m - from_m;
    // The ends are left out: the surface itself lies there.
    let (first, last) = (1e-3, 1.0 - 1e-3);
    meshes.iter().any(|mesh| {
        mesh.triangles.iter().any(|corners| {
            let [a, b, c] = corners.map(|corner| mesh.positions_m[corner as usize].as_dvec3());
            let (ab, ac, to) = (b - a, c - a, from_m - a);
            // T. Möller and B. Trumbore, 1997, as `intersect_triangle` of hairline-index, which depends on this crate.
            let p = to_lamp.cross(ac);
            let det = ab.dot(p);
            if det == 0.0 {
                return false;
            }
            let q = to.cross(ab);
            let [u, v, t] = [to.dot(p), to_lamp.dot(q), ac.dot(q)].map(|it| it / det);
            u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (first..last).contains(&t)
        })
    })
}
