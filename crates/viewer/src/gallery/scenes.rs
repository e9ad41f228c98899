//! The scenes of the small pictures, their rendering onto the sheet, and whether it is out of date.

use std::path::Path;

use glam::DVec3;
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_document::description::{
    Light, LightKind, Material, MaterialKind, Scratches, Shape, Surface,
};
use hairline_document::place_light::place_highlight;
use hairline_document::wear::Wear;
use hairline_document::{Description, Loader};
use hairline_editor::grating_presets::GratingPreset;
use hairline_editor::presets::{LayerPreset, LightPreset, MaterialPreset, ShapePreset};
use hairline_image::{Display, Picture, png};
use hairline_optics::metal::Metal;
use hairline_scene::Environment;
use hairline_sky::BuiltInMap;

use super::{COLUMNS, SIDE_PX, StandIn, Thumb};

/// A shallow dome of steel under a lamp, seen from above at a slant. The lamp's reflection lies a little behind the
/// dome's middle.
const DOME: &str = r#"
[camera]
position_m = [0.0, -0.058, 0.068]
target_m = [0.0, 0.0015, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 20.5
exposure_ev = 2.0
[[material]]
name = "m"
kind = "metal"
metal = "steel"
roughness = 0.08
[[object]]
name = "o"
shape = { lathe = { profile_m = [
    [0.0, 0.0008], [0.006, 0.0007], [0.012, 0.0002], [0.0165, -0.0004], [0.0175, -0.0009], [0.018, -0.002],
], segments = 96 } }
material = "m"
[[light]]
kind = "sphere"
center_m = [-0.004, 0.075, 0.088]
radius_m = 0.0022
radiance = 260.0
color = [1.0, 0.95, 0.88]
[[light]]
kind = "polygon"
vertices_m = [[-0.5, -0.5, 0.2], [-0.5, 0.5, 0.3], [0.5, 0.5, 0.3], [0.5, -0.5, 0.2]]
radiance = 0.045
color = [0.85, 0.93, 1.0]
"#;

/// A ball.
const BALL: &str = r#"
[camera]
position_m = [0.0, -0.1, 0.03]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 23.5
[[material]]
name = "m"
kind = "metal"
metal = "chromium"
roughness = 0.04
[[object]]
name = "o"
shape = { sphere = { radius_m = 0.02 } }
material = "m"
"#;

/// Diagonal of the dome's box.
const DOME_DIAGONAL_M: f64 = 0.051;
/// Diagonal of the box of a round or a tall body.
const BODY_M: f64 = 0.06;

/// Renderer of small pictures. It keeps the map that several of them use.
#[derive(Default)]
struct Studio {
    map: Option<Environment>,
}

/// The scene of a small picture, with its map.
fn scene_of(thumb: Thumb, side_px: u32) -> (Description, Option<BuiltInMap>) {
    let (mut description, map) = match thumb {
        Thumb::Layer(preset, StandIn::Flat) => {
            let mut dome = dome(&[preset.layer("o", DOME_DIAGONAL_M)]);
            if matches!(preset, LayerPreset::PolishedWatch | LayerPreset::SpunDisk) {
                // Scratches that run to the middle light up between it and a lamp beside it.
                dome.lights[0] = mirrored(dome.lights[0].clone(), &dome, BESIDE_M);
            }
            (dome, None)
        }
        Thumb::Layer(preset, form) => (body(form, &[preset.layer("o", BODY_M)]), None),
        Thumb::Wear(wear, StandIn::Flat) => (dome(&wear.layers("o", 0.7 * DOME_DIAGONAL_M)), None),
        Thumb::Wear(wear, form) => (body(form, &wear.layers("o", 0.7 * BODY_M)), None),
        Thumb::Grating(preset, form) => {
            let mut grooved = match form {
                StandIn::Flat => dome(&[]),
                form => body(form, &[]),
            };
            grooved.gratings = vec![preset.grating("o")];
            (grooved, None)
        }
        Thumb::Material(preset, form) => {
            let mut made = of_form(form);
            let mut material = preset.material();
            made.camera.exposure_ev = match (preset, form) {
                // A flat one mirrors the soft box above it alone.
                (MaterialPreset::Metal(_), StandIn::Flat) => -2.2,
                (MaterialPreset::Metal(_), _) => 0.7,
                (MaterialPreset::Mirror, StandIn::Flat) => -3.5,
                _ => 0.5,
            };
            if let MaterialPreset::Metal(_) = preset {
                // So dull that its own colour is seen, and not the room.
                material.roughness = 0.3;
            }
            made.objects[0].material = Some(material.name.clone());
            made.materials = vec![material];
            (made, Some(BuiltInMap::Studio))
        }
        Thumb::Map(map) => (read(BALL), Some(map)),
        Thumb::Shape(preset) => {
            let mut shape = read(BALL);
            shape.objects[0].surface = Surface::Shape(preset.shape(0.043));
            shape.materials[0] = clay();
            shape.objects[0].material = Some(shape.materials[0].name.clone());
            shape.camera.position_m = [0.02, -0.088, 0.058];
            shape.camera.exposure_ev = -1.0;
            (shape, Some(BuiltInMap::Studio))
        }
        Thumb::Light(preset) => {
            let mut lit = dome(&[LayerPreset::RandomWear.layer("o", DOME_DIAGONAL_M)]);
            let light = preset.light(DVec3::ZERO, DVec3::Z, DOME_DIAGONAL_M);
            lit.lights = vec![mirrored(light, &lit, MIDDLE_M)];
            lit.camera.exposure_ev = 1.0;
            (lit, None)
        }
    };
    description.render.size_px = [side_px; 2];
    (description, map)
}

impl Studio {
    /// Renders a picture, as codes of red, green and blue.
    fn picture(&mut self, thumb: Thumb, side_px: u32) -> Vec<u8> {
        let (description, map) = scene_of(thumb, side_px);
        let loader = Loader::default();
        let mut scene = loader.build(&description, Path::new("")).unwrap();
        if let Some(map) = map {
            let is_seen = matches!(thumb, Thumb::Map(_));
            scene.environment = Some(self.environment(map).with_visible(is_seen));
        }
        let options = RenderOptions {
            samples: 2,
            ..RenderOptions::default()
        };
        let image = closed_form::render(&scene, &options, &|_| {});
        let display = Display {
            exposure_ev: description.camera.exposure_ev,
            tone_map: description.render.tone_map,
        };
        let mut beauty = image.beauty();
        if let Thumb::Material(MaterialPreset::Metal(metal), _) = thumb {
            // It lies among others of its kind, whose light has its colour twice: grey metals differ by a few hundredths.
            let [r, g, b] = metal.reflectance_rgb(1.0).map(|c| c as f32);
            let mean = (r + g + b) / 3.0;
            let tint = [r, g, b].map(|c| c * c / mean);
            for rgb in &mut beauty.rgb {
                *rgb = [0, 1, 2].map(|c| rgb[c] * tint[c]);
            }
        }
        let mut codes = png::quantize(&beauty, &display);
        if !matches!(thumb, Thumb::Map(_)) {
            for (i, _) in (image.depth_m.iter().enumerate()).filter(|(_, depth_m)| **depth_m == 0.0)
            {
                codes[3 * i..3 * i + 3].fill(GROUND);
            }
        }
        codes
    }

    fn environment(&mut self, map: BuiltInMap) -> Environment {
        let make = |map: BuiltInMap| {
            let picture: Picture = map.picture([64, 32]);
            // The window is before the ball, where it is seen in it.
            let rotation_rad = if map == BuiltInMap::Window { 2.5 } else { 0.0 };
            hairline_sky::from_map(picture, rotation_rad, 1.0, false)
                .with_up(DVec3::Z, rotation_rad)
        };
        match map {
            // Map of the pictures of all materials and shapes.
            BuiltInMap::Studio => self.map.get_or_insert_with(|| make(map)).clone(),
            other => make(other),
        }
    }
}

/// The ground of menus, where there is nothing.
const GROUND: u8 = 34;

/// Grey and dull: it shows nothing but the shape.
fn clay() -> Material {
    Material {
        name: "clay".to_owned(),
        kind: MaterialKind::Dielectric {
            ior: 1.3,
            base_color: [0.42, 0.41, 0.4],
        },
        roughness: 0.6,
        coherence_um: 20.0,
        coat: None,
        cover: None,
        anisotropy: None,
    }
}

/// The scene of a text, without what a scene without lights is given. The texts are part of the program.
fn read(text: &str) -> Description {
    let mut read = Description::from_toml(text, Path::new("small picture"))
        .unwrap_or_else(|error| unreachable!("{error}"));
    (read.studio.hidden, read.ground) = (true, None);
    read
}

fn dome(layers: &[Scratches]) -> Description {
    let mut description = read(DOME);
    description.scratches = layers.to_vec();
    description
}

/// A stand-in without light.
fn of_form(form: StandIn) -> Description {
    let mut made = read(match form {
        StandIn::Flat => DOME,
        StandIn::Round | StandIn::Tall => BALL,
    });
    made.lights.clear();
    if form == StandIn::Tall {
        made.objects[0].surface = Surface::Shape(Shape::Cylinder {
            radius_m: 0.011,
            height_m: 0.04,
            rounding_m: 0.002,
        });
    }
    made
}

/// A round or a tall body with scratches, under the lights of the dome: the lamp is mirrored in its front.
fn body(form: StandIn, layers: &[Scratches]) -> Description {
    let mut lit = of_form(form);
    let dome = read(DOME);
    // A bent surface shows lamps smaller, and larger ones keep the light of its scratches.
    let (facing, reach_m, lamp) = match form {
        StandIn::Flat | StandIn::Round => (DVec3::new(-0.25, -0.85, 0.4), 0.02, 5.0),
        StandIn::Tall => (DVec3::new(-0.25, -0.95, 0.0), 0.011, 2.0),
    };
    let normal = facing.normalize();
    let mut lights = dome.lights;
    if let LightKind::Sphere { radius_m, .. } = &mut lights[0].kind {
        *radius_m *= lamp;
    }
    let eye_m = DVec3::from(lit.camera.position_m);
    place_highlight(&mut lights[0], eye_m, reach_m * normal, normal);
    lit.lights = lights;
    lit.camera.exposure_ev = dome.camera.exposure_ev;
    lit.scratches = layers.to_vec();
    lit
}

const MIDDLE_M: DVec3 = DVec3::new(0.0, 0.002, 0.0008);
const BESIDE_M: DVec3 = DVec3::new(-0.0125, 0.005, 0.0);

/// The light where the camera sees its reflection at a point of the dome.
fn mirrored(mut light: Light, description: &Description, point_m: DVec3) -> Light {
    let eye_m = DVec3::from(description.camera.position_m);
    place_highlight(&mut light, eye_m, point_m, DVec3::Z);
    light
}

/// What a picture is made of, in a number.
fn fingerprint(thumb: Thumb) -> u64 {
    let (description, map) = scene_of(thumb, SIDE_PX);
    let text = format!("{thumb:?} {map:?} {}", description.to_toml().unwrap());
    // FNV-1a.
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
    })
}

