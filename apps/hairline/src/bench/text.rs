//! Figures as a document of Markdown tables, which can be read in a terminal as well.

use std::fmt::Write as _;

use hairline_cpu::closed_form::Counts;

use super::figures::{Cell, Curve, Figures, Outcome, TableRow};
use super::methods::BenchMethod;
use super::stage::TALK_SCRATCHES;

/// Text of a cell where nothing was measured.
const NOTHING: &str = "–";
/// Mark of times that were scaled.
const SCALED: &str = "*";

/// Writes the document.
pub fn document(figures: &Figures) -> String {
    let mut text = String::new();
    // A string takes everything.
    let _ = head(&mut text, figures)
        .and_then(|()| table(&mut text, figures))
        .and_then(|()| counts(&mut text, figures))
        .and_then(|()| curves(&mut text, figures))
        .and_then(|()| refusals(&mut text, figures));
    text
}

fn head(text: &mut String, figures: &Figures) -> std::fmt::Result {
    let machine = &figures.machine;
    let [width, height] = figures.size_px;
    writeln!(
        text,
        "Hairline {}, `hairline bench`{}, on {}. The {}, {width} x {height}, {} scratches{}. Milliseconds a picture, one sample a pixel, medians, {}; \
         methods take turns. {SCALED}: measured on some rows, spread evenly, and scaled to all.",
        figures.hairline,
        if figures.quick { " --quick" } else { "" },
        machine.in_words(),
        figures.scene,
        figures.scratches,
        if figures.scene == "bench scene" {
            format!(
                ", about {} within the coherence window of each point",
                digits(3.0 * f64::from(figures.scratches) / f64::from(TALK_SCRATCHES))
            )
        } else {
            String::new()
        },
        if machine.device_clock {
            "by the device's own clock around its passes"
        } else {
            "from the call to the end of the wait"
        }
    )
}

fn table(text: &mut String, figures: &Figures) -> std::fmt::Result {
    for row in TableRow::ALL {
        let cells: Vec<&Cell> = figures.table.iter().filter(|c| c.row == row).collect();
        if cells.is_empty() {
            continue;
        }
        let cell = |method: BenchMethod, zoom: f64| {
            let mut cells = cells.iter();
            cells.find(|c| c.way == method && c.zoom == zoom)
        };
        let mut zooms: Vec<f64> = cells.iter().map(|c| c.zoom).collect();
        zooms.dedup_by(|a, b| a == b);
        zooms.truncate(cells.len() / BenchMethod::ALL.len());
        let is_lit = cells.iter().any(|c| c.error.is_some());
        let ms = |method, zoom| Some(cell(method, zoom)?.outcome.ms()?.median);
        let time = |method, zoom| cell(method, zoom).map(|c| time(&c.outcome));
        let ratio = |method, zoom| Some(digits(ms(method, zoom)? / ms(BenchMethod::Ours, zoom)?));
        let error = |method, zoom| {
            let error = cell(method, zoom)?.error.as_ref()?;
            let [rms, noise] =
                [error.relative_rms, error.standard_error].map(|e| digits(100.0 * e));
            Some(format!("{rms} ± {noise} %"))
        };
        let talk = |method, zoom| Some(digits(cell(method, zoom)?.talk_ms?));

        let mut header = vec![row.name().to_owned()];
        let columns: &[&str] = match is_lit {
            true => &["ms", "over ours", "error"],
            false => &["ms", "over ours"],
        };
        header.extend(
            columns
                .iter()
                .flat_map(|name| zooms.iter().map(move |zoom| format!("{name}, {zoom}x"))),
        );
        let mut lines = Vec::new();
        for method in BenchMethod::ALL {
            let of = |figure: &dyn Fn(BenchMethod, f64) -> Option<String>| -> Vec<String> {
                let texts = zooms.iter().map(|zoom| figure(method, *zoom));
                texts
                    .map(|text| text.unwrap_or_else(|| NOTHING.to_owned()))
                    .collect()
            };
            let mut line = vec![method.name().to_owned()];
            line.extend(of(&time));
            line.extend(of(&ratio));
            if is_lit {
                line.extend(of(&error));
            }
            lines.push(line);
            if zooms.iter().any(|zoom| talk(method, *zoom).is_some()) {
                let mut line = vec!["the talk, GTX 970M".to_owned()];
                line.extend(of(&talk));
                line.resize(header.len(), String::new());
                lines.push(line);
            }
        }
        writeln!(text)?;
        markdown(text, &header, &lines)?;
    }
    if figures.table.iter().any(|cell| cell.error.is_some()) {
        writeln!(
            text,
            "\nError: that of the scratch layer on a crop about the rim of the lamp's reflection, root mean square difference from the \
             separable Monte Carlo beyond its noise, over the reference's root mean square. Without anti-aliasing the truth is \
             that of the pixel's middle point, with it the mean over the pixel's Gaussian; ours always has it. The talk's times ({}) are of \
             another scene on another machine: their ratios can be compared, not their sizes.",
            figures.talk
        )?;
    }
    Ok(())
}

