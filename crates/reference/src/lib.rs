//! Pictures by Monte Carlo, to which the closed forms must converge, with the effects that they leave out.
//!
//! A path tracer in f64. Each pixel is an average over points of its filter, wavelengths, directions to the lights and the
//! environment and, if asked for, bounces. Nothing is shared with the closed forms but the scene, its trees, and the
//! definitions that are the model itself.
//!
//! Samples come in batches of [`BATCH_SAMPLES`] that cover the pixel, the spectrum and the lights evenly; batches are independent
//! of one another, so their scatter tells the variance. A batch depends on the seed, the pixel and its number alone: pictures
//! are the same for any number of threads, and a picture that was stopped goes on as if it had not been.
//!
//! ```
//! use hairline_reference::{BATCH_SAMPLES, Integrator, Settings};
//! use std::ops::ControlFlow;
//!
//! let text = r#"
//! camera = { position_m = [0.0, -0.2, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0] }
//! render = { size_px = [16, 12] }
//! material = [{ name = "steel", kind = "metal", metal = "steel" }]
//! object = [{ name = "plate", shape = { disk = { radius_m = 0.08 } }, material = "steel" }]
//! scratches = [{ object = "plate", pattern = "random", count = 100 }]
//! light = [{ kind = "sphere", center_m = [0.0, 0.2, 0.3], radius_m = 0.05, radiance = 9.0 }]
//! "#;
//! let scene = hairline_document::from_toml(text, "plate.toml", ".")?;
//! let integrator = Integrator::new(&scene, Settings::default());
//! let mut image = integrator.start();
//! let end = integrator.run(&mut image, BATCH_SAMPLES, &|_| ControlFlow::Continue(()));
//! assert!(end.is_continue() && image.base.iter().any(|rgb| rgb[1] > 0.0));
//! # Ok::<(), hairline_document::Error>(())
//! ```

#![warn(unreachable_pub)]

mod base;
mod coherent;
mod gratings;
mod grooves;
mod integrator;
mod interval;
mod orders;
mod path;
mod random;
mod reflectance;
mod run;
mod separable;
mod wavelengths;

pub use integrator::{Integrator, Model, SceneIndex, Settings};
pub use random::BATCH_SAMPLES;
pub use run::REVISION;
