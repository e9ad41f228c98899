//! KTX2 images that Basis Universal packs (KHR_texture_basisu): ETC1S and UASTC. The crate basisu unpacks them; what it takes for granted of
//! a file is checked here.

use basisu::{DecodeFlags, SourceFormat, TargetFormat, Transcoder};

/// First bytes of files of this version, and of the older version.
const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
const ANY_MAGIC: &[u8] = b"\xabKTX ";
/// Schemes that pack the packed texels again.
const BASIS_LZ: u32 = 1;
const ZSTANDARD: u32 = 2;
/// Bytes of a UASTC block of 4 x 4 texels.
const BLOCK_BYTES: u64 = 16;

pub(crate) fn is_ktx(bytes: &[u8]) -> bool {
    bytes.starts_with(ANY_MAGIC)
}

/// Reason why an image is not read.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Broken(String);

/// The size of the first level; at most `largest_px` a side.
pub(crate) fn size_px(bytes: &[u8], largest_px: u32) -> Result<[u32; 2], Broken> {
    Head(bytes).check(largest_px)
}

/// Texels of the first level, row by row from the top. The file must have passed the check of its size.
pub(crate) fn texels(bytes: &[u8]) -> Result<Vec<[u8; 4]>, Broken> {
    let broken = |_| Broken("what it packs is broken".to_owned());
    let packed = Transcoder::new(bytes).map_err(broken)?;
    let is_known = matches!(
        packed.source_format(),
        SourceFormat::Etc1s | SourceFormat::UastcLdr
    );
    if !is_known || packed.is_video() {
        let found = "it is packed as neither ETC1S nor UASTC";
        return Err(Broken(found.to_owned()));
    }
    let unpacked = packed.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE);
    Ok(unpacked.map_err(broken)?.as_chunks().0.to_vec())
}

/// The numbers that a file begins with.
struct Head<'a>(&'a [u8]);

