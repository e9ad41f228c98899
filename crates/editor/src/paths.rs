//! Paths inside a scene file, which are relative to its folder.

use std::collections::VecDeque;
use std::path::{Component, Path, PathBuf};

/// `path` as a scene file in `base_dir` would write it. Both are absolute and `base_dir` has no `..` and no symbolic links;
/// those in `path` stay. Absolute where the two have no root in common.
pub(crate) fn relative_to(path: &Path, base_dir: &Path) -> PathBuf {
    let mut own: VecDeque<Component> = path.components().collect();
    let mut base: VecDeque<Component> = base_dir.components().collect();
    let mut shared = 0;
    while let (Some(a), Some(b)) = (own.front(), base.front())
        && a == b
    {
        own.pop_front();
        base.pop_front();
        shared += 1;
    }
    if shared == 0 || base.iter().any(|c| !matches!(c, Component::Normal(_))) {
        return path.to_owned();
    }
    let up = base.iter().map(|_| Component::ParentDir.as_os_str());
    let mut relative = PathBuf::new();
    for part in up.chain(own.iter().map(|c| c.as_os_str())) {
        // A scene file means the same on every system, so its own separator.
        match relative.as_os_str().is_empty() {
            true => relative.push(part),
            false => {
                let text = relative.as_mut_os_string();
                text.push("/");
                text.push(part);
            }
        }
    }
    relative
}

/// A relative `path` that was written for `from_dir`, for `to_dir`; both folders are absolute, without `..` and symbolic
/// links. Absolute paths stay.
pub(crate) fn rebase(path: &Path, from_dir: &Path, to_dir: &Path) -> PathBuf {
    if path.is_absolute() || path.has_root() || from_dir == to_dir {
        return path.to_owned();
    }
    // `..` at the start leads out of a folder without links, so it can be resolved here; one behind a name cannot, since the
    // name may be a link.
    let mut full = from_dir.to_owned();
    let mut parts = path.components().peekable();
    while let Some(Component::ParentDir | Component::CurDir) = parts.peek() {
        if parts.next() == Some(Component::ParentDir) {
            full.pop();
        }
    }
    full.extend(parts);
    relative_to(&full, to_dir)
}

/// A file that an artist chose, as a scene in `base_dir` writes it: relative, where both are known in full.
pub(crate) fn written(file: &Path, base_dir: &Path) -> PathBuf {
    match file.is_absolute() {
        true => relative_to(file, &absolute(base_dir)),
        false => file.to_owned(),
    }
}

/// A folder's full name without `..` and links; as well as can be, where it does not exist.
pub(crate) fn absolute(folder: &Path) -> PathBuf {
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    folder
        .canonicalize()
        .or_else(|_| std::path::absolute(folder))
        .unwrap_or_else(|_| folder.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rebased_paths_lead_to_the_same_file() {
        for (path, from, to, expected) in [
            ("pan.glb", "/a/b", "/a/b", "pan.glb"),
            ("pan.glb", "/a/b", "/a", "b/pan.glb"),
            ("pan.glb", "/a", "/a/b/c", "../../pan.glb"),
            ("../m/pan.glb", "/a/b", "/a/m", "pan.glb"),
            ("../../pan.glb", "/a/b", "/c/d", "../../pan.glb"),
            ("m/../pan.glb", "/a/b", "/a/m", "../b/m/../pan.glb"),
            ("./pan.glb", "/a/b", "/a/c", "../b/pan.glb"),
            ("/x/pan.glb", "/a/b", "/a/c", "/x/pan.glb"),
        ] {
            let got = rebase(Path::new(path), Path::new(from), Path::new(to));
            assert_eq!(got, Path::new(expected), "{path} from {from} to {to}");
        }
    }

    #[test]
    fn without_a_common_root_a_path_stays_absolute() {
        let path = Path::new("/a/pan.glb");
        assert_eq!(relative_to(path, Path::new("elsewhere")), path);
    }
}
