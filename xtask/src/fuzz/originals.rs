//! Sound inputs, small ones, that are mutated.

use anyhow::{Context, Result};
use hairline_image::{Display, Output, Picture};
use rand::RngExt;
use rand_pcg::Pcg64;

use super::case::{Case, Kind};
use super::mutate;

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

/// Packed as ETC1S, and as UASTC.
const KTX2: [&[u8]; 2] = [
    include_bytes!("../../../crates/scene/tests/scene/images/etc1s.ktx2"),
    include_bytes!("../../../crates/scene/tests/scene/images/uastc_zstd.ktx2"),
];

/// All of them, made once.
pub struct Originals {
    exr: Vec<u8>,
    hdr: Vec<u8>,
    png: Vec<u8>,
    /// The binary chunk of the model.
    bin: Vec<u8>,
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
    })
}

impl Originals {
    /// A mutated input of a kind.
    pub fn case(&self, kind: Kind, random: &mut Pcg64) -> Case {
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
        let files = match kind {
            Kind::Toml => {
                let text = format!("{HEAD}{SHAPES}");
                vec![file("scene.toml", mutate::text(&text, random))]
            }
            Kind::Csv => vec![
                scene(&format!("{PLATE}{LIST}")),
                file("list.csv", mutate::text(CSV, random)),
            ],
            Kind::Glb => {
                // Either the text in it or the whole.
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
            Kind::Gltf => {
                let text = json(Some("a.bin"), "tile.png");
                vec![
                    with_model("a.gltf"),
                    file("a.gltf", mutate::text(&text, random)),
                    file("a.bin", self.bin.clone()),
                    file("tile.png", self.png.clone()),
                ]
            }
            Kind::Hdr => vec![map("map.hdr"), file("map.hdr", mutated(&self.hdr, random))],
            Kind::Exr => vec![map("map.exr"), file("map.exr", mutated(&self.exr, random))],
            Kind::Png => vec![
                with_model("a.gltf"),
                file("a.gltf", json(Some("a.bin"), "tile.png").into_bytes()),
                file("a.bin", self.bin.clone()),
                file("tile.png", mutated(&self.png, random)),
            ],
            Kind::Ktx2 => {
                let original = KTX2[random.random_range(0..KTX2.len())];
                vec![
                    with_model("a.gltf"),
                    file("a.gltf", json(Some("a.bin"), "tile.ktx2").into_bytes()),
                    file("a.bin", self.bin.clone()),
                    file("tile.ktx2", mutated(original, random)),
                ]
            }
        };
        Case {
            name: String::new(),
            files,
        }
    }
}

/// A scene with what is given, for cases that were found.
pub fn scene_with(more: &str) -> String {
    format!("{HEAD}{more}")
}

/// Four corners with normals and texture coordinates, and the indices of four triangles.
fn tetrahedron() -> Vec<u8> {
    let corners = [
        [0.0f32, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let normals = [
        [0.577f32, 0.577, 0.577],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let uvs = [[0.0f32, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let indices: [u16; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
    let floats = corners
        .iter()
        .flatten()
        .chain(normals.iter().flatten())
        .chain(uvs.iter().flatten());
    let floats = floats.flat_map(|x| x.to_le_bytes());
    floats
        .chain(indices.iter().flat_map(|x| x.to_le_bytes()))
        .collect()
}

fn json(uri: Option<&str>, image: &str) -> String {
    let uri = uri.map_or(String::new(), |uri| format!("\"uri\": \"{uri}\", "));
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0, "children": [1], "scale": [1, 1, 2]}}, {{"mesh": 0, "translation": [1, 0, 0], "rotation": [0, 0, 0, 1]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}, "indices": 3, "material": 0, "mode": 4}}]}}],
"materials": [{{"name": "m", "pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}, "metallicFactor": 0.9, "roughnessFactor": 0.4}},
"normalTexture": {{"index": 0, "scale": 0.5}}}}],
"textures": [{{"source": 0}}], "images": [{{"uri": "{image}"}}],
"buffers": [{{{uri}"byteLength": 152}}],
"bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 48}},
{{"buffer": 0, "byteOffset": 96, "byteLength": 32}}, {{"buffer": 0, "byteOffset": 128, "byteLength": 24}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}},
{{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"}},
{{"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"}},
{{"bufferView": 3, "componentType": 5123, "count": 12, "type": "SCALAR"}}]}}"#
    )
}

/// A binary file of a text and a chunk.
fn glb(text: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut text = text.to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + bin.len();
    let number = |n: usize| (n as u32).to_le_bytes();
    [
        &b"glTF"[..],
        &number(2),
        &number(length),
        &number(text.len()),
        b"JSON",
        &text,
        &number(bin.len()),
        b"BIN\0",
        &bin,
    ]
    .concat()
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
    vec![
        case("sound-toml", vec![("scene.toml", scene(SHAPES.to_owned()))]),
        case(
            "sound-csv",
            vec![
                ("scene.toml", scene(format!("{PLATE}{LIST}"))),
                ("list.csv", CSV.into()),
            ],
        ),
        case(
            "sound-glb",
            vec![
                ("scene.toml", scene(MODEL.replace("FILE", "a.glb"))),
                (
                    "a.glb",
                    glb(json(None, "tile.png").as_bytes(), &originals.bin),
                ),
                ("tile.png", originals.png.clone()),
            ],
        ),
        case(
            "sound-ktx2",
            vec![
                ("scene.toml", scene(MODEL.replace("FILE", "a.glb"))),
                (
                    "a.glb",
                    glb(json(None, "tile.ktx2").as_bytes(), &originals.bin),
                ),
                ("tile.ktx2", KTX2[0].to_vec()),
            ],
        ),
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
    ]
}
