//! Autosaves: when they are written, to whom they are offered, and their recovery.

use std::path::Path;
use std::time::Duration;

use hairline_document::Description;
use hairline_editor::Document;
use hairline_editor::autosave::{Autosave, Tick, pending};

const SCENE: &str = "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\n\
    [environment]\nfile = \"maps/a.hdr\"\n\
    [[object]]\nname = \"pan\"\nmesh = \"pan.glb\"\n";

fn seconds(s: f64) -> Duration {
    Duration::from_secs_f64(s)
}

fn expose(document: &mut Document, exposure_ev: f64) {
    document.edit("exposure", |d| d.camera.exposure_ev = exposure_ev);
}

fn untitled() -> Document {
    let description = Description::from_toml(SCENE, Path::new("test")).unwrap();
    Document::untitled(description, "")
}

/// Leaves files as after a crash: the lock is free, the files are there.
fn crash(autosave: Autosave) {
    drop(autosave);
}

fn files(folder: &Path) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}

#[test]
fn it_writes_changes_alone_and_not_too_often() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = untitled();
    let mut autosave = Autosave::new(folder.path()).unwrap();
    let mut tick = |at, document: &Document| autosave.tick(seconds(at), document).unwrap();
    assert_eq!(tick(0.0, &document), Tick::Nothing);
    expose(&mut document, 1.0);
    assert_eq!(tick(1.0, &document), Tick::Written);
    assert_eq!(tick(20.0, &document), Tick::Nothing, "nothing new");
    expose(&mut document, 2.0);
    assert_eq!(tick(20.1, &document), Tick::Written);
    expose(&mut document, 3.0);
    assert_eq!(tick(21.0, &document), Tick::Nothing, "too early");
    assert_eq!(tick(25.2, &document), Tick::Written);
    while document.undo().is_some() {}
    assert_eq!(tick(25.3, &document), Tick::Removed, "no changes are left");
    assert_eq!(tick(40.0, &document), Tick::Nothing);
    assert_eq!(files(folder.path()), 1, "the lock");
    autosave.close();
    assert_eq!(files(folder.path()), 0);
}

#[test]
fn a_crash_leaves_the_document_with_its_paths() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = tempfile::tempdir().unwrap();
    let file = scenes.path().join("my pan.toml");
    std::fs::write(&file, SCENE).unwrap();
    let mut document = Document::open(&file).unwrap();
    expose(&mut document, 1.5);
    let mut autosave = Autosave::new(folder.path()).unwrap();
    autosave.tick(seconds(0.0), &document).unwrap();
    assert_eq!(pending(folder.path()), [], "that run is alive");
    crash(autosave);

    let [left] = &pending(folder.path())[..] else {
        panic!("one document was left")
    };
    assert_eq!(
        (left.title().as_str(), left.path.as_deref()),
        ("my pan.toml", Some(file.as_path()))
    );
    let mut recovered = left.recover().unwrap();
    assert_eq!(recovered.description(), document.description());
    assert!(recovered.is_modified());
    assert_eq!(recovered.path(), Some(file.as_path()));
    assert_eq!(
        **recovered.base_dir(),
        *scenes.path().canonicalize().unwrap()
    );
    let text = std::fs::read_dir(folder.path()).unwrap().flatten();
    let text = text.map(|e| std::fs::read_to_string(e.path()).unwrap());
    let header = format!("# autosave of {}\n", file.display());
    assert!(text.into_iter().any(|text| text.starts_with(&header)));

    // The next run takes it over: it is offered no more once that has written or saved it.
    let mut next = Autosave::new(folder.path()).unwrap();
    next.take_over(left.clone());
    assert_eq!(pending(folder.path()).len(), 1);
    assert_eq!(next.tick(seconds(0.0), &recovered).unwrap(), Tick::Written);
    assert_eq!(pending(folder.path()), []);
    recovered.save().unwrap();
    assert!(!recovered.is_modified());
    assert_eq!(next.tick(seconds(0.1), &recovered).unwrap(), Tick::Removed);
    next.close();
    assert_eq!(files(folder.path()), 0);
    assert_eq!(
        Document::open(&file).unwrap().description(),
        document.description()
    );
}

#[test]
fn each_window_keeps_its_own_and_discarding_is_for_good() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("made/when needed");
    let windows: Vec<_> = (0..3)
        .map(|i| {
            let mut document = untitled();
            expose(&mut document, f64::from(i) + 1.0);
            let mut autosave = Autosave::new(&folder).unwrap();
            autosave.tick(seconds(0.0), &document).unwrap();
            autosave
        })
        .collect();
    let mut windows = windows.into_iter();
    let alive = windows.next();
    windows.for_each(crash);
    let left = pending(&folder);
    let mut exposures: Vec<_> = left
        .iter()
        .map(|one| one.recover().unwrap().description().camera.exposure_ev)
        .collect();
    exposures.sort_by(f64::total_cmp);
    assert_eq!(exposures, [2.0, 3.0]);
    assert!(
        left.iter()
            .all(|one| one.path.is_none() && one.title() == "untitled")
    );
    left.into_iter().for_each(|one| one.discard());
    assert_eq!(pending(&folder), []);
    drop(alive);
    assert_eq!(pending(&folder).len(), 1);
}

#[test]
fn other_files_and_broken_ones_do_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(pending(&folder.path().join("none")), []);
    std::fs::write(folder.path().join("notes.toml"), "a = 1").unwrap();
    std::fs::write(
        folder.path().join("1-0.toml"),
        "# autosave of /a/b.toml\n[camera",
    )
    .unwrap();
    let left = pending(folder.path());
    assert_eq!(left.len(), 1);
    assert!(left[0].recover().is_err());
    assert!(
        Autosave::new(&folder.path().join("notes.toml")).is_err(),
        "no folder"
    );
}
