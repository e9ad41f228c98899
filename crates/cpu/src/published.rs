//! The method of 2018 (docs/model.md, section 9), in the place of [`crate::shade_scratches`] and [`crate::shade_base`].
//!
//! The way of a scratch is the same: what the pixel sees of it (`segment`), the light on it (`lights`), and what the base pays.

mod lights;
mod segment;

use crate::gather::gather;
use crate::light_view::LightViews;
use crate::prepared::Prepared;
use crate::published::segment::SegmentView;
use crate::shade_base::SphereOnLobe;
use crate::surface::SurfacePoint;
use hairline_index::method::{PublishedMethod, Structure};
use hairline_index::{Hit, IndexedSegment};
use hairline_optics::band::TUBE_CORNERS;
use hairline_optics::ltc::{LobeFresnel, LtcLobe};
use hairline_optics::mask::{Mask, Masked, ScratchSums};
use hairline_published::polygon::triangulate;
use hairline_published::spectrum::{PUBLISHED_WAVELENGTHS, PublishedSpectrum};
use hairline_published::sptd::{sptd_lobe, sptd_sphere_published};
use hairline_scene::{Light, LightShape};

/// A scene made ready for the published method.
pub(crate) struct Published<'a> {
    prepared: &'a Prepared<'a>,
    method: PublishedMethod,
    mask: Mask,
    /// One for each scratch table.
    spectra: Vec<PublishedSpectrum>,
    /// Triangles of each light of the scene, as corners into its vertices; none for spheres.
    triangles: Vec<Vec<[usize; 3]>>,
}

impl<'a> Published<'a> {
    pub fn new(prepared: &'a Prepared, method: PublishedMethod, mask: Mask) -> Self {
        if method.structure == Structure::TriangleLists {
            // Built now, on one thread: a thread that builds them in parallel while others wait for them may take up one of
            // their pixels meanwhile, and wait for itself.
            prepared.triangle_lists();
        }
        let triangles = |light: &Light| match &light.shape {
            LightShape::Polygon { vertices_m, .. } => triangulate(vertices_m),
            LightShape::Sphere { .. } => Vec::new(),
            // Its outline is convex.
            LightShape::Tube { .. } => (1..TUBE_CORNERS - 1).map(|i| [0, i, i + 1]).collect(),
        };
        Self {
            prepared,
            method,
            mask,
            spectra: prepared.tables.published_spectra(PUBLISHED_WAVELENGTHS),
            triangles: prepared.scene.scratch_lights().map(triangles).collect(),
        }
    }

    /// Radiance of all scratches under the point's footprint, and the energy that they take from the base.
    pub fn scratches(&self, point: &SurfacePoint, hit: &Hit, views: &LightViews) -> Masked {
        // Without anti-aliasing a pixel is the point in its middle.
        let alone = (!self.method.anti_aliasing).then(|| point.without_footprint());
        let point = alone.as_ref().unwrap_or(point);
        let (mut sums, mut density) = (ScratchSums::default(), 0.0);
        let spectrum = &self.spectra[point.table];
        let object = hit.object as usize;
        let mut visit = |segment: &IndexedSegment| {
            let Some(view) = SegmentView::new(point, segment, self.method.anti_aliasing) else {
                return;
            };
            sums.add(
                view.share,
                spectrum.total(view.profile.depth_nm.into()),
                self.radiance(&view, spectrum, views, point).to_array(),
            );
            density += view.density;
        };
        match self.method.structure {
            Structure::Bvh => {
                let segments = &self.prepared.scratches.tree.segments;
                gather(self.prepared, hit.object, point, |i| visit(&segments[i]));
            }
            Structure::TriangleLists => {
                let segments = &self.prepared.scratches.tree.segments;
                let list = self.prepared.triangle_list(hit);
                list.iter().map(|&i| &segments[i as usize]).for_each(visit);
            }
        }
        match self.mask {
            // Twice the share but for the published footprint, which has a density of its own.
            Mask::Density => Masked {
                scratches: sums.radiance,
                taken: [density.min(1.0); 3],
            },
            mask => sums.resolve(mask, self.prepared.scratches.depth_coherence[object] as f64),
        }
    }

    /// Light that the lobe reflects of a sphere, by the pivot transform, for [`crate::shade_base::Base::radiance`].
    pub fn base_sphere(lobe: &LtcLobe, of: &LobeFresnel, sphere: &SphereOnLobe) -> [f64; 3] {
        // The pivot transform knows round lobes alone.
        let roughness = (lobe.alphas.x * lobe.alphas.y).powf(0.25).min(1.0);
        let pivot = sptd_lobe(sphere.wo, roughness);
        // The published fit knows F = 1 alone; Fresnel is that of the whole lobe.
        let share =
            sptd_sphere_published(&pivot, sphere.axis, sphere.sin2) / lobe.albedo.max(1e-30);
        of.albedo.map(|e| e * share)
    }
}

#[cfg(test)]
mod tests;
