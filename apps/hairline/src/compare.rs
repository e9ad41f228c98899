//! `hairline compare`: how far a picture is from a reference, in figures and in a report to look at.

mod figure;
pub mod limits;
mod report;
mod side;
mod table;

use std::path::Path;

use anyhow::anyhow;
use hairline_console::{print, tell};
use hairline_document::inputs::Input;
use hairline_image::metrics::{self, Comparison, Problem};
use hairline_image::{Display, Layers};

use self::limits::Finding;
use crate::cli;
use crate::progress::Progress;
use crate::scene_file::refuse_inputs;
use hairline_render::failure::Failure;
use side::Side;

/// Reads, compares, prints, writes the report, and holds the figures to the limits.
pub fn run(arguments: &cli::Compare) -> Result<(), Failure> {
    // Before the work, as for a render.
    let output = arguments.output.as_deref().map(check_output).transpose()?;
    if let Some(output) = output {
        for (what, input) in [
            ("the picture", &arguments.a),
            ("the reference", &arguments.b),
        ] {
            let input = Input {
                what: what.to_owned(),
                path: input.clone(),
            };
            refuse_inputs(&[output], None, &[input])?;
        }
    }
    let progress = Progress::start("reading");
    let a = Side::read(&arguments.a, &arguments.layers)?;
    let b = Side::read(&arguments.b, &arguments.layers)?;
    let display = Display {
        exposure_ev: arguments.exposure,
        tone_map: arguments.tone_map,
    };
    progress.restart("comparing");
    let comparison = metrics::compare(&a.layers, &b.layers, &display, None);
    drop(progress);
    refuse_the_incomparable(&a, &b, &comparison)?;
    for side in [&a, &b] {
        if let Some(window) = side.layers.window {
            tell(format_args!("note: {}: {window}", side.path.display()));
        }
    }
    for problem in &comparison.problems {
        tell(format_args!("warning: {problem}"));
    }

    if arguments.json {
        print(&format!(
            "{:#}\n",
            table::json(&a, &b, &display, &comparison)
        ))?;
    } else {
        print(&table::text(&a, &b, &comparison))?;
    }
    if let Some(path) = output {
        let page = report::page(&a, &b, &display, &comparison)?;
        hairline_image::output::write_atomically(path, page.as_bytes())?;
    }
    hold_to_limits(arguments, &comparison)
}

fn check_output(path: &Path) -> Result<&Path, Failure> {
    let is_html = path.extension().is_some_and(|ending| {
        ending.eq_ignore_ascii_case("html") || ending.eq_ignore_ascii_case("htm")
    });
    if !is_html {
        return Err(Failure::Input(anyhow!(
            "{}: the report is a web page: end its name in .html",
            path.display()
        )));
    }
    hairline_image::output::check_writable(path)?;
    Ok(path)
}

/// Sizes that differ, and files without a layer in common.
fn refuse_the_incomparable(a: &Side, b: &Side, comparison: &Comparison) -> Result<(), Failure> {
    let (a_name, b_name) = (a.path.display(), b.path.display());
    for problem in &comparison.problems {
        let refusal = match problem {
            Problem::SizesDiffer { a, b } => anyhow!(
                "{a_name} has {} x {} pixels, {b_name} has {} x {}: render one of them again with `--size {}x{}` or \
                 `--size {}x{}` to compare them",
                a[0],
                a[1],
                b[0],
                b[1],
                b[0],
                b[1],
                a[0],
                a[1]
            ),
            Problem::NothingInCommon => anyhow!(
                "{a_name} and {b_name} have no such layer in common: the first has {}, the second {}; layers are in .exr files alone",
                names(&a.layers),
                names(&b.layers)
            ),
            _ => continue,
        };
        return Err(Failure::Input(refusal));
    }
    Ok(())
}

fn names(layers: &Layers) -> String {
    let names: Vec<&str> = layers.held.iter().map(|held| held.layer.name()).collect();
    if names.is_empty() {
        return "none".to_owned();
    }
    names.join(", ")
}

/// One line for everything that is beyond its limit.
fn hold_to_limits(arguments: &cli::Compare, comparison: &Comparison) -> Result<(), Failure> {
    let mut broken = Vec::new();
    let mut limits = arguments
        .fail_above
        .iter()
        .chain(&arguments.fail_below)
        .peekable();
    if limits.peek().is_none() {
        return Ok(());
    }
    for limit in limits {
        match limit.judge(&comparison.layers) {
            Finding::Kept => {}
            Finding::Broken(how) => broken.push(how),
            Finding::Absent(why) => return Err(Failure::Input(anyhow!(why))),
        }
    }
    let not_finite = |problem: &&Problem| matches!(problem, Problem::NotFinite { .. });
    broken.extend(
        comparison
            .problems
            .iter()
            .filter(not_finite)
            .map(Problem::to_string),
    );
    if broken.is_empty() {
        return Ok(());
    }
    Err(Failure::Work(anyhow!(broken.join("; "))))
}
