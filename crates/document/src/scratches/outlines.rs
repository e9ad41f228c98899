//! Outlines that are engraved: those of letters and of drawings.

use hairline_image::FilePath;
use hairline_model::reading::{self, FileKind};
use kurbo::{Affine, BezPath, Point, Shape, Vec2};
use usvg::tiny_skia_path::{PathSegment, Point as SvgPoint};
use usvg::{Group, ImageHrefResolver, Node, Options, Tree};

use crate::error::Error;
use crate::shape::text;

/// The share of the free memory that a drawing's file may take: what is read of it takes several times as much.
const FILE_SHARE: f64 = 1.0 / 16.0;

/// Outlines that are put onto the surface as one: metres in a plane, x to the right and y up.
pub(super) struct Stamp {
    /// Its place to the right of the middle of all.
    pub x_m: f64,
    /// Outlines about that place.
    pub outlines: BezPath,
}

/// The letters of a line, each a stamp.
pub(super) fn letters(line: &str, height_m: f64) -> Vec<Stamp> {
    let line = text::line(line);
    let width = line
        .letters
        .last()
        .map_or(0.0, |last| last.x + last.advance);
    let m_per_unit = height_m / line.capital_height;
    let stamps = line.letters.into_iter().map(|letter| {
        let middle = Vec2::new(letter.advance, line.capital_height) / 2.0;
        Stamp {
            x_m: m_per_unit * (letter.x + middle.x - width / 2.0),
            outlines: Affine::scale(m_per_unit) * Affine::translate(-middle) * letter.outline,
        }
    });
    stamps.collect()
}

/// The outlines of an SVG file, as large as `fit_m`: of what is `held` in its place, if anything is. `key` is the path of its name in the scene file.
pub(super) fn drawing(
    held: Option<&[u8]>,
    path: &FilePath,
    key: &str,
    fit_m: f64,
) -> Result<Stamp, Error> {
    const RIGHT: &str =
        "must be an SVG file with shapes, relative to the scene file; letters as paths";
    let wrong = |found: String| {
        let found = format!("\"{}\" {found}", path.display());
        Error::new(key, found, RIGHT)
    };
    let bytes = match held {
        Some(held) => Ok(held.to_owned()),
        None => reading::read(path, FileKind::File, FILE_SHARE),
    };
    let bytes = bytes.map_err(|why| wrong(format!("cannot be read ({why})")))?;
    let options = Options {
        // No further file is read.
        image_href_resolver: ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..Options::default()
    };
    let tree = Tree::from_data(&bytes, &options);
    let tree = tree.map_err(|why| match why {
        usvg::Error::ParsingFailed(why) => {
            let line = why.pos().row as usize;
            Error::new("", format!("found no drawing ({why})"), RIGHT)
                .with_position(path, Some(line))
        }
        why => wrong(format!("is no drawing ({why})")),
    })?;
    let mut outlines = BezPath::new();
    add(tree.root(), &mut outlines);
    let bounds = outlines.bounding_box();
    let extent = bounds.width().max(bounds.height());
    if outlines.is_empty() || !(extent > 0.0) {
        return Err(wrong(match texts(&bytes) {
            0 => "has no outlines".to_owned(),
            1 => "has 1 text and no outlines; turn it into paths".to_owned(),
            count => format!("has {count} texts and no outlines; turn them into paths"),
        }));
    }
    let m_per_unit = fit_m / extent;
    // In SVG y points down.
    let upright = Affine::scale_non_uniform(m_per_unit, -m_per_unit);
    outlines.apply_affine(upright * Affine::translate(-bounds.center().to_vec2()));
    Ok(Stamp { x_m: 0.0, outlines })
}

/// The number of texts in an SVG file: no outlines are made of them.
fn texts(bytes: &[u8]) -> usize {
    let text = std::str::from_utf8(bytes).unwrap_or_default();
    let document = usvg::roxmltree::Document::parse(text);
    document.map_or(0, |document| {
        let nodes = document.descendants();
        nodes.filter(|node| node.has_tag_name("text")).count()
    })
}

/// Adds all shapes of a group.
fn add(group: &Group, outlines: &mut BezPath) {
    let at = |point: SvgPoint| Point::new(point.x.into(), point.y.into());
    for node in group.children() {
        let path = match node {
            Node::Group(group) => {
                add(group, outlines);
                continue;
            }
            Node::Path(path) if path.is_visible() => path,
            _ => continue,
        };
        let Some(data) = path.data().clone().transform(path.abs_transform()) else {
            continue;
        };
        for segment in data.segments() {
            match segment {
                PathSegment::MoveTo(to) => outlines.move_to(at(to)),
                PathSegment::LineTo(to) => outlines.line_to(at(to)),
                PathSegment::QuadTo(b, to) => outlines.quad_to(at(b), at(to)),
                PathSegment::CubicTo(b, c, to) => outlines.curve_to(at(b), at(c), at(to)),
                PathSegment::Close => outlines.close_path(),
            }
        }
    }
}
