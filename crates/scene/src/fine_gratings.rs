//! Rigorous efficiencies of the fine gratings of scenes. They take seconds to compute: the next process finds them in the user's folder for such
//! things.

use crate::folders::cache_dir;
use crate::grating::Grating;
use crate::scene::{Base, Material};
use hairline_image::output::write_atomically;
use hairline_optics::cover::Cover;
use hairline_optics::fresnel::dielectric_ior;
use hairline_optics::grating::Grating as Row;
use hairline_optics::metal::Metal;
use hairline_optics::rigorous::{Efficiencies, FineGrooves, Medium};
use std::fs;
use std::path::{Path, PathBuf};

/// Gratings of a smaller pitch have rigorous efficiencies. Grooves of 2 um and more send what the scalar ones say, within 3 %.
pub const FINE_PITCH_UM: f64 = 4.0;

/// Part of the key of files: a change of the numbers that a file would hold takes the next one.
const VERSION: u32 = 3;
/// Files are deleted, the oldest first, where there are more.
const MOST_FILES: usize = 200;

/// The grooves of a grating in a material, if they are fine and the material has an index. Of a metal that is given by a colour it is aluminium's.
pub fn fine_grooves(grating: &Grating, material: &Material) -> Option<FineGrooves> {
    let medium = match &material.base {
        _ if material.coat.is_some() => None,
        Base::Mirror => None,
        Base::Metal(metal) | Base::Covered { metal, .. } => Some(Medium::Metal(metal.clone())),
        Base::ColoredMetal { .. } => Some(Medium::Metal(Metal::Aluminium.into())),
        Base::Dielectric { ior, .. } => Some(Medium::Dielectric(*ior)),
        Base::MetallicRoughness { metallic, .. } if *metallic >= 0.5 => {
            Some(Medium::Metal(Metal::Aluminium.into()))
        }
        Base::MetallicRoughness { .. } => {
            dielectric_ior(material.dielectric_f0).map(Medium::Dielectric)
        }
    };
    let medium = medium.filter(|_| grating.is_rigorous)?;
    fine_row(&grating.row, medium, cover(material).as_ref())
}

/// The grooves of a row whose efficiencies are rigorous, if it is fine. A coat has none over them.
pub fn fine_row(row: &Row, medium: Medium, cover: Option<&Cover>) -> Option<FineGrooves> {
    // The solver has no code that all browsers run.
    let is_known = !cfg!(target_arch = "wasm32");
    (is_known && row.pitch_um < FINE_PITCH_UM).then_some(FineGrooves {
        pitch_um: row.pitch_um,
        width_um: row.width_um,
        depth_nm: row.depth_nm,
        above: cover.map_or(1.0, |cover| cover.ior),
        medium,
    })
}

/// The plate over a material.
pub(crate) fn cover(material: &Material) -> Option<Cover> {
    match material.base {
        Base::Covered { cover, .. } => Some(cover),
        _ => None,
    }
}

