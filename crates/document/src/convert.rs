//! Conversion of a description to the units and references of a [`Scene`].

use std::sync::{Arc, OnceLock};

use glam::{DMat4, DVec3};
use hairline_image::FilePath;
use hairline_model::surface::world_from_object;
use hairline_optics::cover::Cover;
use hairline_optics::grating::Grating as Row;
use hairline_optics::metal::MetalIndex;
use hairline_optics::spectrum::Observer;
use hairline_scene::{
    Base, Bearing, Environment, Grating, GrooveField, GroovePicture, Material, PictureLie,
    RenderSettings, Scene, Specular, UvField,
};
use hairline_sky::BuiltInMap;

use crate::description::references::find;
use crate::description::{
    self, Description, GratingTheory, GroovePattern, MaterialKind, MetalColor, PatternAxis, UvAxis,
};
use crate::error::Error;

/// Converts the parts of a scene that take no time: camera, settings, materials, lights.
pub(crate) fn without_surfaces(description: &Description) -> Scene {
    let lights = description.lights.iter().filter(|light| !light.hidden);
    Scene {
        camera: description.camera.in_scene(),
        render: RenderSettings {
            size_px: description.render.size_px,
            filter_std_px: description.render.filter_std_px,
            tone_map: description.render.tone_map,
        },
        environment: None,
        textures: Arc::default(),
        materials: description.materials.iter().map(material).collect(),
        observer: Observer::default(),
        objects: Vec::new(),
        shadow_catcher: None,
        lights: lights.map(description::Light::in_scene).collect(),
        notes: description.notes.clone(),
        tables: Arc::default(),
    }
}

fn bare_or_covered(metal: MetalIndex, cover: Option<description::Cover>) -> Base {
    match cover {
        Some(description::Cover {
            ior,
            thickness_mm,
            color,
        }) => Base::Covered {
            metal,
            cover: Cover {
                ior,
                thickness_mm,
                color,
            },
        },
        None => Base::Metal(metal),
    }
}

pub(crate) fn material(material: &description::Material) -> Material {
    let base = match material.kind {
        MaterialKind::Metal(MetalColor::Measured(metal)) => {
            bare_or_covered(metal.into(), material.cover)
        }
        MaterialKind::Metal(MetalColor::Own(ref rows)) => {
            bare_or_covered(MetalIndex::own(rows), material.cover)
        }
        MaterialKind::Metal(MetalColor::Color(base_color)) => Base::ColoredMetal { base_color },
        MaterialKind::Dielectric { ior, base_color } => Base::Dielectric { ior, base_color },
        MaterialKind::MetallicRoughness {
            base_color,
            metallic,
            ..
        } => Base::MetallicRoughness {
            base_color,
            metallic,
        },
        MaterialKind::Mirror => Base::Mirror,
    };
    Material {
        coherence_um: material.coherence_um,
        specular: match material.kind {
            MaterialKind::MetallicRoughness { specular, .. } => specular,
            _ => Specular::default(),
        },
        coat: material.coat,
        anisotropy: material.anisotropy,
        ..Material::plain(material.name.clone(), base, material.roughness)
    }
}

/// Map of the environment without the scene's settings: not turned, intensity 1.
pub(crate) fn environment_map(
    map: &description::Map,
    base_dir: &FilePath,
) -> Result<Environment, Error> {
    let file = match map {
        description::Map::File(file) => base_dir.join(file),
        description::Map::BuiltIn(map) => {
            return Ok(built_in_map(*map));
        }
    };
    hairline_sky::load(&file, 0.0, 1.0, true).map_err(|error| {
        Error::new(
            "environment.file",
            error.to_string(),
            "must be an equirectangular .hdr or .exr, relative to the scene file",
        )
    })
}

/// One in the box, made once: to prefilter it takes longer than to build a small scene.
fn built_in_map(map: BuiltInMap) -> Environment {
    static MADE: [OnceLock<Environment>; BuiltInMap::ALL.len()] =
        [const { OnceLock::new() }; BuiltInMap::ALL.len()];
    let made = &MADE[map as usize];
    if let Some(map) = made.get() {
        return map.clone();
    }
    let picture = map.picture(hairline_sky::BUILT_IN_SIZE_PX);
    // Outside of `get_or_init`: it is made by several threads, and one that waits for the others may take up the building of another scene,
    // which would wait for the map for ever. Two may make it; the first one stays.
    let map = hairline_sky::from_map(picture, 0.0, 1.0, true);
    made.get_or_init(|| map).clone()
}

/// Environment as described, with the map's top along `up`.
pub(crate) fn environment(
    described: &description::Environment,
    map: Environment,
    up: DVec3,
) -> Environment {
    map.with_up(up, described.rotation_deg.to_radians())
        .with_intensity(described.intensity)
        .with_visible(described.visible)
}

