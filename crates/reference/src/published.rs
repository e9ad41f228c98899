//! The method of 2018, and any mixture of its parts with the default's (docs/model.md, section 9): what
//! [`crate::scratches`] and [`crate::base`] do for the default path.
//!
//! The way of a scratch is the same: what the pixel sees of it (`segment`), the light on it (`lights`), its spectrum
//! (`response`), and what the base pays.

mod lights;
mod response;
mod segment;

use crate::closed_form::Prepared;
use crate::light_view::LightViews;
use crate::published::response::Response;
use crate::published::segment::SegmentView;
use crate::scratches::each_segment;
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::ltc::{LtcLobe, ltc_sphere};
use hairline_optics::mask::{Mask, Masked, ScratchSums};
use hairline_optics::method::{Band, Chords, Method, Spectrum, SphereBase};
use hairline_optics::published::polygon::triangulate;
use hairline_optics::published::spectrum::PublishedSpectrum;
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::sptd::{sptd_lobe, sptd_sphere_published};
use hairline_scene::Light;

/// A scene made ready for a method that the default path has not.
pub(crate) struct Published<'a> {
    prepared: &'a Prepared<'a>,
    method: Method,
    /// One for each scratch table; none where tables are used.
    spectra: Vec<PublishedSpectrum>,
    /// Of each light of the scene, as corners into its vertices; none for spheres, and none where roots are used.
    triangles: Vec<Vec<[usize; 3]>>,
}

impl<'a> Published<'a> {
    /// None for what the default path computes.
    pub fn new(prepared: &'a Prepared, method: Method) -> Option<Self> {
        if method.is_default_path() {
            return None;
        }
        let triangles = |light: &Light| match (method.chords, light) {
            (Chords::Steps, Light::Polygon { vertices_m, .. }) => triangulate(vertices_m),
            _ => Vec::new(),
        };
        Some(Self {
            prepared,
            method,
            spectra: match method.spectrum {
                Spectrum::Table => Vec::new(),
                Spectrum::Wavelengths { count, .. } => prepared.tables.published_spectra(count),
            },
            triangles: prepared.scene.all_lights().map(triangles).collect(),
        })
    }

    /// Radiance of all scratches under the point's footprint, and what they take from the base. `list` is that of the
    /// point's triangle, where the tree is not to be walked.
    pub fn scratches(
        &self,
        point: &SurfacePoint,
        object: usize,
        list: Option<&[u32]>,
        views: &LightViews,
    ) -> Masked {
        let (mut sums, mut density) = (ScratchSums::default(), 0.0);
        let response = self.response(point.table);
        each_segment(self.prepared, point, object, list, |segment| {
            let Some(view) = SegmentView::new(point, segment, self.method.footprint) else {
                return;
            };
            let taken_depth_nm = match self.method.band {
                Band::Lines => oblique_depth_nm(view.depth_nm, point.wo.z, point.wo.z),
                Band::MiddleLine => view.depth_nm,
            };
            sums.add(
                view.share,
                response.total(taken_depth_nm),
                self.radiance(&view, response, views, point).to_array(),
            );
            density += view.density;
        });
        match self.method.mask {
            // Twice the share but for the published footprint, which has a density of its own.
            Mask::Density => Masked {
                scratches: sums.radiance,
                taken: [density.min(1.0); 3],
            },
            mask => sums.resolve(mask, self.prepared.scratches.depth_coherence[object] as f64),
        }
    }

    fn response(&self, table: usize) -> Response<'_> {
        match self.method.spectrum {
            Spectrum::Table => Response::Table(&self.prepared.tables.tables[table]),
            Spectrum::Wavelengths { si, .. } => Response::Wavelengths(&self.spectra[table], si),
        }
    }

    /// The lobe's integrals over a sphere, for [`crate::base::base_radiance`].
    pub fn base_sphere(
        &self,
        point: &SurfacePoint,
    ) -> impl Fn(&LtcLobe, DVec3, f64) -> [f64; 3] + use<> {
        let pivot = match self.method.sphere_base {
            SphereBase::Cosines => None,
            SphereBase::Pivot => Some(sptd_lobe(point.wo, point.roughness)),
        };
        move |lobe, axis, sin2| match &pivot {
            None => ltc_sphere(lobe, axis, sin2),
            // The published fit knows F = 1 alone; Fresnel is that of the whole lobe.
            Some(pivot) => {
                let share = sptd_sphere_published(pivot, axis, sin2) / lobe.albedo[0].max(1e-30);
                lobe.albedo.map(|e| e * share)
            }
        }
    }
}

#[cfg(test)]
mod tests;
