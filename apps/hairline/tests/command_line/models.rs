//! Models that are rendered: at a time, by a camera of the file, and with notes on the contents that the picture does not have.

use std::fs;
use std::path::Path;

use crate::common::{hairline, stderr_of, stdout_of};
use hairline_fixtures::SceneFile;
use hairline_image::{Image, exr_file};

/// A red and a blue square of 0.1 m that face +z at the places `x`, 0.3 m apart. An animation swaps them within a second. `more` is put among
/// the members of the file, and among those of both materials.
fn write(folder: &Path, name: &str, x: [f32; 2], is_animated: bool, more: [&str; 2]) {
    let corners = [
        [-0.05f32, -0.05],
        [0.05, -0.05],
        [0.05, 0.05],
        [-0.05, 0.05],
    ];
    let positions = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]);
    let times = [0.0, 1.0];
    let translations = [
        [0.0, 0.0, 0.0, 0.3, 0.0, 0.0],
        [0.3, 0.0, 0.0, 0.0, 0.0, 0.0],
    ];
    let indices = [0u32, 1, 2, 0, 2, 3].into_iter().flat_map(u32::to_le_bytes);
    let numbers = positions
        .chain(times)
        .chain(translations.into_iter().flatten());
    let bytes: Vec<u8> = numbers.flat_map(f32::to_le_bytes).chain(indices).collect();
    std::fs::write(folder.join("a.bin"), &bytes).unwrap();
    let animations = r#""animations":[{"samplers":[{"input":1,"output":2},{"input":1,"output":3}],"channels":[
        {"sampler":0,"target":{"node":1,"path":"translation"}},{"sampler":1,"target":{"node":2,"path":"translation"}}]}],"#;
    let animations = if is_animated { animations } else { "" };
    let material = |color: &str| {
        format!(
            r#"{{"pbrMetallicRoughness":{{"baseColorFactor":[{color},1],"metallicFactor":0,"roughnessFactor":0.6}}{}}}"#,
            more[1]
        )
    };
    let mesh = |material: u32| {
        format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":4,"material":{material}}}]}}"#
        )
    };
    // Points from 0.6 m before the camera at 0 and, half a turn about y, from 0.2 m behind it.
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"children":[1,2,3,4]}},
            {{"mesh":0,"translation":[{},0,0]}},{{"mesh":1,"translation":[{},0,0]}},
            {{"camera":0,"translation":[0,0,0.6]}},{{"camera":1,"translation":[0,0,-0.2],"rotation":[0,1,0,0]}}],
        "cameras":[{{"name":"front","type":"perspective","perspective":{{"yfov":0.6,"znear":0.1}}}},
            {{"type":"perspective","perspective":{{"yfov":0.6,"znear":0.1}}}}],
        "meshes":[{},{}],"materials":[{},{}],{animations}{}
        "buffers":[{{"uri":"a.bin","byteLength":{}}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":8}},
            {{"buffer":0,"byteOffset":56,"byteLength":24}},{{"buffer":0,"byteOffset":80,"byteLength":24}},
            {{"buffer":0,"byteOffset":104,"byteLength":24}}],
        "accessors":[
            {{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-0.05,-0.05,0],"max":[0.05,0.05,0]}},
            {{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]}},
            {{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}},
            {{"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}},
            {{"bufferView":4,"componentType":5125,"count":6,"type":"SCALAR"}}]}}"#,
        x[0],
        x[1],
        mesh(0),
        mesh(1),
        material("1,0.05,0.05"),
        material("0.05,0.05,1"),
        more[0],
        bytes.len(),
    );
    std::fs::write(folder.join(name), text).unwrap();
    let scene = (SceneFile::seen_from([0.0, 0.0, 0.8]).up([0.0, 1.0, 0.0]))
        .part(&format!("[[object]]\nname = \"it\"\nmesh = {name:?}"))
        .sphere([0.0, 0.2, 0.5], 0.02, 40.0);
    std::fs::write(folder.join(name).with_extension("toml"), scene.to_string()).unwrap();
}

const REST: [f32; 2] = [0.0, 0.3];
const SWAPPED: [f32; 2] = [0.3, 0.0];
const PLAIN: [&str; 2] = ["", ""];

/// Renders a model; returns the picture and the messages.
fn rendered(folder: &Path, arguments: &str) -> (Image, String) {
    let arguments = format!(
        "render {arguments} --backend cpu --size 32x18 --samples 1 --shadows off -o it.exr"
    );
    let assert = hairline(folder, &arguments).success();
    let image = exr_file::read_image(&folder.join("it.exr")).unwrap();
    (image, stderr_of(&assert))
}

#[test]
fn a_model_is_shown_at_a_time_of_its_animation() {
    is_shown_at_a_time("toml");
}

/// A model without a scene, whose surroundings take seconds to blur.
#[test]
#[ignore = "long: cargo long"]
fn a_model_without_a_scene_is_shown_at_a_time_of_its_animation() {
    is_shown_at_a_time("gltf");
}

