//! Pictures in parts: strips put together, and their transfer between processes.

use hairline_image::{Display, Image, Noise, Notes};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors;
use crate::image::Image as Picture;
use crate::names::tone_map;

/// Puts strips of one picture together, from the top.
#[pyfunction]
pub(crate) fn assemble(strips: Vec<Bound<'_, Picture>>) -> PyResult<Picture> {
    let wrong = |found: &str| {
        let right = "must be strips of one picture, from the top";
        Err(errors::of_argument("strips", found, right))
    };
    let Some(first) = strips.first().map(Bound::get) else {
        return wrong("found none");
    };
    let width = first.image().size_px[0];
    let batch = |image: &Image| image.noise.as_ref().map(|noise| noise.batch);
    let mut height = 0;
    for strip in &strips {
        let strip = strip.get();
        if strip.image().size_px[0] != width {
            return wrong("found another width");
        }
        if strip.notes() != first.notes() || batch(strip.image()) != batch(first.image()) {
            return wrong("found a strip of another picture");
        }
        height += strip.image().size_px[1];
    }
    let mut image = Image::new([width, height]);
    image.noise = batch(first.image()).map(|batch| Noise::new(image.size_px, batch));
    let mut row = 0;
    for strip in &strips {
        let strip = strip.get().image();
        put(&mut image, row, strip);
        row += strip.size_px[1] as usize;
    }
    let is_complete = strips.iter().all(|strip| strip.get().is_whole());
    let notes = first.notes().clone();
    Ok(Picture::new(image, *first.shown(), notes, is_complete))
}

/// Copies rows into a picture from row `first` on. Either both have noise or neither has. References have
/// no alpha.
fn put(image: &mut Image, first: usize, rows: &Image) {
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

/// All that a picture is, in the order of [`picture_from_state`]'s arguments.
type State<'py> = (
    [u32; 2],
    Bound<'py, PyBytes>,
    Option<(u32, Bound<'py, PyBytes>)>,
    (f64, &'static str),
    Notes,
    bool,
);

#[pyfunction]
pub(crate) fn picture_state<'py>(picture: &Bound<'py, Picture>) -> State<'py> {
    let py = picture.py();
    let picture = picture.get();
    let image = picture.image();
    let mut layers: Vec<u8> = Vec::with_capacity(image.depth_m.len() * 52);
    for layer in [&image.base, &image.scratches, &image.density, &image.normal] {
        layers.extend_from_slice(bytemuck::cast_slice(layer));
    }
    layers.extend_from_slice(bytemuck::cast_slice(&image.depth_m));
    if let Some(alpha) = &image.alpha {
        layers.extend_from_slice(bytemuck::cast_slice(alpha));
    }
    let noise = image.noise.as_ref().map(|noise| {
        let mut bytes: Vec<u8> = Vec::with_capacity(noise.samples.len() * 52);
        for layer in [&noise.beauty, &noise.base, &noise.scratches, &noise.density] {
            bytes.extend_from_slice(bytemuck::cast_slice(layer));
        }
        bytes.extend_from_slice(bytemuck::cast_slice(&noise.samples));
        (noise.batch, PyBytes::new(py, &bytes))
    });
    let shown = picture.shown();
    (
        image.size_px,
        PyBytes::new(py, &layers),
        noise,
        (shown.exposure_ev, shown.tone_map.name()),
        picture.notes().clone(),
        picture.is_whole(),
    )
}

/// Takes values off the front of bytes.
fn take<T: bytemuck::AnyBitPattern>(bytes: &mut &[u8], count: usize) -> PyResult<Vec<T>> {
    let wrong = || errors::of_argument("state", "found too few bytes", "must be a pickled picture");
    let (own, rest) = bytes
        .split_at_checked(count * size_of::<T>())
        .ok_or_else(wrong)?;
    *bytes = rest;
    Ok(own
        .chunks_exact(size_of::<T>())
        .map(bytemuck::pod_read_unaligned)
        .collect())
}

/// Makes a picture of the values from [`picture_state`].
#[pyfunction]
pub(crate) fn picture_from_state(
    size_px: [u32; 2],
    layers: &[u8],
    noise: Option<(u32, Vec<u8>)>,
    display: (f64, String),
    notes: Notes,
    is_complete: bool,
) -> PyResult<Picture> {
    let count = size_px[0] as usize * size_px[1] as usize;
    let mut bytes = layers;
    let noise = noise.map(|(batch, bytes)| {
        let mut bytes = &bytes[..];
        Ok::<_, PyErr>(Noise {
            beauty: take(&mut bytes, count)?,
            base: take(&mut bytes, count)?,
            scratches: take(&mut bytes, count)?,
            density: take(&mut bytes, count)?,
            samples: take(&mut bytes, count)?,
            batch,
        })
    });
    let image = Image {
        size_px,
        base: take(&mut bytes, count)?,
        scratches: take(&mut bytes, count)?,
        density: take(&mut bytes, count)?,
        normal: take(&mut bytes, count)?,
        depth_m: take(&mut bytes, count)?,
        // Behind all others, where there is one.
        alpha: match bytes.is_empty() {
            true => None,
            false => Some(take(&mut bytes, count)?),
        },
        noise: noise.transpose()?,
        traced: None,
    };
    let (exposure_ev, curve) = display;
    let display = Display {
        exposure_ev,
        tone_map: tone_map(&curve)?,
    };
    Ok(Picture::new(image, display, notes, is_complete))
}
