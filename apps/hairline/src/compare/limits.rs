//! `--fail-above` and `--fail-below`: figures that a script holds pictures to.

use hairline_image::Layer;
use hairline_image::metrics::{LayerComparison, Metric};

use super::figure::figure;

/// A figure and how far it may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    layer: Layer,
    metric: Metric,
    value: f64,
}

/// Result of a limit on a comparison.
pub enum Finding {
    /// The figure keeps the limit.
    Kept,
    /// The limit is broken: its name, and by how much.
    Broken(String),
    /// There is no such figure, and why.
    Absent(String),
}

impl Limit {
    /// Holds the layers that were compared to the limit.
    pub fn judge(&self, layers: &[LayerComparison]) -> Finding {
        let (layer, metric) = (self.layer.name(), self.metric.name());
        let Some(compared) = layers.iter().find(|l| l.layer == self.layer) else {
            return Finding::Absent(format!(
                "no {layer}.{metric} to hold to a limit: the layer {layer} was not compared"
            ));
        };
        let Some(found) = self.metric.value(compared) else {
            let why = self.metric.why_missing();
            return Finding::Absent(format!("no {layer}.{metric} to hold to a limit: {why}"));
        };
        let (kept, side) = if self.metric.larger_is_better() {
            (found >= self.value, "below")
        } else {
            (found <= self.value, "above")
        };
        // NaN keeps no limit, so the test is for kept and not for broken.
        if kept {
            return Finding::Kept;
        }
        let (found_text, limit) = (figure(found), figure(self.value));
        let by = figure((found - self.value).abs());
        Finding::Broken(format!(
            "{layer}.{metric} is {found_text}, {side} the limit of {limit} by {by}"
        ))
    }
}

/// `METRIC=VALUE` or `LAYER.METRIC=VALUE` of a figure that is better when smaller.
pub fn parse_above(text: &str) -> Result<Limit, String> {
    parse(text, "--fail-above", "--fail-below", false)
}

/// Parses a limit on a figure that is better when larger.
pub fn parse_below(text: &str) -> Result<Limit, String> {
    parse(text, "--fail-below", "--fail-above", true)
}

fn parse(
    text: &str,
    flag: &str,
    other_flag: &str,
    larger_is_better: bool,
) -> Result<Limit, String> {
    let example = if larger_is_better {
        "psnr=40"
    } else {
        "flip=0.05"
    };
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| format!("write METRIC=VALUE, as in {example}"))?;
    let (layer_name, metric_name) = name.split_once('.').unwrap_or(("beauty", name));
    let layer = named("layer", layer_name, Layer::ALL, Layer::name)?;
    let metric = named("metric", metric_name, Metric::ALL, Metric::name)?;
    if metric.larger_is_better() != larger_is_better {
        let better = if larger_is_better {
            "smaller"
        } else {
            "larger"
        };
        let metric = metric.name();
        return Err(format!(
            "{metric} is better when {better}: write {other_flag} {text} instead of {flag}"
        ));
    }
    let value = value
        .parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())
        .ok_or_else(|| format!("{value:?} is no number: write METRIC=VALUE, as in {example}"))?;
    Ok(Limit {
        layer,
        metric,
        value,
    })
}

/// Finds one of `all` by its name, or a hint at the closest name.
fn named<T: Copy, const N: usize>(
    what: &str,
    word: &str,
    all: [T; N],
    name: fn(T) -> &'static str,
) -> Result<T, String> {
    if let Some(found) = all.into_iter().find(|one| name(*one) == word) {
        return Ok(found);
    }
    let nearest = all
        .into_iter()
        .map(|one| {
            (
                strsim::jaro_winkler(&word.to_lowercase(), name(one)),
                name(one),
            )
        })
        .filter(|(similarity, _)| *similarity > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    Err(match nearest {
        Some((_, right)) => format!("unknown {what} `{word}`: did you mean `{right}`?"),
        None => format!(
            "unknown {what} `{word}`: there are {}",
            all.map(name).join(", ")
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_name_a_layer_and_a_figure() {
        let limit = parse_above("scratches.relative-rms=0.01").unwrap();
        assert_eq!(
            (limit.layer, limit.metric, limit.value),
            (Layer::Scratches, Metric::RelativeRms, 0.01)
        );
        assert_eq!(parse_above("flip=1e-3").unwrap().layer, Layer::Beauty);
        assert_eq!(parse_below("psnr=40").unwrap().metric, Metric::Psnr);
    }

    #[test]
    fn wrong_limits_say_what_would_be_right() {
        for (text, message) in [
            ("flip", "flip=0.05"),
            ("flpi=0.1", "did you mean `flip`?"),
            ("rmse=0.1", "did you mean `rms`?"),
            ("Flip=0.1", "did you mean `flip`?"),
            ("zebra=0.1", "there are rms, relative-rms"),
            ("scrathces.rms=0.1", "did you mean `scratches`?"),
            ("flip=much", "\"much\" is no number"),
            ("flip=NaN", "is no number"),
            ("psnr=40", "write --fail-below psnr=40"),
        ] {
            let error = parse_above(text).unwrap_err();
            assert!(error.contains(message), "{text}: {error}");
        }
        let error = parse_below("flip=0.1").unwrap_err();
        assert!(error.contains("write --fail-above flip=0.1"), "{error}");
    }
}
