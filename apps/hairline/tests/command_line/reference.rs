//! `hairline reference` from outside: its messages, its files, and that stopping costs nothing.

use std::fs;
use std::path::Path;

use crate::common::{SCRATCHED, folder_with, hairline, names_in, stderr_of};
use hairline_image::{Image, Notes, exr_file, png};

fn folder_with_scene() -> tempfile::TempDir {
    folder_with("plate.v2.toml", &SCRATCHED)
}

fn read(folder: &Path, name: &str) -> (Image, Notes) {
    exr_file::read_image_with_notes(&folder.join(name)).unwrap()
}

fn samples(image: &Image) -> &[u32] {
    &image.noise.as_ref().unwrap().samples
}

#[test]
fn it_is_named_after_its_scene_and_says_how_it_was_made() {
    let folder = folder_with_scene();
    let assert = hairline(folder.path(), "reference plate.v2.toml --spp 100").success();
    let text = stderr_of(&assert);
    assert_eq!(
        text.lines().count(),
        1,
        "one line and no bar in a pipe: {text}"
    );
    for part in [
        "separable model",
        "threads",
        "128 samples for each pixel (100 in whole batches of 64)",
        "from the start",
    ] {
        assert!(text.contains(part), "{text}");
    }
    assert_eq!(
        names_in(folder.path()),
        ["plate.v2-reference.exr", "plate.v2.toml"]
    );
    let (image, notes) = read(folder.path(), "plate.v2-reference.exr");
    assert_eq!(image.size_px, [24, 16]);
    assert!(samples(&image).iter().all(|n| *n == 128));
    for (name, value) in [
        ("model", "separable"),
        ("mask", "energy"),
        ("bounces", "0"),
        ("shadows", "off"),
        ("seed", "0"),
    ] {
        assert_eq!(notes[name], value);
    }
    assert_eq!(notes["scene"].len(), 32);
    assert!(notes["version"].starts_with(env!("CARGO_PKG_VERSION")));

    // Lit, scratched, and not equally sure everywhere.
    let noise = image.noise.as_ref().unwrap();
    let middle = image.index(12, 8);
    assert!(image.base[middle][1] > 0.0 && image.depth_m[middle] > 0.3);
    assert!(image.scratches.iter().any(|c| c[1] > 0.0));
    assert!(noise.beauty.iter().any(|v| v[1] > 0.0));
    let floats = image.base.iter().chain(&noise.beauty).flatten();
    assert!(floats.clone().all(|c| c.is_finite()));
}

#[test]
fn flags_reach_the_picture() {
    let folder = folder_with_scene();
    let render = |flags: &str| {
        let arguments = format!("reference plate.v2.toml --spp 64 -o a.exr {flags}");
        hairline(folder.path(), &arguments).success();
        read(folder.path(), "a.exr")
    };
    let (plain, notes) = render("");
    for (flags, note, value) in [
        ("--model full", "model", "full"),
        ("--model full", "mask", "none"),
        ("--mask linear", "mask", "linear"),
        ("--mask density", "mask", "density"),
        ("--shadows on", "shadows", "on"),
        ("--bounces 2", "bounces", "2"),
        ("--sample-seed 7", "seed", "7"),
    ] {
        let (image, noted) = render(flags);
        assert_eq!(noted[note], value, "{flags}");
        assert_eq!(noted["scene"], notes["scene"], "{flags}");
        // One convex object: there is nothing to hide or to bounce to.
        let is_same = flags.contains("shadows") || flags.contains("bounces");
        assert_eq!(image == plain, is_same, "{flags}");
    }
    // Other scratches are another scene, as for `render`; another exposure is not.
    let (image, noted) = render("--seed 1");
    assert_ne!(image.density, plain.density);
    assert_ne!(noted["scene"], notes["scene"]);
    assert_eq!(render("--exposure 3"), (plain, notes));
    assert_eq!(render("--size 10x12").0.size_px, [10, 12]);
}

