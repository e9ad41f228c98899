//! The report: one HTML file that needs no other and no network, for light and dark displays.
//!
//! Everything that can be said without a script is said without: the pictures, the table, what is wrong. The script adds
//! the slider, the magnifier and the exposure.

mod pictures;
mod values;

use anyhow::Context as _;
use hairline_image::metrics::{Comparison, LayerComparison, Metric, Verdict};
use hairline_image::{Display, Layer, Layers, Referred, ToneMap};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::json;

use self::pictures::ErrorMapKind;
use self::values::ToneTable;
use super::figure::figure;
use super::side::Side;
use super::table::{self, Column};
use hairline_work::failure::Failure;

const STYLE: &str = include_str!("report/report.css");
const SCRIPT: &str = include_str!("report/report.js");

/// Policy of the page: nothing may be loaded, since a report that is mailed around should not call anyone.
const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// Pictures of a layer.
struct View {
    layer: Layer,
    /// PNG URIs.
    shown: [String; 2],
    maps: Vec<(ErrorMapKind, String)>,
    /// Reference and difference from it, packed.
    linear: Option<[String; 2]>,
}

/// The whole file.
pub fn page(
    a: &Side,
    b: &Side,
    display: &Display,
    comparison: &Comparison,
) -> Result<String, Failure> {
    let views = views(a, b, display, comparison)
        .context("the report")
        .map_err(Failure::Work)?;
    let names = [a, b].map(|side| side.path.display().to_string());
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (names[0]) " against " (names[1]) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
            }
            body {
                (header(a, display, &names, is_scene_referred(a, b)))
                (problems(comparison))
                main {
                    (toolbar(&views, is_scene_referred(a, b)))
                    (panes(a.layers.size_px, &views, &names))
                    (magnifier())
                    (figures(comparison))
                }
                (footnotes(a, b, &views))
                (data(a, &views, display).context("the report").map_err(Failure::Work)?)
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    Ok(markup.into_string())
}

fn is_scene_referred(a: &Side, b: &Side) -> bool {
    [a, b]
        .iter()
        .all(|side| side.layers.referred == Referred::Scene)
}

/// The pictures as [`hairline_image::metrics::compare`] compared them: where one is a PNG, both as a display shows them.
fn views(
    a: &Side,
    b: &Side,
    display: &Display,
    comparison: &Comparison,
) -> anyhow::Result<Vec<View>> {
    let scene_referred = is_scene_referred(a, b);
    let (shown_a, shown_b);
    let (a, b, display): (&Layers, &Layers, Display) = if scene_referred {
        (&a.layers, &b.layers, *display)
    } else {
        (shown_a, shown_b) = (a.layers.displayed(display), b.layers.displayed(display));
        let as_it_is = Display {
            exposure_ev: 0.0,
            tone_map: ToneMap::None,
        };
        (&shown_a, &shown_b, as_it_is)
    };
    comparison
        .layers
        .iter()
        .filter_map(|compared| {
            let pair = [a.estimate(compared.layer)?, b.estimate(compared.layer)?];
            Some((compared, pair))
        })
        .map(|(compared, [of_a, of_b])| {
            let (size_px, layer) = (a.size_px, compared.layer);
            let shown = pictures::shown(size_px, layer, [of_a.values, of_b.values], &display);
            let [shown_a, shown_b] = shown.map(|codes| pictures::png_uri(size_px, &codes));
            let mut maps = Vec::new();
            for kind in ErrorMapKind::ALL {
                if let Some(codes) = pictures::map(kind, size_px, compared, [&of_a, &of_b]) {
                    maps.push((kind, pictures::png_uri(size_px, &codes)?));
                }
            }
            Ok(View {
                layer,
                shown: [shown_a?, shown_b?],
                maps,
                linear: linear(layer, of_a.values, of_b.values)?,
            })
        })
        .collect()
}

/// The difference by itself: that of two half floats would lose the small ones.
fn linear(layer: Layer, a: &[[f32; 3]], b: &[[f32; 3]]) -> std::io::Result<Option<[String; 2]>> {
    if a.len() > values::LINEAR_MAX_PX {
        return Ok(None);
    }
    let difference: Vec<[f32; 3]> = a
        .iter()
        .zip(b)
        .map(|(a, b)| std::array::from_fn(|c| a[c] - b[c]))
        .collect();
    let channels = channels(layer);
    Ok(Some([
        values::packed(b, channels)?,
        values::packed(&difference, channels)?,
    ]))
}

