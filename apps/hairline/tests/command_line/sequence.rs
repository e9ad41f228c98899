//! Sequences from outside: written files, refusals, and that stopping leaves whole files only.

use std::path::Path;

use crate::common::{SCRATCHED, command, folder_with, hairline, names_in, stderr_of, stdout_of};
use hairline_image::{exr_file, png};

fn folder_with_scene() -> tempfile::TempDir {
    folder_with("plate.toml", &SCRATCHED)
}

/// Names of all files but the scene.
fn written_in(folder: &Path) -> Vec<String> {
    let mut names = names_in(folder);
    names.retain(|name| name != "plate.toml");
    names
}

#[test]
fn frames_are_numbered_and_the_first_is_the_scenes_own_view() {
    let folder = folder_with_scene();
    let render = |flags: &str| {
        hairline(
            folder.path(),
            &format!("render plate.toml --backend cpu {flags}"),
        )
        .success()
    };
    render("-o still.exr");
    render("-o turn.exr --frames 3 --turntable 360");
    render("-o zoom.exr --frames 2 --zoom 2:1");
    assert_eq!(
        written_in(folder.path()),
        [
            "still.exr",
            "turn-0001.exr",
            "turn-0002.exr",
            "turn-0003.exr",
            "zoom-0001.exr",
            "zoom-0002.exr"
        ]
    );
    let read = |name: &str| {
        exr_file::read_image_with_notes(&folder.path().join(name))
            .unwrap()
            .0
    };
    let still = read("still.exr");
    assert_eq!(read("turn-0001.exr"), still);
    assert_ne!(read("turn-0002.exr"), still);
    // The step after the last frame would be the first again.
    assert_ne!(read("turn-0003.exr"), still);
    assert_eq!(read("zoom-0002.exr"), still);
    let middle = still.index(12, 8);
    let (near, far) = (read("zoom-0001.exr").depth_m[middle], still.depth_m[middle]);
    // The pixel beside the middle is not the target itself.
    assert!((near / far - 0.5).abs() < 0.02, "{near} {far}");
}

/// Seen by the camera an object turns either way; the light on it stands still in one of them.
#[test]
fn a_turntable_turns_the_camera_or_the_objects() {
    let folder = folder_with_scene();
    for (name, turns) in [("camera", ""), ("object", "--turns object")] {
        let sequence = "--frames 2 --turntable 180 --backend cpu";
        let command = format!("render plate.toml -o {name}.exr {sequence} {turns}");
        hairline(folder.path(), &command).success();
    }
    let read = |name: &str| exr_file::read_image(&folder.path().join(name)).unwrap();
    assert_eq!(read("camera-0001.exr"), read("object-0001.exr"));
    let [camera, object] = ["camera-0002.exr", "object-0002.exr"].map(read);
    assert_eq!(camera.depth_m, object.depth_m);
    assert_ne!(camera.base, object.base);
    hairline(folder.path(), "render plate.toml --turns object").code(2);
    let lights = "--frames 2 --turntable 180 --turns lights --backend cpu";
    hairline(
        folder.path(),
        &format!("render plate.toml -o lights.exr {lights}"),
    )
    .success();
    let [first, second] = ["lights-0001.exr", "lights-0002.exr"].map(read);
    assert_eq!(first, read("camera-0001.exr"));
    assert_eq!(second.depth_m, first.depth_m);
    assert_ne!(second.base, first.base);
}

