//! Scenes drawn by three.js in Chromium, against the CPU renderer without shadows.

use std::path::Path;

use anyhow::{Context, ensure};
use glam::DMat4;
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_document::export::Export;
use hairline_document::{Description, Loader, write_scratches};
use hairline_image::{Image, Layer};
use hairline_optics::section::Section;
use hairline_scene::{Base, Light, LightShape, Scene};
use serde_json::{Value, json};

use super::browser::{Answer, Folders, answers};
use super::files::{install, write};

/// The scenes in packages/hairline-shaders/test.
const SCENES: [&str; 10] = [
    "plate", "sheet", "grooves", "lacquer", "disc", "foil", "bauble", "tiles", "layers", "sky",
];
/// The most that a picture may be off, as rms over that of the picture.
const LIMIT: f64 = 0.005;
/// The same for what a file gives, over the same set by hand: its numbers were moved to another frame and back.
const FILE_LIMIT: f64 = 1e-3;

/// Draws all scenes and compares them.
pub(super) fn run(root: &Path, output: &Path) -> anyhow::Result<()> {
    let tests = root.join("packages/hairline-shaders/test");
    install(&tests)?;
    let mut pictures = Vec::new();
    for (name, mut scene) in write_pages(root, output)? {
        let worn = render(&scene);
        for object in &mut scene.objects {
            object.scratches = Default::default();
            object.segments = Default::default();
            object.gratings.clear();
        }
        pictures.push((name, worn, render(&scene)));
    }
    let folders: Folders = vec![
        ("/package/", output.join("hairline-shaders")),
        ("/three/", tests.join("node_modules/three")),
        ("/pages/", output.join("pages")),
        ("/test/", tests),
    ];
    let page = format!("/test/page.html?scenes={}", SCENES.join(","));
    let sent = answers(folders, &page)?;
    for (name, worn, bare) in &pictures {
        let drawn = Drawn {
            name,
            sent: &sent,
            inner: inner_pixels(worn),
        };
        let (three, ours) = (drawn.colours("worn")?, cut(worn));
        let pages = output.join("pages").join(name);
        save(&pages.join("hairline.f32"), &ours)?;
        save(&pages.join("three.f32"), &three)?;
        ensure!(
            drawn.bytes("told")?.is_empty(),
            "{name}: the file has more than is drawn"
        );
        drawn.check_files(&three)?;
        drawn.check_faults(&ours)?;
        drawn.check_pictures([&three, &drawn.colours("bare")?], [&ours, &cut(bare)])?;
    }
    Ok(())
}

/// What the page sent of a scene.
struct Drawn<'a> {
    name: &'static str,
    sent: &'a [Answer],
    /// Pixels that are compared.
    inner: Vec<usize>,
}

