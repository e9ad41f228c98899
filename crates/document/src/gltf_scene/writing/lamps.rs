//! Lights and the camera of a scene in the words of glTF: KHR_lights_punctual, and the draft EXT_lights_area for those with a surface.

use std::f64::consts::PI;

use glam::{DMat3, DMat4, DVec3};
use hairline_model::gltf_file::GltfFile;
use hairline_optics::spectrum::black_body_rgb;
use serde_json::{Value, json};

use super::nodes::node;
use crate::description::{Cone, Description, Light, LightKind};
use crate::gltf_scene::extension::EXTENSION;

const PUNCTUAL: &str = "KHR_lights_punctual";
/// Draft: pull request 2525 of the repository KhronosGroup/glTF.
const AREA: &str = "EXT_lights_area";
/// Candela of a watt a steradian, as exporters have it; reading takes the same number.
const LUMENS_PER_WATT: f64 = 683.0;
/// The near plane over the distance to the target.
const NEAR: f64 = 1e-3;

/// Adds the lights; their nodes are further roots.
pub(super) fn write(
    described: &Description,
    gltf_from_world: &DMat4,
    file: &mut GltfFile,
    roots: &mut Vec<usize>,
    notes: &mut Vec<String>,
) {
    let mut left_out = Vec::new();
    for (i, light) in described.lights.iter().enumerate() {
        if light.hidden {
            continue;
        }
        let title = light.kind.title();
        let name = light.name.clone().unwrap_or_else(|| format!("{title} {i}"));
        let Some((extension, mut words, world_from_light)) = words(light) else {
            continue;
        };
        file.use_extension(EXTENSION);
        let at = |world_from_light: DMat4| {
            let mut node = node(&name, &(*gltf_from_world * world_from_light));
            // Its table has more to say of it than words of glTF.
            node["extensions"][EXTENSION]["light"] = json!(i);
            node
        };
        if extension == EXTENSION {
            let mut node = at(world_from_light);
            for key in ["color", "intensity"] {
                node["extensions"][EXTENSION][key] = words[key].take();
            }
            roots.push(file.push("nodes", node));
            left_out.push(name);
            continue;
        }
        words["name"] = json!(name);
        let number = file.push_in_extension(extension, "lights", words);
        let mut both = vec![world_from_light];
        if light.kind.is_two_sided() {
            both.push(world_from_light * DMat4::from_rotation_y(PI));
        }
        for world_from_light in both {
            let mut node = at(world_from_light);
            node["extensions"][extension]["light"] = json!(number);
            roots.push(file.push("nodes", node));
        }
        if has_more(light, extension) {
            notes.push(format!(
                "light \"{name}\": other programs show it without its picture, its cone and its barn doors"
            ));
        }
    }
    if !left_out.is_empty() {
        let names = left_out.join("\", \"");
        notes.push(format!(
            "lights that glTF has no words for, and that other programs do not show: \"{names}\""
        ));
    }
    if described.environment.is_some() || !described.studio.hidden {
        notes.push("other programs light the file by environments of their own".to_owned());
    }
}

/// Whether a light is more than an extension has words for.
fn has_more(light: &Light, extension: &str) -> bool {
    let is_shaped = light.picture.is_some() || light.barn_doors_deg.is_some();
    is_shaped || extension == AREA && light.cone.is_some()
}

/// Adds the camera, and returns its node.
pub(super) fn camera(
    described: &Description,
    gltf_from_world: &DMat4,
    file: &mut GltfFile,
) -> usize {
    let camera = described.camera.in_scene();
    let size_px = described.render.size_px;
    let frame = camera.frame(size_px);
    let right = frame.per_px_x.normalize();
    let up = -frame.per_px_y.normalize();
    let axes = DMat3::from_cols(right, up, -frame.forward);
    let world_from_camera = placed(axes, camera.position_m);
    let distance_m = camera.position_m.distance(camera.target_m);
    let number = file.push(
        "cameras",
        json!({
            "name": "camera",
            "type": "perspective",
            "perspective": {
                "yfov": camera.fov_y_rad,
                "aspectRatio": f64::from(size_px[0]) / f64::from(size_px[1]),
                "znear": NEAR * distance_m,
            },
        }),
    );
    let mut node = node("camera", &(*gltf_from_world * world_from_camera));
    node["camera"] = json!(number);
    file.push("nodes", node)
}

