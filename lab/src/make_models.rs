//! `cargo lab make-models`: the models of our own that `scenes/` shows, the sky over one of them, and a soft box. Everything in them is computed here, by
//! functions that give the same bits on every platform.

mod glb;
mod handle_texture;
mod knife;
mod sky;
mod soft_box;
mod spline;
mod spoon;

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use glam::DQuat;
use serde_json::json;

use glb::{Glb, PartContents};
use spoon::Spoon;

/// Options of `make-models`.
#[derive(clap::Args)]
pub struct MakeModels {
    /// Compare with the committed files instead of writing; fails where they differ.
    #[arg(long)]
    check: bool,
}

impl MakeModels {
    /// Makes and writes, or compares.
    pub fn run(self) -> Result<()> {
        let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        for (name, bytes) in [
            ("models/spoon.glb", spoons()?),
            ("models/knife.glb", cooks_knife()?),
            ("maps/evening.hdr", sky::evening()?),
            ("maps/soft_box.png", soft_box::cloth()?),
        ] {
            println!("{name}: {} bytes", bytes.len());
            let path = scenes.join(name);
            if self.check {
                let committed = std::fs::read(&path).with_context(|| format!("read {path:?}"))?;
                ensure!(committed == bytes, "{path:?} is not what this code makes");
                continue;
            }
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder).with_context(|| format!("make {folder:?}"))?;
            }
            std::fs::write(&path, bytes).with_context(|| format!("write {path:?}"))?;
        }
        Ok(())
    }
}

/// Two dessert spoons side by side, y up, metres: one lies on its back, the other, the same meshes again, on its face.
fn spoons() -> Result<Vec<u8>> {
    let spoon = Spoon::new();
    let mut glb = Glb::default();
    let texture = handle_texture::paint(&spoon);
    let images = [
        ("handle colour", &texture.base_color),
        ("handle metallic-roughness", &texture.metallic_roughness),
        ("handle normal", &texture.normal),
    ];
    for (name, image) in images {
        glb.image(name, image)?;
    }
    glb.root["samplers"] =
        json!([{ "magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497 }]);
    glb.root["textures"] = json!([
        { "source": 0, "sampler": 0 }, { "source": 1, "sampler": 0 }, { "source": 2, "sampler": 0 },
    ]);
    glb.root["materials"] = json!([
        {
            "name": "polished silver",
            "pbrMetallicRoughness": { "baseColorFactor": [0.962, 0.949, 0.922, 1.0], "roughnessFactor": 0.06 },
        },
        {
            "name": "engraved silver",
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": 0 },
                "metallicRoughnessTexture": { "index": 1 },
            },
            "normalTexture": { "index": 2, "scale": 1.0 },
        },
    ]);
    // The bowl has no normal map, so it needs no tangents: a reader must make do without.
    let bowl = glb.primitive(&spoon.bowl(), 0, PartContents { tangents: false });
    let handle = glb.primitive(&spoon.handle(), 1, PartContents { tangents: true });
    glb.root["meshes"] = json!([
        { "name": "bowl", "primitives": [bowl] },
        { "name": "handle", "primitives": [handle] },
    ]);

    // In f32 the last bits of sines, which differ between platforms, are gone.
    let rotation = |rotation: DQuat| json!(rotation.as_quat().to_array());
    let on_back = DQuat::from_rotation_z(0.12) * DQuat::from_rotation_y(spoon::ON_BACK_RAD);
    let on_face = DQuat::from_rotation_z(-0.16)
        * DQuat::from_rotation_y(spoon::ON_FACE_RAD)
        * DQuat::from_rotation_x(PI);
    // The handle's own frame starts at the joint.
    let handle_at = [spoon::JOINT_MM, 0.0, 0.0];
    let middle_mm = spoon::LENGTH_MM / 2.0;
    glb.root["nodes"] = json!([
        // Millimetres, z up, to metres, y up.
        {
            "name": "spoons", "children": [1, 4], "scale": [0.001, 0.001, 0.001],
            "rotation": rotation(DQuat::from_rotation_x(-FRAC_PI_2)),
        },
        {
            "name": "on its back", "children": [2, 3], "rotation": rotation(on_back),
            "translation": [-middle_mm, -30.0, spoon::ON_BACK_MM],
        },
        { "name": "bowl", "mesh": 0 },
        { "name": "handle", "mesh": 1, "translation": handle_at },
        {
            "name": "on its face", "children": [5, 6], "rotation": rotation(on_face),
            "translation": [-middle_mm + 22.0, 28.0, spoon::ON_FACE_MM],
        },
        { "name": "bowl", "mesh": 0 },
        { "name": "handle", "mesh": 1, "translation": handle_at },
    ]);
    glb.root["scenes"] = json!([{ "name": "spoons", "nodes": [0] }]);
    glb.root["scene"] = json!(0);
    glb.finish()
}

/// A cook's knife on its side, y up, metres, the middle of the blade's heel at the origin.
fn cooks_knife() -> Result<Vec<u8>> {
    let mut glb = Glb::default();
    let metal = |name: &str, roughness: f64| {
        json!({
            "name": name,
            "pbrMetallicRoughness": { "baseColorFactor": [0.6, 0.58, 0.56, 1.0], "roughnessFactor": roughness },
        })
    };
    glb.root["materials"] = json!([
        metal("blade", 0.09),
        metal("edge", 0.08),
        metal("bolster", 0.06),
        {
            "name": "handle",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.045, 0.02, 0.011, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.38,
            },
        },
        metal("rivets", 0.12),
    ]);
    let parts = [
        knife::blade(),
        knife::edge_bevel(),
        knife::bolster(),
        knife::handle(),
        knife::rivets(),
    ];
    let primitives: Vec<_> = (0..)
        .zip(&parts)
        .map(|(i, part)| glb.primitive(part, i, PartContents { tangents: false }))
        .collect();
    glb.root["meshes"] = json!([{ "name": "knife", "primitives": primitives }]);
    let rotation = DQuat::from_rotation_x(-FRAC_PI_2).as_quat().to_array();
    // Millimetres, z up, to metres, y up.
    glb.root["nodes"] = json!([
        { "name": "knife", "mesh": 0, "scale": [0.001, 0.001, 0.001], "rotation": rotation },
    ]);
    glb.root["scenes"] = json!([{ "name": "knife", "nodes": [0] }]);
    glb.root["scene"] = json!(0);
    glb.finish()
}
