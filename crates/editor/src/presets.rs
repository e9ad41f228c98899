//! Good places to start from: layers, materials, lights and shapes that look well, fitted to the size of an object or a
//! scene.
//!
//! Numbers come from trial pictures: widths of 2 to 6 um show the rainbow, depths that differ by more than 15 % wash the
//! colours to straw, and a smooth base, roughness 0.05 to 0.15, leaves the scratches their room.

use glam::DVec3;
use hairline_document::description::SUN_DEG;
use hairline_document::description::{
    Amount, Brushed, Distribution, Laid, Layer, Light, LightKind, Material, MaterialKind,
    MetalColor, Pattern, PatternAxis, Scratches, Shape,
};
use hairline_document::wear::{count, fitting};
use hairline_optics::metal::Metal;
use hairline_scene::{Coat, Specular};

hairline_image::listed! {
    /// A layer of scratches to begin with.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum LayerPreset {
        /// Scratches in every direction.
        RandomWear = "Random wear", "Fine scratches in every direction: a ring of short coloured arcs around each highlight. Everyday use.";
        /// Concentric marks of a lathe.
        TurnedPan = "Turned pan",
            "Marks of the lathe around the z axis: two bright fans that turn with the light, striped with rainbows. Pans, pots, knobs.";
        /// Long parallel strokes.
        BrushedSteel = "Brushed steel", "Long strokes along x: each lamp is drawn out into a streak across them. Kitchen fronts, laptops.";
        /// Rays from an axis.
        PolishedWatch = "Polished watch", "Rays away from the z axis: a sunburst whose bright spokes sweep round as the dial tilts. Watches, medals.";
        /// Arcs that start at an axis.
        SpunDisk = "Spun disk",
            "Arcs that sweep from the z axis to the rim, as a rotary polisher leaves them: a pinwheel of light. Watch parts, wafers.";
        /// Short, bent, uneven scratches.
        WornCutlery = "Worn cutlery", "Bent scratches of very different lengths: loose, lively glints. A drawer of spoons.";
        /// Arcs around many centres.
        FingernailSwirls = "Fingernail swirls",
            "Faint arcs around many centres: a cobweb around each highlight. Car doors behind the handle, machine-washed paint.";
    }
    /// Name in a menu.
    fn name;
    /// Description of its look, for a tooltip.
    fn tooltip;
}

impl LayerPreset {
    /// The layer for an object whose bounding box has this diagonal. Its seed is set when it is added.
    pub fn layer(self, object: impl Into<String>, diagonal_m: f64) -> Scratches {
        let d = fitting(diagonal_m);
        let around = |jitter_deg| PatternAxis {
            jitter_deg,
            ..PatternAxis::default()
        };
        let drawn = |mean, spread| Distribution { mean, spread };
        // Patterns, the share of the surface that scratches cover, and their lengths, widths and depths.
        let (pattern, cover, sizes) = match self {
            Self::RandomWear => (
                Pattern::Random {
                    curvature_per_m: drawn(0.0, 1.8 / d),
                },
                0.014,
                [drawn(0.13 * d, 0.6), drawn(4.0, 0.12), drawn(195.0, 0.12)],
            ),
            Self::TurnedPan => (
                Pattern::Circular(around(3.0)),
                0.05,
                [drawn(0.4 * d, 0.6), drawn(5.0, 0.1), drawn(180.0, 0.12)],
            ),
            Self::BrushedSteel => (
                Pattern::Parallel {
                    direction: [1.0, 0.0, 0.0],
                    jitter_deg: 1.5,
                },
                0.05,
                [drawn(0.25 * d, 0.6), drawn(3.0, 0.12), drawn(165.0, 0.12)],
            ),
            Self::PolishedWatch => (
                Pattern::Radial(around(1.5)),
                0.05,
                [drawn(0.2 * d, 0.4), drawn(3.0, 0.1), drawn(150.0, 0.1)],
            ),
            Self::SpunDisk => (
                Pattern::Spun {
                    around: around(0.5),
                    curvature_per_m: drawn(4.0 / d, 0.2 / d),
                },
                0.05,
                [drawn(0.3 * d, 0.4), drawn(4.0, 0.1), drawn(185.0, 0.1)],
            ),
            Self::WornCutlery => (
                Pattern::Random {
                    curvature_per_m: drawn(0.0, 5.0 / d),
                },
                0.02,
                [drawn(0.08 * d, 0.9), drawn(3.5, 0.2), drawn(210.0, 0.15)],
            ),
            Self::FingernailSwirls => (
                Pattern::Swirl {
                    curvature_per_m: drawn(25.0 / d, 9.0 / d),
                },
                0.01,
                [drawn(0.04 * d, 0.5), drawn(3.0, 0.15), drawn(160.0, 0.12)],
            ),
        };
        let [length_m, width_um, _] = sizes;
        let count = count(cover, length_m.mean, width_um.mean, d);
        let layer = Layer::Laid(Laid::new(pattern, Amount::Count(count), sizes));
        Scratches {
            name: Some(self.name().to_lowercase()),
            ..Scratches::new(object, layer)
        }
    }
}

