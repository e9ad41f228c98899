//! `render --labels`: which scratches each pixel shows, in a file of its own.

use std::fs;

use crate::common::{folder_with, hairline, stderr_of};
use hairline_fixtures::scenes::bare_plate;

#[test]
fn labels_go_to_no_file_that_has_another_use() {
    let folder = folder_with("s.toml", &bare_plate().to_string());
    let path = folder.path();
    let render = "render s.toml --backend cpu --size 16x8 --samples 1 --shadows off";
    for (output, labels) in [("a.exr", "a.exr"), ("a.exr", "./a.exr")] {
        let told = stderr_of(
            &hairline(path, &format!("{render} -o {output} --labels {labels}")).failure(),
        );
        assert!(told.contains("-o names the same file"), "{told}");
        assert!(!path.join("a.exr").exists());
    }
    // A map that the scene reads stays as it is.
    hairline(path, &format!("{render} -o sky.exr")).success();
    let sky = fs::read(path.join("sky.exr")).unwrap();
    let lit = format!("{}\n[environment]\nfile = \"sky.exr\"\n", bare_plate());
    fs::write(path.join("lit.toml"), lit).unwrap();
    let render = render.replace("s.toml", "lit.toml");
    let told = stderr_of(&hairline(path, &format!("{render} -o b.png --labels sky.exr")).failure());
    assert!(told.contains("would be overwritten"), "{told}");
    assert!(fs::read(path.join("sky.exr")).unwrap() == sky);
    hairline(path, &format!("{render} -o b.png --labels b.exr")).success();
    assert!(path.join("b.exr").exists());
}
