//! Notes on models whose files have more than the picture.

use crate::common::{Glb, cube, scene_with, temporary_dir};
use hairline_document::Description;
use std::path::Path;

/// A cube with all that is left out, and some that is read.
fn rich_cube() -> Vec<u8> {
    let mut glb = Glb::default();
    let (corners, triangles) = cube();
    let positions = glb.floats(&corners);
    let ids = glb.floats(&[[7.0f32]; 8]);
    let indices = glb.indices(&triangles);
    glb.more = r#","extensionsUsed":["KHR_materials_sheen","VENDOR_glow","KHR_materials_unlit"],
        "animations":[{"channels":[],"samplers":[]},{"channels":[],"samplers":[]}],
        "scenes":[{"nodes":[0]},{"nodes":[0]}],"asset2":{},
        "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
        "materials":[
            {"alphaMode":"BLEND","occlusionTexture":{"index":0},"extensions":{"KHR_materials_sheen":{"extensions":{"VENDOR_glow":{}}}}},
            {"shine":1,"pbrMetallicRoughness":{"glossFactor":1,"metallicFactor":1},
             "extensions":{"KHR_materials_unlit":{},"KHR_materials_sheen":{},"KHR_materials_clearcoat":{"clearcoatTexture":{"index":0,"mirrored":true},"coats":2},"KHR_materials_specular":{"specularColorFactor":[1,0,0]}}}],
        "images":[{"uri":"data:image/png;base64,AAAA","mimeType":"image/png"}],"textures":[{"source":0}]"#
        .to_owned();
    let attributes = format!(r#""POSITION":{positions},"_BATCHID":{ids}"#);
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{{attributes}}},"indices":{indices},"lod":1}},{{"mode":1,"lod":2,"attributes":{{"POSITION":{positions}}}}}]}}"#
    );
    let json = glb
        .json(
            &mesh,
            r#"{"mesh":0,"extras":{"extensions":{"not":1}}}"#,
            None,
        )
        .replace(r#""scenes":[{"nodes":[0]}],"nodes""#, r#""nodes""#);
    crate::common::glb_of(&json, &glb.bin)
}

fn told(dir: &Path, keys: &str) -> Vec<String> {
    let text = scene_with(&format!(
        "[[object]]\nname = \"it\"\nmesh = \"it.glb\"\n{keys}[[object]]\nname = \"again\"\nmesh = \"it.glb\"\n{keys}"
    ));
    let description = Description::from_toml(&text, Path::new("test.toml")).unwrap();
    let scene = hairline_document::build(&description, dir).unwrap();
    // The notes are known without building the scene.
    assert_eq!(scene.notes, description.model_notes(dir));
    scene.notes
}

#[test]
fn what_is_left_out_is_told_once_with_its_count() {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("it.glb"), rich_cube()).unwrap();
    let notes = told(dir.path(), "");
    assert_eq!(
        notes,
        [
            "it.glb: KHR_materials_sheen (2) left out; cloth misses its sheen",
            "it.glb: VENDOR_glow (1) left out; Hairline does not know it",
            "it.glb: animations (2) left out; the model is at rest; `time_s` of its object shows one at a time",
            "it.glb: points or lines (1) left out; they have no surface",
            "it.glb: scenes (1) left out; one scene of the file is shown",
        ]
    );
    // Another material takes the place of the file's: nothing of those is missed.
    let notes = told(dir.path(), "material = \"steel\"\ntime_s = 1.0\n").join("\n");
    assert!(!notes.contains("sheen"), "{notes}");
    assert!(
        notes.contains("animations (1) left out; one of them is shown"),
        "{notes}"
    );
}

#[test]
fn what_changes_no_picture_is_listed_too() {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("it.glb"), rich_cube()).unwrap();
    let text = scene_with("[[object]]\nname = \"it\"\nmesh = \"it.glb\"\n");
    let description = Description::from_toml(&text, Path::new("test.toml")).unwrap();
    let (file, all) = description.left_out(dir.path()).remove(0);
    assert_eq!(file, Path::new("it.glb"));
    let harmless: Vec<_> = all.iter().filter(|it| !it.matters).collect();
    let names: Vec<_> = harmless.iter().map(|it| it.what.as_str()).collect();
    assert_eq!(
        names,
        [
            "_BATCHID",
            "asset2 of the file",
            "cameras",
            "coats of KHR_materials_clearcoat",
            "glossFactor of pbrMetallicRoughness",
            "lod of primitives",
            "mirrored of a material's texture",
            "shine of materials",
        ]
    );
    // A plain file has nothing to tell.
    let mut glb = Glb::default();
    let (corners, triangles) = cube();
    let (positions, indices) = (glb.floats(&corners), glb.indices(&triangles));
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
    );
    std::fs::write(dir.path().join("it.glb"), glb.bytes(&mesh, r#"{"mesh":0}"#)).unwrap();
    assert!(description.left_out(dir.path())[0].1.is_empty());
}

/// A cube with two nodes that have lights, one of which has a range, and more members.
fn lit_cube(lights: &str) -> Vec<u8> {
    let mut glb = Glb::default();
    let (corners, triangles) = cube();
    let (positions, indices) = (glb.floats(&corners), glb.indices(&triangles));
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
    );
    glb.more = format!(
        r#","extensionsUsed":["KHR_lights_punctual"],"extensions":{{"KHR_lights_punctual":{{"lights":[{lights}]}}}}"#
    );
    let nodes = r#"{"mesh":0,"children":[1,2]},{"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[0,2,0]},
        {"extensions":{"KHR_lights_punctual":{"light":1}},"translation":[0,2000,0]}"#;
    glb.bytes(&mesh, nodes)
}

