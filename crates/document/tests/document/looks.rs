//! Looks of the surfaces of glTF files: mapping of images, colours of vertices, extensions of materials.

use crate::common::{Glb, scene_with, temporary_dir};
use glam::{Vec2, Vec4, vec2, vec4};
use hairline_scene::{
    AlphaRule, Anisotropy, Base, Coat, Cutout, Reflector, Sampling, Scene, Specular, Texture, Wrap,
};

/// The scene of a square with two sets of texture coordinates and colours, of the only material of a file.
fn scene(material: &str, more: &str) -> Scene {
    let mut glb = Glb::default();
    let corners = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let positions = glb.floats(&corners.map(|[x, y]| [x, y, 0.0]));
    let uvs = glb.floats(&corners);
    let others = glb.floats(&corners.map(|[x, y]| [4.0 * x, 1.0 - y]));
    let bytes = [[255, 0, 0, 255], [255, 255, 255, 0]].repeat(2).concat();
    let view = glb.view(&bytes);
    let colors = glb.accessor(format!(
        r#"{{"bufferView":{view},"componentType":5121,"normalized":true,"count":4,"type":"VEC4"}}"#
    ));
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs},"TEXCOORD_1":{others},"COLOR_0":{colors}}},
            "indices":{indices},"material":0}}]}}"#
    );
    let image = |texels: &[[u8; 4]]| {
        let width = texels.len() as u32;
        let image = image::RgbaImage::from_raw(width, 1, texels.concat()).unwrap();
        let mut png = std::io::Cursor::new(Vec::new());
        image.write_to(&mut png, image::ImageFormat::Png).unwrap();
        png.into_inner()
    };
    let [a, b] = [
        image(&[[200, 100, 0, 255], [0, 0, 0, 128]]),
        image(&[[255, 255, 255, 51]]),
    ]
    .map(|png| glb.view(&png));
    glb.more = format!(
        r#","images":[{{"bufferView":{a},"mimeType":"image/png"}},{{"bufferView":{b},"mimeType":"image/png"}}],
        "samplers":[{{"wrapS":33648,"wrapT":33071,"magFilter":9728}}],
        "textures":[{{"source":0}},{{"source":0,"sampler":0}},{{"source":1}}],"materials":[{{{material}}}]{more}"#
    );
    let dir = temporary_dir();
    std::fs::write(dir.path().join("it.glb"), glb.bytes(&mesh, r#"{"mesh":0}"#)).unwrap();
    let text = scene_with("[[object]]\nname = \"it\"\nmesh = \"it.glb\"\nup = \"z\"");
    hairline_document::from_toml(&text, "test.toml", dir.path()).unwrap()
}

fn texture(scene: &Scene, index: Option<usize>) -> &Texture {
    &scene.textures[index.unwrap()]
}

#[test]
fn images_lie_where_the_file_puts_them() {
    let moved =
        r#""extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,2],"texCoord":0}}"#;
    // The set of the transform is taken, not that of the use.
    let scene = scene(
        &format!(
            r#""pbrMetallicRoughness":{{"baseColorTexture":{{"index":1,"texCoord":1}},"metallicRoughnessTexture":{{"index":0,"texCoord":1,{moved}}}}},
            "emissiveTexture":{{"index":0,"texCoord":1}}"#
        ),
        "",
    );
    let mesh = &scene.objects[0].mesh;
    let material = &scene.materials[mesh.triangle_materials[0] as usize];
    let base = texture(&scene, material.base_color_texture);
    let expected = Sampling {
        wrap: [Wrap::Mirror, Wrap::Clamp],
        is_sharp: true,
        by_other_uvs: false,
    };
    assert_eq!(base.sampling, expected);
    // The same image by other coordinates and another sampler.
    let metal = texture(&scene, material.metallic_roughness_texture);
    let expected = Sampling {
        by_other_uvs: true,
        ..Sampling::default()
    };
    assert_eq!(metal.sampling, expected);
    assert_eq!(
        texture(&scene, material.emission_texture).sampling,
        Sampling::default()
    );
    // The first way is that of the base colour, the second one moved.
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for [x, y] in corners {
        let i = (0..mesh.positions_m.len())
            .find(|&i| mesh.positions_m[i].truncate() == vec2(x, y))
            .unwrap();
        assert_eq!(mesh.uvs[i], vec2(4.0 * x, 1.0 - y));
        assert_eq!(mesh.other_uvs[i], Vec2::new(2.0 * x + 0.5, 2.0 * y));
    }
}

#[test]
fn vertices_have_colours() {
    let scene = scene(r#""name":"plain""#, "");
    let mesh = &scene.objects[0].mesh;
    // Flat normals: each triangle has its own corners.
    let red = vec4(1.0, 0.0, 0.0, 1.0);
    let clear = vec4(1.0, 1.0, 1.0, 0.0);
    let expected: Vec<Vec4> = [red, clear, red, red, red, clear].to_vec();
    assert_eq!(mesh.colors, expected);
    assert!(mesh.other_uvs.is_empty());
}

/// Section 3.7.2.1: whole numbers of colours are shares, whether the file marks them or not; those of texture coordinates may be themselves by an
/// extension.
#[test]
fn whole_numbers_are_shares_where_they_can_be_nothing_else() {
    for (extension, u) in [
        ("", 0.2),
        (r#","extensionsUsed":["KHR_mesh_quantization"]"#, 51.0),
    ] {
        let mut glb = Glb::default();
        let positions = glb.floats(&[[0.0f32; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let view = glb.view(&[51, 102, 255, 255].repeat(3));
        let shares = |kind: &str| {
            format!(r#"{{"bufferView":{view},"componentType":5121,"count":3,"type":"{kind}"}}"#)
        };
        let [colors, uvs] = [shares("VEC4"), shares("VEC2")];
        let [colors, uvs] = [glb.accessor(colors), glb.accessor(uvs)];
        let mesh = format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs},"COLOR_0":{colors}}},"material":0}}]}}"#
        );
        let image = image::RgbaImage::from_raw(1, 1, vec![255; 4]).unwrap();
        let mut png = std::io::Cursor::new(Vec::new());
        image.write_to(&mut png, image::ImageFormat::Png).unwrap();
        let image = glb.view(&png.into_inner());
        glb.more = format!(
            r#","images":[{{"bufferView":{image},"mimeType":"image/png"}}],"textures":[{{"source":0}}],
            "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}]{extension}"#
        );
        let dir = temporary_dir();
        std::fs::write(dir.path().join("it.glb"), glb.bytes(&mesh, r#"{"mesh":0}"#)).unwrap();
        let text = scene_with("[[object]]\nname = \"it\"\nmesh = \"it.glb\"\nup = \"z\"");
        let scene = hairline_document::from_toml(&text, "test.toml", dir.path()).unwrap();
        let mesh = &scene.objects[0].mesh;
        assert!(
            (mesh.colors[0] - vec4(0.2, 0.4, 1.0, 1.0))
                .abs()
                .max_element()
                < 1e-6
        );
        assert!((mesh.uvs[0].x - u).abs() < 1e-5, "{}", mesh.uvs[0]);
    }
}

