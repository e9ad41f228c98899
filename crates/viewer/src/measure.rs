//! Measuring in the picture: the scratch that was clicked on, and a distance along a surface.

use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use hairline_editor::quantity::Unit;
use hairline_laying::Ruler;
use hairline_scene::{Mesh, Object, Scratch};

use crate::jobs::Job;
use crate::platform::HAS_THREADS;
use crate::progressive::Built;

/// Measured things; no part of the scene.
#[derive(Default)]
pub(crate) struct Measure {
    pub picked: Option<PickedScratch>,
    pub span: SpanRuler,
    /// Whether the list of the selected layer's scratches is open.
    pub has_list: bool,
    /// The list is to show the picked scratch.
    pub reveals: bool,
}

impl Measure {
    /// Forgets what was measured; whether there was anything.
    pub fn clear(&mut self) -> bool {
        let was_measured = self.picked.is_some() || self.span.wanted.is_some();
        self.picked = None;
        self.span = SpanRuler::default();
        was_measured
    }
}

/// A scratch of the newest scene.
#[derive(Clone)]
pub(crate) struct PickedScratch {
    /// Index of its object.
    object: usize,
    /// Scratches of the object when it was picked.
    scratches: Arc<Vec<Scratch>>,
    /// Index in these.
    index: usize,
}

impl PickedScratch {
    pub fn new(built: &Built, object: usize, index: usize) -> Option<Self> {
        Some(Self {
            object,
            scratches: Arc::clone(&built.scene.objects.get(object)?.scratches),
            index,
        })
    }

    /// The object and the scratch; none once scratches of the object were laid anew.
    pub fn find<'a>(&self, built: &'a Built) -> Option<(&'a Object, &'a Scratch)> {
        let object = built.scene.objects.get(self.object)?;
        let is_same = Arc::ptr_eq(&object.scratches, &self.scratches);
        is_same.then_some((object, object.scratches.get(self.index)?))
    }

    /// Index of its layer.
    pub fn layer(&self) -> usize {
        self.scratches[self.index].layer as usize
    }

    /// Number in its layer, from 0, as files of lists count.
    pub fn number(&self) -> usize {
        let layer = self.scratches[self.index].layer;
        self.index - self.scratches.partition_point(|it| it.layer < layer)
    }
}

/// Measures of a scratch, as texts.
pub(crate) struct ScratchTexts {
    pub width: String,
    pub depth: String,
    pub length: String,
    /// From its first end to its last one, in world space.
    pub direction: String,
    /// Its middle, in world space.
    pub place: String,
}

impl ScratchTexts {
    pub fn new(object: &Object, scratch: &Scratch) -> Self {
        let pieces = object.pieces(scratch);
        let [width_um, depth_nm] = [scratch.profile.width_um, scratch.profile.depth_nm];
        let middle = &pieces[pieces.len() / 2];
        let chord = pieces[pieces.len() - 1].end_m - pieces[0].start_m;
        let direction = match scratch.closed {
            true => "a ring".to_owned(),
            false => {
                let [x, y, z] = chord.normalize_or_zero().to_array();
                format!("{x:+.3}  {y:+.3}  {z:+.3}")
            }
        };
        let [x, y, z] = (0.5e3 * (middle.start_m + middle.end_m)).to_array();
        Self {
            width: text(Unit::Micrometre, width_um.into()),
            depth: text(Unit::Nanometre, depth_nm.into()),
            length: length(object.length_m(scratch).into()),
            direction,
            place: format!("{x:.2}  {y:.2}  {z:.2} mm"),
        }
    }
}

/// A length in metres, in the unit that reads best.
pub(crate) fn length(length_m: f64) -> String {
    text(Unit::Metre, length_m)
}

fn text(unit: Unit, value: f64) -> String {
    unit.shown(value).text(value)
}

/// A place on the surface of an object.
#[derive(Clone)]
pub(crate) struct SurfacePoint {
    pub mesh: Arc<Mesh>,
    pub triangle: usize,
    /// World space.
    pub point_m: DVec3,
}

/// A distance between two places.
#[derive(Clone)]
pub(crate) struct Span {
    pub ends_m: [DVec3; 2],
    /// Whether both ends are on one object.
    pub is_on_one: bool,
    /// The bends of the path on the surface between them; none where there is none.
    pub path_m: Option<Vec<DVec3>>,
}

impl Span {
    pub fn straight_m(&self) -> f64 {
        self.ends_m[0].distance(self.ends_m[1])
    }

    /// Length of the path on the surface.
    pub fn along_m(&self) -> Option<f64> {
        let path_m = self.path_m.as_ref()?;
        Some(path_m.array_windows().map(|[a, b]| a.distance(*b)).sum())
    }
}

/// A ruler that follows the pointer. A large mesh takes long to be made ready, so ways are found beside the interface, one at a time.
#[derive(Default)]
pub(crate) struct SpanRuler {
    /// Ends of the span.
    wanted: Option<[SurfacePoint; 2]>,
    asked_m: Option<[DVec3; 2]>,
    ruler: Arc<Mutex<Option<Ruler>>>,
    found: Arc<Mutex<Option<Span>>>,
    job: Option<Job>,
}

impl SpanRuler {
    /// Begins a span.
    pub fn begin(&mut self, from: SurfacePoint) {
        self.wanted = Some([from.clone(), from]);
        self.asked_m = None;
        *self.found.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Ends the span at a place.
    pub fn stretch(&mut self, to: SurfacePoint) {
        if let Some([_, end]) = &mut self.wanted {
            *end = to;
        }
    }

    /// The newest span that was measured.
    pub fn found(&self) -> Option<Span> {
        let found = self.found.lock();
        found.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Looks for the path that is wanted.
    pub fn follow(&mut self, ctx: &egui::Context) {
        let Some(ends) = &self.wanted else {
            return;
        };
        let ends_m = ends.each_ref().map(|end| end.point_m);
        let is_busy = self.job.as_ref().is_some_and(|job| !job.is_over());
        if is_busy || self.asked_m == Some(ends_m) || ends_m[0] == ends_m[1] {
            return;
        }
        self.asked_m = Some(ends_m);
        let (ends, wake) = (ends.clone(), ctx.clone());
        let (ruler, found) = (Arc::clone(&self.ruler), Arc::clone(&self.found));
        let work = move || {
            let is_on_one = Arc::ptr_eq(&ends[0].mesh, &ends[1].mesh);
            let path_m = path_m(
                &ends,
                &mut ruler.lock().unwrap_or_else(PoisonError::into_inner),
            );
            *found.lock().unwrap_or_else(PoisonError::into_inner) = Some(Span {
                ends_m,
                is_on_one,
                path_m,
            });
            wake.request_repaint();
        };
        match HAS_THREADS {
            // Without a thread there is no distance; the picture is there all the same.
            true => self.job = Job::start("ruler", move |_| work()).ok(),
            false => work(),
        }
    }
}

fn path_m([from, to]: &[SurfacePoint; 2], kept: &mut Option<Ruler>) -> Option<Vec<DVec3>> {
    if !Arc::ptr_eq(&from.mesh, &to.mesh) {
        return None;
    }
    if !kept
        .as_ref()
        .is_some_and(|it| Arc::ptr_eq(it.mesh(), &from.mesh))
    {
        *kept = Some(Ruler::new(Arc::clone(&from.mesh)));
    }
    kept.as_ref()?
        .path_m(from.triangle, from.point_m, to.point_m)
}