fn fingerprints() -> String {
    let lines = Thumb::all().map(|thumb| format!("{:016x} {thumb:?}\n", fingerprint(thumb)));
    lines.collect()
}

const MADE_OF: &str = include_str!("../../assets/tiles.txt");
const HINT: &str =
    "out of date: HAIRLINE_WRITE=1 cargo test --release -p hairline-viewer-lib --lib tiles";

/// The codes of a picture on the sheet.
fn on_sheet(place: usize) -> Vec<u8> {
    let sheet = super::sheet_of(super::SHEET).unwrap();
    let side = SIDE_PX as usize;
    let [x0, y0] = [place % COLUMNS as usize, place / COLUMNS as usize].map(|i| i * side);
    let pixels = (0..side * side).map(|i| (x0 + i % side, y0 + i / side));
    let codes = pixels.flat_map(|(x, y)| {
        let [r, g, b, _] = sheet[(x, y)].to_array();
        [r, g, b]
    });
    codes.collect()
}

fn write() {
    let all: Vec<Thumb> = Thumb::all().collect();
    let side = SIDE_PX as usize;
    let width = COLUMNS as usize * side;
    let height = all.len().div_ceil(COLUMNS as usize) * side;
    let mut sheet = vec![0; 3 * width * height];
    let mut studio = Studio::default();
    for (place, thumb) in all.into_iter().enumerate() {
        let [x0, y0] = [place % COLUMNS as usize, place / COLUMNS as usize].map(|i| i * side);
        for (y, row) in studio.picture(thumb, SIDE_PX).chunks(3 * side).enumerate() {
            let at = 3 * ((y0 + y) * width + x0);
            sheet[at..at + row.len()].copy_from_slice(row);
        }
    }
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let mut bytes = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 90)
        .encode(
            &sheet,
            width as u32,
            height as u32,
            image::ExtendedColorType::Rgb8,
        )
        .unwrap();
    std::fs::write(assets.join("tiles.jpg"), bytes).unwrap();
    std::fs::write(assets.join("tiles.txt"), fingerprints()).unwrap();
}

