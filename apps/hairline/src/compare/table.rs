//! The figures as text and as JSON.

use std::fmt::Write as _;

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use hairline_image::metrics::{Comparison, LayerComparison, Metric, Problem, Verdict, ZTest};
use hairline_image::{Display, Layer};
use serde_json::{Map, Value, json};

use super::figure::figure;
use super::side::Side;

/// A column of the table: a heading, the figure, and an explanation for someone who meets it first.
pub struct Column {
    /// Short enough for a heading.
    pub heading: &'static str,
    /// Metric of the figure.
    pub metric: Metric,
    /// Explanation for a hover.
    pub meaning: &'static str,
}

/// The columns, the same on the terminal and in the report.
pub const COLUMNS: [Column; 10] = [
    Column {
        heading: "FLIP",
        metric: Metric::Flip,
        meaning: "The difference that a viewer sees when the two pictures alternate in place, averaged over the pixels: \
                  0 none, 1 black against white.",
    },
    Column {
        heading: "FLIP 95 %",
        metric: Metric::Flip95,
        meaning: "95 % of the pixels have a smaller FLIP than this: how bad the bad places are.",
    },
    Column {
        heading: "PSNR dB",
        metric: Metric::Psnr,
        meaning: "Peak over rms difference of what a display shows, in decibels. The larger the better: 40 and more are \
                  hard to tell apart. Layers that are no colours: of the values, by the reference's largest.",
    },
    Column {
        heading: "rel. MSE",
        metric: Metric::RelativeMse,
        meaning: "Mean of the squared difference over the squared reference, on linear values: an error of a tenth \
                  everywhere gives 0.01. Dark values are held up so that they do not count without bound.",
    },
    Column {
        heading: "rms",
        metric: Metric::Rms,
        meaning: "Root of the mean squared difference of the linear values, in their own unit.",
    },
    Column {
        heading: "rel. rms",
        metric: Metric::RelativeRms,
        meaning: "The rms difference over the rms of the reference: bright places decide.",
    },
    Column {
        heading: "largest",
        metric: Metric::Max,
        meaning: "The largest difference of a single linear value.",
    },
    Column {
        heading: "rms beyond noise",
        metric: Metric::RmsBeyondNoise,
        meaning: "What is left of the rms difference when the noise that the files tell of is taken off.",
    },
    Column {
        heading: "rel. beyond noise",
        metric: Metric::RelativeRmsBeyondNoise,
        meaning: "The same over the rms of the reference: the error of the model itself.",
    },
    Column {
        heading: "mean z\u{b2}",
        metric: Metric::Z2,
        meaning: "Mean squared difference in units of its own noise. About 1 where noise is all there is, \
                  more with few samples and rare bright ones; the verdict beside it looks at blocks of pixels too.",
    },
];

/// The columns for which a layer has a figure.
pub fn columns(comparison: &Comparison) -> impl Iterator<Item = &'static Column> {
    let layers = &comparison.layers;
    COLUMNS.iter().filter(|column| {
        layers
            .iter()
            .any(|layer| column.metric.value(layer).is_some())
    })
}

/// Problems of each layer, in a few words for its row.
pub fn remarks(comparison: &Comparison) -> Vec<(Layer, String)> {
    let mut remarks: Vec<(Layer, String)> = Vec::new();
    let mut add = |layer: Layer, text: String| match remarks.iter_mut().find(|r| r.0 == layer) {
        Some((_, before)) => {
            before.push_str(", ");
            before.push_str(&text);
        }
        None => remarks.push((layer, text)),
    };
    for problem in &comparison.problems {
        match problem {
            Problem::MissingLayers { side, layers } => {
                for layer in layers {
                    add(*layer, format!("not in {side}"));
                }
            }
            Problem::NotFinite {
                side,
                layer,
                values,
            } => add(*layer, format!("{values} not finite in {side}")),
            _ => {}
        }
    }
    remarks
}

/// Verdict of the z-test, in words, and the figures that it rests on.
pub fn verdict(test: &ZTest) -> String {
    let z2 = format!("mean z\u{b2} = {}", figure(test.mean_z2));
    match test.verdict {
        Verdict::ExplainedByNoise => format!("the difference is explained by noise: {z2}"),
        Verdict::MoreThanNoise => format!(
            "the difference is not explained by noise: {z2}{}",
            beyond_noise(test)
        ),
        Verdict::LessThanNoise => format!(
            "the difference is smaller than the noise that the files tell of (the same noise in both?): {z2}"
        ),
        Verdict::TooFewValues => format!(
            "too few values with a known variance to tell whether noise explains the difference: {}",
            test.values
        ),
    }
}

