//! Contents of a pixel of the picture: rendered anew by itself, from the same scene and the same place, whatever paints.

use std::sync::{Arc, Mutex, PoisonError};

use egui::{Pos2, Rect};
use glam::{DVec2, DVec3};
use hairline_document::DEFAULT_SAMPLES;
use hairline_editor::actions::layers;
use hairline_image::Display;
use hairline_index::Hit;
use hairline_index::scratch_index::{FACING_MIN_COS, REACH_STD};
use hairline_render::Task;
use hairline_scene::{CameraFrame, Scene};

use super::false_color;
use crate::jobs::Job;
use crate::progressive::{Built, SHADOW_SAMPLES, View};

/// A pixel, and the surface under it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Column and row of the window's picture.
    pub at_px: [u32; 2],
    /// Light off the base. Linear Rec.709 radiance, W sr^-1 m^-2.
    pub base: [f32; 3],
    /// Light off the scratches. Linear Rec.709 radiance, W sr^-1 m^-2.
    pub scratches: [f32; 3],
    /// The share of the base's light that the scratches take.
    pub density: [f32; 3],
    /// Distance along the view axis; 0 where there is no surface.
    pub depth_m: f32,
    /// Normal of the surface, world space; 0 where there is none.
    pub normal: [f32; 3],
    /// The object and its material under the pixel's centre.
    pub under: Option<SurfaceHit>,
    /// Number of segments of scratches with a share in the pixel.
    pub segments: f64,
    /// Samples that the pixel took.
    pub samples: u32,
}

/// Hit of the ray through a pixel's centre.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Name of the object.
    pub object: String,
    /// Name of the material.
    pub material: String,
    /// World space.
    pub point_m: DVec3,
    /// The layers of scratches that have a segment there.
    pub layers: Vec<String>,
}

impl Reading {
    /// Base and scratches.
    pub fn beauty(&self) -> [f32; 3] {
        std::array::from_fn(|i| self.base[i] + self.scratches[i])
    }

    /// Codes of the display for the pixel's colour, 0 to 255.
    pub fn codes(&self, display: &Display) -> [u8; 3] {
        let encoded = display.apply(self.beauty());
        encoded.map(|value| (value * 255.0).round().clamp(0.0, 255.0) as u8)
    }

    /// Number of stops from middle grey after exposure; negative infinity without light.
    pub fn stops(&self, display: &Display) -> f32 {
        false_color::stops(self.beauty(), display)
    }
}

/// A pixel of a view of a scene.
#[derive(Clone)]
struct ProbedPixel {
    built: Arc<Built>,
    view: View,
    at_px: [u32; 2],
}

impl ProbedPixel {
    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.built, &other.built)
            && self.view.has_same_pixels(&other.view)
            && self.at_px == other.at_px
    }
}

/// The probe: it follows the pointer, or stays where a click put it.
#[derive(Default)]
pub(crate) struct Probe {
    is_on: bool,
    /// Shares of the picture's width and height.
    kept: Option<[f32; 2]>,
    answer: Arc<Mutex<Option<Reading>>>,
    asked: Option<ProbedPixel>,
    job: Option<Job>,
}

impl Probe {
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    pub fn toggle(&mut self) {
        *self = Self {
            is_on: !self.is_on,
            ..Self::default()
        };
    }

    /// Keeps the pixel that was clicked. False if the click is none of the probe's.
    pub fn click(&mut self, area: Rect, pos: Pos2) -> bool {
        if self.is_on {
            let share = (pos - area.min) / area.size();
            self.kept = Some([share.x, share.y]);
        }
        self.is_on
    }

    /// Follows the pointer again; false if it did already.
    pub fn release(&mut self) -> bool {
        self.kept.take().is_some()
    }

    /// Position where it was put, in an area of the screen.
    pub fn kept_at(&self, area: Rect) -> Option<Pos2> {
        let [x, y] = self.kept?;
        Some(area.min + egui::vec2(x, y) * area.size())
    }

