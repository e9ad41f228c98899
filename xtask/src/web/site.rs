//! The docs as pages, with their pictures: beside the viewer, under the names that they have in the repository.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::Context;
use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};

use super::thumbnail::thumbnail;

/// Pages are reached from this one.
const FIRST: &str = "README.md";
/// The style of all pages.
const STYLE: &str = "docs.css";
/// Pixels: pictures are no wider.
const WIDTH_MAX: u32 = 1280;
/// Links in the line above each page.
const ABOVE: [(&str, &str); 5] = [
    ("index.html", "Try it"),
    ("README.html", "Hairline"),
    ("docs/pictures/README.html", "Pictures"),
    ("docs/scene.html", "Scene files"),
    ("docs/engines.html", "Other engines"),
];

/// Writes [`FIRST`] and all that it leads to. What is not among these becomes plain text, since the folder has no more.
pub(super) fn write(root: &Path, output: &Path) -> anyhow::Result<usize> {
    let mut site = Site {
        root,
        output,
        taken: HashSet::new(),
        waiting: vec![FIRST.into()],
    };
    fs::copy(root.join("apps/web/page").join(STYLE), output.join(STYLE))?;
    let mut pages = 0;
    while let Some(page) = site.waiting.pop() {
        if site.taken.insert(page.clone()) {
            site.page(&page)?;
            pages += 1;
        }
    }
    Ok(pages)
}

struct Site<'a> {
    root: &'a Path,
    output: &'a Path,
    /// Paths from the root.
    taken: HashSet<PathBuf>,
    waiting: Vec<PathBuf>,
}

impl Site<'_> {
    fn page(&mut self, page: &Path) -> anyhow::Result<()> {
        let text =
            fs::read_to_string(self.root.join(page)).with_context(|| page.display().to_string())?;
        let folder = page.parent().unwrap_or(Path::new(""));
        let mut events: Vec<Event> = Parser::new_ext(&text, Options::ENABLE_TABLES).collect();
        name_headings(&mut events);
        let mut ends = Vec::new();
        let mut out = Vec::with_capacity(events.len());
        for event in events {
            match event {
                Event::Start(Tag::Link {
                    link_type,
                    dest_url,
                    title,
                    id,
                }) => {
                    let target = self.link(folder, &dest_url);
                    ends.push(target.is_some());
                    if let Some(dest_url) = target {
                        out.push(Event::Start(Tag::Link {
                            link_type,
                            dest_url: dest_url.into(),
                            title,
                            id,
                        }));
                    }
                }
                Event::End(TagEnd::Link) => {
                    if ends.pop() == Some(true) {
                        out.push(event);
                    }
                }
                Event::Start(Tag::Image {
                    link_type,
                    dest_url,
                    title,
                    id,
                }) => {
                    let dest_url = self.picture(folder, &dest_url)?.into();
                    out.push(Event::Start(Tag::Image {
                        link_type,
                        dest_url,
                        title,
                        id,
                    }));
                }
                // A page that tells of pictures beside it shows them.
                Event::Code(name)
                    if self.root.join(folder).join(&*name).is_file() && name.ends_with(".png") =>
                {
                    let picture = self.picture(folder, &name)?;
                    let shown = format!(
                        "<a href=\"{picture}\"><img src=\"{picture}\" alt=\"{name}\" loading=\"lazy\"></a>"
                    );
                    out.push(Event::InlineHtml(shown.into()));
                }
                Event::Html(tags) => {
                    self.plots(folder, &tags)?;
                    out.push(Event::Html(tags));
                }
                event => out.push(event),
            }
        }
        let mut body = String::new();
        html::push_html(&mut body, out.into_iter());
        let title = text.lines().find_map(|line| line.strip_prefix("# "));
        let path = self.output.join(page.with_extension("html"));
        fs::create_dir_all(path.parent().unwrap_or(self.output))?;
        Ok(fs::write(
            path,
            wrap_page(folder, title.unwrap_or("Hairline"), &body),
        )?)
    }

    /// Target of a link in the folder, if it has one.
    fn link(&mut self, folder: &Path, url: &str) -> Option<String> {
        if url.starts_with('#') || url.contains("://") {
            return Some(url.into());
        }
        let (file, anchor) = match url.split_once('#') {
            Some((file, anchor)) => (file, format!("#{anchor}")),
            None => (url, String::new()),
        };
        let target = plain(&folder.join(file))?;
        if target.extension()? != "md" || !self.root.join(&target).is_file() {
            return None;
        }
        self.waiting.push(target);
        Some(format!(
            "{}{anchor}",
            file.strip_suffix(".md")?.to_owned() + ".html"
        ))
    }

    /// A picture of the docs, made small; its address beside the page.
    fn picture(&mut self, folder: &Path, url: &str) -> anyhow::Result<String> {
        let small = Path::new(url).with_extension("jpg");
        let path =
            plain(&folder.join(url)).with_context(|| format!("{url} is outside of the docs"))?;
        if self.taken.insert(path.clone()) {
            let copy = self.output.join(path.with_extension("jpg"));
            fs::create_dir_all(copy.parent().unwrap_or(self.output))?;
            thumbnail(&self.root.join(&path), &copy, WIDTH_MAX)?;
        }
        Ok(small.to_string_lossy().into_owned())
    }

    /// Drawings that lines of HTML name.
    fn plots(&mut self, folder: &Path, tags: &str) -> anyhow::Result<()> {
        for part in tags.split("src=\"").skip(1) {
            let name = part.split('"').next().unwrap_or("");
            let path = plain(&folder.join(name))
                .with_context(|| format!("{name} is outside of the docs"))?;
            if self.taken.insert(path.clone()) {
                let copy = self.output.join(&path);
                fs::create_dir_all(copy.parent().unwrap_or(self.output))?;
                fs::copy(self.root.join(&path), copy)?;
            }
        }
        Ok(())
    }
}