/// Figures that gave the difference away, since single pixels often do not: blocks of pixels, the whole picture,
/// places without noise.
fn beyond_noise(test: &ZTest) -> String {
    let mut text = format!(
        ", {} of 8 x 8 blocks, largest |z| of a block {} ({} is allowed), z of the picture {}",
        figure(test.block_mean_z2),
        figure(test.block_max_z),
        figure(test.block_max_z_allowed()),
        figure(test.picture_z),
    );
    if test.share_without_noise > 0.0 {
        let percent = figure(100.0 * test.share_without_noise);
        text.push_str(&format!(
            "; {percent} % of the values differ where there is no noise"
        ));
    }
    text
}

/// A table, a column a layer so that it fits a narrow terminal, and a line on the noise of each layer that has any.
pub fn text(a: &Side, b: &Side, comparison: &Comparison) -> String {
    let remarks = remarks(comparison);
    let remark = |layer: Layer| {
        remarks
            .iter()
            .find(|(l, _)| *l == layer)
            .map(|(_, text)| text)
    };
    let compared = |layer: Layer| comparison.layers.iter().find(|l| l.layer == layer);
    let layers: Vec<Layer> = Layer::ALL
        .into_iter()
        .filter(|&layer| compared(layer).is_some() || remark(layer).is_some())
        .collect();

    let rule = LineStyle::none().fill('\u{2500}').junction('\u{2500}');
    let mut table = Table::new();
    table
        .load_style(TableStyle::new().header_separator(rule))
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(std::iter::once("").chain(layers.iter().map(|layer| layer.name())));
    for column in columns(comparison) {
        let figures = layers.iter().map(|&layer| {
            compared(layer)
                .and_then(|compared| column.metric.value(compared))
                .map_or("-".to_owned(), figure)
        });
        table.add_row(std::iter::once(column.heading.to_owned()).chain(figures));
    }
    if !remarks.is_empty() {
        // A line each, so that the columns stay narrow.
        let texts = layers
            .iter()
            .map(|&layer| remark(layer).map_or(String::new(), |text| text.replace(", ", ",\n")));
        table.add_row(std::iter::once("remarks".to_owned()).chain(texts));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }

    let mut text = String::new();
    let [width, height] = a.layers.size_px;
    let (a, b) = (a.path.display(), b.path.display());
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{a} against {b}, {width} x {height}\n{}",
        table.trim_fmt()
    );
    for layer in &comparison.layers {
        if let Some(test) = &layer.z_test {
            let _ = writeln!(text, "{}: {}", layer.layer.name(), verdict(test));
        }
    }
    text
}

/// All figures by the names that limits have.
pub fn json(a: &Side, b: &Side, display: &Display, comparison: &Comparison) -> Value {
    let file = |side: &Side| {
        json!({
            "file": side.path.display().to_string(),
            "size_px": side.layers.size_px,
            "notes": side.layers.notes,
        })
    };
    let layers: Map<String, Value> = comparison
        .layers
        .iter()
        .map(|layer| (layer.layer.name().to_owned(), layer_json(layer)))
        .collect();
    let problems: Vec<String> = comparison
        .problems
        .iter()
        .map(ToString::to_string)
        .collect();
    json!({
        "a": file(a),
        "b": file(b),
        "display": { "exposure_ev": display.exposure_ev, "tone_map": display.tone_map.name() },
        "layers": layers,
        "problems": problems,
    })
}

fn layer_json(layer: &LayerComparison) -> Value {
    let mut figures = Map::new();
    for metric in Metric::ALL {
        if let Some(value) = metric.value(layer) {
            // null where it is infinite.
            figures.insert(metric.name().to_owned(), json!(value));
        }
    }
    figures.insert("mean".to_owned(), json!(layer.difference.mean));
    figures.insert(
        "reference-mean".to_owned(),
        json!(layer.difference.reference_mean),
    );
    figures.insert("not-finite".to_owned(), json!(layer.difference.not_finite));
    if let Some(test) = &layer.z_test {
        figures.insert("verdict".to_owned(), json!(test.verdict.name()));
    }
    Value::Object(figures)
}
