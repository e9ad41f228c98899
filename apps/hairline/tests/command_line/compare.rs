//! `hairline compare` from outside: figures that are known beforehand, limits, refusals, and a report that is whole.

use std::fs;
use std::io::Read as _;
use std::path::Path;

use crate::common::{hairline, stderr_of, stdout_of};
use assert_cmd::assert::Assert;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use hairline_image::{Display, Image, Noise, Output, Picture};
use half::f16;
use html5gum::emitters::default::DefaultEmitter;
use html5gum::{Token, Tokenizer};
use serde_json::Value;

const SIZE: [u32; 2] = [48, 30];

fn compare(folder: &Path, arguments: &str) -> Assert {
    hairline(folder, &format!("compare {arguments}"))
}

fn text_of(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn json_of(folder: &Path, arguments: &str) -> Value {
    let assert = compare(folder, &format!("{arguments} --json")).success();
    serde_json::from_slice(&assert.get_output().stdout).unwrap()
}

/// A smooth picture with something in each layer.
fn scene(size_px: [u32; 2]) -> Image {
    let mut image = Image::new(size_px);
    for y in 0..size_px[1] {
        for x in 0..size_px[0] {
            let i = image.index(x, y);
            let share = x as f32 / size_px[0] as f32;
            image.base[i] = [0.2 + share, 0.3, 0.5 - 0.4 * share];
            image.scratches[i] = [0.1, 0.2 * share, 0.05 + 0.01 * y as f32];
            image.density[i] = [0.3; 3];
            image.depth_m[i] = 0.4 + 0.1 * share;
            image.normal[i] = [0.0, 0.6, 0.8];
        }
    }
    image
}

fn write(folder: &Path, name: &str, image: &Image) {
    let output = Output::check(folder.join(name)).unwrap();
    output.write_image(image, &Display::default()).unwrap();
}

/// Standard normal, near enough: twelve uniform numbers (a 64-bit congruential sequence of D. Knuth's) have variance one.
struct Normal(u64);

impl Normal {
    fn next(&mut self) -> f32 {
        let mut uniform = || {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f32 / (1_u64 << 24) as f32
        };
        (0..12).map(|_| uniform()).sum::<f32>() - 6.0
    }
}

/// The picture as a Monte Carlo estimate: noise of the standard deviation given in base and scratches, and the variance.
fn noisy(mut image: Image, deviation: f32) -> Image {
    let mut normal = Normal(7);
    // A thousand batches: noise known almost exactly.
    let mut noise = Noise::new(image.size_px, 1);
    noise.samples.fill(1000);
    for i in 0..image.pixel_count() {
        for c in 0..3 {
            image.base[i][c] += deviation * normal.next();
            image.scratches[i][c] += deviation * normal.next();
        }
        noise.base[i] = [deviation * deviation; 3];
        noise.scratches[i] = [deviation * deviation; 3];
        noise.beauty[i] = [2.0 * deviation * deviation; 3];
    }
    image.noise = Some(noise);
    image
}

/// Two EXR files: `a.exr` has 0.02 more light by way of the scratches than `b.exr`.
fn folder_with_pair() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut image = scene(SIZE);
    write(folder.path(), "b.exr", &image);
    for c in image.scratches.iter_mut().flatten() {
        *c += 0.02;
    }
    write(folder.path(), "a.exr", &image);
    folder
}

