//! Files are looked at before a scene names them: errors are as clear as when a scene is loaded.

use crate::common::{self, Glb, cube, temporary_dir};
use hairline_document::probe;
use hairline_image::{Display, FilePath, Output, Picture};

/// The message about a file of these bytes, without the folder.
fn message<T>(
    name: &str,
    bytes: &[u8],
    look: impl Fn(FilePath) -> Result<T, hairline_document::Error>,
) -> String {
    let dir = temporary_dir();
    let path = dir.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let Err(error) = look(FilePath::from(&path)) else {
        return "it can be used".to_owned();
    };
    assert_eq!(error.file(), Some(path.as_path()));
    let folder = format!("{}/", dir.path().display());
    error.to_string().replace(&folder, "")
}

fn cube_glb() -> Vec<u8> {
    let (corners, triangles) = cube();
    let mut glb = Glb::default();
    let (positions, indices) = (glb.floats(&corners), glb.indices(&triangles));
    let primitive =
        format!(r#"{{"attributes":{{"POSITION":{positions}}},"indices":{indices},"material":0}}"#);
    glb.more = r#","materials":[{"name":"lacquer"}]"#.to_owned();
    glb.bytes(
        &format!(r#"{{"primitives":[{primitive}]}}"#),
        r#"{"mesh":0,"translation":[1,0,0]}"#,
    )
}

#[test]
fn a_mesh_tells_what_it_holds() {
    let dir = temporary_dir();
    let path = dir.path().join("cube.glb");
    std::fs::write(&path, cube_glb()).unwrap();
    let summary = probe::mesh(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(summary.triangles, 12);
    assert_eq!(
        summary.bounds_m,
        (
            glam::Vec3::new(0.5, -0.5, -0.5),
            glam::Vec3::new(1.5, 0.5, 0.5)
        )
    );
    assert_eq!(summary.materials, ["lacquer"]);
}

#[test]
fn wrong_meshes_say_what_is_wrong() {
    let whole = cube_glb();
    for (bytes, expected) in [
        (
            &b"Dear all,\nthis is no model.\n"[..],
            "a.glb: it is neither binary nor text glTF; must be a whole glTF 2.0 file, text (.gltf) or binary (.glb)",
        ),
        (
            &whole[..whole.len() / 2],
            "a.glb: it is cut off: 370 of 740 bytes are there; must be a whole glTF 2.0 file, text (.gltf) or binary (.glb)",
        ),
        (
            &[],
            "a.glb: it is empty; must be a whole glTF 2.0 file, text (.gltf) or binary (.glb)",
        ),
        (
            br#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]}"#,
            "a.glb: it has no surface; must have triangles that span an area",
        ),
    ] {
        assert_eq!(message("a.glb", bytes, probe::mesh), expected);
    }
    let error = probe::mesh(std::path::Path::new("gone.glb")).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("gone.glb: it cannot be read ("),
        "{error}"
    );
}

/// 8 x 4 pixels, each of its own colour, so that nothing can be packed away.
fn radiance_file() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n".to_vec();
    bytes.extend((0..32u8).flat_map(|i| [i + 1, 2 * i, 3 * i, 128]));
    bytes
}

fn exr_bytes() -> Vec<u8> {
    let dir = temporary_dir();
    let path = dir.path().join("map.exr");
    let picture = Picture {
        size_px: [8, 4],
        rgb: (0..32).map(|i| [i as f32, 0.1, 0.2]).collect(),
    };
    let file = Output::check(&path).unwrap();
    file.write_picture(&picture, &Display::default()).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn environments_tell_their_size_or_what_is_wrong() {
    let right = "must be an equirectangular .hdr or .exr";
    for (ending, whole) in [("hdr", radiance_file()), ("exr", exr_bytes())] {
        let dir = temporary_dir();
        let path = dir.path().join(format!("map.{ending}"));
        std::fs::write(&path, &whole).unwrap();
        let summary = probe::environment(&path).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(summary.size_px, [8, 4]);

        let name = format!("map.{ending}");
        for missing in [1, 40, 100] {
            let cut = &whole[..whole.len() - missing];
            assert_eq!(
                message(&name, cut, probe::environment),
                format!("{name}: the file is truncated: it ends before the last pixel; {right}")
            );
        }
        let text = message(&name, b"no picture", probe::environment);
        assert!(
            text.starts_with(&format!("{name}: ")) && text.ends_with(right),
            "{text}"
        );
        println!("{text}");
    }
    assert_eq!(
        message("map.png", b"", probe::environment),
        format!(
            "map.png: not an environment map by its name: .hdr (Radiance) and .exr (OpenEXR) can be read; {right}"
        )
    );
}

#[test]
fn scenes_are_read_and_checked_but_not_built() {
    let text = common::scene_with(&common::object("{ disk = { radius_m = 0.1 } }"));
    assert_eq!(
        message("a.toml", text.as_bytes(), probe::scene),
        "it can be used"
    );
    let wrong = text.replace("material = \"steel\"", "material = \"stel\"");
    assert_eq!(
        message("a.toml", wrong.as_bytes(), probe::scene),
        "a.toml:14: object[0].material: found no material called \"stel\"; did you mean \"steel\"?"
    );
    assert_eq!(
        message("a.toml", &[0xff, 0xfe, 0], probe::scene),
        "a.toml: it is no text; must be a scene file (TOML)"
    );
}
