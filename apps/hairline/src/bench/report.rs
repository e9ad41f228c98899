//! The figures as a Markdown document, with its plots beside it.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::anyhow;
use hairline_image::output::write_atomically;

use super::counts::{Counts, work};
use super::figures::{Columns, Figures, Row, Whose};
use super::plots::{self, Plot};
use super::stage::TALK_SCRATCHES;
use super::text::{
    NOTHING, OFF_HEADER, SCALED, curve_header, curve_lines, digits, off_lines, refusals,
};
use crate::failure::Failure;

/// What ours should gain on the published method at 1x, set down before anything was measured.
const EXPECTED: [(Row, Columns, f64); 4] = [
    (Row::Triangle, Columns::PointBvh, 5.0),
    (Row::Triangle, Columns::Filtered, 8.0),
    (Row::Sphere, Columns::PointBvh, 3.0),
    (Row::Sphere, Columns::Filtered, 4.0),
];

/// Parts of a limit below which it is not what a renderer waits for.
const NEAR_A_LIMIT: f64 = 0.25;

/// Refuses what does not end in .md: the plots are named after it.
pub fn check_name(path: &Path) -> Result<(), Failure> {
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("md") => Ok(()),
        _ => Err(Failure::Input(anyhow!(
            "{}: the report is Markdown, its plots are .svg files beside it; end its name in .md",
            path.display()
        ))),
    }
}

/// Writes the document and its plots.
pub fn write(path: &Path, figures: &Figures) -> Result<(), Failure> {
    let plots = plots::draw(figures)?;
    let mut named = Vec::new();
    for plot in plots {
        let mut name = path.file_stem().unwrap_or_default().to_owned();
        name.push(format!("-{}.svg", plot.name));
        write_atomically(&path.with_file_name(&name), plot.svg.as_bytes())?;
        named.push((name, plot));
    }
    write_atomically(path, document(figures, &named).as_bytes())?;
    Ok(())
}

fn document(figures: &Figures, plots: &[(OsString, Plot)]) -> String {
    let mut text = String::new();
    // A string takes everything.
    let _ = head(&mut text, figures)
        .and_then(|()| table(&mut text, figures))
        .and_then(|()| findings(&mut text, figures))
        .and_then(|()| scaling(&mut text, figures))
        .and_then(|()| pictures(&mut text, plots))
        .and_then(|()| off(&mut text, figures))
        .and_then(|()| counts(&mut text, figures))
        .and_then(|()| bounds(&mut text, figures));
    text
}

fn head(text: &mut String, figures: &Figures) -> std::fmt::Result {
    let machine = &figures.machine;
    let [width, height] = figures.size_px;
    writeln!(text, "# Performance\n")?;
    writeln!(
        text,
        "Measured by Hairline {} with `hairline bench`{}, on {}.\n",
        figures.hairline,
        if figures.quick { " --quick" } else { "" },
        machine.in_words()
    )?;
    if !figures.ours.is_empty() {
        writeln!(text, "\"Ours\" is the method of `{}`.\n", figures.ours)?;
    }
    writeln!(
        text,
        "What is measured: {}, {width} x {height}, one sample a pixel, by the method of 2018 (`--method published`, section 9 of \
         [model.md](model.md)) and by ours, by turns in one run. Times are milliseconds a picture, median and quartiles of \
         several runs after a warm-up, {}. {SCALED} marks cells that were measured on some rows, spread evenly over the picture, \
         and scaled to all. The published column has the talk's parts: eight wavelengths by the approximated sine integral, its \
         six steps for each light, its blended footprint, its density mask.\n",
        if figures.scene == "bench scene" {
            format!(
                "a worn disk of steel with {} scratches of 24 mm in every direction under one lamp of 0.1 rad, about {} within the \
                 coherence window of each point (`hairline bench --write-scene FILE` writes it)",
                figures.scratches,
                digits(3.0 * f64::from(figures.scratches) / f64::from(TALK_SCRATCHES))
            )
        } else {
            figures.scene.clone()
        },
        if machine.device_clock {
            "by the device's own clock around its passes"
        } else {
            "from the call to the end of the wait"
        }
    )?;
    writeln!(
        text,
        "The error is that of the scratch layer on a crop about the rim of the lamp's reflection, with pixels of the table's size: \
         root mean square difference from the separable Monte Carlo beyond its noise, over the reference's root mean square. \
         Without anti-aliasing the truth is that of the pixel's middle point, with it the mean over the Gaussian that has the square \
         pixel's variance. The energy mask is the truth for both: what scratches take from one another does not depend on how it \
         is computed.\n"
    )?;
    writeln!(
        text,
        "The talk's own figures stand beside them ({}). They are of another scene on another machine: their ratios can be \
         compared, not their sizes.\n",
        figures.talk
    )
}

