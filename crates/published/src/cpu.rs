//! The method on the CPU (docs/model.md, section 9).
//!
//! The way of a scratch is Hairline's: what the pixel sees of it (`segment`), the light on it (`lights`), and what the base pays.

mod lights;
mod segment;

use crate::cpu::segment::SegmentView;
use crate::polygon::triangulate;
use crate::spectrum::{PublishedSpectrum, published_spectra};
use crate::sptd::{sptd_lobe, sptd_sphere_published};
use crate::switches::{PublishedMethod, Structure};
use crate::triangle_lists::TriangleLists;
use hairline_cpu::closed_form::Prepared;
use hairline_cpu::method::{LightViews, PointShader, ShadingMethod, SphereOnLobe, gather};
use hairline_cpu::surface::SurfacePoint;
use hairline_index::{Hit, IndexedSegment, ScratchIndex};
use hairline_optics::band::TUBE_CORNERS;
use hairline_optics::ltc::{LobeFresnel, LtcLobe};
use hairline_optics::mask::{Mask, Masked, ScratchSums};
use hairline_scene::{Light, LightShape};
use std::sync::{Arc, Mutex, PoisonError};

/// The method, with the lists of the scratches that it rendered last.
pub(crate) struct OnCpu {
    method: PublishedMethod,
    lists: Mutex<Option<(Arc<ScratchIndex>, Arc<TriangleLists>)>>,
}

impl OnCpu {
    /// The method with these switches.
    pub(crate) fn new(method: PublishedMethod) -> Self {
        Self {
            method,
            lists: Mutex::default(),
        }
    }

    fn lists(&self, prepared: &Prepared) -> Arc<TriangleLists> {
        let kept = || self.lists.lock().unwrap_or_else(PoisonError::into_inner);
        let index = prepared.laid();
        if let Some((of, lists)) = &*kept()
            && Arc::ptr_eq(of, index)
        {
            return lists.clone();
        }
        // Not locked meanwhile: a thread that waits for a part of the lists may take up another picture, and wait for itself.
        let lists = Arc::new(TriangleLists::build(prepared.scene(), index));
        *kept() = Some((index.clone(), lists.clone()));
        lists
    }
}

impl ShadingMethod for OnCpu {
    fn prepare<'a>(&self, prepared: &'a Prepared<'a>, mask: Mask) -> Box<dyn PointShader + 'a> {
        let mut published = Published::new(prepared, self.method, mask);
        if self.method.structure == Structure::TriangleLists {
            published.lists = Some(self.lists(prepared));
        }
        Box::new(published)
    }
}

/// A scene made ready for the method.
struct Published<'a> {
    prepared: &'a Prepared<'a>,
    method: PublishedMethod,
    mask: Mask,
    /// One for each scratch table.
    spectra: Vec<PublishedSpectrum>,
    /// Triangles of each light of the scene, as corners into its vertices; none for spheres.
    triangles: Vec<Vec<[usize; 3]>>,
    /// The scratches of each triangle, in the place of the tree.
    lists: Option<Arc<TriangleLists>>,
    /// Index of the first triangle of each object, counted over the whole scene.
    first_triangles: Vec<usize>,
}

impl<'a> Published<'a> {
    fn new(prepared: &'a Prepared<'a>, method: PublishedMethod, mask: Mask) -> Self {
        let scene = prepared.scene();
        let triangles = |light: &Light| match &light.shape {
            LightShape::Polygon { vertices_m, .. } => triangulate(vertices_m),
            LightShape::Sphere { .. } => Vec::new(),
            // Its outline is convex.
            LightShape::Tube { .. } => (1..TUBE_CORNERS - 1).map(|i| [0, i, i + 1]).collect(),
        };
        let mut next = 0;
        let first_triangles = scene.objects.iter().map(|object| {
            let first = next;
            next += object.mesh.triangles.len();
            first
        });
        Self {
            prepared,
            method,
            mask,
            spectra: published_spectra(prepared.tables()),
            triangles: scene.all_lights().map(triangles).collect(),
            lists: None,
            first_triangles: first_triangles.collect(),
        }
    }
}

impl PointShader for Published<'_> {
    fn scratches(&self, point: &SurfacePoint, hit: &Hit, views: &LightViews) -> Masked {
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
        let index = self.prepared.laid();
        let segments = &index.tree.segments;
        match &self.lists {
            None => gather(&index.tree, hit.object, point, |i| visit(&segments[i])),
            Some(lists) => {
                let list = lists.list(self.first_triangles[object] + hit.triangle as usize);
                list.iter().map(|&i| &segments[i as usize]).for_each(visit);
            }
        }
        match self.mask {
            // Twice the share but for the published footprint, which has a density of its own.
            Mask::Density => Masked {
                kept: 1.0,
                scratches: sums.radiance,
                taken: [density.min(1.0); 3],
            },
            mask => sums.resolve(mask, index.depth_coherence[object].into()),
        }
    }

    /// By the pivot transform.
    fn base_sphere(&self, lobe: &LtcLobe, of: &LobeFresnel, sphere: &SphereOnLobe) -> [f64; 3] {
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
