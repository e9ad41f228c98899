//! Letters that stand on the xy plane: the outlines of a font, filled and drawn up along z.

use earcut::Earcut;
use glam::{DVec2, DVec3, Vec2};
use hairline_model::surface::{Surface, Vertex};
use kurbo::{BezPath, PathEl, Point};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider};

use super::profile::{ROUNDED_BEND_COS, flat_vertex};

/// Into so many straight pieces a curve of an outline is parted: one turns by a quarter at most, and by 11 degrees a piece.
const CURVE_PIECES: u32 = 8;

/// The font of texts, TrueType: Ubuntu Light without hints. Its licence stands beside it.
pub static FONT: &[u8] = include_bytes!("../../assets/text.ttf");

fn font() -> FontRef<'static> {
    FontRef::new(FONT).expect("the font that is built in")
}

/// Characters of a text that the font does not have.
pub(crate) fn missing(text: &str) -> String {
    let charmap = font().charmap();
    let is_missing = |c: &char| charmap.map(*c).is_none();
    text.chars().filter(is_missing).collect()
}

/// The text in one line, with its middle over the origin and capitals as high as `height_m`; from z = 0 to `depth_m`.
pub(super) fn surface(text: &str, height_m: f64, depth_m: f64) -> Surface {
    let letters = letters(text, height_m);
    let points = || letters.iter().flatten().flatten();
    let low = points().copied().reduce(DVec2::min).unwrap_or_default();
    let high = points().copied().reduce(DVec2::max).unwrap_or_default();
    let middle = DVec2::new(0.5 * (low.x + high.x), 0.5 * height_m);
    let mut surface = Surface::default();
    for letter in letters {
        let contours = letter.into_iter();
        let moved = contours.map(|contour| contour.into_iter().map(|p| p - middle).collect());
        for shape in shapes(moved.collect()) {
            let size_m = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
            add_faces(&mut surface, &shape, depth_m, size_m);
            for contour in &shape {
                add_wall(&mut surface, contour, depth_m);
            }
        }
    }
    surface
}

/// Numbers of triangles and vertices.
pub(super) fn size(text: &str) -> [f64; 2] {
    let surface = surface(text, 1.0, 1.0);
    [
        surface.triangles.len() as f64,
        surface.vertices.len() as f64,
    ]
}

/// A closed line of points, without the first one again.
type Contour = Vec<DVec2>;

/// A letter of a line, in units of the font.
pub(crate) struct Letter {
    /// Its outlines, from its own origin.
    pub outline: BezPath,
    /// Its origin in the line.
    pub x: f64,
    /// The way to the origin of the next one.
    pub advance: f64,
}

/// A line of text, in units of the font.
pub(crate) struct Line {
    pub letters: Vec<Letter>,
    pub capital_height: f64,
}

/// The outlines of each character that the font has.
pub(crate) fn line(text: &str) -> Line {
    let font = font();
    let unscaled = Size::unscaled();
    let metrics = font.metrics(unscaled, LocationRef::default());
    let capital = metrics
        .cap_height
        .expect("the font that is built in has one");
    let charmap = font.charmap();
    let advances = font.glyph_metrics(unscaled, LocationRef::default());
    let outlines = font.outline_glyphs();
    let mut x = 0.0;
    let letters = text.chars().filter_map(|c| {
        let glyph = charmap.map(c)?;
        let advance = f64::from(advances.advance_width(glyph).unwrap_or(0.0));
        let mut pen = Pen(BezPath::new());
        let origin = x;
        x += advance;
        let settings = DrawSettings::unhinted(unscaled, LocationRef::default());
        outlines.get(glyph)?.draw(settings, &mut pen).ok()?;
        Some(Letter {
            outline: pen.0,
            x: origin,
            advance,
        })
    });
    Line {
        letters: letters.collect(),
        capital_height: f64::from(capital),
    }
}

/// Takes outlines.
struct Pen(BezPath);