#[test]
fn extensions_change_what_a_surface_reflects() {
    let material = |text: &str| {
        let scene = scene(text, "");
        scene.materials[scene.objects[0].mesh.triangle_materials[0] as usize].clone()
    };
    let plastic = r#""pbrMetallicRoughness":{"metallicFactor":0}"#;
    assert_eq!(material(plastic).dielectric_f0, 0.04);
    assert!(!material(plastic).has_specular());
    assert_eq!(
        Reflector::new(&material(plastic)),
        Reflector::Dielectric(1.5)
    );
    // 0 is a mirror under its own colour; what is no refractive index is one, too.
    for (ior, f0) in [
        (3.0, 0.25),
        (1.5, 0.04),
        (1.0, 0.0),
        (0.0, 1.0),
        (-1.0, 1.0),
    ] {
        let of_index = material(&format!(
            r#"{plastic},"extensions":{{"KHR_materials_ior":{{"ior":{ior}}}}}"#
        ));
        assert!((of_index.dielectric_f0 - f0).abs() < 1e-16, "{ior}");
        assert_eq!(of_index.specular, Specular::default());
    }
    let dull = format!(
        r#"{plastic},"extensions":{{"KHR_materials_specular":{{"specularFactor":0.5,"specularColorFactor":[2,0.5,0.25],"specularTexture":{{"index":2}},"specularColorTexture":{{"index":2,"texCoord":1}}}}}}"#
    );
    let dull = scene(&dull, "");
    let of_dull = &dull.materials[dull.objects[0].mesh.triangle_materials[0] as usize];
    let (weight, color) = (0.5, [2.0, 0.5, 0.25]);
    assert_eq!(of_dull.specular, Specular { weight, color });
    let [of_weight, of_color] = of_dull.specular_textures.map(|it| texture(&dull, it));
    assert!(!of_weight.srgb && of_color.srgb && of_color.sampling.by_other_uvs);
    let unlit = material(&format!(
        r#"{plastic},"extensions":{{"KHR_materials_unlit":{{}}}}"#
    ));
    assert!(unlit.is_unlit && unlit.has_specular());
    let coated = material(&format!(
        r#"{plastic},"extensions":{{"KHR_materials_clearcoat":{{"clearcoatFactor":0.75,"clearcoatRoughnessFactor":0.25}}}}"#
    ));
    let (weight, roughness) = (0.75, 0.25);
    assert_eq!(coated.coat, Some(Coat { weight, roughness }));
    let bare = material(&format!(
        r#"{plastic},"extensions":{{"KHR_materials_clearcoat":{{}}}}"#
    ));
    assert_eq!(bare.coat, None);
    let mapped = |roughness_map: &str| {
        format!(
            r#"{plastic},"extensions":{{"KHR_materials_clearcoat":{{"clearcoatFactor":1,"clearcoatTexture":{{"index":2}},"clearcoatRoughnessTexture":{{{roughness_map}}}}}}}"#
        )
    };
    let textured = scene(&mapped(r#""index":2,"texCoord":1"#), "");
    let coated = &textured.materials[textured.objects[0].mesh.triangle_materials[0] as usize];
    assert_eq!(coated.coat_textures, [Some(0), Some(1)]);
    // The same image lies in two ways.
    let by_other = [0, 1].map(|i| textured.textures[i].sampling.by_other_uvs);
    assert_eq!(by_other, [false, true]);
    let (normal_map, normals) = (
        r#""normalTexture":{"index":2}"#,
        r#""index":2,"texCoord":1,"scale":0.5"#,
    );
    let bumpy = scene(
        &format!(
            r#"{plastic},{normal_map},"extensions":{{"KHR_materials_clearcoat":{{"clearcoatFactor":1,"clearcoatNormalTexture":{{{normals}}}}}}}"#
        ),
        "",
    );
    let coated = &bumpy.materials[bumpy.objects[0].mesh.triangle_materials[0] as usize];
    let (own, scale) = coated.coat_normal_texture.unwrap();
    assert_eq!(scale, 0.5);
    assert!(bumpy.textures[own].sampling.by_other_uvs && !bumpy.textures[own].srgb);
    assert!(coated.has_coat_normals() && coated.normal_texture.is_some());
    // It lies as it should; its tangents are those of the other map.
    let expected = "it.glb: tangents of clearcoatNormalTexture (1) left out; its bumps turn by the texture coordinates of normalTexture";
    assert_eq!(bumpy.notes, [expected]);
    // A material with three mappings: the coat's normals lose theirs, and the colour does not.
    let crowded = scene(
        r#""pbrMetallicRoughness":{"baseColorTexture":{"index":2,"texCoord":1}},"normalTexture":{"index":2},
            "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":2,
            "extensions":{"KHR_texture_transform":{"scale":[2,2]}}}}}"#,
        "",
    );
    let of_crowded = &crowded.materials[crowded.objects[0].mesh.triangle_materials[0] as usize];
    let color = of_crowded.base_color_texture.unwrap();
    assert!(crowded.textures[color].sampling.by_other_uvs);
    assert!(!crowded.notes.is_empty());
    let brushed = |text: &str| {
        scene(
            &format!(r#"{plastic},"extensions":{{"KHR_materials_anisotropy":{{{text}}}}}"#),
            "",
        )
    };
    let of = |scene: &Scene| {
        scene.materials[scene.objects[0].mesh.triangle_materials[0] as usize].clone()
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned = brushed(&format!(
        r#""anisotropyStrength":0.5,"anisotropyRotation":{quarter},"anisotropyTexture":{{"index":2}}"#
    ));
    let (strength, direction_deg) = (0.5, 90.0);
    let expected = Anisotropy {
        strength,
        direction_deg,
    };
    assert_eq!(of(&turned).anisotropy, Some(expected));
    assert!(!texture(&turned, of(&turned).anisotropy_texture).srgb);
    assert_eq!(of(&brushed("")).anisotropy, None);
    // The older model, as its conversion has it; its image takes the place of both of the newer one, and so do factors alone.
    let newer = r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}}"#;
    let older = |texture: &str| {
        scene(
            &format!(
                r#"{newer},"extensions":{{"KHR_materials_pbrSpecularGlossiness":{{"diffuseFactor":[0.6,0.2,0.1,1],
                    "specularFactor":[0.5,0.5,0.5],"glossinessFactor":0.75{texture}}}}}"#
            ),
            "",
        )
    };
    let plain = of(&older(""));
    assert_eq!(plain.roughness, 0.25);
    let Base::MetallicRoughness {
        base_color,
        metallic,
    } = plain.base
    else {
        panic!("{:?}", plain.base)
    };
    assert!((metallic - 0.617_692).abs() < 1e-5 && (base_color[1] - 0.461_169).abs() < 1e-5);
    assert_eq!(
        (plain.base_color_texture, plain.metallic_roughness_texture),
        (None, None)
    );
    let mapped = older(r#","specularGlossinessTexture":{"index":2}"#);
    let material = of(&mapped);
    assert_eq!(material.base_color_texture, Some(0));
    assert_eq!(material.metallic_roughness_texture, Some(1));
    // White in the image keeps the specular factor, and 51 is a fifth of the glossiness.
    assert_eq!(mapped.textures[0].levels[0], [[229, 181, 166, 255]]);
    assert_eq!(mapped.textures[1].levels[0], [[255, 217, 158, 255]]);
}