#[test]
fn tiles_are_made_of_the_presets_that_there_are() {
    if std::env::var_os("HAIRLINE_WRITE").is_some() {
        write();
        return;
    }
    assert!(fingerprints() == MADE_OF, "{HINT}");
}

/// A few that are soon rendered stand for all.
#[test]
fn tiles_are_what_the_renderer_makes() {
    let few = [
        Thumb::Shape(ShapePreset::Torus),
        Thumb::Map(BuiltInMap::Window),
        Thumb::Light(LightPreset::SmallLamp),
        Thumb::Material(MaterialPreset::CarPaint, StandIn::Tall),
        Thumb::Wear(Wear::ALL[1], StandIn::Round),
        Thumb::Grating(GratingPreset::ALL[0], StandIn::Flat),
    ];
    let mut studio = Studio::default();
    for thumb in few {
        let place = Thumb::all().position(|other| other == thumb).unwrap();
        let (made, there) = (studio.picture(thumb, SIDE_PX), on_sheet(place));
        let off = made
            .iter()
            .zip(&there)
            .map(|(a, b)| u64::from(a.abs_diff(*b)));
        let mean = off.sum::<u64>() as f64 / made.len() as f64;
        assert!(mean < 6.0, "{thumb:?} is {mean} codes off: {HINT}");
    }
}

