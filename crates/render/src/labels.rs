//! Labels of a picture: which scratches each pixel shows, and how much of it they cover.

use std::path::Path;

use glam::{DVec2, DVec3};
use hairline_image::cryptomatte::{self, Matte, NOTHING};
use hairline_index::segment_tree::SegmentTree;
use hairline_index::{Hit, TriangleIndex};
use hairline_scene::{CameraFrame, Object, Scene};
use rayon::prelude::*;

use outlines::Outlines;
use pieces::{Piece, PieceInPixel, pieces};

mod outlines;
mod pieces;

pub use outlines::OBJECT_RANKS;

/// Number of scratches that each pixel names: three layers of the convention.
pub const RANKS: usize = 6;
/// Distance in standard deviations of a pixel's filter beyond which a scratch covers nothing of it.
const REACH: f64 = 3.5;
/// Least cosine between the normals of a scratch and of the surface that shows it.
const FACING: f32 = 0.5;

/// Labels of a picture, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Object that the middle of each pixel sees; [`NOTHING`] for none.
    pub object: Vec<u32>,
    /// The [`OBJECT_RANKS`] objects that cover most of each pixel, the largest first; [`NOTHING`] for none.
    pub objects: Vec<u32>,
    /// Share of the pixel, through its filter, that each of these covers.
    pub object_coverage: Vec<f32>,
    /// The [`RANKS`] scratches that cover most of each pixel, the strongest first, counted over all objects; [`NOTHING`] for none.
    pub scratch: Vec<u32>,
    /// Share of the pixel, through its filter, that each of these covers.
    pub coverage: Vec<f32>,
    /// Direction of each of these in the picture, radians from the right, counter-clockwise, from -pi/2 to pi/2.
    pub direction_rad: Vec<f32>,
    /// Pixels that scratches go through: the index of the pixel and that of the scratch, in the order of the pixels.
    pub touched: Vec<[u32; 2]>,
}

/// A scratch in a pixel.
#[derive(Clone, Copy)]
struct ScratchInPixel {
    scratch: u32,
    coverage: f64,
    /// Coverage by the piece that covers most, and its direction.
    most: f64,
    direction_rad: f64,
    is_touched: bool,
}

/// One pixel's labels.
#[derive(Clone)]
struct Pixel {
    object: u32,
    shown: Vec<ScratchInPixel>,
}

/// The index of the first scratch of each object, counted over all objects, and that behind the last one.
pub fn first_scratches(scene: &Scene) -> Vec<u32> {
    let mut first = vec![0];
    for object in &scene.objects {
        first.push(first[first.len() - 1] + object.scratches.len() as u32);
    }
    first
}

/// Labels of a scene's picture. None where `cancelled` says so, which is asked from any thread.
pub fn labels(scene: &Scene, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Labels> {
    let seen = SeenScene::new(scene);
    let [width, height] = scene.render.size_px;
    let rows = (0..height).into_par_iter().map(|y| {
        if cancelled() {
            return None;
        }
        let pixel = |x| seen.pixel(DVec2::new(f64::from(x), f64::from(y)));
        Some((0..width).map(pixel).collect::<Vec<_>>())
    });
    let pixels: Option<Vec<Vec<Pixel>>> = rows.collect();
    let mut labels = Labels {
        size_px: scene.render.size_px,
        ..Labels::default()
    };
    for (i, pixel) in (0..).zip(pixels?.into_iter().flatten()) {
        labels.push(i, &pixel);
    }
    let covers = Outlines {
        scene,
        frame: &seen.frame,
        triangles: &seen.triangles,
        object: &labels.object,
    };
    let covers = (0..labels.object.len())
        .into_par_iter()
        .map(|i| covers.of_pixel(i));
    for (object, share) in covers.collect::<Vec<_>>().into_iter().flatten() {
        labels.objects.push(object);
        labels.object_coverage.push(share);
    }
    Some(labels)
}

/// A scene with what tells what its pixels see.
struct SeenScene<'a> {
    scene: &'a Scene,
    frame: CameraFrame,
    triangles: TriangleIndex,
    pieces: SegmentTree<Piece>,
    /// Half of the width of each object's widest scratch.
    half_widths_m: Vec<f64>,
}

/// Half of the width of an object's widest scratch.
fn half_widest_m(object: &Object) -> f64 {
    let widths_um = object.scratches.iter().map(|it| it.profile.width_um);
    0.5e-6 * f64::from(widths_um.fold(0.0, f32::max))
}