#[test]
fn more_samples_are_added_to_the_same_picture() {
    let folder = folder_with_scene();
    let path = folder.path();
    let first = hairline(path, "reference plate.v2.toml --spp 64 -o a.exr --resume").success();
    assert!(stderr_of(&first).contains("from the start"));
    let more = hairline(path, "reference plate.v2.toml --spp 192 -o a.exr --resume").success();
    assert!(
        stderr_of(&more).contains("going on from 64 samples"),
        "{}",
        stderr_of(&more)
    );
    hairline(path, "reference plate.v2.toml --spp 192 -o b.exr").success();
    assert!(read(path, "a.exr") == read(path, "b.exr"));
    let before = fs::read(path.join("a.exr")).unwrap();

    let enough = hairline(path, "reference plate.v2.toml --spp 150 -o a.exr --resume").success();
    assert!(
        stderr_of(&enough).contains("192 samples for each pixel already: nothing to do"),
        "{}",
        stderr_of(&enough)
    );
    assert!(fs::read(path.join("a.exr")).unwrap() == before);

    // Without the flag it starts anew, and says what it replaces.
    let anew = hairline(path, "reference plate.v2.toml --spp 64 -o a.exr").success();
    assert!(stderr_of(&anew).contains("in place of the a.exr"));
    assert!(samples(&read(path, "a.exr").0).iter().all(|n| *n == 64));
}

#[test]
fn samples_of_another_picture_are_refused() {
    let folder = folder_with_scene();
    let path = folder.path();
    hairline(path, "reference plate.v2.toml --spp 64 -o a.exr").success();
    fs::write(
        path.join("other.toml"),
        SCRATCHED.replace("radiance = 40.0", "radiance = 41.0"),
    )
    .unwrap();
    let before = fs::read(path.join("a.exr")).unwrap();
    for (arguments, message) in [
        (
            "plate.v2.toml --model full",
            "model is separable and not full",
        ),
        (
            "plate.v2.toml --mask linear",
            "mask is energy and not linear",
        ),
        ("plate.v2.toml --bounces 1", "bounces is 0 and not 1"),
        ("plate.v2.toml --shadows on", "shadows is off and not on"),
        (
            "plate.v2.toml --sample-seed 4",
            "seed of the samples is 0 and not 4",
        ),
        ("plate.v2.toml --size 16x24", "size is 24x16 and not 16x24"),
        ("plate.v2.toml --seed 4", "scene is another one"),
        ("other.toml", "scene is another one"),
    ] {
        let assert = hairline(
            path,
            &format!("reference {arguments} --spp 128 -o a.exr --resume"),
        )
        .code(2);
        let text = stderr_of(&assert);
        assert!(
            text.contains("cannot go on") && text.contains(message),
            "{text}"
        );
        // Nothing that is equal is named. The full model has no mask.
        let differences = if message.contains("full") { 2 } else { 1 };
        assert_eq!(text.matches(" its ").count() - 1, differences, "{text}");
        assert!(!text.contains("sampling by"), "{text}");
        assert!(fs::read(path.join("a.exr")).unwrap() == before);
    }
    // Comments and exposure are not the scene's light.
    let same =
        format!("# The same.\n{}", *SCRATCHED).replace("[render]", "exposure_ev = 1.0\n[render]");
    fs::write(path.join("same.toml"), same).unwrap();
    hairline(path, "reference same.toml --spp 128 -o a.exr --resume").success();
}

#[test]
fn what_is_no_reference_is_refused() {
    let folder = folder_with_scene();
    let path = folder.path();
    fs::write(path.join("text.exr"), "a text").unwrap();
    hairline(path, "render plate.v2.toml --backend cpu -o render.exr").success();
    for name in ["text.exr", "render.exr"] {
        let before = fs::read(path.join(name)).unwrap();
        let arguments = format!("reference plate.v2.toml --spp 64 --resume -o {name}");
        let text = stderr_of(&hairline(path, &arguments).code(2));
        assert!(
            text.contains(name) && text.contains("not a reference"),
            "{text}"
        );
        assert!(fs::read(path.join(name)).unwrap() == before);
    }
}

