//! Plots as small SVG files that can be read on a light page and on a dark one: no background, grey axes.

#![warn(unreachable_pub)]

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;

/// Contrast of about four on white and of five on black.
const GREY: RGBColor = RGBColor(128, 128, 128);
/// Colours of the lines: bright enough for black, dark enough for white.
const COLORS: [RGBColor; 4] = [
    RGBColor(38, 132, 226),
    RGBColor(222, 108, 36),
    RGBColor(46, 152, 82),
    RGBColor(188, 82, 196),
];
const SIZE_PX: (u32, u32) = (560, 320);
/// Number of decades below the largest value: smaller values are drawn on the axis, since logarithms have no zero.
const DECADES_MAX: f64 = 5.0;

/// One axis.
pub(crate) struct Axis<'a> {
    /// Name of the quantity, with its unit.
    pub(crate) name: &'a str,
    /// Whether places are logarithms.
    pub(crate) log: bool,
}

/// One line.
pub(crate) struct Series {
    /// Name in the legend.
    pub(crate) name: String,
    /// x, y and y's standard error.
    pub(crate) points: Vec<[f64; 3]>,
    /// One of four, counted from 0.
    pub(crate) color: usize,
    /// A thin line without marks: for curves of many points.
    pub(crate) plain: bool,
    /// Whether the line is dashed.
    pub(crate) dashed: bool,
}

impl Series {
    /// Marked points with their errors.
    pub(crate) fn new(name: &str, color: usize, points: impl Iterator<Item = [f64; 3]>) -> Self {
        Self {
            name: name.to_owned(),
            points: points.filter(|p| p.iter().all(|v| v.is_finite())).collect(),
            color,
            plain: false,
            dashed: false,
        }
    }

    /// Makes the line dashed.
    pub(crate) fn dashed(self) -> Self {
        Self {
            dashed: true,
            ..self
        }
    }

    /// Leaves out the marks.
    pub(crate) fn plain(self) -> Self {
        Self {
            plain: true,
            ..self
        }
    }
}

/// A plot that could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw: {0}")]
pub(crate) struct Error(String);

/// The text of an SVG file: series over an x axis and a y axis.
///
/// # Errors
/// Where the drawing library refuses.
pub(crate) fn plot(axes: [Axis; 2], series: &[Series]) -> Result<String, Error> {
    let mut svg = String::new();
    draw(&mut svg, &axes, series).map_err(|error| Error(error.to_string()))?;
    Ok(svg)
}

type Drawn = std::result::Result<(), Box<dyn std::error::Error>>;

fn draw(svg: &mut String, [x, y]: &[Axis; 2], series: &[Series]) -> Drawn {
    let root = SVGBackend::with_string(svg, SIZE_PX).into_drawing_area();
    let of = |i: usize| {
        series
            .iter()
            .flat_map(move |s| s.points.iter().map(move |p| p[i]))
    };
    let text = ("sans-serif", 13).into_font().color(&GREY);
    let mut chart = ChartBuilder::on(&root)
        .margin(8)
        .margin_right(16)
        .x_label_area_size(40)
        .y_label_area_size(58)
        .build_cartesian_2d(
            Scale::new(x.log, false, of(0)),
            Scale::new(y.log, true, of(1)),
        )?;
    chart
        .configure_mesh()
        .axis_style(GREY)
        .bold_line_style(GREY.mix(0.25))
        .light_line_style(TRANSPARENT)
        .label_style(text.clone())
        .axis_desc_style(text.clone())
        .x_desc(x.name)
        .y_desc(y.name)
        .draw()?;
    for one in series {
        let color = COLORS[one.color % COLORS.len()];
        let at = |p: &[f64; 3]| (p[0], p[1]);
        let line = one.points.iter().map(at);
        let width = if one.plain { 1 } else { 2 };
        let drawn = if one.dashed {
            chart.draw_series(DashedLineSeries::new(line, 5, 4, color.stroke_width(width)))?
        } else {
            chart.draw_series(LineSeries::new(line, color.stroke_width(width)))?
        };
        // The legend shows the line as it is drawn: two dashes and the gap between them, or the whole.
        let ends = if one.dashed { [6, 10] } else { [8, 8] };
        drawn.label(&one.name).legend(move |(x, y)| {
            let stroke = color.stroke_width(2);
            EmptyElement::at((x, y))
                + PathElement::new(vec![(0, 0), (ends[0], 0)], stroke)
                + PathElement::new(vec![(ends[1], 0), (16, 0)], stroke)
        });
        if !one.plain {
            chart.draw_series(
                one.points
                    .iter()
                    .map(|p| Circle::new(at(p), 3, color.filled())),
            )?;
            let errors = one.points.iter().filter(|p| p[2] > 0.0).map(|p| {
                ErrorBar::new_vertical(
                    p[0],
                    p[1] - p[2],
                    p[1],
                    p[1] + p[2],
                    color.stroke_width(1),
                    4,
                )
            });
            chart.draw_series(errors)?;
        }
    }
    if series.len() > 1 {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .label_font(text)
            .border_style(TRANSPARENT)
            .draw()?;
    }
    root.present()?;
    Ok(())
}

