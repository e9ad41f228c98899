//! The curves as SVG files.

use anyhow::anyhow;
use hairline_plot::{Axis, Series, plot};

use super::figures::{Columns, Curve, Figures, Row, Whose};
use super::text::{series, series_name};
use crate::failure::Failure;

/// A plot with the name that its file ends in.
pub struct Plot {
    pub name: String,
    pub title: &'static str,
    pub svg: String,
}

/// Whatever was measured at more than one place.
pub fn draw(figures: &Figures) -> Result<Vec<Plot>, Failure> {
    let mut plots = Vec::new();
    if let Some(plot) = zooms(figures)? {
        plots.push(plot);
    }
    for curve in figures.scaling.iter().filter(|c| c.points.len() > 1) {
        plots.push(along(curve)?);
    }
    Ok(plots)
}

/// With anti-aliasing, over the zoom.
fn zooms(figures: &Figures) -> Result<Option<Plot>, Failure> {
    let mut series = Vec::new();
    for (i, (row, whose)) in [
        (Row::Sphere, Whose::Published),
        (Row::Triangle, Whose::Published),
        (Row::Sphere, Whose::Ours),
        (Row::Triangle, Whose::Ours),
    ]
    .into_iter()
    .enumerate()
    {
        let points: Vec<[f64; 3]> = super::talk::ZOOMS
            .into_iter()
            .filter_map(|zoom| {
                let cell = figures.cell(row, zoom, whose, Columns::Filtered)?;
                Some([zoom, cell.outcome.ms()?.median, 0.0])
            })
            .collect();
        let name = format!("{}, {}", series_name((whose, true)), row.name());
        let one = Series::new(&name, i % 2, points.into_iter());
        series.push(if whose == Whose::Ours {
            one.dashed()
        } else {
            one
        });
    }
    if series.iter().all(|one| one.points.len() < 2) {
        return Ok(None);
    }
    Ok(Some(Plot {
        name: "zoom".to_owned(),
        title: "Time over the zoom",
        svg: svg("zoom", &series)?,
    }))
}

fn along(curve: &Curve) -> Result<Plot, Failure> {
    let lines: Vec<Series> = series(curve)
        .into_iter()
        .map(|one| {
            let (whose, antialiasing) = one;
            let points = curve
                .points
                .iter()
                .filter(|p| (p.method, p.antialiasing) == one)
                .filter_map(|p| Some([p.x, p.outcome.ms()?.median, 0.0]));
            let line = Series::new(&series_name(one), whose as usize, points);
            if antialiasing { line } else { line.dashed() }
        })
        .collect();
    let (axis, title) = match curve.along {
        "scratches" => ("scratches", "Time over the number of scratches"),
        "zoom" => ("zoom", "Time over the zoom, a million scratches"),
        "lights" => ("lights", "Time over the number of lights"),
        _ => ("pixels", "Time over the size"),
    };
    Ok(Plot {
        // The table has a plot over the zoom too.
        name: match curve.along {
            "zoom" => "many-scratches".to_owned(),
            along => along.to_owned(),
        },
        title,
        svg: svg(axis, &lines)?,
    })
}

fn svg(axis: &str, series: &[Series]) -> Result<String, Failure> {
    let log = |name| Axis { name, log: true };
    plot([log(axis), log("ms a picture")], series)
        .map_err(|error| Failure::Work(anyhow!("{error}")))
}