fn table(text: &mut String, figures: &Figures) -> std::fmt::Result {
    for block in figures.blocks() {
        let mut name = block.row.name().to_owned();
        name[..1].make_ascii_uppercase();
        writeln!(text, "## {name}\n")?;
        let mut header = vec!["ms".to_owned()];
        header.extend(block.zooms.iter().map(|zoom| format!("{zoom}x")));
        markdown_header(text, &header)?;
        for line in block.lines {
            let bold = if line.strong { "**" } else { "" };
            write!(text, "| {bold}{}{bold} |", line.label)?;
            for cell in line.texts {
                write!(text, " {bold}{cell}{bold} |")?;
            }
            writeln!(text)?;
        }
        writeln!(text)?;
    }
    let refused = refusals(figures);
    for reason in &refused {
        writeln!(text, "* refused: {reason}")?;
    }
    if !refused.is_empty() {
        writeln!(text)?;
    }
    Ok(())
}

fn findings(text: &mut String, figures: &Figures) -> std::fmt::Result {
    let found: Vec<_> = EXPECTED
        .iter()
        .filter_map(|(row, columns, least)| {
            Some((row, columns, least, figures.speedup(*row, 1.0, *columns)?))
        })
        .collect();
    if found.is_empty() {
        return Ok(());
    }
    writeln!(text, "## What was expected, and what was found\n")?;
    writeln!(
        text,
        "How many times faster ours is at 1x, expected before measuring, and how the errors compare:\n"
    )?;
    let header = [
        "published over ours",
        "time, expected",
        "time, found",
        "error, found",
        "",
    ];
    markdown_header(text, &header.map(str::to_owned))?;
    let (mut reached, mut missed) = (Vec::new(), Vec::new());
    for (row, columns, least, found) in found {
        let name = format!("{}, {}", row.name(), columns.name());
        let error = figures.error_ratio(*row, 1.0, *columns);
        let goal = format!("{name} ({found:.1} of {least})");
        let verdict = if found >= *least {
            reached.push(goal);
            "reached"
        } else {
            missed.push(goal);
            "not reached"
        };
        writeln!(
            text,
            "| {name} | at least {least} | {found:.1} | {} | {verdict} |",
            error.map_or_else(|| NOTHING.to_owned(), digits)
        )?;
    }
    let listed = |goals: &[String]| match goals {
        [] => "none".to_owned(),
        goals => goals.join("; "),
    };
    writeln!(
        text,
        "\nReached: {}. Not reached: {}. An error ratio above 1 means that ours errs less.",
        listed(&reached),
        listed(&missed)
    )?;
    writeln!(
        text,
        "\nWhat the talk's table shows, looked for in the published method's figures here:\n"
    )?;
    let ms = |row, zoom, columns| {
        let cell = figures.cell(row, zoom, Whose::Published, columns)?;
        Some(cell.outcome.ms()?.median)
    };
    let pairs = |one: &dyn Fn(Row, f64) -> Option<(f64, f64)>, rows: &[Row]| {
        let zooms = super::talk::ZOOMS;
        let pairs = rows
            .iter()
            .flat_map(|row| zooms.map(|zoom| one(*row, zoom)))
            .flatten();
        let pairs: Vec<(f64, f64)> = pairs.collect();
        let holds = pairs.iter().filter(|(less, more)| less < more).count();
        let ratios: Vec<String> = pairs.iter().map(|(l, m)| digits(m / l)).collect();
        format!(
            "in {holds} of {} cells (times {})",
            pairs.len(),
            ratios.join(", ")
        )
    };
    let all = Row::TALK;
    writeln!(
        text,
        "* lists for each triangle are faster than the hierarchy without anti-aliasing: {}",
        pairs(
            &|row, zoom| Some((
                ms(row, zoom, Columns::PointTriangles)?,
                ms(row, zoom, Columns::PointBvh)?
            )),
            &all
        )
    )?;
    if let Some(because) = lists_because(figures) {
        writeln!(text, "  {because}")?;
    }
    writeln!(
        text,
        "* a triangle is dearer than a sphere, without anti-aliasing: {}",
        pairs(
            &|_, zoom| Some((
                ms(Row::Sphere, zoom, Columns::PointBvh)?,
                ms(Row::Triangle, zoom, Columns::PointBvh)?
            )),
            &[Row::Triangle]
        )
    )?;
    writeln!(
        text,
        "* anti-aliasing is dearer than none, by the hierarchy: {}\n",
        pairs(
            &|row, zoom| Some((
                ms(row, zoom, Columns::PointBvh)?,
                ms(row, zoom, Columns::Filtered)?
            )),
            &all
        )
    )
}

