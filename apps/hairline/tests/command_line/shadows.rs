//! `render --shadows on`: refusals, and that it reaches the picture.

#[cfg(unix)]
use std::path::Path;
#[cfg(unix)]
use std::time::Duration;

use crate::common::{folder_with, hairline, stderr_of};
use hairline_image::exr_file;

/// A disk under a lamp, and a smaller disk between them.
const SCREENED: &str = r#"
[camera]
position_m = [0.0, -0.3, 0.3]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 20.0

[render]
size_px = [32, 24]

[[material]]
name = "steel"
kind = "metal"
metal = "steel"
roughness = 0.4

[[object]]
name = "table"
material = "steel"
shape = { disk = { radius_m = 0.1 } }

[[object]]
name = "screen"
material = "steel"
shape = { disk = { radius_m = 0.02 } }
translation_m = [0.0, 0.1, 0.1]

[[light]]
kind = "sphere"
center_m = [0.0, 0.3, 0.3]
radius_m = 0.01
radiance = 50.0
"#;

#[test]
fn what_has_no_shadows_refuses_them() {
    let folder = folder_with("screened.toml", SCREENED);
    let arguments = "render screened.toml -o out.exr --shadows on --method published";
    let text = stderr_of(&hairline(folder.path(), arguments).code(2));
    let message = "the published method has no shadows";
    assert!(text.contains(message), "{text}");
    assert!(!folder.path().join("out.exr").exists());
}

#[test]
fn a_picture_of_nothing_says_so() {
    let away = SCREENED.replace("target_m = [0.0, 0.0, 0.0]", "target_m = [0.0, -0.6, 0.6]");
    let dark = SCREENED.replace("radiance = 50.0", "radiance = 0.0");
    for (scene, note) in [
        (away, "no object is in the picture"),
        (dark, "the picture is black"),
    ] {
        let folder = folder_with("nothing.toml", &scene);
        let arguments = "render nothing.toml -o out.exr --backend cpu";
        let text = stderr_of(&hairline(folder.path(), arguments).code(0));
        assert!(text.contains(note), "{text}");
    }
    let folder = folder_with("screened.toml", SCREENED);
    let text = stderr_of(
        &hairline(
            folder.path(),
            "render screened.toml -o out.exr --backend cpu",
        )
        .code(0),
    );
    assert!(!text.contains("note:"), "{text}");
}

#[test]
fn bounces_ask_for_shadows() {
    let folder = folder_with("screened.toml", SCREENED);
    let arguments = "render screened.toml -o out.exr --shadows off --bounces 1";
    let text = stderr_of(&hairline(folder.path(), arguments).code(2));
    assert!(text.contains("add --shadows on"), "{text}");
    assert!(!folder.path().join("out.exr").exists());
}

#[test]
fn the_screen_lights_the_table_from_below() {
    let folder = folder_with("screened.toml", SCREENED);
    let file = folder.path().join("out.exr");
    let is_there = hairline_gpu::headless::test_gpu().is_some();
    for backend in ["cpu", "gpu"].into_iter().take(1 + usize::from(is_there)) {
        // Light goes from the table to the screen's dark side, and from there to the table where the lamp
        // is hidden.
        let [dark, lit] = [0, 2].map(|bounces| {
            let flags =
                format!("--shadows on --samples 64 --bounces {bounces} --backend {backend}");
            hairline(
                folder.path(),
                &format!("render screened.toml -o out.exr {flags}"),
            )
            .success();
            let (image, notes) = exr_file::read_image_with_notes(&file).unwrap();
            assert_eq!(
                notes.get("bounces").map(String::as_str),
                (bounces > 0).then_some("2")
            );
            image.base
        });
        let most = dark.iter().fold(0.0f32, |most, p| most.max(p[1]));
        let hidden = (0..dark.len()).filter(|&i| dark[i][1] < 0.02 * most);
        let sums = hidden.fold([0.0, 0.0], |[a, b], i| [a + dark[i][1], b + lit[i][1]]);
        assert!(sums[1] > sums[0], "{backend}: {sums:?}");
    }
}

