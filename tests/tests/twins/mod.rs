//! Every optics function against its shader twin, over tables of inputs that hold the awkward ones.

mod band;
mod brushed;
mod draws;
mod four_edges;
mod gratings;
mod lobes;
mod never_nan;
mod picture;
mod published;
mod rays;
mod rows_never_nan;
mod scratch;
mod surface;
mod tube;
mod twin;