fn units(x: f32, y: f32) -> Point {
    Point::new(x.into(), y.into())
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(units(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(units(x, y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.0.quad_to(units(cx, cy), units(x, y));
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.0.curve_to(units(ax, ay), units(bx, by), units(x, y));
    }

    fn close(&mut self) {
        self.0.close_path();
    }
}

/// The outlines of each character in straight pieces, with the first one's origin at 0.
fn letters(text: &str, height_m: f64) -> Vec<Vec<Contour>> {
    let line = line(text);
    let m_per_unit = height_m / line.capital_height;
    let letters = line.letters.iter().map(|letter| {
        let mut contours = Contours {
            contours: Vec::new(),
            m_per_unit,
            origin: DVec2::new(letter.x, 0.0),
            at: DVec2::ZERO,
        };
        letter.outline.iter().for_each(|part| contours.add(part));
        let mut contours = contours.contours;
        for contour in &mut contours {
            contour.dedup();
            if contour.first() == contour.last() {
                contour.pop();
            }
        }
        contours.retain(|contour| contour.len() > 2);
        contours
    });
    letters.collect()
}

/// Parts outlines in units of the font into straight pieces.
struct Contours {
    contours: Vec<Contour>,
    m_per_unit: f64,
    origin: DVec2,
    at: DVec2,
}

impl Contours {
    fn add(&mut self, part: PathEl) {
        let units = |point: Point| DVec2::new(point.x, point.y);
        match part {
            PathEl::MoveTo(to) => {
                self.contours.push(Vec::new());
                self.push(units(to));
            }
            PathEl::LineTo(to) => self.push(units(to)),
            PathEl::QuadTo(b, c) => {
                let (a, b, c) = (self.at, units(b), units(c));
                self.curve(|t| a.lerp(b, t).lerp(b.lerp(c, t), t));
            }
            PathEl::CurveTo(b, c, d) => {
                let (a, b, c, d) = (self.at, units(b), units(c), units(d));
                self.curve(|t| {
                    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
                    ab.lerp(bc, t).lerp(bc.lerp(cd, t), t)
                });
            }
            PathEl::ClosePath => {}
        }
    }

    fn push(&mut self, to: DVec2) {
        self.at = to;
        let point_m = (self.origin + to) * self.m_per_unit;
        if let Some(contour) = self.contours.last_mut() {
            contour.push(point_m);
        }
    }

    /// A Bezier curve by its value at t.
    fn curve(&mut self, at: impl Fn(f64) -> DVec2) {
        for i in 1..=CURVE_PIECES {
            self.push(at(f64::from(i) / f64::from(CURVE_PIECES)));
        }
    }
}

/// Twice the area within a contour, positive where it runs counter-clockwise.
fn twice_area(contour: &[DVec2]) -> f64 {
    let next = contour.iter().cycle().skip(1);
    contour.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

fn is_within(point: DVec2, contour: &[DVec2]) -> bool {
    let next = contour.iter().cycle().skip(1);
    let crossed = contour.iter().zip(next).filter(|(a, b)| {
        (a.y > point.y) != (b.y > point.y)
            && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

/// The contours of a letter by the parts that it has: each an outer one, counter-clockwise, with the holes in it, clockwise.
fn shapes(contours: Vec<Contour>) -> Vec<Vec<Contour>> {
    let around = |i: usize| -> Vec<usize> {
        let others = (0..contours.len()).filter(|&j| j != i);
        others
            .filter(|&j| is_within(contours[i][0], &contours[j]))
            .collect()
    };
    let outside: Vec<Vec<usize>> = (0..contours.len()).map(around).collect();
    let turned = |i: usize, counter_clockwise: bool| {
        let mut contour = contours[i].clone();
        if (twice_area(&contour) > 0.0) != counter_clockwise {
            contour.reverse();
        }
        contour
    };
    let outer = (0..contours.len()).filter(|&i| outside[i].len().is_multiple_of(2));
    let with_holes = outer.map(|i| {
        let is_hole =
            |j: &usize| outside[*j].len() == outside[i].len() + 1 && outside[*j].contains(&i);
        let holes = (0..contours.len()).filter(is_hole);
        std::iter::once(turned(i, true))
            .chain(holes.map(|j| turned(j, false)))
            .collect()
    });
    with_holes.collect()
}

/// The face at the top and the one at the bottom.
fn add_faces(surface: &mut Surface, shape: &[Contour], depth_m: f64, size_m: DVec2) {
    let points: Vec<[f64; 2]> = shape.iter().flatten().map(|p| p.to_array()).collect();
    let mut hole_starts = Vec::new();
    let mut start = 0;
    for contour in &shape[..shape.len() - 1] {
        start += contour.len() as u32;
        hole_starts.push(start);
    }
    let mut corners: Vec<u32> = Vec::new();
    Earcut::new().earcut(points.iter().copied(), &hole_starts, &mut corners);
    for (z_m, facing) in [(depth_m, 1.0), (0.0, -1.0)] {
        let first = surface.vertices.len() as u32;
        let vertices = points
            .iter()
            .map(|&[x, y]| flat_vertex(DVec3::new(x, y, z_m), facing, x / size_m.x, y / size_m.y));
        surface.vertices.extend(vertices);
        for corner in corners.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| DVec2::from(points[corner[i] as usize]));
            let is_seen = ((b - a).perp_dot(c - a) > 0.0) == (facing > 0.0);
            let [i, j, k] = [corner[0], corner[1], corner[2]].map(|i| first + i);
            surface
                .triangles
                .push(if is_seen { [i, j, k] } else { [i, k, j] });
        }
    }
}

/// Adds the wall along a contour, which has the letter to its left.
fn add_wall(surface: &mut Surface, contour: &[DVec2], depth_m: f64) {
    let count = contour.len();
    let ends = |i: usize| [contour[i], contour[(i + 1) % count]];
    let outwards = |i: usize| {
        let [a, b] = ends(i);
        -(b - a).perp().normalize()
    };
    let length_m: f64 = (0..count).map(|i| ends(i)[0].distance(ends(i)[1])).sum();
    let mut gone_m = 0.0;
    for i in 0..count {
        let own = outwards(i);
        let rounded = |other: DVec2| match own.dot(other) > ROUNDED_BEND_COS {
            true => (own + other).normalize(),
            false => own,
        };
        let normals = [outwards((i + count - 1) % count), outwards((i + 1) % count)].map(rounded);
        let first = surface.vertices.len() as u32;
        let next_m = gone_m + ends(i)[0].distance(ends(i)[1]);
        for ((point, normal), at_m) in ends(i).into_iter().zip(normals).zip([gone_m, next_m]) {
            for (z_m, v) in [(0.0, 1.0), (depth_m, 0.0)] {
                surface.vertices.push(Vertex {
                    position_m: point.extend(z_m),
                    normal: normal.extend(0.0),
                    tangent: normal.perp().extend(0.0),
                    uv: Vec2::new((at_m / length_m) as f32, v),
                    ..Vertex::default()
                });
            }
        }
        gone_m = next_m;
        let [a, b, c, d] = [first, first + 2, first + 3, first + 1];
        surface.triangles.extend([[a, b, c], [a, c, d]]);
    }
}