#[test]
fn a_png_is_a_picture_and_no_more() {
    let folder = folder_with_scene();
    let path = folder.path();
    let assert = hairline(path, "reference plate.v2.toml --spp 64 -o a.png").success();
    assert!(stderr_of(&assert).contains("warning: a .png keeps neither"));
    let picture = png::read_picture(&path.join("a.png")).unwrap();
    assert!(picture.rgb.iter().flatten().any(|c| *c > 0.1), "black");
    let assert = hairline(path, "reference plate.v2.toml -o a.png --resume").code(2);
    assert!(stderr_of(&assert).contains("end it in .exr"));
}

#[test]
fn wrong_command_lines_are_2() {
    let folder = folder_with_scene();
    let before = names_in(folder.path());
    for (arguments, message) in [
        ("", "<SCENE>"),
        ("missing.toml", "missing.toml"),
        ("plate.v2.toml --spp 0", "from 1 to"),
        ("plate.v2.toml --spp many", "--spp"),
        ("plate.v2.toml --time 0", "1h30m"),
        ("plate.v2.toml --time soon", "1h30m"),
        ("plate.v2.toml --time=-5", "1h30m"),
        ("plate.v2.toml --bounces 65", "from 0 to 64"),
        ("plate.v2.toml --shadows some", "on, off"),
        ("plate.v2.toml --model waves", "separable, full"),
        (
            "plate.v2.toml --model full --mask energy",
            "--model separable",
        ),
        ("plate.v2.toml -o a.jpg", "end it in .png or .exr"),
    ] {
        let assert = hairline(folder.path(), &format!("reference {arguments}")).code(2);
        let text = stderr_of(&assert);
        assert!(text.contains(message), "{arguments}: {text}");
        assert_eq!(names_in(folder.path()), before, "{arguments}");
    }
}

#[test]
fn outputs_that_cannot_be_written_are_1_before_the_work() {
    let folder = folder_with_scene();
    let before = names_in(folder.path());
    let arguments = "reference plate.v2.toml -o nowhere/a.exr";
    let text = stderr_of(&hairline(folder.path(), arguments).code(1));
    assert!(text.contains("there is no folder"), "{text}");
    assert!(!text.contains("sampling by"), "found out too late: {text}");
    assert_eq!(names_in(folder.path()), before);
}

#[test]
fn time_alone_takes_what_fits_and_can_be_gone_on_with() {
    let folder = folder_with_scene();
    let path = folder.path();
    let text =
        stderr_of(&hairline(path, "reference plate.v2.toml --time 300ms -o a.exr").success());
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines.len(), 2, "{text}");
    assert!(
        lines[0].contains("at most 300ms") && !lines[0].contains("samples"),
        "{text}"
    );
    assert!(
        lines[1].starts_with("the time is up: a.exr has ") && lines[1].contains("--resume goes on"),
        "{text}"
    );
    let mean = |image: &Image| samples(image).iter().map(|&n| f64::from(n)).sum::<f64>();
    let before = mean(&read(path, "a.exr").0);
    hairline(
        path,
        "reference plate.v2.toml --time 300ms -o a.exr --resume",
    )
    .success();
    assert!(mean(&read(path, "a.exr").0) > before);
}

