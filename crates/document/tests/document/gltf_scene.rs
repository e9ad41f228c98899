//! Scenes in glTF files: they come back bit for bit, the model in them is untouched, and what is wrong is named.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use hairline_document::description::Surface;
use hairline_document::export::Export;
use hairline_document::gltf_scene::Exported;
use hairline_document::{Arrays, Description, Loader, MeshArrays, ScratchArrays, inputs};
use hairline_image::{FilePath, Memory};
use hairline_optics::grating::GRATING_DEPTH_NM;
use hairline_optics::table::rows_down_to;
use hairline_scene::{Scene, ScratchTables};
use serde_json::{Value, json};

use crate::common::{Glb, cube, glb_of, png, temporary_dir};

/// All kinds of tables, with files of all kinds.
const WHOLE: &str = r#"
camera = { position_m = [0.1, -0.22, 0.3], target_m = [0.0, 0.0, 0.01], up = [0.0, 0.0, 1.0], exposure_ev = 0.7 }
render = { size_px = [320, 200], tone_map = "agx" }
environment = { builtin = "window", rotation_deg = 33.3, intensity = 0.123456789 }
material = [
    { name = "steel", kind = "metal", metal = "steel", roughness = 0.07 },
    { name = "paint", kind = "dielectric", base_color = [0.1, 0.2, 0.7], clearcoat = 1.0 },
    { name = "disc", kind = "metal", metal = "aluminium", cover = { ior = 1.58 } },
]
object = [
    { name = "plate", shape = { disk = { radius_m = 0.08 } }, material = "steel", rotation_deg = [12.5, 7.0, 3.1], scale = [1.0, 1.2, 1.0] },
    { name = "box", shape = { box = { size_m = [0.05, 0.04, 0.03], rounding_m = 0.004 } }, material = "paint", translation_m = [0.1, 0.05, 0.02] },
    { name = "dvd", shape = { disk = { radius_m = 0.06 } }, material = "disc", translation_m = [-0.1, 0.1, 0.0] },
    { name = "gone", shape = { sphere = { radius_m = 0.01 } }, material = "steel", hidden = true },
]
scratches = [
    { object = "plate", pattern = "random", count = 40, seed = 9223372036854775807, curvature_per_m = { mean = 0.0, spread = 8.0 } },
    { object = "plate", pattern = "swirl", count = 30, where = { mask = "maps/mask.png", density = "density.png" }, profile = "v", name = "wiped" },
    { object = "plate", pattern = "file", file = "list.csv", profile = [1.0, 0.7, 0.0, -0.3, 0.0] },
    { object = "box", pattern = "drawn", strokes = [{ points_m = [[0.0, 0.0, 0.015], [0.01, 0.012, 0.015]], radius_m = 0.004, density_per_m = 900.0 }] },
    { object = "box", pattern = "parallel", density_per_m2 = 20000.0, where = { edges = 0.8 }, hidden = true },
    { object = "plate", pattern = "svg", file = "mark.svg", fit_m = 0.03, center_m = [0.01, 0.0, 0.0] },
]
grating = [
    { object = "dvd", pattern = "circular", pitch_um = 0.74, mask = "maps/mask.png", tile_m = 0.03 },
    { object = "plate", pattern = "uv", pitch_um = 5.0, directions = "other/mask.png", coverage = 0.3 },
]
light = [
    { kind = "sphere", center_m = [0.2, -0.3, 0.7], radius_m = 0.013, radiance = 55.5, cone_deg = 40.0, target_m = [0.0, 0.0, 0.0] },
    { kind = "rectangle", center_m = [-0.3, 0.1, 0.5], target_m = [0.0, 0.0, 0.0], width_m = 0.2, height_m = 0.1, rotation_deg = 20.0, picture = "box.png" },
    { kind = "disk", center_m = [0.3, 0.1, 0.5], target_m = [0.0, 0.0, 0.0], radius_m = 0.05, two_sided = true, temperature_k = 3000.0 },
    { kind = "tube", ends_m = [[0.0, 0.3, 0.4], [0.1, 0.3, 0.4]], radius_m = 0.01 },
    { kind = "sun", direction = [0.3, 0.2, -1.0], irradiance = 0.4 },
    { kind = "sphere", center_m = [0.2, 0.3, 0.7], radius_m = 0.013, hidden = true },
]
"#;

