//! The materials of a model's file, whose factors a scene may change.

use egui::{CollapsingHeader, Ui};
use hairline_document::description::{Object, Override};
use hairline_scene::{Base, Material};

use super::form::Form;
use super::material::metals;
use crate::parts;
use crate::workspace::Workspace;

/// Section of the overrides of the object with this index.
pub(super) fn section(ui: &mut Ui, work: &mut Workspace, index: usize) {
    let description = work.document.description().clone();
    let Some(object) = description.objects.get(index) else {
        return;
    };
    let names = parts::names(work, &object.name).materials;
    if names.is_empty() {
        return;
    }
    ui.add_space(8.0);
    ui.strong("Materials of its file");
    for name in names {
        let Some(made) = made(work, object, &name) else {
            continue;
        };
        CollapsingHeader::new(name.as_str())
            .id_salt(("override", &name))
            .show(ui, |ui| rows(ui, work, index, &name, &made));
    }
}

/// A material of the built scene.
fn made(work: &Workspace, object: &Object, name: &str) -> Option<Material> {
    let built = work.renderer.built()?;
    let scene = &built.scene;
    let own = scene.objects.iter().find(|it| it.name == object.name)?;
    let mut own = own.mesh.materials().into_iter();
    own.find_map(|number| {
        let material = scene.materials.get(number)?;
        (material.name == name).then(|| material.clone())
    })
}

fn rows(ui: &mut Ui, work: &mut Workspace, index: usize, name: &str, made: &Material) {
    let Base::MetallicRoughness {
        base_color: made_color,
        metallic: made_metallic,
    } = made.base
    else {
        return;
    };
    let overrides = &work.document.description().objects[index].overrides;
    let known = overrides.iter().find(|it| it.material == name).cloned();
    let mut own = known.clone().unwrap_or_else(|| Override::new(name));
    let mut form = Form::new(ui, ("override", index, name), work.diagonal_m(Some(index)));
    let as_in_file = std::iter::once((None, "as in the file".to_owned()));
    let metals = metals().map(|(metal, name)| (Some(metal), name));
    let metal_before = own.metal;
    form.choice(
        "Metal",
        "A measured metal in the place of the file's colour; its maps stay",
        as_in_file.chain(metals),
        &mut own.metal,
    );
    if own.metal != metal_before {
        (own.base_color, own.metallic) = (None, None);
    }
    let mut roughness = own.roughness.unwrap_or(made.roughness);
    let mut metallic = own.metallic.unwrap_or(made_metallic);
    let mut color = own.base_color.unwrap_or(made_color);
    let before = (roughness, metallic, color);
    form.number(Override::ROUGHNESS, &mut roughness);
    form.number(Override::METALLIC, &mut metallic);
    form.color(Override::BASE_COLOR, &mut color);
    if roughness != before.0 {
        own.roughness = Some(roughness);
    }
    if metallic != before.1 {
        own.metallic = Some(metallic);
    }
    if color != before.2 {
        if own.metal.take().is_some() {
            own.metallic = Some(metallic);
        }
        own.base_color = Some(color);
    }
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            let overrides = &mut d.objects[index].overrides;
            match overrides.iter_mut().find(|it| it.material == name) {
                Some(known) => *known = own,
                None => overrides.push(own),
            }
        });
    }
    let is_known = known.is_some();
    let button = ui.add_enabled(is_known, egui::Button::new("As in the file").small());
    if button.clicked() {
        work.document.edit("Material of the file", |d| {
            d.objects[index].overrides.retain(|it| it.material != name);
        });
    }
}
