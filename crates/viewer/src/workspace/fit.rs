//! Settings that fit the objects and the view: the camera that shows them, and the brush.

use std::sync::Arc;

use glam::DVec3;
use hairline_document::navigate;
use hairline_document::{Description, probe};
use hairline_editor::Selection;
use hairline_editor::actions::materials;
use hairline_editor::brush::BrushSettings;
use hairline_image::shown::{LITTLE, Shown};

use super::Workspace;

/// The step's name in the history.
const LAMPS: &str = "Light for the scratches";

/// Bounds of things that are assumed before the scene is built.
const UNKNOWN_M: (DVec3, DVec3) = (DVec3::splat(-0.1), DVec3::splat(0.1));

impl Workspace {
    pub fn scale_brush(&mut self, factor: f64) {
        let mut brush = self.brush();
        brush.radius_m = (brush.radius_m * factor).clamp(1e-5, 10.0);
        self.toolbox.brush = Some(brush);
    }

    /// Brush with the settings made by hand, or else fitted to the object that it was over last, or to the selected object
    /// in the middle of the view.
    pub fn brush(&self) -> BrushSettings {
        let fitted = || {
            let camera = self.camera();
            self.fitting_brush(self.selected_object(), camera.target_m.into())
        };
        self.toolbox
            .brush
            .or(self.toolbox.fitted.as_ref().map(|(.., brush)| *brush))
            .unwrap_or_else(fitted)
    }

    pub fn selected_object(&self) -> Option<usize> {
        self.selection().object(self.document.description())
    }

    /// Brush that fits a place on an object, as seen in the view.
    pub fn fitting_brush(&self, object: Option<usize>, point_m: DVec3) -> BrushSettings {
        let height_m = navigate::view_height_m(&self.camera(), point_m);
        BrushSettings::for_view(height_m, self.diagonal_m(object))
    }

    pub fn frame_selection(&mut self) {
        self.frame(Some(self.selection()));
    }

    /// Brings a part, or all, into the picture.
    pub fn frame(&mut self, part: Option<Selection>) {
        let description = self.document.description();
        let is_sun = |i: usize| {
            let light = description.lights.get(i);
            light.is_some_and(|light| light.kind.sunbeam().is_some())
        };
        // A sun stands nowhere: all that it shines on is framed.
        let part = part.filter(|part| !matches!(part, Selection::Light(i) if is_sun(*i)));
        let points_m = match part {
            Some(Selection::Light(i)) => {
                let Some(light) = description.lights.get(i) else {
                    return;
                };
                let center = hairline_document::place_light::center(light);
                let reach = DVec3::splat(0.25 * self.diagonal_m(None));
                navigate::corners(center - reach, center + reach).to_vec()
            }
            Some(Selection::Material(i)) => self.points_of(&materials::users(description, i)),
            _ => {
                let object = part.and_then(|part| part.object(description));
                self.points_of(object.as_slice())
            }
        };
        let [width, height] = description.render.size_px;
        let aspect = f64::from(width) / f64::from(height.max(1));
        self.move_view("Frame", None, |camera| {
            navigate::frame_points(camera, &points_m, aspect);
        });
    }

    /// Extreme points of some objects; of all that the scene is about where they have nothing. As it was built last.
    fn points_of(&self, objects: &[usize]) -> Vec<DVec3> {
        let Some(built) = self.renderer.built() else {
            return navigate::corners(UNKNOWN_M.0, UNKNOWN_M.1).to_vec();
        };
        if let Some((low_m, high_m)) = self.empty_bounds_m() {
            return navigate::corners(low_m, high_m).to_vec();
        }
        let of = |objects: &[usize]| -> Vec<DVec3> {
            let objects = objects.iter().filter_map(|i| built.scene.objects.get(*i));
            let points = objects.flat_map(|object| object.mesh.extreme_points_m());
            points.map(|point| point.as_dvec3()).collect()
        };
        let own = of(objects);
        match own.is_empty() {
            true => of(&self.subject()),
            false => own,
        }
    }

    /// Whether a built object, by its index, is part of the scene's subject.
    pub fn is_of_subject(&self, object: usize) -> bool {
        self.subject().contains(&object)
    }

    /// The objects that the scene is about.
    fn subject(&self) -> Vec<usize> {
        let description = self.document.description();
        if description.objects.is_empty() {
            return Vec::new();
        }
        hairline_document::subject::objects(description, &self.boxes_m())
    }

    /// The box around an object, or around all that the scene is about, in metres: as it was built last.
    pub fn bounds_m(&self, object: Option<usize>) -> (DVec3, DVec3) {
        let own = object.and_then(|object| self.bounds_of(|i| i == object));
        own.or_else(|| {
            let subject = self.subject();
            self.bounds_of(|i| subject.contains(&i))
        })
        .or_else(|| self.empty_bounds_m())
        .unwrap_or(UNKNOWN_M)
    }

    /// The box in the place of objects, where there are none.
    fn empty_bounds_m(&self) -> Option<(DVec3, DVec3)> {
        let description = self.document.description();
        let is_empty = description.objects.is_empty();
        is_empty.then(|| probe::empty_bounds_m(description))
    }

