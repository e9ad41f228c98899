//! Documents beside the programs: those of the repository, with links to what lies beside them alone.

use std::fs;
use std::path::Path;

use anyhow::Context;
use pulldown_cmark::{Event, Parser, Tag};

use crate::archive;

/// Leaves the text alone of each link that leads to a file that is not there, in all documents of a folder.
pub fn without_dead_links(folder: &Path) -> anyhow::Result<()> {
    for file in archive::files(folder)? {
        if file.extension().is_some_and(|ending| ending == "md") {
            let path = folder.join(file);
            let beside = path.parent().context("a document without a folder")?;
            let text = fs::read_to_string(&path)?;
            let linked = with_links(&text, |url| {
                let file = url.split('#').next().unwrap_or_default();
                url.contains("://") || beside.join(file).exists()
            });
            fs::write(&path, linked)?;
        }
    }
    Ok(())
}

/// The text with those links alone that are to stay.
fn with_links(text: &str, stays: impl Fn(&str) -> bool) -> String {
    let mut linked = String::new();
    let mut copied = 0;
    for (event, range) in Parser::new(text).into_offset_iter() {
        let Event::Start(Tag::Link { dest_url, .. }) = event else {
            continue;
        };
        let source = &text[range.clone()];
        let words = source.strip_prefix('[').zip(source.rfind("]("));
        if let (false, Some((inner, end))) = (stays(&dest_url), words) {
            linked += &text[copied..range.start];
            linked += &inner[..end - 1];
            copied = range.end;
        }
    }
    linked + &text[copied..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dead_links_become_their_text() {
        let text = "Read [`this`](there.md#at), [that](gone.md) and ![a](gone.png).\n\n    [code](gone.md)\n";
        let expected =
            "Read [`this`](there.md#at), that and ![a](gone.png).\n\n    [code](gone.md)\n";
        assert_eq!(
            with_links(text, |url| url.starts_with("there.md")),
            expected
        );
    }
}
