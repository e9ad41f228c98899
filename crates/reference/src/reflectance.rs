//! Reflectances of facets and of lobes made of them, by the equations and by quadrature. The curves and tables of the closed form are not used.

use glam::DVec3;
use hairline_cpu::surface::SurfacePoint;
use hairline_optics::coat::COAT_F0;
use hairline_optics::cover::Cover;
use hairline_optics::facets::Facets;
use hairline_optics::fresnel::{dielectric_weight, schlick_weight};
use hairline_optics::ggx::{ggx_alpha, ggx_mean};
use hairline_optics::metal::MetalIndex;
use hairline_optics::spectrum::Observer;
use hairline_scene::{Material, Reflector};

/// The reflectance of a material.
pub(crate) struct Reflectance {
    reflector: Reflector,
    /// Reflectance of a metal, in equal steps of the square root of the cosine.
    metal: Vec<[DVec3; 2]>,
    /// One for each roughness, rising.
    albedos: Vec<Albedos>,
}

/// Directional albedos at one roughness, in equal steps of the square root of the viewer's cosine.
struct Albedos {
    roughness: f64,
    nodes: Vec<Albedo>,
}

/// E0, and the means of [`FacetParts`] over the lobe times E0.
#[derive(Clone, Copy)]
pub(crate) struct Albedo {
    pub e0: f64,
    parts: FacetParts,
}

/// A reflectance is t F90 + s F0.
#[derive(Clone, Copy)]
struct FacetParts {
    t: f64,
    s: f64,
}

/// Reflectance of a surface at normal incidence, and that to which it rises: 1 but for a dielectric whose reflection has a factor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReflectanceEnds {
    pub f0: DVec3,
    pub f90: f64,
}

/// A metal in part, of a share, and a dielectric.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MixedEnds {
    pub metallic: f64,
    pub metal: ReflectanceEnds,
    pub dielectric: ReflectanceEnds,
}

/// A facet's reflectance in linear Rec.709, and that times the reflectance at normal incidence, wavelength by wavelength: light that is
/// scattered once more takes the surface's colour once more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FacetReflectance {
    pub once: DVec3,
    pub twice: DVec3,
}

/// Nodes of a metal's curve: the error of linear interpolation is below 1e-6.
const METAL_NODES: usize = 2049;
/// Nodes of albedos, and points along each axis of their quadrature.
const ALBEDO_NODES: usize = 97;
const ALBEDO_STEPS: usize = 64;
/// Steps of the albedo of a lobe that is seen at one point.
const ALBEDO_STEPS_AT_A_POINT: usize = 24;
/// Steps of roughness where a texture gives it.
const ROUGHNESS_STEPS: usize = 32;

impl ReflectanceEnds {
    pub(crate) const COAT: Self = Self {
        f0: DVec3::splat(COAT_F0),
        f90: 1.0,
    };

    /// Reflectances of a point, mixed where two materials are.
    pub(crate) fn from_point(point: &SurfacePoint) -> Self {
        Self {
            f0: point.fresnel.f0.into(),
            f90: point.fresnel.f90,
        }
    }
}

impl MixedEnds {
    /// A material that is not mixed.
    pub(crate) fn pure(ends: ReflectanceEnds) -> Self {
        Self {
            metallic: 0.0,
            metal: ends,
            dielectric: ends,
        }
    }

    /// The materials whose mixed reflectances a point has.
    pub(crate) fn from_point(point: &SurfacePoint) -> Self {
        let mixed = ReflectanceEnds::from_point(point);
        let (metallic, plastic) = (point.metallic, 1.0 - point.metallic);
        if metallic <= 0.0 || plastic <= 0.0 {
            return Self::pure(mixed);
        }
        let metal = ReflectanceEnds {
            f0: point.diffuse / plastic,
            f90: 1.0,
        };
        let dielectric = ReflectanceEnds {
            f0: (mixed.f0 - metallic * metal.f0) / plastic,
            f90: (mixed.f90 - metallic) / plastic,
        };
        Self {
            metallic,
            metal,
            dielectric,
        }
    }

