//! Documents: steps, drags, modification, and files.

use std::path::{Path, PathBuf};

use hairline_document::Description;
use hairline_document::description::{Layer, Surface};
use hairline_editor::document::SaveError;
use hairline_editor::{ActionError, Document, DragKey, Selection, actions};

const SCENE: &str = r#"
[camera]
position_m = [0, 0, 1]
target_m = [0, 0, 0]

[environment]
file = "../maps/studio.hdr"

[[material]]
name = "steel"
kind = "metal"
metal = "steel"

[[object]]
name = "plate"
shape = { disk = { radius_m = 0.1 } }
material = "steel"

[[object]]
name = "pan"
mesh = "models/pan.glb"

[[scratches]]
object = "plate"
pattern = "file"
file = "scratches.csv"

[[scratches]]
object = "pan"
pattern = "random"
count = 10
"#;

fn scene() -> Description {
    Description::from_toml(SCENE, Path::new("test")).unwrap()
}

fn document() -> Document {
    Document::untitled(scene(), "")
}

fn set_exposure(document: &mut Document, exposure_ev: f64) {
    document.edit("exposure", |d| d.camera.exposure_ev = exposure_ev);
}

#[test]
fn an_edit_is_a_step_unless_it_changes_nothing() {
    let mut document = document();
    let start = document.revision();
    set_exposure(&mut document, 0.0);
    assert_eq!((document.undo_label(), document.revision()), (None, start));
    assert!(!document.is_modified());

    set_exposure(&mut document, 1.0);
    assert_eq!(document.undo_label(), Some("exposure"));
    assert!(document.is_modified() && document.revision() != start);
    let edited = document.revision();
    assert_eq!(document.undo().as_deref(), Some("exposure"));
    assert!(!document.is_modified());
    assert!(![start, edited].contains(&document.revision()));
    assert_eq!(**document.description(), scene());
    assert_eq!(document.redo_label(), Some("exposure"));
    assert_eq!(document.redo().as_deref(), Some("exposure"));
    assert_eq!(document.description().camera.exposure_ev, 1.0);
    assert_eq!(
        (document.redo(), document.undo().is_some(), document.undo()),
        (None, true, None)
    );

    // A new edit forgets what was undone.
    set_exposure(&mut document, 2.0);
    assert_eq!(document.redo_label(), None);
}

#[test]
fn a_document_in_the_place_of_another_has_later_revisions() {
    let mut shown = document();
    set_exposure(&mut shown, 1.0);
    let edited = shown.revision();
    shown.replace(document());
    assert!(shown.revision() > edited && !shown.is_modified());
    assert_eq!(shown.undo(), None, "the history is the other's");
}

#[test]
fn a_drag_is_one_step_until_it_ends_or_another_begins() {
    let mut document = document();
    let (here, there) = (
        DragKey::from_name("slider"),
        DragKey::from_name(("gizmo", 1)),
    );
    assert_ne!(here, there);
    let drag = |document: &mut Document, label: &str, key, by: f64| {
        document.drag(label, key, |d| d.camera.exposure_ev += by);
    };
    drag(&mut document, "exposure", here, 0.0);
    assert_eq!(document.undo_label(), None);
    for _ in 0..3 {
        drag(&mut document, "exposure", here, 1.0);
    }
    assert_eq!(document.before_drag().unwrap().camera.exposure_ev, 0.0);
    document.end_drag();
    drag(&mut document, "exposure", here, 1.0);
    drag(&mut document, "exposure", there, 1.0);
    drag(&mut document, "brightness", there, 1.0);
    let mut seen = vec![document.description().camera.exposure_ev];
    while document.undo().is_some() {
        seen.push(document.description().camera.exposure_ev);
    }
    assert_eq!(seen, [6.0, 5.0, 4.0, 3.0, 0.0]);
}

#[test]
fn a_drag_back_to_its_start_or_cancelled_is_no_step() {
    let mut document = document();
    let key = DragKey(7);
    set_exposure(&mut document, 1.0);
    for to in [2.0, 3.0, 1.0] {
        document.drag("exposure", key, |d| d.camera.exposure_ev = to);
    }
    assert_eq!(document.undo_label(), Some("exposure"));
    document.drag("exposure", key, |d| d.camera.exposure_ev = 4.0);
    document.cancel_drag();
    assert_eq!(document.description().camera.exposure_ev, 1.0);
    document.drag("turn", key, |d| d.camera.exposure_ev = 5.0);
    document.drag("turn", key, |d| d.camera.exposure_ev = 1.0);
    document.end_drag();
    document.undo();
    assert_eq!(
        **document.description(),
        scene(),
        "the edit was the only step"
    );
    assert_eq!(document.undo(), None);
}

#[test]
fn steps_restore_what_was_selected() {
    let mut document = document();
    document.select(Selection::Layer(1));
    document
        .apply("delete layer", |d, selection| {
            actions::parts::delete(d, Selection::Layer(1), selection)
        })
        .unwrap();
    assert_eq!(document.selection(), Selection::Object(1));
    document.select(Selection::Camera);
    document.undo();
    assert_eq!(document.selection(), Selection::Layer(1));
    document.select(Selection::Light(3));
    assert_eq!(document.selection(), Selection::None, "there is none");
    document.redo();
    assert_eq!(document.selection(), Selection::Object(1));
    document.undo();
    assert_eq!(document.selection(), Selection::Layer(1));
}

