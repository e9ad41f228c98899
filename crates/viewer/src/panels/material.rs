//! A material.

use egui::Ui;
use hairline_document::description::{Cover, Material, MaterialKind, MetalColor, Rows};
use hairline_editor::actions::materials;
use hairline_editor::presets::MaterialPreset;
use hairline_optics::metal::Metal;
use hairline_scene::{Anisotropy, Coat, Specular};

use super::form::{Form, NAME};
use super::own_presets;
use crate::command::Command;
use crate::gallery::{StandIn, Thumb, cards, metal_swatches};
use crate::workspace::Workspace;

/// Kinds of materials, each with its defaults.
#[derive(Clone, Copy, PartialEq)]
enum MaterialChoice {
    Measured,
    Colored,
    Own,
    Dielectric,
    MetallicRoughness,
    Mirror,
}

const KINDS: [(MaterialChoice, &str); 6] = [
    (MaterialChoice::Measured, "measured metal"),
    (MaterialChoice::Colored, "coloured metal"),
    (MaterialChoice::Own, "metal by n and k"),
    (MaterialChoice::Dielectric, "clear coat over a body"),
    (MaterialChoice::MetallicRoughness, "metallic-roughness"),
    (MaterialChoice::Mirror, "mirror"),
];

impl MaterialChoice {
    fn from_kind(kind: &MaterialKind) -> Self {
        match kind {
            MaterialKind::Metal(MetalColor::Measured(_)) => Self::Measured,
            MaterialKind::Metal(MetalColor::Own(_)) => Self::Own,
            MaterialKind::Metal(MetalColor::Color(_)) => Self::Colored,
            MaterialKind::Dielectric { .. } => Self::Dielectric,
            MaterialKind::MetallicRoughness { .. } => Self::MetallicRoughness,
            MaterialKind::Mirror => Self::Mirror,
        }
    }

    fn begin(self) -> MaterialKind {
        match self {
            Self::Measured => MaterialKind::Metal(MetalColor::Measured(Metal::StainlessSteel)),
            Self::Colored => MaterialKind::Metal(MetalColor::Color([0.9, 0.9, 0.9])),
            Self::Own => MaterialKind::Metal(MetalColor::Own(n_k_of(Metal::StainlessSteel))),
            Self::Dielectric => MaterialKind::Dielectric {
                ior: 1.5,
                base_color: [0.5; 3],
            },
            Self::MetallicRoughness => MaterialKind::MetallicRoughness {
                base_color: [1.0; 3],
                metallic: 1.0,
                specular: Specular::default(),
            },
            Self::Mirror => MaterialKind::Mirror,
        }
    }
}

/// n and k of a measured metal, to begin with.
fn n_k_of(metal: Metal) -> Vec<[f64; 3]> {
    let row = |i: u32| {
        let nm = 380.0 + 10.0 * f64::from(i);
        let (n, k) = metal.n_k(nm);
        [nm, n, k]
    };
    (0..=40).map(row).collect()
}

/// Rows for a part that a material may have.
fn part<T: Rows>(form: &mut Form, texts: [&str; 2], part: &mut Option<T>, begin: T) {
    if let Some(part) = form.optional(texts, part, || begin) {
        part.rows(form);
    }
}

/// Alike in all directions, or brushed.
fn anisotropy_rows(form: &mut Form, anisotropy: &mut Option<Anisotropy>) {
    let texts = [
        "Brushed",
        "Whether highlights are drawn out one way, as on brushed metal",
    ];
    let begin = Anisotropy {
        strength: 0.6,
        direction_deg: 0.0,
    };
    part(form, texts, anisotropy, begin);
}

/// Rows for a material without a coat, or with one.
fn coat_rows(form: &mut Form, coat: &mut Option<Coat>) {
    let texts = [
        "Coated",
        "Whether a clear layer lies over it, in which its scratches are",
    ];
    let begin = Coat {
        weight: 1.0,
        roughness: 0.03,
    };
    part(form, texts, coat, begin);
}

/// Rows for a measured metal under a clear plate, or bare.
fn cover_rows(form: &mut Form, cover: &mut Option<Cover>) {
    let texts = [
        "Covered",
        "Whether a clear plate lies over the metal and its gratings, as the polycarbonate of a disc",
    ];
    part(form, texts, cover, Cover::default());
}