impl<'a> SeenScene<'a> {
    fn new(scene: &'a Scene) -> Self {
        let first = first_scratches(scene);
        let objects = scene.objects.iter().zip(&first);
        Self {
            scene,
            frame: scene.camera.frame(scene.render.size_px),
            triangles: TriangleIndex::build(scene),
            pieces: SegmentTree::build(objects.map(|(object, first)| pieces(object, *first))),
            half_widths_m: scene.objects.iter().map(half_widest_m).collect(),
        }
    }

    /// The pixel whose upper left corner is at `corner_px`.
    fn pixel(&self, corner_px: DVec2) -> Pixel {
        let Self {
            scene,
            frame,
            triangles,
            ..
        } = self;
        let ray = frame.camera_ray(corner_px + 0.5);
        let nothing = Pixel {
            object: NOTHING,
            shown: Vec::new(),
        };
        let Some(hit) = triangles.intersect(frame.position_m, ray.normalize()) else {
            return nothing;
        };
        if scene.objects[hit.object as usize].is_lamp {
            return nothing;
        }
        let mut shown = self.shown(corner_px, ray, &hit);
        add_up(&mut shown);
        keep_strongest(&mut shown);
        Pixel {
            object: hit.object,
            shown,
        }
    }

    /// Pieces of scratches that a pixel shows of what its ray hits, each as a scratch.
    fn shown(&self, corner_px: DVec2, ray: DVec3, hit: &Hit) -> Vec<ScratchInPixel> {
        let Self {
            scene,
            frame,
            pieces,
            ..
        } = self;
        let position_m = frame.position_m + ray.normalize() * hit.distance_m;
        let normal = smooth_normal(scene, hit, -ray);
        let depth_m = hit.distance_m / ray.length();
        let px_m = frame.footprint_axes(ray, depth_m, normal);
        let axes = px_m.map(|axis| axis * scene.render.filter_std_px);
        // The filter, or the square of the pixel, whichever is wider. On a flat surface the box of both has no height, and rounding would miss it.
        let reach_m = |axes: [DVec3; 2]| axes.map(|axis| axis.length()).iter().sum::<f64>();
        let reach_m = (REACH * reach_m(axes)).max(reach_m(px_m));
        let object = hit.object as usize;
        let reach = DVec3::splat(reach_m + self.half_widths_m[object]);
        let mut shown: Vec<ScratchInPixel> = Vec::new();
        pieces.gather(object, position_m.as_vec3(), reach.as_vec3(), |i| {
            let piece = &pieces.segments[i];
            if piece.normal.dot(normal.as_vec3()) < FACING {
                return;
            }
            let Some(seen) = PieceInPixel::new(piece, frame, corner_px, position_m, axes, normal)
            else {
                return;
            };
            shown.push(ScratchInPixel {
                scratch: piece.scratch,
                coverage: seen.coverage,
                most: seen.coverage,
                direction_rad: seen.direction_rad,
                is_touched: seen.is_touched,
            });
        });
        shown
    }
}

/// Adds up the pieces of each scratch, in their order.
fn add_up(shown: &mut Vec<ScratchInPixel>) {
    // Stable, so that sums are added up in the order of the pieces.
    shown.sort_by_key(|it| it.scratch);
    shown.dedup_by(|next, kept| {
        let is_same = next.scratch == kept.scratch;
        if is_same {
            kept.coverage += next.coverage;
            kept.is_touched |= next.is_touched;
            if next.most > kept.most {
                (kept.most, kept.direction_rad) = (next.most, next.direction_rad);
            }
        }
        is_same
    });
}

/// Sorts scratches by their coverage, and keeps those that a pixel names or that go through it.
fn keep_strongest(shown: &mut Vec<ScratchInPixel>) {
    shown.retain(|it| it.coverage > 1e-9 || it.is_touched);
    // Equal coverage falls to the scratch that was laid first.
    shown.sort_by(|a, b| {
        b.coverage
            .total_cmp(&a.coverage)
            .then(a.scratch.cmp(&b.scratch))
    });
    // Thousands of scratches may lie in a pixel: all of them for all pixels would not fit into memory.
    let mut rank = 0;
    shown.retain(|scratch| {
        rank += 1;
        rank <= RANKS || scratch.is_touched
    });
    shown.shrink_to_fit();
}

