//! The kinds of lights on the device: how they are told apart, and how each is packed.

use std::ops::Range;

use bytemuck::Zeroable;
use glam::DVec3;
use hairline_optics::band::TUBE_CORNERS;
use hairline_scene::{Doors, Light, LightShape, Scene, vector_area_m2};

use crate::host::relative;
use crate::layout;
use crate::texture_array::TextureArray;

/// [`layout::Light::kind`]. Twin: layout.wgsl.
const LIGHT_SPHERE: u32 = 0;
const LIGHT_POLYGON: u32 = 1;
const LIGHT_TUBE: u32 = 2;

/// [`layout::Light::extras`]. Twin: layout.wgsl.
const LIGHT_DOORS: u32 = 1;
const LIGHT_PICTURE: u32 = 2;

/// Kinds of lights that light scratches in a pass of their own. Twin: SCRATCH_LIGHTS of shade_scratches.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum LightKind {
    Spheres,
    /// Polygons of at most four vertices.
    Quads,
    /// Polygons of more.
    Outlines,
    Tubes,
    /// Rectangles with pictures on them.
    Pictures,
    Environment,
}

impl LightKind {
    pub(crate) const ALL: [Self; 6] = [
        Self::Spheres,
        Self::Quads,
        Self::Outlines,
        Self::Tubes,
        Self::Pictures,
        Self::Environment,
    ];

    const CORNERED: [Self; 4] = [Self::Quads, Self::Outlines, Self::Tubes, Self::Pictures];

    /// Kind of the light's rays, which take polygons of few vertices as others.
    pub(crate) fn of_rays(self) -> Self {
        match self {
            Self::Quads => Self::Outlines,
            other => other,
        }
    }

    /// Constants of a pass that takes lights of this kind alone.
    pub(crate) fn constants(self) -> [(&'static str, f64); 7] {
        let mut only = Kinds::default();
        only.0[self as usize] = true;
        only.constants()
    }

    fn from_light(light: &Light) -> Self {
        match &light.shape {
            LightShape::Sphere { .. } => Self::Spheres,
            LightShape::Polygon { .. } if light.picture.is_some() => Self::Pictures,
            LightShape::Polygon { vertices_m, .. } if vertices_m.len() <= 4 => Self::Quads,
            LightShape::Polygon { .. } => Self::Outlines,
            LightShape::Tube { .. } => Self::Tubes,
        }
    }
}

/// The kinds that a scene has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Kinds([bool; LightKind::ALL.len()]);

impl Kinds {
    pub(crate) const ALL: Self = Self([true; LightKind::ALL.len()]);

    pub(crate) fn from_scene(scene: &Scene) -> Self {
        let mut kinds = Self::default();
        for light in scene.all_lights() {
            kinds.0[LightKind::from_light(light) as usize] = true;
        }
        kinds.0[LightKind::Environment as usize] = scene.environment.is_some();
        kinds
    }

    pub(crate) fn has(self, kind: LightKind) -> bool {
        self.0[kind as usize]
    }

    /// Kinds with a pass over scratches: spheres where there are none, for the mask.
    pub(crate) fn over_scratches(self) -> impl Iterator<Item = LightKind> {
        let none = self == Self::default();
        let wanted = move |kind: &LightKind| self.has(*kind) || none && *kind == LightKind::Spheres;
        LightKind::ALL.into_iter().filter(wanted)
    }

    /// Kinds of rays to sources. Each kind has passes of its own.
    pub(crate) fn of_rays(self) -> impl Iterator<Item = LightKind> {
        let folded =
            move |kind: &LightKind| *kind != LightKind::Quads || !self.has(LightKind::Outlines);
        let there = LightKind::ALL
            .into_iter()
            .filter(move |kind| self.has(*kind));
        there.filter(folded).map(LightKind::of_rays)
    }

