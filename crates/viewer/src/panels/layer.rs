//! A layer of scratches.

use std::path::Path;

use egui::{Id, Ui};
use hairline_document::description::{
    Amount, Distribution, Engraved, Laid, Layer, Line, Pattern, PatternAxis, Rows, Scratches,
};
use hairline_editor::Selection;
use hairline_editor::actions::pictures::PictureOf;
use hairline_editor::presets::LayerPreset;
use hairline_editor::strength::StrengthSlider;
use hairline_optics::section::Section;

use super::form::Form;
use super::layer_place;
use crate::command::Command;
use crate::parts;
use crate::style::tooltip_beside_menu;
use crate::tools::Tool;
use crate::workspace::{NO_PRESET, Workspace};

pub(super) fn show(ui: &mut Ui, work: &mut Workspace, index: usize) {
    let description = work.document.description().clone();
    let Some(mut layer) = description.scratches.get(index).cloned() else {
        return;
    };
    let object = Selection::Layer(index).object(&description);
    let diagonal_m = work.diagonal_m(object);
    let names = parts::names(work, &layer.object);
    ui.heading("Scratches");
    let mut form = Form::new(ui, ("layer", index), diagonal_m);
    form.optional_name(&mut layer.name);
    form.object("What they lie on", &description, &mut layer.object);
    form.flag(Scratches::HIDDEN, &mut layer.hidden);
    form.flag(Scratches::SOLO, &mut layer.solo);
    strength_row(&mut form, &mut layer, index);
    let picks = layer_place::show(&mut form, &mut layer, index, names);
    profile(&mut form, &mut layer.profile);
    match &mut layer.layer {
        Layer::Laid(laid) => laid_rows(&mut form, laid),
        Layer::Brushed(brushed) => {
            form.section("Look");
            form.distribution(Laid::WIDTH_UM, &mut brushed.width_um);
            form.distribution(Laid::DEPTH_NM, &mut brushed.depth_nm);
            form.distribution(Laid::LENGTH_M, &mut brushed.length_m);
        }
        Layer::Engraved(engraved) => engraved_rows(&mut form, engraved, index),
        Layer::Listed(listed) => file_row(&mut form, &listed.file),
    }
    form.rest(&mut layer);
    work.choose_picture(form.wanted());
    if let Some(change) = form.change() {
        work.drag(&change.label, change.key, |d| {
            d.scratches[index] = layer.clone();
        });
    }
    if picks {
        work.toolbox.tool = Tool::PickPart;
    }
    if matches!(layer.layer, Layer::Engraved(_)) {
        super::button(ui, work, Command::Pick(Tool::Pen));
    }
    strokes(ui, work, index, &layer);
    buttons(ui, work, index, &layer, diagonal_m);
}

/// A row for the strength. Its slider stays the same while the layer's panel is shown.
fn strength_row(form: &mut Form, layer: &mut Scratches, index: usize) {
    if !matches!(layer.layer, Layer::Laid(_) | Layer::Brushed(_)) {
        return;
    }
    let id = Id::unique("slider of the strength");
    let pass = form.ui.ctx().cumulative_pass_nr();
    let kept = form.ui.data(|data| data.get_temp::<KeptSlider>(id));
    let is_of_it = |kept: &KeptSlider| kept.layer == index && kept.pass + 1 >= pass;
    let before = kept.filter(is_of_it).map(|kept| kept.slider);
    let texts = [
        "Strength",
        "From barely there (0) to heavy (1): count, width and depth together, as the grades of wear have them. \
         Ten times as many scratches are 1.25 times as wide and 1.15 times as deep",
    ];
    let Some(mut slider) = StrengthSlider::new(layer, form.diagonal_m, before) else {
        let why = match layer.layer {
            Layer::Brushed(_) => "nothing is drawn yet",
            _ => "there are no scratches: their number is 0",
        };
        form.fraction_slider(texts, Err(why));
        return;
    };
    let mut wanted = slider.position();
    form.fraction_slider(texts, Ok(&mut wanted));
    if wanted != slider.position() {
        slider.go(wanted, layer);
    }
    let kept = KeptSlider {
        layer: index,
        pass,
        slider,
    };
    form.ui.data_mut(|data| data.insert_temp(id, kept));
}

/// The slider that was shown last.
#[derive(Clone)]
struct KeptSlider {
    layer: usize,
    pass: u64,
    slider: StrengthSlider,
}

/// A row for the cross section. Depths of a file's own are one more choice.
fn profile(form: &mut Form, section: &mut Section) {
    let named = [
        (Section::Rectangle, "Flat floor"),
        (Section::V, "V"),
        (Section::Round, "Round"),
        (Section::Shoulders, "Round, with shoulders"),
    ];
    let own = matches!(section, Section::Listed(_)).then(|| (section.clone(), "Own"));
    let options = named.into_iter().chain(own);
    form.choice(
        "Profile",
        "Cross section of the grooves. A flat floor shows the purest colours; slopes spread light further and mix them",
        options.map(|(section, name)| (section, name.to_owned())),
        section,
    );
}

fn laid_rows(form: &mut Form, laid: &mut Laid) {
    let mut name = laid.pattern.name();
    form.choice(
        "Pattern",
        "How they run over the surface",
        PATTERNS.map(|name| (name, name.to_owned())),
        &mut name,
    );
    if name != laid.pattern.name() {
        laid.pattern = begin(name, &laid.pattern);
    }
    amount(form, &mut laid.amount);
    form.section("Look");
    form.distribution(Laid::WIDTH_UM, &mut laid.width_um);
    form.distribution(Laid::DEPTH_NM, &mut laid.depth_nm);
    form.distribution(Laid::LENGTH_M, &mut laid.length_m);
    form.section("Direction and bend");
    laid.pattern.rows(form);
}