/// A folder with the files of [`WHOLE`].
fn whole() -> (tempfile::TempDir, Description) {
    let dir = temporary_dir();
    let write = |name: &str, bytes: &[u8]| {
        let path = dir.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    };
    write("maps/mask.png", &png([4, 4], [255, 255, 255, 255]));
    write("other/mask.png", &png([4, 2], [255, 128, 0, 255]));
    write("density.png", &png([2, 2], [180, 180, 180, 255]));
    write("box.png", &png([2, 2], [90, 180, 220, 255]));
    let list = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n-0.04,0.01,0,0.05,0.02,0,4.25,130\n0.1234567e-1,0,0,0,0.03,0,2.1,99.5\n";
    write("list.csv", list.as_bytes());
    let mark = "<svg xmlns='http://www.w3.org/2000/svg'><circle cx='3' cy='3' r='2'/></svg>";
    write("mark.svg", mark.as_bytes());
    let description = Description::from_toml(WHOLE, Path::new("whole.toml")).unwrap();
    (dir, description)
}

fn exported(description: &Description, dir: &Path) -> Exported {
    let loader = Loader::default();
    let export = Export {
        laid: true,
        ..Export::default()
    };
    loader.export(description, dir, export).unwrap()
}

/// Writes a scene beside its files, and opens the file.
fn reopened(description: &Description, dir: &Path) -> (PathBuf, Description) {
    let path = dir.join("worn.glb");
    std::fs::write(&path, exported(description, dir).bytes).unwrap();
    let again = Description::for_model(&path).unwrap();
    assert_eq!(again.notes, [""; 0]);
    (path, again)
}

fn check_same(a: &Scene, b: &Scene) {
    assert_eq!(a.camera, b.camera);
    assert_eq!(a.render, b.render);
    assert_eq!(a.lights, b.lights);
    assert_eq!(a.materials, b.materials);
    assert_eq!(a.objects.len(), b.objects.len());
    for (a, b) in a.objects.iter().zip(&b.objects) {
        assert_eq!(a.name, b.name);
        assert_eq!(a.mesh.positions_m, b.mesh.positions_m, "{}", a.name);
        assert_eq!(a.mesh.normals, b.mesh.normals);
        assert_eq!(a.mesh.tangents, b.mesh.tangents);
        assert_eq!(a.mesh.uvs, b.mesh.uvs);
        assert_eq!(a.mesh.triangles, b.mesh.triangles);
        assert_eq!(a.mesh.triangle_materials, b.mesh.triangle_materials);
        assert_eq!(a.parts, b.parts);
        assert_eq!(a.gratings, b.gratings);
        assert_eq!(a.scratches, b.scratches);
        assert_eq!(a.segments, b.segments);
    }
    let texels = |scene: &Scene| -> Vec<_> {
        let textures = scene.textures.iter();
        textures
            .map(|it| (it.size_px, it.srgb, it.levels.clone()))
            .collect()
    };
    assert_eq!(texels(a), texels(b));
    assert_eq!(a.notes, b.notes);
}

#[test]
fn a_scene_of_shapes_comes_back_bit_for_bit() {
    let (dir, description) = whole();
    let before = hairline_document::build(&description, dir.path()).unwrap();
    assert!(before.objects[0].segments.len() > 60);
    let (path, again) = reopened(&description, dir.path());
    // Elsewhere, without any of its files.
    let elsewhere = temporary_dir();
    std::fs::copy(&path, elsewhere.path().join("worn.glb")).unwrap();
    check_same(
        &hairline_document::build(&again, elsewhere.path()).unwrap(),
        &before,
    );
    // As a scene file that names what lies in the glTF file.
    let text = again.to_toml().unwrap();
    let loaded = hairline_document::from_toml(&text, "again.toml", elsewhere.path()).unwrap();
    check_same(&loaded, &before);
}

#[test]
fn a_file_that_was_opened_is_written_as_it_was() {
    let (dir, description) = whole();
    let (path, again) = reopened(&description, dir.path());
    let bytes = std::fs::read(&path).unwrap();
    assert!(exported(&again, dir.path()).bytes == bytes);
}