    /// Constants of shaders. Twin: contents.wgsl.
    pub(crate) fn constants(self) -> [(&'static str, f64); 7] {
        [
            ("HAS_SPHERES", self.has(LightKind::Spheres).into()),
            ("HAS_POLYGONS", self.has_polygons().into()),
            ("HAS_TUBES", self.has(LightKind::Tubes).into()),
            ("ONLY_TUBES", self.has_only(LightKind::Tubes).into()),
            ("ONLY_PICTURES", self.has_only(LightKind::Pictures).into()),
            ("HAS_PICTURES", self.has(LightKind::Pictures).into()),
            ("HAS_ENVIRONMENT", self.has(LightKind::Environment).into()),
        ]
    }

    /// Whether all lights with corners are of that kind.
    fn has_only(self, kind: LightKind) -> bool {
        self.has(kind)
            && LightKind::CORNERED
                .into_iter()
                .all(|it| it == kind || !self.has(it))
    }

    fn has_polygons(self) -> bool {
        LightKind::CORNERED.into_iter().any(|kind| self.has(kind))
    }
}

/// All area lights, kind after kind.
pub(crate) fn sorted(scene: &Scene) -> Vec<&Light> {
    let mut lights: Vec<_> = scene.all_lights().collect();
    lights.sort_by_key(|light| LightKind::from_light(light));
    lights
}

/// The kind of each light, in the order of [`sorted`].
pub(crate) fn kinds(scene: &Scene) -> Vec<LightKind> {
    sorted(scene)
        .into_iter()
        .map(LightKind::from_light)
        .collect()
}

/// Ranges among the sorted lights of each kind that the scene has; the environment has none.
pub(crate) fn ranges(scene: &Scene) -> Vec<(LightKind, Range<u32>)> {
    let kinds = kinds(scene);
    let range = |kind| {
        let start = kinds.partition_point(|it| *it < kind);
        let end = kinds.partition_point(|it| *it <= kind);
        (kind, start as u32..end as u32)
    };
    Kinds::from_scene(scene)
        .over_scratches()
        .map(range)
        .collect()
}

/// Texels of a light without its vertices.
const LIGHT_TEXELS: usize = size_of::<layout::Light>() / 16;

fn vertices_m(light: &Light) -> &[DVec3] {
    match &light.shape {
        LightShape::Polygon { vertices_m, .. } => vertices_m,
        LightShape::Sphere { .. } => &[],
        LightShape::Tube { ends_m, .. } => ends_m,
    }
}

/// The barn doors of a light.
pub(crate) fn doors(light: &Light) -> Option<Doors> {
    light.cone.and_then(|cone| cone.doors)
}

/// Places among the vertices that a light's doors take, behind its own. Twin: rows.wgsl.
pub(crate) const DOOR_PLACES: usize = 3;

/// Number of entries of a light in the array of vertices.
pub(crate) fn places(light: &Light) -> usize {
    let doors = doors(light).map_or(0, |_| DOOR_PLACES);
    vertices_m(light).len() + doors + usize::from(light.picture.is_some())
}

/// Packs all area lights, then the vertices of those that have some, as texels.
pub(crate) fn packed(scene: &Scene, array: &TextureArray, origin_m: DVec3) -> Vec<[u32; 4]> {
    let mut vertices: Vec<[f32; 4]> = Vec::new();
    let pack = |light: &Light| {
        let (center_m, radius_m) = light.bounding_sphere();
        let own = vertices_m(light);
        let first_vertex = vertices.len() as u32;
        add_places(light, array, origin_m, &mut vertices);
        let bounded = layout::Light {
            radiance: light.radiance.map(|c| c as f32),
            center_m: relative(center_m, origin_m),
            radius_m: radius_m as f32,
            first_vertex,
            vertex_count: own.len() as u32,
            cone: light.cone.map_or([-2.0, 1.0], |cone| {
                [cone.cos_outer, cone.per_cos()].map(|x| x as f32)
            }),
            cone_axis: light
                .cone
                .map_or(DVec3::Z, |cone| cone.axis)
                .as_vec3()
                .to_array(),
            extras: u32::from(doors(light).is_some()) * LIGHT_DOORS
                + u32::from(light.picture.is_some()) * LIGHT_PICTURE,
            ..layout::Light::zeroed()
        };
        match &light.shape {
            LightShape::Sphere { .. } => layout::Light {
                kind: LIGHT_SPHERE,
                first_vertex: 0,
                ..bounded
            },
            LightShape::Tube { .. } => layout::Light {
                kind: LIGHT_TUBE,
                vertex_count: TUBE_CORNERS as u32,
                ..bounded
            },
            LightShape::Polygon { two_sided, .. } => layout::Light {
                kind: LIGHT_POLYGON,
                normal: (vector_area_m2(own).normalize_or_zero().as_vec3()).to_array(),
                two_sided: u32::from(*two_sided),
                ..bounded
            },
        }
    };
    let lights: Vec<layout::Light> = sorted(scene).into_iter().map(pack).collect();
    let mut texels = bytemuck::cast_slice(&lights).to_vec();
    texels.extend_from_slice(bytemuck::cast_slice(&vertices));
    texels
}

/// Adds the entries of a light in the array of vertices.
fn add_places(light: &Light, array: &TextureArray, origin_m: DVec3, vertices: &mut Vec<[f32; 4]>) {
    // Vertices of a tube hold its radius too.
    let w = match light.shape {
        LightShape::Tube { radius_m, .. } => radius_m as f32,
        _ => 0.0,
    };
    vertices.extend(vertices_m(light).iter().map(|vertex| {
        let [x, y, z] = relative(*vertex, origin_m);
        [x, y, z, w]
    }));
    if let Some(doors) = doors(light) {
        let across = doors.across.extend(0.0).to_array();
        let places = [across, doors.tans, doors.per_tan()];
        vertices.extend(places.map(|place| place.map(|x| x as f32)));
    }
    if light.picture.is_some() {
        let [x, y] = array.packed(light.picture).map(f32::from_bits);
        vertices.push([x, y, 0.0, 0.0]);
    }
}

/// Number of texels that [`packed`] makes.
pub(crate) fn texels(scene: &Scene) -> usize {
    let texels = |light| LIGHT_TEXELS + places(light);
    scene.all_lights().map(texels).sum()
}
