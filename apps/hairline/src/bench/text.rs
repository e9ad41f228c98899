//! The figures in words: the blocks of the table, which terminal and document share, and the terminal's output.

use std::io::{self, Write};

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};

use super::figures::{
    Cell, CellError, Columns, Curve, Figures, Off, Outcome, Point, Row, Spread, Whose,
};
use crate::failure::Failure;

/// A row of the talk's table as a table of its own: zooms across, methods down.
pub struct Block {
    pub row: Row,
    pub zooms: Vec<f64>,
    pub lines: Vec<Line>,
}

/// A label and a text for each zoom.
pub struct Line {
    pub label: String,
    pub texts: Vec<String>,
    /// Whether it says the most: set in bold.
    pub strong: bool,
}

/// What stands where nothing was measured.
pub const NOTHING: &str = "–";
/// Behind times that were scaled.
pub const SCALED: &str = "*";

impl Figures {
    /// The cell of a method in a column; ours by its own look-up.
    pub fn cell(&self, row: Row, zoom: f64, whose: Whose, columns: Columns) -> Option<&Cell> {
        let lookup = match whose {
            Whose::Published => lookup_name(columns),
            Whose::Ours | Whose::AtPixels | Whose::Grids => self.own_lookup()?,
        };
        self.cell_by(row, zoom, whose, columns.antialiasing(), lookup)
    }

    fn cell_by(
        &self,
        row: Row,
        zoom: f64,
        whose: Whose,
        antialiasing: bool,
        lookup: &str,
    ) -> Option<&Cell> {
        self.table.iter().find(|cell| {
            cell.row == row
                && cell.zoom == zoom
                && cell.method == whose
                && cell.antialiasing == antialiasing
                && cell.lookup == lookup
        })
    }

    /// Our look-up where no column asks for another: that with anti-aliasing.
    fn own_lookup(&self) -> Option<&'static str> {
        let mut ours = self.table.iter().filter(|c| c.method == Whose::Ours);
        ours.find(|c| c.antialiasing).map(|c| c.lookup)
    }

    /// Time of the published method over ours.
    pub fn speedup(&self, row: Row, zoom: f64, columns: Columns) -> Option<f64> {
        let ms = |whose| Some(self.cell(row, zoom, whose, columns)?.outcome.ms()?.median);
        Some(ms(Whose::Published)? / ms(Whose::Ours)?)
    }

    /// Error of the published method over ours.
    pub fn error_ratio(&self, row: Row, zoom: f64, columns: Columns) -> Option<f64> {
        let error = |whose| self.cell(row, zoom, whose, columns)?.error.as_ref();
        let (published, ours) = (error(Whose::Published)?, error(Whose::Ours)?);
        // Of an error that is lost in the noise no more is known than that.
        let least = ours.relative_rms.max(ours.standard_error);
        (least > 0.0).then(|| published.relative_rms / least)
    }

    /// The table's rows, block by block.
    pub fn blocks(&self) -> Vec<Block> {
        let rows = [Row::Intersection, Row::Sphere, Row::Triangle, Row::Scene];
        rows.into_iter()
            .filter(|row| self.table.iter().any(|cell| cell.row == *row))
            .map(|row| self.block(row))
            .collect()
    }

    fn block(&self, row: Row) -> Block {
        let mut zooms: Vec<f64> = Vec::new();
        for cell in self.table.iter().filter(|cell| cell.row == row) {
            if !zooms.contains(&cell.zoom) {
                zooms.push(cell.zoom);
            }
        }
        let mut block = Block {
            row,
            zooms,
            lines: Vec::new(),
        };
        let lit = self.table.iter().any(|c| c.row == row && c.error.is_some());
        let own = self.own_lookup().unwrap_or_default();
        for columns in Columns::ALL {
            let name = columns.name();
            let published = |zoom| self.cell(row, zoom, Whose::Published, columns);
            let ours = |zoom| self.cell(row, zoom, Whose::Ours, columns);
            block.push(format!("published, {name}"), |zoom| time(published(zoom)));
            if row != Row::Scene {
                block.push("the talk, GTX 970M".to_owned(), |zoom| {
                    published(zoom)?.talk_ms.map(|ms| format!("{ms:.1}"))
                });
            }
            let lookup = lookup_name(columns);
            if !columns.antialiasing() && lookup != own {
                let same = |zoom| self.cell_by(row, zoom, Whose::Ours, false, lookup);
                block.push(format!("ours, {name}"), |zoom| time(same(zoom)));
            }
            let aa = if columns.antialiasing() { "on" } else { "off" };
            block.push(format!("ours, AA {aa}, {own}"), |zoom| time(ours(zoom)));
            block.push_strong("published over ours, time".to_owned(), |zoom| {
                self.speedup(row, zoom, columns).map(|r| format!("{r:.1}"))
            });
            if !lit {
                continue;
            }
            for (whose, of) in [("published", &published as Of), ("ours", &ours)] {
                block.push(format!("error of the scratches, {whose}"), |zoom| {
                    let error = error(of, zoom)?;
                    Some(format!(
                        "{} ± {} %",
                        digits(100.0 * error.relative_rms),
                        digits(100.0 * error.standard_error)
                    ))
                });
                block.push(format!("mean over the reference's, {whose}"), |zoom| {
                    Some(format!("{:.3}", error(of, zoom)?.mean_ratio))
                });
            }
            block.push("published over ours, error".to_owned(), |zoom| {
                self.error_ratio(row, zoom, columns).map(digits)
            });
        }
        block
    }
}

