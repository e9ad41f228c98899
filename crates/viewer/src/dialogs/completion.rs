//! Completion of a path that is being typed, by the files that are there.

use crate::files::from_home;

/// Largest number of names that are offered.
const MOST: usize = 12;

/// A path as far as it can be completed.
#[derive(Debug, PartialEq)]
pub(super) struct Completion {
    pub text: String,
    /// Names with which it may go on, where there are several.
    pub choices: Vec<String>,
}

/// Completes a path by the names of folders, and of files with one of these endings.
pub(super) fn completion(typed: &str, endings: &[&str]) -> Completion {
    let typed = typed.trim_start();
    let (folder, begun) = match typed.rfind(['/', std::path::MAIN_SEPARATOR]) {
        Some(at) => typed.split_at(at + 1),
        None => ("", typed),
    };
    let place = match folder {
        "" => ".".into(),
        folder => from_home(folder),
    };
    let entries = std::fs::read_dir(place).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let path = entry.path();
            let ending = path.extension().unwrap_or_default().to_string_lossy();
            let is_wanted = endings.iter().any(|it| ending.eq_ignore_ascii_case(it));
            // Hidden files are offered to those who type their dot.
            let is_shown = begun.starts_with('.') || !name.starts_with('.');
            match path.is_dir() {
                _ if !name.starts_with(begun) || !is_shown => None,
                true => Some(format!("{name}/")),
                false => is_wanted.then_some(name),
            }
        })
        .collect();
    names.sort_unstable();
    let shared = names.iter().cloned().reduce(|a, b| shared_start(&a, &b));
    let choices = match names.len() {
        ..=1 => Vec::new(),
        _ => names.into_iter().take(MOST).collect(),
    };
    Completion {
        text: format!("{folder}{}", shared.as_deref().unwrap_or(begun)),
        choices,
    }
}

/// The characters with which both names begin.
fn shared_start(a: &str, b: &str) -> String {
    let alike = a.chars().zip(b.chars()).take_while(|(a, b)| a == b);
    alike.map(|(c, _)| c).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_goes_on_as_far_as_there_is_one_way() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["watch.glb", "watch.gltf", "wall.png", ".hidden.glb"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        std::fs::create_dir(folder.path().join("scenes")).unwrap();
        let at = |name: &str| format!("{}/{name}", folder.path().display());
        let completed = |name: &str| completion(&at(name), &["glb", "gltf"]);
        let only = |name: &str| Completion {
            text: at(name),
            choices: Vec::new(),
        };
        // A picture is no model.
        assert_eq!(completed("w").text, at("watch.gl"));
        assert_eq!(completed("w").choices, ["watch.glb", "watch.gltf"]);
        assert_eq!(completed("watch.glt"), only("watch.gltf"));
        assert_eq!(completed("s"), only("scenes/"));
        assert_eq!(completed(".h"), only(".hidden.glb"));
        assert_eq!(completed("none"), only("none"));
        assert_eq!(completed("").choices.len(), 3);
        assert_eq!(
            completion("/no/such/folder/a", &["glb"]).text,
            "/no/such/folder/a"
        );
    }
}
