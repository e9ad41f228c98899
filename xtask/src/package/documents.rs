//! Programs in documents, for TypeScript's checker, and what they name besides: files, shaders, elements, functions of the page's viewer.

use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};
use hairline_fixtures::documents::documents;

use super::files::write;
use super::modules::validate;

/// Writes the JavaScript of each block in the documents into a file of `output`, and returns their paths. `wgsl` is the package's whole shader.
pub(super) fn programs(root: &Path, output: &Path, wgsl: &str) -> anyhow::Result<Vec<PathBuf>> {
    let output = &output.canonicalize()?;
    let mut programs = Vec::new();
    for block in documents().into_iter().flat_map(|(_, blocks)| blocks) {
        let (place, text) = (&*block.place, &*block.text);
        let script = match &*block.language {
            "js" => text,
            "html" => text_between(text, "<script type=\"module\">", "</script>"),
            _ => continue,
        };
        let named = text_between(text, "<script type=\"importmap\">", "</script>");
        for file in named
            .split('"')
            .filter(|part| part.starts_with("./node_modules/"))
        {
            let file = file.trim_start_matches("./node_modules/");
            let three = root.join("packages/hairline-shaders/test/node_modules");
            let is_there = [output, &three]
                .into_iter()
                .any(|it| it.join(file).exists());
            ensure!(is_there, "{place}: {file} is no file of a package");
        }
        let element = root.join("packages/hairline-viewer/src/hairline-viewer.js");
        let attributes = text_between(text, "<hairline-viewer ", ">").split('=');
        for name in attributes.filter_map(|part| part.rsplit([' ', '"']).next()) {
            let known = std::fs::read_to_string(&element)?.contains(&format!("'{name}'"));
            ensure!(
                known || name.is_empty(),
                "{place}: <hairline-viewer> has no {name}"
            );
        }
        let shader = text_between(text, "code: `${hairlineWgsl}", "`");
        if !shader.is_empty() {
            validate(&format!("{wgsl}{shader}")).context(place.to_owned())?;
        }
        // The page's viewer, which is compiled for browsers alone.
        let page = std::fs::read_to_string(root.join("apps/web/src/lib.rs"))?;
        for call in text
            .split("viewer.")
            .skip(1)
            .filter(|_| text.contains("./hairline.js"))
        {
            let name = call
                .split(|c: char| !c.is_alphanumeric())
                .next()
                .unwrap_or(call);
            let is_there = page.contains(&format!("fn {name}("))
                || page.contains(&format!("js_name = {name})"));
            ensure!(is_there, "{place}: the page's viewer has no {name}");
        }
        let file = output.join(format!("documents/{}.js", place.replace(['/', ':'], "-")));
        write(
            &file,
            format!("// {place}\n{script}\nexport {{}};\n").as_bytes(),
        )?;
        programs.push(file);
    }
    Ok(programs)
}

/// The text between the first `start` and what ends it, or none.
fn text_between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let rest = text.split_once(start).map_or("", |(_, rest)| rest);
    rest.split_once(end).map_or("", |(inner, _)| inner)
}
