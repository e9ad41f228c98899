//! glTF and GLB files: their possible contents, and the errors of broken ones. The files are made here.

use std::path::Path;

use crate::common::{self, Glb, asset, cube, glb_of, png, scene_with, temporary_dir};
use glam::{DVec2, DVec3, Vec3};
use hairline_document::{Description, Error};
use hairline_scene::{Base, Mesh, Scene};

/// Loads a scene whose only object is a mesh file, with more keys for its table.
fn load(path: &Path, more: &str) -> Result<Scene, Error> {
    let file = path.file_name().unwrap().to_str().unwrap();
    // Axes are the file's unless `more` sets them.
    let up = match more.contains("up = ") {
        true => "",
        false => "up = \"z\"\n",
    };
    let text = scene_with(&format!(
        "[[object]]\nname = \"it\"\nmesh = \"{file}\"\n{up}{more}"
    ));
    hairline_document::from_toml(&text, "test.toml", path.parent().unwrap())
}

fn load_bytes(bytes: &[u8], more: &str) -> Result<Scene, Error> {
    let dir = temporary_dir();
    let path = dir.path().join("it.glb");
    std::fs::write(&path, bytes).unwrap();
    load(&path, more)
}

/// A file with a cube, without normals; `primitive` is added to its primitive's members.
fn cube_glb(primitive: &str, nodes: &str, glb: &mut Glb) -> Vec<u8> {
    let (corners, triangles) = cube();
    let positions = glb.floats(&corners);
    let indices = glb.indices(&triangles);
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}{primitive}}}]}}"#
    );
    glb.bytes(&mesh, nodes)
}