/// The shading normal without textures, on the side of the viewer.
fn smooth_normal(scene: &Scene, hit: &Hit, to_viewer: DVec3) -> DVec3 {
    let mesh = &scene.objects[hit.object as usize].mesh;
    let [a, b, c] =
        mesh.triangles[hit.triangle as usize].map(|i| mesh.normals[i as usize].as_dvec3());
    let [u, v] = hit.barycentric;
    let normal = (a * (1.0 - u - v) + b * u + c * v).normalize_or(to_viewer.normalize());
    if normal.dot(to_viewer) < 0.0 {
        -normal
    } else {
        normal
    }
}

impl Labels {
    /// Adds the labels of pixel `i`.
    fn push(&mut self, i: u32, pixel: &Pixel) {
        self.object.push(pixel.object);
        let touched = pixel.shown.iter().filter(|it| it.is_touched);
        self.touched.extend(touched.map(|it| [i, it.scratch]));
        for rank in 0..RANKS {
            let shown = pixel.shown.get(rank);
            self.scratch.push(shown.map_or(NOTHING, |it| it.scratch));
            self.coverage
                .push(shown.map_or(0.0, |it| it.coverage as f32));
            self.direction_rad
                .push(shown.map_or(0.0, |it| it.direction_rad as f32));
        }
    }

