//! `hairline export`: one file that opens as the same scene.

use std::fs;

use crate::common::{folder_with, hairline, stderr_of, stdout_of};
use hairline_fixtures::scenes::bare_plate;

const WORN: &str =
    "[[scratches]]\nobject = \"plate\"\npattern = \"random\"\ncount = 30\nlength_m = 0.01\n";

#[test]
fn the_picture_of_the_file_is_that_of_the_scene() {
    let folder = folder_with("s.toml", &bare_plate().part(WORN).to_string());
    let path = folder.path();
    let run = |arguments: &str| hairline(path, arguments).success();
    let told = run("export s.toml -o worn.glb");
    assert!(stderr_of(&told).contains("worn.glb: "), "its size is told");
    let render = |scene: &str, output: &str| {
        run(&format!(
            "render {scene} --backend cpu --size 48x32 --samples 1 --shadows off -o {output}"
        ));
        fs::read(path.join(output)).unwrap()
    };
    // In a folder of its own, without the scene.
    fs::create_dir(path.join("elsewhere")).unwrap();
    fs::copy(path.join("worn.glb"), path.join("elsewhere/worn.glb")).unwrap();
    let scene = render("s.toml", "a.png");
    assert!(render("elsewhere/worn.glb", "b.png") == scene);
    let list = |scene: &str, output: &str| {
        run(&format!("scratches {scene} -o {output}"));
        fs::read_to_string(path.join(output)).unwrap()
    };
    assert_eq!(list("s.toml", "a.csv"), list("worn.glb", "b.csv"));
    // Another seed lays others, and with those that lie it is larger.
    run("export s.toml -o other.glb --seed 7 --laid on");
    assert_ne!(list("s.toml", "a.csv"), list("other.glb", "b.csv"));
    let length = |name: &str| path.join(name).metadata().unwrap().len();
    assert!(length("worn.glb") + 44 * 30 < length("other.glb"));
    let told = stdout_of(&run("info worn.glb"));
    assert!(told.contains("plate"), "{told}");
}

/// Wear takes the place of wear, on what the scene is about; the layers that are the scene's own stay.
#[test]
fn wear_is_given_by_a_flag() {
    let folder = folder_with("s.toml", &bare_plate().part(WORN).to_string());
    let layers = |arguments: &str| {
        hairline(folder.path(), &format!("export {arguments}")).success();
        hairline(folder.path(), "scratches worn.glb -o a.csv").success();
        fs::read_to_string(folder.path().join("a.csv"))
            .unwrap()
            .lines()
            .count()
    };
    let [new, used, old] =
        ["new", "used", "Old"].map(|wear| layers(&format!("s.toml -o worn.glb --wear {wear}")));
    assert!(
        30 < new && 10 * new < used && 2 * used < old,
        "{new} {used} {old}"
    );
    let told = hairline(folder.path(), "export s.toml -o worn.glb --wear rusty").failure();
    assert!(stderr_of(&told).contains("Polished"));
}

#[test]
fn wrong_names_are_refused() {
    let folder = folder_with("s.toml", &bare_plate().part(WORN).to_string());
    hairline(folder.path(), "export s.toml -o worn.glb").success();
    for (arguments, message) in [
        (
            "export s.toml -o worn.gltf",
            "--output: found \"worn.gltf\"; must end in .glb or .usdz",
        ),
        (
            "export s.toml -o worn.usdz --laid on",
            "laid: found scratches as they lie; must be off",
        ),
        ("export worn.glb -o worn.glb", "would be overwritten"),
        ("export s.toml -o nowhere/worn.glb", "nowhere"),
        ("export none.toml -o worn.glb", "none.toml"),
    ] {
        let told = stderr_of(&hairline(folder.path(), arguments).failure());
        assert!(told.contains(message), "{arguments}: {told}");
    }
}

#[test]
fn a_file_of_an_unknown_version_is_shown_plain_and_told() {
    let folder = folder_with("s.toml", &bare_plate().part(WORN).to_string());
    let path = folder.path().join("worn.glb");
    hairline(folder.path(), "export s.toml -o worn.glb").success();
    let mut bytes = fs::read(&path).unwrap();
    let at = bytes
        .windows(12)
        .position(|it| it == b"\"version\":1}")
        .unwrap();
    bytes[at + 10] = b'9';
    fs::write(&path, bytes).unwrap();
    let told = hairline(
        folder.path(),
        "render worn.glb --backend cpu --size 16x16 --samples 1 --shadows off -o a.png",
    );
    let told = stderr_of(&told.success());
    let wanted = "worn.glb: extensions.HAIRLINE_scratches.version: found version 9; must be 1";
    assert!(told.contains(wanted), "{told}");
}

#[test]
fn a_file_that_is_mostly_laid_scratches_names_the_flag() {
    let worn = WORN.replace("count = 30", "count = 30000");
    let folder = folder_with("s.toml", &bare_plate().part(&worn).to_string());
    let told = |flags: &str| {
        let run = format!("export s.toml -o worn.glb{flags}");
        stderr_of(&hairline(folder.path(), &run).success())
    };
    assert!(told(" --laid on").contains("of it and more are scratches as they lie"));
    assert!(!told("").contains("--laid"));
}

#[cfg(unix)]
#[test]
fn an_interrupted_export_says_so() {
    use std::process::{Command, Stdio};
    use std::time::Duration;
    let worn = WORN.replace("count = 30", "count = 3000000");
    let folder = folder_with("s.toml", &bare_plate().part(&worn).to_string());
    let child = Command::new(assert_cmd::cargo::cargo_bin("hairline"))
        .current_dir(folder.path())
        .args(["export", "s.toml", "-o", "worn.glb"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(300));
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("interrupted: worn.glb is not written"),
        "{told}"
    );
    assert!(!folder.path().join("worn.glb").exists());
}