#[cfg(unix)]
mod interrupted {
    use super::*;
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Child, ChildStderr, Stdio};
    use std::time::Duration;

    /// Starts work that takes minutes, and waits until the first samples.
    fn start(folder: &Path, arguments: &str) -> (Child, BufReader<ChildStderr>) {
        let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_hairline"))
            .current_dir(folder)
            .args(arguments.split_whitespace())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut stderr = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        stderr.read_line(&mut line).unwrap();
        assert!(line.starts_with("sampling by"), "{line}");
        std::thread::sleep(Duration::from_millis(300));
        (child, stderr)
    }

    fn signal(child: &Child, name: &str) {
        let status = std::process::Command::new("kill")
            .args([name, &child.id().to_string()])
            .status();
        assert!(status.unwrap().success());
    }

    /// Whether hang-ups are ignored: under `nohup` the tests, and so the program, pass them over.
    fn hang_ups_are_ignored() -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let bits = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
        bits.unwrap_or(0) & 1 == 1
    }

    #[test]
    fn work_is_saved_and_goes_on_as_if_nothing_had_been() {
        for name in ["-INT", "-TERM", "-HUP"] {
            if name == "-HUP" && hang_ups_are_ignored() {
                eprintln!("skipped: SIGHUP is ignored here");
                continue;
            }
            let folder = folder_with_scene();
            let path = folder.path();
            let (mut child, mut stderr) =
                start(path, "reference plate.v2.toml --spp 1000000 -o a.exr");
            signal(&child, name);
            let mut rest = String::new();
            stderr.read_to_string(&mut rest).unwrap();
            assert_eq!(child.wait().unwrap().code(), Some(0), "{rest}");
            assert!(
                rest.starts_with("interrupted: a.exr has ") && rest.contains("--resume goes on"),
                "{rest}"
            );
            assert_eq!(names_in(path), ["a.exr", "plate.v2.toml"]);

            // One batch more than the richest pixel has.
            let most = *samples(&read(path, "a.exr").0).iter().max().unwrap();
            let to = format!("reference plate.v2.toml --spp {} -o", most + 64);
            hairline(path, &format!("{to} a.exr --resume")).success();
            hairline(path, &format!("{to} b.exr")).success();
            assert!(
                read(path, "a.exr") == read(path, "b.exr"),
                "{name}: not bit for bit"
            );
        }
    }

    /// A hang-up is ignored if the parent process ignores it, as `nohup` and shells that disown a
    /// job do.
    #[test]
    fn a_terminal_that_hangs_up_is_passed_over_where_it_is_to_be() {
        let folder = folder_with_scene();
        let command = format!(
            "trap '' HUP; exec {} reference plate.v2.toml --spp 1000000 -o a.exr",
            env!("CARGO_BIN_EXE_hairline")
        );
        let mut child = std::process::Command::new("sh")
            .current_dir(folder.path())
            .args(["-c", &command])
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut stderr = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        stderr.read_line(&mut line).unwrap();
        signal(&child, "-HUP");
        std::thread::sleep(Duration::from_millis(500));
        assert!(child.try_wait().unwrap().is_none());
        signal(&child, "-INT");
        assert_eq!(child.wait().unwrap().code(), Some(0));
    }

    /// The file is the one from before or a whole new one, whenever the second signal comes.
    #[test]
    fn a_second_signal_ends_it_at_once() {
        let folder = folder_with_scene();
        let path = folder.path();
        hairline(path, "reference plate.v2.toml --spp 64 -o a.exr").success();
        for _ in 0..4 {
            let (mut child, _stderr) = start(
                path,
                "reference plate.v2.toml --size 300x200 --bounces 3 --model full --spp 1000000 -o a.exr",
            );
            signal(&child, "-INT");
            signal(&child, "-TERM");
            let code = child.wait().unwrap().code();
            // 128 + SIGINT or SIGTERM, whichever is seen last, or it was faster than the second.
            assert!(matches!(code, Some(130 | 143 | 0)), "{code:?}");
            // Reading succeeds for whole files only.
            let is_new = read(path, "a.exr").0.size_px == [300, 200];
            assert!(is_new || code != Some(0));
            if is_new {
                hairline(path, "reference plate.v2.toml --spp 64 -o a.exr").success();
            }
        }
    }
}