/// What a list for each triangle saves and what it costs, by the counts.
fn lists_because(figures: &Figures) -> Option<String> {
    let of = |lookup: &str| {
        figures.counts.iter().find(|counts| {
            counts.row == Row::Sphere
                && counts.method == Whose::Published
                && !counts.antialiasing
                && counts.lookup == lookup
        })
    };
    let (lists, walk) = (of("triangles")?.per_pixel, of("bvh")?.per_pixel);
    Some(format!(
        "(a walk reads {} nodes and looks at {} segments for the {} that a pixel sees; a triangle's list spares the walk but holds {}, \
         the neighbours' pieces within reach of its edges included, since scratches are cut at the edges)",
        digits(walk.nodes),
        digits(walk.weighed),
        digits(walk.kept),
        digits(lists.weighed)
    ))
}

fn scaling(text: &mut String, figures: &Figures) -> std::fmt::Result {
    for curve in &figures.scaling {
        let (title, about) = match curve.along {
            "scratches" => (
                "Scratches",
                "Under a sphere, at 1x. They are a tenth as long as the table's, so that 100,000 lie as densely as its 10,000.",
            ),
            "zoom" => (
                "Zoom",
                "Short scratches under a sphere, a million of them unless the report's head says otherwise: from 0.1x, where the disk is a tenth as \
                 high, to 8x. A whole picture, of which the disk fills a hundredth at 0.1x and all from 2x on.",
            ),
            "lights" => (
                "Lights",
                "Spheres and triangles by turns, spread over a radian about the mirror direction; at 1x.",
            ),
            _ => (
                "Resolution",
                "Under a sphere, at 1x and the same field of view: more pixels are smaller ones.",
            ),
        };
        writeln!(text, "## {title}\n\n{about}\n")?;
        markdown_header(text, &curve_header(curve))?;
        for line in curve_lines(curve) {
            writeln!(text, "| {} |", line.join(" | "))?;
        }
        writeln!(text)?;
    }
    Ok(())
}

