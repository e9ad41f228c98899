//! The validated scene in canonical units, which every renderer reads. Positions are world space, metres; scratches keep the units of the physics
//! (width in micrometres, depth in nanometres).
//!
//! A [`Scene`] holds no choice and no default: whatever a scene file left out was filled in, and whatever was wrong
//! was refused, before one of these exists.

use glam::{DVec2, DVec3, Vec3};
use hairline_image::{Batches, Display};
use hairline_optics::scratch::DEPTH_MAX_NM;
use hairline_optics::section::Section;
use hairline_optics::spectrum::Observer;
use std::ops::Range;
use std::sync::Arc;

use crate::environment::Environment;
use crate::grating::Grating;
use crate::kept_tables::KeptTables;

pub use crate::light::{Cone, Doors, Light, LightShape};
pub use hairline_model::material::*;
pub use hairline_model::mesh::{Mesh, NodeTriangles};
pub use hairline_model::texture::{Sampling, Texture, Wrap};

/// The ways that light may take besides the direct one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transport {
    /// Whether objects hide lights and the environment from one another.
    pub shadows: bool,
    /// Largest number of other objects on a path of light; only with shadows.
    pub bounces: u32,
}

impl Transport {
    /// No other way: the closed forms alone.
    pub const DIRECT: Self = Self {
        shadows: false,
        bounces: 0,
    };

    /// Batches that make up a picture of `samples` samples. None where a picture has all of its samples at once.
    pub fn batches(self, camera: &Camera, samples: u32) -> Option<Batches> {
        match (camera.has_lens(), self.shadows) {
            (true, _) => Some(Batches::new(samples.max(LENS_SAMPLES))),
            (false, true) => Some(Batches::of_rounds(samples)),
            (false, false) => None,
        }
    }
}

/// Least number of samples with a lens: fewer points of it would be seen one by one.
const LENS_SAMPLES: u32 = 64;

/// Everything that a picture depends on.
///
/// What is large lies behind an [`Arc`], so a clone costs microseconds: an editor clones a scene, changes what is small (a
/// light, the camera, a material) and hands it on, and who has seen the scene before tells by [`Arc::ptr_eq`] what is still
/// the same. [`Arc::make_mut`] changes what is large.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The view.
    pub camera: Camera,
    /// Sampling and display of the picture.
    pub render: RenderSettings,
    /// Light from all around, if there is any.
    pub environment: Option<Environment>,
    /// Images that materials refer to.
    pub textures: Arc<Vec<Texture>>,
    /// Materials that the triangles of the objects refer to.
    pub materials: Vec<Material>,
    /// What the channels of pictures are: colours, or bands of the spectrum.
    pub observer: Observer,
    /// Objects in world space.
    pub objects: Vec<Object>,
    /// A ground that is seen by the shadows on it alone: no renderer sees it, and pictures get its shadows as alpha.
    pub shadow_catcher: Option<Object>,
    /// Area lights, without those of the environment: see [`Scene::all_lights`].
    pub lights: Vec<Light>,
    /// Notes on the scene file and its models for the author, a line each: a key that has no effect any more, a part of a model that is not shown.
    pub notes: Vec<String>,
    /// Tables that were computed for this scene and for others of its builder.
    pub tables: Arc<KeptTables>,
}

impl Scene {
    /// The area lights, then the environment's [suns](Environment::suns): all that shine besides the environment itself.
    pub fn all_lights(&self) -> impl Iterator<Item = &Light> + Clone {
        let suns = self.environment.iter().flat_map(Environment::suns);
        self.lights.iter().chain(suns)
    }

    /// How its pictures are shown.
    pub fn display(&self) -> Display {
        Display {
            exposure_ev: self.camera.exposure_ev,
            tone_map: self.render.tone_map,
        }
    }

    /// Returns the scene with nothing to be seen behind its surfaces: its environment shines, and the camera does not see it.
    #[must_use]
    pub fn before_nothing(&self) -> Self {
        let mut scene = self.clone();
        let environment = scene.environment.take();
        scene.environment = environment.map(|it| it.with_visible(false));
        scene
    }
}