fn channels(layer: Layer) -> usize {
    if layer == Layer::Depth { 1 } else { 3 }
}

fn header(a: &Side, display: &Display, names: &[String; 2], scene_referred: bool) -> Markup {
    let [width, height] = a.layers.size_px;
    let sign = if display.exposure_ev > 0.0 { "+" } else { "" };
    html! {
        header {
            h1 {
                span.tag { "A" } span.file { (names[0]) }
                span.against { "against" }
                span.tag { "B" } span.file { (names[1]) }
                span.against { "the reference" }
            }
            p.facts {
                span { (width) " \u{d7} " (height) " px" }
                @if scene_referred {
                    span { "shown at " (sign) (display.exposure_ev) " EV, " (display.tone_map.name()) }
                } @else {
                    span { "compared as displayed" }
                }
            }
        }
    }
}

fn problems(comparison: &Comparison) -> Markup {
    html! {
        @if !comparison.problems.is_empty() {
            ul.problems aria-label="Warnings" {
                @for problem in &comparison.problems {
                    li { (problem) }
                }
            }
        }
    }
}

fn toolbar(views: &[View], scene_referred: bool) -> Markup {
    let has = |kind| {
        views
            .iter()
            .any(|view| view.maps.iter().any(|(k, _)| *k == kind))
    };
    html! {
        div.toolbar role="toolbar" aria-label="What to look at" {
            fieldset.segments {
                legend { "Layer" }
                @for (i, view) in views.iter().enumerate() {
                    label {
                        input type="radio" name="layer" value=(view.layer.name()) checked[i == 0];
                        span { (view.layer.name()) }
                    }
                }
            }
            fieldset.segments {
                legend { "Error map" }
                @for (i, kind) in ErrorMapKind::ALL.into_iter().filter(|kind| has(*kind)).enumerate() {
                    label title=(kind.meaning()) {
                        input type="radio" name="kind" value=(kind.name()) checked[i == 0];
                        span { (kind.title()) }
                    }
                }
            }
            @if scene_referred && views.iter().any(|view| view.linear.is_some()) {
                div.exposure {
                    label for="exposure" { "Exposure" }
                    input #exposure type="range" min="-8" max="8" step="0.25" value="0"
                        aria-describedby="exposure-value";
                    output #exposure-value for="exposure" { "0 EV" }
                    button #exposure-reset type="button" disabled { "Reset" }
                }
            }
        }
    }
}

fn panes([width, height]: [u32; 2], views: &[View], names: &[String; 2]) -> Markup {
    let shape = format!("--w:{width};--h:{height}");
    html! {
        div.panes style=(shape) {
            figure {
                div #pictures .stage tabindex="0" role="group"
                    aria-label="The two pictures. Arrow keys move the magnifier, plus and minus change its factor." {
                    @for (i, view) in views.iter().enumerate() {
                        @for (role, uri, name) in [("b", &view.shown[1], &names[1]), ("a", &view.shown[0], &names[0])] {
                            img .shot.(role) data-layer=(view.layer.name()) src=(uri)
                                width=(width) height=(height)
                                alt={ (view.layer.name()) " of " (name) } hidden[i != 0];
                        }
                    }
                    canvas #exposed-b .shot.b width=(width) height=(height) hidden {}
                    canvas #exposed-a .shot.a width=(width) height=(height) hidden {}
                    span.corner.left aria-hidden="true" { "A" }
                    span.corner.right aria-hidden="true" { "B" }
                    div #slider .slider role="slider" tabindex="0" aria-label="Where A ends and B begins"
                        aria-orientation="horizontal" aria-valuemin="0" aria-valuemax="100" aria-valuenow="50"
                        aria-valuetext="50 % A" {}
                    div.field aria-hidden="true" hidden {}
                }
                figcaption {
                    span { "A left of the line, B right of it" }
                    span.keys { kbd { "A" } " " kbd { "B" } " one alone \u{b7} " kbd { "space" } " flips" }
                }
            }
            figure {
                div #map .stage tabindex="0" role="group"
                    aria-label="The error map. Arrow keys move the magnifier, plus and minus change its factor." {
                    @for (i, view) in views.iter().enumerate() {
                        @for (k, (kind, uri)) in view.maps.iter().enumerate() {
                            img .shot data-layer=(view.layer.name()) data-kind=(kind.name()) src=(uri)
                                width=(width) height=(height)
                                alt={ (kind.title()) " of " (view.layer.name()) } hidden[i != 0 || k != 0];
                        }
                    }
                    div.field aria-hidden="true" hidden {}
                }
                @for (i, kind) in ErrorMapKind::ALL.into_iter().enumerate() {
                    figcaption.legend data-kind=(kind.name()) hidden[i != 0] {
                        span.scale {
                            span.ramp style={ "background:" (ramp(kind)) } {}
                            span.ticks { @for tick in kind.ticks() { span { (tick) } } }
                        }
                        span.meaning { (kind.meaning()) }
                    }
                }
            }
        }
    }
}

