//! The document of the files' outcomes.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::opened::{Opened, Outcome, Source};

/// Largest number of files of one outcome that are named, the first ones.
const NAMED: usize = 12;

/// Writes all tables.
pub fn document(sources: &[Source]) -> String {
    let mut out = String::from(INTRODUCTION);
    summary(&mut out, sources);
    lacking(&mut out, sources);
    extensions(&mut out, sources);
    out.push_str(BY_EYE);
    out.push_str(FILES);
    for source in sources {
        files(&mut out, source);
    }
    out
}

const INTRODUCTION: &str = "\
# Files as people have them

Each glTF file of some public repositories, opened as `hairline render FILE` opens it and rendered 96 x 54 pixels large on the CPU, without shadows and without wear.
The files are not part of Hairline. The table is made by

    cargo lab models FOLDER...

with a folder for each repository, called `OWNER+NAME`. Files and buffers of 4 MiB and more were not in the copies that were used.
";

const BY_EYE: &str = "
## By eye

Pictures by `hairline render FILE` beside those that the repositories publish with their models, looked at on 26 November 2026:

* market-assets, `nes`, `race-car` and `helicopter` (packed by Draco; the thumbnails are of another renderer): the same shapes, the same colours and maps, glass of the
  visor and of the canopy at the same places. Hairline's light is a darker studio, and its ground touches the model. The thumbnails' camera sees from farther off.
* MeshesLibrary, `Material_SpecularGlossiness_02` (`Figures/SampleImages`, rendered by Babylon.js): the same picture of dirt and stripes. Under Babylon's map of a street the
  rough metal of the dirt is brighter than under the studio.
* MeshesLibrary, `Mesh_PrimitivesUV_03`: two triangles by two sets of coordinates, the seam at the same place, with the same colours of vertices.
";

const FILES: &str = "
## The files

By repository: what became of how many files, what was told to be missing in the picture, and which files.
";

fn all(sources: &[Source]) -> impl Iterator<Item = &Opened> {
    sources.iter().flat_map(|source| &source.files)
}

fn is_told(file: &Opened) -> bool {
    file.left_out.iter().any(|(_, _, matters)| *matters)
}

fn summary(out: &mut String, sources: &[Source]) {
    out.push_str("\n## In all\n\n| repository | files | rendered whole | rendered, with notes | refused | faults |\n|---|---|---|---|---|---|\n");
    let mut row = |name: &str, files: &[&Opened]| {
        let count = |is: &dyn Fn(&Opened) -> bool| files.iter().filter(|file| is(file)).count();
        let is_rendered = |file: &Opened| file.outcome == Outcome::Rendered;
        let whole = count(&|file| is_rendered(file) && !is_told(file));
        let noted = count(&|file| is_rendered(file) && is_told(file));
        let refused = count(&|file| matches!(file.outcome, Outcome::Refused(_)));
        let faults = files.len() - whole - noted - refused;
        let total = files.len();
        let _ = writeln!(
            out,
            "| {name} | {total} | {whole} | {noted} | {refused} | {faults} |"
        );
    };
    for source in sources {
        row(&source.name, &source.files.iter().collect::<Vec<_>>());
    }
    row("all", &all(sources).collect::<Vec<_>>());
}

/// Lists the contents that are left out of the files.
fn lacking(out: &mut String, sources: &[Source]) {
    let mut counts: BTreeMap<(bool, &str, &str), usize> = BTreeMap::new();
    for file in all(sources).filter(|file| file.outcome == Outcome::Rendered) {
        let distinct: BTreeSet<_> = file.left_out.iter().collect();
        for (what, meaning, matters) in distinct {
            *counts.entry((!matters, what, meaning)).or_default() += 1;
        }
    }
    out.push_str("\n## What is told\n\nOf the files that are rendered. What leaves the picture as it is, `hairline info` alone tells.\n\n| left out | files | meaning | changes the picture |\n|---|---|---|---|\n");
    for ((harmless, what, meaning), count) in counts {
        let matters = if harmless { "no" } else { "yes" };
        let _ = writeln!(
            out,
            "| {} | {count} | {meaning} | {matters} |",
            escaped(what)
        );
    }
}

/// Writes the table of the extensions in the files, and whether a note reports each.
fn extensions(out: &mut String, sources: &[Source]) {
    let mut counts: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for file in all(sources).filter(|file| file.outcome == Outcome::Rendered) {
        for name in &file.used {
            let told = file.left_out.iter().any(|(what, _, _)| what == name);
            let count = counts.entry(name).or_default();
            count[0] += 1;
            count[1] += usize::from(told);
        }
    }
    out.push_str("\n## Extensions\n\nWhat rendered files list as used, by their own text. One that is never told of is read, or is listed and not used.\n\n| extension | files | told of in |\n|---|---|---|\n");
    for (name, [used, told]) in counts {
        let _ = writeln!(out, "| {} | {used} | {told} |", escaped(name));
    }
}

fn files(out: &mut String, source: &Source) {
    let mut groups: BTreeMap<(&Outcome, Vec<&str>), Vec<&str>> = BTreeMap::new();
    for file in &source.files {
        let told = file.left_out.iter().filter(|(_, _, matters)| *matters);
        let told: BTreeSet<_> = told.map(|(what, _, _)| &**what).collect();
        let told = match file.outcome {
            Outcome::Rendered => told.into_iter().collect(),
            _ => Vec::new(),
        };
        groups
            .entry((&file.outcome, told))
            .or_default()
            .push(&file.name);
    }
    let _ = write!(
        out,
        "\n### {}\n\n| outcome | left out | files |\n|---|---|---|\n",
        source.name
    );
    for ((outcome, told), names) in groups {
        let shown = names[..names.len().min(NAMED)].join(", ");
        let more = match names.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let outcome = escaped(&outcome.to_string());
        let told = escaped(&told.join(", "));
        let _ = writeln!(
            out,
            "| {outcome} | {told} | {}: {}{more} |",
            names.len(),
            escaped(&shown)
        );
    }
}

/// Text for a cell of a table.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
        .replace(['<', '\n'], " ")
        .replace('_', "\\_")
}
