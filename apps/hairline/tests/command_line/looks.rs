//! `hairline render --looks`: a picture of each look.

use crate::common::{folder_with, hairline, names_in, stderr_of};
use hairline_fixtures::scenes::bare_plate;
use hairline_image::exr_file;

fn scene(looks: &str) -> String {
    let plate = bare_plate().size_px([32, 18]);
    let lit = plate.sphere([0.06, 0.10, 0.25], 0.01, 40.0);
    lit.part(looks).to_string()
}

#[test]
fn each_look_has_a_picture_of_its_name() {
    let looks = "[[look]]\nname = \"as it is\"\n\
                 [[look]]\nname = \"a/b\"\nexposure_ev = 3\n\
                 [[look]]\nname = \"studio\"\n[look.studio]\n";
    let folder = folder_with("s.toml", &scene(looks));
    let render = |flags: &str| {
        hairline(
            folder.path(),
            &format!("render s.toml --backend cpu {flags}"),
        )
    };
    render("-o still.exr").success();
    render("-o out.exr --looks").success();
    render("-o out.png --looks").success();
    let mut names = names_in(folder.path());
    names.retain(|name| name.starts_with("out"));
    assert_eq!(
        names,
        [
            "out-a-b.exr",
            "out-a-b.png",
            "out-as it is.exr",
            "out-as it is.png",
            "out-studio.exr",
            "out-studio.png"
        ]
    );
    let read = |name: &str| exr_file::read_image(&folder.path().join(name)).unwrap();
    let still = read("still.exr");
    assert_eq!(read("out-as it is.exr"), still);
    // An exposure is of the display alone.
    assert_eq!(read("out-a-b.exr"), still);
    assert_ne!(read("out-studio.exr").base, still.base);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_ne!(bytes("out-a-b.png"), bytes("out-as it is.png"));
}

#[test]
fn looks_that_have_no_files_are_refused() {
    let folder = folder_with("s.toml", &scene(""));
    let refused = |flags: &str| {
        let assert = hairline(folder.path(), &format!("render s.toml {flags}"));
        stderr_of(&assert.code(2))
    };
    let message = refused("--looks");
    assert!(message.contains("s.toml has no `[[look]]`"), "{message}");
    let alike = scene("[[look]]\nname = \"a/b\"\n[[look]]\nname = \"A-B\"\n");
    std::fs::write(folder.path().join("s.toml"), alike).unwrap();
    let message = refused("--looks");
    assert!(message.contains("\"a/b\" and \"A-B\""), "{message}");
    let message = refused("--looks --frames 2 --turntable 90");
    assert!(message.contains("--frames"), "{message}");
    assert_eq!(names_in(folder.path()), ["s.toml"]);
}

#[test]
fn what_a_look_lacks_is_told_before_any_is_rendered() {
    let looks =
        "[[look]]\nname = \"a\"\n[[look]]\nname = \"b\"\n[look.environment]\nfile = \"no.hdr\"\n";
    let text = scene(looks);
    let line = 1 + text.lines().position(|it| it.contains("no.hdr")).unwrap();
    let folder = folder_with("s.toml", &text);
    let refused = |flags: &str| {
        let assert = hairline(folder.path(), &format!("render s.toml {flags}"));
        stderr_of(&assert.code(2))
    };
    let message = refused("--looks");
    let place = format!("s.toml:{line}: look[1].environment.file: ");
    assert!(message.contains(&place), "{message}");
    let message = refused("--looks --exposure 5");
    assert!(
        message.contains("would give all looks one exposure"),
        "{message}"
    );
    assert_eq!(names_in(folder.path()), ["s.toml"]);
}