/// Table of the work of our method in each cell.
fn counts(text: &mut String, figures: &Figures) -> std::fmt::Result {
    let lines: Vec<Vec<String>> = figures
        .table
        .iter()
        .filter_map(|cell| {
            let Counts {
                segments,
                entries,
                tests,
                pairs,
                asked,
                lit,
            } = cell.counts?;
            let mut line = vec![format!("{}, {}x", cell.row.name(), cell.zoom)];
            line.extend([segments, entries, tests, pairs, asked, lit].map(|n| n.to_string()));
            Some(line)
        })
        .collect();
    if lines.is_empty() {
        return Ok(());
    }
    writeln!(text)?;
    let header = [
        "ours, a picture",
        "segments projected",
        "entries of tile lists",
        "(pixel, segment) tests",
        "pairs",
        "(pair, light) asked",
        "lit",
    ];
    markdown(text, &header.map(str::to_owned), &lines)
}

fn curves(text: &mut String, figures: &Figures) -> std::fmt::Result {
    for curve in &figures.curves {
        let about = match curve.along {
            "scratches" => {
                "Under a sphere, at 1x, 2.4 mm long: 100,000 lie as densely as the table's 10,000."
            }
            "zoom" => {
                "Scratches of 2.4 mm under a sphere, a million unless --scratches says otherwise. The disk fills a hundredth of the picture at \
                 0.1x and all of it from 2x on."
            }
            "lights" => {
                "Spheres and triangles by turns, over a radian about the mirror direction, at 1x."
            }
            _ => "Under a sphere, at 1x and the same field of view: more pixels are smaller ones.",
        };
        writeln!(text, "\n{about}\n")?;
        let (header, lines) = lines(curve);
        markdown(text, &header, &lines)?;
    }
    Ok(())
}

fn lines(curve: &Curve) -> (Vec<String>, Vec<Vec<String>>) {
    let there = |method: &BenchMethod| curve.points.iter().any(|point| point.way == *method);
    let methods: Vec<BenchMethod> = BenchMethod::ALL.into_iter().filter(there).collect();
    let mut header = vec![curve.along.to_owned()];
    header.extend(
        methods
            .iter()
            .map(|method| format!("{}, ms", method.name())),
    );
    let is_compared = methods.contains(&BenchMethod::Filtered);
    header.extend(is_compared.then(|| "published over ours".to_owned()));
    header.push("pairs".to_owned());
    header.push("ns a pair".to_owned());
    let mut xs: Vec<f64> = curve.points.iter().map(|point| point.x).collect();
    xs.dedup();
    let lines = xs.into_iter().map(|x| {
        let at = |method: BenchMethod| {
            let mut points = curve.points.iter();
            points.find(|point| point.x == x && point.way == method)
        };
        let ms = |method| Some(at(method)?.outcome.ms()?.median);
        let ours = || Some((ms(BenchMethod::Ours)?, at(BenchMethod::Ours)?.counts?.pairs));
        let or_nothing = |text: Option<String>| text.unwrap_or_else(|| NOTHING.to_owned());
        let mut line = vec![format!("{x}")];
        line.extend(
            methods
                .iter()
                .map(|method| or_nothing(at(*method).map(|p| time(&p.outcome)))),
        );
        if is_compared {
            let ratio = ms(BenchMethod::Filtered).zip(ms(BenchMethod::Ours));
            line.push(or_nothing(ratio.map(|(a, b)| digits(a / b))));
        }
        line.push(or_nothing(ours().map(|(_, pairs)| pairs.to_string())));
        line.push(or_nothing(
            ours().map(|(ms, pairs)| digits(1e6 * ms / pairs as f64)),
        ));
        line
    });
    let lines = lines.collect();
    (header, lines)
}