fn off(text: &mut String, figures: &Figures) -> std::fmt::Result {
    let Some(off) = &figures.off else {
        return Ok(());
    };
    writeln!(
        text,
        "## Without scratches\n\nThe disk at 1x under a sphere, by turns: without scratches, the same once more, and with a single scratch \
         of no depth, which changes no light. Ratios are of one turn each, median and quartiles. {}\n",
        if figures.machine.adapter.is_some() {
            "Shaders are compiled for what a scene has: without scratches there is no code for them, with one there is all of it."
        } else {
            "The CPU renderer has one code for both, and asks an object first whether it has any."
        }
    )?;
    markdown_header(text, &OFF_HEADER.map(str::to_owned))?;
    for line in off_lines(off) {
        writeln!(text, "| {} |", line.join(" | "))?;
    }
    let Some((again, one)) = off.again_over_none.zip(off.one_over_none) else {
        return writeln!(text);
    };
    let percent = |ratio: f64| digits(100.0 * (ratio - 1.0).abs());
    let [low, high] = again.quartiles;
    let noise = (high - 1.0).max(1.0 - low);
    let costs = match one.median - 1.0 {
        dearer if dearer.abs() <= noise => "nothing beyond that".to_owned(),
        dearer if dearer > 0.0 => format!("{} % more", percent(one.median)),
        _ => format!("{} % less", percent(one.median)),
    };
    writeln!(
        text,
        "\nTwo times of the same scene without scratches are {} % apart in the median, their quartiles up to {} %. With the code for \
         scratches and one to look for, a picture costs {costs}.\n",
        percent(again.median),
        digits(100.0 * noise)
    )
}

fn pictures(text: &mut String, plots: &[(OsString, Plot)]) -> std::fmt::Result {
    for (name, plot) in plots {
        writeln!(text, "![{}]({})\n", plot.title, name.to_string_lossy())?;
    }
    Ok(())
}

fn counts(text: &mut String, figures: &Figures) -> std::fmt::Result {
    if figures.counts.is_empty() {
        return Ok(());
    }
    writeln!(
        text,
        "## What is done for a pixel\n\nCounted at 1x by walks over the same index on the CPU, mean over the pixels that see the disk; what a tile's \
         pixels share is dealt out among those of them that do. {}\n",
        if figures.machine.adapter.is_some() {
            "By tiles, one walk for 8 x 8 pixels finds leaves whose segments are projected into the picture; those whose line comes near \
             the tile are its list, with a bit for every pixel that the line comes near to. A \
             pixel weighs only the segments whose bit it finds. Those with a share it keeps, asks of each light which of them its bound \
             reaches, and lights these. The published method walks, weighs and lights for each pixel on its own."
        } else {
            "The CPU renderer has no tiles: both methods walk for each pixel on its own, and ours asks of each light which segments its \
             bound reaches before it lights them."
        }
    )?;
    let mut header = vec!["a pixel".to_owned()];
    header.extend(figures.counts.iter().map(name));
    markdown_header(text, &header)?;
    let first = figures.counts[0].per_pixel.named();
    for (i, (thing, _)) in first.iter().enumerate() {
        write!(text, "| {thing} |")?;
        for counts in &figures.counts {
            write!(text, " {} |", digits(counts.per_pixel.named()[i].1))?;
        }
        writeln!(text)?;
    }
    type Of = fn(&Counts) -> f64;
    for (thing, of) in [
        ("bytes read", (|c| c.bytes) as Of),
        ("operations", |c| c.operations),
        ("operations a byte", |c| c.operations / c.bytes),
    ] {
        write!(text, "| {thing} |")?;
        for counts in &figures.counts {
            write!(text, " {} |", digits(of(counts)))?;
        }
        writeln!(text)?;
    }
    writeln!(
        text,
        "\nBytes and operations follow from the counts by this table. An operation is an addition, multiplication, comparison, \
         division or root; a sine, exponential or error function is as many as its polynomial. Estimates to a quarter or so.\n"
    )?;
    let header = ["thing", "because", "bytes", "operations"];
    markdown_header(text, &header.map(str::to_owned))?;
    for cost in work::COSTS {
        writeln!(
            text,
            "| {} | {} | {} | {} |",
            cost.thing, cost.because, cost.bytes, cost.operations
        )?;
    }
    writeln!(text)
}