impl Block {
    fn push(&mut self, label: String, text: impl Fn(f64) -> Option<String>) {
        let texts = self.zooms.iter().map(|zoom| text(*zoom));
        let texts: Vec<String> = texts
            .map(|text| text.unwrap_or_else(|| NOTHING.to_owned()))
            .collect();
        self.lines.push(Line {
            label,
            texts,
            strong: false,
        });
    }

    fn push_strong(&mut self, label: String, text: impl Fn(f64) -> Option<String>) {
        self.push(label, text);
        if let Some(line) = self.lines.last_mut() {
            line.strong = true;
        }
    }
}

/// The cell of a zoom.
type Of<'a, 'b> = &'b dyn Fn(f64) -> Option<&'a Cell>;

fn error<'a>(of: Of<'a, '_>, zoom: f64) -> Option<&'a CellError> {
    of(zoom)?.error.as_ref()
}

fn lookup_name(columns: Columns) -> &'static str {
    match columns {
        Columns::PointTriangles => "triangles",
        Columns::PointBvh | Columns::Filtered => "bvh",
    }
}

fn time(cell: Option<&Cell>) -> Option<String> {
    Some(time_of(&cell?.outcome))
}

fn time_of(outcome: &Outcome) -> String {
    let mark = if outcome.scaled() { SCALED } else { "" };
    outcome.ms().map_or_else(
        || "refused".to_owned(),
        |ms| format!("{}{mark}", spread(ms, digits)),
    )
}

fn spread(Spread { median, quartiles }: Spread, digits: impl Fn(f64) -> String) -> String {
    let [low, high] = quartiles.map(&digits);
    format!("{} ({low} to {high})", digits(median))
}

pub const OFF_HEADER: [&str; 3] = ["", "ms", "over without"];

pub fn off_lines(off: &Off) -> [Vec<String>; 3] {
    off.lines().map(|(name, outcome, ratio)| {
        let ratio = ratio.map(|ratio| spread(ratio, |v| format!("{v:.3}")));
        vec![
            name.to_owned(),
            time_of(outcome),
            ratio.unwrap_or_else(|| NOTHING.to_owned()),
        ]
    })
}

/// Three digits.
pub fn digits(value: f64) -> String {
    if !value.is_finite() {
        return NOTHING.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 3.0) as usize;
    format!("{value:.decimals$}")
}

/// Prints to stdout.
pub fn print(figures: &Figures) -> Result<(), Failure> {
    match write(&mut io::stdout().lock(), figures) {
        // Somebody downstream has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| Failure::Work(error.into())),
    }
}

fn write(out: &mut impl Write, figures: &Figures) -> io::Result<()> {
    writeln!(out, "{}", figures.machine.in_words())?;
    let clock = if figures.machine.device_clock {
        "by the device's clock"
    } else {
        "from the call to the end of the wait"
    };
    for block in figures.blocks() {
        let [width, height] = figures.size_px;
        let name = block.row.name();
        writeln!(
            out,
            "\n{name}, {width} x {height}, ms {clock}, median (quartiles)"
        )?;
        let mut header = vec![String::new()];
        header.extend(block.zooms.iter().map(|zoom| format!("{zoom}x")));
        let mut table = table(header);
        for line in block.lines {
            let texts = std::iter::once(line.label).chain(line.texts);
            table.add_row(texts);
        }
        align(&mut table);
        writeln!(out, "{table}")?;
    }
    for curve in &figures.scaling {
        writeln!(out, "\n{}, ms {clock}", curve.along)?;
        let mut table = table(curve_header(curve));
        for line in curve_lines(curve) {
            table.add_row(line);
        }
        align(&mut table);
        writeln!(out, "{table}")?;
    }
    if let Some(off) = &figures.off {
        writeln!(out, "\nwithout scratches, ms {clock}")?;
        let mut table = table(OFF_HEADER.map(str::to_owned).to_vec());
        for line in off_lines(off) {
            table.add_row(line);
        }
        align(&mut table);
        writeln!(out, "{table}")?;
    }
    let outcomes = || {
        let cells = figures.table.iter().map(|cell| &cell.outcome);
        let points = figures.scaling.iter().flat_map(|curve| &curve.points);
        let off = figures.off.iter().flat_map(|off| off.lines());
        cells
            .chain(points.map(|point| &point.outcome))
            .chain(off.map(|(_, outcome, _)| outcome))
    };
    if outcomes().any(Outcome::scaled) {
        writeln!(
            out,
            "\n{SCALED} measured on some rows, spread evenly, and scaled to all"
        )?;
    }
    for reason in refusals(figures) {
        writeln!(out, "refused: {reason}")?;
    }
    Ok(())
}

