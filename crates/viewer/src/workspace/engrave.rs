//! Letters and drawings that are engraved where the view sees the selected object.

use std::path::Path;

use glam::DVec3;
use hairline_editor::pen::{self, EngravingPlace};

use super::Workspace;

impl Workspace {
    /// Engraves a text on the selected object, else on the first one.
    pub fn engrave_text(&mut self) {
        let place = self.engraving_place();
        self.apply("Engrave a text", |d, _| pen::add_text(d, &place));
    }

    /// As [`Self::engrave_text`], the outlines of an SVG file.
    pub fn engrave_drawing(&mut self, file: &Path) {
        let place = self.engraving_place();
        let base_dir = self.document.base_dir().to_owned();
        self.apply("Engrave a drawing", |d, _| {
            pen::add_drawing(d, &place, file, &base_dir)
        });
    }

    /// The place of the object that is seen before its middle.
    fn engraving_place(&self) -> EngravingPlace {
        let object = self.selected_object().unwrap_or(0);
        let (low_m, high_m) = self.bounds_m(Some(object));
        let middle_m = 0.5 * (low_m + high_m);
        let camera = self.camera();
        let eye_m = self.eye_m();
        let ray = (middle_m - eye_m).normalize_or(DVec3::NEG_Z);
        let built = self.renderer.built();
        let hit = built.and_then(|it| it.triangles.intersect(eye_m, ray));
        let seen = hit.filter(|hit| hit.object as usize == object);
        let forward = DVec3::from(camera.target_m) - eye_m;
        EngravingPlace {
            object,
            middle_m: seen.map_or(middle_m, |hit| eye_m + ray * hit.distance_m),
            right: forward.cross(camera.up.into()).normalize_or(DVec3::X),
            diagonal_m: low_m.distance(high_m),
        }
    }
}