impl Drawn<'_> {
    fn bytes(&self, what: &str) -> anyhow::Result<&[u8]> {
        let wanted = format!("{}/{what}", self.name);
        let found = self.sent.iter().find(|(path, _)| *path == wanted);
        let (_, bytes) = found.with_context(|| format!("the page sent no {wanted}"))?;
        Ok(bytes)
    }

    fn colours(&self, what: &str) -> anyhow::Result<Vec<[f32; 3]>> {
        self.bytes(what).map(colours)
    }

    /// The rms of the difference over that of the second.
    fn error(&self, a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
        let (mut off, mut all) = (0.0, 0.0);
        for &i in &self.inner {
            for (x, y) in a[i].iter().zip(&b[i]) {
                off += f64::from(x - y).powi(2);
                all += f64::from(*y).powi(2);
            }
        }
        (off / all).sqrt()
    }

    /// The same by a file with its scratches, by one with their seeds, and by one whose scratches nobody reads. `by_hand` is the picture of what
    /// was set by hand.
    fn check_files(&self, by_hand: &[[f32; 3]]) -> anyhow::Result<()> {
        let Self { name, .. } = self;
        if let Ok(of_file) = self.colours("file") {
            let off = self.error(&of_file, by_hand);
            println!(
                "three.js, {name}: a file, against what was set by hand: {:.4} %",
                100.0 * off
            );
            ensure!(off < FILE_LIMIT, "{name}: the file is {off} off");
            if let Ok(of_seeds) = self.colours("seeds") {
                let off = self.error(&of_seeds, &of_file);
                println!(
                    "three.js, {name}: laid by its seeds, against the file: {:.4} %",
                    100.0 * off
                );
                ensure!(off < FILE_LIMIT, "{name}: the seeds are {off} off");
            }
        }
        if let Ok(plain) = self.colours("plain") {
            let has_none = self.error(&plain, by_hand) > 10.0 * FILE_LIMIT;
            ensure!(has_none, "{name}: a file without the plug-in has scratches");
        }
        Ok(())
    }

    /// Pictures with a fault, which must differ from Hairline's.
    fn check_faults(&self, ours: &[[f32; 3]]) -> anyhow::Result<()> {
        let Self { name, .. } = self;
        for (sent, what) in [
            ("turned", "an environment that is turned by 5 degrees"),
            ("unmasked", "gratings without their masks"),
            ("swapped", "gratings along the other texture coordinate"),
        ] {
            if let Ok(faulty) = self.colours(sent) {
                let off = self.error(&faulty, ours);
                println!("three.js, {name}: {what}: {:.1} %", 100.0 * off);
                ensure!(off > 4.0 * LIMIT, "{name}: {what} is not seen");
            }
        }
        Ok(())
    }

    /// Pictures with scratches and without, of three.js and of Hairline.
    fn check_pictures(
        &self,
        [three_worn, three_bare]: [&[[f32; 3]]; 2],
        [worn, bare]: [&[[f32; 3]]; 2],
    ) -> anyhow::Result<()> {
        let Self { name, .. } = self;
        let changes = self.error(&difference(three_worn, three_bare), &difference(worn, bare));
        let mut errors = vec![
            ("picture", self.error(three_worn, worn)),
            ("without scratches", self.error(three_bare, bare)),
            ("what scratches change", changes),
        ];
        for (sent, what) in [
            ("instanced", "as an instance"),
            ("skinned", "as a skin"),
            ("faceted", "without tangents"),
        ] {
            if let Ok(other) = self.colours(sent) {
                errors.push((what, self.error(&other, worn)));
            }
        }
        for (what, error) in &errors {
            println!(
                "three.js, {name}: {what}: relative rms error {:.3} %",
                100.0 * error
            );
        }
        let timing = String::from_utf8_lossy(self.bytes("times")?);
        println!("three.js, {name}: {timing}");
        for (what, error) in errors {
            ensure!(
                error < LIMIT,
                "{name}: {what} is {:.2} % off",
                100.0 * error
            );
        }
        Ok(())
    }
}

fn difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let minus = |(a, b): (&[f32; 3], &[f32; 3])| std::array::from_fn(|c| a[c] - b[c]);
    a.iter().zip(b).map(minus).collect()
}

/// Writes a picture for whoever wants to look at it: three f32 a pixel.
fn save(path: &Path, rgb: &[[f32; 3]]) -> anyhow::Result<()> {
    let bytes: Vec<u8> = rgb.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    write(path, &bytes)
}

/// Writes what the pages of all scenes show, and returns the scenes.
fn write_pages(root: &Path, output: &Path) -> anyhow::Result<Vec<(&'static str, Scene)>> {
    let tests = root.join("packages/hairline-shaders/test");
    let page = |name: &'static str| {
        let file = tests.join(format!("{name}.toml"));
        let scene = hairline_document::load(&file)?;
        let folder = output.join("pages").join(name);
        write_page(&folder, &scene)?;
        let text = std::fs::read_to_string(&file)?;
        let described = Description::from_toml(&text, &file)?;
        for (file, laid) in [("worn.glb", true), ("seeds.glb", false)] {
            let export = Export {
                laid,
                ..Export::default()
            };
            let exported = Loader::default().export(&described, &tests, export)?;
            write(&folder.join(file), &exported.bytes)?;
        }
        Ok((name, scene))
    };
    SCENES.into_iter().map(page).collect()
}

/// Writes a scene as a model with its scratches.
pub(super) fn write_model(scene: &Path, model: &Path) -> anyhow::Result<()> {
    let described = Description::from_toml(&std::fs::read_to_string(scene)?, scene)?;
    let folder = scene.parent().context("a scene without a folder")?;
    let export = Export {
        laid: true,
        ..Export::default()
    };
    let exported = Loader::default().export(&described, folder, export)?;
    write(model, &exported.bytes)
}

fn render(scene: &Scene) -> Image {
    let prepared = Prepared::new(scene).as_laid();
    prepared.render(&RenderOptions::default(), &|_| {})
}

