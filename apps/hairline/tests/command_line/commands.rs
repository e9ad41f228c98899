//! Requirements of a day at the command line: inputs stay, closed streams are no failure, bad inputs take no time and no memory, models
//! open, and flags have their effect.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{command, folder_with, hairline, names_in, stderr_of, stdout_of};
use hairline_fixtures::scenes::bare_plate;
use hairline_image::{Display, Output, Picture, exr_file};

/// A plate under a lamp with a name, without scratches, and the given tables.
fn scene(more: &str) -> String {
    bare_plate()
        .size_px([48, 27])
        .sphere([0.06, 0.10, 0.25], 0.01, 40.0)
        .with_lines("name = \"lamp\"")
        .part(more)
        .to_string()
}

const CSV: &str =
    "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n-0.04,0.01,0,0.05,0.02,0,4.2,130\n";
const LISTED: &str = "[[scratches]]\nobject = \"plate\"\npattern = \"file\"\nfile = \"list.csv\"\n";

/// Three corners in a file beside its glTF, and a texture. Metal would get scratches, which take long.
const TRIANGLE: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.4}}],
"textures": [{"source": 0}], "images": [{"uri": "tile.png"}], "buffers": [{"uri": "a.bin", "byteLength": 36}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [2, 1, 0]}]}"#;

/// Upright, 2 m wide, 1 m high.
fn write_triangle(folder: &Path) {
    let corners = [0.0f32, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(folder.join("a.bin"), bytes).unwrap();
    fs::write(folder.join("a.gltf"), TRIANGLE).unwrap();
    write_picture(&folder.join("tile.png"), [4, 4]);
}

fn write_picture(path: &Path, size_px: [u32; 2]) {
    let picture = Picture {
        size_px,
        rgb: vec![[0.4, 0.5, 0.6]; (size_px[0] * size_px[1]) as usize],
    };
    let output = Output::check(path).unwrap();
    output.write_picture(&picture, &Display::default()).unwrap();
}

#[test]
fn inputs_are_not_overwritten() {
    let text = format!(
        "{}[environment]\nfile = \"map.exr\"\n[[object]]\nname = \"model\"\nmesh = \"a.gltf\"\n{LISTED}",
        scene("")
    );
    let folder = folder_with("s.toml", &text);
    write_triangle(folder.path());
    write_picture(&folder.path().join("map.exr"), [8, 4]);
    fs::write(folder.path().join("list.csv"), CSV).unwrap();
    #[cfg(unix)]
    {
        let link = |to: &str, name: &str| std::os::unix::fs::symlink(to, folder.path().join(name));
        link("s.toml", "link.png").unwrap();
        link("list.csv", "list.png").unwrap();
        fs::hard_link(folder.path().join("a.bin"), folder.path().join("bin.png")).unwrap();
    }
    let contents = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let before = names_in(folder.path());
    let all: Vec<_> = before.iter().map(|name| contents(name)).collect();
    let mut cases = vec![
        ("render s.toml -o map.exr", "its environment"),
        ("reference s.toml --spp 1 -o ./map.exr", "its environment"),
        (
            "render s.toml -o tile.png",
            "image 0 of the mesh of object \"model\"",
        ),
    ];
    if cfg!(unix) {
        cases.extend([
            ("render s.toml -o link.png", "the scene file"),
            ("render s.toml -o list.png", "the list of scratches[0]"),
            ("render s.toml -o bin.png", "buffer 0 of the mesh"),
        ]);
    }
    for (arguments, message) in cases {
        let text = stderr_of(&hairline(folder.path(), arguments).code(2));
        assert!(
            text.contains(message) && text.contains("another name"),
            "{arguments}: {text}"
        );
    }
    assert_eq!(names_in(folder.path()), before);
    for (name, bytes) in before.iter().zip(all) {
        assert_eq!(contents(name), bytes, "{name}");
    }
    // The report of a comparison too.
    fs::copy(folder.path().join("tile.png"), folder.path().join("b.png")).unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("b.png", folder.path().join("r.html")).unwrap();
        let text = stderr_of(&hairline(folder.path(), "compare tile.png b.png -o r.html").code(2));
        assert!(text.contains("it is the reference"), "{text}");
    }
}