fn plain_cube() -> Vec<u8> {
    cube_glb("", r#"{"mesh":0}"#, &mut Glb::default())
}

fn corners(mesh: &Mesh, i: usize) -> [DVec3; 3] {
    mesh.triangles[i].map(|v| mesh.positions_m[v as usize].as_dvec3())
}

/// The flux of r / 3 through a closed surface that faces outwards.
fn volume_m3(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len())
        .map(|i| {
            let [a, b, c] = corners(mesh, i);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

fn check_frames(mesh: &Mesh) {
    assert_eq!(mesh.positions_m.len(), mesh.normals.len());
    assert_eq!(mesh.positions_m.len(), mesh.tangents.len());
    assert_eq!(mesh.positions_m.len(), mesh.uvs.len());
    assert_eq!(mesh.triangles.len(), mesh.triangle_materials.len());
    for (normal, tangent) in mesh.normals.iter().zip(&mesh.tangents) {
        assert!((normal.length() - 1.0).abs() < 1e-5);
        assert!((tangent.truncate().length() - 1.0).abs() < 1e-5);
        assert!(normal.dot(tangent.truncate()).abs() < 1e-5);
        assert!(tangent.w.abs() == 1.0);
    }
}

/// Exports of mirrored parts have such triangles. The scene is the one of the file whose triangles are all wound right, and its author
/// is told.
#[test]
fn triangles_wound_against_their_normals_face_the_way_of_the_normals() {
    let tetrahedron = [
        [1.0f32, 1.0, 1.0],
        [-1.0, -1.0, 1.0],
        [-1.0, 1.0, -1.0],
        [1.0, -1.0, -1.0],
    ];
    let wound = |triangles: &[[u16; 3]]| {
        let mut glb = Glb::default();
        let positions = glb.floats(&tetrahedron);
        let normals = glb.floats(&tetrahedron.map(|p| p.map(|c| c / 3f32.sqrt())));
        let indices = glb.indices(triangles.as_flattened());
        let mesh = format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals}}},"indices":{indices}}}]}}"#
        );
        load_bytes(&glb.bytes(&mesh, r#"{"mesh":0}"#), "material = \"steel\"").unwrap()
    };
    let right = wound(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    // A tetrahedron in a cube of side 2.
    assert!((volume_m3(&right.objects[0].mesh) - 8.0 / 3.0).abs() < 1e-6);
    assert!(right.notes.is_empty(), "{:?}", right.notes);
    for (triangles, count) in [
        (
            [[0, 1, 2], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            "1 triangle is",
        ),
        (
            [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
            "4 triangles are",
        ),
    ] {
        let scene = wound(&triangles);
        let volume = volume_m3(&scene.objects[0].mesh);
        assert!((volume - 8.0 / 3.0).abs() < 1e-6, "{count}: {volume}");
        let note = format!("it.glb: {count} wound against the normals");
        assert!(scene.notes[0].starts_with(&note), "{:?}", scene.notes);
    }
}

/// A cube of 2 cm in coordinates of the Earth: single precision has half a metre there.
#[test]
fn models_far_from_their_origin_are_those_that_stand_at_it() {
    let node = |translation: &str| {
        let nodes = format!(r#"{{"mesh":0,"scale":[0.02,0.02,0.02]{translation}}}"#);
        cube_glb("", &nodes, &mut Glb::default())
    };
    let (far, near) = (node(r#","translation":[500000,100,-4000000]"#), node(""));
    for more in ["material = \"steel\"", "material = \"steel\"\nfit_m = 0.5"] {
        let [far, near] = [&far, &near].map(|bytes| load_bytes(bytes, more).unwrap());
        let [of_far, of_near] = [&far, &near].map(|scene| &scene.objects[0].mesh);
        assert_eq!(of_far.triangles.len(), 12);
        for (a, b) in of_far.positions_m.iter().zip(&of_near.positions_m) {
            assert!(a.distance(*b) < 1e-8, "{a} {b}");
        }
        assert!(
            far.notes[0].contains("4.031e6 m from its own origin"),
            "{:?}",
            far.notes
        );
        assert!(near.notes.is_empty());
    }
    // Alone: in the middle of a scene that shows it.
    let dir = temporary_dir();
    let path = dir.path().join("it.glb");
    let mut shown = [&far, &near].map(|bytes| {
        std::fs::write(&path, bytes).unwrap();
        Description::for_model(&path).unwrap()
    });
    for description in &shown {
        description.check().unwrap();
        hairline_document::build(description, dir.path()).unwrap();
    }
    let [far, near] = shown.each_mut().map(|it| DVec3::from(it.camera.position_m));
    assert!(far.distance(near) < 1e-6, "{far} {near}");
}

/// Sections 3.2, 3.5 and 3.9 of the specification, and RFC 8259 on order marks.
#[test]
fn what_the_specification_says_of_odd_files() {
    let plain = plain_cube();
    let text = |from: &str, to: &str| {
        let mut glb = Glb::default();
        let (corners, triangles) = cube();
        let positions = glb.floats(&corners);
        let indices = glb.indices(&triangles);
        let mesh = format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
        );
        let json = glb.json(&mesh, r#"{"mesh":0}"#, None);
        assert!(json.contains(from), "{json}");
        glb_of(&json.replace(from, to), &glb.bin)
    };
    let expected = load_bytes(&plain, "material = \"steel\"").unwrap();
    let version = r#""version":"2.0""#;
    let read = load_bytes(&text(version, r#""version":2.0"#), "material = \"steel\"").unwrap();
    assert_eq!(
        read.objects[0].mesh.positions_m,
        expected.objects[0].mesh.positions_m
    );
    let least = |least: &str| text(version, &format!(r#""version":"2.0","minVersion":{least}"#));
    assert!(load_bytes(&least("\"2.0\""), "material = \"steel\"").is_ok());
    for newer in ["\"2.1\"", "2.1"] {
        let error = load_bytes(&least(newer), "material = \"steel\"").unwrap_err();
        assert!(
            error.found().contains("it needs a reader of glTF 2.1"),
            "{error}"
        );
    }

    // A text with an order mark, its buffer beside it.
    let dir = temporary_dir();
    let mut glb = Glb::default();
    let (corners, triangles) = cube();
    let positions = glb.floats(&corners);
    let indices = glb.indices(&triangles);
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
    );
    let json = glb.json(&mesh, r#"{"mesh":0}"#, Some("it.bin"));
    std::fs::write(dir.path().join("it.bin"), &glb.bin).unwrap();
    let path = dir.path().join("it.gltf");
    std::fs::write(&path, [b"\xef\xbb\xbf", json.as_bytes()].concat()).unwrap();
    let read = load(&path, "material = \"steel\"").unwrap();
    assert_eq!(
        read.objects[0].mesh.positions_m,
        expected.objects[0].mesh.positions_m
    );
    // The files that it names are found too.
    assert_eq!(
        hairline_document::inputs::of_model(&path),
        [dir.path().join("it.bin")]
    );
}

/// A texture by a set of coordinates that the mesh does not have.
#[test]
fn images_without_their_coordinates_are_told() {
    let mut glb = Glb::default();
    let view = glb.view(&png([1, 1], [9, 9, 9, 255]));
    glb.more = format!(
        r#","images":[{{"bufferView":{view},"mimeType":"image/png"}}],"textures":[{{"source":0}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0,"texCoord":1}}}}}}]"#
    );
    let bytes = cube_glb(r#","material":0"#, r#"{"mesh":0}"#, &mut glb);
    let notes = load_bytes(&bytes, "").unwrap().notes;
    assert!(
        notes[0].starts_with("it.glb: 1 primitive has no TEXCOORD_1"),
        "{notes:?}"
    );
    assert!(
        load_bytes(&bytes, "material = \"steel\"")
            .unwrap()
            .notes
            .is_empty()
    );
}

/// The up of its picture is that of the file, whichever way that runs on the ground; a scene file that looks down does the same.
#[test]
fn a_camera_that_looks_straight_down_sees_the_top() {
    for turn in [0.0_f64, 30.0, 90.0, 180.0, 260.0] {
        let mut glb = Glb {
            more: r#","cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}]"#
                .into(),
            ..Glb::default()
        };
        // About y after a quarter turn about x: as quaternions, the product of both.
        let ((s, c), q) = ((0.5 * turn.to_radians()).sin_cos(), 0.5_f64.sqrt());
        let rotation = [-q * c, q * s, q * s, q * c];
        let nodes = format!(
            r#"{{"mesh":0,"children":[1]}},{{"camera":0,"translation":[0,2,0],"rotation":{rotation:?}}}"#
        );
        let bytes = cube_glb("", &nodes, &mut glb);
        let dir = temporary_dir();
        let path = dir.path().join("top.glb");
        std::fs::write(&path, &bytes).unwrap();
        let mut description = Description::for_model(&path).unwrap();
        description.see_by("0", dir.path()).unwrap();
        description.check().unwrap();
        assert_eq!(description.camera.world_up(), DVec3::Z);
        let scene = hairline_document::build(&description, dir.path()).unwrap();
        // The file's y is up: its picture's up, -z turned about y, is +y of the world turned about z.
        let (sin, cos) = turn.to_radians().sin_cos();
        let up = DVec3::new(-sin, cos, 0.0);
        let frame = scene.camera.frame([100, 100]);
        let ray = frame.camera_ray(DVec2::new(50.0, 20.0)).normalize();
        let above = (ray - DVec3::NEG_Z * ray.dot(DVec3::NEG_Z)).normalize();
        assert!(above.distance(up) < 1e-5, "{turn}: {above} {up}");
        assert!(scene.camera.position_m.distance(2.0 * DVec3::Z) < 1e-6);
    }
    // The same view of a world whose up is y: the model stands as its file does.
    let bytes = plain_cube();
    let dir = temporary_dir();
    std::fs::write(dir.path().join("it.glb"), bytes).unwrap();
    for up in ["[0, 0, -1]", "[1, 0, 0]", "[-1, 0, 0]"] {
        let text = format!(
            "[camera]\nposition_m = [0, 2, 0]\ntarget_m = [0, 0, 0]\nup = {up}\n[[object]]\nname = \"it\"\nmesh = \"it.glb\"\n\
             scale = [1, 2, 3]"
        );
        let scene = hairline_document::from_toml(&text, "test.toml", dir.path()).unwrap();
        let (least, most) = scene.objects[0].mesh.bounds_m();
        assert_eq!(most - least, Vec3::new(1.0, 2.0, 3.0), "{up}");
    }
}

#[test]
fn a_cube_without_normals_is_flat_shaded() {
    let scene = load_bytes(&plain_cube(), "").unwrap();
    let mesh = &scene.objects[0].mesh;
    check_frames(mesh);
    assert_eq!(mesh.triangles.len(), 12);
    assert!((volume_m3(mesh) - 1.0).abs() < 1e-6);
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = corners(mesh, i);
        let flat = (b - a).cross(c - a).normalize();
        for &v in triangle {
            assert!(mesh.normals[v as usize].as_dvec3().dot(flat) > 0.999_999);
        }
    }
    // The file has no material: glTF's default, rough white metal.
    let material = &scene.materials[mesh.triangle_materials[0] as usize];
    let default = Base::MetallicRoughness {
        base_color: [1.0; 3],
        metallic: 1.0,
    };
    assert_eq!((&material.base, material.roughness), (&default, 1.0));
}

#[test]
fn node_transforms_chain_and_mirror() {
    // The child is mirrored and doubled along x, the parent turned by 90 degrees about z and moved.
    let nodes = r#"{"children":[1],"translation":[1,0,0],"rotation":[0,0,0.70710678,0.70710678]},
        {"mesh":0,"scale":[-2,1,1],"translation":[0.5,0,0]}"#;
    let scene = load_bytes(
        &cube_glb("", nodes, &mut Glb::default()),
        "translation_m = [0, 0, 5]",
    );
    let mesh = &scene.unwrap().objects[0].mesh;
    let (least, most) = mesh.bounds_m();
    // Along the child's x: from -0.5 to 1.5, which the parent turns to y.
    assert!(
        least.abs_diff_eq(glam::vec3(0.5, -0.5, 4.5), 1e-6),
        "{least}"
    );
    assert!(most.abs_diff_eq(glam::vec3(1.5, 1.5, 5.5), 1e-6), "{most}");
    assert!((volume_m3(mesh) - 2.0).abs() < 1e-5);
    let matrix = r#"{"mesh":0,"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 3,4,5,1]}"#;
    let scene = load_bytes(&cube_glb("", matrix, &mut Glb::default()), "").unwrap();
    let (least, _) = scene.objects[0].mesh.bounds_m();
    assert!(least.abs_diff_eq(glam::vec3(2.5, 3.5, 4.5), 1e-6));
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let number =
            chunk.iter().fold(0u32, |n, b| n << 8 | u32::from(*b)) << (8 * (3 - chunk.len()));
        for i in 0..4 {
            match i <= chunk.len() {
                true => text.push(DIGITS[(number >> (18 - 6 * i) & 63) as usize] as char),
                false => text.push('='),
            }
        }
    }
    text
}

#[test]
fn primitives_keep_their_materials_and_textures() {
    let mut glb = Glb::default();
    let quad = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let positions = glb.floats(&quad);
    let normals = glb.floats(&[[0.0, 0.0, 1.0f32]; 4]);
    // v runs down, as in glTF: the quad shows the image upright.
    let uvs = glb.floats(&[[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0f32]]);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let embedded = glb.view(&png([4, 2], [200, 100, 50, 255]));
    let data_uri = base64(&png([1, 1], [0, 128, 255, 255]));
    glb.more = format!(
        r#","images":[{{"bufferView":{embedded},"mimeType":"image/png"}},{{"uri":"data:image/png;base64,{data_uri}"}},{{"uri":"beside%20it.png"}}],
        "textures":[{{"source":0}},{{"source":1}},{{"source":2}}],
        "materials":[
          {{"name":"red","pbrMetallicRoughness":{{"baseColorFactor":[1,0,0,1],"metallicFactor":0.25,"roughnessFactor":0.5}}}},
          {{"name":"mapped","pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}},"metallicRoughnessTexture":{{"index":1}}}},
            "normalTexture":{{"index":2,"scale":0.5}},"emissiveTexture":{{"index":0}},"emissiveFactor":[1,0.5,0],
            "extensions":{{"KHR_materials_emissive_strength":{{"emissiveStrength":4}}}}}}]"#
    );
    let attributes =
        format!(r#""attributes":{{"POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs}}}"#);
    let mesh = format!(
        r#"{{"primitives":[{{{attributes},"indices":{indices},"material":1}},{{{attributes},"mode":5,"material":0}},{{{attributes},"mode":1}}]}}"#
    );
    let nodes = r#"{"mesh":0,"children":[1]},{"mesh":0,"translation":[0,0,1]}"#;
    let dir = temporary_dir();
    std::fs::write(dir.path().join("it.glb"), glb.bytes(&mesh, nodes)).unwrap();
    std::fs::write(
        dir.path().join("beside it.png"),
        png([3, 3], [128, 128, 255, 255]),
    )
    .unwrap();

    let scene = load(&dir.path().join("it.glb"), "").unwrap();
    let mesh = &scene.objects[0].mesh;
    check_frames(mesh);
    // Two quads of two triangles, twice; the lines are skipped.
    assert_eq!(mesh.triangles.len(), 8);
    let names: Vec<_> = mesh
        .triangle_materials
        .iter()
        .map(|&m| scene.materials[m as usize].name.as_str())
        .collect();
    assert_eq!(names, ["mapped", "mapped", "red", "red"].repeat(2));
    // Each of the file's materials comes once, after the scene's own.
    assert_eq!(scene.materials.len(), 3);

    let mapped = &scene.materials[mesh.triangle_materials[0] as usize];
    let base = &scene.textures[mapped.base_color_texture.unwrap()];
    assert!(base.srgb);
    assert_eq!(base.size_px, [4, 2]);
    assert_eq!(
        base.levels.iter().map(Vec::len).collect::<Vec<_>>(),
        [8, 2, 1]
    );
    assert_eq!(base.levels[2], [[200, 100, 50, 255]]);
    assert_eq!(mapped.emission_texture, mapped.base_color_texture);
    assert_eq!(mapped.emission, [4.0, 2.0, 0.0]);
    let rough = &scene.textures[mapped.metallic_roughness_texture.unwrap()];
    assert!(!rough.srgb && rough.levels[0] == [[0, 128, 255, 255]]);
    let (normal, scale) = mapped.normal_texture.unwrap();
    assert_eq!((scene.textures[normal].size_px, scale), ([3, 3], 0.5));
    // Made up for the normal map: along u, which is x, with the bitangent up.
    for triangle in &mesh.triangles[..2] {
        for &v in triangle {
            let tangent = mesh.tangents[v as usize];
            assert!(
                tangent.abs_diff_eq(glam::vec4(1.0, 0.0, 0.0, 1.0), 1e-5),
                "{tangent}"
            );
        }
    }
    // An override changes factors, and leaves all maps and the other materials.
    let path = dir.path().join("it.glb");
    let over = "overrides = [{ material = \"mapped\", roughness = 0.25, metallic = 0.5, base_color = [0.5, 0.25, 1] }]";
    let other = load(&path, over).unwrap();
    let red = scene.materials.iter().find(|m| m.name == "red");
    assert_eq!(other.materials.iter().find(|m| m.name == "red"), red);
    let expected = hairline_scene::Material {
        roughness: 0.25,
        base: Base::MetallicRoughness {
            base_color: [0.5, 0.25, 1.0],
            metallic: 0.5,
        },
        ..mapped.clone()
    };
    let changed = other.materials.iter().find(|m| m.name == "mapped");
    assert_eq!(changed, Some(&expected));
    let gold = load(
        &path,
        "overrides = [{ material = \"red\", metal = \"gold\" }]",
    )
    .unwrap();
    let changed = gold.materials.iter().find(|m| m.name == "red").unwrap();
    let Base::MetallicRoughness {
        base_color,
        metallic,
    } = changed.base
    else {
        panic!("{changed:?}");
    };
    // Gold reflects red almost whole and a third of blue, and is a metal.
    assert!(base_color[0] > 0.9 && base_color[2] < 0.5 && metallic == 1.0);
    for (more, expected) in [
        (
            "overrides = [{ material = \"maped\" }]",
            "object[0].overrides[0].material: found no material called \"maped\" in the object; did you mean \"mapped\"?",
        ),
        (
            "overrides = [{ material = \"red\", roughness = 2 }]",
            "object[0].overrides[0].roughness: found 2; must be from 0 to 1",
        ),
        (
            "overrides = [{ material = \"red\", metal = \"golt\" }]",
            "object[0].overrides[0].metal: found the text \"golt\"; did you mean `gold`?",
        ),
        (
            "overrides = [{ material = \"red\", metal = \"gold\", base_color = [1, 1, 1] }]",
            "object[0].overrides[0].metal: found `base_color` beside it; must have one of them at most",
        ),
        (
            "material = \"steel\"\noverrides = [{ material = \"red\", roughness = 0.5 }]",
            "object[0].overrides: found `material` beside it, of which all of the mesh is; leave out one of the two",
        ),
    ] {
        let error = load(&path, more).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }

    // A material of the scene replaces all of them, and no texture is read.
    let scene = load(&dir.path().join("it.glb"), "material = \"steel\"").unwrap();
    assert!(
        scene.objects[0]
            .mesh
            .triangle_materials
            .iter()
            .all(|&m| m == 0)
    );
    assert!(scene.textures.is_empty());
}

#[test]
fn buffers_may_lie_beside_or_in_a_data_uri() {
    let (corners, triangles) = cube();
    let mut glb = Glb::default();
    let positions = glb.floats(&corners);
    let indices = glb.indices(&triangles);
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
    );
    let dir = temporary_dir();
    let path = dir.path().join("it.gltf");
    std::fs::create_dir(dir.path().join("data")).unwrap();
    for name in ["it data.bin", "half%20.bin", "data/it.bin"] {
        std::fs::write(dir.path().join(name), &glb.bin).unwrap();
    }
    let text = base64(&glb.bin);
    let data_uri = format!("DATA:application/octet-stream;BASE64,{text}");
    // RFC 2397: escapes are for any character; without `;base64` they are all there is.
    let slashes = text.replace('/', "%2F").replace('+', "%2b");
    let escaped = format!("data:;base64,{}", slashes.replace('=', "%3D"));
    let lines: Vec<_> = text
        .as_bytes()
        .chunks(76)
        .map(String::from_utf8_lossy)
        .collect();
    let lines = format!("data:;base64,{}", lines.join(r"\r\n"));
    let plain: String = glb.bin.iter().map(|byte| format!("%{byte:02x}")).collect();
    let plain = format!("data:application/octet-stream,{plain}");
    for uri in [
        "it%20data.bin",
        "it data.bin",
        &data_uri,
        &escaped,
        &lines,
        &plain,
        // Left unescaped by its exporter; written on Windows, in two ways.
        "half%20.bin",
        r"data\\it.bin",
        "data%5Cit.bin",
    ] {
        std::fs::write(&path, glb.json(&mesh, r#"{"mesh":0}"#, Some(uri))).unwrap();
        let scene = load(&path, "").unwrap();
        assert!(
            (volume_m3(&scene.objects[0].mesh) - 1.0).abs() < 1e-6,
            "{uri}"
        );
    }
}

/// Images are found from the glTF file, above its folder too; a path that only this machine has is refused.
#[test]
fn images_are_named_from_the_file() {
    let dir = temporary_dir();
    let folder = dir.path().join("models");
    std::fs::create_dir(&folder).unwrap();
    let picture = dir.path().join("above.png");
    std::fs::write(&picture, png([3, 2], [9, 9, 9, 255])).unwrap();
    let load_with = |uri: &str| {
        let mut glb = Glb {
            more: format!(
                r#","images":[{{"uri":"{uri}"}}],"textures":[{{"source":0}}],
                "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}]"#
            ),
            ..Glb::default()
        };
        let bytes = cube_glb(r#","material":0"#, r#"{"mesh":0}"#, &mut glb);
        std::fs::write(folder.join("it.glb"), bytes).unwrap();
        load(&folder.join("it.glb"), "")
    };
    let scene = load_with("../above.png").unwrap();
    assert_eq!(scene.textures[0].size_px, [3, 2]);
    let absolute = picture.to_str().unwrap();
    for uri in [absolute, &format!("file://{absolute}"), "C:/above.png"] {
        let error = load_with(uri).unwrap_err().to_string();
        let expected = format!(
            "its image 0 is at \"{uri}\"; must be a file, by a path relative to the glTF file"
        );
        assert!(error.contains(&expected), "{error}");
    }
}

#[test]
fn sparse_and_quantized_accessors_are_read() {
    // Positions of zeros, three of which are replaced; normalised bytes as texture coordinates.
    let mut glb = Glb::default();
    let places = glb.view(&[1, 2]);
    let values: Vec<u8> = [1f32, 0.0, 0.0, 0.0, 2.0, 0.0]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let values = glb.view(&values);
    let positions = glb.accessor(format!(
        r#"{{"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0],"sparse":{{"count":2,"indices":{{"bufferView":{places},"componentType":5121}},"values":{{"bufferView":{values}}}}}}}"#
    ));
    let uv_bytes = glb.view(&[0, 255, 51, 0, 255, 0]);
    let uvs = glb.accessor(format!(
        r#"{{"bufferView":{uv_bytes},"componentType":5121,"normalized":true,"count":3,"type":"VEC2"}}"#
    ));
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs}}}}}]}}"#
    );
    let scene = load_bytes(&glb.bytes(&mesh, r#"{"mesh":0}"#), "").unwrap();
    let mesh = &scene.objects[0].mesh;
    assert_eq!(mesh.triangles.len(), 1);
    assert_eq!(mesh.positions_m[2], glam::vec3(0.0, 2.0, 0.0));
    assert_eq!(mesh.uvs[1], glam::vec2(0.2, 0.0));
}

/// KHR_mesh_quantization: positions of whole numbers that the node scales, and normals of bytes, in steps of four bytes.
#[test]
fn whole_numbers_are_positions_and_normals() {
    let mut glb = Glb::default();
    let mut add = |bytes: &[u8], stride: usize, kind: &str| {
        let view = glb.view(bytes);
        glb.views[view] = glb.views[view].replace("}", &format!(r#","byteStride":{stride}}}"#));
        glb.accessor(format!(
            r#"{{"bufferView":{view},{kind},"count":3,"type":"VEC3"}}"#
        ))
    };
    let positions = [[-300i16, 0, 7, 0], [500, -2, 7, 0], [0, 32767, 7, 0]];
    let positions: Vec<u8> = positions
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let bounds = r#""componentType":5122,"min":[-300,-2,7],"max":[500,32767,7]"#;
    let positions = add(&positions, 8, bounds);
    let normals = [[127i8, 0, 0, 0], [0, -127, 0, 0], [0, 0, 127, 0]];
    let normals: Vec<u8> = normals.as_flattened().iter().map(|x| *x as u8).collect();
    let normals = add(&normals, 4, r#""componentType":5120,"normalized":true"#);
    glb.more = r#","extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"]"#.to_owned();
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals}}}}}]}}"#
    );
    let bytes = glb.bytes(&mesh, r#"{"mesh":0,"scale":[0.25,0.25,0.25]}"#);
    let scene = load_bytes(&bytes, "").unwrap();
    let mesh = &scene.objects[0].mesh;
    let expected = [
        [-75.0, 0.0, 1.75],
        [125.0, -0.5, 1.75],
        [0.0, 8191.75, 1.75f32],
    ];
    assert_eq!(mesh.positions_m[..], expected.map(Vec3::from));
    assert_eq!(mesh.normals[..], [Vec3::X, Vec3::NEG_Y, Vec3::Z]);
    assert_eq!(scene.notes, [""; 0]);
}