fn placed(axes: DMat3, place: DVec3) -> DMat4 {
    DMat4::from_translation(place) * DMat4::from_mat3(axes)
}

fn spot(cone: &Cone) -> Value {
    let outer = 0.5 * cone.cone_deg.to_radians();
    let inner = (outer * (1.0 - cone.cone_softness)).min(outer * (1.0 - 1e-6));
    json!({ "innerConeAngle": inner, "outerConeAngle": outer })
}

/// What the irradiance of a sun is multiplied by for its brightest colour.
fn sun_factor(light: &Light) -> f64 {
    let tint = light.temperature_k.map_or([1.0; 3], black_body_rgb);
    let tinted = (0..3).map(|c| light.color[c] * tint[c]);
    light.exposure_ev.exp2() * tinted.fold(0.0, f64::max)
}

/// A place whose -z is an axis.
fn place_along(axis: DVec3, place: DVec3) -> DMat4 {
    let z = -axis.normalize_or(DVec3::NEG_Z);
    let x = z.any_orthonormal_vector();
    placed(DMat3::from_cols(x, z.cross(x), z), place)
}

/// The place of a rectangle or a disk: its y leads from the lower to the upper edge.
fn flat_place(kind: &LightKind, middle_m: DVec3) -> Option<DMat4> {
    let axis = kind.axis()?;
    let y = match kind {
        LightKind::Rectangle { .. } => {
            let corners = kind.corners_m();
            (corners[3] - corners[0]).normalize_or_zero()
        }
        _ => axis.any_orthonormal_vector(),
    };
    Some(placed(DMat3::from_cols(y.cross(-axis), y, -axis), middle_m))
}

/// The extension that has words for a light, the words, and the light's place: it shines along -z. Of the kinds that glTF does not know the extension
/// of scenes has the colour, and the table the place.
fn words(light: &Light) -> Option<(&'static str, Value, DMat4)> {
    let in_scene = light.in_scene();
    let brightest = in_scene.radiance.into_iter().fold(0.0, f64::max);
    let color = in_scene.radiance.map(|c| match brightest > 0.0 {
        true => c / brightest,
        false => 1.0,
    });
    let luminance = LUMENS_PER_WATT * brightest;
    let flat = |middle_m: [f64; 3], height_m: f64| {
        // What is not above 0 is no light to the draft.
        let intensity = luminance.max(f64::from(f32::MIN_POSITIVE));
        let words = json!({ "color": color, "intensity": intensity, "size": height_m });
        Some((words, flat_place(&light.kind, middle_m.into())?))
    };
    match &light.kind {
        LightKind::Sphere { center_m, radius_m } => {
            let intensity = luminance * PI * radius_m * radius_m;
            let mut words = json!({ "type": "point", "color": color, "intensity": intensity });
            // Where loaders keep them, renderers of scratches find sizes by these names.
            words["extras"] = json!({ "radius": radius_m });
            if let Some(cone) = light.cone.as_ref().filter(|cone| cone.cone_deg < 180.0) {
                words["type"] = json!("spot");
                words["spot"] = spot(cone);
            }
            let axis = in_scene.cone.map_or(DVec3::NEG_Z, |cone| cone.axis);
            Some((PUNCTUAL, words, place_along(axis, (*center_m).into())))
        }
        LightKind::Sun {
            direction,
            angle_deg,
            irradiance,
        } => {
            let intensity = LUMENS_PER_WATT * irradiance * sun_factor(light);
            let mut words =
                json!({ "type": "directional", "color": color, "intensity": intensity });
            words["extras"] = json!({ "angle": 0.5 * angle_deg.to_radians() });
            Some((
                PUNCTUAL,
                words,
                place_along((*direction).into(), DVec3::ZERO),
            ))
        }
        LightKind::Disk {
            center_m, radius_m, ..
        } => {
            let (mut words, place) = flat(*center_m, 2.0 * radius_m)?;
            words["type"] = json!("disk");
            Some((AREA, words, place))
        }
        LightKind::Rectangle {
            center_m,
            width_m,
            height_m,
            ..
        } => {
            let (mut words, place) = flat(*center_m, *height_m)?;
            words["type"] = json!("rect");
            words["rect"] = json!({ "aspect": width_m / height_m });
            Some((AREA, words, place))
        }
        LightKind::Polygon { .. } | LightKind::Tube { .. } => {
            let words = json!({ "color": color, "intensity": luminance });
            Some((EXTENSION, words, DMat4::IDENTITY))
        }
    }
}
