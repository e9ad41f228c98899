//! From a scene to pictures in files, for the command line, Python and the window: choosing a renderer, painting by it, sequences, labels, and
//! references that can be stopped and continued. The caller is told of the progress by a [`Listener`] or asked by a [`GoOn`], and shows it in its
//! own way. A [`Painter`] never blocks; what does is not there in a browser.

#![warn(unreachable_pub)]

mod adding;
#[cfg(not(target_arch = "wasm32"))]
pub mod bands;
#[cfg(not(target_arch = "wasm32"))]
mod choice;
pub mod failure;
mod fine;
pub mod labels;
mod listener;
pub mod motion;
mod on_gpu;
mod painter;
mod parts;
pub mod reference;
mod rows;
mod sequence;
mod task;

pub use adding::Rendered;
#[cfg(not(target_arch = "wasm32"))]
pub use choice::{Backend, block_on};
pub use fine::FINE_SAMPLES;
pub use listener::{Listener, Quiet};
pub use motion::Motion;
pub use painter::Painter;
pub use parts::Parts;
pub use rows::GoOn;
pub use sequence::{Error, Sequence, Writer};
pub use task::{BouncesWithoutShadows, Method, Task, transport};
