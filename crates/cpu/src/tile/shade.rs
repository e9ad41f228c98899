//! The light of a batch of points: scratches of all at once, then base and gratings point by point.

use super::{Picture, PictureMethod, Tile};
use crate::base_layer::transformed_sphere;
use crate::light_view::LightViews;
use crate::method::PointShader;
use crate::pixel_base::PixelBase;
use crate::resolve::{PointLight, Sample};
use crate::sample_point::{SamplePoint, SampleView, Shared};
use crate::shade_gratings::ShadedGratings;
use crate::shade_scratches::{Picks, ScratchPoint};
use crate::shadows::{HitBuffers, Shadows};
use crate::surface::SurfacePoint;
use hairline_index::Hit;
use hairline_optics::mask::{Masked, ScratchSums};

/// A point of a batch whose scratches are shaded.
struct Shaded<'s, 'a> {
    point: &'s SamplePoint<'a>,
    hit: &'s Hit,
    at: &'s SurfacePoint<'a>,
    views: &'s LightViews<'a>,
    base: PixelBase<'s, 'a>,
    sums: ScratchSums,
    /// Samples whose scratches these are.
    samples: f64,
}

impl<'a> Tile<'a> {
    pub(super) fn shade_unless_cancelled(&mut self, column: usize, row: usize) {
        if self.gives_up() {
            return;
        }
        self.look_from_points();
        self.shade_scratches(column, row);
        for i in 0..self.batch.len() {
            if self.picture.shadows.is_some() && self.gives_up() {
                return;
            }
            if let Some(sample) = self.sample(i) {
                self.pixels[self.batch[i].pixel].add(&sample);
            }
        }
    }

    /// Whether it is of no use to go on.
    fn gives_up(&mut self) -> bool {
        self.is_cancelled = self.is_cancelled || (self.cancelled)();
        self.is_cancelled
    }

    /// Looks at the lights from each point.
    fn look_from_points(&mut self) {
        let prepared = self.picture.prepared;
        let is_tiled = matches!(self.picture.by, PictureMethod::Tiles(_));
        for (point, views) in self.batch.iter().zip(&mut self.views) {
            if let SampleView::Surface { point: at, hit, .. } = &point.seen {
                views.look_from(at);
                if is_tiled && (prepared.is_scratched(hit) || prepared.has_gratings(hit)) {
                    views.ready_for_scratches(point.scratched(at));
                }
            }
        }
    }

    /// Sums up the scratches of each point that has its own.
    fn shade_scratches(&mut self, column: usize, row: usize) {
        self.sums.fill(ScratchSums::default());
        for (i, point) in self.batch.iter().enumerate() {
            if let Some(picks) = &mut self.picks
                && let Some(at) = point.scratched_point(&self.picture.camera, &self.views[i])
            {
                picks[i].clear(at.rounds.now.count, at.picks_seed());
            }
        }
        let prepared = self.picture.prepared;
        let PictureMethod::Tiles(lists) = &self.picture.by else {
            return;
        };
        let points = self.batch.iter().zip(&self.views).enumerate();
        let points = points.filter_map(|(index, (point, views))| match &point.seen {
            SampleView::Surface { point: at, hit, .. }
                if prepared.is_scratched(hit) && matches!(point.scratches, Shared::Among(_)) =>
            {
                Some(ScratchPoint {
                    point: point.scratched(at),
                    object: hit.object,
                    at_px: point.at_px,
                    views,
                    index,
                })
            }
            _ => None,
        });
        let points: Vec<ScratchPoint> = points.collect();
        if !points.is_empty() {
            self.shader.shade(
                prepared,
                &points,
                lists.tile(column, row),
                &mut self.sums,
                self.picks.as_deref_mut(),
                &mut self.counts,
            );
        }
    }