#[test]
fn lights_of_a_file_are_told_where_the_scene_has_its_own() {
    let dir = temporary_dir();
    let path = dir.path().join("it.glb");
    let lights = r#"{"type":"point","range":3},{"type":"directional"}"#;
    std::fs::write(&path, lit_cube(lights)).unwrap();
    let told_in_scene = "it.glb: KHR_lights_punctual (2) left out; the scene's own lights are shown; \
         `hairline render` of the model itself shows these";
    for material in ["", "material = \"steel\"\n"] {
        assert_eq!(told(dir.path(), material), [told_in_scene]);
    }
    // Opened by itself the model has them, for all distances.
    let alone = Description::for_model(&path).unwrap();
    let told_alone = "it.glb: range of lights (1) left out; they shine beyond it, ever weaker";
    assert_eq!(alone.model_notes(dir.path()), [told_alone]);
    let scene = hairline_document::build(&alone, dir.path()).unwrap();
    assert!(scene.notes.iter().any(|it| it == told_alone));
    assert_eq!(scene.lights.len(), 2);
    // Saved it is a scene like others.
    let saved = Description::from_toml(&alone.to_toml().unwrap(), Path::new("test.toml")).unwrap();
    assert_eq!(saved.model_notes(dir.path()), [told_in_scene]);
}

#[test]
fn lights_that_no_scene_holds_are_told() {
    let dir = temporary_dir();
    let path = dir.path().join("it.glb");
    let lights = r#"{"type":"point","intensity":1e308},{"type":"point","name":"star"}"#;
    std::fs::write(&path, lit_cube(lights)).unwrap();
    let alone = Description::for_model(&path).unwrap();
    assert_eq!(
        alone.notes,
        [
            "it.glb: light 0 left out; its intensity is too large for a number",
            "it.glb: light star left out; it would stand over 1000 m off",
        ]
    );
    // A studio lights what is left without any.
    assert!(!alone.lights.is_empty());
}

#[test]
fn channels_that_move_no_node_are_told() {
    let dir = temporary_dir();
    let mut glb = Glb::default();
    let (corners, triangles) = cube();
    let (positions, indices) = (glb.floats(&corners), glb.indices(&triangles));
    let times = glb.floats(&[[0.0], [1.0]]);
    let places = glb.floats(&[[0.0; 3], [4.0, 0.0, 0.0]]);
    let pointer = r#"{"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/x"}}}}"#;
    glb.more = format!(
        r#","animations":[{{"channels":[{pointer},{{"sampler":0,"target":{{"node":0,"path":"translation"}}}},{pointer}],
            "samplers":[{{"input":{times},"output":{places}}}]}}]"#
    );
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
    );
    let bytes = glb.bytes(&mesh, r#"{"mesh":0}"#);
    std::fs::write(dir.path().join("it.glb"), bytes).unwrap();
    let notes = told(dir.path(), "time_s = 0.5\n");
    let expected =
        "it.glb: KHR_animation_pointer (2) left out; what it animates stays as it is at rest";
    assert_eq!(notes, [expected]);
    let notes = told(dir.path(), "");
    let expected = "it.glb: animations (1) left out; the model is at rest; `time_s` of its object shows one at a time";
    assert_eq!(notes, [expected]);
}

/// A square with texture coordinates, of a material that uses images; `attributes` and `primitive` are added to its members.
fn square(material: &str, attributes: &str, primitive: &str) -> Vec<u8> {
    let mut glb = Glb::default();
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f32]];
    let positions = glb.floats(&corners.map(|[x, y]| [x, y, 0.0]));
    let normals = glb.floats(&[[0.0, 0.0, 1.0f32]; 4]);
    let uvs = glb.floats(&corners);
    let tangents = glb.floats(&[[1.0, 0.0, 0.0, 1.0f32]; 4]);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let image = glb.view(&crate::common::png([1, 1], [255, 128, 255, 255]));
    glb.more = format!(
        r#","images":[{{"bufferView":{image},"mimeType":"image/png"}}],"textures":[{{"source":0}},{{"source":0,"sampler":0}}],
            "samplers":[{{"wrapS":33071}}],"materials":[{{{material}}}]"#
    );
    let attributes = attributes
        .replace("UVS", &uvs.to_string())
        .replace("TANGENTS", &tangents.to_string());
    let primitive = primitive.replace("NORMALS", &normals.to_string());
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals}{attributes}}},"indices":{indices},"material":0{primitive}}}]}}"#
    );
    glb.bytes(&mesh, r#"{"mesh":0}"#)
}