/// A program in the place of ffmpeg: it writes the frames as they come.
#[cfg(unix)]
fn write_program(folder: &Path) {
    use std::os::unix::fs::PermissionsExt;
    let program = "#!/bin/sh\ncase \"$*\" in *-encoders*) exit 0;; esac\n\
                   for last; do :; done\nexec /bin/cat > \"$last\"\n";
    let path = folder.join("ffmpeg");
    std::fs::write(&path, program).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

#[cfg(unix)]
#[test]
fn a_video_gets_the_frames_and_needs_its_program() {
    let folder = folder_with_scene();
    let programs = tempfile::tempdir().unwrap();
    let render = |flags: &str| {
        let own = "--backend cpu --frames 2 --turntable 90";
        let arguments = format!("render plate.toml {own} {flags}");
        let mut command = command(folder.path(), &arguments);
        command.env("PATH", programs.path()).assert()
    };
    let message = stderr_of(&render("-o a.mp4").code(1));
    assert!(
        message.contains("ffmpeg, which is not on PATH"),
        "{message}"
    );
    assert!(message.contains(".apng"), "{message}");
    write_program(programs.path());
    render("--animation a.mp4 -o b.png").success();
    assert_eq!(
        written_in(folder.path()),
        ["a.mp4", "b-0001.png", "b-0002.png"]
    );
    let frames = ["b-0001.png", "b-0002.png"].map(|name| {
        let picture = image::open(folder.path().join(name)).unwrap();
        picture.into_rgb8().into_raw()
    });
    let video = std::fs::read(folder.path().join("a.mp4")).unwrap();
    assert!(video == frames.concat());
    let message = stderr_of(&render("-o c.mp4 --transparent").code(1));
    assert!(message.contains("no alpha"), "{message}");
    assert!(!folder.path().join("c.mp4").exists());
}

#[test]
fn an_animation_is_one_file_and_its_first_frame_is_the_picture() {
    let folder = folder_with_scene();
    for (flags, names) in [
        ("-o a.apng", vec!["a.apng"]),
        ("--animation b.png", vec!["a.apng", "b.png"]),
        (
            "--animation b.png -o c.png",
            vec!["a.apng", "b.png", "c-0001.png", "c-0002.png"],
        ),
    ] {
        let arguments =
            format!("render plate.toml --backend cpu --frames 2 --turntable 90 --fps 12 {flags}");
        hairline(folder.path(), &arguments).success();
        assert_eq!(written_in(folder.path()), names);
    }
    let read = |name: &str| png::read_picture(&folder.path().join(name)).unwrap();
    assert_eq!(read("a.apng"), read("c-0001.png"));
    assert_eq!(read("b.png"), read("c-0001.png"));
    assert_ne!(read("c-0001.png"), read("c-0002.png"));
}

/// A square that rises towards the camera within a second.
fn write_rising(folder: &Path) {
    let corners = [[-1.0f32, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let positions = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]);
    let times = [0.0, 1.0];
    let places = [0.0, 0.0, 0.0, 0.0, 0.0, 0.4];
    let indices = [0u32, 1, 2, 0, 2, 3].into_iter().flat_map(u32::to_le_bytes);
    let numbers = positions.chain(times).chain(places);
    let bytes: Vec<u8> = numbers.flat_map(f32::to_le_bytes).chain(indices).collect();
    std::fs::write(folder.join("rising.bin"), &bytes).unwrap();
    let view = |at: usize, length: usize| {
        format!(r#"{{"buffer":0,"byteOffset":{at},"byteLength":{length}}}"#)
    };
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":3}}]}}],
        "animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],
            "samplers":[{{"input":1,"output":2}}]}}],
        "buffers":[{{"uri":"rising.bin","byteLength":{}}}],
        "bufferViews":[{},{},{},{}],
        "accessors":[
            {{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}},
            {{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]}},
            {{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}},
            {{"bufferView":3,"componentType":5125,"count":6,"type":"SCALAR"}}]}}"#,
        bytes.len(),
        view(0, 48),
        view(48, 8),
        view(56, 24),
        view(80, 24),
    );
    std::fs::write(folder.join("rising.gltf"), text).unwrap();
    let scene = "[camera]\nposition_m = [0.0, -0.01, 1.0]\ntarget_m = [0.0, 0.0, 0.0]\n\
        [[material]]\nname = \"m\"\nkind = \"dielectric\"\nroughness = 0.5\n\
        [[object]]\nname = \"it\"\nmesh = \"rising.gltf\"\nmaterial = \"m\"\n\
        [[light]]\nkind = \"sphere\"\ncenter_m = [0.5, 0.0, 1.0]\nradius_m = 0.1\nradiance = 9.0\n\
        [render]\nsize_px = [16, 12]\n";
    std::fs::write(folder.join("rising.toml"), scene).unwrap();
}

#[test]
fn frames_go_through_the_time_of_an_animation() {
    let folder = tempfile::tempdir().unwrap();
    write_rising(folder.path());
    let depth_m = |name: &str| {
        let read = exr_file::read_image_with_notes(&folder.path().join(name));
        let image = read.unwrap().0;
        image.depth_m[image.index(8, 6)]
    };
    let render = |flags: &str| {
        let arguments = format!("render rising.toml --backend cpu {flags}");
        hairline(folder.path(), &arguments).success()
    };
    render("-o late.exr --time 1");
    render("-o rising.exr --frames 3 --time 0:1");
    let depths = ["0001", "0002", "0003"].map(|i| depth_m(&format!("rising-{i}.exr")));
    for (found, right) in depths.into_iter().zip([1.0, 0.8, 0.6]) {
        assert!((found - right).abs() < 0.01, "{depths:?}");
    }
    assert_eq!(depths[2], depth_m("late.exr"));
}

