//! The Monte Carlo reference against the closed form, against facts of physics, and against itself: docs/accuracy.md has
//! the same comparisons on more scenes.

mod bounced;
mod bounced_on_gpu;
mod bumps;
mod chance;
mod closed_form;
mod contact;
mod depth_of_field;
mod environment;
mod filtered;
mod full_wave;
mod furnace;
mod going_on;
mod gratings;
mod light_kinds;
mod mask;
mod mirrored;
mod penumbra;
mod picture;
mod pictures;
mod plastics;
mod published;
mod random;
mod scenes;
mod shadowed;
mod shadowed_on_gpu;
mod shadows;
mod unbiased;