impl Head<'_> {
    fn u32(&self, at: usize) -> Result<u32, Broken> {
        let four = self.0.get(at..).and_then(|rest| rest.first_chunk());
        let cut_off = || Broken("it is cut off".to_owned());
        four.map(|four| u32::from_le_bytes(*four))
            .ok_or_else(cut_off)
    }

    /// A length or an offset: no more than there are bytes.
    fn length(&self, at: usize) -> Result<usize, Broken> {
        let (low, high) = (self.u32(at)?, self.u32(at + 4)?);
        self.checked_length(u64::from(high) << 32 | u64::from(low))
    }

    fn checked_length(&self, length: u64) -> Result<usize, Broken> {
        if length > self.0.len() as u64 {
            return Err(Broken("it is cut off".to_owned()));
        }
        Ok(length as usize)
    }

    /// Checks that the file is one flat image and that all its ranges lie within it, and returns the image's size.
    fn check(&self, largest_px: u32) -> Result<[u32; 2], Broken> {
        let refused = |found: String| Err(Broken(found));
        if !self.0.starts_with(MAGIC) {
            return refused("it is no KTX file of version 2".to_owned());
        }
        let vulkan_format = self.u32(12)?;
        if vulkan_format != 0 {
            return refused(format!(
                "its format is number {vulkan_format} of Vulkan, not of Basis Universal"
            ));
        }
        let size_px = [self.u32(20)?, self.u32(24)?];
        let [depth, layers, faces, levels] = [28, 32, 36, 40].map(|at| self.u32(at));
        if depth? > 0 || layers? > 1 || faces? != 1 || size_px.contains(&0) {
            return refused("it is not one flat image".to_owned());
        }
        if size_px.iter().any(|size| *size > largest_px) {
            return refused(format!(
                "it has {} x {} texels, and {largest_px} a side are the most",
                size_px[0], size_px[1]
            ));
        }
        // The description of the texels, keys and values, and what all levels share.
        for at in [48, 52, 56, 60] {
            self.checked_length(self.u32(at)?.into())?;
        }
        let (shared, _) = (self.length(64)?, self.length(72)?);
        let levels = levels?.clamp(1, 32) as usize;
        for level in 0..levels {
            let at = 80 + 24 * level;
            self.length(at)?;
            self.length(at + 8)?;
        }
        let scheme = self.u32(44)?;
        if scheme == BASIS_LZ {
            // Ranges of the endpoints, the selectors and the tables, then of the slices of each level.
            for at in [4, 8, 12] {
                self.checked_length(self.u32(shared + at)?.into())?;
            }
            for slice in (0..levels).map(|level| shared + 20 + 20 * level) {
                for at in [4, 8, 12, 16] {
                    self.checked_length(self.u32(slice + at)?.into())?;
                }
            }
        }
        if scheme == ZSTANDARD {
            let [across, down] = size_px.map(|size| u64::from(size.div_ceil(4)));
            let (low, high) = (self.u32(96)?, self.u32(100)?);
            if u64::from(high) << 32 | u64::from(low) != BLOCK_BYTES * across * down {
                return refused("its first level is not as long as its size says".to_owned());
            }
        }
        Ok(size_px)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    /// Images that Basis Universal's own program packed, and the texels that it decodes from them.
    macro_rules! images {
        ($($name:literal)*) => {
            [$((
                $name,
                include_bytes!(concat!("../../document/tests/document/images/", $name, ".ktx2")).as_slice(),
                include_bytes!(concat!("../../document/tests/document/images/", $name, ".png")).as_slice(),
            )),*]
        };
    }
    const IMAGES: [(&str, &[u8], &[u8]); 3] = images!("etc1s" "opaque_etc1s" "uastc_zstd");

    fn decode(bytes: &[u8]) -> Result<([u32; 2], Vec<[u8; 4]>), Broken> {
        Ok((size_px(bytes, 16_384)?, texels(bytes)?))
    }

    #[test]
    fn texels_are_those_of_the_program_that_packed_them() {
        for (name, packed, unpacked) in IMAGES {
            let (size_px, texels) = decode(packed).unwrap();
            let expected = image::load_from_memory(unpacked).unwrap().into_rgba8();
            assert_eq!(size_px, [20, 12]);
            let expected: Vec<_> = expected.pixels().map(|pixel| pixel.0).collect();
            assert_eq!(texels, expected, "{name}");
        }
    }

    #[test]
    fn broken_files_are_told_of() {
        let told = |change: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = IMAGES[2].1.to_vec();
            change(&mut bytes);
            match decode(&bytes) {
                Ok(_) => panic!("it was read"),
                Err(error) => error.to_string(),
            }
        };
        assert_eq!(told(&|it| it[6] = b'1'), "it is no KTX file of version 2");
        assert!(told(&|it| it[12] = 37).contains("number 37 of Vulkan"));
        assert!(told(&|it| it[36] = 6).contains("not one flat image"));
        assert!(told(&|it| it[23] = 1).contains("16384 a side are the most"));
        assert!(told(&|it| it.truncate(150)).contains("cut off"));
        assert!(told(&|it| it.truncate(14)).contains("cut off"));
        assert!(told(&|it| it[21] = 0x3f).contains("not as long as its size says"));
        assert!(told(&|it| it[80 + 7] = 1).contains("cut off"));
    }

    #[test]
    fn nothing_makes_it_panic() {
        let mut random = Pcg64::seed_from_u64(5);
        let (mut read, mut refused) = (0, 0);
        for (_, packed, _) in IMAGES {
            for _ in 0..4000 {
                let mut bytes = packed.to_vec();
                for _ in 0..random.random_range(1..4) {
                    let at = random.random_range(0..bytes.len());
                    bytes[at] = random.random();
                }
                if random.random_range(0..8) == 0 {
                    bytes.truncate(random.random_range(0..bytes.len()));
                }
                match decode(&bytes) {
                    Ok(_) => read += 1,
                    Err(_) => refused += 1,
                }
            }
        }
        assert!(read > 1000 && refused > 1000, "{read} {refused}");
    }
}
