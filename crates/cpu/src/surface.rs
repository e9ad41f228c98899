//! Stage 2, surface: the surface under a sample: position, frame, footprint, material with its textures. Twin: surface.wgsl.

pub(crate) mod ray_start;
mod textured_hit;

use glam::{DMat3, DVec2, DVec3};
use hairline_index::Hit;
use hairline_optics::coat::COAT_F0;
use hairline_optics::facets::{FacetAxes, anisotropic_alpha};
use hairline_optics::filtered_lobe::PixelSlopes;
use hairline_optics::fresnel::FresnelRgb;
use hairline_optics::ggx::ggx_alpha;
use hairline_optics::spectrum::Observer;
use hairline_scene::{MaterialOptics, Scene, ScratchTables};

use textured_hit::{MappedNormal, TexturedHit, raised};

/// A shading point. Its local frame has z along the shading normal and the viewer in the x-z plane. Of a surface under a coat it is that of the
/// coat; [`SurfacePoint::under_coat`] has that of what is under it.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint<'a> {
    /// World space.
    pub position_m: DVec3,
    /// Origin of rays to lights: on the smooth surface that the normals describe, at the point or above it. From the flat triangle its neighbours
    /// would hide lights that the shading normal shows (J. Hanika, "Hacking the shadow terminator", 2021).
    pub raised_m: DVec3,
    /// Axes of the local frame in world space; `normal` is on the viewer's side.
    pub axis_x: DVec3,
    /// Completes the frame.
    pub axis_y: DVec3,
    /// Shading normal.
    pub normal: DVec3,
    /// Shading normal under the coat, where it is another one.
    pub normal_under_coat: Option<DVec3>,
    /// Unit normal of the triangle, on the viewer's side.
    pub facet: DVec3,
    /// Unit direction to the viewer in the local frame.
    pub wo: DVec3,
    /// Distance to the viewer.
    pub distance_m: f64,
    /// Movements of the point by one standard deviation of the pixel's filter to the right and down, world space.
    pub footprint_axes_m: [DVec3; 2],
    /// Turns of the smooth normal, on the viewer's side, over each of the footprint's axes, in the local frame.
    pub normal_turns: [DVec3; 2],
    /// Specular reflectance.
    pub fresnel: FresnelRgb<'a>,
    /// Albedo of the diffuse body, times the share that is no metal.
    pub diffuse: DVec3,
    /// Share of the surface that is a metal.
    pub metallic: f64,
    /// Roughness of the surface between the scratches, or of the surface under the coat.
    pub roughness: f64,
    /// Axes of the facets' spread, where they lean further one way than across it; in the frame of the surface under the coat.
    pub facets: Option<FacetAxes>,
    /// A clear layer over all of this.
    pub coat: Option<PointCoat<'a>>,
    /// Standard deviation of the slopes of the normal map about the slope that is looked up, in each direction.
    pub slope_std: f64,
    /// Share of the environment's light that reaches the base.
    pub open: f64,
    /// Emitted radiance.
    pub emission: DVec3,
    /// Index into the scene's materials.
    pub material: usize,
    /// Index of the triangle in its object.
    pub triangle: u32,
    /// Standard deviation of the coherence window.
    pub coherence_um: f64,
    /// What the channels of the picture are.
    pub observer: &'a Observer,
    /// Index of the scratch table.
    pub table: usize,
}

/// A coat at a point.
#[derive(Clone, Copy, Debug)]
pub struct PointCoat<'a> {
    /// The share of the surface that it covers.
    pub weight: f64,
    /// Perceptual.
    pub roughness: f64,
    /// Reflectance where it is.
    pub fresnel: FresnelRgb<'a>,
    /// See [`SurfacePoint::slope_std`]; of the coat's own normal map.
    pub slope_std: f64,
}

/// Largest distance of a surface from the plane of a footprint, over the length along it.
const SURFACE_BENDS: f64 = 0.125;

