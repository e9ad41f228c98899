//! Pictures of the repository, smaller for a page.

use std::path::Path;

use anyhow::Context;
use image::imageops::FilterType;

/// A picture as a JPEG that is not wider than `width`.
pub(super) fn thumbnail(from: &Path, to: &Path, width: u32) -> anyhow::Result<()> {
    let picture = image::open(from).with_context(|| from.display().to_string())?;
    let small = picture.resize(width, u32::MAX, FilterType::Lanczos3);
    small.to_rgb8().save(to)?;
    Ok(())
}
