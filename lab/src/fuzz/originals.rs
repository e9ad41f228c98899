//! Sound inputs, small ones, that are mutated.

use anyhow::{Context, Result};
use hairline_image::{Display, Output, Picture};
use rand::RngExt;
use rand_pcg::Pcg64;

use super::case::{Case, InputKind};
use super::model::{glb, json, tetrahedron};
use super::mutate;
use super::packed::{self, Packed};

const HEAD: &str = r#"[camera]
position_m = [0.0, -0.22, 0.30]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 30.0

[render]
size_px = [16, 9]
tone_map = "neutral"

[[material]]
name = "steel"
kind = "metal"
metal = "iron"
roughness = 0.2

[[light]]
kind = "sphere"
center_m = [0.06, 0.10, 0.25]
radius_m = 0.02
radiance = 40.0

[[light]]
kind = "polygon"
vertices_m = [[-1.0, 1.0, 0.2], [1.0, 1.0, 0.2], [1.0, 0.2, 1.4], [-1.0, 0.2, 1.4]]
radiance = 0.1
two_sided = true
"#;

const SHAPES: &str = r#"
[[object]]
name = "plate"
shape = { disk = { radius_m = 0.08 } }
material = "steel"
rotation_deg = [0.0, 10.0, 0.0]

[[object]]
name = "ring"
shape = { lathe = { profile_m = [[0.05, 0.0], [0.06, 0.01], [0.05, 0.02]], segments = 24, smooth = true } }
material = "steel"
scale = [1.0, 1.0, 2.0]

[[scratches]]
object = "plate"
pattern = "spun"
count = 40
seed = 3
curvature_per_m = { mean = 20.0, spread = 2.0 }

[[scratches]]
object = "ring"
pattern = "drawn"
jitter_deg = 8.0
strokes = [
    { points_m = [[-0.05, -0.01, 0.01], [0.0, 0.05, 0.01]], radius_m = 0.006, density_per_m = 500.0 },
    { points_m = [[0.0, -0.05, 0.01]], radius_m = 0.002, erase = true },
]

[[scratches]]
object = "plate"
pattern = "swirl"
density_per_m2 = 2000.0
length_m = { mean = 0.02, spread = 0.5 }
width_um = 4.0
depth_nm = { mean = 130.0, spread = 0.1 }
"#;

const PLATE: &str = "\n[[object]]\nname = \"plate\"\nshape = { plane = { size_m = [0.2, 0.2] } }\nmaterial = \"steel\"\n";
const MODEL: &str = "\n[[object]]\nname = \"model\"\nmesh = \"FILE\"\nfit_m = 0.1\n\n[[scratches]]\nobject = \"model\"\npattern = \"random\"\ncount = 20\n";
const LIST: &str = "\n[[scratches]]\nobject = \"plate\"\npattern = \"file\"\nfile = \"list.csv\"\n";
const CSV: &str = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n-0.04,0.01,0,0.05,0.02,0,4.2,130\n0.00,-0.03,0,0.01,0.04,0,4.5,138\n";

macro_rules! image {
    ($name:literal) => {
        include_bytes!(concat!(
            "../../../crates/document/tests/document/images/",
            $name
        ))
    };
}

/// Packed as ETC1S, and as UASTC.
const KTX2: [&[u8]; 2] = [image!("etc1s.ktx2"), image!("uastc_zstd.ktx2")];
/// WebP images: one with losses and an alpha beside it, one without.
const WEBP: [&[u8]; 2] = [image!("lossy.webp"), image!("lossless.webp")];
/// Row by row, with colours of half the size and marks to begin again at; and in passes.
const JPEG: [&[u8]; 2] = [image!("baseline.jpg"), image!("progressive.jpg")];

/// All original files, made once.
pub struct Originals {
    exr: Vec<u8>,
    hdr: Vec<u8>,
    png: Vec<u8>,
    /// The binary chunk of the model.
    bin: Vec<u8>,
    draco: Vec<Packed>,
    meshopt: Packed,
}

