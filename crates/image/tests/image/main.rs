//! Files, tone curve and comparisons.
//! In one program, since each that is linked takes seconds.

mod compare;
mod files;
mod flip;
mod foreign_files;
mod metrics;
mod noise_files;
mod tone_map;
mod z_test;
