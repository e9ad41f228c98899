//! Rows of a picture, taken out and put back.

use hairline_image::{Image, Noise};

/// Some rows of a picture.
pub(crate) fn of(image: &Image, first: usize, end: usize) -> Image {
    let width = image.size_px[0] as usize;
    let own = first * width..end * width;
    let noise = image.noise.as_ref().map(|noise| Noise {
        beauty: noise.beauty[own.clone()].to_vec(),
        base: noise.base[own.clone()].to_vec(),
        scratches: noise.scratches[own.clone()].to_vec(),
        density: noise.density[own.clone()].to_vec(),
        samples: noise.samples[own.clone()].to_vec(),
        batch: noise.batch,
    });
    Image {
        size_px: [image.size_px[0], (end - first) as u32],
        base: image.base[own.clone()].to_vec(),
        scratches: image.scratches[own.clone()].to_vec(),
        density: image.density[own.clone()].to_vec(),
        depth_m: image.depth_m[own.clone()].to_vec(),
        normal: image.normal[own].to_vec(),
        noise,
    }
}

/// Puts rows of a picture over those from `first` on. Both have noise, or none.
pub(crate) fn put(image: &mut Image, first: usize, rows: &Image) {
    let start = first * image.size_px[0] as usize;
    let own = start..start + rows.depth_m.len();
    image.base[own.clone()].copy_from_slice(&rows.base);
    image.scratches[own.clone()].copy_from_slice(&rows.scratches);
    image.density[own.clone()].copy_from_slice(&rows.density);
    image.depth_m[own.clone()].copy_from_slice(&rows.depth_m);
    image.normal[own.clone()].copy_from_slice(&rows.normal);
    if let (Some(noise), Some(more)) = (&mut image.noise, &rows.noise) {
        noise.beauty[own.clone()].copy_from_slice(&more.beauty);
        noise.base[own.clone()].copy_from_slice(&more.base);
        noise.scratches[own.clone()].copy_from_slice(&more.scratches);
        noise.density[own.clone()].copy_from_slice(&more.density);
        noise.samples[own].copy_from_slice(&more.samples);
    }
}