impl description::Grating {
    /// Converts the grating for an object with this transform. `mask` and `directions` are the textures of
    /// the scene that it names.
    pub(crate) fn in_scene(
        &self,
        world_from_object: &DMat4,
        mask: Option<usize>,
        directions: Option<usize>,
    ) -> Grating {
        let (field, jitter_deg) = self.field(world_from_object, directions);
        Grating {
            row: Row {
                pitch_um: self.pitch_um,
                width_um: self.width_um,
                depth_nm: self.depth_nm.mean,
                depth_spread: self.depth_nm.spread,
                jitter_um: self.jitter_um,
            },
            field,
            angle_std_rad: jitter_deg.to_radians(),
            coverage: self.coverage,
            radii_m: self.radius_m.unwrap_or([0.0, f64::INFINITY]),
            mask: mask.map(|texture| GroovePicture {
                texture,
                lie: PictureLie::new(self.tile_m, world_from_object),
            }),
            seed: (self.seed ^ (self.seed >> 32)) as u32,
            is_rigorous: self.theory == GratingTheory::Rigorous,
        }
    }

    /// The field of its grooves in world space, and its `jitter_deg`. `directions` is the texture that turns a field by coordinates.
    fn field(&self, world_from_object: &DMat4, directions: Option<usize>) -> (GrooveField, f64) {
        let direction = |direction: [f64; 3]| {
            let direction = world_from_object.transform_vector3(direction.into());
            direction.normalize_or_zero()
        };
        let around = |around: &PatternAxis, bearing| {
            let field = GrooveField::Around {
                axis: direction(around.axis),
                center_m: world_from_object.transform_point3(around.center_m.into()),
                bearing,
            };
            (field, around.jitter_deg)
        };
        let center_m = self.center_m.unwrap_or_default();
        let center_m = world_from_object.transform_point3(center_m.into());
        match &self.pattern {
            GroovePattern::Circular(axis) => around(axis, Bearing::Circular),
            GroovePattern::Radial(axis) => around(axis, Bearing::Radial),
            GroovePattern::Spun {
                around: axis,
                curvature_per_m,
            } => {
                let curvature_per_m = *curvature_per_m;
                around(axis, Bearing::Spun { curvature_per_m })
            }
            GroovePattern::Swirl {
                around: spots,
                spacing_m,
            } => {
                let axis = direction(spots.axis);
                let field = GrooveField::Spots {
                    axis,
                    center_m: world_from_object.transform_point3(spots.center_m.into()),
                    along_row: row_across(axis, direction),
                    spacing_m: *spacing_m,
                };
                (field, spots.jitter_deg)
            }
            GroovePattern::Parallel {
                direction: along,
                jitter_deg,
            } => {
                let direction = direction(*along);
                let field = GrooveField::Along {
                    direction,
                    center_m,
                };
                (field, *jitter_deg)
            }
            GroovePattern::Uv {
                along, jitter_deg, ..
            } => {
                let uv = UvField {
                    along_v: *along == UvAxis::V,
                    directions,
                };
                (GrooveField::ByUv { uv, center_m }, *jitter_deg)
            }
        }
    }
}

/// The object's x axis, or y where the axis is nearly x; across the axis in the world, whatever the scales.
fn row_across(axis: DVec3, direction_in_world: impl Fn([f64; 3]) -> DVec3) -> DVec3 {
    let [x, y] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(direction_in_world);
    let along = if axis.dot(x).abs() > 0.9 { y } else { x };
    along.reject_from(axis).normalize_or_zero()
}

impl description::Object {
    /// Transform of the object by its `scale`, `rotation_deg` and `translation_m`.
    pub fn world_from_object(&self) -> DMat4 {
        world_from_object(self.translation_m, self.rotation_deg, self.scale)
    }
}

/// The number of the material that all of an object is of; `None` where its file brings its own.
pub(crate) fn object_material(
    object: &description::Object,
    key: &str,
    materials: &[description::Material],
) -> Result<Option<u32>, Error> {
    let Some(name) = &object.material else {
        return Ok(None);
    };
    let names = materials.iter().map(|m| m.name.as_str());
    let index = find(name, names, &format!("{key}.material"), "material")?;
    Ok(Some(index as u32))
}

/// The material with its textures numbered from `first` on instead of 0.
pub(crate) fn with_textures_from(material: Material, first: usize) -> Material {
    let shifted = |texture: Option<usize>| texture.map(|texture| texture + first);
    let shifted_map = |(texture, factor): (usize, f64)| (texture + first, factor);
    Material {
        base_color_texture: shifted(material.base_color_texture),
        metallic_roughness_texture: shifted(material.metallic_roughness_texture),
        normal_texture: material.normal_texture.map(shifted_map),
        emission_texture: shifted(material.emission_texture),
        occlusion_texture: material.occlusion_texture.map(shifted_map),
        specular_textures: material.specular_textures.map(shifted),
        coat_textures: material.coat_textures.map(shifted),
        coat_normal_texture: material.coat_normal_texture.map(shifted_map),
        anisotropy_texture: shifted(material.anisotropy_texture),
        ..material
    }
}