#[test]
fn contradictions_are_2_and_nothing_is_written() {
    let folder = folder_with_scene();
    for (flags, message) in [
        ("--frames 3", "--turntable DEG, --zoom A:B"),
        ("--frames 0 --turntable 9", "from 1 to 100000"),
        ("--time 0:1", "--time A:B is for a sequence"),
        ("--frames 2 --time 0:much", "FROM:TO"),
        ("--frames 2 --time 0:1 --stability", "not with --time A:B"),
        ("--frames 2 --time 1", "--frames needs what changes"),
        ("--turntable 90", "--frames N"),
        ("--zoom 1:2", "--frames N"),
        ("--stability", "--frames N"),
        ("--animation a.apng", "--frames N"),
        ("-o a.apng", "--frames N"),
        ("--frames 2 --turntable much", "360"),
        ("--frames 2 --zoom 8", "1:8"),
        ("--frames 2 --zoom 0:8", "1:8"),
        ("--frames 2 --zoom 1:90000", "from its target"),
        ("--frames 2 --zoom 1:2 --fps 12", "--animation FILE"),
        (
            "--frames 2 --zoom 1:2 --fps 29.97",
            "must be a whole number from 1 to 100",
        ),
        ("--frames 1 --zoom 1:2 --stability", "--frames 2 or more"),
        (
            "--frames 2 --zoom 1:2 -o a.gif",
            "error: a.gif: end it in .png or .exr for numbered pictures, in .apng or .mp4",
        ),
        (
            "--frames 2 --zoom 1:2 -o -",
            "--frames: -o - is one picture; name a file",
        ),
        (
            "--frames 2 --zoom 1:2 --animation a.gif",
            ".apng, .png or .mp4",
        ),
        (
            "--frames 2 --zoom 1:2 -o a.apng --animation b.apng",
            "leave one of them out",
        ),
    ] {
        let arguments = format!("render plate.toml --backend cpu {flags}");
        let text = stderr_of(&hairline(folder.path(), &arguments).code(2));
        assert!(text.contains(message), "{flags}: {text}");
        assert!(written_in(folder.path()).is_empty(), "{flags}");
    }
    let arguments = "render plate.toml --backend cpu --frames 2 --zoom 1:2 -o nowhere/a.png";
    hairline(folder.path(), arguments).code(1);
}

/// "mean FLIP a; of 64 samples b; ratio c"
fn figures(folder: &Path, flags: &str) -> [f64; 3] {
    let arguments = format!("render plate.toml --stability -o a.png {flags}");
    let assert = hairline(folder, &arguments).success();
    let text = stdout_of(&assert);
    let numbers: Vec<f64> = text
        .split([' ', ';', '\n'])
        .filter_map(|word| word.parse().ok())
        .collect();
    assert!(text.starts_with("stability: mean FLIP"), "{text}");
    // The third number is how many samples.
    [numbers[0], numbers[2], numbers[3]]
}

#[test]
fn a_camera_that_stands_still_is_steady_and_a_moving_one_as_its_reference() {
    let folder = folder_with_scene();
    let still = figures(folder.path(), "--backend cpu --frames 2 --zoom 1:1");
    assert_eq!(still, [0.0, 0.0, 1.0]);
    let [own, reference, ratio] = figures(folder.path(), "--backend cpu --frames 3 --turntable 3");
    assert!(own > 0.0 && reference > 0.0);
    assert!((ratio - own / reference).abs() < 0.01);
    // The averages over pixels are closed forms: they flicker no more than what they stand for.
    assert!((0.8..1.2).contains(&ratio), "{ratio}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_whole_frames_and_no_animation() {
    let folder = folder_with_scene();
    let child = std::process::Command::new(assert_cmd::cargo::cargo_bin("hairline"))
        .current_dir(folder.path())
        .args("render plate.toml --backend cpu --frames 100000 --turntable 360 -o a.png".split(' '))
        .args(["--animation", "b.apng", "--size", "160x90"])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let second = folder.path().join("a-000002.png");
    let start = std::time::Instant::now();
    while !second.exists() {
        assert!(start.elapsed().as_secs() < 600, "no second frame");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let killed = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(killed.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    let names = written_in(folder.path());
    let said = format!(
        "interrupted; {} of 100000 frames are whole, a-000001.png to {}; b.apng was not written",
        names.len(),
        names.last().unwrap()
    );
    assert!(text.contains(&said), "{text} {names:?}");
    for name in names {
        let picture = png::read_picture(&folder.path().join(name)).unwrap();
        assert_eq!(picture.size_px, [160, 90]);
    }
}
