//! The scenes of the small pictures.

use std::path::Path;

use egui::ColorImage;
use glam::DVec3;
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_editor::place_light::place_highlight;
use hairline_editor::presets::{LayerPreset, MaterialPreset};
use hairline_image::{Picture, png};
use hairline_scene::description::{
    Light, LightKind, Material, MaterialKind, Scratches, Shape, Surface,
};
use hairline_scene::environment::BuiltInMap;
use hairline_scene::{Description, Environment, Loader};

use super::thumb::{StandIn, Thumb};

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
pub(super) struct Studio {
    map: Option<Environment>,
}

impl Studio {
    /// Renders a picture; none where the scene cannot be made, which a test excludes.
    pub fn picture(&mut self, thumb: Thumb, side_px: u32) -> Option<ColorImage> {
        let (description, map) = match thumb {
            Thumb::Layer(preset, StandIn::Flat) => {
                let mut dome = dome(&[preset.layer("o", DOME_DIAGONAL_M)]);
                if matches!(preset, LayerPreset::PolishedWatch | LayerPreset::SpunDisk) {
                    // Scratches that run to the middle light up between it and a lamp beside it.
                    dome.lights[0] = mirrored(dome.lights[0].clone(), &dome, BESIDE_M);
                }
                (dome, None)
            }
            Thumb::Layer(preset, form) => (body(form, &[preset.layer("o", BODY_M)]), None),
            Thumb::Wear(wear, StandIn::Flat) => {
                (dome(&wear.layers("o", 0.7 * DOME_DIAGONAL_M)), None)
            }
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
                let material = preset.material();
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
        let mut description = description;
        description.render.size_px = [side_px; 2];
        let mut scene = Loader::default().build(&description, Path::new("")).ok()?;
        match thumb {
            // A flat one mirrors the soft box above it alone.
            Thumb::Material(MaterialPreset::Metal(_) | MaterialPreset::Mirror, StandIn::Flat) => {
                description.camera.exposure_ev = -3.5;
            }
            Thumb::Shape(_) | Thumb::Material(..) => description.camera.exposure_ev = 0.5,
            _ => {}
        }
        if let Some(map) = map {
            let is_seen = matches!(thumb, Thumb::Map(_));
            scene.environment = Some(self.environment(map).with_visible(is_seen));
        }
        let options = RenderOptions {
            samples: 2,
            ..RenderOptions::default()
        };
        let image = closed_form::render(&scene, &options, &|_| {});
        let display = hairline_image::Display {
            exposure_ev: description.camera.exposure_ev,
            tone_map: description.render.tone_map,
        };
        // The ground of menus, where there is nothing.
        let mut beauty = image.beauty();
        if !matches!(thumb, Thumb::Map(_)) {
            let nothing = image.depth_m.iter().map(|depth_m| *depth_m == 0.0);
            for (rgb, is_nothing) in beauty.rgb.iter_mut().zip(nothing) {
                if is_nothing {
                    *rgb = GROUND;
                }
            }
        }
        let size = [side_px as usize; 2];
        let codes = png::quantize(&beauty, &display);
        Some(ColorImage::from_rgb(size, &codes))
    }

    fn environment(&mut self, map: BuiltInMap) -> Environment {
        let make = |map: BuiltInMap| {
            let picture: Picture = map.picture([64, 32]);
            // The window is before the ball, where it is seen in it.
            let rotation_rad = if map == BuiltInMap::Window { 2.5 } else { 0.0 };
            Environment::from_map(picture, rotation_rad, 1.0, false).with_up(DVec3::Z, rotation_rad)
        };
        match map {
            // Map of the pictures of all materials and shapes.
            BuiltInMap::Studio => self.map.get_or_insert_with(|| make(map)).clone(),
            other => make(other),
        }
    }
}

const GROUND: [f32; 3] = [0.012; 3];

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
    let (way, reach_m, lamp) = match form {
        StandIn::Flat | StandIn::Round => (DVec3::new(-0.25, -0.85, 0.4), 0.02, 5.0),
        StandIn::Tall => (DVec3::new(-0.25, -0.95, 0.0), 0.011, 2.0),
    };
    let normal = way.normalize();
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

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_editor::grating_presets::GratingPreset;
    use hairline_editor::presets::{LightPreset, ShapePreset};
    use hairline_editor::wear::Wear;

