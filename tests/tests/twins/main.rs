//! Every optics function against its shader twin, over tables of inputs that hold the awkward ones.

mod band;
mod lobes;
mod never_nan;
mod scratch;
mod surface;
mod twin;