/// A camera: a pinhole, or a thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole, or the middle of the lens, world space.
    pub position_m: DVec3,
    /// The point in the centre of the picture without a shift, world space.
    pub target_m: DVec3,
    /// The direction that is up in the picture; need not be perpendicular to the view.
    pub up: DVec3,
    /// The picture's vertical field of view.
    pub fov_y_rad: f64,
    /// How far the picture's centre is off the target, to the right and up, at unit depth.
    pub shift_tan: DVec2,
    /// Exposure: radiances are multiplied by 2^exposure_ev before the tone map.
    pub exposure_ev: f64,
    /// Lens of the camera.
    pub lens: Lens,
}

/// A thin lens, across the view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lens {
    /// Radius of the lens's opening. Without one the camera is a pinhole: everything is in focus.
    pub radius_m: f64,
    /// Depth of focus along the view.
    pub focus_m: f64,
}

/// Sampling and display of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Standard deviation of the pixel's Gaussian filter (docs/model.md, section 6).
    pub filter_std_px: f64,
    /// The curve from linear radiance to the display.
    pub tone_map: hairline_image::ToneMap,
}

/// A surface, with the scratches and gratings that lie on it.
#[derive(Clone, Debug)]
pub struct Object {
    /// The name in the scene file.
    pub name: String,
    /// The surface.
    pub mesh: Arc<Mesh>,
    /// Scratches, each a run of `segments`.
    pub scratches: Arc<Vec<Scratch>>,
    /// Straight pieces, one triangle each, those of one scratch side by side in the order of its walk.
    pub segments: Arc<Vec<Segment>>,
    /// Parts of the object that its file names; none of a shape.
    pub parts: Arc<Vec<NodeTriangles>>,
    /// Grooves that are finer than a pixel.
    pub gratings: Vec<Grating>,
    /// Whether it is the shape of a light that the camera sees: black but for its emission, met by no ray but the camera's, and by that on its
    /// front alone. Such objects are the last of a scene.
    pub is_lamp: bool,
}

impl Object {
    /// The straight pieces of one of its scratches.
    pub fn pieces(&self, scratch: &Scratch) -> &[Segment] {
        &self.segments[scratch.segments.start as usize..scratch.segments.end as usize]
    }

    /// Indices of the scratches of a layer, which lie side by side.
    pub fn of_layer(&self, layer: u32) -> Range<usize> {
        let first = self.scratches.partition_point(|it| it.layer < layer);
        let end = self.scratches.partition_point(|it| it.layer <= layer);
        first..end
    }

    /// Length of a scratch.
    pub fn length_m(&self, scratch: &Scratch) -> f32 {
        let pieces = self.pieces(scratch).iter();
        pieces.map(|p| p.start_m.distance(p.end_m)).sum()
    }

    /// The area of a scratch: its width in micrometres times its length in metres.
    pub fn covered_um_m(&self, scratch: &Scratch) -> f32 {
        scratch.profile.width_um * self.length_m(scratch)
    }
}

/// The cross section of a groove. It travels whole, from the layer that draws it to what shades it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    /// Width of the opening, with the shoulders beside it.
    pub width_um: f32,
    /// Depth of the deepest place.
    pub depth_nm: f32,
    /// Shape of the cross section.
    pub section: Section,
}

impl Profile {
    /// Least and greatest width: the spectral table's, and below the coherence windows of scenes.
    pub const WIDTHS_UM: (f64, f64) = (0.05, 100.0);
    /// Least and greatest depth: the spectral table's.
    pub const DEPTHS_NM: (f64, f64) = (0.0, DEPTH_MAX_NM);
}

/// One scratch: one groove, one wave. Where two of its segments meet, the end is joined; its own two ends are free,
/// unless it is closed to a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct Scratch {
    /// Profile of its groove.
    pub profile: Profile,
    /// Index of the `[[scratches]]` table of the scene file that laid it, from 0.
    pub layer: u32,
    /// Whether the last segment's end is joined to the first one's start.
    pub closed: bool,
    /// Range of its segments in [`Object::segments`].
    pub segments: Range<u32>,
}

/// A straight piece of a scratch within one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// World space, metres.
    pub start_m: Vec3,
    /// World space, metres.
    pub end_m: Vec3,
    /// Unit shading normal of the surface at the middle: tells the two sides of a thin sheet apart.
    pub normal: Vec3,
    /// Index in [`Mesh::triangles`] of the segment's triangle.
    pub triangle: u32,
}
