//! Archives whose bytes follow from what is in them and from the commit: twice the same, wherever they are made.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use flate2::read::GzDecoder;
use flate2::{Compression, GzBuilder};
use tar::{Archive, Builder, EntryType, Header, HeaderMode};

/// The time of all files in archives, in seconds: `SOURCE_DATE_EPOCH`, or that of the last commit. Without git it is the first that a zip can tell.
pub fn time(root: &Path) -> anyhow::Result<u64> {
    if let Ok(text) = std::env::var("SOURCE_DATE_EPOCH") {
        return text.parse().context("SOURCE_DATE_EPOCH");
    }
    let asked = Command::new("git")
        .current_dir(root)
        .args(["log", "-1", "--format=%ct"])
        .output();
    let answer = asked.ok().filter(|it| it.status.success());
    Ok(match answer {
        Some(it) => String::from_utf8(it.stdout)?.trim().parse()?,
        None => 315_532_800,
    })
}

/// Packs a folder, under its own name, into a compressed archive. Returns the number of its files.
pub fn pack(folder: &Path, archive: &Path, time: u64) -> anyhow::Result<usize> {
    let name = folder.file_name().context("a folder without a name")?;
    let gzip = GzBuilder::new()
        .mtime(0)
        .write(File::create(archive)?, Compression::best());
    let mut tar = Builder::new(gzip);
    let files = files(folder)?;
    ensure!(!files.is_empty(), "{} has no files", folder.display());
    for file in &files {
        let path = folder.join(file);
        let mut header = Header::new_gnu();
        header.set_metadata_in_mode(&fs::metadata(&path)?, HeaderMode::Deterministic);
        header.set_entry_type(EntryType::Regular);
        header.set_mtime(time);
        let content = File::open(&path).with_context(|| path.display().to_string())?;
        tar.append_data(&mut header, Path::new(name).join(file), content)?;
    }
    tar.into_inner()?.finish()?.flush()?;
    Ok(files.len())
}

/// Unpacks what [`pack`] made into a folder.
pub fn unpack(archive: &Path, folder: &Path) -> anyhow::Result<()> {
    let file = File::open(archive).with_context(|| archive.display().to_string())?;
    fs::create_dir_all(folder)?;
    Ok(Archive::new(GzDecoder::new(file)).unpack(folder)?)
}

/// The files of a folder and of those in it, sorted.
pub fn files(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(inner) = folders.pop() {
        let read = fs::read_dir(folder.join(&inner));
        for entry in read.with_context(|| folder.display().to_string())? {
            let entry = entry?;
            let path = inner.join(entry.file_name());
            let list = if entry.path().is_dir() {
                &mut folders
            } else {
                &mut found
            };
            list.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Copies a file, or a folder with all its contents.
pub fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    let each = if from.is_dir() {
        files(from)?
    } else {
        vec![PathBuf::new()]
    };
    for file in each {
        let (from, to) = match file.as_os_str().is_empty() {
            true => (from.to_owned(), to.to_owned()),
            false => (from.join(&file), to.join(&file)),
        };
        fs::create_dir_all(to.parent().context("a file without a folder")?)?;
        fs::copy(&from, &to).with_context(|| from.display().to_string())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn archives_of_the_same_files_are_the_same() {
        let scratch = tempfile::tempdir().unwrap();
        let packed = |which: &str, names: [&str; 3]| {
            let folder = scratch.path().join(which).join("it");
            for name in names {
                let path = folder.join(name);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, name).unwrap();
            }
            let archive = scratch.path().join(which).join("it.tar.gz");
            assert_eq!(pack(&folder, &archive, 1_000_000_000).unwrap(), 3);
            fs::read(archive).unwrap()
        };
        let first = packed("a", ["b.txt", "inner/a.txt", "a.txt"]);
        std::thread::sleep(std::time::Duration::from_millis(1100));
        let second = packed("b", ["inner/a.txt", "a.txt", "b.txt"]);
        assert!(first == second);
    }
}