pub fn all() -> Result<Originals> {
    let folder = tempfile::tempdir().context("make a folder")?;
    let map = Picture {
        size_px: [32, 16],
        rgb: (0..32 * 16)
            .map(|i| {
                if i == 40 {
                    [900.0; 3]
                } else {
                    [0.3, 0.4, i as f32 / 512.0]
                }
            })
            .collect(),
    };
    let tile = Picture {
        size_px: [8, 8],
        rgb: (0..64).map(|i| [i as f32 / 64.0, 0.5, 0.7]).collect(),
    };
    let written = |name: &str, picture: &Picture| -> Result<Vec<u8>> {
        let path = folder.path().join(name);
        Output::check(&path)?.write_picture(picture, &Display::default())?;
        Ok(std::fs::read(&path)?)
    };
    let mut hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.0\n\n-Y 16 +X 32\n".to_vec();
    hdr.extend(
        (0..16 * 32u32).flat_map(|i| [100, 90, (i % 256) as u8, if i == 70 { 138 } else { 128 }]),
    );
    Ok(Originals {
        exr: written("a.exr", &map)?,
        png: written("a.png", &tile)?,
        hdr,
        bin: tetrahedron(),
        draco: packed::draco()?,
        meshopt: packed::meshopt()?,
    })
}

impl Originals {
    /// A mutated input of a kind.
    pub fn case(&self, kind: InputKind, random: &mut Pcg64) -> Case {
        let scene = |more: &str| {
            (
                "scene.toml".to_owned(),
                format!("{HEAD}{more}").into_bytes(),
            )
        };
        let with_model = |name: &str| scene(&MODEL.replace("FILE", name));
        let file = |name: &str, bytes: Vec<u8>| (name.to_owned(), bytes);
        let map = |name: &str| scene(&format!("{PLATE}\n[environment]\nfile = \"{name}\"\n"));
        let mutated = |original: &[u8], random: &mut Pcg64| {
            let mut bytes = original.to_vec();
            mutate::bytes(&mut bytes, random);
            bytes
        };
        let with_image = |name: &str, image: Vec<u8>| {
            vec![
                with_model("a.gltf"),
                file("a.gltf", json(Some("a.bin"), name).into_bytes()),
                file("a.bin", self.bin.clone()),
                file(name, image),
            ]
        };
        let files = match kind {
            InputKind::Toml => {
                let text = format!("{HEAD}{SHAPES}");
                vec![file("scene.toml", mutate::text(&text, random))]
            }
            InputKind::Csv => vec![
                scene(&format!("{PLATE}{LIST}")),
                file("list.csv", mutate::text(CSV, random)),
            ],
            InputKind::Glb => {
                // Changes either the text in the file or the whole file.
                let glb = match random.random_range(0..2) {
                    0 => glb(&mutate::text(&json(None, "tile.png"), random), &self.bin),
                    _ => mutated(&glb(json(None, "tile.png").as_bytes(), &self.bin), random),
                };
                vec![
                    with_model("a.glb"),
                    file("a.glb", glb),
                    file("tile.png", self.png.clone()),
                ]
            }
            InputKind::Gltf => {
                let text = json(Some("a.bin"), "tile.png");
                vec![
                    with_model("a.gltf"),
                    file("a.gltf", mutate::text(&text, random)),
                    file("a.bin", self.bin.clone()),
                    file("tile.png", self.png.clone()),
                ]
            }
            InputKind::Hdr => vec![map("map.hdr"), file("map.hdr", mutated(&self.hdr, random))],
            InputKind::Exr => vec![map("map.exr"), file("map.exr", mutated(&self.exr, random))],
            InputKind::Png => with_image("tile.png", mutated(&self.png, random)),
            InputKind::Ktx2 => with_image("tile.ktx2", mutated(one(&KTX2, random), random)),
            InputKind::Webp => with_image("tile.webp", mutated(one(&WEBP, random), random)),
            InputKind::Jpeg => with_image("tile.jpg", mutated(one(&JPEG, random), random)),
            InputKind::Draco => {
                let original = &self.draco[random.random_range(0..self.draco.len())];
                vec![
                    with_model("a.glb"),
                    file("a.glb", repacked(original, random)),
                ]
            }
            InputKind::Meshopt => vec![
                with_model("a.glb"),
                file("a.glb", repacked(&self.meshopt, random)),
            ],
        };
        Case {
            name: String::new(),
            files,
        }
    }
}