    #[test]
    fn each_has_a_picture_of_its_own() {
        // The most expensive pictures are like others, and one body shows as much as three.
        have_pictures_of_their_own(
            all().filter(|thumb| match thumb {
                Thumb::Wear(wear, form) => {
                    *form == StandIn::Flat && !matches!(wear, Wear::Keys | Wear::Polished)
                }
                Thumb::Layer(layer, form) => {
                    *form == StandIn::Flat
                        && !matches!(layer, LayerPreset::TurnedPan | LayerPreset::SpunDisk)
                }
                Thumb::Grating(_, form) => *form == StandIn::Flat,
                Thumb::Light(_) => true,
                _ => false,
            }),
            8,
        );
    }

    #[test]
    fn so_has_each_material_and_shape() {
        // One body
        have_pictures_of_their_own(
            all().filter(|thumb| {
                matches!(thumb, Thumb::Shape(_) | Thumb::Material(_, StandIn::Flat))
            }),
            8,
        );
    }

    #[test]
    #[ignore = "long: cargo long"]
    fn so_has_each_on_every_body() {
        have_pictures_of_their_own(all(), 96);
    }

    fn all() -> impl Iterator<Item = Thumb> {
        let on = |form: StandIn| {
            let layers = LayerPreset::ALL.map(|p| Thumb::Layer(p, form)).into_iter();
            layers
                .chain(MaterialPreset::all().map(move |p| Thumb::Material(p, form)))
                .chain(Wear::ALL.map(|p| Thumb::Wear(p, form)))
                .chain(GratingPreset::ALL.map(|p| Thumb::Grating(p, form)))
        };
        let lights = LightPreset::ALL.map(Thumb::Light).into_iter();
        lights
            .chain(ShapePreset::ALL.map(Thumb::Shape))
            .chain(BuiltInMap::ALL.map(Thumb::Map))
            .chain(StandIn::ALL.into_iter().flat_map(on))
    }

    /// With `HAIRLINE_GALLERY=FOLDER` it leaves the pictures in that folder.
    fn have_pictures_of_their_own(thumbs: impl Iterator<Item = Thumb>, side_px: u32) {
        let mut studio = Studio::default();
        let pictures: Vec<(Thumb, ColorImage)> = thumbs
            .map(|thumb| {
                let t = std::time::Instant::now();
                let picture = studio.picture(thumb, side_px);
                eprintln!("{:.2} {thumb:?}", t.elapsed().as_secs_f64());
                (thumb, picture.expect("a picture"))
            })
            .collect();
        if let Some(folder) = std::env::var_os("HAIRLINE_GALLERY") {
            write_sheet(&pictures, Path::new(&folder));
        }
        for (i, (thumb, a)) in pictures.iter().enumerate() {
            let mean =
                a.pixels.iter().map(|p| u32::from(p.g())).sum::<u32>() / a.pixels.len() as u32;
            assert!((6..235).contains(&mean), "{thumb:?}: {mean}");
            for (other, b) in &pictures[..i] {
                assert!(a.pixels != b.pixels, "{thumb:?} {other:?}");
            }
        }
    }

    /// Writes all pictures on one sheet, to look at.
    fn write_sheet(pictures: &[(Thumb, ColorImage)], folder: &Path) {
        const COLUMNS: usize = 9;
        let side = pictures[0].1.size[0];
        let rows = pictures.len().div_ceil(COLUMNS);
        let mut sheet = Picture::new([(COLUMNS * side) as u32, (rows * side) as u32]);
        for (i, (_, picture)) in pictures.iter().enumerate() {
            let (x0, y0) = (i % COLUMNS * side, i / COLUMNS * side);
            for (j, pixel) in picture.pixels.iter().enumerate() {
                let at = (y0 + j / side) * COLUMNS * side + x0 + j % side;
                let code = |c: u8| hairline_image::tone_map::linear_from_srgb(f32::from(c) / 255.0);
                sheet.rgb[at] = [pixel.r(), pixel.g(), pixel.b()].map(code);
            }
        }
        let output = hairline_image::Output::check(&folder.join("gallery.png")).unwrap();
        let display = hairline_image::Display {
            exposure_ev: 0.0,
            tone_map: hairline_image::ToneMap::None,
        };
        output.write_picture(&sheet, &display).unwrap();
    }
}
