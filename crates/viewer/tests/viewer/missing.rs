//! Files that a scene names and that are not there.

use std::path::{Path, PathBuf};

use crate::common::{
    self, SMALL, click_on, description, viewer_of_any_file, wait_built, wait_until,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_viewer::Viewer;

fn opened(scene: &Path) -> Harness<'static, Viewer> {
    let mut harness = viewer_of_any_file(scene);
    wait_until(&mut harness, "the scene is looked at", |viewer| {
        !viewer.renderer().is_building()
    });
    harness.run_steps(2);
    harness
}

/// Types into the line for a path, and enters it.
fn enter_path(harness: &mut Harness<'static, Viewer>, path: &Path) {
    harness.run_steps(2);
    harness.event(egui::Event::Text(path.display().to_string()));
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
}

/// The folders of a scene, and of files that were moved.
fn folders(dir: &Path) -> [PathBuf; 2] {
    let folders = ["scene", "moved"].map(|name| dir.join(name));
    for folder in &folders {
        std::fs::create_dir(folder).unwrap();
    }
    folders
}

#[test]
fn a_mask_that_is_not_there_is_told_of_and_found() {
    let dir = tempfile::tempdir().unwrap();
    let [here, moved] = folders(dir.path());
    let picture = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/hairline.png");
    std::fs::copy(picture, moved.join("leaf.png")).unwrap();
    let scene = here.join("a.toml");
    let text = SMALL.replace(
        "count = 200",
        "count = 200\nwhere = { mask = \"leaf.png\", tile_m = 0.1 }",
    );
    std::fs::write(&scene, text).unwrap();
    let mut harness = opened(&scene);
    harness.get_by_label("The mask leaf.png is not there.");
    // Nothing is being waited for, and nothing is told twice.
    assert!(harness.query_by_label("building the scene").is_none());
    assert!(harness.state().messages().is_empty());
    let before = description(&harness);
    click_on(&mut harness, "Find the file…");
    enter_path(&mut harness, &moved.join("leaf.png"));
    wait_built(&mut harness);
    let file = description(&harness).scratches[0].place.mask.clone();
    assert_eq!(file.as_deref(), Some(Path::new("../moved/leaf.png")));
    assert!(harness.query_by_label_contains("is not there").is_none());
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn a_model_is_found_and_what_was_beside_it_with_it() {
    let dir = tempfile::tempdir().unwrap();
    let [here, moved] = folders(dir.path());
    crate::picking::two_squares(&moved);
    let picture = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/hairline.png");
    std::fs::copy(picture, moved.join("leaf.png")).unwrap();
    let scene = here.join("a.toml");
    let text = "[camera]\nposition_m = [0, 0, 0.4]\ntarget_m = [0, 0, 0]\nup = [0, 1, 0]\n\
        [[object]]\nname = \"it\"\nmesh = \"parts/a.gltf\"\n\
        [[scratches]]\nobject = \"it\"\npattern = \"random\"\ncount = 50\nlength_m = 0.02\n\
        where = { mask = \"parts/leaf.png\", tile_m = 0.1 }\n";
    std::fs::write(&scene, format!("{text}{}", crate::picking::LAMP)).unwrap();
    let mut harness = opened(&scene);
    harness.get_by_label("The mask leaf.png is not there.");
    harness.get_by_label("The model a.gltf is not there.");
    let no_picture = harness.query_all_by_label("the scene could not be built");
    assert_eq!(
        no_picture.count(),
        2,
        "in the picture and in the status line"
    );
    let button = harness.query_all_by_label("Find the file…").next();
    button.unwrap().click();
    harness.run_steps(3);
    enter_path(&mut harness, &moved.join("a.gltf"));
    wait_built(&mut harness);
    let files: Vec<PathBuf> = description(&harness)
        .files()
        .into_iter()
        .map(|(_, path)| path.clone())
        .collect();
    assert_eq!(
        files,
        ["../moved/a.gltf", "../moved/leaf.png"].map(PathBuf::from)
    );
    assert!(harness.query_by_label_contains("is not there").is_none());
}
