//! Lights as an author writes them: all that is particular to a kind but its look in a window.

use glam::DVec3;
use hairline_optics::spectrum::black_body_rgb;
use serde::Serialize;

use super::limits::{EXPOSURE_EV, TEMPERATURE_K};
use super::ranges::{Check, components, not_negative, point, size, within};
use super::table::{Read, Table, Value};
use super::values::{is_false, is_zero};
use crate::error::Error;
use crate::polygon;
use crate::scene;

/// `[[light]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Light {
    /// Free text, for lists that people read. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Lights nothing, as if it were not there. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// `kind` and the keys that belong to it.
    #[serde(flatten)]
    pub kind: LightKind,
    /// W sr^-1 m^-2 in effect; not negative. Default: 1.
    pub radiance: f64,
    /// Stops: the radiance is multiplied by 2^`exposure_ev`. Default: 0.
    #[serde(skip_serializing_if = "is_zero")]
    pub exposure_ev: f64,
    /// The light is a black body of this temperature, K, of the luminance that it would have without. `color` is a filter before it. Default:
    /// none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<f64>,
    /// Factor on the radiance, linear Rec.709, not negative; `[1, 1, 1]` has the spectrum of D65. Default: `[1, 1, 1]`.
    pub color: [f64; 3],
}

/// `kind` of a `[[light]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum LightKind {
    /// `"sphere"`
    Sphere {
        /// Required.
        center_m: [f64; 3],
        /// Required.
        radius_m: f64,
    },
    /// `"polygon"`: planar, simple, convex or not; shines to the side that sees its vertices counter-clockwise.
    Polygon {
        /// At least three. Required.
        vertices_m: Vec<[f64; 3]>,
        /// Whether the other side shines too. Default: false.
        two_sided: bool,
    },
}

impl Light {
    /// A white light of radiance 1, without a name, not hidden.
    pub fn new(kind: LightKind) -> Self {
        Self {
            name: None,
            hidden: false,
            kind,
            radiance: 1.0,
            exposure_ev: 0.0,
            temperature_k: None,
            color: [1.0; 3],
        }
    }
}

impl Light {
    /// Refuses values out of range, and polygons that are not planar and simple. Keys begin with `light`.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), Error> {
        self.check_at("light")
    }

    pub(super) fn check_at(&self, key: &str) -> Check {
        not_negative(&format!("{key}.radiance"), self.radiance)?;
        components(&format!("{key}.color"), self.color, 0.0..=f64::MAX)?;
        within(&format!("{key}.exposure_ev"), self.exposure_ev, EXPOSURE_EV)?;
        if let Some(temperature_k) = self.temperature_k {
            within(
                &format!("{key}.temperature_k"),
                temperature_k,
                TEMPERATURE_K,
            )?;
        }
        match &self.kind {
            LightKind::Sphere { center_m, radius_m } => {
                point(&format!("{key}.center_m"), *center_m)?;
                size(&format!("{key}.radius_m"), *radius_m)
            }
            LightKind::Polygon { .. } => {
                let key = format!("{key}.vertices_m");
                for (i, vertex) in self.kind.vertices_m().iter().enumerate() {
                    point(&format!("{key}[{i}]"), *vertex)?;
                }
                polygon::check(&self.kind.corners_m())
                    .map_err(|flaw| Error::new(key, flaw.to_string(), flaw.remedy()))
            }
        }
    }

    /// What it is in a scene.
    pub(crate) fn in_scene(&self) -> scene::Light {
        let tint = self.temperature_k.map_or([1.0; 3], black_body_rgb);
        let radiance = self.radiance * self.exposure_ev.exp2();
        let radiance = std::array::from_fn(|c| self.color[c] * tint[c] * radiance);
        match &self.kind {
            LightKind::Sphere { center_m, radius_m } => scene::Light::Sphere {
                center_m: (*center_m).into(),
                radius_m: *radius_m,
                radiance,
            },
            LightKind::Polygon { two_sided, .. } => scene::Light::Polygon {
                vertices_m: self.kind.corners_m(),
                radiance,
                two_sided: *two_sided,
            },
        }
    }
}

impl LightKind {
    /// A sphere.
    pub fn sphere(center_m: [f64; 3], radius_m: f64) -> Self {
        Self::Sphere { center_m, radius_m }
    }

    /// A polygon that shines to one side.
    pub fn polygon(vertices_m: Vec<[f64; 3]>) -> Self {
        Self::Polygon {
            vertices_m,
            two_sided: false,
        }
    }

    /// What scene files call it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "sphere",
            Self::Polygon { .. } => "polygon",
        }
    }

    /// What people call such a light.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "sphere light",
            Self::Polygon { .. } => "polygon light",
        }
    }

    /// Its vertices; none of a sphere.
    pub fn vertices_m(&self) -> &[[f64; 3]] {
        match self {
            Self::Sphere { .. } => &[],
            Self::Polygon { vertices_m, .. } => vertices_m,
        }
    }

    /// The same as vectors.
    pub fn corners_m(&self) -> Vec<DVec3> {
        self.vertices_m().iter().map(|&v| v.into()).collect()
    }
}

impl Read for Light {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let (kind, table) = Table::read_kind(
            value,
            key,
            "kind",
            &[
                "kind",
                "name",
                "hidden",
                "radiance",
                "exposure_ev",
                "temperature_k",
                "color",
            ],
            &[
                ("sphere", &["center_m", "radius_m"]),
                ("polygon", &["vertices_m", "two_sided"]),
            ],
        )?;
        let kind = match kind {
            "sphere" => LightKind::Sphere {
                center_m: table.required("center_m")?,
                radius_m: table.required("radius_m")?,
            },
            _ => LightKind::Polygon {
                vertices_m: table.required("vertices_m")?,
                two_sided: table.or("two_sided", false)?,
            },
        };
        Ok(Self {
            name: table.optional("name")?,
            hidden: table.or("hidden", false)?,
            kind,
            radiance: table.or("radiance", 1.0)?,
            exposure_ev: table.or("exposure_ev", 0.0)?,
            temperature_k: table.optional("temperature_k")?,
            color: table.or("color", [1.0; 3])?,
        })
    }
}
