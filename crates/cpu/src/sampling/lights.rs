//! The area lights of a scene as directions to sample: densities are per solid angle, points and directions in world space.
//!
//! A direction is drawn uniformly among those in which the light is seen; of a tube, evenly over its surface. That leaves the cosine and the BRDF to the integrand,
//! which multiple importance sampling with the BRDF's own directions takes care of, and it makes the density a constant for each
//! point and light: sampling and evaluating it cannot disagree.

use glam::{DVec2, DVec3};
use hairline_optics::picture::PicturePlane;
use hairline_scene::{Cone, Light, LightShape, Scene, Texture};
use std::sync::Arc;

mod bound;
mod polygon;
mod sphere;
#[cfg(test)]
mod tests;
mod tube;

use crate::picture::{WHOLE, picture_radiance};
#[cfg(test)]
use bound::Cone as Bound;
use polygon::PolygonLight;
use sphere::SphereLight;
use tube::TubeLight;

/// The lights of a scene, made ready once.
#[derive(Clone, Debug)]
pub struct AreaLights {
    lights: Vec<AreaLight>,
}

#[derive(Clone, Debug)]
struct AreaLight {
    shape: Shape,
    radiance: DVec3,
    cone: Option<Cone>,
    picture: Option<Picture>,
}

/// A picture on a light: its texture, and the light's corners.
#[derive(Clone, Debug)]
struct Picture {
    textures: Arc<Vec<Texture>>,
    texture: usize,
    corners_m: [DVec3; 4],
}

impl Picture {
    /// Value of the picture along a ray.
    fn seen(&self, from: DVec3, direction: DVec3) -> DVec3 {
        let plane = PicturePlane::from_corners(&self.corners_m.map(|corner| corner - from));
        let texture = &self.textures[self.texture];
        picture_radiance(texture, plane.picture_uv(direction), 0.0, WHOLE)
    }
}

impl AreaLight {
    /// Radiance that comes along a ray; every point of the light has its own cone.
    fn seen(&self, from: DVec3, direction: DVec3) -> DVec3 {
        let even = self.radiance * self.cone.map_or(1.0, |cone| cone.share(-direction));
        let picture = self.picture.as_ref();
        picture.map_or(even, |picture| even * picture.seen(from, direction))
    }
}

#[derive(Clone, Debug)]
enum Shape {
    Sphere(SphereLight),
    Polygon(PolygonLight),
    Tube(TubeLight),
}

/// A direction towards a light.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit vector.
    pub direction: DVec3,
    /// Distance to the point of the light that is seen there.
    pub distance_m: f64,
    /// Density of the direction, per steradian.
    pub pdf: f64,
    /// Linear Rec.709.
    pub radiance: DVec3,
}

/// Hit of a ray on a light.
#[derive(Clone, Copy, Debug)]
pub struct LightHit {
    /// Distance to the ray's first point on the light.
    pub distance_m: f64,
    /// Linear Rec.709.
    pub radiance: DVec3,
}

impl AreaLights {
    /// The lights of a scene. The environment's suns are not among them: [`EnvironmentSampler`](super::environment::EnvironmentSampler)
    /// finds them in its map.
    pub fn new(scene: &Scene) -> Self {
        Self::with_textures(&scene.lights, &scene.textures)
    }