impl SurfacePoint<'_> {
    /// Largest distance of the surface under a footprint from the plane of shading, over the length along it. Scratches lie on triangles: that of
    /// the point leaves the plane by as much as its normal is another one, its neighbours by about as much again; and where a surface bends
    /// elsewhere under a footprint, by an eighth of its size.
    pub fn leaves(&self) -> f64 {
        SURFACE_BENDS + 2.0 * self.normal.distance(self.facet)
    }

    /// Reflectance at a cosine of the layer in which scratches lie: the coat, if there is one.
    pub fn reflectance(&self, cos_theta: f64) -> DVec3 {
        let base = DVec3::from(self.fresnel.eval(cos_theta));
        self.coat.map_or(base, |coat| {
            base.lerp(coat.fresnel.eval(cos_theta).into(), coat.weight)
        })
    }

    /// A direction in the local frame.
    pub fn surface_from_world(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.axis_x), v.dot(self.axis_y), v.dot(self.normal))
    }

    /// A direction in world space.
    pub fn world_from_surface(&self, v: DVec3) -> DVec3 {
        self.axis_x * v.x + self.axis_y * v.y + self.normal * v.z
    }

    /// Slopes that a pixel sees. `map_std` is the spread of the normal map's.
    pub(crate) fn pixel_slopes(&self, map_std: f64) -> PixelSlopes {
        let local = |step| self.surface_from_world(step).truncate();
        PixelSlopes {
            turns: self.normal_turns.map(|turn| turn.truncate()),
            steps_m: self.footprint_axes_m.map(local),
            cos_o: self.wo.z,
            viewer_m: self.distance_m,
            map_std,
        }
    }

    /// The surface under the coat in its own frame, if it has a normal of its own.
    pub fn under_coat(&self) -> Option<Self> {
        let normal = self.normal_under_coat?;
        let to_viewer = self.world_from_surface(self.wo);
        let ([axis_x, axis_y], wo) = frame(normal, to_viewer);
        let turn = |turn| {
            let turn = self.world_from_surface(turn);
            DVec3::new(turn.dot(axis_x), turn.dot(axis_y), 0.0)
        };
        Some(Self {
            axis_x,
            axis_y,
            normal,
            normal_under_coat: None,
            wo,
            normal_turns: self.normal_turns.map(turn),
            coat: None,
            ..*self
        })
    }

    /// The turn from this point's frame to that of another one at the same place.
    pub fn turn_to(&self, other: &Self) -> DMat3 {
        let axes = [other.axis_x, other.axis_y, other.normal];
        let [x, y, z] = axes.map(|axis| self.surface_from_world(axis));
        DMat3::from_cols(x, y, z).transpose()
    }

    /// The point under a filter that is `times` as wide.
    pub(crate) fn with_footprint_of(self, times: f64) -> Self {
        Self {
            footprint_axes_m: self.footprint_axes_m.map(|axis| axis * times),
            normal_turns: self.normal_turns.map(|turn| turn * times),
            ..self
        }
    }

    /// The point alone, for scratches that are not averaged over the pixel.
    pub fn without_footprint(self) -> Self {
        Self {
            footprint_axes_m: [DVec3::ZERO; 2],
            normal_turns: [DVec3::ZERO; 2],
            ..self
        }
    }
}

/// The least cosine between the viewer and a shading normal; interpolated and mapped normals that turn further away are
/// bent back.
pub(crate) const MIN_VIEW_COS: f64 = 0.01;

/// How the bumps of a normal map under a footprint widen the lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BumpSlopes {
    /// As a spread that is the same in all directions.
    Spread,
    /// As turns of the normal along the footprint, over which bumps hardly bend. What is finer than a texel spreads.
    Turns,
}

/// A hit as it is seen.
#[derive(Clone, Copy)]
pub struct SeenHit<'h> {
    /// The hit.
    pub hit: &'h Hit,
    /// Its place.
    pub position_m: DVec3,
    /// Unit direction to the viewer.
    pub to_viewer: DVec3,
}

/// The surface at a hit. `footprint` gives, for a plane of a given unit normal through the hit, how the hit moves by one standard deviation of the
/// pixel's filter to the right and down, metres.
pub fn surface_point<'a>(
    scene: &'a Scene,
    tables: &'a ScratchTables,
    seen: &SeenHit,
    footprint: impl Fn(DVec3) -> [DVec3; 2],
) -> SurfacePoint<'a> {
    surface_with_bumps(scene, tables, seen, footprint, BumpSlopes::Spread)
}

/// [`surface_point`], with bumps that widen the lobe in either way.
pub(crate) fn surface_with_bumps<'a>(
    scene: &'a Scene,
    tables: &'a ScratchTables,
    seen: &SeenHit,
    footprint: impl Fn(DVec3) -> [DVec3; 2],
    bumps: BumpSlopes,
) -> SurfacePoint<'a> {
    let SeenHit {
        hit,
        position_m,
        to_viewer,
    } = *seen;
    let at = TexturedHit::new(scene, hit, to_viewer, &footprint);
    let (material, side) = (at.material, at.side);
    let mesh = &scene.objects[hit.object as usize].mesh;
    let material_index = mesh.triangle_materials[hit.triangle as usize] as usize;
    let optics = &tables.materials[material_index];
    let (coat, normal, under_coat) = coat_and_normals(&at, tables, optics, bumps);
    let [normal, normal_under_coat] =
        [normal, under_coat.normal].map(|normal| face_viewer(side * normal, to_viewer));
    let ([axis_x, axis_y], wo) = frame(normal, to_viewer);
    let paint = at.paint(optics);
    SurfacePoint {
        position_m,
        raised_m: raised(position_m, hit, mesh, side),
        axis_x,
        axis_y,
        normal,
        normal_under_coat: (normal_under_coat != normal).then_some(normal_under_coat),
        facet: side * at.geometric.normalize_or(normal),
        wo,
        distance_m: hit.distance_m,
        footprint_axes_m: match normal == side * at.smooth {
            true => at.axes,
            false => footprint(normal),
        },
        normal_turns: normal_turns(&at, &under_coat, [axis_x, axis_y]),
        fresnel: FresnelRgb {
            f0: paint.f0.to_array(),
            f90: paint.f90,
            curve: &tables.curves[optics.curve as usize],
        },
        diffuse: paint.diffuse,
        metallic: paint.metallic,
        roughness: paint.roughness,
        facets: facet_axes(&at, paint.roughness, normal_under_coat, to_viewer),
        coat,
        slope_std: under_coat.slope_std,
        open: at.open(),
        emission: paint.emission,
        material: material_index,
        triangle: hit.triangle,
        coherence_um: material.coherence_um,
        observer: &scene.observer,
        table: optics.table as usize,
    }
}

