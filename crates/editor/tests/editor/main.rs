//! Tests of an artist's actions on a scene.
//! They are one program, since each that is linked takes seconds.

mod actions;
mod autosave;
mod brush;
mod document;
mod navigate;
mod on_disk;
mod place_light;
mod quantity;
mod undo;

use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// Settings that give the same cases on every run.
fn seeded(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}
