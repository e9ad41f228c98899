//! Presets that are given to an object, or to a part of it: by a click on their card, or by a drop of it.

use hairline_document::description::Scratches;
use hairline_editor::actions::{gratings, layers, materials};
use hairline_editor::presets::MaterialPreset;
use hairline_editor::wear;

use super::Workspace;
use crate::gallery::{StandIn, Thumb};
use crate::parts::ObjectPart;

impl Workspace {
    /// The stand-in for an object, or for the selected one, in small pictures.
    pub fn stand_in(&self, object: Option<usize>) -> StandIn {
        let (low_m, high_m) = self.bounds_m(object.or(self.selected_object()));
        let sides_m = high_m - low_m;
        let up = self.document.description().camera.world_up();
        StandIn::for_box(sides_m.to_array(), sides_m.dot(up).abs())
    }

    /// Gives a preset to a part of an object, as one step. Metals and layers lie on the part; other presets on all of the object.
    pub fn give(&mut self, preset: Thumb, object: usize, part: ObjectPart) {
        let diagonal_m = self.diagonal_m(Some(object));
        let Some(name) = self.document.description().objects.get(object) else {
            return;
        };
        let name = name.name.clone();
        match preset {
            Thumb::Material(preset, _) => {
                self.apply("Material", |d, _| match (preset, &part.material) {
                    (MaterialPreset::Metal(metal), Some(material)) => {
                        materials::make_metal(d, object, material, metal)
                    }
                    _ => materials::give(d, object, preset.material()),
                })
            }
            Thumb::Wear(grade, _) => {
                self.apply("Wear", |d, _| wear::set_wear(d, object, diagonal_m, grade));
            }
            Thumb::Layer(preset, _) => self.apply("Add scratches", |d, _| {
                let layer = Scratches {
                    material: part.material,
                    node: part.node,
                    ..preset.layer(name, diagonal_m)
                };
                layers::add(d, layer)
            }),
            Thumb::Grating(preset, _) => {
                self.apply("Add grating", |d, _| gratings::add(d, preset.grating(name)));
            }
            Thumb::Light(_) | Thumb::Shape(_) | Thumb::Map(_) => {}
        }
    }

    /// Words for what [`Self::give`] would change, in a preview of a drop.
    pub fn given_to(&self, preset: Thumb, object: usize, part: &ObjectPart) -> Option<String> {
        let object = self.document.description().objects.get(object)?;
        let given = preset.given_name()?;
        let of_part = match preset {
            Thumb::Material(MaterialPreset::Metal(_), _) => part.material.as_ref(),
            Thumb::Layer(..) => part.node.as_ref().or(part.material.as_ref()),
            _ => None,
        };
        let of_part = of_part.map_or(String::new(), |name| format!(", part {name}"));
        Some(format!("{given} onto {}{of_part}", object.name))
    }
}
