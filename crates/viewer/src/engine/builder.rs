//! The building of scenes, by a thread of its own where there are threads.

use super::build::Workshop;
use super::request::{Shared, WantedScene};
use super::{Event, pool};

#[cfg(not(target_arch = "wasm32"))]
pub(super) fn run(shared: &Shared) {
    let mut workshop = Workshop::default();
    while let Some(wanted) = shared.next_scene() {
        build(shared, &mut workshop, wanted);
    }
}

/// Builds one, and hands it over or tells why there is none.
pub(super) fn build(shared: &Shared, workshop: &mut Workshop, wanted: WantedScene) {
    let cancelled = || shared.is_stopped();
    let built = pool::Crew::Builder.install(|| {
        workshop.build(
            &cancelled,
            wanted.revision,
            wanted.asked,
            wanted.description,
            &wanted.base_dir,
        )
    });
    match built {
        Ok(Some(built)) => shared.put_built(built),
        Ok(None) => {}
        Err(error) => shared.put_event(Event::NotBuilt {
            revision: wanted.revision,
            message: error.to_string(),
        }),
    }
}
