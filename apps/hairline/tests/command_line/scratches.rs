//! `hairline scratches`: a list for other programs.

use std::fs;

use crate::common::{folder_with, hairline, stderr_of};
use hairline_fixtures::scenes::bare_plate;
use hairline_fixtures::{DISK, SceneFile};

const LISTED: &str = "[[scratches]]\nobject = \"plate\"\npattern = \"file\"\nfile = \"list.csv\"\n\
                      [[scratches]]\nobject = \"plate\"\npattern = \"random\"\ncount = 3\nlength_m = 0.01\n";

#[test]
fn laid_scratches_are_listed_as_they_lie() {
    let folder = folder_with("s.toml", &bare_plate().part(LISTED).to_string());
    let list =
        "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n-0.04,0.01,0,0.05,0.02,0,4.25,130\n";
    fs::write(folder.path().join("list.csv"), list).unwrap();
    hairline(folder.path(), "scratches s.toml -o all.csv").success();
    hairline(
        folder.path(),
        "scratches s.toml --object plate --layer 0 -o first.csv",
    )
    .success();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let rows = |text: &str| -> Vec<Vec<f64>> {
        let rows = text.lines().skip(1);
        rows.map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect()
    };
    let first = read("first.csv");
    assert!(
        first.starts_with("x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm,scratch,nx,ny,nz\n")
    );
    let pieces = rows(&first);
    // The scratch runs from end to end, in pieces that lie on the plate.
    let (begin, end) = (&pieces[0], &pieces[pieces.len() - 1]);
    for (found, given) in begin[..2]
        .iter()
        .chain(&end[3..5])
        .zip([-0.04, 0.01, 0.05, 0.02])
    {
        assert!((found - given).abs() < 1e-6, "{found} {given}");
    }
    assert!(
        pieces
            .iter()
            .all(|row| row[6..] == [4.25, 130.0, 0.0, 0.0, 0.0, 1.0])
    );
    let numbers = rows(&read("all.csv"))
        .iter()
        .map(|row| row[8])
        .fold(0.0, f64::max);
    assert_eq!(numbers, 3.0, "four scratches in all");

    for (arguments, message) in [
        (
            "scratches s.toml --object plaet -o x.csv",
            "found no object called \"plaet\"; must be one of \"plate\"",
        ),
        (
            "scratches s.toml --layer 7 -o x.csv",
            "found no scratches of layer 7",
        ),
        ("scratches s.toml -o list.csv", "list.csv"),
    ] {
        let text = stderr_of(&hairline(folder.path(), arguments).code(2));
        assert!(text.contains(message), "{arguments}: {text}");
    }
    assert_eq!(read("list.csv"), list, "what the scene is made of stays");
}

/// In the object's own frame a list is what `pattern = "file"` reads.
#[test]
fn a_list_in_the_objects_own_frame_is_laid_again() {
    let object = "[[object]]\nname = \"bowl\"\nmaterial = \"steel\"\nshape = { sphere = { radius_m = 0.03 } }\n\
                  translation_m = [0.1, 0.2, 0.3]\nrotation_deg = [10, 20, 30]\n";
    let layer = |pattern: &str| format!("{object}[[scratches]]\nobject = \"bowl\"\n{pattern}\n");
    let laid = layer("pattern = \"swirl\"\ncount = 20\nlength_m = 0.03");
    let folder = folder_with("s.toml", &bare_plate().part(&laid).to_string());
    hairline(
        folder.path(),
        "scratches s.toml --object bowl --own-frame -o list.csv",
    )
    .success();
    let listed = bare_plate().part(&layer("pattern = \"file\"\nfile = \"list.csv\""));
    fs::write(folder.path().join("again.toml"), listed.to_string()).unwrap();
    hairline(
        folder.path(),
        "scratches again.toml --object bowl --own-frame -o again.csv",
    )
    .success();
    let numbers = |name: &str| {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        let rows = text.lines().skip(1);
        let numbers = rows.map(|row| row.split(',').nth(8).unwrap().parse::<u32>().unwrap());
        numbers.max()
    };
    assert_eq!(numbers("list.csv"), Some(19));
    assert_eq!(numbers("again.csv"), Some(19));
}

/// Light for scratches that shows little of them says so; shallow ones drown in what a rough base sends.
#[test]
fn light_that_hardly_shows_scratches_is_told_of() {
    for (base, depth_nm, is_told) in [
        ("roughness = 0.5", 15, true),
        ("roughness = 0.05", 180, false),
    ] {
        let scene = SceneFile::seen_from([0.0, -0.3, 0.3])
            .metal("m", "steel")
            .with_lines(base)
            .object("plate", "m", DISK)
            .random("plate", 1500)
            .with_lines(&format!(
                "length_m = 0.03\nwidth_um = 4.0\ndepth_nm = {depth_nm}"
            ));
        let folder = folder_with("s.toml", &scene.to_string());
        let run = "render s.toml --show-scratches --backend cpu --size 96x64 --samples 1 --shadows off -o a.png";
        let told = stderr_of(&hairline(folder.path(), run).success());
        assert_eq!(
            told.contains("light for the scratches shows"),
            is_told,
            "{told}"
        );
    }
}