#[test]
fn figures_are_what_they_must_be() {
    let folder = folder_with_pair();
    let figures = json_of(folder.path(), "a.exr b.exr");
    for layer in ["beauty", "scratches"] {
        let rms = figures["layers"][layer]["rms"].as_f64().unwrap();
        assert!((rms - 0.02).abs() < 1e-6, "{layer}: {rms}");
        assert!(figures["layers"][layer]["flip"].as_f64().unwrap() > 0.0);
    }
    for layer in ["base", "density", "depth", "normal"] {
        assert_eq!(figures["layers"][layer]["rms"], 0.0, "{layer}");
        // Infinite.
        assert_eq!(figures["layers"][layer]["psnr"], Value::Null, "{layer}");
    }
    assert_eq!(figures["layers"]["density"]["flip"], Value::Null);
    assert_eq!(figures["a"]["size_px"], serde_json::json!(SIZE));

    let assert = compare(folder.path(), "a.exr b.exr").success();
    let text = stdout_of(&assert);
    assert!(text.starts_with("a.exr against b.exr, 48 x 30\n"), "{text}");
    for part in ["beauty", "normal", "FLIP 95 %", "0.02000", "infinite"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
    assert!(stderr_of(&assert).is_empty());

    let only = json_of(folder.path(), "a.exr b.exr --layer scratches");
    assert_eq!(only["layers"].as_object().unwrap().len(), 1);

    // Brighter pictures show more of the same difference in dark places.
    let flip = |arguments: &str| {
        let figures = json_of(folder.path(), &format!("a.exr b.exr {arguments}"));
        figures["layers"]["beauty"]["flip"].as_f64().unwrap()
    };
    assert!(flip("--exposure -5") < 0.5 * flip("--exposure 0"));
    assert_ne!(flip("--tone-map agx"), flip("--tone-map neutral"));
}

#[test]
fn noise_is_told_from_differences() {
    let folder = tempfile::tempdir().unwrap();
    let truth = scene(SIZE);
    write(folder.path(), "truth.exr", &truth);
    write(folder.path(), "estimate.exr", &noisy(truth.clone(), 0.01));
    let mut biased = truth;
    for c in biased.scratches.iter_mut().flatten() {
        *c += 0.01;
    }
    write(folder.path(), "biased.exr", &biased);

    let text = stdout_of(&compare(folder.path(), "truth.exr estimate.exr").success());
    assert!(
        text.contains("scratches: the difference is explained by noise: mean z\u{b2} = "),
        "{text}"
    );
    let z2 = &json_of(folder.path(), "truth.exr estimate.exr")["layers"]["scratches"]["z2"];
    // 4320 values: the mean of z^2 scatters by sqrt(2 / 4320) = 0.02.
    assert!((z2.as_f64().unwrap() - 1.0).abs() < 0.1, "{z2}");

    // A bias of one standard deviation: hidden in a pixel, plain in the picture.
    let text = stdout_of(&compare(folder.path(), "biased.exr estimate.exr").success());
    assert!(
        text.contains("scratches: the difference is not explained by noise"),
        "{text}"
    );
    assert!(
        text.contains("base: the difference is explained by noise"),
        "{text}"
    );
    compare(
        folder.path(),
        "biased.exr estimate.exr --fail-above scratches.z2=1.5",
    )
    .code(1);
    compare(
        folder.path(),
        "truth.exr estimate.exr --fail-above scratches.z2=1.5",
    )
    .success();
}

#[test]
fn limits_are_kept_or_named() {
    let folder = folder_with_pair();
    for kept in [
        "--fail-above rms=0.021",
        "--fail-above base.relmse=0",
        "--fail-below base.psnr=100",
    ] {
        compare(folder.path(), &format!("a.exr b.exr {kept}")).success();
    }
    let broken = "--fail-above rms=0.015 --fail-above base.rms=0 --fail-below psnr=90";
    let assert = compare(folder.path(), &format!("a.exr b.exr {broken}")).code(1);
    let text = stderr_of(&assert);
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(
        text.contains("beauty.rms is 0.02000, above the limit of 0.01500 by 0.005000"),
        "{text}"
    );
    assert!(
        text.contains("beauty.psnr is") && text.contains("below the limit of 90.00"),
        "{text}"
    );
    assert!(!text.contains("base"), "{text}");
    // The figures come all the same.
    assert!(stdout_of(&assert).contains("FLIP"));

    for (limit, message) in [
        ("--fail-above flpi=0.1", "did you mean `flip`?"),
        ("--fail-above psnr=40", "--fail-below psnr=40"),
        ("--fail-above z2=1", "how noisy"),
        ("--fail-above density.flip=1", "no picture for a display"),
        (
            "--fail-above base.rms=1 --layer beauty",
            "layer base was not compared",
        ),
        ("--layer zebra", "beauty, base"),
        ("--tone-map filmic", "neutral, agx"),
    ] {
        let assert = compare(folder.path(), &format!("a.exr b.exr {limit}")).code(2);
        let text = stderr_of(&assert);
        assert!(text.contains(message), "{limit}: {text}");
    }
}

#[test]
fn values_that_are_not_finite_are_told_and_fail() {
    let folder = folder_with_pair();
    let mut image = scene(SIZE);
    image.base[5][1] = f32::NAN;
    image.base[6] = [f32::INFINITY; 3];
    write(folder.path(), "nan.exr", &image);
    let assert = compare(folder.path(), "nan.exr b.exr").success();
    let (errors, table) = (stderr_of(&assert), stdout_of(&assert));
    assert!(
        errors.contains("warning: A has 4 values in the layer base that are NaN"),
        "{errors}"
    );
    assert!(
        table.contains("4 not finite in A") && !table.contains("NaN"),
        "{table}"
    );
    let assert = compare(folder.path(), "nan.exr b.exr --fail-above rms=10").code(1);
    assert!(
        stderr_of(&assert).contains("error: A has 4 values"),
        "{}",
        stderr_of(&assert)
    );
    // Limits of a layer that is not compared are ignored.
    compare(
        folder.path(),
        "nan.exr b.exr --layer scratches --fail-above scratches.rms=10",
    )
    .success();
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = folder_with_pair();
    write(folder.path(), "small.exr", &scene([24, 30]));
    fs::write(folder.path().join("text.exr"), "not a picture").unwrap();
    for (arguments, messages) in [
        (
            "a.exr small.exr",
            ["a.exr has 48 x 30", "small.exr has 24 x 30"],
        ),
        ("a.exr small.exr", ["--size 24x30", "--size 48x30"]),
        ("a.exr gone.exr", ["gone.exr", "no such file"]),
        ("text.exr a.exr", ["text.exr", "neither an EXR nor a PNG"]),
        ("a.exr b.exr -o report.pdf", ["report.pdf", ".html"]),
        ("a.exr", ["<B>", "Usage"]),
    ] {
        let assert = compare(folder.path(), arguments).code(2);
        let text = stderr_of(&assert);
        assert!(
            messages.iter().all(|message| text.contains(message)),
            "{arguments}: {text}"
        );
        assert!(stdout_of(&assert).is_empty());
    }
    for (output, message) in [
        ("nowhere/report.html", "there is no folder"),
        ("b.exr/report.html", "a file where a folder is needed"),
    ] {
        // Before the work: the second picture is not even there.
        let assert = compare(folder.path(), &format!("a.exr gone.exr -o {output}")).code(1);
        assert!(
            stderr_of(&assert).contains(message),
            "{}",
            stderr_of(&assert)
        );
    }
}

#[test]
fn missing_layers_and_tone_mapped_pictures_are_told() {
    let folder = folder_with_pair();
    let plain = Picture {
        size_px: SIZE,
        rgb: scene(SIZE).beauty().rgb,
    };
    for name in ["plain.exr", "plain.png"] {
        let output = Output::check(folder.path().join(name)).unwrap();
        output.write_picture(&plain, &Display::default()).unwrap();
    }
    let assert = compare(folder.path(), "a.exr plain.exr").success();
    let (errors, table) = (stderr_of(&assert), stdout_of(&assert));
    assert!(
        errors.contains("warning: B lacks the layers base, scratches"),
        "{errors}"
    );
    assert!(table.contains("not in B"), "{table}");

    let assert = compare(folder.path(), "b.exr plain.png -o shown.html").success();
    assert!(
        stderr_of(&assert).contains("warning: A was tone-mapped"),
        "{}",
        stderr_of(&assert)
    );
    let figures = json_of(folder.path(), "b.exr plain.png");
    // The same picture but for the PNG's eight bits: rounding has an rms of 1/sqrt(12) of a step, dither as much again.
    assert!(figures["layers"]["beauty"]["psnr"].as_f64().unwrap() > 50.0);
    // A picture as displayed has a tone curve that cannot be undone, so there is no exposure to choose.
    let page = fs::read_to_string(folder.path().join("shown.html")).unwrap();
    assert!(page.contains("compared as displayed") && !page.contains("id=\"exposure\""));
}

/// An element of a page: its name, its attributes, and the text directly inside.
struct Element {
    name: String,
    attributes: Vec<(String, String)>,
    text: String,
}

impl Element {
    fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(n, _)| n == name)?;
        Some(&found.1)
    }
}

