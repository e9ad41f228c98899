//! KHR_lights_punctual: the lights of a file, in its own frame.

use glam::DVec3;
use gltf::json::Value;

use super::nodes::placed_nodes;
use super::pose::Pose;
use crate::flaw::Flaw;

pub(super) const NAME: &str = "KHR_lights_punctual";
/// The extension's default.
const OUTER_RAD: f64 = std::f64::consts::FRAC_PI_4;

/// A light without a size.
#[derive(Clone, Debug, PartialEq)]
pub struct Punctual {
    /// Name of the light or its node.
    pub name: Option<String>,
    /// Directions that it shines in.
    pub kind: PunctualKind,
    /// Place of the light, metres.
    pub position: DVec3,
    /// Unit vector, away from the light.
    pub direction: DVec3,
    /// Linear Rec.709.
    pub color: [f64; 3],
    /// Candela, of a directional light lux.
    pub intensity: f64,
}

/// Directions that a light without a size shines in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualKind {
    /// All of them.
    Point,
    /// A cone about the light's direction.
    Spot {
        /// Half the angle of the cone of full light.
        inner_rad: f64,
        /// Half the angle of the cone of any light.
        outer_rad: f64,
    },
    /// One, from far away.
    Directional,
}

/// Lights of the visible nodes.
pub(super) fn read_lights(document: &gltf::Document) -> Result<Vec<Punctual>, Flaw> {
    let none = Vec::new();
    let table = document
        .extension_value(NAME)
        .and_then(|value| value.get("lights")?.as_array())
        .unwrap_or(&none);
    let mut lights = Vec::new();
    for placed in placed_nodes(document, &Pose::at_rest(document))? {
        let node = &placed.node;
        let Some(index) = node
            .extension_value(NAME)
            .and_then(|value| value.get("light")?.as_u64())
        else {
            continue;
        };
        let Some(light) = table.get(index as usize) else {
            return Err(Flaw::new(
                format!(
                    "its node {} has the light {index}, of {}",
                    node.index(),
                    table.len()
                ),
                "export it again",
            ));
        };
        let position = placed.file_from_node.transform_point3(DVec3::ZERO);
        // Along -z of its node.
        let direction = placed.file_from_node.transform_vector3(DVec3::NEG_Z);
        let number = |value: &Value, key: &str| value.get(key).and_then(Value::as_f64);
        let color = light.get("color").and_then(|color| color.as_array());
        let channel = |c: usize| Some(color?.get(c)?.as_f64()?.max(0.0));
        lights.push(Punctual {
            name: light
                .get("name")
                .and_then(|name| Some(name.as_str()?.to_owned())),
            kind: match light.get("type").and_then(Value::as_str) {
                Some("directional") => PunctualKind::Directional,
                Some("spot") => {
                    let spot = light.get("spot").unwrap_or(light);
                    let outer_rad = number(spot, "outerConeAngle").unwrap_or(OUTER_RAD);
                    PunctualKind::Spot {
                        inner_rad: number(spot, "innerConeAngle").unwrap_or(0.0),
                        outer_rad,
                    }
                }
                _ => PunctualKind::Point,
            },
            position,
            direction: direction.normalize_or(DVec3::NEG_Z),
            color: std::array::from_fn(|c| channel(c).unwrap_or(1.0)),
            intensity: number(light, "intensity").unwrap_or(1.0).max(0.0),
        });
    }
    Ok(lights)
}
