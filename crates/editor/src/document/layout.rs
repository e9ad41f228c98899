//! A scene file's own layout: comments, order and spelling of the parts that an edit did not touch stay as they were written.
//!
//! The file's text is not understood here. Its meaning is written out as the scene format writes it, before and after the edit; where
//! those two differ the text is changed, and nowhere else. The result is read again, and where it does not mean the edited scene, the
//! plain form is taken.

use std::path::Path;

use hairline_document::Description;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

/// Returns the text of a scene file that holds `description`: `original` with the changes, or `plain` where that cannot be.
pub(super) fn kept(original: &str, description: &Description, plain: String) -> String {
    match merged(original, &plain) {
        Some(text) if means(&text, description) => text,
        _ => plain,
    }
}

fn means(text: &str, description: &Description) -> bool {
    Description::from_toml(text, Path::new("saved")).is_ok_and(|read| read == *description)
}

fn merged(original: &str, plain: &str) -> Option<String> {
    let before = Description::from_toml(original, Path::new("original")).ok()?;
    let before: DocumentMut = before.to_toml().ok()?.parse().ok()?;
    let after: DocumentMut = plain.parse().ok()?;
    let mut text: DocumentMut = original.parse().ok()?;
    merge(text.as_table_mut(), before.as_table(), after.as_table());
    Some(text.to_string())
}

/// Changes `text`, which means `before`, to mean `after`.
fn merge(text: &mut Table, before: &Table, after: &Table) {
    for (key, wanted) in after {
        let had = before.get(key);
        if had.is_some_and(|had| same(had, wanted)) {
            continue;
        }
        match (text.get_mut(key), had, wanted) {
            (Some(Item::Table(text)), Some(Item::Table(before)), Item::Table(after)) => {
                merge(text, before, after);
            }
            (
                Some(Item::ArrayOfTables(text)),
                Some(Item::ArrayOfTables(before)),
                Item::ArrayOfTables(after),
            ) if text.len() == before.len() => merge_parts(text, before, after),
            (Some(Item::Value(text)), _, Item::Value(after)) => {
                let decor = text.decor().clone();
                *text = after.clone();
                *text.decor_mut() = decor;
            }
            _ => {
                text.insert(key, unplaced(wanted));
            }
        }
    }
    for (key, _) in before {
        if !after.contains_key(key) {
            text.remove(key);
        }
    }
}

/// Merges a list of objects, layers, lights or materials, some of which may be new, gone or in another order.
fn merge_parts(text: &mut ArrayOfTables, before: &ArrayOfTables, after: &ArrayOfTables) {
    let matches = matches(before, after);
    let first = text.get(0).and_then(Table::position);
    let known: Vec<usize> = matches.iter().flatten().copied().collect();
    let in_order = known.is_sorted();
    let mut parts = Vec::new();
    for (after, known) in after.iter().zip(matches) {
        let old = known.and_then(|i| Some((text.get(i)?.clone(), before.get(i)?)));
        let mut part = match old {
            Some((mut part, before)) => {
                merge(&mut part, before, after);
                part
            }
            None => {
                let mut part = after.clone();
                place(&mut part, None);
                // A line between it and what comes before.
                part.decor_mut().set_prefix("\n");
                part
            }
        };
        if !in_order {
            // Parts in one place keep the order of the list.
            place(&mut part, first);
        }
        parts.push(part);
    }
    text.clear();
    for part in parts {
        text.push(part);
    }
}

/// Index before the edit of each part after it: the same one, else that of its name, else, renamed, that of its place. Another thing
/// in its place is new: a comment would describe what is gone.
fn matches(before: &ArrayOfTables, after: &ArrayOfTables) -> Vec<Option<usize>> {
    let mut found: Vec<Option<usize>> = vec![None; after.len()];
    let mut taken = vec![false; before.len()];
    type IndexedTable<'a> = (usize, &'a Table);
    let alike: [fn(IndexedTable<'_>, IndexedTable<'_>) -> bool; 3] = [
        |(_, a), (_, b)| a.to_string() == b.to_string(),
        |(_, a), (_, b)| name(a).is_some() && name(a) == name(b),
        |(i, a), (j, b)| i == j && is_same_thing(a, b),
    ];
    for alike in alike {
        for (j, b) in after.iter().enumerate() {
            let same = |(i, a): &(usize, &Table)| !taken[*i] && alike((*i, *a), (j, b));
            if found[j].is_none()
                && let Some((i, _)) = before.iter().enumerate().find(same)
            {
                taken[i] = true;
                found[j] = Some(i);
            }
        }
    }
    found
}

/// Whether a part may be an edit of another: it is of the same kind, and not all the rest is other than before, its name included.
fn is_same_thing(before: &Table, after: &Table) -> bool {
    let is_kept = |key: &str| match (before.get(key), after.get(key)) {
        (Some(a), Some(b)) => same(a, b),
        (a, b) => a.is_none() && b.is_none(),
    };
    let mut rest = before
        .iter()
        .map(|(key, _)| key)
        .filter(|key| *key != "kind");
    is_kept("kind") && (is_kept("name") || rest.any(is_kept))
}

fn name(part: &Table) -> Option<&str> {
    part.get("name").and_then(Item::as_str)
}

/// Whether two items are the same text; both were written by the same serializer.
fn same(a: &Item, b: &Item) -> bool {
    match (a, b) {
        (Item::ArrayOfTables(a), Item::ArrayOfTables(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_string() == b.to_string())
        }
        (Item::Value(a), Item::Value(b)) => text(a) == text(b),
        _ => a.to_string() == b.to_string(),
    }
}

fn text(value: &Value) -> String {
    value.clone().decorated("", "").to_string()
}