/// The efficiencies of grooves, computed in seconds or read from the file of an earlier time. None where `cancelled` says so, which is asked from any
/// thread.
pub fn efficiencies(
    grooves: &FineGrooves,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Efficiencies> {
    let file = cache_dir().map(|folder| CacheFile::new(&folder, grooves));
    let read = file.as_ref().and_then(|file| file.read(grooves));
    if read.is_some() {
        return read;
    }
    let found = Efficiencies::new(grooves, cancelled)?;
    // Without the file they are computed anew: no reason to fail.
    let _ = file.map(|file| file.write(&found));
    Some(found)
}

/// The file that keeps the efficiencies of grooves: a checksum of the key and of the values, and the values.
struct CacheFile {
    path: PathBuf,
    key: String,
}

impl CacheFile {
    fn new(folder: &Path, grooves: &FineGrooves) -> Self {
        let FineGrooves {
            pitch_um,
            width_um,
            depth_nm,
            above,
            medium,
        } = grooves;
        // A metal by measured rows tells them all: too many for a file's name.
        let key = format!("{VERSION} {pitch_um} {width_um} {depth_nm} {above} {medium:?}");
        let name = format!("{}.efficiencies", blake3::hash(key.as_bytes()).to_hex());
        Self {
            path: folder.join("gratings").join(name),
            key,
        }
    }

    fn checksum(&self, values: &[u8]) -> blake3::Hash {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.key.as_bytes()).update(values);
        hasher.finalize()
    }

    /// The values, unless they are not those that were written.
    fn read(&self, grooves: &FineGrooves) -> Option<Efficiencies> {
        let bytes = fs::read(&self.path).ok()?;
        let (checksum, values) = bytes.split_first_chunk::<{ blake3::OUT_LEN }>()?;
        if self.checksum(values) != *checksum {
            return None;
        }
        let (values, _) = values.as_chunks();
        let values = values.iter().map(|bytes| f32::from_le_bytes(*bytes));
        Efficiencies::from_values(grooves, values)
    }

    fn write(&self, efficiencies: &Efficiencies) -> Result<(), hairline_image::Error> {
        let folder = self.path.parent().unwrap_or(&self.path);
        let _ = fs::create_dir_all(folder);
        let aged =
            |entry: fs::DirEntry| Some((entry.metadata().ok()?.modified().ok()?, entry.path()));
        let files = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut files: Vec<_> = files.filter_map(aged).collect();
        files.sort();
        for (_, old) in files.iter().rev().skip(MOST_FILES - 1) {
            let _ = fs::remove_file(old);
        }
        let values: Vec<u8> = efficiencies.values().flat_map(f32::to_le_bytes).collect();
        let mut bytes = self.checksum(&values).as_bytes().to_vec();
        bytes.extend(values);
        write_atomically(&self.path, &bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_optics::metal::MetalIndex;

    #[test]
    fn what_is_kept_in_a_file_comes_back_and_another_gratings_does_not() {
        let grooves = FineGrooves {
            pitch_um: 0.3,
            width_um: 0.1,
            depth_nm: 50.0,
            above: 1.0,
            medium: Medium::Metal(Metal::Gold.into()),
        };
        let folder = tempfile::tempdir().unwrap();
        let file = CacheFile::new(folder.path(), &grooves);
        assert!(file.read(&grooves).is_none());
        let found = Efficiencies::new(&grooves, &|| false).unwrap();
        file.write(&found).unwrap();
        let again = file.read(&grooves).unwrap();
        assert!(
            again
                .values()
                .map(f32::to_bits)
                .eq(found.values().map(f32::to_bits))
        );
        let wider = FineGrooves {
            pitch_um: 0.6,
            ..grooves.clone()
        };
        assert!(CacheFile::new(folder.path(), &wider).read(&wider).is_none());
        let mut bytes = fs::read(&file.path).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(&file.path, bytes).unwrap();
        assert!(file.read(&grooves).is_none(), "one bit is wrong");
        assert!(Efficiencies::new(&grooves, &|| true).is_none());
    }

    /// Of a metal by many measured rows, whose key is longer than any name of a file.
    #[test]
    fn long_tables_of_metals_are_kept_too() {
        let rows: Vec<[f64; 3]> = (0..400)
            .map(|i| [380.0 + f64::from(i), 0.9 + 1e-3 * f64::from(i), 4.5])
            .collect();
        let of = |rows: &[[f64; 3]]| FineGrooves {
            pitch_um: 0.3,
            width_um: 0.1,
            depth_nm: 50.0,
            above: 1.0,
            medium: Medium::Metal(MetalIndex::own(rows)),
        };
        let folder = Path::new("folder");
        let path = CacheFile::new(folder, &of(&rows)).path;
        assert!(path.file_name().unwrap().len() < 100);
        let mut others = rows.clone();
        others[399][2] = 4.6;
        assert!(CacheFile::new(folder, &of(&others)).path != path);
    }
}