    /// The newest reading.
    pub fn reading(&self) -> Option<Reading> {
        let answer = self.answer.lock();
        answer.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Asks for the pixel at `pos` of the picture that fills `area`, one at a time.
    pub fn follow(
        &mut self,
        ctx: &egui::Context,
        built: &Arc<Built>,
        view: &View,
        area: Rect,
        pos: Pos2,
    ) {
        let share = (pos - area.min) / area.size();
        let pixel = |share: f32, side: u32| {
            let at = share * side as f32;
            (at.max(0.0) as u32).min(side.saturating_sub(1))
        };
        let spot = ProbedPixel {
            built: Arc::clone(built),
            view: *view,
            at_px: [
                pixel(share.x, view.size_px[0]),
                pixel(share.y, view.size_px[1]),
            ],
        };
        let is_asked = self
            .asked
            .as_ref()
            .is_some_and(|asked| asked.is_same(&spot));
        if is_asked || self.job.as_ref().is_some_and(|job| !job.is_over()) {
            return;
        }
        let (answer, wake, wanted) = (Arc::clone(&self.answer), ctx.clone(), spot.clone());
        // Without a thread there is no reading; the picture is there all the same.
        self.job = Job::start("probe", move |_| {
            let reading = read(&wanted);
            *answer.lock().unwrap_or_else(PoisonError::into_inner) = reading;
            wake.request_repaint();
        })
        .ok();
        self.asked = Some(spot);
    }
}

fn read(spot: &ProbedPixel) -> Option<Reading> {
    let ProbedPixel { built, view, at_px } = spot;
    let mut scene = built.scene.clone();
    scene.camera = view.camera;
    scene.render.size_px = view.size_px;
    scene.render.filter_std_px = view.filter_std_px;
    let prepared = built.parts().prepared(&scene);
    let samples = match view.transport.shadows {
        true => SHADOW_SAMPLES,
        false => DEFAULT_SAMPLES,
    };
    let options = Task::new(samples, view.transport).options();
    let pixel = prepared.read_pixel(&options, *at_px)?;
    let image = &pixel.image;
    Some(Reading {
        at_px: *at_px,
        base: image.base[0],
        scratches: image.scratches[0],
        density: image.density[0],
        depth_m: image.depth_m[0],
        normal: image.normal[0],
        under: pixel
            .hit
            .and_then(|hit| surface_under(built, &scene, *at_px, &hit)),
        segments: pixel.segments,
        samples: pixel.samples,
    })
}

fn surface_under(built: &Built, scene: &Scene, at_px: [u32; 2], hit: &Hit) -> Option<SurfaceHit> {
    let object = scene.objects.get(hit.object as usize)?;
    let mesh = &object.mesh;
    let material = *mesh.triangle_materials.get(hit.triangle as usize)?;
    let camera = scene.camera.frame(scene.render.size_px);
    let at = DVec2::new(at_px[0].into(), at_px[1].into()) + 0.5;
    let ray = camera.camera_ray(at).normalize();
    let point_m = camera.position_m + ray * hit.distance_m;
    let corners = mesh.triangles.get(hit.triangle as usize)?;
    let normal: DVec3 = corners
        .iter()
        .map(|corner| mesh.normals[*corner as usize].as_dvec3())
        .sum();
    let [right, down] = [camera.per_px_x, camera.per_px_y].map(DVec3::length);
    let depth_m = (point_m - camera.position_m).dot(camera.forward);
    let coherence_um = built.scratches.coherence_max_um();
    let window_m = 1e-6 * f64::from(*coherence_um.get(hit.object as usize)?);
    let window_px = window_m / (depth_m * right.min(down)).max(f64::MIN_POSITIVE);
    let reach_px = f64::from(REACH_STD) * scene.render.filter_std_px.hypot(window_px);
    let mut seen = vec![false; built.description.scratches.len()];
    for scratch in object.scratches.iter() {
        let Some(seen) = seen.get_mut(scratch.layer as usize).filter(|seen| !**seen) else {
            continue;
        };
        let range = scratch.segments.start as usize..scratch.segments.end as usize;
        *seen = object
            .segments
            .get(range)
            .into_iter()
            .flatten()
            .any(|segment| {
                let ends =
                    [segment.start_m, segment.end_m].map(|m| on_picture(&camera, m.as_dvec3()));
                let faces = segment.normal.as_dvec3().dot(normal.normalize_or_zero());
                matches!(ends, [Some(a), Some(b)] if distance(at, a, b) <= reach_px)
                    && faces >= f64::from(FACING_MIN_COS)
            });
    }
    let names = built.description.scratches.iter().zip(seen);
    Some(SurfaceHit {
        object: object.name.clone(),
        material: scene.materials.get(material as usize)?.name.clone(),
        point_m,
        layers: names
            .filter(|(_, seen)| *seen)
            .map(|(layer, _)| layers::title(layer).to_owned())
            .collect(),
    })
}

/// Pixels from the upper left corner; none behind the pinhole.
fn on_picture(camera: &CameraFrame, point_m: DVec3) -> Option<DVec2> {
    let from_eye = point_m - camera.position_m;
    let depth_m = from_eye.dot(camera.forward);
    let [x, y] = [camera.per_px_x, camera.per_px_y]
        .map(|axis| from_eye.dot(axis) / (axis.length_squared() * depth_m));
    (depth_m > 0.0).then(|| 0.5 * camera.size_px + DVec2::new(x, y))
}

/// Distance of a point from a line segment.
fn distance(point: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share = (point - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    point.distance(a + along * share.clamp(0.0, 1.0))
}