#[test]
fn shadows_darken_the_middle_and_are_noted() {
    let folder = folder_with("screened.toml", SCREENED);
    let file = folder.path().join("out.exr");
    // The GPU's where there is a driver.
    let is_there = hairline_gpu::headless::test_gpu().is_some();
    for backend in ["cpu", "gpu"].into_iter().take(1 + usize::from(is_there)) {
        let mut middle = Vec::new();
        for (switch, note) in [("off", None), ("on", Some("on"))] {
            let arguments =
                format!("render screened.toml -o out.exr --shadows {switch} --backend {backend}");
            hairline(folder.path(), &arguments).success();
            let (image, notes) = exr_file::read_image_with_notes(&file).unwrap();
            assert_eq!(notes.get("shadows").map(String::as_str), note);
            middle.push(image.base[image.index(16, 12)][1]);
        }
        assert!(
            middle[0] > 0.0 && middle[1] < 0.1 * middle[0],
            "{backend}: {middle:?}"
        );
    }
}

#[test]
fn shadows_hold_their_variance_and_closed_forms_have_none() {
    let folder = folder_with("screened.toml", SCREENED);
    let file = folder.path().join("out.exr");
    let render = |flags: &str| {
        let arguments = format!("render screened.toml -o out.exr --backend cpu {flags}");
        hairline(folder.path(), &arguments).success();
        exr_file::read_image_with_notes(&file).unwrap()
    };
    let (image, notes) = render("--shadows on --samples 14");
    let noise = image.noise.unwrap();
    assert!(noise.samples.iter().all(|&samples| samples == 14));
    let uncertain = noise.base.iter().filter(|v| v[1] > 0.0).count();
    let certain = noise.base.iter().filter(|v| v[1] == 0.0).count();
    assert!(uncertain > 50 && certain > 50, "{uncertain} {certain}");
    assert_eq!(notes.get("samples"), None, "all of them are there");
    assert_eq!(render("--shadows off --bounces 0").0.noise, None);
}

/// Starts a command, and interrupts it so long after its first message. Returns its exit code and its further messages.
#[cfg(unix)]
fn interrupted(folder: &Path, arguments: &str, after: Duration) -> (Option<i32>, String) {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};

    let mut child = Command::new(env!("CARGO_BIN_EXE_hairline"))
        .current_dir(folder)
        .args(arguments.split(' '))
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    stderr.read_line(&mut String::new()).unwrap();
    std::thread::sleep(after);
    let id = child.id().to_string();
    let killed = Command::new("kill").args(["-INT", &id]).status();
    assert!(killed.unwrap().success());
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).unwrap();
    (child.wait().unwrap().code(), rest)
}

#[cfg(unix)]
#[test]
fn an_interrupt_is_heard_while_scratches_are_sorted() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = "render --backend cpu --size 64x36 --samples 1024";
    let (code, messages) = interrupted(folder.path(), arguments, Duration::ZERO);
    assert!(
        code == Some(1) && messages.contains("interrupted before the first samples"),
        "{code:?} {messages}"
    );
}

#[cfg(unix)]
#[test]
fn an_interrupted_picture_has_the_samples_that_are_done() {
    let folder = folder_with("screened.toml", SCREENED);
    let flags = "--backend cpu --shadows on --samples 1024 --size 160x120";
    let arguments = format!("render screened.toml -o out.exr {flags}");
    let (code, rest) = interrupted(folder.path(), &arguments, Duration::from_millis(1500));
    assert_eq!(code, Some(0), "{rest}");
    let (image, notes) = exr_file::read_image_with_notes(&folder.path().join("out.exr")).unwrap();
    let samples = image.noise.unwrap().samples[0];
    assert!(
        (4..1024).contains(&samples) && samples % 4 == 0,
        "{samples}"
    );
    let so_far = format!("{samples} of 1024");
    assert_eq!(notes.get("samples"), Some(&so_far));
    assert!(
        rest.contains(&format!("interrupted: out.exr has {so_far} samples")),
        "{rest}"
    );
}