    /// Light of a point; none where no ray can start from it.
    fn sample(&mut self, i: usize) -> Option<Sample> {
        let (point, views) = (&self.batch[i], &self.views[i]);
        let (hit, at, parts, depth_m) = match &point.seen {
            SampleView::Background(radiance) => return Some(Sample::background(*radiance)),
            SampleView::Surface {
                hit,
                point,
                parts,
                depth_m,
            } => (hit, point, parts, *depth_m),
        };
        for ((_, part), views) in parts.iter().zip(&mut self.part_views) {
            views.look_from(part);
        }
        let (sums, samples) = match point.scratches {
            Shared::Among(samples) => (self.sums[i], f64::from(samples)),
            Shared::With(leader) => (self.sums[leader], 0.0),
        };
        let shaded = Shaded {
            base: PixelBase::new(at, views, parts, &self.part_views),
            point,
            hit,
            at,
            views,
            sums,
            samples,
        };
        let (masked, light) = match (&self.picture.by, &self.picture.shadows) {
            (PictureMethod::Tiles(_), Some(shadows)) => {
                let picks = self.picks.as_ref().map(|picks| &picks[i]);
                let mut rays = Rays {
                    shadows,
                    grating_picks: &mut self.grating_picks,
                    hit_buffers: &mut self.hit_buffers,
                };
                (
                    shaded.masked(self.picture),
                    rays.light(self.picture, &shaded, picks)?,
                )
            }
            (PictureMethod::Tiles(_), None) => {
                (shaded.masked(self.picture), shaded.open(self.picture))
            }
            (PictureMethod::Other(method), _) => shaded.by_method(self.picture, &**method),
        };
        Some(Sample::surface(at, hit.object, &masked, light, depth_m))
    }
}

impl<'a> Shaded<'_, 'a> {
    /// What scratches take of the base and of one another.
    fn masked(&self, picture: &Picture<'a>) -> Masked {
        let coherence = picture.prepared.depth_coherence(self.hit.object);
        self.sums.resolve(picture.options.mask, coherence)
    }

    /// Light where nothing hides a source.
    fn open(&self, picture: &Picture<'a>) -> PointLight {
        let prepared = picture.prepared;
        let gratings = prepared
            .has_gratings(self.hit)
            .then(|| ShadedGratings::new(prepared, self.at, self.hit.object, self.views, None));
        let environment = prepared.scene.environment.as_ref();
        let base = self.base.radiance(environment, transformed_sphere);
        let mut light = PointLight::open(base, &self.sums, gratings);
        light.scratches = light.scratches.for_samples(self.samples);
        light
    }

    /// Light by a method of others.
    fn by_method(&self, picture: &Picture<'a>, method: &dyn PointShader) -> (Masked, PointLight) {
        let masked = method.scratches(self.at, self.hit, self.views);
        let environment = picture.prepared.scene.environment.as_ref();
        let base = self.base.radiance(environment, |lobe, of, sphere| {
            method.base_sphere(lobe, of, sphere)
        });
        let sums = ScratchSums {
            radiance: masked.scratches,
            ..self.sums
        };
        let whole = Masked {
            kept: 1.0,
            ..masked
        };
        (whole, PointLight::open(base, &sums, None))
    }
}

/// What rays from a point need.
struct Rays<'s, 'a> {
    shadows: &'s Shadows<'a>,
    grating_picks: &'s mut Picks,
    hit_buffers: &'s mut [HitBuffers<'a>],
}

impl<'a> Rays<'_, 'a> {
    /// Light of which a part is hidden, and that of other objects; none where no ray can start.
    fn light(
        &mut self,
        picture: &Picture<'a>,
        shaded: &Shaded<'_, 'a>,
        picks: Option<&Picks>,
    ) -> Option<PointLight> {
        let Shaded { point, views, .. } = *shaded;
        let shadow_point = point.shadow_point(&picture.camera, views)?;
        let mut light = PointLight {
            base: self
                .shadows
                .base(&shadow_point, &shaded.base, self.hit_buffers),
            ..PointLight::default()
        };
        if let Some(picks) = picks
            && let Some(at) = point.scratched_point(&picture.camera, views)
            && picture.prepared.is_scratched(shaded.hit)
        {
            light.scratches = self.shadows.by_picks(&at, picks, self.hit_buffers);
            // Exact to the bit if nothing is hidden.
            light.scratches.open = shaded.sums.radiance.into();
            light.scratches = light.scratches.for_samples(shaded.samples);
        }
        if picture.prepared.has_gratings(shaded.hit) {
            let gratings =
                self.shadows
                    .gratings(&shadow_point, self.grating_picks, self.hit_buffers);
            light.gratings = Some(gratings);
        }
        Some(light)
    }
}
