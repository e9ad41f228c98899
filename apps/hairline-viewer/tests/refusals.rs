//! The viewer without what it needs, and with what it cannot show: one sentence.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use hairline_fixtures::scenes::bare_plate;

/// What it says on stderr where there is no display, and ends with this code.
fn said(folder: &Path, argument: &str, code: i32) -> String {
    let mut viewer = Command::cargo_bin("hairline-viewer").unwrap();
    viewer.current_dir(folder).arg(argument);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        viewer.env_remove(name);
    }
    let output = viewer.assert().code(code).get_output().stderr.clone();
    String::from_utf8(output).unwrap()
}

#[test]
#[cfg(target_os = "linux")]
fn what_is_missing_is_told_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), bare_plate().to_string()).unwrap();
    let text = said(folder.path(), "s.toml", 1);
    assert!(
        text.contains("there is no display") && text.contains("hairline render"),
        "{text}"
    );
    assert!(
        !text.contains(".rs") && !text.contains("{}") && text.lines().count() == 1,
        "{text}"
    );
    // Errors of the scene come first.
    let wrong = bare_plate().part("[lamp]\n").to_string();
    let line = 1 + wrong.lines().position(|line| line == "[lamp]").unwrap();
    fs::write(folder.path().join("wrong.toml"), wrong).unwrap();
    let text = said(folder.path(), "wrong.toml", 1);
    let expected = format!("wrong.toml:{line}: lamp: unknown key");
    assert!(text.contains(&expected), "{text}");
}

#[test]
fn what_it_cannot_open_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (argument, message) in [
        (
            "picture.png",
            "it is a picture; give a scene (.toml) or a model (.glb, .gltf, .obj, .stl)",
        ),
        ("map.hdr", "an environment map"),
        ("-", "needs a file"),
    ] {
        let text = said(folder.path(), argument, 2);
        assert!(text.contains(message), "{argument}: {text}");
    }
}
