//! Rigorous efficiencies of the fine gratings of scenes. They take seconds to compute: a process makes each once, and the next one finds it in the
//! user's folder for such things.

use crate::folders::cache_dir;
use crate::grating::Grating;
use crate::scene::{Base, Material};
use hairline_image::output::write_atomically;
use hairline_optics::cover::Cover;
use hairline_optics::grating::Grating as Row;
use hairline_optics::metal::Metal;
use hairline_optics::rigorous::{Efficiencies, FineGrooves, Medium};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Gratings of a smaller pitch have rigorous efficiencies. Grooves of 2 um and more send what the scalar ones say, within 3 %.
pub const FINE_PITCH_UM: f64 = 4.0;

/// Part of the files' names: a change of the numbers that a file would hold takes the next one.
const VERSION: u32 = 1;
/// Files are deleted, the oldest first, where there are more.
const MOST_FILES: usize = 200;
/// Efficiencies that a process keeps.
const MOST_KEPT: usize = 32;

/// The grooves of a grating in a material, if they are fine and the material has an index. Of a metal that is given by a colour it is aluminium's.
pub(crate) fn fine_grooves(grating: &Grating, material: &Material) -> Option<FineGrooves> {
    let medium = match material.base {
        _ if material.coat.is_some() => None,
        Base::Mirror => None,
        Base::Metal(metal) | Base::Covered { metal, .. } => Some(Medium::Metal(metal)),
        Base::ColoredMetal { .. } => Some(Medium::Metal(Metal::Aluminium)),
        Base::Dielectric { ior, .. } => Some(Medium::Dielectric(ior)),
        Base::MetallicRoughness { metallic, .. } if metallic >= 0.5 => {
            Some(Medium::Metal(Metal::Aluminium))
        }
        Base::MetallicRoughness { .. } => {
            let root = material.dielectric_f0.sqrt();
            Some(Medium::Dielectric((1.0 + root) / (1.0 - root)))
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

/// The efficiencies of grooves, computed or kept from before: seconds. None where `cancelled` says so, which is asked from any thread.
pub fn efficiencies(
    grooves: &FineGrooves,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Arc<Efficiencies>> {
    static KEPT: Mutex<Vec<(FineGrooves, Arc<Efficiencies>)>> = Mutex::new(Vec::new());
    let kept = || KEPT.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if let Some((_, known)) = kept().iter().find(|(of, _)| of == grooves) {
        return Some(Arc::clone(known));
    }
    let file = cache_dir().map(|folder| file(&folder, grooves));
    let read = file.as_deref().and_then(|file| read(file, grooves));
    let found = match read {
        Some(found) => found,
        None => {
            let found = Efficiencies::new(grooves, cancelled)?;
            // Without the file they are computed anew: no reason to fail.
            let _ = file.map(|file| write(&file, &found));
            found
        }
    };
    let found = Arc::new(found);
    let mut kept = kept();
    if kept.len() == MOST_KEPT {
        kept.remove(0);
    }
    kept.push((*grooves, Arc::clone(&found)));
    Some(found)
}

fn file(folder: &Path, grooves: &FineGrooves) -> PathBuf {
    let FineGrooves {
        pitch_um,
        width_um,
        depth_nm,
        above,
        medium,
    } = grooves;
    let medium = match medium {
        Medium::Metal(metal) => format!("{metal:?}"),
        Medium::Dielectric(ior) => ior.to_string(),
    };
    let name = format!("{VERSION}-{pitch_um}-{width_um}-{depth_nm}-{above}-{medium}.f32");
    folder.join("gratings").join(name)
}

fn read(file: &Path, grooves: &FineGrooves) -> Option<Efficiencies> {
    let bytes = fs::read(file).ok()?;
    let (values, []) = bytes.as_chunks() else {
        return None;
    };
    Efficiencies::from_values(
        grooves,
        values.iter().map(|bytes| f32::from_le_bytes(*bytes)),
    )
}

fn write(file: &Path, efficiencies: &Efficiencies) -> Result<(), hairline_image::Error> {
    let folder = file.parent().unwrap_or(file);
    let _ = fs::create_dir_all(folder);
    let aged = |entry: fs::DirEntry| Some((entry.metadata().ok()?.modified().ok()?, entry.path()));
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = files.filter_map(aged).collect();
    files.sort();
    for (_, old) in files.iter().rev().skip(MOST_FILES - 1) {
        let _ = fs::remove_file(old);
    }
    let bytes: Vec<u8> = efficiencies.values().flat_map(f32::to_le_bytes).collect();
    write_atomically(file, &bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_in_a_file_comes_back_and_another_gratings_does_not() {
        let grooves = FineGrooves {
            pitch_um: 0.3,
            width_um: 0.1,
            depth_nm: 50.0,
            above: 1.0,
            medium: Medium::Metal(Metal::Gold),
        };
        let folder = tempfile::tempdir().unwrap();
        let file = file(folder.path(), &grooves);
        assert!(read(&file, &grooves).is_none());
        let found = Efficiencies::new(&grooves, &|| false).unwrap();
        write(&file, &found).unwrap();
        let again = read(&file, &grooves).unwrap();
        assert!(
            again
                .values()
                .map(f32::to_bits)
                .eq(found.values().map(f32::to_bits))
        );
        let wider = FineGrooves {
            pitch_um: 0.6,
            ..grooves
        };
        assert!(read(&file, &wider).is_none());
        assert!(Efficiencies::new(&grooves, &|| true).is_none());
    }
}