/// Turns of the normal over the axes of the footprint, in the frame of the surface.
fn normal_turns(
    at: &TexturedHit,
    under_coat: &MappedNormal,
    [axis_x, axis_y]: [DVec3; 2],
) -> [DVec3; 2] {
    let smooth_turns = at.smooth_turns();
    [0, 1].map(|i| {
        let turn = smooth_turns[i] + under_coat.turns[i];
        at.side * DVec3::new(turn.dot(axis_x), turn.dot(axis_y), 0.0)
    })
}

/// The coat at a hit, the normal that is seen, and that under the coat.
fn coat_and_normals<'a>(
    at: &TexturedHit,
    tables: &'a ScratchTables,
    optics: &MaterialOptics,
    bumps: BumpSlopes,
) -> (Option<PointCoat<'a>>, DVec3, MappedNormal) {
    let material = at.material;
    let has_coat = material.coat.is_some_and(|coat| coat.weight > 0.0);
    // A coat with a normal map of its own turns another way than what is under it.
    let as_turns = bumps == BumpSlopes::Turns && !(has_coat && material.has_coat_normals());
    let under_coat = at.mapped(material.normal_texture, as_turns);
    let mut coat = point_coat(at, tables, optics, under_coat.slope_std);
    let mut normal = under_coat.normal;
    if let Some(coat) = coat.as_mut().filter(|coat| coat.weight > 0.0)
        && material.has_coat_normals()
    {
        let of_coat = at.mapped(material.coat_normal_texture, as_turns);
        (normal, coat.slope_std) = (of_coat.normal, of_coat.slope_std);
    }
    (coat, normal, under_coat)
}

/// The coat at a hit, with the slopes of what is under it.
fn point_coat<'a>(
    at: &TexturedHit,
    tables: &'a ScratchTables,
    optics: &MaterialOptics,
    slope_std: f64,
) -> Option<PointCoat<'a>> {
    let (curve, coat) = optics.coat_curve.zip(at.material.coat)?;
    let [weight, roughness] = at.material.coat_textures.map(|index| at.texture(index));
    Some(PointCoat {
        weight: coat.weight * weight.map_or(1.0, |texel| texel.x),
        roughness: coat.roughness * roughness.map_or(1.0, |texel| texel.y),
        fresnel: FresnelRgb {
            f0: [COAT_F0; 3],
            f90: 1.0,
            curve: &tables.curves[curve as usize],
        },
        slope_std,
    })
}

/// The facets' spread at a hit, if they lean further one way than across it.
fn facet_axes(
    at: &TexturedHit,
    roughness: f64,
    normal: DVec3,
    to_viewer: DVec3,
) -> Option<FacetAxes> {
    let (way, strength) = at.anisotropy()?;
    let alpha = ggx_alpha(roughness);
    let ([axis_x, axis_y], _) = frame(normal, to_viewer);
    Some(FacetAxes {
        along: DVec2::new(way.dot(axis_x), way.dot(axis_y)).normalize_or(DVec2::X),
        alphas: DVec2::new(anisotropic_alpha(alpha, strength), alpha),
    })
}

/// The axes across a normal, and the direction to the viewer in the frame of all three: in its x-z plane. Any x will do where they look along the
/// normal.
fn frame(normal: DVec3, to_viewer: DVec3) -> ([DVec3; 2], DVec3) {
    let cos = normal.dot(to_viewer);
    let axis_x = (to_viewer - normal * cos)
        .try_normalize()
        .unwrap_or_else(|| normal.any_orthonormal_vector());
    let wo = DVec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    ([axis_x, normal.cross(axis_x)], wo)
}

/// Bends a normal that the viewer cannot see until its cosine is [`MIN_VIEW_COS`].
fn face_viewer(normal: DVec3, to_viewer: DVec3) -> DVec3 {
    let cos = normal.dot(to_viewer);
    if cos >= MIN_VIEW_COS {
        return normal;
    }
    let tangential = (normal - to_viewer * cos).normalize_or(to_viewer.any_orthonormal_vector());
    to_viewer * MIN_VIEW_COS + tangential * (1.0 - MIN_VIEW_COS * MIN_VIEW_COS).sqrt()
}