/// All elements of a page that is well formed: no error of the tokenizer, every element closed in its turn.
fn elements(page: &str) -> Result<Vec<Element>, String> {
    const VOID: [&str; 6] = ["meta", "link", "input", "img", "br", "hr"];
    let mut emitter: DefaultEmitter = DefaultEmitter::default();
    emitter.naively_switch_states(true);
    let (mut elements, mut open): (Vec<Element>, Vec<usize>) = (Vec::new(), Vec::new());
    for token in Tokenizer::new_with_emitter(page, emitter) {
        match token.unwrap() {
            Token::StartTag(tag) => {
                let name = text_of(&tag.name);
                if !VOID.contains(&name.as_str()) {
                    open.push(elements.len());
                }
                let attributes = tag
                    .attributes
                    .iter()
                    .map(|(n, v)| (text_of(n), text_of(v)))
                    .collect();
                elements.push(Element {
                    name,
                    attributes,
                    text: String::new(),
                });
            }
            Token::EndTag(tag) => {
                let opened = open.pop().map(|i| elements[i].name.as_str());
                if opened != Some(&text_of(&tag.name)) {
                    return Err(format!("</{}> closes {opened:?}", text_of(&tag.name)));
                }
            }
            Token::String(text) => {
                if let Some(&i) = open.last() {
                    elements[i].text.push_str(&text_of(&text));
                }
            }
            Token::Error(error) => return Err(error.value.to_string()),
            Token::Comment(_) | Token::Doctype(_) => {}
        }
    }
    if open.is_empty() {
        Ok(elements)
    } else {
        Err("elements stay open".to_owned())
    }
}