/// The legend's colours, a stop for every sixteenth.
fn ramp(kind: ErrorMapKind) -> String {
    let palette = kind.palette();
    let (colors, _) = palette.as_chunks::<3>();
    let stops: Vec<String> = (0..=16)
        .map(|i| colors[(i * 255) / 16])
        .map(|[r, g, b]| format!("rgb({r} {g} {b})"))
        .collect();
    format!("linear-gradient(to right,{})", stops.join(","))
}

fn magnifier() -> Markup {
    html! {
        section.magnifier aria-label="Magnifier" {
            @for (id, label) in [("zoom-a", "A"), ("zoom-b", "B"), ("zoom-map", "map")] {
                figure.zoom {
                    canvas id=(id) aria-hidden="true" {}
                    span.corner.left { (label) }
                }
            }
            div.readout {
                div.where {
                    span #where { "no pixel" }
                    span #pinned .badge hidden { "pinned" }
                    label.factor {
                        "Factor "
                        select #factor {
                            @for factor in [2, 4, 8, 16, 32] {
                                option value=(factor) selected[factor == 8] { (factor) "\u{d7}" }
                            }
                        }
                    }
                    button #worst type="button" title="The brightest pixel of the error map" { "Worst pixel" }
                }
                table #values {
                    caption.hidden { "Values of the pixel" }
                    thead {
                        tr { th scope="col" #unit {} th scope="col" { "red" } th scope="col" { "green" } th scope="col" { "blue" } }
                    }
                    tbody {
                        @for (id, label) in [("va", "A"), ("vb", "B"), ("vd", "A \u{2212} B")] {
                            tr id=(id) { th scope="row" { (label) } td {} td {} td {} }
                        }
                        tr #vm { th scope="row" {} td colspan="3" {} }
                    }
                }
                p.keys {
                    "Point at a pixel; click pins it. Wheel: factor. "
                    kbd { "W" } " worst pixel, " kbd { "esc" } " unpins."
                }
            }
        }
        noscript { p.keys { "The slider and the magnifier need JavaScript; the table does not." } }
    }
}

fn figures(comparison: &Comparison) -> Markup {
    let columns: Vec<&Column> = table::columns(comparison).collect();
    let noisy = comparison.layers.iter().any(|layer| layer.z_test.is_some());
    let remarks: Vec<(Layer, String)> = table::remarks(comparison);
    let remark = |layer: Layer| {
        remarks
            .iter()
            .find(|(l, _)| *l == layer)
            .map(|(_, text)| text)
    };
    let missing = remarks.iter().filter(|(layer, _)| {
        comparison
            .layers
            .iter()
            .all(|compared| compared.layer != *layer)
    });
    html! {
        section.figures aria-label="Figures" {
            table {
                caption.hidden { "How far A is from B" }
                thead {
                    tr {
                        th scope="col" { "Layer" }
                        @for column in &columns {
                            th scope="col" {
                                span.term tabindex="0" { (column.heading) span.tip role="tooltip" { (column.meaning) } }
                            }
                        }
                        @if noisy {
                            th.words scope="col" {
                                span.term tabindex="0" {
                                    "is it noise?"
                                    span.tip role="tooltip" {
                                        "A z-test over pixels and blocks of pixels: whether the noise that the files tell of \
                                         is enough to explain the difference."
                                    }
                                }
                            }
                        }
                        @if !remarks.is_empty() { th.words scope="col" { "remarks" } }
                    }
                }
                tbody {
                    @for layer in &comparison.layers {
                        tr data-layer=(layer.layer.name()) {
                            th scope="row" { (layer.layer.name()) }
                            @for column in &columns {
                                td { (cell(layer, column.metric)) }
                            }
                            @if noisy { td.words { (verdict(layer)) } }
                            @if !remarks.is_empty() {
                                td.words { @if let Some(text) = remark(layer.layer) { span.remark { (text) } } }
                            }
                        }
                    }
                    @for (layer, text) in missing {
                        tr.missing {
                            th scope="row" { (layer.name()) }
                            @for _ in &columns { td { "\u{2013}" } }
                            @if noisy { td {} }
                            td.words { span.remark { (text) } }
                        }
                    }
                }
            }
        }
    }
}