    /// The box around each object that the scene is about.
    pub fn there_m(&self) -> Vec<(DVec3, DVec3)> {
        let subject = self.subject().into_iter();
        subject
            .filter_map(|own| self.bounds_of(|i| i == own))
            .collect()
    }

    /// The box around all objects, where they are built as they are described.
    pub fn built_bounds_m(&self) -> Option<(DVec3, DVec3)> {
        let objects = &self.document.description().objects;
        let built = self.renderer.built()?;
        let is_built = built.description.objects == *objects;
        let bounds_m = is_built.then(|| self.bounds_of(|i| i < objects.len()))?;
        bounds_m.or_else(|| self.empty_bounds_m())
    }

    /// Replaces the scene's lights by lights that show its scratches.
    pub fn light_for_scratches(&mut self) {
        let built = self.renderer.built();
        let before = self.shown();
        match (built, self.built_bounds_m()) {
            (Some(built), Some(_)) => {
                self.apply(LAMPS, |d, selection| {
                    d.light_for_scratches(&built.scene);
                    // Lights that were selected are gone.
                    Ok(match selection {
                        Selection::Light(_) | Selection::Studio => Selection::None,
                        other => other,
                    })
                });
                self.reading.tried = Some((Arc::clone(self.document.description()), before));
            }
            _ => (self.notices).note(
                "light",
                "Lights are placed by the shapes: wait until the picture shows them.",
            ),
        }
    }

    /// What the newest picture shows of its scratches, if it is a whole one: a coarse one has others.
    pub fn shown(&self) -> Option<Shown> {
        let frame = self
            .renderer
            .latest()
            .filter(|frame| frame.has_all_scratches());
        frame?.findings.shown
    }

    /// Makes lamps for scratches as bright as shows most of these, once a picture tells, and says what they show.
    pub fn try_lamps(&mut self) {
        let Some((tried, before)) = &self.reading.tried else {
            return;
        };
        let before = *before;
        let now = self.document.description();
        if now.lights != tried.lights || now.scratches != tried.scratches {
            self.reading.tried = None;
            return;
        }
        let frame = self.renderer.latest().filter(|frame| {
            frame.has_all_scratches() && frame.built.description.lights == tried.lights
        });
        let Some((mut stops, shown)) = frame.and_then(|frame| frame.findings.best_lamps) else {
            return;
        };
        self.reading.tried = None;
        if self.document.undo_label() != Some(LAMPS) {
            stops = 0;
        }
        if stops != 0 {
            // The same step with other lamps.
            let lit = Arc::clone(self.document.description());
            self.document.undo();
            self.apply(LAMPS, |d, selection| {
                *d = Description::clone(&lit);
                for light in &mut d.lights {
                    light.radiance *= 2.0_f64.powi(stops);
                }
                Ok(selection)
            });
        }
        self.notices.note("light", lamps_text(stops, shown, before));
    }

    /// Height of their lowest point along the vertical.
    pub fn lowest_m(&self) -> Option<f64> {
        let up = self.document.description().camera.world_up();
        let (a, b) = self.built_bounds_m()?;
        Some(a.dot(up).min(b.dot(up)))
    }

    /// The box around some objects.
    fn bounds_of(&self, is_one: impl Fn(usize) -> bool) -> Option<(DVec3, DVec3)> {
        let boxes = self.boxes_m().into_iter().enumerate();
        // A hidden object has no box.
        let boxes = boxes.filter(|(_, (low_m, high_m))| low_m.cmple(*high_m).all());
        boxes
            .filter_map(|(i, one)| is_one(i).then_some(one))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// Bounds of each object.
    fn boxes_m(&self) -> Vec<(DVec3, DVec3)> {
        let Some(built) = self.renderer.built() else {
            return Vec::new();
        };
        let objects = built.scene.objects.iter();
        objects
            .map(|object| object.mesh.bounds_m())
            .map(|(low, high)| (low.as_dvec3(), high.as_dvec3()))
            .collect()
    }

    /// The diagonal of that box.
    pub fn diagonal_m(&self, object: Option<usize>) -> f64 {
        let (low_m, high_m) = self.bounds_m(object);
        low_m.distance(high_m)
    }
}

/// What became of lamps for scratches that were made brighter by so many stops, in a line.
fn lamps_text(stops: i32, shown: Shown, before: Option<Shown>) -> String {
    let percent = |share: f32| format!("{:.0} %", 100.0 * share);
    let mut text = match shown.noticed < LITTLE {
        true => format!("The {}", shown.little()),
        false => format!(
            "Light for the scratches shows {} of them; {} of where they lie is white.",
            percent(shown.noticed),
            percent(shown.white)
        ),
    };
    match stops {
        0 => {}
        1.. => text += &format!(" The lamps are {} times as bright as at first.", 1 << stops),
        ..0 => text += &format!(" The lamps are 1/{} as bright as at first.", 1 << -stops),
    }
    if let Some(before) = before
        && before.noticed > shown.noticed
    {
        let better = percent(before.noticed);
        text += &format!(" The lights before showed {better}: undo brings them back.");
    }
    text
}