/// Section 3.9.4: a surface with the alpha of the cutoff is there. Exporters write a code over 255 as a
/// single.
#[test]
fn an_alpha_that_equals_the_cutoff_is_there() {
    for code in [1u8, 77, 128, 204, 255] {
        for (cutoff, is_there) in [
            (f32::from(code) / 255.0, true),
            // A tenth of a step between codes more.
            ((f32::from(code) + 0.1) / 255.0, false),
        ] {
            let text = format!(
                r#""alphaMode":"MASK","alphaCutoff":{cutoff},"pbrMetallicRoughness":{{"baseColorFactor":[1,1,1,{}]}}"#,
                f64::from(code) / 255.0
            );
            let scene = scene(&text, "");
            let material = scene.objects[0].mesh.triangle_materials[0] as usize;
            let cutout = scene.materials[material].cutout;
            let Some(Cutout {
                rule: AlphaRule::AtLeast(least),
                ..
            }) = cutout
            else {
                panic!("{cutout:?}")
            };
            // The alpha of a texel, as both renderers ask; the GPU in single precision.
            let alpha = f64::from(code) / 255.0;
            assert_eq!(alpha >= least, is_there, "{code}: {cutoff}");
            let there = alpha as f32 >= least as f32;
            assert_eq!(there, is_there, "{code}: {cutoff}");
        }
    }
}

