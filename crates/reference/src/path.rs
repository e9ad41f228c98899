//! One path: from the camera to a surface, to the lights, and on to further surfaces.

mod scratches;

use super::base::BaseLobes;
use super::coherent::Field;
use super::gratings::RowView;
use super::grooves::{self, GrooveView, REACH_OF_AMPLITUDE, REACH_OF_ENERGY};
use super::integrator::{Integrator, Model};
use super::random::{Purpose, Random};
use super::separable::Lobe;
use super::wavelengths::{SpectralFresnel, Spectrum, Wavelengths};

use glam::{DVec2, DVec3};
use hairline_cpu::surface::{SeenHit, SurfacePoint, surface_point};
use hairline_index::Hit;
use hairline_optics::ggx::{GGX_MIN_ALPHA, ggx_alpha};
use hairline_optics::groove_spectrum::GrooveSpectrum;
use hairline_optics::mask::ScratchSums;

/// Light that a sample adds to the film.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Light {
    /// Light whose last reflection is by the base, or that the surface emits, or that passed it.
    pub base: DVec3,
    /// Light whose last reflection is by scratches.
    pub scratches: DVec3,
    /// Light that scratches take from the base at the first surface.
    pub density: DVec3,
}

impl Light {
    pub(crate) fn total(&self) -> DVec3 {
        self.base + self.scratches
    }
}

/// A place on a path, with its lobes.
struct Vertex<'a> {
    point: &'a SurfacePoint<'a>,
    lobes: BaseLobes<'a>,
    /// Share of the base's specular reflection that is left; 0 where the field replaces it.
    specular_kept: DVec3,
    response: Response<'a>,
    /// Number of surfaces that the path met before.
    depth: u32,
    random: Random,
}

/// Response of the scratches, by the model.
enum Response<'a> {
    Separable {
        lobes: Vec<Lobe<'a>>,
        kept: f64,
        /// Lobe of a grating under the scratches, and the share of its light that the scratches leave.
        row: Option<Box<(Lobe<'a>, DVec3)>>,
    },
    Full(Box<Field<'a>>),
}

impl Vertex<'_> {
    /// The base's BRDF times the cosine for a direction of the surface's frame.
    fn base(&self, wi: DVec3) -> DVec3 {
        let (specular, diffuse) = self.lobes.eval(wi);
        specular * self.specular_kept + diffuse
    }

    fn world(&self, direction: DVec3) -> DVec3 {
        self.point.world_from_surface(direction)
    }
}