/// A cube with a camera, a light and an animation, below a node that turns it.
fn cube_file(dir: &Path) -> PathBuf {
    let mut glb = Glb::default();
    let (corners, triangles) = cube();
    let positions = glb.floats(&corners.map_each(|x| x * 0.1 + 0.012_345_678));
    let indices = glb.indices(&triangles);
    let times = glb.floats(&[[0.0f32], [1.0]]);
    let translations = glb.floats(&[[0.0f32, 0.0, 0.0], [0.3, 0.0, 0.0]]);
    glb.more = format!(
        r#","materials":[{{"name":"a","pbrMetallicRoughness":{{"metallicFactor":1,"roughnessFactor":0.123456789012345678}}}},{{"name":"unused"}}],
        "cameras":[{{"name":"own","type":"perspective","perspective":{{"yfov":0.6,"znear":0.1}}}}],
        "extensionsUsed":["KHR_lights_punctual"],
        "extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"point","intensity":20}}]}}}},
        "animations":[{{"samplers":[{{"input":{times},"output":{translations}}}],"channels":[{{"sampler":0,"target":{{"node":1,"path":"translation"}}}}]}}]"#
    );
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices},"material":0}}]}}"#
    );
    let nodes = r#"{"name":"turned","rotation":[0,0.38268343236,0,0.92387953251],"children":[1,2,3]},{"name":"cube","mesh":0},
        {"camera":0,"translation":[0,0,0.6]},{"translation":[0,0.5,0.3],"extensions":{"KHR_lights_punctual":{"light":0}}}"#;
    let path = dir.join("cube.glb");
    std::fs::write(&path, glb.bytes(&mesh, nodes)).unwrap();
    path
}

trait MapEach {
    fn map_each(&self, by: impl Fn(f32) -> f32) -> Vec<[f32; 3]>;
}

impl MapEach for Vec<[f32; 3]> {
    fn map_each(&self, by: impl Fn(f32) -> f32) -> Vec<[f32; 3]> {
        self.iter().map(|corner| corner.map(&by)).collect()
    }
}

/// The text and the chunk of a binary file.
fn taken_apart(bytes: &[u8]) -> (Value, Vec<u8>) {
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let text = 20..20 + number(12);
    let chunk = text.end + 8..text.end + 8 + number(text.end);
    let root = serde_json::from_slice(&bytes[text]).unwrap();
    (root, bytes[chunk].to_vec())
}

#[test]
fn a_worn_model_that_was_opened_is_written_as_it_was() {
    let dir = temporary_dir();
    let description = Description::for_model(cube_file(dir.path())).unwrap();
    let (path, again) = reopened(&description, dir.path());
    let bytes = std::fs::read(&path).unwrap();
    assert!(exported(&again, dir.path()).bytes == bytes);
}

#[test]
fn a_worn_model_comes_back_bit_for_bit_and_its_file_is_untouched() {
    let dir = temporary_dir();
    let path = cube_file(dir.path());
    let description = Description::for_model(&path).unwrap();
    assert!(!description.scratches.is_empty(), "metal is worn");
    let before = hairline_document::build(&description, dir.path()).unwrap();
    let (worn, again) = reopened(&description, dir.path());
    check_same(
        &hairline_document::build(&again, dir.path()).unwrap(),
        &before,
    );
    assert_eq!(
        again.objects[0].surface,
        Surface::Mesh("worn.glb/cube.glb".into())
    );

    let (was, chunk) = taken_apart(&std::fs::read(&path).unwrap());
    let (is, longer) = taken_apart(&std::fs::read(&worn).unwrap());
    assert!(longer.starts_with(&chunk));
    for list in [
        "nodes",
        "meshes",
        "materials",
        "accessors",
        "bufferViews",
        "animations",
        "cameras",
    ] {
        let [was, is] = [&was, &is].map(|it| it[list].as_array().unwrap());
        assert_eq!(was[..], is[..was.len()], "{list}");
    }
    // Its own lights are in the scene already.
    let lights = &is["extensions"]["KHR_lights_punctual"]["lights"];
    assert_eq!(lights.as_array().unwrap().len(), 1);
}