    /// The mix of what both reflect.
    pub(crate) fn mix(&self, reflected: impl Fn(ReflectanceEnds) -> DVec3) -> DVec3 {
        let by_dielectric = reflected(self.dielectric);
        match self.metallic > 0.0 {
            true => by_dielectric.lerp(reflected(self.metal), self.metallic),
            false => by_dielectric,
        }
    }
}

impl Reflectance {
    pub(crate) fn new(observer: &Observer, material: &Material) -> Self {
        let map = material.metallic_roughness_texture;
        Self::mapped(observer, Reflector::new(material), material.roughness, map)
    }

    /// Reflectance of a material's coat.
    pub(crate) fn of_coat(material: &Material) -> Option<Self> {
        let coat = material.coat?;
        let [_, map] = material.coat_textures;
        Some(Self::mapped(
            Observer::eye(),
            Reflector::COAT,
            coat.roughness,
            map,
        ))
    }

    /// Reflectance for one roughness, or for all where a texture gives it.
    fn mapped(
        observer: &Observer,
        reflector: Reflector,
        roughness: f64,
        map: Option<usize>,
    ) -> Self {
        if map.is_none() {
            return Self::with_roughness(observer, reflector, &[roughness]);
        }
        let step = |i: usize| i as f64 / ROUGHNESS_STEPS as f64;
        let all: Vec<f64> = (0..=ROUGHNESS_STEPS).map(step).collect();
        Self::with_roughness(observer, reflector, &all)
    }

    /// Reflectance for these roughnesses, in ascending order.
    pub(crate) fn with_roughness(
        observer: &Observer,
        reflector: Reflector,
        roughness: &[f64],
    ) -> Self {
        let metal = match &reflector {
            Reflector::Metal(metal) => curve(observer, metal),
            Reflector::Covered(metal, cover) => covered_curve(observer, metal, cover),
            _ => Vec::new(),
        };
        let mut reflectance = Self {
            reflector,
            metal,
            albedos: Vec::new(),
        };
        reflectance.albedos = roughness.iter().map(|r| reflectance.albedos(*r)).collect();
        reflectance
    }

    fn albedos(&self, roughness: f64) -> Albedos {
        let alpha = ggx_alpha(roughness);
        let node = |i: usize| {
            let root = i as f64 / (ALBEDO_NODES - 1) as f64;
            let [e0, t, s] = ggx_mean(root * root, alpha, ALBEDO_STEPS, |cos_h| {
                let FacetParts { t, s } = self.parts(cos_h);
                [1.0, t, s]
            });
            Albedo {
                e0,
                parts: FacetParts { t, s },
            }
        };
        Albedos {
            roughness,
            nodes: (0..ALBEDO_NODES).map(node).collect(),
        }
    }

    /// Reflectance parts of a facet. Metals have no body: nothing asks for their albedo, and the value here is white's.
    fn parts(&self, cos_theta: f64) -> FacetParts {
        let t = match &self.reflector {
            Reflector::Dielectric(ior) => dielectric_weight(cos_theta, *ior),
            Reflector::Schlick => schlick_weight(cos_theta),
            Reflector::Metal(_) | Reflector::Covered(..) => 1.0,
        };
        FacetParts { t, s: 1.0 - t }
    }

    /// Reflectance of a facet.
    pub(crate) fn eval(
        &self,
        cos_theta: f64,
        ReflectanceEnds { f0, f90 }: ReflectanceEnds,
    ) -> FacetReflectance {
        if self.metal.is_empty() {
            let FacetParts { t, s } = self.parts(cos_theta);
            let once = f0 * s + t * f90;
            return FacetReflectance {
                once,
                twice: once * f0,
            };
        }
        let at = cos_theta.clamp(0.0, 1.0).sqrt() * (METAL_NODES - 1) as f64;
        let i = (at as usize).min(METAL_NODES - 2);
        let [once, twice] =
            [0, 1].map(|k| self.metal[i][k].lerp(self.metal[i + 1][k], at - i as f64));
        FacetReflectance { once, twice }
    }

    /// Albedo of the lobe for a viewer, of facets that are not round: too many for a table.
    pub(crate) fn albedo_of(&self, facets: &Facets, wo: DVec3) -> Albedo {
        let [e0, t, s] = facets.mean(wo, ALBEDO_STEPS_AT_A_POINT, |cos_h| {
            let FacetParts { t, s } = self.parts(cos_h);
            [1.0, t, s]
        });
        Albedo {
            e0,
            parts: FacetParts { t, s },
        }
    }