    /// Makes the lights, in this order, with the textures of their pictures.
    ///
    /// # Panics
    /// Panics if a picture is not among them.
    pub(crate) fn with_textures<'l>(
        lights: impl IntoIterator<Item = &'l Light>,
        textures: &Arc<Vec<Texture>>,
    ) -> Self {
        let lights = lights
            .into_iter()
            .map(|light| AreaLight {
                shape: match &light.shape {
                    LightShape::Sphere { center_m, radius_m } => {
                        Shape::Sphere(SphereLight::new(*center_m, *radius_m))
                    }
                    LightShape::Polygon {
                        vertices_m,
                        two_sided,
                    } => Shape::Polygon(PolygonLight::new(vertices_m, *two_sided)),
                    LightShape::Tube { ends_m, radius_m } => {
                        Shape::Tube(TubeLight::new(*ends_m, *radius_m))
                    }
                },
                radiance: light.radiance.into(),
                cone: light.cone,
                picture: picture(light, textures),
            })
            .collect();
        Self { lights }
    }

    /// Number of lights.
    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A direction towards light `i` as seen from the point `from`. `u` is in [0, 1)^2.
    /// None where the light shows its dark side or its edge.
    pub fn sample(&self, i: usize, from: DVec3, u: DVec2) -> Option<LightSample> {
        let light = &self.lights[i];
        let (direction, distance_m, pdf) = match &light.shape {
            Shape::Sphere(sphere) => sphere.sample(from, u),
            Shape::Polygon(polygon) => polygon.sample(from, u),
            Shape::Tube(tube) => tube.sample(from, u),
        }?;
        Some(LightSample {
            direction,
            distance_m,
            pdf,
            radiance: light.seen(from, direction),
        })
    }

    /// Intersects a ray (unit `direction`) with light `i`, and returns its first point on the light. None if it misses, or meets a dark side. From inside a
    /// sphere every ray hits.
    pub fn hit(&self, i: usize, from: DVec3, direction: DVec3) -> Option<LightHit> {
        let light = &self.lights[i];
        let distance_m = match &light.shape {
            Shape::Sphere(sphere) => sphere.hit(from, direction),
            Shape::Polygon(polygon) => polygon.hit(from, direction),
            Shape::Tube(tube) => tube.hit(from, direction),
        }?;
        Some(LightHit {
            distance_m,
            radiance: light.seen(from, direction),
        })
    }

    /// The distance along a unit `direction` at which a ray that goes to light `i` arrives: also where it passes beside the light by little.
    pub fn reach_m(&self, i: usize, from: DVec3, direction: DVec3) -> f64 {
        match &self.lights[i].shape {
            Shape::Sphere(sphere) => sphere.distance_m(from, direction).1,
            Shape::Polygon(polygon) => polygon.plane_m(from, direction),
            Shape::Tube(tube) => tube.reach_m(from, direction),
        }
    }

    /// Length of a ray to light `i`, which arrives at `distance_m`, over which an object would hide the light. It ends `step_m` above a flat light, so that it
    /// does not meet the surface that the light lies in.
    pub fn clear_m(&self, i: usize, direction: DVec3, distance_m: f64, step_m: f64) -> f64 {
        let cos = match &self.lights[i].shape {
            Shape::Sphere(_) | Shape::Tube(_) => 1.0,
            Shape::Polygon(polygon) => polygon.cos(direction).abs(),
        };
        // A point that is nearer to the light's plane has nothing before it.
        (distance_m - step_m / cos.max(f64::MIN_POSITIVE)).max(0.0)
    }

    /// The density of [`AreaLights::sample`] at a direction that hits light `i`, per steradian; the same for all of them.
    /// 0 where nothing can be sampled.
    pub fn pdf(&self, i: usize, from: DVec3, direction: DVec3) -> f64 {
        match &self.lights[i].shape {
            Shape::Sphere(sphere) => sphere.pdf(from),
            Shape::Polygon(polygon) => polygon.pdf(from),
            Shape::Tube(tube) => tube.pdf(from, direction),
        }
    }

    /// Returns a cone that holds every direction from a point to light `i`; the tests draw even directions from it. To tell which directions a light can reach,
    /// [`AreaLights::extent`] is tighter.
    #[cfg(test)]
    pub(crate) fn bound(&self, i: usize, from: DVec3) -> Bound {
        match &self.lights[i].shape {
            Shape::Sphere(sphere) => sphere.bound(from),
            Shape::Polygon(polygon) => polygon.bound(from),
            Shape::Tube(tube) => tube.bound(from),
        }
    }

    /// Bounds on the component along a unit `axis` of the unit directions from a point to light `i`. For polygons they are
    /// tighter than those of a cone about them.
    pub fn extent(&self, i: usize, from: DVec3, axis: DVec3) -> (f64, f64) {
        match &self.lights[i].shape {
            Shape::Sphere(sphere) => sphere.bound(from).extent(axis),
            Shape::Polygon(polygon) => polygon.extent(from, axis),
            Shape::Tube(tube) => tube.extent(from, axis),
        }
    }
}

fn picture(light: &Light, textures: &Arc<Vec<Texture>>) -> Option<Picture> {
    let texture = light.picture?;
    let LightShape::Polygon { vertices_m, .. } = &light.shape else {
        return None;
    };
    assert!(texture < textures.len(), "a picture without its texture");
    Some(Picture {
        textures: textures.clone(),
        texture,
        corners_m: vertices_m.as_slice().try_into().ok()?,
    })
}