fn file_row(form: &mut Form, file: &Path) {
    form.custom("File", "", |ui, _| {
        ui.add(egui::Label::new(file.display().to_string()).truncate());
        false
    });
}

fn engraved_rows(form: &mut Form, engraved: &mut Engraved, index: usize) {
    match &mut engraved.line {
        Line::Curve { points_m, .. } => {
            for (i, point_m) in points_m.iter_mut().enumerate() {
                form.numbered(Line::CURVE_POINTS_M, i, point_m);
            }
        }
        Line::Svg { file, .. } => {
            let mut named = Some(file.clone());
            let meaning = Line::DRAWING.meaning;
            form.picture("File", meaning, &mut named, PictureOf::Drawing(index));
            *file = named.unwrap_or_default();
        }
        Line::Text { .. } => {}
    }
    engraved.line.rows(form);
    form.section("Look");
    form.number(Engraved::LINE_M, &mut engraved.line_m);
    form.distribution(Laid::WIDTH_UM, &mut engraved.width_um);
    form.distribution(Laid::DEPTH_NM, &mut engraved.depth_nm);
}

/// A number of scratches, or a number on each square metre.
fn amount(form: &mut Form, amount: &mut Amount) {
    let mut is_density = matches!(amount, Amount::DensityPerM2(_));
    form.choice(
        "How many",
        "A number of scratches in all, whatever the size of the object, or a number on each square metre",
        [
            (false, "in all".to_owned()),
            (true, "per area".to_owned()),
        ],
        &mut is_density,
    );
    match (is_density, *amount) {
        (true, Amount::Count(_)) => *amount = Amount::DensityPerM2(1e5),
        (false, Amount::DensityPerM2(_)) => *amount = Amount::Count(5000),
        _ => {}
    }
    match amount {
        Amount::Count(count) => form.whole(Amount::COUNT, count),
        Amount::DensityPerM2(density) => form.number(Amount::DENSITY_PER_M2, density),
    }
}

/// The strokes of a brush and an eraser.
fn strokes(ui: &mut Ui, work: &mut Workspace, index: usize, layer: &Scratches) {
    ui.add_space(8.0);
    ui.strong("Strokes");
    ui.horizontal_wrapped(|ui| {
        ui.label(match layer.strokes.len() {
            0 => "none yet".to_owned(),
            1 => "1 stroke".to_owned(),
            n => format!("{n} strokes"),
        });
        for tool in [Tool::Brush, Tool::Eraser] {
            let command = Command::Pick(tool);
            if ui
                .button(command.label())
                .on_hover_text(tool.hint())
                .clicked()
            {
                work.toolbox.tool = tool;
            }
        }
        let last = ui.add_enabled(
            !layer.strokes.is_empty(),
            egui::Button::new("Remove the last"),
        );
        if last.clicked() {
            work.document.edit("Remove a stroke", |d| {
                drop(d.scratches[index].strokes.pop())
            });
        }
    });
}

fn buttons(ui: &mut Ui, work: &mut Workspace, index: usize, layer: &Scratches, diagonal_m: f64) {
    ui.add_space(8.0);
    ui.horizontal_wrapped(|ui| {
        ui.menu_button("Replace by a preset…", |ui| {
            for preset in LayerPreset::ALL {
                let entry = ui.button(preset.name());
                tooltip_beside_menu(&entry, entry.rect, preset.tooltip());
                if entry.clicked() {
                    let made = preset.layer(layer.object.clone(), diagonal_m);
                    work.document.edit("Layer preset", |d| {
                        let kept = &mut d.scratches[index];
                        let seed = kept.layer.seed();
                        kept.layer = made.layer;
                        if let (Some(seed), Some(own)) = (seed, kept.layer.seed_mut()) {
                            *own = seed;
                        }
                        // Paint needs a drawn layer; an eraser serves any.
                        kept.strokes.retain(|stroke| {
                            matches!(stroke.brush, hairline_document::description::Brush::Erase)
                        });
                    });
                }
            }
        });
        let keep = egui::Button::new(Command::SavePreset.label());
        let keep = ui.add_enabled(work.can(Command::SavePreset), keep);
        if keep.on_disabled_hover_text(NO_PRESET).clicked() {
            work.requested.push(Command::SavePreset);
        }
        super::list_buttons(ui, work);
    });
}

/// Patterns that are drawn at random.
const PATTERNS: [&str; 6] = ["random", "parallel", "circular", "radial", "spun", "swirl"];

/// The pattern of a name with the axis of the one before, if both have one.
fn begin(name: &str, before: &Pattern) -> Pattern {
    let around = match before {
        Pattern::Circular(around) | Pattern::Radial(around) | Pattern::Spun { around, .. } => {
            *around
        }
        Pattern::Parallel { jitter_deg, .. } => PatternAxis {
            jitter_deg: *jitter_deg,
            ..PatternAxis::default()
        },
        Pattern::Random { .. } | Pattern::Swirl { .. } => PatternAxis::default(),
    };
    let curvature = |mean, spread| Distribution { mean, spread };
    match name {
        "random" => Pattern::Random {
            curvature_per_m: curvature(0.0, 0.0),
        },
        "parallel" => Pattern::Parallel {
            direction: [1.0, 0.0, 0.0],
            jitter_deg: around.jitter_deg,
        },
        "circular" => Pattern::Circular(around),
        "radial" => Pattern::Radial(around),
        "spun" => Pattern::Spun {
            around,
            curvature_per_m: curvature(20.0, 0.0),
        },
        _ => Pattern::Swirl {
            curvature_per_m: curvature(25.0, 8.0),
        },
    }
}