/// Unpacks values as the page's script does.
fn unpacked(text: &str, channels: usize) -> Vec<f32> {
    let mut bytes = Vec::new();
    let packed = BASE64.decode(text).unwrap();
    flate2::read::ZlibDecoder::new(packed.as_slice())
        .read_to_end(&mut bytes)
        .unwrap();
    let count = bytes.len() / 2 / channels;
    bytes
        .chunks(2 * count)
        .flat_map(|plane| {
            (0..count).map(|i| f16::from_be_bytes([plane[i], plane[count + i]]).to_f32())
        })
        .collect()
}

#[test]
fn a_report_is_whole_and_needs_nothing_else() {
    let folder = folder_with_pair();
    write(folder.path(), "<b>&.exr", &noisy(scene(SIZE), 0.01));
    let assert = compare(folder.path(), "a.exr <b>&.exr -o report.html").success();
    assert!(stdout_of(&assert).contains("FLIP"));
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let elements = elements(&page).unwrap();

    // Nothing from outside: addresses are data or places in the page.
    for element in &elements {
        for name in ["src", "href", "srcset", "action", "poster"] {
            if let Some(address) = element.attribute(name) {
                assert!(
                    address.starts_with("data:"),
                    "<{}> {name}={address}",
                    element.name
                );
            }
        }
    }
    for outside in [
        "http:",
        "https:",
        "//cdn",
        "@import",
        "url(",
        "fetch(",
        "XMLHttpRequest",
    ] {
        assert!(!page.contains(outside), "{outside}");
    }

    // Two pictures for each of six layers; relative errors for all, FLIP for three, z for the four that have a variance.
    let pictures: Vec<&Element> = elements.iter().filter(|e| e.name == "img").collect();
    assert_eq!(pictures.len(), 6 * 2 + 6 + 3 + 4);
    for picture in &pictures {
        let source = picture.attribute("src").unwrap();
        let png = BASE64
            .decode(source.strip_prefix("data:image/png;base64,").unwrap())
            .unwrap();
        let decoded = image::load_from_memory_with_format(&png, image::ImageFormat::Png).unwrap();
        assert_eq!([decoded.width(), decoded.height()], SIZE);
        assert!(picture.attribute("alt").is_some_and(|alt| !alt.is_empty()));
    }
    // One layer and one map are shown before any script has run.
    assert_eq!(
        pictures
            .iter()
            .filter(|p| p.attribute("hidden").is_none())
            .count(),
        3
    );

    // The values that the magnifier reads are those of the files.
    let packed = |id: &str| {
        let element = elements
            .iter()
            .find(|e| e.attribute("id") == Some(id))
            .unwrap();
        unpacked(&element.text, if id.contains("depth") { 1 } else { 3 })
    };
    let pixels = (SIZE[0] * SIZE[1]) as usize;
    let (reference, difference) = (packed("linear-base-b"), packed("linear-base-d"));
    assert_eq!(reference.len(), 3 * pixels);
    assert_eq!(packed("linear-depth-b").len(), pixels);
    let truth = scene(SIZE);
    for (i, rgb) in truth.base.iter().enumerate() {
        for (c, right) in rgb.iter().enumerate() {
            let a = reference[c * pixels + i] + difference[c * pixels + i];
            // Two roundings to eleven bits.
            assert!(
                (a - right).abs() < 2e-3 * right.max(0.1),
                "{i} {c}: {a} {right}"
            );
        }
    }

    // Accessibility: names, roles, a slider that the keyboard reaches; and names are not code.
    let slider = elements
        .iter()
        .find(|e| e.attribute("role") == Some("slider"))
        .unwrap();
    for name in [
        "aria-label",
        "aria-valuenow",
        "aria-valuemin",
        "aria-valuemax",
        "tabindex",
    ] {
        assert!(slider.attribute(name).is_some(), "{name}");
    }
    assert!(
        elements
            .iter()
            .any(|e| e.name == "title" && e.text.contains("<b>&.exr"))
    );
    assert!(!elements.iter().any(|e| e.name == "b"));
    assert!(page.contains("explained by noise"));
}

