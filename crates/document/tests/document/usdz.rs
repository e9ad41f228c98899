//! Models as packages of USD.

use hairline_document::export::{Export, Format};
use hairline_document::{Description, Loader};

use crate::common::{png, scene_with, temporary_dir};

/// The files of an archive: their names, where they begin, their bytes. Only what is stored is read.
fn unpacked(archive: &[u8]) -> Vec<(String, usize, &[u8])> {
    let number = |at: usize, length: usize| -> usize {
        let bytes = archive[at..at + length].iter().rev();
        bytes.fold(0, |sum, byte| sum << 8 | usize::from(*byte))
    };
    let end = archive.len() - 22;
    assert_eq!(&archive[end..end + 4], b"PK\x05\x06");
    let mut at = number(end + 16, 4);
    let mut files = Vec::new();
    for _ in 0..number(end + 10, 2) {
        assert_eq!(&archive[at..at + 4], b"PK\x01\x02");
        assert_eq!(number(at + 10, 2), 0, "stored");
        let (length, name_length) = (number(at + 20, 4), number(at + 28, 2));
        let name = String::from_utf8_lossy(&archive[at + 46..at + 46 + name_length]);
        let header = number(at + 42, 4);
        assert_eq!(&archive[header..header + 4], b"PK\x03\x04");
        let start = header + 30 + number(header + 26, 2) + number(header + 28, 2);
        files.push((name.into_owned(), start, &archive[start..start + length]));
        at += 46 + name_length;
    }
    assert_eq!(at, end);
    files
}

/// The stage is the first file, and each begins where a reader may map it. What the stage says is looked at by Pixar's own checks in crates/python/tests.
#[test]
fn a_package_has_the_model_with_its_textures_and_not_the_ground() {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("red.png"), png([2, 2], [255, 0, 0, 255])).unwrap();
    let paint = "newmtl paint\nKd 1 1 1\nmap_Kd red.png\n";
    std::fs::write(dir.path().join("a.mtl"), paint).unwrap();
    let obj = "mtllib a.mtl\nv 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl paint\nf 1/1 2/2 3/3\n";
    std::fs::write(dir.path().join("a.obj"), obj).unwrap();
    let objects = "[[object]]\nname = \"it's \\\"it\\\"\"\nmesh = \"a.obj\"\n\
        [[object]]\nname = \"floor\"\nshape = { plane = { size_m = [2, 2] } }\nmaterial = \"steel\"\n";
    let description = Description::from_toml(&scene_with(objects), "s.toml".as_ref()).unwrap();
    let export = Export {
        format: Format::Usdz,
        ..Export::default()
    };
    let loader = Loader::default();
    let made = loader.export(&description, dir.path(), export).unwrap();
    let again = loader.export(&description, dir.path(), export).unwrap();
    assert!(made.bytes == again.bytes, "one scene makes one file");
    let files = unpacked(&made.bytes);
    let names: Vec<_> = files.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["scene.usda", "textures/0.png"]);
    for (name, start, _) in &files {
        assert_eq!(start % 64, 0, "{name}");
    }
    let picture = image::load_from_memory(files[1].2).unwrap().into_rgba8();
    assert_eq!(picture.get_pixel(1, 1).0, [255, 0, 0, 255]);
    let text = str::from_utf8(files[0].2).unwrap();
    assert!(text.starts_with("#usda 1.0\n"), "{text}");
    assert!(text.contains(r#"displayName = "it's \"it\"""#), "{text}");
    assert!(!text.contains("floor"));
    // The model's y is up there, whatever is up in the scene.
    assert!(
        text.contains("point3f[] points = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0)]"),
        "{text}"
    );
    assert!(text.contains("asset inputs:file = @textures/0.png@"));
}