fn unplaced(item: &Item) -> Item {
    let mut item = item.clone();
    match &mut item {
        Item::Table(table) => place(table, None),
        Item::ArrayOfTables(tables) => tables.iter_mut().for_each(|table| place(table, None)),
        Item::Value(_) | Item::None => {}
    }
    item
}

/// Sets the position of a table in the file; none: behind the one before it.
fn place(table: &mut Table, position: Option<isize>) {
    table.set_position(position);
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(inner) => place(inner, position),
            Item::ArrayOfTables(inner) => inner.iter_mut().for_each(|t| place(t, position)),
            Item::Value(_) | Item::None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_document::description::{Layer, Light, LightKind};

    const SCENE: &str = r#"# A plate for the window of the shop.

[camera]
position_m = [0.0, -0.3, 0.3]   # from the door
target_m = [0, 0, 0]
up = [0.0, 0.0, 1.0]

# Blued at the edge.
[[material]]
name = "steel"
kind = "metal"
metal = "steel"

[[object]]
name = "plate"
shape = { disk = { radius_m = 8e-2 } }  # 16 cm
material = "steel"

# What the cloth left.
[[scratches]]
object = "plate"
pattern = "random"
count = 1_000
seed = 1
length_m = 0.02
width_um = { mean = 3.0, spread = 0.2 }   # fine
depth_nm = 200.0

# The lamp
[[light]]
kind = "sphere"
center_m = [0.0, 0.3, 0.3]
radius_m = 0.05
radiance = 9.0

[[light]]   # behind
kind = "sphere"
center_m = [0.0, -0.9, 0.3]
radius_m = 0.05
radiance = 1.0
# The end.
"#;

    fn scene() -> Description {
        Description::from_toml(SCENE, Path::new("test")).unwrap()
    }

    /// Text that is saved after an edit; it must mean the edited scene, and not be the plain form.
    fn saved(edit: impl FnOnce(&mut Description)) -> String {
        let mut edited = scene();
        edit(&mut edited);
        let plain = edited.to_toml().unwrap();
        let text = kept(SCENE, &edited, plain.clone());
        assert!(means(&text, &edited), "{text}");
        assert_ne!(text, plain);
        text
    }

    #[test]
    fn what_is_not_touched_stays_to_the_letter() {
        assert_eq!(saved(|_| {}), SCENE);
        let text = saved(|d| d.camera.exposure_ev = 1.5);
        assert_eq!(text.replace("exposure_ev = 1.5\n", ""), SCENE);
    }

    #[test]
    fn a_changed_number_keeps_its_comment() {
        let text = saved(|d| d.camera.position_m = [0.0, -0.4, 0.3]);
        assert!(
            text.contains("position_m = [0.0, -0.4, 0.3]   # from the door\n"),
            "{text}"
        );
        let text = saved(|d| {
            let Layer::Laid(laid) = &mut d.scratches[0].layer else {
                panic!()
            };
            laid.width_um.mean = 4.5;
        });
        assert!(
            text.contains("mean = 4.5") && text.contains("# fine"),
            "{text}"
        );
        assert!(text.contains("count = 1_000\n"), "{text}");
    }

    #[test]
    fn parts_that_come_go_and_move_leave_the_others_alone() {
        let text = saved(|d| {
            d.lights.remove(0);
        });
        assert!(
            !text.contains("# The lamp") && text.contains("[[light]]   # behind"),
            "{text}"
        );
        assert_eq!(text.matches("[[light]]").count(), 1);
        let text = saved(|d| d.lights.swap(0, 1));
        let (lamp, behind) = (text.find("# The lamp"), text.find("# behind"));
        assert!(behind.is_some() && behind < lamp, "{text}");
        let text = saved(|d| {
            let mut more = d.scratches[0].clone();
            more.name = Some("more".into());
            d.scratches.push(more);
        });
        assert_eq!(text.matches("[[scratches]]").count(), 2);
        assert!(text.contains("# What the cloth left."), "{text}");
        let text = saved(|d| d.materials[0].name = "blue".into());
        assert!(
            text.contains("# Blued at the edge.\n[[material]]\nname = \"blue\""),
            "{text}"
        );
    }

    /// As by lights for the scratches, which replace all: another name and another kind, or another name and all other values.
    #[test]
    fn a_comment_goes_with_what_it_describes() {
        for kind in [
            LightKind::Disk {
                center_m: [0.0, 0.3, 0.3],
                target_m: [0.0; 3],
                radius_m: 0.05,
                two_sided: false,
            },
            LightKind::sphere([0.1, 0.2, 0.3], 0.02),
        ] {
            let text = saved(|d| {
                d.lights[0] = Light {
                    name: Some("lamp".to_owned()),
                    radiance: 100.0,
                    color: [1.0, 0.9, 0.8],
                    ..Light::new(kind)
                }
            });
            assert!(!text.contains("# The lamp"), "{text}");
            assert!(
                text.contains("# behind") && text.contains("# The end."),
                "{text}"
            );
        }
        // Moved and dimmed it is still the same lamp.
        let text = saved(|d| {
            d.lights[0].kind = LightKind::sphere([0.1, 0.2, 0.3], 0.02);
            d.lights[0].radiance = 2.0;
        });
        assert!(text.contains("# The lamp\n[[light]]"), "{text}");
    }

    #[test]
    fn a_text_that_means_something_else_is_not_kept() {
        let edited = scene();
        let plain = edited.to_toml().unwrap();
        assert_eq!(kept("no scene", &edited, plain.clone()), plain);
        // Merging into another scene's text is noticed by what the result means.
        assert!(!means(&SCENE.replace("0.3, 0.3]", "0.3, 0.4]"), &edited));
    }
}
