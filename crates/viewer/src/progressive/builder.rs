//! Building of scenes, in a thread of its own if there are threads.

use std::time::Duration;

use web_time::Instant;

use super::build::ViewBuilder;
#[cfg(not(target_arch = "wasm32"))]
use super::caught::caught;
use super::painter::STILL;
use super::request::{Shared, WantedScene};
use super::{Backend, Event, pool};

/// Time after which the building of an outdated scene is given up: shorter ones are finished, so that each step of a drag shows something.
const LONG: Duration = Duration::from_millis(700);

#[cfg(not(target_arch = "wasm32"))]
pub(super) fn run(shared: &Shared) {
    crate::priority::lower();
    let mut view_builder = ViewBuilder::default();
    while let Some(wanted) = shared.next_scene() {
        let built = caught(shared, "Building the scene", || {
            build(shared, &mut view_builder, wanted);
        });
        if built.is_none() {
            view_builder = ViewBuilder::default();
            shared.drop_sketch();
        }
    }
}

/// Builds a scene, and hands it over or reports why there is none.
pub(super) fn build(shared: &Shared, view_builder: &mut ViewBuilder, wanted: WantedScene) {
    let has_sketch = matches!(shared.backend(), Backend::Cpu)
        && pool::Pool::Drafter.install(|| sketch(shared, view_builder, &wanted));
    // With a sketch on the screen, the whole of an outdated scene need not be built; nor where it takes so long that nobody waits for it.
    let start = Instant::now();
    let is_dispensable = || has_sketch || start.elapsed() > LONG;
    let cancelled = || shared.is_stopped() || shared.wants_scene() && is_dispensable();
    if has_sketch && view_builder.has_built() {
        // A moment to see whether the hand goes on.
        shared.wait_for_scene(STILL);
    }
    if cancelled() {
        return;
    }
    let built = pool::Pool::Builder.install(|| {
        view_builder.build(
            &cancelled,
            wanted.revision,
            wanted.asked,
            wanted.description,
            &wanted.base_dir,
            shared.view(),
        )
    });
    match built {
        Ok(Some(built)) => shared.put_built(built),
        Ok(None) => {}
        Err(error) => {
            shared.drop_sketch();
            shared.put_event(Event::NotBuilt {
                revision: wanted.revision,
                message: error.to_string(),
            });
        }
    }
}

/// Hands a sketch over, if one is of use.
fn sketch(shared: &Shared, view_builder: &mut ViewBuilder, wanted: &WantedScene) -> bool {
    let sketch = view_builder.sketch(
        wanted.revision,
        wanted.asked,
        &wanted.description,
        &wanted.base_dir,
    );
    let is_there = sketch.is_some();
    if let Some(sketch) = sketch {
        shared.put_sketch(sketch);
    }
    is_there
}