/// Scale of an axis: the values themselves, or their logarithms to base ten.
struct Scale {
    log: bool,
    /// The axis's ends, as places.
    low: f64,
    high: f64,
}

impl Ranged for Scale {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let part = (self.place(*value) - self.low) / (self.high - self.low);
        from + (part * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.value(self.low)..self.value(self.high)
    }
}

impl ValueFormatter<f64> for Scale {
    fn format_ext(&self, value: &f64) -> String {
        label(*value)
    }
}

impl Scale {
    /// Scale for these values, with `room` for a legend and for marks at the ends.
    fn new(log: bool, room: bool, values: impl Iterator<Item = f64> + Clone) -> Self {
        let usable = values.filter(|v| v.is_finite() && (!log || *v > 0.0));
        let (low, high) = usable
            .map(|v| if log { v.log10() } else { v })
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let low = if log {
            low.max(high - DECADES_MAX)
        } else {
            low
        };
        let span = if high > low {
            high - low
        } else if log {
            1.0
        } else {
            0.1 * high.abs().max(1e-9)
        };
        let (below, above) = if room { (0.08, 0.35) } else { (0.02, 0.02) };
        Self {
            log,
            low: low - below * span,
            high: high + above * span,
        }
    }

    fn place(&self, value: f64) -> f64 {
        let place = match (self.log, value > 0.0) {
            (false, _) => value,
            (true, true) => value.log10(),
            (true, false) => self.low,
        };
        place.clamp(self.low, self.high)
    }

    fn value(&self, place: f64) -> f64 {
        if self.log { 10_f64.powf(place) } else { place }
    }

    /// 1, 2 and 5 of each decade, or only 1 where that would be too many; multiples of such a number on a linear axis.
    fn ticks(&self) -> Vec<f64> {
        if self.log {
            let many = self.high - self.low > 3.0;
            let steps: &[f64] = if many { &[1.0] } else { &[1.0, 2.0, 5.0] };
            let decades = self.low.floor() as i32..=self.high.ceil() as i32;
            return decades
                .flat_map(|d| steps.iter().map(move |s| s * 10_f64.powi(d)))
                .filter(|v| (self.low..=self.high).contains(&v.log10()))
                .collect();
        }
        let rough = (self.high - self.low) / 5.0;
        let decade = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .map(|s| s * decade)
            .into_iter()
            .find(|s| *s >= rough)
            .unwrap_or(rough);
        let first = (self.low / step).ceil() as i64;
        (first..)
            .map(|i| i as f64 * step)
            .take_while(|v| *v <= self.high)
            .collect()
    }
}

/// Formats a tick's value with enough digits to tell ticks apart, and without rounding errors.
fn label(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e6).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(log: bool, low: f64, high: f64) -> Scale {
        Scale { log, low, high }
    }

    #[test]
    fn ticks_are_round_numbers() {
        let labels = |s: Scale| -> Vec<String> { s.ticks().iter().map(|t| label(*t)).collect() };
        assert_eq!(
            labels(scale(true, -3.1, -1.2)).join(" "),
            "0.001 0.002 0.005 0.01 0.02 0.05"
        );
        assert_eq!(labels(scale(false, 0.93, 1.06)).join(" "), "0.95 1 1.05");
        assert_eq!(
            labels(scale(true, 0.0, 4.0)).join(" "),
            "1 10 100 1000 10000"
        );
    }

    #[test]
    fn nothing_to_show_is_an_empty_plot_and_zero_lies_at_the_foot_of_a_logarithm() {
        let empty = Scale::new(true, true, std::iter::empty());
        assert!(empty.low < empty.high);
        let some = Scale::new(true, true, [1.0, 10.0].into_iter());
        assert_eq!(some.place(0.0), some.low);
    }
}