fn is_shown_at_a_time(kind: &str) {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, "moving.gltf", REST, true, PLAIN);
    write(folder, "posed.gltf", SWAPPED, false, PLAIN);
    let base = |arguments: &str| rendered(folder, &arguments.replace("KIND", kind)).0.base;
    let [moved, posed, rest] = [
        base("moving.KIND --time 1"),
        base("posed.KIND"),
        base("moving.KIND"),
    ];
    assert_eq!(moved, posed);
    assert_ne!(moved, rest);
}

#[test]
fn a_model_is_seen_by_a_camera_of_its_file_and_told_of() {
    is_seen_by_a_camera_and_told_of("it.toml");
}

#[test]
#[ignore = "long: cargo long"]
fn a_model_without_a_scene_is_seen_by_a_camera_of_its_file_and_told_of() {
    is_seen_by_a_camera_and_told_of("it.gltf");
}

/// The camera is chosen by its name, else by its number; each content of the file that the picture does not have is told of in a line.
fn is_seen_by_a_camera_and_told_of(file: &str) {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let more = [
        r#""extensionsUsed":["KHR_materials_sheen","VENDOR_glow"],"extensions":{"VENDOR_glow":{}},"#,
        r#","shine":1,"extensions":{"KHR_materials_sheen":{}}"#,
    ];
    write(folder, "it.gltf", REST, false, more);
    for (camera, depth_m) in [("front", 0.6), ("1", 0.2)] {
        let (image, told) = rendered(folder, &format!("{file} --camera {camera}"));
        let seen_m = image.depth_m[image.index(16, 9)];
        assert!((seen_m - depth_m).abs() < 1e-3, "{camera}: {seen_m}");
        let notes = told
            .lines()
            .filter(|line| line.starts_with("note: it.gltf"));
        let expected = [
            "note: it.gltf: KHR_materials_sheen (2) left out; cloth misses its sheen",
            "note: it.gltf: VENDOR_glow (1) left out; Hairline does not know it",
        ];
        assert_eq!(notes.collect::<Vec<_>>(), expected);
    }
    let wrong = hairline(folder, &format!("render {file} --camera side -o it.exr")).code(2);
    let told = stderr_of(&wrong);
    assert!(told.contains("its cameras are front, 1"), "{told}");
    // Data that change no picture are listed with the rest.
    let listed = stdout_of(&hairline(folder, &format!("info {file}")).success());
    for line in [
        "  it.gltf: KHR_materials_sheen (2); cloth misses its sheen\n",
        "  it.gltf: VENDOR_glow (1); Hairline does not know it\n",
        "  it.gltf: shine of materials (2); ",
    ] {
        assert_eq!(listed.matches(line).count(), 1, "{line}: {listed}");
    }
    let of_shine = listed.lines().find(|line| line.contains("shine of"));
    assert!(of_shine.is_some_and(|it| it.ends_with("; the picture is the same")));
}

/// A part of a 3D printer is rendered by itself, as large as it is in millimetres; one that is cut off is told.
#[test]
fn an_stl_file_is_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let corners = [[0, 0, 0], [40, 0, 0], [0, 40, 0], [0, 0, 40]];
    let mut text = "solid part\n".to_owned();
    for face in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        let vertices = face.map(|i: usize| {
            let [x, y, z] = corners[i];
            format!("vertex {x} {y} {z}\n")
        });
        text += &format!(
            "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
            vertices.concat()
        );
    }
    fs::write(folder.path().join("cut.stl"), &text).unwrap();
    fs::write(folder.path().join("part.stl"), text + "endsolid part\n").unwrap();
    let run = "render part.stl --backend cpu --size 48x32 --samples 1 --shadows off -o a.png";
    let told = stderr_of(&hairline(folder.path(), run).success());
    assert!(told.contains("part.stl: it names no unit"), "{told}");
    assert!(
        !told.contains("fit_m"),
        "4 cm are shown as they are: {told}"
    );
    let told = stderr_of(&hairline(folder.path(), "render cut.stl -o b.png").code(2));
    assert!(told.contains("cut.stl: it is cut off"), "{told}");
}

/// Faces that mirror a lamp to the camera as a whole show their scratches too.
#[test]
fn a_cube_of_metal_is_not_white() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::new();
    for [x, y, z] in [0.0, 0.04].iter().flat_map(|y| {
        [[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]].map(|[x, z]| [x, *y, z])
    }) {
        text += &format!("v {x} {y} {z}\n");
    }
    text += "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";
    fs::write(folder.path().join("cube.obj"), text).unwrap();
    let (image, _) = rendered(folder.path(), "cube.obj");
    let lit = image.base.iter().filter(|rgb| rgb[1] > 0.1).count();
    let white = image.base.iter().filter(|rgb| rgb[1] > 1.0).count();
    assert!(lit > 50 && 4 * white < lit, "{white} of {lit}");
}