impl Integrator<'_> {
    /// Radiance along a ray. `wavelengths` are the path's.
    pub(super) fn arrive(
        &self,
        origin_m: DVec3,
        direction: DVec3,
        wavelengths: &Wavelengths,
        random: Random,
    ) -> Light {
        match self.triangles.intersect_drawn(origin_m, direction) {
            Some(hit) => self.leave(origin_m, direction, &hit, wavelengths, 0, random),
            None => Light {
                base: match &self.scene.environment {
                    Some(environment) if environment.visible() => environment.radiance(direction),
                    _ => DVec3::ZERO,
                },
                ..Light::default()
            },
        }
    }

    /// Radiance that leaves a surface against the ray that hit it.
    fn leave(
        &self,
        origin_m: DVec3,
        direction: DVec3,
        hit: &Hit,
        wavelengths: &Wavelengths,
        depth: u32,
        random: Random,
    ) -> Light {
        let at_a_point = |_| [DVec3::ZERO; 2];
        let seen = SeenHit {
            hit,
            position_m: origin_m + direction * hit.distance_m,
            to_viewer: -direction,
        };
        let point = surface_point(self.scene, &self.tables, &seen, at_a_point);
        let object = hit.object as usize;
        let mut views = grooves::gather(
            (&self.grooves, &self.tables.shapes),
            self.widest_um[object],
            object,
            &point,
            self.reach_sigma(),
        );
        let row = RowView::drawn(self.scene, object, &self.tables, &point, random);
        let material = &self.scene.materials[point.material];
        let optics = &self.tables.materials[point.material];
        let reflectance = &self.reflectances[point.material];
        let coat = self.coats[point.material].as_ref();
        let fresnel = SpectralFresnel::new(&material.base, optics, &point, reflectance, coat);
        let (response, taken, specular_kept) = match self.settings.model {
            Model::Separable => {
                let weights = fresnel.separable(wavelengths);
                let (response, left) =
                    self.separable(object, &point, &views, row, wavelengths, &weights);
                (response, DVec3::ONE - left, left)
            }
            Model::Full => {
                if let Some(row) = &row {
                    views.extend(row.grooves(random, point.coherence_um, self.reach_sigma()));
                }
                full(&point, &views, row.as_ref(), wavelengths, &fresnel)
            }
        };
        let vertex = Vertex {
            lobes: BaseLobes::new(&point, reflectance, coat),
            specular_kept,
            response,
            depth,
            random,
            point: &point,
        };
        Light {
            density: taken,
            ..self.reflected(&vertex, wavelengths)
        }
    }

    /// How far grooves reach, in standard deviations of the coherence window.
    fn reach_sigma(&self) -> f64 {
        match self.settings.model {
            Model::Separable => REACH_OF_ENERGY,
            Model::Full => REACH_OF_AMPLITUDE,
        }
    }

    /// The response of the scratches each by itself, and the share of the base's light that they and a grating leave.
    fn separable<'s>(
        &'s self,
        object: usize,
        point: &SurfacePoint,
        views: &[GrooveView],
        row: Option<RowView<'s>>,
        wavelengths: &Wavelengths,
        weights: &Spectrum<DVec3>,
    ) -> (Response<'s>, DVec3) {
        let (kept, taken) = self.mask(object, point, views);
        let sigma_um = point.coherence_um;
        let lobes = lobes(views, &self.spectra, wavelengths, weights, sigma_um);
        let mut left = DVec3::ONE - taken;
        // Scratches lie on top.
        let row = row.map(|row| {
            let lobe = Lobe::of_row(&row, wavelengths, weights, sigma_um);
            let under = Box::new((lobe, left));
            left *= DVec3::ONE - row.taken(&self.tables);
            under
        });
        (Response::Separable { lobes, kept, row }, left)
    }

    /// Light that a vertex emits, and light off its lobes.
    fn reflected(&self, vertex: &Vertex, wavelengths: &Wavelengths) -> Light {
        let mut light = Light {
            base: vertex.point.emission,
            ..Light::default()
        };
        light.base += self.by_base(vertex, wavelengths);
        match &vertex.response {
            Response::Separable { lobes, kept, row } => {
                light.scratches += *kept * self.by_grooves(vertex, lobes, wavelengths);
                if let Some(row) = row {
                    let (lobe, left) = &**row;
                    let lobe = std::slice::from_ref(lobe);
                    light.scratches += *left * self.by_grooves(vertex, lobe, wavelengths);
                }
            }
            Response::Full(field) if !field.is_empty() => {
                let by_field = self.by_field(vertex, field, wavelengths);
                light.base += by_field.base;
                light.scratches += by_field.scratches;
            }
            Response::Full(_) => {}
        }
        light
    }

    /// Share of their light that scratches keep beside one another, and the share that they take from the base.
    fn mask(&self, object: usize, point: &SurfacePoint, views: &[GrooveView]) -> (f64, DVec3) {
        let mut sums = ScratchSums::default();
        for view in views {
            let table = &self.tables.tables[point.table + usize::from(view.shape)];
            // In the mirror's direction both cosines are the viewer's.
            let total = table.scratch_table_total(view.piece.depth_nm * point.wo.z);
            sums.add(view.share, total, [0.0; 3]);
        }
        let coherence = self.depth_coherence[object] as f64;
        let masked = sums.resolve(self.settings.mask, coherence);
        (masked.kept, masked.taken.into())
    }

    /// Light off the base: multiple importance sampling of lights and lobes (E. Veach, 1997).
    fn by_base(&self, vertex: &Vertex, wavelengths: &Wavelengths) -> DVec3 {
        let point = vertex.point;
        let mut sum = DVec3::ZERO;
        let [pick, u, v, _] = vertex.random.four(Purpose::BaseLobe);
        let drawn = vertex
            .lobes
            .sample(pick, DVec2::new(u, v))
            .map(|wi| (vertex.world(wi), vertex.base(wi), vertex.lobes.pdf(wi)))
            .filter(|(_, _, pdf)| *pdf > 0.0);
        for i in 0..self.lights.len() {
            let [u, v, ..] = vertex.random.four(Purpose::Light(i as u32));
            if let Some(to) = self.lights.sample(i, point.position_m, DVec2::new(u, v))
                && !self.is_hidden(point, i, to.direction, to.distance_m)
            {
                let wi = point.surface_from_world(to.direction);
                if vertex.lobes.are_above(wi) {
                    let pdf = to.pdf + vertex.lobes.pdf(wi);
                    sum += to.radiance * vertex.base(wi) / pdf;
                }
            }
            if let Some((direction, value, pdf)) = drawn
                && let Some(hit) = self.lights.hit(i, point.position_m, direction)
                && !self.is_hidden(point, i, direction, hit.distance_m)
            {
                let pdf = pdf + self.lights.pdf(i, point.position_m, direction);
                sum += hit.radiance * value / pdf;
            }
        }
        // Hit of the drawn direction: the next surface, or the environment.
        let next = drawn.and_then(|(direction, ..)| self.next_surface(vertex, direction));
        if let (Some(environment), Some(sampler)) = (&self.scene.environment, &self.environment) {
            let [u, v, ..] = vertex.random.four(Purpose::Environment);
            let (direction, sampler_pdf) = sampler.sample(DVec2::new(u, v));
            let wi = point.surface_from_world(direction);
            let is_lit = vertex.lobes.are_above(wi) && sampler_pdf > 0.0;
            if is_lit && self.next_surface(vertex, direction).is_none() {
                let pdf = sampler_pdf + vertex.lobes.pdf(wi);
                sum += point.open * environment.radiance(direction) * vertex.base(wi) / pdf;
            }
            if let Some((direction, value, pdf)) = drawn
                && next.is_none()
            {
                let pdf = pdf + sampler.pdf(direction);
                sum += point.open * environment.radiance(direction) * value / pdf;
            }
        }
        if let (Some((direction, value, pdf)), Some(hit)) = (drawn, next) {
            sum += value / pdf * self.next_light(vertex, direction, &hit, wavelengths);
        }
        sum
    }

    /// Light from the surface that a path meets next.
    fn next_light(
        &self,
        vertex: &Vertex,
        direction: DVec3,
        hit: &Hit,
        wavelengths: &Wavelengths,
    ) -> DVec3 {
        if vertex.depth >= self.settings.bounces {
            return DVec3::ZERO;
        }
        let origin_m = self.off_the_surface(vertex.point, direction);
        let random = vertex.random.next_vertex();
        self.leave(
            origin_m,
            direction,
            hit,
            wavelengths,
            vertex.depth + 1,
            random,
        )
        .total()
    }

    /// The surface that hides the environment in a direction: with shadows any, else one that the path goes on from, whose
    /// light takes the place of the hidden part.
    fn next_surface(&self, vertex: &Vertex, direction: DVec3) -> Option<Hit> {
        if !self.settings.shadows && vertex.depth >= self.settings.bounces {
            return None;
        }
        let origin_m = self.off_the_surface(vertex.point, direction);
        self.triangles.intersect_solid(origin_m, direction)
    }

    /// Whether an object hides light `i` at some distance. The surface that a flat light lies in hides nothing of it.
    fn is_hidden(&self, point: &SurfacePoint, i: usize, direction: DVec3, distance_m: f64) -> bool {
        if !self.settings.shadows {
            return false;
        }
        let step_m = self.step_m(point.position_m + direction * distance_m);
        let clear_m = self.lights.clear_m(i, direction, distance_m, step_m);
        let origin_m = self.off_the_surface(point, direction);
        let way_m = point.position_m + direction * clear_m - origin_m;
        let to_end = way_m.normalize_or(direction);
        self.triangles.is_hidden(origin_m, to_end, way_m.length())
    }

    /// Start of a ray, moved off the surface so that the ray does not meet the surface that it leaves.
    fn off_the_surface(&self, point: &SurfacePoint, direction: DVec3) -> DVec3 {
        point.raised_m + self.step_m(point.position_m) * (direction + point.normal)
    }

    /// Distance by which rounding may move a point on a surface: vertices are in single precision, and this is some ten of
    /// its steps.
    fn step_m(&self, at_m: DVec3) -> f64 {
        1e-6 * (self.extent_m + at_m.length())
    }
}