pub(super) fn show(ui: &mut Ui, work: &mut Workspace, index: usize) {
    let Some(mut material) = work.document.description().materials.get(index).cloned() else {
        return;
    };
    ui.heading("Material");
    let mut form = Form::new(ui, ("material", index), work.diagonal_m(None));
    let mut name = material.name.clone();
    form.text(NAME, "What objects call it", &mut name);
    let mut kind = MaterialChoice::from_kind(&material.kind);
    form.choice(
        "Kind",
        "What the surface is made of",
        KINDS.map(|(kind, name)| (kind, name.to_owned())),
        &mut kind,
    );
    if kind != MaterialChoice::from_kind(&material.kind) {
        material.kind = kind.begin();
    }
    kind_rows(&mut form, &mut material.kind);
    form.number(Material::ROUGHNESS, &mut material.roughness);
    anisotropy_rows(&mut form, &mut material.anisotropy);
    coat_rows(&mut form, &mut material.coat);
    match material.kind {
        MaterialKind::Metal(MetalColor::Measured(_) | MetalColor::Own(_))
            if material.coat.is_none() =>
        {
            cover_rows(&mut form, &mut material.cover);
        }
        _ => material.cover = None,
    }
    form.rest(&mut material);
    if let Some(change) = form.change() {
        if name != material.name {
            // Objects call it by its name.
            work.apply("Rename material", |d, _| materials::rename(d, index, &name));
        } else {
            work.drag(&change.label, change.key, |d| {
                d.materials[index] = material;
            });
        }
    }
    ui.add_space(8.0);
    ui.horizontal_wrapped(|ui| {
        ui.menu_button("Replace by a preset…", |ui| {
            let stand_in = work.stand_in(None);
            if let Some(material) = material_cards(ui, work, stand_in) {
                work.document.edit("Material preset", |d| {
                    let name = d.materials[index].name.clone();
                    d.materials[index] = Material { name, ..material };
                });
            }
        });
        super::button(ui, work, Command::SavePreset);
        super::button(ui, work, Command::Duplicate);
        super::button(ui, work, Command::Delete);
    });
}

/// Rows for what a surface is made of.
fn kind_rows(form: &mut Form, kind: &mut MaterialKind) {
    match kind {
        MaterialKind::Metal(MetalColor::Measured(metal)) => {
            form.choice("Metal", "By its measured n and k", metals(), metal);
            let hint = "Their reflectance at normal incidence in daylight, D65";
            form.custom("", hint, |ui, _| metal_swatches(ui, metal));
        }
        MaterialKind::Metal(MetalColor::Own(rows)) => {
            let hint =
                "Rows of a wavelength, n and k: `n_k` of the scene file, where they are changed";
            let rows = rows.len();
            form.custom("n and k", hint, |ui, _| {
                ui.label(format!("{rows} rows"));
                false
            });
        }
        MaterialKind::MetallicRoughness {
            base_color,
            metallic,
            specular,
        } => {
            form.color(MaterialKind::BASE_COLOR, base_color);
            form.number(MaterialKind::METALLIC, metallic);
            // A metal takes no part in it.
            if *metallic < 1.0 {
                specular.rows(form);
            }
        }
        kind => kind.rows(form),
    }
}

/// The measured metals, by name.
pub(super) fn metals() -> impl Iterator<Item = (Metal, String)> {
    MaterialPreset::all().filter_map(|preset| match preset {
        MaterialPreset::Metal(metal) => Some((metal, preset.name().to_owned())),
        _ => None,
    })
}

/// Cards of all materials to begin with, and the user's own.
pub(super) fn material_cards(
    ui: &mut Ui,
    work: &mut Workspace,
    stand_in: StandIn,
) -> Option<Material> {
    let choices =
        MaterialPreset::all().map(|p| (p, Thumb::Material(p, stand_in), p.name(), p.tooltip()));
    let ours = cards(ui, &mut work.gallery, "materials", choices);
    let own = own_presets::show(ui, work, |parts| !parts.materials.is_empty());
    ours.map(MaterialPreset::material)
        .or_else(|| work.own_material(own?))
}