fn bounds(text: &mut String, figures: &Figures) -> std::fmt::Result {
    let machine = &figures.machine;
    let [width, height] = figures.size_px;
    let pixels = f64::from(width) * f64::from(height);
    let lines: Vec<_> = figures
        .counts
        .iter()
        .filter_map(|counts| {
            let cell = figures.table.iter().find(|cell| {
                cell.row == counts.row
                    && cell.zoom == 1.0
                    && cell.method == counts.method
                    && cell.antialiasing == counts.antialiasing
                    && cell.lookup == counts.lookup
            })?;
            let seconds = 1e-3 * cell.outcome.ms()?.median;
            let a_second = 1e-9 * pixels * counts.covered / seconds;
            Some((
                counts,
                a_second * counts.operations,
                a_second * counts.bytes,
            ))
        })
        .collect();
    if lines.is_empty() {
        return Ok(());
    }
    writeln!(text, "## What bounds the time\n")?;
    let (peak, bandwidth) = (machine.peak_gflops(), machine.bandwidth_gb_s);
    let header = [
        "cell at 1x",
        "10⁹ operations/s",
        "of the peak",
        "GB/s",
        "of the memory's",
    ];
    markdown_header(text, &header.map(str::to_owned))?;
    let percent = |share: Option<f64>| {
        share.map_or_else(|| "–".to_owned(), |s| format!("{} %", digits(100.0 * s)))
    };
    for (counts, operations, bytes) in &lines {
        writeln!(
            text,
            "| {} | {} | {} | {} | {} |",
            name(counts),
            digits(*operations),
            percent(peak.map(|p| operations / p)),
            digits(*bytes),
            percent(bandwidth.map(|b| bytes / b)),
        )?;
    }
    let (Some(peak), Some(bandwidth)) = (peak, bandwidth) else {
        return writeln!(
            text,
            "\nThe adapter does not tell its peaks; hold the rates against its data sheet.\n"
        );
    };
    writeln!(
        text,
        "\nThe peak: {} threads times 8 lanes times a multiply-add at {} MHz, {} 10⁹ operations/s. The memory's: {} GB/s, by \
         summing an array of 256 MiB with all threads in this run.\n",
        machine.threads,
        machine.cpu_mhz,
        digits(peak),
        digits(bandwidth)
    )?;
    let largest =
        |of: &dyn Fn(&(&Counts, f64, f64)) -> f64| lines.iter().map(of).fold(0.0, f64::max);
    let arithmetic = largest(&|line| line.1 / peak);
    let memory = largest(&|line| line.2 / bandwidth);
    let verdict = if arithmetic.max(memory) < NEAR_A_LIMIT {
        "**Neither what is counted of bytes nor of arithmetic is near its limit.**"
    } else if memory > arithmetic {
        "**Bytes bound the time.**"
    } else {
        "**Arithmetic bounds the time, not bytes.**"
    };
    writeln!(
        text,
        "{verdict} If every byte that is counted came from memory, that would be {} % of what it gives at most; most come from caches. \
         The counted operations are {} % of the peak at most.\n",
        digits(100.0 * memory),
        digits(100.0 * arithmetic)
    )?;
    if machine.adapter.is_some() {
        writeln!(
            text,
            "What counts do not see: a software driver computes eight pixels in step, executes both sides of every branch and every loop \
             until the last of the eight is done, fetches for each of them apart, and few of the operations pair up to multiply-adds.\n"
        )?;
    } else {
        writeln!(
            text,
            "What counts do not see: the CPU renderer computes one pixel at a time in double precision, so that of the eight lanes one or \
             two are at work, and calls sines, exponentials and error functions that are exact.\n"
        )?;
    }
    Ok(())
}

fn name(counts: &Counts) -> String {
    let aa = if counts.antialiasing { "on" } else { "off" };
    let whose = counts.method.name();
    format!("{whose}, {}, AA {aa}, {}", counts.row.name(), counts.lookup)
}

fn markdown_header(text: &mut String, header: &[String]) -> std::fmt::Result {
    writeln!(text, "| {} |", header.join(" | "))?;
    writeln!(text, "|---|{}", "---:|".repeat(header.len() - 1))
}
