//! Every optics function against its shader twin, over tables of inputs that hold the awkward ones.

mod band;
mod never_nan;
mod scratch;
mod twin;
