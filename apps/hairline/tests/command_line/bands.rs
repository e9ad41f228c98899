//! `render --bands`: bands of the spectrum in the place of colours.

use std::fs;

use crate::common::{folder_with, hairline, stderr_of};
use hairline_fixtures::scenes::lit_plate;

#[test]
fn bands_are_written_or_refused() {
    let folder = folder_with("s.toml", &lit_plate().to_string());
    let path = folder.path();
    let render = "render s.toml --size 16x8 --samples 1 --shadows off";
    hairline(path, &format!("{render} -o a.exr --bands 400:700:75")).success();
    let written = fs::read(path.join("a.exr")).unwrap();
    let has = |name: &[u8]| written.windows(name.len()).any(|at| at == name);
    assert!(has(b"S0.437,50nm") && has(b"base.S0.662,50nm") && !has(b"S0.737,50nm"));
    for (wrong, message) in [
        ("-o a.png --bands 400:700:100", "--bands needs an .exr"),
        (
            "-o b.exr --bands 400:700:77",
            "fits a whole number of times",
        ),
        ("-o b.exr --bands 300:400:50", "within 380 to 780 nm"),
        ("-o b.exr --bands 400:700:100 --backend gpu", "on the CPU"),
    ] {
        let told = stderr_of(&hairline(path, &format!("{render} {wrong}")).failure());
        assert!(told.contains(message), "{told}");
    }
    assert!(!path.join("b.exr").exists());
}