#[test]
fn a_model_in_two_places_is_in_the_file_once_and_seen_twice() {
    let dir = temporary_dir();
    cube_file(dir.path());
    let text = r#"
camera = { position_m = [0.1, -0.9, 0.6], target_m = [0.0, 0.0, 0.01], up = [0.0, 0.0, 1.0] }
object = [{ name = "a", mesh = "cube.glb", fit_m = 0.2 }, { name = "b", mesh = "cube.glb", translation_m = [0.4, 0.0, 0.0], scale = [1.0, -2.0, 1.0] }]
scratches = [{ object = "a", pattern = "random", count = 20, material = "a" }, { object = "b", pattern = "random", count = 20, node = "cube" }]
light = [{ kind = "sphere", center_m = [0.0, 0.0, 1.0], radius_m = 0.1 }]
"#;
    let description = Description::from_toml(text, Path::new("two.toml")).unwrap();
    let before = hairline_document::build(&description, dir.path()).unwrap();
    let (path, again) = reopened(&description, dir.path());
    let after = hairline_document::build(&again, dir.path()).unwrap();
    assert_eq!(after.objects[1].segments, before.objects[1].segments);
    assert_eq!(
        after.objects[1].mesh.positions_m,
        before.objects[1].mesh.positions_m
    );
    // What other programs see lies where Hairline has it.
    let plain = dir.path().join("plain.glb");
    let (mut root, chunk) = taken_apart(&std::fs::read(&path).unwrap());
    root["extensions"]["HAIRLINE_scratches"] = json!(null);
    root["extensions"]
        .as_object_mut()
        .unwrap()
        .remove("HAIRLINE_scratches");
    std::fs::write(&plain, glb_of(&root.to_string(), &chunk)).unwrap();
    let text = r#"
camera = { position_m = [0.1, -0.9, 0.6], target_m = [0.0, 0.0, 0.01], up = [0.0, 0.0, 1.0] }
object = [{ name = "all", mesh = "plain.glb" }]
light = [{ kind = "sphere", center_m = [0.0, 0.0, 1.0], radius_m = 0.1 }]
"#;
    let seen = hairline_document::from_toml(text, "plain.toml", dir.path()).unwrap();
    let (least, most) = seen.objects[0].mesh.bounds_m();
    let bounds = [&before.objects[0], &before.objects[1]].map(|it| it.mesh.bounds_m());
    assert!(
        least.abs_diff_eq(bounds[0].0.min(bounds[1].0), 1e-6),
        "{least}"
    );
    assert!(
        most.abs_diff_eq(bounds[0].1.max(bounds[1].1), 1e-6),
        "{most}"
    );
}

