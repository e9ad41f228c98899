//! A zip archive as Pixar's *Usdz File Format Specification* asks: its files are stored, and each begins at a multiple of 64 bytes, so that readers may map
//! it. Own code: no crate of the workspace writes zip archives, and without packing they are headers alone.

/// Files begin at multiples of this.
const ALIGNMENT: usize = 64;
/// Header of an extra field that fills up: its number, which Pixar's writer has too, and its length.
const FILLER_HEADER: usize = 4;
const FILLER: u16 = 0x1986;
/// The version of zip that knows stored files.
const VERSION: u16 = 10;
/// The first day that a zip archive can name: one scene makes one file.
const DAY: u16 = 1 << 5 | 1;

/// An archive of files by their names.
pub(super) fn packed(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, String> {
    let (mut archive, mut list) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let offset = number(archive.len())?;
        let entry = entry(name, bytes)?;
        let filler = filler(archive.len() + 4 + entry.len() + 2 + name.len());
        archive.extend(b"PK\x03\x04");
        archive.extend(&entry);
        archive.extend((filler.len() as u16).to_le_bytes());
        archive.extend(name.as_bytes());
        archive.extend(filler);
        archive.extend(bytes);

        list.extend(b"PK\x01\x02");
        list.extend(VERSION.to_le_bytes());
        list.extend(&entry);
        // No extra field, no comment, the first disk, no attributes.
        list.extend([0; 12]);
        list.extend(offset.to_le_bytes());
        list.extend(name.as_bytes());
    }
    let (offset, length) = (number(archive.len())?, number(list.len())?);
    archive.extend(list);
    archive.extend(b"PK\x05\x06\0\0\0\0");
    let count = (files.len() as u16).to_le_bytes();
    archive.extend([count, count].as_flattened());
    archive.extend(length.to_le_bytes());
    archive.extend(offset.to_le_bytes());
    archive.extend([0; 2]);
    Ok(archive)
}

/// What both headers of a file say, from its version to the length of its name.
fn entry(name: &str, bytes: &[u8]) -> Result<Vec<u8>, String> {
    let length = number(bytes.len())?;
    let mut entry = Vec::new();
    // No flags, stored, midnight.
    for it in [VERSION, 0, 0, 0, DAY] {
        entry.extend(it.to_le_bytes());
    }
    for it in [crc32fast::hash(bytes), length, length] {
        entry.extend(it.to_le_bytes());
    }
    entry.extend((name.len() as u16).to_le_bytes());
    Ok(entry)
}

/// An extra field that ends at a multiple of the alignment.
fn filler(start: usize) -> Vec<u8> {
    let mut length = start.next_multiple_of(ALIGNMENT) - start;
    if length == 0 {
        return Vec::new();
    }
    if length < FILLER_HEADER {
        length += ALIGNMENT;
    }
    let mut filler = FILLER.to_le_bytes().to_vec();
    filler.extend(((length - FILLER_HEADER) as u16).to_le_bytes());
    filler.resize(length, 0);
    filler
}

fn number(length: usize) -> Result<u32, String> {
    u32::try_from(length)
        .map_err(|_| "it would be larger than 4 GiB, which a .usdz cannot be".to_owned())
}