#[test]
fn surfaces_are_cut_out_by_their_alpha() {
    let cutout = |text: &str| {
        let scene = scene(text, "");
        scene.materials[scene.objects[0].mesh.triangle_materials[0] as usize].cutout
    };
    assert_eq!(cutout(r#""name":"whole""#), None);
    let mask = r#""alphaMode":"MASK","alphaCutoff":0.25,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}"#;
    let expected = Cutout {
        alpha: 0.5,
        rule: AlphaRule::AtLeast(0.25 - 1e-6),
    };
    assert_eq!(cutout(mask), Some(expected));
    let blend = r#""alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.1]}"#;
    let expected = Cutout {
        alpha: f64::from(0.1f32),
        rule: AlphaRule::Share,
    };
    assert_eq!(cutout(blend), Some(expected));
}

/// A file that requires the extension gives the texels that the program unpacks that packed them.
#[test]
fn images_of_basis_universal_are_textures() {
    let dir = temporary_dir();
    let images = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/document/images/");
    for name in ["etc1s.ktx2", "uastc_zstd.ktx2"] {
        std::fs::copy(format!("{images}{name}"), dir.path().join(name)).unwrap();
    }
    let mut glb = Glb::default();
    let positions = glb.floats(&[[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let uvs = glb.floats(&[[0.0f32, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let indices = glb.indices(&[0, 1, 2]);
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs}}},"indices":{indices},"material":0}}]}}"#
    );
    glb.more = r#","extensionsUsed":["KHR_texture_basisu"],"extensionsRequired":["KHR_texture_basisu"],
        "images":[{"uri":"uastc_zstd.ktx2"},{"uri":"etc1s.ktx2"}],
        "textures":[{"extensions":{"KHR_texture_basisu":{"source":1}}},{"extensions":{"KHR_texture_basisu":{"source":0}}}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"emissiveTexture":{"index":1}}]"#
        .to_owned();
    std::fs::write(dir.path().join("it.glb"), glb.bytes(&mesh, r#"{"mesh":0}"#)).unwrap();
    let text = scene_with("[[object]]\nname = \"it\"\nmesh = \"it.glb\"\n");
    let scene = hairline_document::from_toml(&text, "test.toml", dir.path()).unwrap();
    assert_eq!(scene.notes, [""; 0]);
    let material = scene.materials.last().unwrap();
    for (index, name) in [
        (material.base_color_texture, "etc1s.png"),
        (material.emission_texture, "uastc_zstd.png"),
    ] {
        let unpacked = image::open(format!("{images}{name}")).unwrap().into_rgba8();
        let texture = texture(&scene, index);
        assert_eq!(texture.size_px, [unpacked.width(), unpacked.height()]);
        assert_eq!(
            texture.levels[0].as_flattened(),
            unpacked.as_raw(),
            "{name}"
        );
    }
}

/// Four squares of one colour each, alpha rising to the right below; packed by Pillow 13.
#[test]
fn images_of_jpeg_and_webp_are_textures() {
    let images = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/document/images/");
    // Name, largest difference by lossy coding, and whether there is an alpha.
    let files = [
        ("baseline.jpg", 10, false),
        ("progressive.jpg", 4, false),
        ("lossy.webp", 20, true),
        ("lossless.webp", 0, true),
    ];
    let dir = temporary_dir();
    for (name, ..) in files {
        std::fs::copy(format!("{images}{name}"), dir.path().join(name)).unwrap();
    }
    let mut glb = Glb::default();
    let positions = glb.floats(&[[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let uris = files.map(|(name, ..)| format!(r#"{{"uri":"{name}"}}"#));
    glb.more = format!(
        r#","images":[{}],"textures":[{{"source":0}},{{"source":1}},{{"source":2}},{{"source":3}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}},"metallicRoughnessTexture":{{"index":1}}}},
            "emissiveTexture":{{"index":2}},"occlusionTexture":{{"index":3}}}}]"#,
        uris.join(",")
    );
    let mesh =
        format!(r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"material":0}}]}}"#);
    std::fs::write(dir.path().join("it.glb"), glb.bytes(&mesh, r#"{"mesh":0}"#)).unwrap();
    let text = scene_with("[[object]]\nname = \"it\"\nmesh = \"it.glb\"\n");
    let scene = hairline_document::from_toml(&text, "test.toml", dir.path()).unwrap();
    let material = scene.materials.last().unwrap();
    let used = [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.emission_texture,
        material.occlusion_texture.map(|it| it.0),
    ];
    for ((name, losses, has_alpha), index) in files.into_iter().zip(used) {
        let texture = texture(&scene, index);
        assert_eq!(texture.size_px, [16, 16], "{name}");
        for (x, y, [r, g, b, a]) in [
            (3, 3, [230, 40, 30, 255]),
            (12, 3, [40, 200, 60, 255]),
            (3, 12, [30, 60, 220, 88]),
            (12, 12, [240, 240, 240, 160]),
        ] {
            let right: [u8; 4] = [r, g, b, if has_alpha { a } else { 255 }];
            let found = texture.levels[0][16 * y + x];
            let off = (0..4).map(|i| found[i].abs_diff(right[i])).max();
            assert!(off <= Some(losses), "{name}: {found:?}, {right:?}");
        }
    }
}