/// Headings get the names that links use: those of GitHub.
fn name_headings(events: &mut [Event]) {
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut start = 0;
    for i in 0..events.len() {
        match &events[i] {
            Event::Start(Tag::Heading { .. }) => start = i,
            Event::End(TagEnd::Heading(_)) => {
                let words = events[start..i].iter().filter_map(|event| match event {
                    Event::Text(words) | Event::Code(words) => Some(&**words),
                    _ => None,
                });
                let kept = |c: char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
                let name: String = words
                    .collect::<String>()
                    .to_lowercase()
                    .chars()
                    .filter(|c| kept(*c))
                    .collect();
                let name = name.trim().replace(' ', "-");
                let count = seen.entry(name.clone()).or_default();
                let unique = if *count == 0 {
                    name
                } else {
                    format!("{name}-{count}")
                };
                *count += 1;
                if let Event::Start(Tag::Heading { id, .. }) = &mut events[start] {
                    *id = Some(CowStr::from(unique));
                }
            }
            _ => {}
        }
    }
}

/// Path without `..`, if it stays inside.
fn plain(path: &Path) -> Option<PathBuf> {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => plain.pop().then_some(())?,
            Component::Normal(name) => plain.push(name),
            Component::CurDir => {}
            _ => return None,
        }
    }
    Some(plain)
}

fn wrap_page(folder: &Path, title: &str, body: &str) -> String {
    let up = "../".repeat(folder.components().count());
    let above: String = ABOVE
        .iter()
        .map(|(file, name)| format!("<a href=\"{up}{file}\">{name}</a>\n"))
        .collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"{up}hairline.png\">\n<link rel=\"stylesheet\" href=\"{up}{STYLE}\">\n</head>\n\
         <body>\n<nav>\n{above}</nav>\n<main>\n{body}</main>\n</body>\n</html>\n"
    )
}