/// Why cells were refused, each reason once.
pub fn refusals(figures: &Figures) -> Vec<String> {
    let mut reasons: Vec<String> = Vec::new();
    let mut add = |whose: Whose, what: String, outcome: &Outcome| {
        if let Outcome::Refused(reason) = outcome {
            reasons.push(format!("{}, {what}: {reason}", whose.name()));
        }
    };
    for cell in &figures.table {
        let aa = if cell.antialiasing { "on" } else { "off" };
        let what = format!(
            "{}, {}x, AA {aa}, {}",
            cell.row.name(),
            cell.zoom,
            cell.lookup
        );
        add(cell.method, what, &cell.outcome);
    }
    for curve in &figures.scaling {
        for point in &curve.points {
            add(
                point.method,
                format!("{} {}", point.x, curve.along),
                &point.outcome,
            );
        }
    }
    for (name, outcome, _) in figures.off.iter().flat_map(Off::lines) {
        add(Whose::Ours, name.to_owned(), outcome);
    }
    reasons
}

/// The series of a curve, in the order of its columns.
pub fn series(curve: &Curve) -> Vec<(Whose, bool)> {
    let mut series = Vec::new();
    for point in &curve.points {
        let one = (point.method, point.antialiasing);
        if !series.contains(&one) {
            series.push(one);
        }
    }
    series
}

/// "published, AA on"
pub fn series_name((whose, antialiasing): (Whose, bool)) -> String {
    let aa = if antialiasing { "on" } else { "off" };
    format!("{}, AA {aa}", whose.name())
}

pub fn curve_header(curve: &Curve) -> Vec<String> {
    let x = match curve.along {
        "resolution" => "pixels",
        along => along,
    };
    let mut header = vec![x.to_owned()];
    header.extend(series(curve).into_iter().map(series_name));
    header.extend(ratios(curve).map(|(a, b)| format!("{} over {}, AA on", a.name(), b.name())));
    header
}

/// What is held against what.
fn ratios(curve: &Curve) -> impl Iterator<Item = (Whose, Whose)> {
    let there = series(curve);
    let pairs = [
        (Whose::Published, Whose::Ours),
        (Whose::AtPixels, Whose::Ours),
        (Whose::Ours, Whose::Grids),
    ];
    pairs
        .into_iter()
        .filter(move |(a, b)| there.contains(&(*a, true)) && there.contains(&(*b, true)))
}

pub fn curve_lines(curve: &Curve) -> Vec<Vec<String>> {
    let mut xs: Vec<f64> = Vec::new();
    for point in &curve.points {
        if !xs.contains(&point.x) {
            xs.push(point.x);
        }
    }
    xs.into_iter()
        .map(|x| {
            let at = |one: (Whose, bool)| -> Option<&Point> {
                let mut points = curve.points.iter();
                points.find(|p| p.x == x && (p.method, p.antialiasing) == one)
            };
            let ms = |one| Some(at(one)?.outcome.ms()?.median);
            let mut line = vec![format!("{x}")];
            for one in series(curve) {
                let mark = at(one).is_some_and(|p| p.outcome.scaled());
                line.push(match ms(one) {
                    Some(ms) => format!("{}{}", digits(ms), if mark { SCALED } else { "" }),
                    None => "refused".to_owned(),
                });
            }
            line.extend(ratios(curve).map(|(a, b)| {
                let ratio = ms((a, true)).zip(ms((b, true)));
                ratio.map_or_else(|| NOTHING.to_owned(), |(a, b)| format!("{:.1}", a / b))
            }));
            line
        })
        .collect()
}

fn table(header: Vec<String>) -> Table {
    let rule = LineStyle::none().fill('\u{2500}').junction('\u{2500}');
    let mut table = Table::new();
    table
        .load_style(TableStyle::new().header_separator(rule))
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(header);
    table
}

fn align(table: &mut Table) {
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
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
}