#[test]
fn arrays_in_memory_are_in_the_file() {
    let dir = temporary_dir();
    let text = r#"
camera = { position_m = [0.1, -0.9, 0.6], target_m = [0.0, 0.0, 0.01], up = [0.0, 0.0, 1.0] }
material = [{ name = "steel", kind = "metal", metal = "steel" }]
object = [{ name = "it", mesh = "array 0", material = "steel" }]
scratches = [{ object = "it", pattern = "file", file = "array 1" }]
light = [{ kind = "sphere", center_m = [0.0, 0.0, 1.0], radius_m = 0.1 }]
"#;
    let description = Description::from_toml(text, Path::new("arrays.toml")).unwrap();
    let corners = vec![
        [0.0, 0.0, 0.0],
        [0.5, 0.0, 0.0],
        [0.5, 0.25, 0.125],
        [0.0, 0.25, 0.125],
    ];
    let mesh = MeshArrays::new(corners, vec![[0, 1, 2], [0, 2, 3]], None, None).unwrap();
    // A bent one of two pieces, and a straight one.
    let [a, b, c] = [[0.1, 0.01, 0.005], [0.4, 0.2, 0.1], [0.41, 0.1, 0.05]];
    let pieces = || ScratchArrays::new(vec![[a, b], [b, c], [c, a]], [&[2.3], &[150.0]]).unwrap();
    let scratches = pieces().with_scratches(&[4, 4, 7]).unwrap();
    for (wrong, told) in [
        (
            &[4, 4][..],
            "scratches: found 2 numbers for 3 pieces; must be one for each",
        ),
        (&[4, 7, 7, 7][..], "scratches: found 4 numbers"),
    ] {
        let error = pieces().with_scratches(wrong).unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
    let torn = ScratchArrays::new(vec![[a, b], [c, a]], [&[2.3], &[150.0]]).unwrap();
    let error = torn.with_scratches(&[1, 1]).unwrap_err().to_string();
    assert!(
        error.contains("ends_m[1]: found a piece off the one before it"),
        "{error}"
    );
    let mut arrays = Arrays::default();
    arrays.insert_mesh("array 0", Arc::new(mesh));
    arrays.insert_scratches("array 1", Arc::new(scratches));
    let loader = Loader {
        arrays: &arrays,
        ..Loader::default()
    };
    let before = loader.build(&description, dir.path()).unwrap();
    assert_eq!(before.objects[0].scratches.len(), 2);
    let exported = loader
        .export(&description, dir.path(), Export::default())
        .unwrap();
    std::fs::write(dir.path().join("worn.glb"), exported.bytes).unwrap();
    let again = Description::for_model(dir.path().join("worn.glb")).unwrap();
    let after = hairline_document::build(&again, dir.path()).unwrap();
    assert_eq!(
        before.objects[0].mesh.positions_m,
        after.objects[0].mesh.positions_m
    );
    assert_eq!(
        before.objects[0].mesh.triangles,
        after.objects[0].mesh.triangles
    );
    assert_eq!(before.objects[0].segments, after.objects[0].segments);
    assert_eq!(before.objects[0].scratches, after.objects[0].scratches);
}

/// What lies in a file is read there, wherever the file is, by whoever asks for it.
#[test]
fn what_lies_in_a_file_in_memory_is_read_from_there() {
    let (dir, description) = whole();
    let bytes = exported(&description, dir.path()).bytes;
    let memory = Memory::new(|_, _| {});
    memory.hold(Path::new("worn.glb"), &bytes);
    let file = FilePath::new(Arc::new(memory), "worn.glb");
    let again = Description::for_model(&file).unwrap();
    let loader = Loader::default();
    let before = hairline_document::build(&description, dir.path()).unwrap();
    check_same(&before, &loader.build(&again, file.folder()).unwrap());
    let picture = png([2, 2], [90, 180, 220, 255]);
    assert_eq!(inputs::bytes(file.join("box.png")).unwrap(), picture);
    assert!(inputs::is_there(file.join("box.png")));
    assert_eq!(inputs::file_of(file.join("box.png")), *file);
    let gone = inputs::bytes(file.join("gone.png"));
    assert!(gone.is_err(), "a name that the file does not hold");
}

#[test]
fn scratches_as_they_lie_are_in_the_frame_of_their_object() {
    let (dir, description) = whole();
    let scene = hairline_document::build(&description, dir.path()).unwrap();
    let (root, chunk) = taken_apart(&exported(&description, dir.path()).bytes);
    let extension = &root["extensions"]["HAIRLINE_scratches"];
    let laid = &extension["scratches"][0]["laid"];
    let floats = |accessor: &Value| -> Vec<f32> {
        let words = words(&root, &chunk, accessor).into_iter();
        words.map(f32::from_bits).collect()
    };
    let starts = floats(&laid["start_m"]);
    let world_from_object = description.objects[0].world_from_object();
    let pieces = &scene.objects[0].segments;
    assert!(starts.len() / 3 <= pieces.len());
    for (start, piece) in starts.chunks(3).zip(pieces.iter()) {
        // On the disk, which is flat.
        assert!(start[2].abs() < 1e-7);
        let start = glam::DVec3::new(start[0].into(), start[1].into(), start[2].into());
        let there = world_from_object.transform_point3(start).as_vec3();
        assert!(
            there.abs_diff_eq(piece.start_m, 1e-7),
            "{there} {}",
            piece.start_m
        );
    }
    assert_eq!(
        floats(&laid["width_um"])[0],
        scene.objects[0].scratches[0].profile.width_um
    );
    // A hidden layer has none.
    assert_eq!(extension["scratches"][4].get("laid"), None);
    let plain = Loader::default();
    let plain = plain
        .export(&description, dir.path(), Export::default())
        .unwrap();
    let (root, _) = taken_apart(&plain.bytes);
    let layers = &root["extensions"]["HAIRLINE_scratches"]["scratches"];
    assert_eq!(layers[0].get("laid"), None);
    assert!(
        layers[2]["file"]["ends_f64"].is_u64(),
        "decimals are no binary fractions"
    );
}

/// A list with pieces of one scratch comes back as the same scratches.
#[test]
fn pieces_of_listed_scratches_stay_together() {
    let dir = temporary_dir();
    let csv = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm,scratch\n\
        0,0,0,0.01,0,0,2,150,0\n0.01,0,0,0.01,0.02,0,2,150,0\n0.03,0,0,0,0.03,0,2,150,1\n";
    std::fs::write(dir.path().join("list.csv"), csv).unwrap();
    let text = "
        camera = { position_m = [0.0, 0.0, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0] }
        material = [{ name = \"m\", kind = \"metal\", metal = \"gold\" }]
        object = [{ name = \"o\", material = \"m\", shape = { disk = { radius_m = 0.05 } } }]
        scratches = [{ object = \"o\", pattern = \"file\", file = \"list.csv\" }]
        light = [{ kind = \"sphere\", center_m = [0.0, 0.0, 0.5], radius_m = 0.01 }]
    ";
    let description = Description::from_toml(text, Path::new("lists.toml")).unwrap();
    let scene = hairline_document::build(&description, dir.path()).unwrap();
    let path = dir.path().join("worn.glb");
    std::fs::write(&path, exported(&description, dir.path()).bytes).unwrap();
    let again =
        hairline_document::build(&Description::for_model(&path).unwrap(), dir.path()).unwrap();
    assert_eq!(scene.objects[0].scratches.len(), 2);
    assert_eq!(scene.objects[0].scratches, again.objects[0].scratches);
    assert_eq!(scene.objects[0].segments, again.objects[0].segments);
}

/// Numbers of an accessor of whole numbers or floats, as words.
fn words(root: &Value, chunk: &[u8], accessor: &Value) -> Vec<u32> {
    let accessor = &root["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    let bytes = &chunk[start..start + view["byteLength"].as_u64().unwrap() as usize];
    let (words, []) = bytes.as_chunks() else {
        panic!("a part of a word");
    };
    words.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

#[test]
fn a_grating_as_it_lies_is_in_the_frame_of_its_object_and_has_its_table() {
    let text = "
        camera = { position_m = [0.0, 0.0, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0] }
        material = [{ name = \"m\", kind = \"metal\", metal = \"gold\" }]
        object = [{ name = \"o\", material = \"m\", shape = { disk = { radius_m = 0.05 } }, translation_m = [0.1, 0.2, 0.3], rotation_deg = [20.0, 30.0, 40.0] }]
        grating = [
            { object = \"o\", pattern = \"swirl\", pitch_um = 20.0, spacing_m = 0.005, hidden = true },
            { object = \"o\", pattern = \"parallel\", direction = [3.0, 4.0, 0.0], center_m = [0.01, 0.0, 0.0], radius_m = [0.0, 0.03], pitch_um = 20.0 },
        ]
    ";
    let dir = temporary_dir();
    let description = Description::from_toml(text, Path::new("rows.toml")).unwrap();
    let (root, chunk) = taken_apart(&exported(&description, dir.path()).bytes);
    let gratings = &root["extensions"]["HAIRLINE_scratches"]["grating"];
    assert_eq!(gratings[0].get("laid"), None);
    // Whoever opens the file makes the table of one that is not fine.
    let plain = Loader::default().export(&description, dir.path(), Export::default());
    let (plain, _) = taken_apart(&plain.unwrap().bytes);
    let rows = &plain["extensions"]["HAIRLINE_scratches"]["grating"];
    assert_eq!(rows[1].get("laid"), None);
    let laid = &gratings[1]["laid"];
    let near = |key: &str, expected: [f64; 3]| {
        for (i, expected) in expected.into_iter().enumerate() {
            let found = laid[key][i].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-12, "{key}: {found}");
        }
    };
    near("axis", [0.6, 0.8, 0.0]);
    near("center", [0.01, 0.0, 0.0]);
    assert_eq!(
        (&laid["kind"], &laid["is_fine"]),
        (&json!("along"), &json!(false))
    );
    assert_eq!(laid["radii_m"], json!([0.0, 0.03]));
    // Light of all orders at the depth of the first row and of the last one, over that of the scene's own table.
    let texels = words(&root, &chunk, &laid["texels"]);
    let scene = hairline_document::build(&description, dir.path()).unwrap();
    let grating = &scene.objects[0].gratings[0];
    let rows = rows_down_to(grating.row.depth_nm);
    assert_eq!(texels.len(), 4 * 512 * rows);
    let tables = ScratchTables::new(&scene);
    let own = tables.grating_table(grating, 0).unwrap();
    for (row, depth_nm) in [
        (1, GRATING_DEPTH_NM / (rows - 1) as f64),
        (rows - 1, GRATING_DEPTH_NM),
    ] {
        let expected = tables.tables[own].scratch_table(1e18, depth_nm);
        for (c, expected) in expected.into_iter().enumerate() {
            let found = f32::from_bits(texels[4 * (512 * row + 511) + c]);
            assert!(
                (f64::from(found) / expected - 1.0).abs() < 1e-5,
                "{found} {expected}"
            );
        }
    }
    let (_, again) = reopened(&description, dir.path());
    assert_eq!(again.gratings, description.gratings);
}

#[test]
fn a_grating_by_texture_coordinates_has_no_axis_and_its_mesh_has_tangents() {
    let text = "
        camera = { position_m = [0.0, 0.0, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0] }
        material = [{ name = \"m\", kind = \"metal\", metal = \"gold\" }]
        object = [
            { name = \"o\", material = \"m\", shape = { sphere = { radius_m = 0.05 } } },
            { name = \"p\", material = \"m\", shape = { sphere = { radius_m = 0.01 } } },
        ]
        grating = [
            { object = \"o\", pattern = \"uv\", along = \"v\", pitch_um = 20.0, mask = \"mask.png\", directions = \"mask.png\" },
            { object = \"p\", pattern = \"circular\", pitch_um = 20.0, mask = \"mask.png\" },
            { object = \"p\", pattern = \"circular\", pitch_um = 20.0, mask = \"mask.png\", tile_m = 0.01 },
        ]
    ";
    let dir = temporary_dir();
    let picture = image::RgbImage::from_pixel(2, 2, image::Rgb([255, 128, 0]));
    picture.save(dir.path().join("mask.png")).unwrap();
    let description = Description::from_toml(text, Path::new("rows.toml")).unwrap();
    let (root, chunk) = taken_apart(&exported(&description, dir.path()).bytes);
    let gratings = &root["extensions"]["HAIRLINE_scratches"]["grating"];
    assert_eq!(gratings[0]["laid"]["kind"], "along-v");
    assert_eq!(gratings[0]["laid"].get("axis"), None);
    assert_eq!(
        (&gratings[0]["mask"], &gratings[0]["directions"]),
        (&json!(0), &json!(0))
    );
    assert_eq!(gratings[1]["laid"]["kind"], "circular");
    assert_eq!(gratings[2].get("laid"), None);
    // Grooves around the axis: tangents are horizontal units, across the way to the middle.
    let attributes = |mesh: usize| &root["meshes"][mesh]["primitives"][0]["attributes"];
    assert_eq!(attributes(1).get("TANGENT"), None);
    let floats = |name: &str| {
        let words = words(&root, &chunk, &attributes(0)[name]);
        words.into_iter().map(f32::from_bits).collect::<Vec<f32>>()
    };
    let (tangents, normals) = (floats("TANGENT"), floats("NORMAL"));
    assert_eq!(tangents.len() / 4, normals.len() / 3);
    for (tangent, normal) in tangents.chunks(4).zip(normals.chunks(3)) {
        let across = tangent[0] * normal[0] + tangent[1] * normal[1];
        assert!(across.abs() < 1e-6 && tangent[2] == 0.0, "{tangent:?}");
        assert!((tangent[0].hypot(tangent[1]) - 1.0).abs() < 1e-6 && tangent[3] == 1.0);
    }
}

#[test]
fn lights_without_words_have_a_node_that_names_their_table() {
    let (dir, description) = whole();
    let (root, _) = taken_apart(&exported(&description, dir.path()).bytes);
    let named = |number: usize| -> Vec<&Value> {
        let nodes = root["nodes"].as_array().unwrap().iter();
        let own = nodes.map(|node| &node["extensions"]);
        own.filter(|it| it["HAIRLINE_scratches"]["light"] == number)
            .collect()
    };
    // A tube.
    let [tube] = named(3)[..] else {
        panic!("found {:?}", named(3));
    };
    let expected = json!({ "light": 3, "color": [1.0, 1.0, 1.0], "intensity": 683.0 });
    assert_eq!(tube["HAIRLINE_scratches"], expected);
    // A rectangle, and both sides of a disk; one that is hidden has none.
    assert_eq!(named(1).len(), 1);
    assert!(named(1)[0]["EXT_lights_area"]["light"].is_u64());
    assert_eq!(named(2).len(), 2);
    assert!(named(5).is_empty());
}

/// The note of a file whose extension was changed so, which is shown plain.
fn note_of(dir: &Path, bytes: &[u8], change: impl Fn(&mut Value)) -> String {
    let (mut root, chunk) = taken_apart(bytes);
    change(&mut root);
    let path = dir.join("bad.glb");
    std::fs::write(&path, glb_of(&root.to_string(), &chunk)).unwrap();
    let plain = Description::for_model(&path).unwrap();
    assert!(plain.scratches.is_empty());
    assert_eq!(plain.objects[0].surface, Surface::Mesh("bad.glb".into()));
    hairline_document::build(&plain, dir).unwrap();
    let note = plain
        .notes
        .into_iter()
        .find(|it| it.contains("shown plain"))
        .unwrap();
    note.replace(&format!("{}/", dir.display()), "")
}

#[test]
fn a_wrong_extension_is_named_and_the_model_is_shown_plain() {
    let (dir, description) = whole();
    let bytes = exported(&description, dir.path()).bytes;
    type Change = fn(&mut Value);
    let cases: [(Change, &str); 9] = [
        (
            |it| it["version"] = json!(2),
            "version: found version 2; must be 1: this Hairline knows no other one",
        ),
        (
            |it| it["version"] = json!(null),
            "version: found version null; must be 1: this Hairline knows no other one",
        ),
        (
            |it| it["scratches"][0]["seed"] = json!(9_223_372_036_854_775_808_u64),
            "scratches[0].seed: found the whole number 9223372036854775808; must be a whole number from 0 to 2^63 - 1",
        ),
        (
            |it| it["scratches"][0]["seed"] = json!(-1),
            "scratches[0].seed: found the whole number -1; must be a whole number from 0 to 2^63 - 1",
        ),
        (
            |it| it["scratches"][1]["where"]["mask"] = json!(77),
            "scratches[1].where.mask: found 77; must be below 5, the number of its `files`",
        ),
        (
            |it| it["files"][0]["bufferView"] = json!(7777),
            "grating[0].mask: it has no buffer view 7777; must be below",
        ),
        (
            |it| it["scratches"][2]["file"]["end_m"] = json!(0),
            "scratches[2].file: found 2 starts, ",
        ),
        (
            |it| it["scratches"][0]["depth_nm"] = json!(5000),
            "scratches[0].depth_nm: found 5000; must be",
        ),
        (
            |it| it["scratches"][0]["object"] = json!("plat"),
            "scratches[0].object: found no object called \"plat\"; did you mean \"plate\"?",
        ),
    ];
    for (change, message) in cases {
        let note = note_of(dir.path(), &bytes, |root| {
            change(&mut root["extensions"]["HAIRLINE_scratches"]);
        });
        let wanted = format!("bad.glb: extensions.HAIRLINE_scratches.{message}");
        assert!(note.starts_with(&wanted), "{note}\n{wanted}");
    }
}

#[test]
fn a_file_that_is_cut_short_is_refused() {
    let (dir, description) = whole();
    let bytes = exported(&description, dir.path()).bytes;
    let path = dir.path().join("cut.glb");
    for length in [3, 30, bytes.len() / 2, bytes.len() - 1] {
        std::fs::write(&path, &bytes[..length]).unwrap();
        let error = Description::for_model(&path).unwrap_err();
        assert_eq!(error.file(), Some(&*path));
    }
}

#[test]
fn a_missing_model_in_a_file_is_named() {
    let dir = temporary_dir();
    let path = cube_file(dir.path());
    let description = Description::for_model(&path).unwrap();
    let bytes = exported(&description, dir.path()).bytes;
    let note = note_of(dir.path(), &bytes, |root| {
        for node in root["nodes"].as_array_mut().unwrap() {
            node.as_object_mut().unwrap().remove("extensions");
        }
    });
    let wanted = "object[0].mesh: it holds no model called \"cube.glb\"; must be one of";
    assert!(note.contains(wanted), "{note}");
}

#[test]
fn a_second_model_is_refused() {
    let dir = temporary_dir();
    let path = cube_file(dir.path());
    std::fs::copy(&path, dir.path().join("other.glb")).unwrap();
    let text = r#"
camera = { position_m = [0.1, -0.9, 0.6], target_m = [0.0, 0.0, 0.01], up = [0.0, 0.0, 1.0] }
object = [{ name = "a", mesh = "cube.glb" }, { name = "b", mesh = "other.glb" }]
light = [{ kind = "sphere", center_m = [0.0, 0.0, 1.0], radius_m = 0.1 }]
"#;
    let description = Description::from_toml(text, Path::new("two.toml")).unwrap();
    let loader = Loader::default();
    let error = loader
        .export(&description, dir.path(), Export::default())
        .unwrap_err();
    assert_eq!(error.key(), "object[1].mesh");
}