/// EXT_texture_webp: a texture whose only image is a WebP one, which the extension names.
#[test]
fn a_texture_may_have_a_webp_image_alone() {
    let texels = [
        [255, 0, 0, 255],
        [0, 255, 0, 255],
        [1, 2, 3, 255],
        [250, 128, 7, 255u8],
    ];
    let image = image::RgbaImage::from_raw(2, 2, texels.concat()).unwrap();
    let mut webp = std::io::Cursor::new(Vec::new());
    image.write_to(&mut webp, image::ImageFormat::WebP).unwrap();
    let mut glb = Glb::default();
    let view = glb.view(&webp.into_inner());
    // The first image is another one.
    let other = base64(&png([1, 1], [9, 9, 9, 255]));
    glb.more = format!(
        r#","extensionsUsed":["EXT_texture_webp"],"extensionsRequired":["EXT_texture_webp"],
            "images":[{{"uri":"data:image/png;base64,{other}"}},{{"bufferView":{view},"mimeType":"image/webp"}}],
            "textures":[{{"extensions":{{"EXT_texture_webp":{{"source":1}}}}}}],
            "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}]"#
    );
    let bytes = cube_glb(r#","material":0"#, r#"{"mesh":0}"#, &mut glb);
    let scene = load_bytes(&bytes, "").unwrap();
    let [texture] = &scene.textures[..] else {
        panic!("{}", scene.textures.len());
    };
    assert_eq!((texture.size_px, texture.srgb), ([2, 2], true));
    assert_eq!(texture.levels[0], texels);
}

/// Strips and fans are the triangles that section 3.7.2.1 of the specification lists, in its order and with its sides.
#[test]
fn strips_and_fans_are_lists_of_triangles() {
    // None of them is flat, and each pair of edges is another.
    let corners: Vec<[f32; 3]> = (0..7_u8)
        .map(|i| {
            let x = f32::from(i);
            [x, (x * 1.3).sin(), 0.3 * x * x]
        })
        .collect();
    let order = [2, 0, 5, 1, 6, 3, 4_u16];
    let load = |mode: u32, indices: Option<&[u16]>| {
        let mut glb = Glb::default();
        let positions = glb.floats(&corners);
        let indices = indices.map_or(String::new(), |indices| {
            format!(r#","indices":{}"#, glb.indices(indices))
        });
        let mesh = format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}}{indices},"mode":{mode}}}]}}"#
        );
        let scene = load_bytes(&glb.bytes(&mesh, r#"{"mesh":0}"#), "").unwrap();
        let mesh = scene.objects[0].mesh.clone();
        let corners = (0..mesh.triangles.len()).map(|i| self::corners(&mesh, i));
        corners.collect::<Vec<_>>()
    };
    let strip = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4], [4, 5, 6]];
    let fan = [[1, 2, 0], [2, 3, 0], [3, 4, 0], [4, 5, 0], [5, 6, 0]];
    // Each triangle from its least corner on: which one is the first does not matter.
    let sorted = |triangles: Vec<[DVec3; 3]>| {
        let mut all: Vec<_> = triangles
            .into_iter()
            .map(|triangle| {
                let mut corners = triangle.map(|corner| corner.to_array().map(f64::to_bits));
                let least = (0..3).min_by_key(|i| corners[*i]).unwrap();
                corners.rotate_left(least);
                corners
            })
            .collect();
        all.sort_unstable();
        all
    };
    for (mode, triangles) in [(5, strip), (6, fan)] {
        let plain: Vec<u16> = triangles.as_flattened().to_vec();
        let ordered: Vec<u16> = plain.iter().map(|i| order[usize::from(*i)]).collect();
        assert_eq!(
            sorted(load(mode, None)),
            sorted(load(4, Some(&plain))),
            "{mode}"
        );
        assert_eq!(
            sorted(load(mode, Some(&order))),
            sorted(load(4, Some(&ordered))),
            "{mode}"
        );
    }
}