#[test]
fn malformed_pages_would_be_seen() {
    assert!(elements("<p><b>text</p></b>").is_err());
    assert!(elements("<div><p>text</p>").is_err());
    assert!(elements("<p a=1 a=2>text</p>").is_err());
    assert!(elements("<p>a <img src=\"data:,\"> b</p>").is_ok());
}

#[test]
fn large_pictures_are_reported_without_their_values() {
    let folder = tempfile::tempdir().unwrap();
    let picture = Picture::new([1000, 601]);
    for name in ["a.exr", "b.exr"] {
        let output = Output::check(folder.path().join(name)).unwrap();
        output.write_picture(&picture, &Display::default()).unwrap();
    }
    compare(folder.path(), "a.exr b.exr -o report.html").success();
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let elements = elements(&page).unwrap();
    assert!(page.contains("too large to embed"));
    assert!(
        !elements
            .iter()
            .any(|e| e.attribute("type") == Some("application/x-packed-halves"))
    );
    assert!(
        !elements
            .iter()
            .any(|e| e.attribute("id") == Some("exposure"))
    );
}

/// A report is an output as others are: the old file or the new one.
#[test]
fn a_refused_comparison_leaves_the_old_report() {
    let folder = folder_with_pair();
    write(folder.path(), "small.exr", &scene([24, 30]));
    fs::write(folder.path().join("report.html"), "old").unwrap();
    compare(folder.path(), "a.exr small.exr -o report.html").code(2);
    assert_eq!(
        fs::read_to_string(folder.path().join("report.html")).unwrap(),
        "old"
    );
    compare(folder.path(), "a.exr b.exr -o report.html").success();
    assert!(
        fs::read_to_string(folder.path().join("report.html"))
            .unwrap()
            .starts_with("<!DOCTYPE html>")
    );
    let names = fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(names, 4, "a temporary file stayed");
}