/// Layer that a brush of this radius starts.
pub fn drawn_layer(object: impl Into<String>, radius_m: f64) -> Scratches {
    let drawn = |mean, spread| Distribution { mean, spread };
    let length_m = (1.5 * radius_m).clamp(1e-4, 10.0);
    let sizes = [drawn(length_m, 0.5), drawn(4.0, 0.12), drawn(195.0, 0.12)];
    // Some of them are lit, wherever the stroke runs.
    let layer = Layer::Brushed(Brushed::new(15.0, sizes));
    Scratches {
        name: Some("drawn".to_owned()),
        ..Scratches::new(object, layer)
    }
}

/// A material to begin with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialPreset {
    /// Polished, by its measured n and k.
    Metal(Metal),
    /// A clear coat over a dark body.
    CarPaint,
    /// A clear coat over metal flakes.
    FlakePaint,
    /// Dark and dull, for surroundings.
    DarkTable,
    /// Reflects all.
    Mirror,
}

impl MaterialPreset {
    /// Every preset, in the order of a menu.
    pub fn all() -> impl Iterator<Item = Self> {
        const METALS: &[Metal] = &[
            Metal::StainlessSteel,
            Metal::Iron,
            Metal::Aluminium,
            Metal::Chromium,
            Metal::Nickel,
            Metal::Titanium,
            Metal::Silver,
            Metal::Gold,
            Metal::Brass,
            Metal::Copper,
        ];
        let others = [
            Self::CarPaint,
            Self::FlakePaint,
            Self::DarkTable,
            Self::Mirror,
        ];
        METALS.iter().copied().map(Self::Metal).chain(others)
    }

    /// Name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Metal(metal) => metal.title(),
            Self::CarPaint => "Car paint",
            Self::FlakePaint => "Metallic paint",
            Self::DarkTable => "Dark table",
            Self::Mirror => "Mirror",
        }
    }

    /// Description of its look, for a tooltip.
    pub fn tooltip(self) -> &'static str {
        match self {
            Self::Metal(Metal::Gold | Metal::Copper | Metal::Brass) => {
                "A warm metal: it tints its scratches too, so their blues stay faint."
            }
            Self::Metal(Metal::Silver | Metal::Aluminium) => {
                "A bright, neutral metal: the colours of scratches come out as they are."
            }
            Self::Metal(_) => "A grey metal: scratches stand out well against it.",
            Self::CarPaint => {
                "A clear coat over a dark body: only about 4 % is mirrored, so scratches show around strong lights alone."
            }
            Self::FlakePaint => {
                "Lacquer over metal flakes: a broad, coloured sheen, and white scratches in the coat above it."
            }
            Self::DarkTable => "Dark and dull: a ground that leaves the object the stage.",
            Self::Mirror => "Reflects everything, without a colour: scratches at their purest.",
        }
    }

    /// The material.
    pub fn material(self) -> Material {
        let (kind, roughness) = match self {
            Self::Metal(metal) => (MaterialKind::Metal(MetalColor::Measured(metal)), 0.06),
            Self::CarPaint => (
                MaterialKind::Dielectric {
                    ior: 1.5,
                    base_color: [0.012, 0.014, 0.02],
                },
                0.05,
            ),
            Self::FlakePaint => (
                MaterialKind::MetallicRoughness {
                    base_color: [0.02, 0.05, 0.16],
                    metallic: 1.0,
                    specular: Specular::default(),
                },
                0.45,
            ),
            Self::DarkTable => (
                MaterialKind::Dielectric {
                    ior: 1.2,
                    base_color: [0.02, 0.017, 0.015],
                },
                0.7,
            ),
            Self::Mirror => (MaterialKind::Mirror, 0.05),
        };
        Material {
            name: self.name().to_lowercase(),
            kind,
            roughness,
            coherence_um: 20.0,
            coat: match self {
                Self::FlakePaint => Some(Coat {
                    weight: 1.0,
                    roughness: 0.03,
                }),
                _ => None,
            },
            anisotropy: None,
            cover: None,
        }
    }
}

/// The material of shapes in a scene that has none.
pub(crate) fn plain_steel() -> Material {
    MaterialPreset::Metal(Metal::StainlessSteel).material()
}

hairline_image::listed! {
    /// A light to begin with.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum LightPreset {
        /// A small, bright sphere.
        SmallLamp = "Small lamp", "A small, bright sphere: the purest colours, each scratch a thin rainbow. The light to begin with.";
        /// A long, thin rectangle.
        Tube = "Tube", "A long, thin light: pure colours across it, and scratches light up along its whole length.";
        /// A square.
        Softbox = "Softbox", "A square of light: colours overlap to pastel near the highlight and stay at its edges.";
        /// A large, cool rectangle.
        Window = "Window", "A large, cool light: it shapes the object; scratches get little colour from it.";
        /// Light from one direction.
        Sun = "Sun", "Light from one direction, wherever things stand: thin, pure rainbows and sharp shadows, the same all over the scene.";
    }
    /// Name in a menu.
    fn name;
    /// Description of its effect on the look, for a tooltip.
    fn tooltip;
}