#[test]
fn each_tile_has_a_picture_of_its_own() {
    let all: Vec<(Thumb, Vec<u8>)> = Thumb::all()
        .enumerate()
        .map(|(place, thumb)| (thumb, on_sheet(place)))
        .collect();
    for (i, (thumb, codes)) in all.iter().enumerate() {
        let mean = codes.iter().map(|c| u32::from(*c)).sum::<u32>() / codes.len() as u32;
        assert!((6..235).contains(&mean), "{thumb:?}: {mean}");
        for (other, others) in &all[..i] {
            assert!(codes != others, "{thumb:?} {other:?}");
        }
    }
}

/// Steel, nickel and titanium are greys: side by side their pictures are told apart.
#[test]
fn grey_metals_are_told_apart_by_their_tiles() {
    let greys = [Metal::StainlessSteel, Metal::Nickel, Metal::Titanium];
    for form in StandIn::ALL {
        let colors = greys.map(|metal| {
            let thumb = Thumb::Material(MaterialPreset::Metal(metal), form);
            let place = Thumb::all().position(|other| other == thumb).unwrap();
            // The middle, without the ground.
            let side = SIDE_PX as usize;
            let codes = on_sheet(place);
            let middle = (0..side * side).filter(|i| {
                [i % side, i / side]
                    .into_iter()
                    .all(|x| (side / 3..2 * side / 3).contains(&x))
            });
            let mut sum = [0.0; 3];
            let mut count = 0.0;
            for i in middle {
                sum = [0, 1, 2].map(|c| sum[c] + f64::from(codes[3 * i + c]));
                count += 1.0;
            }
            sum.map(|sum| sum / count)
        });
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            let off = [0, 1, 2].map(|c| (colors[a][c] - colors[b][c]).abs());
            let all: f64 = off.iter().sum();
            assert!(
                all > 16.0,
                "{form:?} {:?} {:?}: {off:?}",
                greys[a],
                greys[b]
            );
        }
    }
}
