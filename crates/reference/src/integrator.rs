//! A scene made ready to be integrated, and how.

use crate::reflectance::Reflectance;
use hairline_cpu::sampling::environment::EnvironmentSampler;
use hairline_cpu::sampling::lights::AreaLights;
use hairline_index::{Groove, ScratchIndex, SegmentTree, TriangleIndex, groove_index};
use hairline_optics::groove_spectrum::GrooveSpectrum;
use hairline_optics::mask::Mask;
use hairline_optics::section::GrooveShape;
use hairline_scene::{CameraFrame, Object, Scene, ScratchTables};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Model of the waves at a scratch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Model {
    /// Equations (4) to (9) of docs/model.md at a point: the model of the closed forms, integrated by chance.
    #[default]
    Separable,
    /// |B - S|^2 with all phases, equation (1): interference between scratches and with the base, the path of oblique light.
    Full,
}

/// Settings of the integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Settings {
    /// Model of the waves at a scratch.
    pub model: Model,
    /// Energy that the base loses to the scratches; [`Model::Full`] has it from the field.
    pub mask: Mask,
    /// Largest number of surfaces on a path after the first. 0: direct light, as the closed form.
    pub bounces: u32,
    /// Whether objects hide the lights and the environment from one another. The closed form has no shadows.
    pub shadows: bool,
    /// Seed of the samples.
    pub seed: u64,
}

/// Look-up structures for a scene's surfaces, scratches and materials. A clone shares them.
#[derive(Clone)]
pub struct SceneIndex {
    /// Triangles along a ray.
    pub triangles: Arc<TriangleIndex>,
    /// Tree over the grooves of the scratches, in full detail.
    pub grooves: Arc<SegmentTree<Groove>>,
    /// Spectrum of each of the scene's shapes of grooves; none for narrow rectangles.
    spectra: Arc<Vec<Option<GrooveSpectrum>>>,
    /// Width of the widest scratch of each object.
    widest_um: Arc<Vec<f64>>,
    /// Optical properties of the materials.
    pub tables: Arc<ScratchTables>,
    /// One for each material.
    reflectances: Arc<Vec<Reflectance>>,
    /// Reflectances of coats.
    coats: Arc<Vec<Option<Reflectance>>>,
    depth_coherence: Arc<Vec<f32>>,
}

impl SceneIndex {
    /// Builds the trees and the tables.
    pub fn new(scene: &Scene) -> Self {
        let (triangles, (grooves, tables)) = rayon::join(
            || TriangleIndex::build(scene),
            || rayon::join(|| groove_index::build(scene), || ScratchTables::new(scene)),
        );
        Self::from_parts(scene, triangles.into(), grooves.into(), tables.into())
    }

    /// Takes trees and tables of a scene that are there already.
    pub fn from_parts(
        scene: &Scene,
        triangles: Arc<TriangleIndex>,
        grooves: Arc<SegmentTree<Groove>>,
        tables: Arc<ScratchTables>,
    ) -> Self {
        let reflectances: Vec<_> = (scene.materials.par_iter())
            .map(|material| Reflectance::new(&scene.observer, material))
            .collect();
        let coats: Vec<_> = scene
            .materials
            .par_iter()
            .map(Reflectance::of_coat)
            .collect();
        Self {
            spectra: (tables.shapes.shapes())
                .map(|shape| (shape != GrooveShape::default()).then(|| GrooveSpectrum::new(&shape)))
                .collect::<Vec<_>>()
                .into(),
            widest_um: (scene.objects.iter().map(widest_um))
                .collect::<Vec<_>>()
                .into(),
            triangles,
            grooves,
            tables,
            reflectances: reflectances.into(),
            coats: coats.into(),
            depth_coherence: ScratchIndex::depth_coherence(scene).into(),
        }
    }

    /// Whether the index of one scene serves another: its surfaces, scratches, gratings and materials are shared ones.
    pub fn are_alike(a: &Scene, b: &Scene) -> bool {
        let alike = |a: &Object, b: &Object| {
            Arc::ptr_eq(&a.mesh, &b.mesh)
                && Arc::ptr_eq(&a.scratches, &b.scratches)
                && Arc::ptr_eq(&a.segments, &b.segments)
                && a.gratings == b.gratings
                && a.is_lamp == b.is_lamp
        };
        Arc::ptr_eq(&a.textures, &b.textures)
            && a.materials == b.materials
            && a.observer == b.observer
            && a.objects.len() == b.objects.len()
            && a.objects.iter().zip(&b.objects).all(|(a, b)| alike(a, b))
    }
}

fn widest_um(object: &Object) -> f64 {
    let widths = object.scratches.iter().map(|it| it.profile.width_um);
    widths.fold(0.0, f32::max).into()
}

/// A scene made ready.
pub struct Integrator<'a> {
    pub(super) scene: &'a Scene,
    pub(super) settings: Settings,
    /// Rows of the picture.
    pub(super) rows: Range<u32>,
    pub(super) triangles: Arc<TriangleIndex>,
    pub(super) grooves: Arc<SegmentTree<Groove>>,
    /// Spectrum of each shape of grooves; none for narrow rectangles.
    pub(super) spectra: Arc<Vec<Option<GrooveSpectrum>>>,
    pub(super) widest_um: Arc<Vec<f64>>,
    pub(super) depth_coherence: Arc<Vec<f32>>,
    pub(super) tables: Arc<ScratchTables>,
    /// One for each material.
    pub(super) reflectances: Arc<Vec<Reflectance>>,
    /// Reflectances of coats.
    pub(super) coats: Arc<Vec<Option<Reflectance>>>,
    pub(super) lights: AreaLights,
    pub(super) environment: Option<EnvironmentSampler>,
    pub(super) camera: CameraFrame,
    /// Largest distance of the scene from the origin; rounding errors grow with it.
    pub(super) extent_m: f64,
}

impl<'a> Integrator<'a> {
    /// Builds the trees and the tables.
    pub fn new(scene: &'a Scene, settings: Settings) -> Self {
        Self::from_parts(scene, settings, SceneIndex::new(scene))
    }

    /// Takes trees and tables that were built before, of `scene` or of one with the same surfaces, scratches and materials.
    pub fn from_parts(scene: &'a Scene, settings: Settings, parts: SceneIndex) -> Self {
        let SceneIndex {
            triangles,
            grooves,
            spectra,
            widest_um,
            tables,
            reflectances,
            coats,
            depth_coherence,
        } = parts;
        let positions = scene.objects.iter().flat_map(|o| &o.mesh.positions_m);
        Self {
            scene,
            settings,
            rows: 0..scene.render.size_px[1],
            triangles,
            grooves,
            spectra,
            widest_um,
            depth_coherence,
            tables,
            reflectances,
            coats,
            lights: AreaLights::new(scene),
            environment: scene.environment.as_ref().map(EnvironmentSampler::new),
            camera: scene.camera.frame(scene.render.size_px),
            extent_m: positions.map(|p| p.length() as f64).fold(0.0, f64::max),
        }
    }

    /// Some rows of the picture alone, which become an image of their own: the same samples as in the whole.
    pub fn of_rows(mut self, rows: Range<u32>) -> Self {
        let height = self.scene.render.size_px[1];
        self.rows = rows.start.min(height)..rows.end.min(height);
        self
    }

    pub(super) fn size_px(&self) -> [u32; 2] {
        [self.scene.render.size_px[0], self.rows.len() as u32]
    }
}