/// The error for a file, without the place in the scene file.
fn flaw(bytes: &[u8]) -> String {
    let error = load_bytes(bytes, "").unwrap_err();
    assert_eq!(error.key(), "object[0].mesh");
    assert_eq!(error.line(), Some(13));
    format!("{}; {}", error.found(), error.right())
}

/// The files have rare contents that the specification allows, or lack contents that nothing needs.
#[test]
fn unusual_files_are_read() {
    let (corners, triangles) = common::cube();
    let mut glb = Glb::default();
    let positions = glb.floats(&corners);
    let indices = glb.indices(&triangles);
    let zeros = glb.accessor(r#"{"componentType":5126,"count":8,"type":"VEC2"}"#.to_owned());
    let mesh = format!(
        r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"TEXCOORD_0":{zeros}}},"indices":{indices}}}]}}"#
    );
    let text = glb.json(&mesh, r#"{"mesh":0}"#, None);
    let bounds = |bytes: &[u8]| {
        let dir = temporary_dir();
        std::fs::write(dir.path().join("it.glb"), bytes).unwrap();
        let scene = scene_with("[[object]]\nname = \"it\"\nmesh = \"it.glb\"\n");
        let scene = hairline_document::from_toml(&scene, "test.toml", dir.path()).unwrap();
        scene.objects[0].mesh.bounds_m()
    };
    let plain = glb_of(&text, &glb.bin);
    let expected = bounds(&plain);
    assert_eq!(bounds(&plain_cube()), expected);
    for [from, to] in [
        [
            r#""scenes":[{"nodes":[0]}]"#,
            r#""scenes":[{"nodes":[0]},{}]"#,
        ],
        [r#""count":8"#, r#""count":8.0"#],
        [r#""min":"#, r#""least":"#],
        [
            r#"],"bufferViews""#,
            r#",{"byteLength":1024}],"bufferViews""#,
        ],
        [
            r#""scene":0"#,
            r#""extensionsRequired":["KHR_materials_variants"],"scene":0"#,
        ],
    ] {
        assert!(text.contains(from), "{from} is not in {text}");
        let unusual = glb_of(&text.replacen(from, to, 1), &glb.bin);
        assert_eq!(bounds(&unusual), expected, "{to}");
    }
    let with_more_behind = [&plain[..], &[0; 5]].concat();
    assert_eq!(bounds(&with_more_behind), expected);
}

#[test]
fn broken_files_end_in_a_message() {
    let cube = plain_cube();
    let json = |edit: &dyn Fn(String) -> String| {
        let (corners, triangles) = common::cube();
        let mut glb = Glb::default();
        let positions = glb.floats(&corners);
        let indices = glb.indices(&triangles);
        let mesh = format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
        );
        glb_of(&edit(glb.json(&mesh, r#"{"mesh":0}"#, None)), &glb.bin)
    };
    let replaced = |from: &str, to: &str| {
        json(&|text| {
            assert!(text.contains(from), "{from} is not in {text}");
            text.replacen(from, to, 1)
        })
    };
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (
            b"no glTF at all".to_vec(),
            "it is neither binary nor text glTF",
        ),
        (cube[..6].to_vec(), "it ends within its header"),
        (cube[..cube.len() - 8].to_vec(), "it is cut off: "),
        (
            replaced(
                r#""buffers":[{"byteLength":168"#,
                r#""buffers":[{"byteLength":1680"#,
            ),
            "its buffer 0 is cut off: 168 of 1680 bytes are there; must be whole",
        ),
        (
            replaced(
                r#""byteOffset":0,"byteLength":96"#,
                r#""byteOffset":100,"byteLength":96"#,
            ),
            "its buffer view 0 reaches beyond its buffer; must end within it",
        ),
        (
            replaced(r#""count":8"#, r#""count":9"#),
            "its accessor 0 reaches beyond its buffer view; must end within it",
        ),
        (
            replaced(r#""count":8"#, r#""count":4"#),
            "its primitive 0 refers to vertex 4 of 4; indices must be below the number of vertices",
        ),
        (
            replaced(
                r#""nodes":[{"mesh":0}]"#,
                r#""nodes":[{"mesh":0,"children":[0]}]"#,
            ),
            "its node 0 is its own ancestor or has two parents; nodes must form trees",
        ),
        (
            replaced(
                r#""scene":0"#,
                r#""extensionsRequired":["KHR_materials_glow"],"scene":0"#,
            ),
            "it requires the extension KHR_materials_glow, which is not supported; export it again without that",
        ),
        (
            replaced(
                r#"{"byteLength":168"#,
                r#"{"uri":"gone.bin","byteLength":168"#,
            ),
            "its buffer 0, \"",
        ),
        (
            replaced(
                r#"{"byteLength":168"#,
                r#"{"uri":"data:;base64,%%%","byteLength":168"#,
            ),
            "the data URI of its buffer 0 cannot be decoded",
        ),
        (
            replaced(
                r#"{"byteLength":168"#,
                r#"{"uri":"https://example.org/a","byteLength":168"#,
            ),
            "its buffer 0 is at \"https://example.org/a\"; must be a file, by a path relative to the glTF file",
        ),
    ];
    for (bytes, expected) in cases {
        let message = flaw(&bytes);
        assert!(
            message.starts_with(&format!("\"it.glb\": {expected}")),
            "{message}\n{expected}"
        );
    }
}

#[test]
fn vertices_that_are_no_numbers_are_refused() {
    let (mut corners, triangles) = cube();
    for bad in [f32::NAN, f32::INFINITY] {
        corners[3][1] = bad;
        let mut glb = Glb::default();
        let bytes: Vec<u8> = corners
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let view = glb.view(&bytes);
        let positions = glb.accessor(format!(
            r#"{{"bufferView":{view},"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}}"#
        ));
        let indices = glb.indices(&triangles);
        let mesh = format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}]}}"#
        );
        let message = flaw(&glb.bytes(&mesh, r#"{"mesh":0}"#));
        assert!(message.contains("holds infinities or NaN"), "{message}");
    }
}

/// Section 4.4.3.2 asks for spaces.
#[test]
fn the_text_of_a_binary_file_may_end_in_zeros() {
    let glb = cube_glb("", r#"{"mesh":0}"#, &mut Glb::default());
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let (mut head, rest) = (glb[..20 + length].to_vec(), &glb[20 + length..]);
    head.extend([0; 4]);
    for at in [8, 12] {
        let number = u32::from_le_bytes(head[at..at + 4].try_into().unwrap()) + 4;
        head[at..at + 4].copy_from_slice(&number.to_le_bytes());
    }
    let scene = load_bytes(&[&head, rest].concat(), "").unwrap();
    assert!((volume_m3(&scene.objects[0].mesh) - 1.0).abs() < 1e-6);
}

/// Section 5.18 asks for a kind where a view holds an image; the bytes tell it too.
#[test]
fn images_need_no_kind() {
    let mut glb = Glb::default();
    let view = glb.view(&png([3, 2], [1, 2, 3, 255]));
    glb.more = format!(
        r#","images":[{{"bufferView":{view}}}],"textures":[{{"source":0}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}]"#
    );
    let scene = load_bytes(&cube_glb(r#","material":0"#, r#"{"mesh":0}"#, &mut glb), "").unwrap();
    assert_eq!(scene.textures[0].size_px, [3, 2]);
}

#[test]
fn corrupt_images_are_refused() {
    let mut glb = Glb::default();
    let mut bytes = png([8, 8], [1, 2, 3, 255]);
    bytes.truncate(bytes.len() / 2);
    let view = glb.view(&bytes);
    glb.more = format!(
        r#","images":[{{"bufferView":{view},"mimeType":"image/png"}}],"textures":[{{"source":0}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}]"#
    );
    let message = flaw(&cube_glb(r#","material":0"#, r#"{"mesh":0}"#, &mut glb));
    assert!(
        message.contains("its image 0 cannot be decoded"),
        "{message}"
    );
}

#[test]
fn meshes_without_area_are_refused_and_degenerate_triangles_dropped() {
    let message = |error: Error| format!("{}: {}; {}", error.key(), error.found(), error.right());
    let flat = load_bytes(
        &cube_glb("", r#"{"mesh":0,"scale":[1,0,0]}"#, &mut Glb::default()),
        "",
    );
    assert_eq!(
        message(flat.unwrap_err()),
        "object[0]: found no surface: every triangle of \"it\" has zero area; must have triangles that span an area"
    );
    let empty = load_bytes(
        &cube_glb(r#","mode":0"#, r#"{"mesh":0}"#, &mut Glb::default()),
        "",
    );
    assert!(message(empty.unwrap_err()).contains("points and lines, and no triangles"));
    // Flattened along z, the four sides vanish, top and bottom stay.
    let sheet = load_bytes(
        &cube_glb("", r#"{"mesh":0,"scale":[1,1,0]}"#, &mut Glb::default()),
        "",
    );
    assert_eq!(sheet.unwrap().objects[0].mesh.triangles.len(), 4);
}

/// No byte of a file can make the loader panic: every truncation, and every byte overwritten.
#[test]
fn damaged_files_never_panic() {
    let mut glb = Glb::default();
    let view = glb.view(&png([2, 2], [1, 2, 3, 255]));
    glb.more = format!(
        r#","images":[{{"bufferView":{view},"mimeType":"image/png"}}],"textures":[{{"source":0}}],"materials":[{{"normalTexture":{{"index":0}}}}]"#
    );
    let whole = cube_glb(
        r#","material":0"#,
        r#"{"mesh":0,"children":[1]},{"scale":[1,2,3]}"#,
        &mut glb,
    );
    assert!(load_bytes(&whole, "").is_ok());
    let dir = temporary_dir();
    let path = dir.path().join("it.glb");
    let mut refused = 0;
    let mut check = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        refused += usize::from(load(&path, "").is_err());
    };
    for length in 0..whole.len() {
        check(&whole[..length]);
    }
    for i in 0..whole.len() {
        for value in [0, b'9', b'-', 0xff] {
            let mut damaged = whole.clone();
            damaged[i] = value;
            check(&damaged);
        }
    }
    assert!(refused > whole.len());
}

#[test]
fn the_monkey_wears_scratches_under_the_studio() {
    let (Some(mesh), Some(map)) = (asset("suzi.glb"), asset("studio.hdr")) else {
        return;
    };
    let text = scene_with(&format!(
        "[environment]\nfile = {map:?}\n[[object]]\nname = \"it\"\nmesh = {mesh:?}\n[[scratches]]\nobject = \"it\"\npattern = \"random\"\ncount = 50000\n"
    ));
    let scene = hairline_document::from_toml(&text, "test.toml", "").unwrap();
    let object = &scene.objects[0];
    check_frames(&object.mesh);
    assert!(scene.environment.is_some());
    // Some seeds lie at a boundary and leave nothing.
    assert!(object.scratches.len() > 49_900);
}

/// The box around the only object.
fn bounds(scene: &Scene) -> [DVec3; 2] {
    let (least, most) = scene.objects[0].mesh.bounds_m();
    [least, most].map(|p| p.as_dvec3())
}

#[test]
fn files_stand_upright_and_fit() {
    // 1 wide, 2 high, 3 deep in the file.
    let bytes = cube_glb("", r#"{"mesh":0,"scale":[1,2,3]}"#, &mut Glb::default());
    let of = |more: &str| {
        let [least, most] = bounds(&load_bytes(&bytes, more).unwrap());
        most - least
    };
    let own = of("");
    assert_eq!(own / own.x, DVec3::new(1.0, 2.0, 3.0));
    let upright = of("up = \"y\"");
    assert_eq!(upright / upright.x, DVec3::new(1.0, 3.0, 2.0));
    // Same turn as by the rotation that scenes had to have before.
    assert_eq!(upright, of("rotation_deg = [90, 0, 0]"));
    let fitted = of("up = \"y\"\nfit_m = 0.3");
    assert!(
        (fitted - DVec3::new(0.1, 0.3, 0.2)).length() < 1e-7,
        "{fitted}"
    );
    let scaled = of("up = \"y\"\nfit_m = 0.3\nscale = 2");
    assert!((scaled - 2.0 * fitted).length() < 1e-6, "{scaled}");
}

/// A slanted bar fills a part of its bounding box alone, and was seen in less than half of the picture.
#[test]
fn a_slanted_model_fills_its_picture() {
    let node = r#"{"mesh":0,"rotation":[0.2014,0.1007,0.3826,0.8961],"scale":[0.03,0.5,0.02]}"#;
    let bytes = cube_glb("", node, &mut Glb::default());
    let dir = temporary_dir();
    let path = dir.path().join("bar.glb");
    std::fs::write(&path, bytes).unwrap();
    let description = Description::for_model(&path).unwrap();
    let scene = hairline_document::build(&description, dir.path()).unwrap();
    let frame = scene.camera.frame(scene.render.size_px);
    let seen = |point: &Vec3| {
        let offset = point.as_dvec3() - frame.position_m;
        let across = |step: DVec3| offset.dot(step) / step.length_squared();
        let at = DVec2::new(across(frame.per_px_x), across(frame.per_px_y));
        at / offset.dot(frame.forward) / frame.size_px + DVec2::splat(0.5)
    };
    let points = scene.objects[0].mesh.positions_m.iter().map(seen);
    let (least, most) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| {
        (a.min(p), b.max(p))
    });
    let margin = least.min(DVec2::ONE - most).min_element();
    // There is room for its shadow.
    assert!((0.08..0.14).contains(&margin), "{least} to {most}");
    let middle = 0.5 * (least + most) - DVec2::splat(0.5);
    assert!(middle.length() < 0.03, "{least} to {most}");
}

#[test]
fn a_shape_has_no_axes_of_a_file() {
    for key in ["up = \"y\"", "fit_m = 1"] {
        let text = scene_with(&format!(
            "{}{key}\n",
            common::object("{ disk = { radius_m = 1 } }")
        ));
        let error = hairline_document::from_toml(&text, "test.toml", "").unwrap_err();
        assert_eq!(error.right(), "it belongs to an object with a `mesh`");
    }
}

/// Contents that other programs write are named.
#[test]
fn what_cannot_be_read_is_named() {
    let asset = r#""asset":{"version":"2.0"}"#;
    let chain: Vec<_> = (0..400)
        .map(|i| format!(r#"{{"children":[{}]}}"#, i + 1))
        .collect();
    let of_avif = format!(
        r#"{{{asset},"textures":[{{"extensions":{{"EXT_texture_avif":{{"source":0}}}}}}],"images":[{{"uri":"a.avif"}}]}}"#
    );
    let cases = [
        (
            r#"{"asset":{"version":"1.0"},"meshes":{"a":{}}}"#.to_owned(),
            "it is a file of glTF 1.0",
        ),
        (
            format!(
                r#"{{{asset},"textures":[{{"extensions":{{"KHR_texture_basisu":{{"source":7}}}}}}],"images":[{{"uri":"a.ktx2"}}]}}"#
            ),
            "its texture 0 has no image that is there",
        ),
        (
            of_avif.clone(),
            "its texture 0 has an image by the extension EXT_texture_avif alone, which is not supported; \
             must have a PNG, JPEG, WebP or KTX2 image",
        ),
        (
            of_avif.replace("EXT_texture_avif", "MSFT_texture_dds"),
            "its texture 0 has an image by the extension MSFT_texture_dds alone, which is not supported",
        ),
        (
            of_avif.replace(
                r#""asset""#,
                r#""extensionsRequired":["EXT_texture_avif"],"asset""#,
            ),
            "it requires the extension EXT_texture_avif, which is not supported",
        ),
        (
            format!(
                r#"{{{asset},"scenes":[{{"nodes":[0]}}],"nodes":[{},{{}}]}}"#,
                chain.join(",")
            ),
            "its node 257 lies more than 256 nodes deep",
        ),
        (
            format!(r#"{{{asset},"nodes":[{{"children":[0]}}],"scenes":[{{"nodes":[0]}}]}}"#),
            "its node 0 is its own ancestor or has two parents",
        ),
        (
            format!(r#"{{{asset},"buffers":[{{"uri":"/etc/hostname","byteLength":1}}]}}"#),
            "its buffer 0 is at \"/etc/hostname\"; must be a file, by a path relative to the glTF file",
        ),
    ];
    for (text, expected) in cases {
        let error = load_bytes(text.as_bytes(), "").unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let mut binary = plain_cube();
    binary[4] = 1;
    let error = load_bytes(&binary, "").unwrap_err().to_string();
    assert!(error.contains("glTF 1.0"), "{error}");
}

/// A model at rest shows no animation, so one of an extension is no mistake.
#[test]
fn what_is_ignored_cannot_be_wrong() {
    let mut glb = Glb {
        more: r#","animations":[{"channels":[{"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/x"}}}}],"samplers":[]}],"cameras":[{"type":"fisheye"}]"#.to_owned(),
        ..Glb::default()
    };
    load_bytes(&cube_glb("", r#"{"mesh":0}"#, &mut glb), "").unwrap();
}

/// KHR_lights_punctual: a point, a spot that looks down, and a sun, beside a cube of a metre.
#[test]
fn lights_of_a_file_light_its_scene() {
    let more = r#","extensionsRequired":["KHR_lights_punctual"],"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[
        {"type":"point","name":"bulb","intensity":683,"color":[1,0.5,0.25]},
        {"type":"spot","intensity":1366,"spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}},
        {"type":"directional","intensity":2049}]}}"#;
    let mut glb = Glb {
        more: more.into(),
        ..Glb::default()
    };
    let light = |i: u32, place: &str| {
        format!(r#"{{"extensions":{{"KHR_lights_punctual":{{"light":{i}}}}},{place}}}"#)
    };
    let down = r#""rotation":[-0.70710678,0,0,0.70710678]"#;
    let nodes = [
        r#"{"mesh":0,"children":[1,2,3]}"#.to_owned(),
        light(0, r#""translation":[1,2,3]"#),
        light(1, &format!(r#""translation":[0,2,0],{down}"#)),
        light(2, down),
    ];
    let bytes = cube_glb("", &nodes.join(","), &mut glb);
    let dir = temporary_dir();
    let path = dir.path().join("lit.glb");
    std::fs::write(&path, &bytes).unwrap();
    let description = Description::for_model(&path).unwrap();
    description.check().unwrap();
    let scene = hairline_document::build(&description, dir.path()).unwrap();
    let [bulb, spot, sun] = &scene.lights[..] else {
        panic!("{:?}", scene.lights)
    };
    assert_eq!(description.lights[0].name.as_deref(), Some("bulb"));
    // Irradiance on a surface that faces a sphere of radiance L and radius r at distance d: L pi r^2 / d^2.
    let irradiance = |light: &hairline_scene::Light, at_m: DVec3| {
        let (center_m, radius_m) = light.bounding_sphere();
        let share = light
            .cone
            .map_or(1.0, |cone| cone.share((at_m - center_m).normalize()));
        let sin2 = (radius_m / center_m.distance(at_m)).powi(2);
        DVec3::from(light.radiance) * share * std::f64::consts::PI * sin2
    };
    let near = |a: DVec3, b: DVec3| a.distance(b) < 1e-6 * b.length();
    // z up: the file's (1, 2, 3) is (1, -3, 2). 683 cd are a watt per steradian.
    let at_m = DVec3::new(1.0, -3.0, 0.0);
    let expected = DVec3::new(1.0, 0.5, 0.25) / 4.0;
    assert!(near(irradiance(bulb, at_m), expected), "{bulb:?}");
    assert!(near(irradiance(spot, DVec3::ZERO), DVec3::splat(2.0 / 4.0)));
    // The fall-off of the extension: squared, linear in the cosine.
    let angle = 0.4_f64;
    let beside = DVec3::new(2.0 * angle.tan(), 0.0, 0.0);
    let share = (angle.cos() - 0.5_f64.cos()) / (0.25_f64.cos() - 0.5_f64.cos());
    let expected = DVec3::splat(2.0 * share * share * (angle.cos() / 2.0).powi(2));
    assert!(near(irradiance(spot, beside), expected), "{spot:?}");
    let outside = DVec3::new(2.0 * 0.51_f64.tan(), 0.0, 0.0);
    assert_eq!(irradiance(spot, outside), DVec3::ZERO);
    let expected = DVec3::splat(3.0);
    assert!(near(irradiance(sun, DVec3::ZERO), expected), "{sun:?}");
    assert!(sun.bounding_sphere().0.normalize().distance(DVec3::Z) < 1e-6);
    // A studio is given to what comes without, and a ground to either.
    let plain = dir.path().join("plain.glb");
    std::fs::write(&plain, plain_cube()).unwrap();
    let lamps = Description::for_model(&plain).unwrap().lights;
    let names: Vec<_> = lamps
        .iter()
        .filter_map(|lamp| lamp.name.as_deref())
        .collect();
    assert_eq!(names, ["lamp", "lamp 2", "strip left", "strip right"]);
    let mut objects = scene.objects.iter().map(|object| &*object.name);
    assert_eq!(objects.next_back(), Some("ground"));
    // A light that is not there.
    let wrong = nodes.join(",").replace(r#"{"light":2}"#, r#"{"light":7}"#);
    std::fs::write(&path, cube_glb("", &wrong, &mut glb)).unwrap();
    let error = Description::for_model(&path).unwrap_err();
    assert_eq!(error.found(), "its node 3 has the light 7, of 3");
}

#[test]
fn a_camera_of_a_file_is_seen_by() {
    let more = r#","cameras":[
        {"name":"eye","type":"perspective","perspective":{"yfov":0.5,"znear":0.1}},
        {"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0.1,"zfar":9}}]"#;
    let mut glb = Glb {
        more: more.into(),
        ..Glb::default()
    };
    // Above the cube, looking down at it by 30 degrees.
    let (sin, cos) = 15f64.to_radians().sin_cos();
    let nodes = format!(
        r#"{{"mesh":0,"children":[1,2]}},{{"camera":0,"translation":[0,1,2],"rotation":[{},0,0,{cos}]}},{{"name":"plan","camera":1}}"#,
        -sin
    );
    let bytes = cube_glb("", &nodes, &mut glb);
    let dir = temporary_dir();
    let path = dir.path().join("seen.glb");
    std::fs::write(&path, &bytes).unwrap();
    let mut description = Description::for_model(&path).unwrap();
    description.see_by("eye", dir.path()).unwrap();
    description.check().unwrap();
    let camera = &description.camera;
    // z up: the file's (x, y, z) is (x, -z, y).
    let (position, target) = (DVec3::from(camera.position_m), DVec3::from(camera.target_m));
    assert!(position.distance(DVec3::new(0.0, -2.0, 1.0)) < 1e-12);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let forward = (target - position).normalize();
    assert!(
        forward.distance(DVec3::new(0.0, cos, -sin)) < 1e-6,
        "{forward}"
    );
    assert!((camera.fov_y_deg - 0.5_f64.to_degrees()).abs() < 1e-5);
    assert_eq!(camera.up, [0.0, 0.0, 1.0]);
    // The camera can be selected by its number, too.
    let by_name = description.camera.clone();
    description.see_by("0", dir.path()).unwrap();
    assert_eq!(description.camera, by_name);
    assert_eq!(description.file_cameras(dir.path()), ["eye"]);
    // A scene file says the same.
    let whole = description.to_toml().unwrap();
    let (_, rest) = whole.split_once("[render]").unwrap();
    let text = format!("[camera]\nof_file = \"eye\"\nup = [0, 0, 1]\n[render]{rest}");
    let read = Description::from_toml(&text, Path::new("test.toml")).unwrap();
    assert_eq!(read.camera.of_file.as_deref(), Some("eye"));
    let again = Description::from_toml(&read.to_toml().unwrap(), Path::new("test.toml")).unwrap();
    assert_eq!(again, read);
    let scene = hairline_document::build(&read, dir.path()).unwrap();
    assert!(scene.camera.position_m.distance(position) < 1e-12);
    let wrong = text.replace("\"eye\"", "\"nose\"");
    let wrong = Description::from_toml(&wrong, Path::new("test.toml")).unwrap();
    let error = hairline_document::build(&wrong, dir.path())
        .unwrap_err()
        .to_string();
    assert!(error.contains("its cameras are eye, plan"), "{error}");
    let mut error = |wanted: &str| description.see_by(wanted, dir.path()).unwrap_err();
    assert_eq!(error("nose").right(), "its cameras are eye, plan");
    assert!(
        error("plan")
            .found()
            .ends_with("its camera \"plan\" is orthographic")
    );
}
