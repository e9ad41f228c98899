//! The user's own presets: made of what is selected, and given to the scene.

use hairline_document::Description;
use hairline_document::description::{Layer, Material, Scratches};
use hairline_editor::Selection;
use hairline_editor::actions::{layers, lights, materials};
use hairline_editor::document::rebased;
use hairline_editor::own_presets::PresetError;

use super::Workspace;

impl Workspace {
    /// Name of the selected part, where a preset can be made of it. A layer that was drawn or listed lies where it lies.
    pub fn preset_name(&self) -> Option<String> {
        let description = self.document.description();
        match self.selection() {
            Selection::Layer(i) => {
                let layer = description.scratches.get(i)?;
                matches!(layer.layer, Layer::Laid(_)).then(|| layers::title(layer).to_owned())
            }
            Selection::Material(i) => Some(description.materials.get(i)?.name.clone()),
            Selection::Light(i) => Some(lights::title(description.lights.get(i)?).to_owned()),
            _ => None,
        }
    }

    /// Keeps the selected part as a preset; of a light, on request, all lights of the scene.
    pub fn save_preset(&mut self, name: &str, all_lights: bool) -> Result<(), PresetError> {
        let scene = self.document.description();
        let mut parts = Description {
            materials: Vec::new(),
            scratches: Vec::new(),
            lights: Vec::new(),
            ..Description::clone(scene)
        };
        match self.selection() {
            Selection::Layer(i) => parts.scratches.extend(scene.scratches.get(i).cloned()),
            Selection::Material(i) => parts.materials.extend(scene.materials.get(i).cloned()),
            Selection::Light(_) if all_lights => parts.lights.clone_from(&scene.lights),
            Selection::Light(i) => parts.lights.extend(scene.lights.get(i).cloned()),
            _ => {}
        }
        for layer in &mut parts.scratches {
            layer.strokes.clear();
            (layer.hidden, layer.solo) = (false, false);
        }
        let parts = match self.own_presets.folder() {
            Some(folder) => rebased(&parts, self.document.base_dir(), folder),
            None => parts,
        };
        self.own_presets.save(name, parts)
    }

    /// Deletes a preset, or tells why it could not.
    pub fn delete_preset(&mut self, name: &str) {
        match self.own_presets.delete(name) {
            Ok(()) => self.notices.clear("presets"),
            Err(error) => self.notices.error("presets", error.to_string()),
        }
    }

    /// The parts of a preset, as this document writes them.
    fn preset(&self, index: usize) -> Option<Description> {
        let parts = &self.own_presets.list().get(index)?.parts;
        Some(match self.own_presets.folder() {
            Some(folder) => self.document.brought_here(parts, folder),
            None => parts.clone(),
        })
    }

    /// Lays a preset's scratches on all of an object.
    pub fn give_own_layers(&mut self, index: usize, object: usize) {
        let Some(parts) = self.preset(index) else {
            return;
        };
        let of_preset = self.own_presets.list()[index].name.clone();
        let of_preset = Some(of_preset).filter(|_| parts.scratches.len() == 1);
        self.apply("Add scratches", |d, mut selection| {
            let name = d.objects.get(object).map(|object| object.name.clone());
            for layer in parts.scratches {
                let layer = Scratches {
                    object: name.clone().unwrap_or_default(),
                    name: of_preset.clone().or(layer.name),
                    material: None,
                    node: None,
                    ..layer
                };
                selection = layers::add(d, layer)?;
            }
            Ok(selection)
        });
    }

    /// Material of a preset.
    pub fn own_material(&self, index: usize) -> Option<Material> {
        self.preset(index)?.materials.into_iter().next()
    }

    /// Adds the lights of a preset.
    pub fn add_own_lights(&mut self, index: usize) {
        let Some(parts) = self.preset(index) else {
            return;
        };
        self.apply("Add lights", |d, mut selection| {
            for light in parts.lights {
                selection = lights::add(d, light);
            }
            Ok(selection)
        });
    }

    /// Makes an object of a material.
    pub fn make_of(&mut self, object: usize, material: Material) {
        self.apply("Material", |d, _| materials::give(d, object, material));
    }
}