/// The response of the whole field, what it takes from the base, and the share of the base's specular reflection that it leaves.
fn full<'a>(
    point: &'a SurfacePoint<'a>,
    views: &'a [GrooveView],
    row: Option<&RowView<'a>>,
    wavelengths: &'a Wavelengths,
    fresnel: &'a SpectralFresnel<'a>,
) -> (Response<'a>, DVec3, DVec3) {
    let roughness = point.coat.map_or(point.roughness, |coat| coat.roughness);
    let brushed = point.coat.is_none() && point.facets.is_some();
    let smooth = ggx_alpha(roughness) <= GGX_MIN_ALPHA && !brushed;
    let field = Field::new(point, views, row, smooth, wavelengths, fresnel);
    let taken = field.taken();
    let lobe = if smooth {
        DVec3::ZERO
    } else {
        DVec3::ONE - taken
    };
    (Response::Full(Box::new(field)), taken, lobe)
}

fn lobes<'a>(
    views: &[GrooveView],
    spectra: &'a [Option<GrooveSpectrum>],
    wavelengths: &Wavelengths,
    weights: &Spectrum<DVec3>,
    coherence_um: f64,
) -> Vec<Lobe<'a>> {
    views
        .iter()
        .filter(|view| view.share.segment > 0.0)
        .map(|view| {
            let spectrum = spectra[usize::from(view.shape)].as_ref();
            Lobe::new(view, spectrum, wavelengths, weights, coherence_um)
        })
        .collect()
}
