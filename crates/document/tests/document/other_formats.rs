//! Models of OBJ and STL files.

use std::fmt::Write;
use std::path::Path;

use crate::common::{png, scene_with, temporary_dir};
use glam::{DVec3, Vec3, vec3};
use hairline_document::description::Description;
use hairline_document::export::Export;
use hairline_document::{Loader, build, probe};
use hairline_scene::{Base, Scene};

/// The triangles of a box of 20 x 10 x 4, its corner at the origin, z up.
fn box_triangles() -> Vec<[Vec3; 3]> {
    let size = vec3(20.0, 10.0, 4.0);
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        for (side, flip) in [(0.0, true), (1.0, false)] {
            let corner = |a: f32, b: f32| {
                let mut at = Vec3::ZERO;
                (at[axis], at[u], at[v]) = (side * size[axis], a * size[u], b * size[v]);
                at
            };
            let quad = [
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(1.0, 1.0),
                corner(0.0, 1.0),
            ];
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                triangles.push(if flip {
                    [quad[a], quad[c], quad[b]]
                } else {
                    [quad[a], quad[b], quad[c]]
                });
            }
        }
    }
    triangles
}

fn binary_stl(triangles: &[[Vec3; 3]]) -> Vec<u8> {
    // Headers may begin like a text.
    let mut bytes = b"solid by some program".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(
            triangle
                .iter()
                .flat_map(|p| p.to_array())
                .flat_map(f32::to_le_bytes),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

fn text_stl(triangles: &[[Vec3; 3]]) -> String {
    let mut text = "solid\n".to_owned();
    for triangle in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for p in triangle {
            writeln!(text, "vertex {} {} {}", p.x, p.y, p.z).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid\n"
}

/// A scene of one model with materials of its own.
fn described(file: &str) -> Description {
    let text = scene_with(&format!("[[object]]\nname = \"it\"\nmesh = \"{file}\"\n"));
    Description::from_toml(&text, Path::new("s.toml")).unwrap()
}

fn scene(folder: &Path, file: &str) -> Scene {
    build(&described(file), folder).unwrap()
}

#[test]
fn an_stl_file_is_in_millimetres_and_stands_upright() {
    let dir = temporary_dir();
    let triangles = box_triangles();
    std::fs::write(dir.path().join("b.stl"), binary_stl(&triangles)).unwrap();
    std::fs::write(dir.path().join("t.STL"), text_stl(&triangles)).unwrap();
    let [binary, text] = ["b.stl", "t.STL"].map(|file| scene(dir.path(), file));
    let mesh = &binary.objects[0].mesh;
    let (low, high) = mesh.bounds_m();
    assert!(
        low.abs_diff_eq(Vec3::ZERO, 1e-7) && high.abs_diff_eq(vec3(0.02, 0.01, 0.004), 1e-7),
        "{low} {high}"
    );
    assert_eq!(mesh.triangles.len(), 12);
    assert_eq!(mesh.positions_m, text.objects[0].mesh.positions_m);
    // Its edges are edges, and normals point outwards.
    let middle = 0.5 * (low + high);
    for (position, normal) in mesh.positions_m.iter().zip(&mesh.normals) {
        assert!(normal.abs().max_element() > 0.9999 && normal.dot(*position - middle) > 0.0);
    }
    let notes = binary.notes.join("\n");
    assert!(
        notes.contains("b.stl") && notes.contains("millimetres"),
        "{notes}"
    );
    assert!(matches!(
        binary.materials.last().unwrap().base,
        Base::MetallicRoughness { metallic: 1.0, .. }
    ));
}

/// A ball without normals, of triangles that bend by less than 30 degrees.
fn ball_obj() -> String {
    let (rings, sides) = (24, 32);
    let mut text = "mtllib ball.mtl\no ball\nusemtl paint\n".to_owned();
    for ring in 0..=rings {
        let polar = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        for side in 0..sides {
            let turn = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
            let [x, z] = [turn.sin(), turn.cos()].map(|it| it * polar.sin());
            writeln!(
                text,
                "v {x:.6} {:.6} {z:.6}\nvt {} {}",
                polar.cos(),
                f64::from(side) / f64::from(sides),
                0.25
            )
            .unwrap();
        }
    }
    for ring in 0..rings {
        for side in 0..sides {
            let v = |r: i32, s: i32| r * sides + s % sides + 1;
            let corners = [
                v(ring, side),
                v(ring + 1, side),
                v(ring + 1, side + 1),
                v(ring, side + 1),
            ];
            let words = corners.map(|v| format!("{v}/{v}"));
            writeln!(text, "f {}", words.join(" ")).unwrap();
        }
    }
    text
}

#[test]
fn an_obj_file_has_its_materials_and_smooth_normals() {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("ball.obj"), ball_obj()).unwrap();
    let mtl = "newmtl paint\nKd 0.2 0.3 0.4\nPm 1\nPr 0.25\nd 0.5\nmap_Kd -s 1 1 1 maps\\red.png\n";
    std::fs::write(dir.path().join("ball.mtl"), mtl).unwrap();
    std::fs::create_dir(dir.path().join("maps")).unwrap();
    std::fs::write(
        dir.path().join("maps/red.png"),
        png([1, 1], [255, 0, 0, 255]),
    )
    .unwrap();
    let scene = scene(dir.path(), "ball.obj");
    let mesh = &scene.objects[0].mesh;
    for (position, normal) in mesh.positions_m.iter().zip(&mesh.normals) {
        let off = normal
            .as_dvec3()
            .angle_between(position.as_dvec3().normalize());
        assert!(off < 0.06, "{off} {position}");
    }
    assert!(mesh.uvs.iter().all(|uv| uv.y == 0.75));
    assert_eq!(scene.objects[0].parts[0].nodes[0], "ball");
    let material = scene
        .materials
        .iter()
        .find(|it| it.name == "paint")
        .unwrap();
    assert!(matches!(
        material.base,
        Base::MetallicRoughness { metallic: 1.0, .. }
    ));
    assert!((material.roughness - 0.25).abs() < 1e-6);
    assert_eq!(scene.textures.len(), 1);
    let notes = scene.notes.join("\n");
    assert!(
        notes.contains("metres") && notes.contains("d of its material paint left out"),
        "{notes}"
    );
    let files: Vec<_> = described("ball.obj")
        .inputs(dir.path())
        .into_iter()
        .map(|it| it.path)
        .collect();
    for name in ["ball.obj", "ball.mtl", "maps/red.png"] {
        assert!(files.contains(&dir.path().join(name)), "{name} {files:?}");
    }
    // Materials that are not there are told, and a metal takes their place.
    std::fs::remove_file(dir.path().join("ball.mtl")).unwrap();
    let bare = self::scene(dir.path(), "ball.obj");
    assert!(
        bare.notes.join("").contains("\"ball.mtl\", cannot be read"),
        "{:?}",
        bare.notes
    );
    assert_eq!(bare.materials.last().unwrap().name, "metal");
}

/// The model goes into the file of an export, and comes out as it was.
#[test]
fn an_obj_file_is_exported_as_gltf() {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("ball.obj"), ball_obj()).unwrap();
    let before = scene(dir.path(), "ball.obj");
    let exported = Loader::default()
        .export(&described("ball.obj"), dir.path(), Export::default())
        .unwrap();
    let path = dir.path().join("worn.glb");
    std::fs::write(&path, exported.bytes).unwrap();
    std::fs::remove_file(dir.path().join("ball.obj")).unwrap();
    let after =
        hairline_document::build(&Description::for_model(&path).unwrap(), dir.path()).unwrap();
    assert_eq!(
        before.objects[0].mesh.positions_m,
        after.objects[0].mesh.positions_m
    );
    assert_eq!(
        before.objects[0].mesh.normals,
        after.objects[0].mesh.normals
    );
}

#[test]
fn what_is_cut_off_or_broken_is_told() {
    let dir = temporary_dir();
    let path = |ending: &str| dir.path().join(format!("a.{ending}"));
    let error_of = |ending: &str, bytes: &[u8]| {
        std::fs::write(path(ending), bytes).unwrap();
        probe::mesh(path(ending)).map_err(|error| error.to_string())
    };
    let triangles = box_triangles();
    let (binary, text) = (binary_stl(&triangles), text_stl(&triangles));
    for (ending, bytes, message) in [
        (
            "stl",
            &binary[..300],
            "it is cut off, or no STL: 300 of 684 bytes are there; must be a whole STL file, binary or text",
        ),
        (
            "stl",
            &text.as_bytes()[..200],
            "it is cut off: it ends in line",
        ),
        ("stl", b"", "it is empty"),
        ("stl", b"<html>", "it has 6 bytes"),
        (
            "stl",
            b"solid a\nfacet normal 0 0 0\nouter loop\nvertex 1 2\nendsolid",
            "line 4: vertex: it has 2 of 3 numbers",
        ),
        (
            "stl",
            b"solid a\nfacet normal 0 0 0\nouter loop\nvertex 1 nan 2\nendsolid",
            "line 4: vertex: \"nan\" is no finite number",
        ),
        (
            "stl",
            b"solid a\nfacet normal 0 0 0\nendsolid",
            "it is no valid STL",
        ),
        (
            "obj",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 3\n",
            "line 4: vertex 9; there are 3; must be a whole OBJ file",
        ),
        (
            "obj",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -4\n",
            "line 4: vertex -4; there are 3",
        ),
        (
            "obj",
            b"v 0 0 0\nv 1 0 zero\n",
            "line 2: v: \"zero\" is no finite number",
        ),
        ("obj", b"v 0 0 0\nv 1 1e99 0\n", "line 2: v: \"1e99\" is no"),
        ("obj", b"v 0 0 0\nf 1 1 ?\n", "in line 2 or before"),
        (
            "step",
            b"",
            "it is a model of another format; export it as .glb",
        ),
        ("obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "it has no triangles"),
        ("obj", b"\xff\xfe", "it has no triangles"),
    ] {
        let error = error_of(ending, bytes).unwrap_err();
        assert!(
            error.contains(&format!("a.{ending}")) && error.contains(message),
            "{error}"
        );
    }
    for end in 0..text.len() - 10 {
        assert!(error_of("stl", &text.as_bytes()[..end]).is_err(), "{end}");
    }
    for end in 0..binary.len() {
        assert!(error_of("stl", &binary[..end]).is_err(), "{end}");
    }
    let obj = ball_obj();
    for end in (0..obj.len()).step_by(97) {
        let _ = error_of("obj", &obj.as_bytes()[..end]);
    }
    let size = DVec3::splat(1.0);
    assert_eq!(
        error_of("obj", obj.as_bytes())
            .unwrap()
            .bounds_m
            .1
            .as_dvec3(),
        size
    );
}

const TRIANGLE: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\n";

/// Notes on a model file, or what is wrong with it, with a file of materials beside it.
fn notes_of(obj: &str, mtl: &str) -> Result<String, String> {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("a.obj"), obj).unwrap();
    std::fs::write(dir.path().join("a.mtl"), mtl).unwrap();
    let built = build(&described("a.obj"), dir.path());
    built
        .map(|scene| scene.notes.join("\n"))
        .map_err(|error| error.to_string())
}

#[test]
fn what_a_material_lacks_is_told_by_its_line() {
    let face = TRIANGLE.to_owned() + "f 1 2 3\n";
    let missing = "newmtl paint\nKd 1 0 0\nmap_Kd wood.png\nnorm C:\\bumps.png\n";
    let notes = notes_of(&face, missing).unwrap();
    assert!(
        notes.contains("a.mtl:3: its map_Kd, ") && notes.contains("wood.png\", cannot be read"),
        "{notes}"
    );
    assert!(notes.contains("a.mtl:4: its norm is at"), "{notes}");
    for (mtl, message) in [
        (
            "newmtl paint\nKd hello 1\n",
            "a.mtl:2: Kd: found \"hello 1\"; must be 3 numbers",
        ),
        ("newmtl paint\nKd 1 1\n", "a.mtl:2: Kd: found \"1 1\""),
        ("newmtl\n", "a.mtl:1: newmtl: found \"\"; must be a name"),
    ] {
        let error = notes_of(&face, mtl).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn what_an_obj_file_has_in_vain_is_told() {
    let obj = TRIANGLE.to_owned() + "f 1 2\nusemtl nope\nf 1 2 3\n";
    let notes = notes_of(&obj, "newmtl paint\n").unwrap();
    for note in [
        "line 6: a face of fewer than 3 corners left out (1 in all)",
        "line 7: usemtl nope: no .mtl file has it",
    ] {
        assert!(notes.contains(note), "{notes}");
    }
}

#[test]
fn a_model_that_is_metal_for_a_smaller_part_says_why_it_has_no_wear() {
    let dir = temporary_dir();
    let path = dir.path().join("a.obj");
    let faces = "f 1 2 3\nusemtl gold\nf 1 3 2\n";
    std::fs::write(&path, TRIANGLE.to_owned() + faces).unwrap();
    let mtl = "newmtl paint\nnewmtl gold\nPm 1\n";
    std::fs::write(dir.path().join("a.mtl"), mtl).unwrap();
    let scene = Description::for_model(&path).unwrap();
    assert!(scene.scratches.is_empty());
    let notes = scene.notes.join("\n");
    assert!(notes.contains("no wear is laid on it"), "{notes}");
}