/// Lists the reasons why there are no times, each once.
fn refusals(text: &mut String, figures: &Figures) -> std::fmt::Result {
    let cells = figures.table.iter().map(|cell| {
        let what = format!("{}, {}x", cell.row.name(), cell.zoom);
        (what, cell.way, &cell.outcome)
    });
    let points = figures.curves.iter().flat_map(|curve| {
        let what = |x: f64| format!("{x} {}", curve.along);
        curve
            .points
            .iter()
            .map(move |p| (what(p.x), p.way, &p.outcome))
    });
    for (what, method, outcome) in cells.chain(points) {
        if let Outcome::Refused(reason) = outcome {
            writeln!(text, "\nRefused: {what}, {}: {reason}", method.name())?;
        }
    }
    Ok(())
}

fn time(outcome: &Outcome) -> String {
    let mark = if outcome.scaled() { SCALED } else { "" };
    outcome.ms().map_or_else(
        || "refused".to_owned(),
        |ms| format!("{}{mark}", digits(ms.median)),
    )
}

/// Three digits.
fn digits(value: f64) -> String {
    if !value.is_finite() {
        return NOTHING.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 3.0) as usize;
    format!("{value:.decimals$}")
}

/// A table, its columns as wide as they must be: the first on the left, the others on the right.
fn markdown(text: &mut String, header: &[String], lines: &[Vec<String>]) -> std::fmt::Result {
    let all = || std::iter::once(header).chain(lines.iter().map(Vec::as_slice));
    let width = |i: usize| {
        let widths = all().map(|line| line[i].chars().count());
        widths.max().unwrap_or(0).max(4)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    for (n, line) in all().enumerate() {
        for (i, (cell, &width)) in line.iter().zip(&widths).enumerate() {
            match i {
                0 => write!(text, "| {cell:<width$} |")?,
                _ => write!(text, " {cell:>width$} |")?,
            }
        }
        writeln!(text)?;
        if n == 0 {
            for (i, &width) in widths.iter().enumerate() {
                match i {
                    0 => write!(text, "|{}|", "-".repeat(width + 2))?,
                    _ => write!(text, "{}:|", "-".repeat(width + 1))?,
                }
            }
            writeln!(text)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_are_enough() {
        for (value, text) in [
            (0.0, "0"),
            (0.01234, "0.012"),
            (1.2345, "1.23"),
            (12.345, "12.3"),
            (123.45, "123"),
            (12345.6, "12346"),
            (f64::INFINITY, NOTHING),
        ] {
            assert_eq!(digits(value), text);
        }
    }

    #[test]
    fn a_table_is_markdown() {
        let mut text = String::new();
        let words = |line: [&str; 2]| line.map(str::to_owned).to_vec();
        let lines = [words(["ours", "1.5"])];
        markdown(&mut text, &words(["method", "ms"]), &lines).unwrap();
        assert_eq!(
            text,
            "| method |   ms |\n|--------|-----:|\n| ours   |  1.5 |\n"
        );
    }
}