    /// Albedo of the lobe for a viewer.
    pub(crate) fn albedo(&self, roughness: f64, cos_o: f64) -> Albedo {
        let above = self.albedos.partition_point(|a| a.roughness < roughness);
        let high = &self.albedos[above.min(self.albedos.len() - 1)];
        let low = &self.albedos[above.max(1) - 1];
        let span = high.roughness - low.roughness;
        let share = if span > 0.0 {
            ((roughness - low.roughness) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        low.lookup(cos_o).lerp(high.lookup(cos_o), share)
    }
}

/// Light that facets scatter once more meets the plate once more.
fn covered_curve(observer: &Observer, metal: &MetalIndex, cover: &Cover) -> Vec<[DVec3; 2]> {
    let straight = DVec3::from(cover.reflectance_seen_by(observer, metal, 1.0));
    let node = |i: usize| {
        let root = i as f64 / (METAL_NODES - 1) as f64;
        let once = DVec3::from(cover.reflectance_seen_by(observer, metal, root * root));
        [once, once * straight]
    };
    (0..METAL_NODES).map(node).collect()
}

fn curve(observer: &Observer, metal: &MetalIndex) -> Vec<[DVec3; 2]> {
    let node = |i: usize| {
        let root = i as f64 / (METAL_NODES - 1) as f64;
        let at = |nm: f64| metal.reflectance(root * root, nm);
        let once = observer.channels(at);
        let twice = observer.channels(|nm| at(nm) * metal.reflectance(1.0, nm));
        [once, twice].map(DVec3::from)
    };
    (0..METAL_NODES).map(node).collect()
}

impl Albedos {
    fn lookup(&self, cos_o: f64) -> Albedo {
        let at = cos_o.clamp(0.0, 1.0).sqrt() * (ALBEDO_NODES - 1) as f64;
        let i = (at as usize).min(ALBEDO_NODES - 2);
        self.nodes[i].lerp(self.nodes[i + 1], at - i as f64)
    }
}

impl Albedo {
    fn lerp(self, other: Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        Self {
            e0: mix(self.e0, other.e0),
            parts: FacetParts {
                t: mix(self.parts.t, other.parts.t),
                s: mix(self.parts.s, other.parts.s),
            },
        }
    }

    /// Light of multiple scattering over that of single scattering where F = 1.
    pub(crate) fn gain(self) -> f64 {
        1.0 / self.e0.clamp(1e-3, 1.0) - 1.0
    }

    /// Reflectance of a surface's facets without its body, multiple scattering included.
    pub(crate) fn reflected(self, ReflectanceEnds { f0, f90 }: ReflectanceEnds) -> DVec3 {
        (f0 * self.parts.s + self.parts.t * f90) * (DVec3::ONE + f0 * self.gain())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_fixtures::SceneFile;
    use hairline_scene::Coat;

    /// A map of a coat's roughness says which albedo it has, as one of the base's does.
    #[test]
    fn a_coat_of_mapped_roughness_has_the_albedo_of_each() {
        let plate = SceneFile::seen_from([0.0, 0.0, 1.0])
            .up([0.0, 1.0, 0.0])
            .mirror("m")
            .object("o", "m", "plane = { size_m = [0.01, 0.01] }");
        let scene = plate.scene();
        let mut material = scene.materials[0].clone();
        material.coat = Some(Coat {
            weight: 1.0,
            roughness: 0.9,
        });
        let albedo = |of: &Reflectance, roughness| {
            of.albedo(roughness, 0.2).reflected(ReflectanceEnds::COAT).x
        };
        let one = Reflectance::of_coat(&material).unwrap();
        material.coat_textures[1] = Some(0);
        let all = Reflectance::of_coat(&material).unwrap();
        for roughness in [0.25, 0.5] {
            let exact = albedo(
                &Reflectance::with_roughness(Observer::eye(), Reflector::COAT, &[roughness]),
                roughness,
            );
            assert!((albedo(&all, roughness) / exact - 1.0).abs() < 1e-6);
            assert!((albedo(&one, roughness) / exact - 1.0).abs() > 0.1);
        }
    }
}
