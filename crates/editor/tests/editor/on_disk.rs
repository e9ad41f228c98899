//! A scene file that another program writes while it is open here.

use hairline_editor::Document;
use hairline_editor::document::{OnDisk, SaveError};

const SCENE: &str = r#"# Mine.
[camera]
position_m = [0.0, 0.0, 1.0]
target_m = [0.0, 0.0, 0.0]
fov_y_deg = 30.0

[[material]]
name = "mirror"
kind = "mirror"

[[object]]
name = "plate"
shape = { disk = { radius_m = 0.1 } }
material = "mirror"
"#;

fn expose(document: &mut Document) {
    document.edit("Exposure", |d| d.camera.exposure_ev = 2.0);
}

#[test]
fn a_file_that_changed_is_not_saved_over_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, SCENE).unwrap();
    let mut document = Document::open(&path).unwrap();
    assert_eq!(document.on_disk(), OnDisk::Same);
    expose(&mut document);
    let theirs = SCENE.replace("30.0", "20.0");
    std::fs::write(&path, &theirs).unwrap();
    assert_eq!(document.on_disk(), OnDisk::Changed);
    let refused = document.save().unwrap_err();
    assert!(matches!(&refused, SaveError::ChangedOnDisk(p) if *p == path));
    assert!(refused.to_string().contains("a.toml"));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), theirs);
    assert!(document.is_modified());
    // Somebody has seen it and chooses the one here.
    document.pass_over_disk();
    assert_eq!(document.on_disk(), OnDisk::Same);
    document.save().unwrap();
    let saved = std::fs::read_to_string(&path).unwrap();
    assert!(saved.starts_with("# Mine.") && saved.contains("fov_y_deg = 30.0"));
    // A file that is gone is written again.
    std::fs::remove_file(&path).unwrap();
    assert_eq!(document.on_disk(), OnDisk::Gone);
    document.save().unwrap();
    std::fs::write(&path, &theirs).unwrap();
    document.save_over().unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), saved);
}

#[test]
fn reload_and_revert_are_steps() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, SCENE).unwrap();
    let mut document = Document::open(&path).unwrap();
    assert!(!document.can_revert());
    expose(&mut document);
    let edited = document.description().clone();
    assert!(document.can_revert());
    document.revert();
    assert_eq!(document.description().camera.exposure_ev, 0.0);
    assert!(!document.is_modified());
    document.undo();
    assert_eq!(*document.description(), edited);

    std::fs::write(&path, SCENE.replace("30.0", "20.0")).unwrap();
    document.reload().unwrap();
    assert_eq!(document.description().camera.fov_y_deg, 20.0);
    assert!(!document.is_modified());
    assert_eq!(document.on_disk(), OnDisk::Same);
    document.undo();
    assert_eq!(*document.description(), edited);
    assert!(document.is_modified());
    // A mistake in the file is reported and changes nothing.
    std::fs::write(&path, "[camera]\nposition_m = 3\n").unwrap();
    let error = document.reload().unwrap_err().to_string();
    assert!(error.contains("a.toml:2"), "{error}");
    assert_eq!(*document.description(), edited);
}