    /// Writes the labels as an .exr by the convention of Cryptomatte, with the layer, the width, the depth and the direction of each pixel's strongest
    /// scratch.
    ///
    /// # Errors
    /// Another ending; a file that cannot be written.
    pub fn write(&self, path: &Path, scene: &Scene) -> Result<(), hairline_image::Error> {
        let first = first_scratches(scene);
        let owner = |scratch: u32| first.partition_point(|f| *f <= scratch) - 1;
        let scratch_of = |scratch: u32| {
            let object = owner(scratch);
            (object, scratch - first[object])
        };
        let named = |scratch: u32| {
            let (object, i) = scratch_of(scratch);
            format!("{}/{i}", scene.objects[object].name)
        };
        let object_named = |object: u32| scene.objects[object as usize].name.clone();
        let mattes = [
            Matte {
                name: "CryptoScratch",
                ranks: RANKS,
                things: &self.scratch,
                coverage: &self.coverage,
                name_of: &named,
            },
            Matte {
                name: "CryptoObject",
                ranks: OBJECT_RANKS,
                things: &self.objects,
                coverage: &self.object_coverage,
                name_of: &object_named,
            },
        ];
        let strongest = |of: &dyn Fn(u32, usize) -> f32| {
            let each = self.scratch.iter().step_by(RANKS).enumerate();
            each.map(|(i, scratch)| {
                if *scratch == NOTHING {
                    0.0
                } else {
                    of(*scratch, i * RANKS)
                }
            })
            .collect()
        };
        let of_scratch = |value: fn(&hairline_scene::Scratch) -> f32| {
            strongest(&|scratch, _| {
                let (object, i) = scratch_of(scratch);
                value(&scene.objects[object].scratches[i as usize])
            })
        };
        let planes = vec![
            // 0 is no scratch.
            ("label.layer", of_scratch(|it| it.layer as f32 + 1.0)),
            ("label.width_um", of_scratch(|it| it.profile.width_um)),
            ("label.depth_nm", of_scratch(|it| it.profile.depth_nm)),
            (
                "label.direction_rad",
                strongest(&|_, i| self.direction_rad[i]),
            ),
        ];
        cryptomatte::write_labels(path, self.size_px, &mattes, planes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_fixtures::SceneFile;

    fn plate() -> Scene {
        SceneFile::seen_from([0.0, -0.05, 0.3])
            .fov_y_deg(20.0)
            .size_px([64, 48])
            .metal("steel", "steel")
            .object("disk", "steel", "disk = { radius_m = 0.05 }")
            .random("disk", 60)
            .with_lines("seed = 1\nlength_m = 0.03\nwidth_um = 20.0\ndepth_nm = 180.0")
            .sphere([0.0, 0.3, 0.2], 0.02, 50.0)
            .scene()
    }

    /// Coverages of all pixels add up to the area of the scratches in the picture.
    #[test]
    fn coverage_is_the_area_of_the_scratches() {
        let scene = plate();
        let labels = labels(&scene, &|| false).unwrap();
        let frame = scene.camera.frame(scene.render.size_px);
        let object = &scene.objects[0];
        let mut area_px = 0.0;
        for scratch in object.scratches.iter() {
            for piece in
                &object.segments[scratch.segments.start as usize..scratch.segments.end as usize]
            {
                let [a, b] = [piece.start_m, piece.end_m].map(|p| p.as_dvec3());
                let way = b - a;
                let half =
                    0.5e-6 * f64::from(scratch.profile.width_um) * DVec3::Z.cross(way).normalize();
                let corners =
                    [a - half, a + half, b + half, b - half].map(|p| frame.pixel_of(p).unwrap());
                let inside = corners
                    .iter()
                    .all(|c| c.x > 0.0 && c.y > 0.0 && c.x < 64.0 && c.y < 48.0);
                assert!(inside, "the plate fills less than the picture");
                let (p, q) = (corners[2] - corners[0], corners[3] - corners[1]);
                area_px += 0.5 * p.perp_dot(q).abs();
            }
        }
        let found: f64 = labels.coverage.iter().map(|c| f64::from(*c)).sum();
        assert!((found / area_px - 1.0).abs() < 0.02, "{found} {area_px}");
    }

    /// Shares of a plane that ends within pixels add up to its area, and no pixel has less than its middle shows.
    #[test]
    fn objects_cover_what_the_filter_sees_of_them() {
        let mut scene = plate();
        scene.objects[0].scratches = Vec::new().into();
        let labels = labels(&scene, &|| false).unwrap();
        let first = |i: usize| {
            (
                labels.objects[OBJECT_RANKS * i],
                labels.object_coverage[OBJECT_RANKS * i],
            )
        };
        let all: f32 = (0..64 * 48).map(|i| first(i).1).sum();
        let middles = labels.object.iter().filter(|object| **object == 0).count() as f32;
        assert!((all / middles - 1.0).abs() < 0.01, "{all} {middles}");
        let in_part = (0..64 * 48)
            .filter(|i| (0.05..0.95).contains(&first(*i).1))
            .count();
        assert!(in_part > 50, "{in_part}");
        assert!((0..64 * 48).all(|i| (first(i).1 > 0.0) == (first(i).0 == 0)));
    }

    /// A scratch many pixels wide covers pixels beside its middle line wholly, and none by more than one.
    #[test]
    fn wide_scratches_cover_whole_pixels() {
        let mut scene = plate();
        let mut one = scene.objects[0].scratches[0].clone();
        one.profile.width_um = 12_000.0;
        scene.objects[0].scratches = vec![one].into();
        let labels = labels(&scene, &|| false).unwrap();
        assert!(labels.coverage.iter().all(|c| *c <= 1.0 + 1e-4));
        let whole = labels.coverage.iter().filter(|c| **c > 0.999).count();
        let touched = labels.touched.len();
        // 3 cm by 1.2 cm in pixels of 2.2 mm, without three standard deviations of half a pixel at each edge: 11 by 2.
        assert!((15..30).contains(&whole), "{whole}");
        assert!(touched >= whole, "{touched}");
    }

    /// Pixels of a scratch are those that samples of its line fall into.
    #[test]
    fn touched_pixels_are_those_under_the_line() {
        let scene = plate();
        let labels = labels(&scene, &|| false).unwrap();
        let frame = scene.camera.frame(scene.render.size_px);
        let object = &scene.objects[0];
        let mut right = std::collections::BTreeMap::new();
        for (i, scratch) in object.scratches.iter().enumerate() {
            for piece in
                &object.segments[scratch.segments.start as usize..scratch.segments.end as usize]
            {
                for step in 0..20_000 {
                    let at = piece
                        .start_m
                        .as_dvec3()
                        .lerp(piece.end_m.as_dvec3(), f64::from(step) / 2e4);
                    let px = frame.pixel_of(at).unwrap().floor();
                    *right
                        .entry([px.y as u32 * 64 + px.x as u32, i as u32])
                        .or_insert(0) += 1;
                }
            }
        }
        let found: std::collections::BTreeSet<_> = labels.touched.iter().copied().collect();
        // Corners that a line cuts by less than a thousandth of a piece may fall either way. At the rim the middle of a pixel sees no surface.
        let missed = right
            .iter()
            .filter(|(key, count)| {
                **count > 20 && labels.object[key[0] as usize] == 0 && !found.contains(*key)
            })
            .count();
        let added = found.iter().filter(|key| !right.contains_key(*key)).count();
        assert!(
            found.len() > 500 && missed == 0 && added * 200 < found.len(),
            "{missed} {added} {}",
            found.len()
        );
    }
}