impl LightPreset {
    /// Makes the light, beside and above a target, at a distance and of a size that suit a scene of this diagonal; flat ones
    /// face the target. `up` is the camera's.
    pub fn light(self, target_m: DVec3, up: DVec3, diagonal_m: f64) -> Light {
        let d = fitting(diagonal_m);
        let up = up.normalize_or(DVec3::Y);
        let side = up.any_orthonormal_vector();
        let center = target_m + (up * 0.8 + side * 0.5).normalize() * (1.3 * d);
        let rectangle = |width: f64, height: f64| {
            let mut kind = LightKind::Rectangle {
                center_m: center.into(),
                target_m: target_m.into(),
                width_m: width * d,
                height_m: height * d,
                rotation_deg: 0.0,
                two_sided: false,
            };
            kind.lay_width_along(side);
            kind
        };
        let (kind, radiance, color) = match self {
            Self::SmallLamp => (
                LightKind::sphere(center.into(), 0.015 * d),
                200.0,
                [1.0, 0.95, 0.88],
            ),
            Self::Tube => {
                let end = |sign: f64| (center + sign * 0.75 * d * up.cross(side)).into();
                let kind = LightKind::Tube {
                    ends_m: [end(-1.0), end(1.0)],
                    radius_m: 0.01 * d,
                };
                (kind, 150.0, [1.0, 0.96, 0.92])
            }
            Self::Softbox => (rectangle(0.4, 0.4), 8.0, [1.0, 1.0, 1.0]),
            Self::Window => (rectangle(1.2, 1.6), 1.5, [0.85, 0.93, 1.0]),
            Self::Sun => {
                let kind = LightKind::Sun {
                    direction: (-(up * 0.8 + side * 0.5)).into(),
                    angle_deg: SUN_DEG,
                    irradiance: 0.2,
                };
                (kind, 1.0, [1.0, 0.96, 0.9])
            }
        };
        Light {
            name: Some(self.name().to_lowercase()),
            radiance,
            color,
            ..Light::new(kind)
        }
    }
}

hairline_image::listed! {
    /// A built-in shape to begin with.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum ShapePreset {
        /// A square.
        Plane = "Plane";
        /// A disk.
        Disk = "Disk";
        /// A sphere.
        Sphere = "Sphere";
        /// A flat box with rounded edges.
        Box = "Box";
        /// A cylinder with rounded rims.
        Cylinder = "Cylinder";
        /// A ring of round section.
        Torus = "Torus";
        /// A watch glass.
        Dome = "Dome";
        /// A pan without a handle.
        Pan = "Pan";
        /// A studio's floor that turns up into its wall.
        Sweep = "Sweep";
        /// Letters: a logo.
        Text = "Text";
    }
    /// Name in a menu.
    fn name;
}

impl ShapePreset {
    /// Words on where it is put, for a tooltip; empty where it stands at the origin.
    pub fn tooltip(self) -> &'static str {
        match self {
            Self::Text => "Letters on top of the selected object, as wide as it.",
            _ => "",
        }
    }

    /// The shape, as wide as this.
    pub fn shape(self, width_m: f64) -> Shape {
        let r = 0.5 * fitting(width_m);
        match self {
            Self::Plane => Shape::Plane {
                size_m: [2.0 * r, 2.0 * r],
            },
            Self::Disk => Shape::Disk { radius_m: r },
            Self::Sphere => Shape::Sphere { radius_m: r },
            Self::Box => Shape::Box {
                size_m: [2.0 * r, 1.4 * r, 0.4 * r],
                rounding_m: 0.08 * r,
            },
            Self::Cylinder => Shape::Cylinder {
                radius_m: r,
                height_m: r,
                rounding_m: 0.08 * r,
            },
            Self::Torus => Shape::Torus {
                radius_m: 0.75 * r,
                tube_radius_m: 0.25 * r,
            },
            Self::Dome => Shape::Dome {
                radius_m: r,
                height_m: 0.4 * r,
            },
            Self::Sweep => Shape::Sweep {
                size_m: [2.0 * r, 2.0 * r],
                height_m: r,
                rounding_m: 0.5 * r,
            },
            Self::Text => Shape::Text {
                line: "Hairline".to_owned(),
                height_m: 0.46 * r,
                depth_m: 0.08 * r,
            },
            Self::Pan => Shape::Lathe {
                profile_m: [
                    [0.0, 0.0],
                    [0.78, 0.0],
                    [0.86, 0.026],
                    [0.9, 0.1],
                    [0.94, 0.21],
                    [0.98, 0.23],
                    [1.0, 0.21],
                    [0.95, 0.0],
                ]
                .map(|[x, z]| [x * r, z * r])
                .to_vec(),
                segments: 256,
                smooth: true,
            },
        }
    }
}
