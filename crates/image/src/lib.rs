//! Linear images with the layers of a render, EXR and PNG files, tone mapping, and metrics to compare images by.
//!
//! Colours are linear Rec.709 in `f32` until [`png`] encodes them for a display; rows run from the top.
//!
//! ```
//! use hairline_image::{Display, Picture, png};
//!
//! let mut picture = Picture::new([2, 1]);
//! picture.rgb[1] = [1000.0; 3];
//! // Black stays black; what is too bright for the display is white.
//! assert_eq!(png::quantize(&picture, &Display::default()), [0, 0, 0, 255, 255, 255]);
//! ```

#![warn(unreachable_pub)]

mod animation;
mod backdrop;
mod bands;
mod batches;
pub mod cryptomatte;
mod disk;
mod error;
pub mod exr_file;
mod file_path;
mod files;
mod film;
pub mod filter;
mod layers;
mod listed;
mod memory;
pub mod metrics;
mod mp4;
pub mod output;
pub mod png;
mod primaries;
pub mod shown;
mod temporary;
pub mod tone_map;
mod traced;

pub use animation::{Animation, FPS, FPS_MAX, check_sequence};
pub use backdrop::Backdrop;
pub use bands::BandImage;
pub use batches::{BATCH_SAMPLES, Batch, Batches, add_batch};
pub use disk::Disk;
pub use error::Error;
pub use exr_file::Notes;
pub use file_path::FilePath;
pub use files::{Facts, FileType, Files, Source};
pub use film::{Image, Layer, Noise, Picture};
pub use filter::filter_traced;
pub use layers::{HeldLayer, Layers, Referred};
pub use memory::Memory;
pub use output::{Format, Output};
pub use png::Finish;
pub use primaries::{Primaries, ToRec709, in_gamut};
pub use tone_map::{Display, ToneMap};
pub use traced::{Traced, TracedLight, TracedPixel};
