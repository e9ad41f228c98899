//! The drawing of crates in ARCHITECTURE.md against what their `Cargo.toml` files say.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

type Edges = BTreeMap<String, BTreeSet<String>>;

/// What each library depends on: its own crates but `features`, without those of its tests.
fn dependencies(root: &Path) -> Edges {
    let folders = std::fs::read_dir(root.join("crates")).unwrap();
    let of_folder = |folder: std::fs::DirEntry| {
        let text = std::fs::read_to_string(folder.path().join("Cargo.toml")).unwrap();
        let manifest: toml::Table = text.parse().unwrap();
        let listed = manifest.get("dependencies").and_then(|it| it.as_table());
        let names = listed.into_iter().flat_map(|it| it.keys());
        let own = names.filter_map(|name| name.strip_prefix("hairline-"));
        let own = own.filter(|name| *name != "features").map(str::to_owned);
        let name = folder.file_name().into_string().unwrap();
        (name, own.collect())
    };
    folders.map(|folder| of_folder(folder.unwrap())).collect()
}

/// The arrows of the drawing, from what stands on their right to what stands on their left.
fn drawn(text: &str) -> Edges {
    let drawing = text.split("```").nth(1).unwrap();
    let mut edges = Edges::new();
    for line in drawing.lines().filter(|line| line.contains("<--")) {
        let names = |group: &str| -> Vec<String> {
            let names = group.split(',').map(|name| name.trim().to_owned());
            names.collect()
        };
        let groups: Vec<_> = line.split("<--").map(names).collect();
        for pair in groups.windows(2) {
            for right in &pair[1] {
                let left = edges.entry(right.clone()).or_default();
                left.extend(pair[0].iter().cloned());
            }
        }
    }
    edges
}

/// Everything to the left of a crate.
fn left_of(edges: &Edges, name: &str) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    let mut next = vec![name.to_owned()];
    while let Some(name) = next.pop() {
        let more = edges.get(&name).into_iter().flatten().cloned();
        next.extend(more.filter(|it| all.insert(it.clone())));
    }
    all
}

#[test]
fn crates_depend_on_each_other_as_drawn() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let text = std::fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    let (drawn, real) = (drawn(&text), dependencies(&root));
    for (name, left) in &drawn {
        let missing: Vec<_> = left.difference(&real[name]).collect();
        assert!(missing.is_empty(), "{name} has no {missing:?}, as drawn");
    }
    for (name, own) in &real {
        let undrawn: Vec<_> = own.difference(&left_of(&drawn, name)).cloned().collect();
        assert!(undrawn.is_empty(), "{name} has {undrawn:?}, not drawn");
    }
}