#[test]
fn a_refused_action_changes_nothing() {
    let mut document = document();
    let revision = document.revision();
    let refused = document.apply("delete material", |d, selection| {
        actions::materials::delete(d, 0, selection)
    });
    assert_eq!(
        refused,
        Err(ActionError::MaterialInUse {
            material: "steel".into(),
            users: vec!["plate".into()]
        })
    );
    assert_eq!(
        (document.revision(), document.undo_label()),
        (revision, None)
    );
}

fn paths(description: &Description) -> Vec<PathBuf> {
    let mut paths = vec![
        description
            .environment
            .as_ref()
            .unwrap()
            .map
            .file()
            .unwrap()
            .to_owned(),
    ];
    for object in &description.objects {
        if let Surface::Mesh(file) = &object.surface {
            paths.push(file.clone());
        }
    }
    for layer in &description.scratches {
        if let Layer::Listed(listed) = &layer.layer {
            paths.push(listed.file.clone());
        }
    }
    paths
}

#[test]
fn what_is_saved_opens_again_and_counts_as_saved() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plate.toml");
    std::fs::write(&file, SCENE).unwrap();
    let mut document = Document::open(&file).unwrap();
    assert_eq!(
        (document.title(), &**document.base_dir()),
        ("plate.toml".into(), folder.path())
    );
    assert!(!document.is_modified());
    set_exposure(&mut document, 1.0);
    document.save().unwrap();
    assert!(!document.is_modified());
    let again = Document::open(&file).unwrap();
    assert_eq!(again.description(), document.description());
    // Back over the saving is a modification, and forward again is none.
    document.undo();
    assert!(document.is_modified());
    document.redo();
    assert!(!document.is_modified());
    assert!(matches!(
        Document::untitled(scene(), "").save(),
        Err(SaveError::NoPath)
    ));
}

#[test]
fn saving_elsewhere_keeps_every_path_on_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().canonicalize().unwrap();
    for name in ["scenes/models", "maps", "elsewhere/deep"] {
        std::fs::create_dir_all(root.join(name)).unwrap();
    }
    for name in [
        "scenes/models/pan.glb",
        "scenes/scratches.csv",
        "maps/studio.hdr",
    ] {
        std::fs::write(root.join(name), "").unwrap();
    }
    std::fs::write(root.join("scenes/a.toml"), SCENE).unwrap();
    let mut document = Document::open(root.join("scenes/a.toml")).unwrap();
    let named = |document: &Document| -> Vec<PathBuf> {
        let paths = paths(document.description()).into_iter();
        paths
            .map(|path| document.base_dir().join(path).canonicalize().unwrap())
            .collect()
    };
    let before = named(&document);
    set_exposure(&mut document, 1.0);
    document
        .save_as(root.join("elsewhere/deep/b.toml"))
        .unwrap();
    assert!(!document.is_modified());
    assert_eq!(document.title(), "b.toml");
    assert_eq!(named(&document), before);
    assert_eq!(
        paths(document.description()),
        [
            "../../maps/studio.hdr",
            "../../scenes/models/pan.glb",
            "../../scenes/scratches.csv"
        ]
        .map(PathBuf::from)
    );
    let opened = Document::open(root.join("elsewhere/deep/b.toml")).unwrap();
    assert_eq!(opened.description(), document.description());
    // The past moved along.
    document.undo();
    assert_eq!(document.description().camera.exposure_ev, 0.0);
    assert_eq!(named(&document), before);
    // In the same folder nothing changes.
    document.redo();
    let revision = document.revision();
    document
        .save_as(root.join("elsewhere/deep/c.toml"))
        .unwrap();
    assert_eq!(document.revision(), revision);
}

#[test]
fn a_failed_save_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.toml");
    std::fs::write(&file, SCENE).unwrap();
    let mut document = Document::open(&file).unwrap();
    set_exposure(&mut document, 1.0);
    let before = document.description().clone();
    assert!(
        document
            .save_as(folder.path().join("no/such/folder/b.toml"))
            .is_err()
    );
    assert!(document.save_as(folder.path()).is_err(), "a folder");
    assert_eq!(*document.description(), before);
    assert_eq!(document.path(), Some(file.as_path()));
    assert!(document.is_modified());
    // TOML has no integers that large.
    document.edit("seed", |d| {
        *d.scratches[1].layer.seed_mut().unwrap() = u64::MAX
    });
    assert!(matches!(document.save(), Err(SaveError::Form(_))));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), SCENE);
}

#[test]
fn a_wrong_file_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.toml");
    for (from, to, line, said) in [
        (
            "kind = \"metal\"",
            "kind = \"metall\"",
            Some(11),
            "did you mean",
        ),
        (
            "radius_m = 0.1",
            "radius_m = -0.1",
            Some(16),
            "must be from 1e-5 to 1000",
        ),
        (
            "material = \"steel\"",
            "material = \"stel\"",
            Some(17),
            "did you mean \"steel\"?",
        ),
        (
            "object = \"pan\"",
            "object = \"pot\"",
            Some(29),
            "found no object called \"pot\"",
        ),
    ] {
        std::fs::write(&file, SCENE.replace(from, to)).unwrap();
        let error = Document::open(&file).unwrap_err();
        assert_eq!(
            (error.file(), error.line()),
            (Some(file.as_path()), line),
            "{error}"
        );
        assert!(error.to_string().contains(said), "{error}");
    }
    let error = Document::open(folder.path().join("none.toml")).unwrap_err();
    assert!(error.to_string().contains("cannot be read"), "{error}");
}