fn cell(layer: &LayerComparison, metric: Metric) -> String {
    match metric.of(layer) {
        Some(value) if value == f64::INFINITY => "\u{221e}".to_owned(),
        Some(value) => figure(value),
        None => "\u{2013}".to_owned(),
    }
}

fn verdict(layer: &LayerComparison) -> Markup {
    let Some(test) = &layer.z_test else {
        return html! { "\u{2013}" };
    };
    let (class, words) = match test.verdict {
        Verdict::ExplainedByNoise => ("good", "explained by noise"),
        Verdict::MoreThanNoise => ("bad", "not explained"),
        Verdict::LessThanNoise => ("odd", "less than noise"),
        Verdict::TooFewValues => ("odd", "too few values"),
    };
    html! { span .verdict.(class) title=(table::verdict(test)) { (words) } }
}

/// Notes in the files on their making, and the contents of the report.
fn footnotes(a: &Side, b: &Side, views: &[View]) -> Markup {
    let embedded = views.iter().any(|view| view.linear.is_some());
    html! {
        footer {
            @for (tag, side) in [("A", a), ("B", b)] {
                @if !side.layers.notes.is_empty() {
                    details {
                        summary { span.tag { (tag) } "made by" }
                        dl { @for (name, text) in &side.layers.notes { dt { (name) } dd { (text) } } }
                    }
                }
            }
            p {
                @if embedded {
                    "Linear values are embedded as half floats: three digits. "
                } @else {
                    "The pictures are too large to embed linear values (" (values::LINEAR_MAX_PX)
                    " pixels at most): the magnifier reads displayed ones, and there is no exposure. "
                }
                "hairline " (env!("CARGO_PKG_VERSION"))
            }
        }
    }
}

/// Data that the script needs beyond the pictures.
fn data(a: &Side, views: &[View], display: &Display) -> anyhow::Result<Markup> {
    let exposable = views
        .iter()
        .any(|view| view.linear.is_some() && pictures::is_light(view.layer));
    let layers: Vec<_> = views
        .iter()
        .map(|view| {
            json!({
                "name": view.layer.name(),
                "channels": channels(view.layer),
                "isLight": pictures::is_light(view.layer),
                "hasLinear": view.linear.is_some(),
                "kinds": view.maps.iter().map(|(kind, _)| kind.name()).collect::<Vec<_>>(),
            })
        })
        .collect();
    let palettes: serde_json::Map<_, _> = ErrorMapKind::ALL
        .into_iter()
        .map(|kind| {
            (
                kind.name().to_owned(),
                json!(values::plain(&kind.palette())),
            )
        })
        .collect();
    let text = json!({
        "size": a.layers.size_px,
        "exposureEv": display.exposure_ev,
        "layers": layers,
        "palettes": palettes,
        "zMax": pictures::Z_MAX,
        "tone": { "nodes": ToneTable::NODES, "gain": ToneTable::GAIN, "max": ToneTable::MAX },
    })
    .to_string()
    // No text may end the element.
    .replace('<', "\\u003c");
    Ok(html! {
        script #data type="application/json" { (PreEscaped(text)) }
        @for view in views {
            @if let Some([reference, difference]) = &view.linear {
                script id={ "linear-" (view.layer.name()) "-b" } type="application/x-packed-halves" { (reference) }
                script id={ "linear-" (view.layer.name()) "-d" } type="application/x-packed-halves" { (difference) }
            }
        }
        @if exposable {
            script #tone type="application/x-packed-codes" { (ToneTable::new(display.tone_map).packed()?) }
        }
    })
}