/// Writes the page's contents: the scene as JSON, its first object's mesh and scratches.
fn write_page(folder: &Path, scene: &Scene) -> anyhow::Result<()> {
    let object = &scene.objects[0];
    let mesh = &object.mesh;
    let mut bytes = Vec::new();
    for v in mesh.positions_m.iter().chain(&mesh.normals) {
        bytes.extend(v.to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    bytes.extend(
        mesh.triangles
            .iter()
            .flatten()
            .flat_map(|i| i.to_le_bytes()),
    );
    write(&folder.join("mesh.bin"), &bytes)?;
    let mut list = Vec::new();
    write_scratches(object, object.scratches.iter(), &DMat4::IDENTITY, &mut list)?;
    write(&folder.join("scratches.csv"), &list)?;
    let material = &scene.materials[mesh.triangle_materials[0] as usize];
    let surface = match material.base {
        // The file has it, maps, axes of brushing and gratings.
        _ if material.base_color_texture.is_some()
            || material.coat.is_some()
            || !object.gratings.is_empty() =>
        {
            Value::Null
        }
        Base::Metal(_) => json!({ "metal": "steel" }),
        Base::MetallicRoughness {
            base_color,
            metallic,
        } => json!({ "color": base_color, "metalness": metallic }),
        _ => anyhow::bail!("the test page knows steel and metallic-roughness"),
    };
    let profile = match object
        .scratches
        .first()
        .map(|it| it.profile.section.clone())
    {
        None | Some(Section::Rectangle) => json!("rectangle"),
        Some(Section::V) => json!("v"),
        Some(Section::Round) => json!("round"),
        Some(Section::Shoulders) => json!("shoulders"),
        Some(Section::Listed(depths)) => json!(depths.to_vec()),
    };
    let lights: Vec<Value> = scene.lights.iter().map(light).collect();
    let environment = scene.environment.as_ref().map(|environment| {
        let map = environment.background();
        let texels = map.rgb.iter().flatten().flat_map(|c| c.to_le_bytes());
        write(&folder.join("environment.bin"), &texels.collect::<Vec<_>>())?;
        Ok::<_, anyhow::Error>(json!({
            "size": map.size_px, "intensity": environment.texel_radiance(),
            "mapFromWorld": environment.map_from_world().to_cols_array(),
        }))
    });
    let camera = &scene.camera;
    let page = json!({
        "size": scene.render.size_px,
        "camera": {
            "position": camera.position_m.to_array(), "target": camera.target_m.to_array(),
            "up": camera.up.to_array(), "fov": camera.fov_y_rad.to_degrees(),
        },
        "vertices": mesh.positions_m.len(), "triangles": mesh.triangles.len(),
        "surface": surface, "roughness": material.roughness, "profile": profile, "lights": lights,
        "environment": environment.transpose()?,
    });
    write(&folder.join("scene.json"), &serde_json::to_vec(&page)?)
}

/// A light as the page takes it; angles from the middle of a cone to its rim, and to where light begins to fall.
fn light(light: &Light) -> Value {
    let mut written = match &light.shape {
        LightShape::Sphere { center_m, radius_m } => json!({
            "kind": "sphere", "center": center_m.to_array(), "radius": radius_m,
        }),
        LightShape::Polygon { vertices_m, .. } => json!({
            "kind": "flat", "corners": vertices_m.iter().map(|v| v.to_array()).collect::<Vec<_>>(),
        }),
        LightShape::Tube { ends_m, radius_m } => json!({
            "kind": "tube", "ends": ends_m.map(|v| v.to_array()), "radius": radius_m,
        }),
    };
    written["radiance"] = json!(light.radiance);
    if let Some(cone) = light.cone {
        written["cone"] = json!({
            "axis": cone.axis.to_array(), "outer": cone.cos_outer.acos(), "inner": cone.cos_inner.acos(),
        });
    }
    written
}

/// The picture without channels below 0, those outside of the gamut, which three.js cuts.
fn cut(image: &Image) -> Vec<[f32; 3]> {
    let rgb = image.layer(Layer::Beauty);
    rgb.iter().map(|rgb| rgb.map(|c| c.max(0.0))).collect()
}

/// Four f32 a pixel.
fn colours(bytes: &[u8]) -> Vec<[f32; 3]> {
    let (pixels, _) = bytes.as_chunks::<16>();
    let channel = |pixel: &[u8; 16], c: usize| {
        f32::from_le_bytes([
            pixel[4 * c],
            pixel[4 * c + 1],
            pixel[4 * c + 2],
            pixel[4 * c + 3],
        ])
    };
    pixels
        .iter()
        .map(|pixel| std::array::from_fn(|c| channel(pixel, c)))
        .collect()
}

/// Pixels around which all is covered: rims are smoothed by samples in one picture and not in the other.
fn inner_pixels(image: &Image) -> Vec<usize> {
    let [width, height] = image.size_px.map(|n| n as usize);
    let is_inner = |i: &usize| {
        let (x, y) = (i % width, i / width);
        (-2..=2_isize).all(|dy| {
            (-2..=2_isize).all(|dx| {
                let at = [(x, dx, width), (y, dy, height)]
                    .map(|(at, step, size)| at.saturating_add_signed(step).min(size - 1));
                image.depth_m[at[1] * width + at[0]] > 0.0
            })
        })
    };
    (0..width * height).filter(is_inner).collect()
}