fn one<'a>(images: &[&'a [u8]], random: &mut Pcg64) -> &'a [u8] {
    images[random.random_range(0..images.len())]
}

/// Changes a packed model: three times in four one of its pieces, whose new length goes into its text, else the
/// text.
fn repacked(original: &Packed, random: &mut Pcg64) -> Vec<u8> {
    let mut changed = original.clone();
    if random.random_range(0..4) > 0 {
        let piece = random.random_range(0..changed.pieces.len());
        mutate::bytes(&mut changed.pieces[piece], random);
        let (text, chunk) = changed.parts();
        return glb(text.as_bytes(), &chunk);
    }
    let (text, chunk) = changed.parts();
    glb(&mutate::text(&text, random), &chunk)
}

/// A scene with the given tables, for cases that were found.
pub fn scene_with(more: &str) -> String {
    format!("{HEAD}{more}")
}

/// Whether all originals are sound: a fuzzer of broken ones finds nothing.
pub fn sound_cases(originals: &Originals) -> Vec<Case> {
    let case = |name: &str, files: Vec<(&str, Vec<u8>)>| Case {
        name: name.to_owned(),
        files: files
            .into_iter()
            .map(|(name, bytes)| (name.to_owned(), bytes))
            .collect(),
    };
    let scene = |more: String| scene_with(&more).into_bytes();
    let model = |name: &str, text: &str, bin: &[u8]| {
        let scene = scene(MODEL.replace("FILE", "a.glb"));
        let files = vec![("scene.toml", scene), ("a.glb", glb(text.as_bytes(), bin))];
        case(name, files)
    };
    let images = [
        ("tile.ktx2", &KTX2),
        ("tile.webp", &WEBP),
        ("tile.jpg", &JPEG),
    ];
    let with_image = |name: &str, image: &[u8]| {
        let mut case = model(&format!("sound-{name}"), &json(None, name), &originals.bin);
        case.files.push((name.to_owned(), image.to_vec()));
        case
    };
    let images = images
        .into_iter()
        .flat_map(|(name, files)| files.iter().map(move |file| (name, file)));
    let packed = originals.draco.iter().chain([&originals.meshopt]);
    let packed = packed.map(|packed| {
        let (text, chunk) = packed.parts();
        model("sound-packed", &text, &chunk)
    });
    let rest = [
        case("sound-toml", vec![("scene.toml", scene(SHAPES.to_owned()))]),
        case(
            "sound-csv",
            vec![
                ("scene.toml", scene(format!("{PLATE}{LIST}"))),
                ("list.csv", CSV.into()),
            ],
        ),
        with_image("tile.png", &originals.png),
        case(
            "sound-hdr",
            vec![
                (
                    "scene.toml",
                    scene(format!("{PLATE}\n[environment]\nfile = \"m.hdr\"\n")),
                ),
                ("m.hdr", originals.hdr.clone()),
            ],
        ),
        case(
            "sound-exr",
            vec![
                (
                    "scene.toml",
                    scene(format!("{PLATE}\n[environment]\nfile = \"m.exr\"\n")),
                ),
                ("m.exr", originals.exr.clone()),
            ],
        ),
    ];
    let images = images.map(|(name, file)| with_image(name, file));
    rest.into_iter().chain(images).chain(packed).collect()
}