#[cfg(unix)]
#[test]
fn links_are_followed() {
    let folder = folder_with("s.toml", &scene(""));
    fs::create_dir(folder.path().join("pictures")).unwrap();
    let link = folder.path().join("out.png");
    std::os::unix::fs::symlink("pictures/new.png", &link).unwrap();
    for _ in 0..2 {
        // First to nothing, then to the picture.
        hairline(folder.path(), "render s.toml --backend cpu -o out.png").success();
        assert!(link.is_symlink());
        assert_eq!(names_in(&folder.path().join("pictures")), ["new.png"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn closed_and_full_streams_are_no_failure() {
    let folder = folder_with("s.toml", &scene(""));
    let run = |arguments: &str, out: Stdio, err: Stdio| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hairline"));
        command
            .current_dir(folder.path())
            .args(arguments.split_whitespace());
        let child = command.stdout(out).stderr(err).spawn().unwrap();
        child.wait_with_output().unwrap()
    };
    let closed = || {
        // Nobody reads from it.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        Stdio::from(writer)
    };
    let full = || Stdio::from(fs::File::options().write(true).open("/dev/full").unwrap());
    for (name, err) in [("a.png", closed()), ("b.png", full())] {
        let output = run(
            &format!("render s.toml --backend cpu -o {name}"),
            Stdio::null(),
            err,
        );
        assert_eq!(output.status.code(), Some(0), "{name}");
        assert!(folder.path().join(name).exists());
    }
    for arguments in [
        "compare a.png b.png --json",
        "compare a.png b.png",
        "info",
        "info s.toml",
        "man",
    ] {
        let output = run(arguments, closed(), Stdio::piped());
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {text}");
        assert_eq!(text, "", "{arguments}");
    }
    // The exit code is that of the work.
    let output = run(
        "compare a.png b.png --fail-below psnr=1000 --layer depth",
        closed(),
        closed(),
    );
    assert_ne!(output.status.code(), Some(0));
    // A result that could not be written is one.
    let output = run("man", full(), Stdio::piped());
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write to stdout"));
}

/// Refused at once, in one line, whatever they would take.
#[test]
fn floods_are_refused() {
    let points: Vec<_> = (0..2700)
        .map(|i| format!("[0.05, {}]", f64::from(i) * 1e-5))
        .collect();
    let lathe = format!(
        "[[object]]\nname = \"it\"\nmaterial = \"steel\"\nshape.lathe = {{ profile_m = [{}], segments = 4096 }}\n",
        points.join(", ")
    );
    let stroke = "[[scratches]]\nobject = \"plate\"\npattern = \"drawn\"\nstrokes = [{ points_m = [[0, 0, 0], [0, 45, 0]], \
                  radius_m = 0.006, density_per_m = 12000.0 }]\n";
    let folder = folder_with("stroke.toml", &scene(stroke));
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("lathe.toml", &scene(&lathe));
    write("list.toml", &scene(LISTED));
    write(
        "model.toml",
        &scene("[[object]]\nname = \"it\"\nmesh = \"a.glb\"\n"),
    );
    let mut cases = vec![(
        "stroke.toml",
        "strokes[0].points_m[1]: found a point 44.9 m off",
    )];
    if cfg!(target_os = "linux") {
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("list.csv")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("a.glb")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero.toml")).unwrap();
        cases.extend([
            ("list.toml", "no regular file"),
            ("model.toml", "no regular file"),
            ("zero.toml", "no regular file"),
        ]);
    }
    for (name, message) in cases {
        let start = Instant::now();
        let text = stderr_of(&hairline(folder.path(), &format!("render {name} -o a.png")).code(2));
        assert!(text.contains(message), "{name}: {text}");
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(start.elapsed() < Duration::from_secs(10), "{name}");
    }
    // Under the limit of the shell, whatever the machine has.
    if cfg!(target_os = "linux") {
        let script = format!(
            "ulimit -v 2000000; exec {} render lathe.toml -o a.png --backend cpu",
            env!("CARGO_BIN_EXE_hairline")
        );
        let run = Command::new("sh")
            .args(["-c", &script])
            .current_dir(folder.path())
            .output();
        let output = run.unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(
            text.contains("object[1].shape.lathe: found 22110208 triangles"),
            "{text}"
        );
        assert!(text.contains("11.33 GiB of memory"), "{text}");
    }
    assert!(!folder.path().join("a.png").exists());
}

#[test]
fn terminals_are_told_nothing_that_they_obey() {
    let folder = folder_with("s.toml", &scene(LISTED));
    let header = CSV.lines().next().unwrap();
    let name = "[[object]]\nname = \"a\"\nmaterial = \"\\u001b[2Jx\"\nshape.disk.radius_m = 1\n";
    fs::write(folder.path().join("name.toml"), scene(name)).unwrap();
    let long = "x".repeat(1_000_000);
    for cell in ["\u{1b}]0;title\u{7}", long.as_str()] {
        let text = format!("{header}\n{cell},0,0,0,0,0,1,1\n");
        fs::write(folder.path().join("list.csv"), text).unwrap();
        for file in ["s.toml", "name.toml", "gone\u{1b}[2J.toml"] {
            let text =
                stderr_of(&hairline(folder.path(), &format!("render {file} -o a.png")).code(2));
            assert!(text.len() < 500, "{} bytes", text.len());
            assert!(!text.contains(['\u{1b}', '\u{7}']), "{text:?}");
        }
    }
}

#[test]
fn models_open_upright_in_a_lit_scene() {
    let folder = tempfile::tempdir().unwrap();
    write_triangle(folder.path());
    let assert = hairline(
        folder.path(),
        "render a.gltf --backend cpu --size 64x36 --samples 1 --shadows off -o a.exr",
    )
    .success();
    let text = stderr_of(&assert);
    assert!(
        text.contains("2.000 m large; it is shown 0.05 m large"),
        "{text}"
    );
    let image = exr_file::read_image(&folder.path().join("a.exr")).unwrap();
    // It stands on a ground that lies.
    let seen = image.normal.iter().filter(|n| n[2].abs() < 0.5).count();
    assert!((300..1500).contains(&seen), "{seen} pixels");
    let lit = image.base.iter().filter(|c| c[1] > 0.02).count();
    assert!(lit > seen / 2, "{lit} of {seen}");
}

#[test]
fn info_tells_what_is_in_a_model() {
    let folder = tempfile::tempdir().unwrap();
    write_triangle(folder.path());
    let json = stdout_of(&hairline(folder.path(), "info a.gltf --json").success());
    let contents: serde_json::Value = serde_json::from_str(&json).unwrap();
    let object = &contents["objects"][0];
    assert_eq!(object["triangles"], 1);
    let most_m = [0, 1, 2].map(|axis| object["most_m"][axis].as_f64().unwrap() as f32);
    assert_eq!(most_m, [0.05, 0.0, 0.025]);
    assert_eq!(contents["textures"], 1);
}

#[test]
fn info_tells_what_is_in_a_scene() {
    let map = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/maps/evening.hdr");
    let text = scene(&format!(
        "[environment]\nfile = {map:?}\n[[scratches]]\nobject = \"plate\"\nname = \"cloth\"\npattern = \"random\"\ncount = 50\n[[look]]\nname = \"at night\"\n"
    ));
    let folder = folder_with("s.toml", &text);
    let text = stdout_of(&hairline(folder.path(), "info s.toml").success());
    for part in [
        "picture: 48 x 27 pixels",
        "\"plate\": 160.0 mm x 160.0 mm",
        "random \"cloth\" on \"plate\": 50 scratches",
        "sphere \"lamp\" at (0.0600, 0.1000, 0.2500) m",
        "lamps found in it: 1",
        "looks: 1\n  \"at night\"",
        "degrees above the horizon",
        "memory: about",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn info_tells_elevations_above_the_worlds_horizon() {
    let map = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/maps/evening.hdr");
    let elevation_deg = |picture_up: [f64; 3]| {
        let plate = bare_plate().up(picture_up);
        let text = plate.part(&format!("[environment]\nfile = {map:?}\n"));
        let text = (text.to_string()).replacen("[camera]\n", "[camera]\nworld_up = \"z\"\n", 1);
        let folder = folder_with("s.toml", &text);
        let json = stdout_of(&hairline(folder.path(), "info s.toml --json").success());
        let contents: serde_json::Value = serde_json::from_str(&json).unwrap();
        contents["environment"]["lamps"][0]["elevation_deg"].as_f64()
    };
    let upright = elevation_deg([0.0, 0.0, 1.0]);
    assert!(upright.is_some());
    // A camera on its side.
    assert_eq!(elevation_deg([1.0, 0.0, 0.0]), upright);
}

#[test]
fn scenes_come_by_stdin_and_flags_change_them() {
    let folder = tempfile::tempdir().unwrap();
    let render = |arguments: &str| {
        let arguments = format!("render - --backend cpu --samples 1 {arguments}");
        command(folder.path(), &arguments)
            .write_stdin(scene(""))
            .assert()
            .success();
    };
    render("");
    assert_eq!(names_in(folder.path()), ["hairline.png"]);
    render("--tone-map none -o none.png");
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_ne!(bytes("hairline.png"), bytes("none.png"));
    let wrong = command(folder.path(), "render -")
        .write_stdin("[camera")
        .assert()
        .code(2);
    assert!(
        stderr_of(&wrong).contains("stdin:1:"),
        "{}",
        stderr_of(&wrong)
    );
}

#[test]
fn a_highlight_comes_where_it_is_asked_for() {
    let folder = folder_with("s.toml", &scene(""));
    let render = "render s.toml --backend cpu --samples 1 -o a.exr";
    for at in ["20,18", "30,10,lamp"] {
        hairline(folder.path(), &format!("{render} --highlight {at}")).success();
        let image = exr_file::read_image(&folder.path().join("a.exr")).unwrap();
        let brightest =
            (0..image.base.len()).max_by(|a, b| image.base[*a][1].total_cmp(&image.base[*b][1]));
        let brightest = brightest.unwrap() as i64;
        let (x, y) = (brightest % 48, brightest / 48);
        let wanted: Vec<i64> = at
            .split(',')
            .take(2)
            .map(|it| it.parse().unwrap())
            .collect();
        assert!(
            (x - wanted[0]).abs() <= 1 && (y - wanted[1]).abs() <= 1,
            "{at}: {x},{y}"
        );
    }
    for (at, message) in [
        ("0,0", "no surface at the pixel 0,0"),
        ("48,3", "outside of the picture"),
        ("20,18,moon", "no light called \"moon\""),
        ("20", "write a pixel"),
    ] {
        let text =
            stderr_of(&hairline(folder.path(), &format!("{render} --highlight {at}")).code(2));
        assert!(text.contains(message), "{at}: {text}");
    }
}

#[test]
fn shells_and_manuals_know_the_flags() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let text = stdout_of(&hairline(folder.path(), &format!("completions {shell}")).success());
        assert!(
            text.contains("highlight") && text.contains("reference"),
            "{shell}"
        );
    }
    let page = stdout_of(&hairline(folder.path(), "man").success());
    for part in [
        ".TH hairline",
        "HAIRLINE RENDER",
        "highlight",
        "HAIRLINE COMPARE",
        "fail\\-above",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[cfg(unix)]
#[test]
fn a_watched_scene_is_rendered_again() {
    let folder = folder_with("s.toml", &scene(""));
    let picture = folder.path().join("a.png");
    let mut child = Command::new(env!("CARGO_BIN_EXE_hairline"))
        .current_dir(folder.path())
        .args([
            "render",
            "s.toml",
            "-o",
            "a.png",
            "--backend",
            "cpu",
            "--watch",
            "--samples",
            "1",
        ])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let wait_for = |is_there: &dyn Fn() -> bool| {
        let start = Instant::now();
        while !is_there() {
            assert!(start.elapsed() < Duration::from_secs(60), "nothing came");
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    wait_for(&|| picture.exists());
    let first = fs::read(&picture).unwrap();
    // A mistake does not end it.
    fs::write(folder.path().join("s.toml"), "[camera").unwrap();
    std::thread::sleep(Duration::from_millis(700));
    fs::write(
        folder.path().join("s.toml"),
        scene("").replace("radiance = 40.0", "radiance = 400.0"),
    )
    .unwrap();
    wait_for(&|| fs::read(&picture).is_ok_and(|bytes| bytes != first));
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn other_files_than_scenes_are_refused_with_their_use() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (
            "render picture.png",
            "it is a picture; give a scene (.toml) or a model (.glb, .gltf, .obj, .stl)",
        ),
        ("render map.hdr", "an environment map"),
        ("render model.fbx", "export it as .glb"),
        ("render model.STEP", "it is a model of another format"),
    ] {
        let text = stderr_of(&hairline(folder.path(), arguments).code(2));
        assert!(text.contains(message), "{arguments}: {text}");
    }
}