const UVS: &str = r#","TEXCOORD_0":UVS,"TEXCOORD_1":UVS"#;
const WITH_TANGENTS: &str = r#","TEXCOORD_0":UVS,"TEXCOORD_1":UVS,"TANGENT":TANGENTS"#;

#[test]
fn images_of_the_older_model_lie_as_the_first_of_them() {
    let dir = temporary_dir();
    let notes = |textures: &str| {
        let material =
            format!(r#""extensions":{{"KHR_materials_pbrSpecularGlossiness":{{{textures}}}}}"#);
        std::fs::write(dir.path().join("it.glb"), square(&material, UVS, "")).unwrap();
        told(dir.path(), "")
    };
    let other = "it.glb: texture coordinates and sampler of specularGlossinessTexture (1) left out; \
         it has those of diffuseTexture";
    for (specular, expected) in [
        (r#"{"index":0}"#, &[][..]),
        (r#"{"index":0,"texCoord":1}"#, &[other]),
        (
            r#"{"index":0,"extensions":{"KHR_texture_transform":{"scale":[2,2]}}}"#,
            &[other],
        ),
        // Repeated where the first is clamped.
        (r#"{"index":1}"#, &[other]),
        // A transform that moves nothing.
        (
            r#"{"index":0,"extensions":{"KHR_texture_transform":{"scale":[1,1]}}}"#,
            &[],
        ),
    ] {
        let textures =
            format!(r#""diffuseTexture":{{"index":0}},"specularGlossinessTexture":{specular}"#);
        assert_eq!(notes(&textures), expected, "{specular}");
    }
    assert!(notes(r#""specularGlossinessTexture":{"index":0,"texCoord":1}"#).is_empty());
}

#[test]
fn a_third_way_of_images_is_told() {
    let dir = temporary_dir();
    let moved = r#""extensions":{"KHR_texture_transform":{"offset":[0.5,0]}}"#;
    let material = format!(
        r#""normalTexture":{{"index":0}},"emissiveTexture":{{"index":0,"texCoord":1}},
            "extensions":{{"KHR_materials_pbrSpecularGlossiness":{{"diffuseTexture":{{"index":0,{moved}}}}}}}"#
    );
    std::fs::write(dir.path().join("it.glb"), square(&material, UVS, "")).unwrap();
    let expected = "it.glb: texCoord (1) left out; a third way to place images on one surface; they lie as the first one";
    assert_eq!(told(dir.path(), ""), [expected]);
    assert!(told(dir.path(), "material = \"steel\"\n").is_empty());
}

#[test]
fn directions_by_other_texture_coordinates_are_told() {
    let dir = temporary_dir();
    let notes = |material: &str, attributes: &str| {
        std::fs::write(dir.path().join("it.glb"), square(material, attributes, "")).unwrap();
        told(dir.path(), "")
    };
    let coat = r#""normalTexture":{"index":0},"extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":0,"texCoord":1}}}"#;
    let expected = "it.glb: tangents of clearcoatNormalTexture (1) left out; its bumps turn by the texture coordinates of normalTexture";
    assert_eq!(notes(coat, UVS), [expected]);
    // Those of the file serve both, and so do the same coordinates; a coat of no weight has no bumps.
    assert!(notes(coat, WITH_TANGENTS).is_empty());
    assert!(notes(&coat.replace(r#""texCoord":1"#, r#""texCoord":0"#), UVS).is_empty());
    assert!(notes(&coat.replace("Factor\":1", "Factor\":0"), UVS).is_empty());

    let brushed = r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":1,"anisotropyTexture":{"index":0,"texCoord":1}}}"#;
    let expected = "it.glb: tangents of anisotropyTexture (1) left out; its directions turn by the texture coordinates of another image";
    assert_eq!(notes(brushed, UVS), [expected]);
    assert!(notes(brushed, WITH_TANGENTS).is_empty());
    assert!(notes(&brushed.replace("Strength\":1", "Strength\":0"), UVS).is_empty());
    let plain = r#""extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":1}}"#;
    let expected = "it.glb: direction of KHR_materials_anisotropy (1) left out; \
         there are neither tangents nor texture coordinates; highlights are drawn out any way";
    assert_eq!(notes(plain, ""), [expected]);
    assert!(notes(plain, UVS).is_empty());
    assert!(notes(plain, r#","TANGENT":TANGENTS"#).is_empty());
}

#[test]
fn what_morph_targets_do_not_move_is_told() {
    let dir = temporary_dir();
    let targets = r#","targets":[{"NORMAL":NORMALS,"TEXCOORD_0":NORMALS,"COLOR_0":NORMALS},{"POSITION":NORMALS,"COLOR_0":NORMALS,"_HEAT":NORMALS}]"#;
    std::fs::write(
        dir.path().join("it.glb"),
        square(r#""name":"plain""#, UVS, targets),
    )
    .unwrap();
    let expected = [
        "it.glb: COLOR_0 of morph targets (2) left out; colours of vertices do not change",
        "it.glb: TEXCOORD_0 of morph targets (1) left out; images do not move on the surface",
    ];
    assert_eq!(told(dir.path(), ""), expected);
}
