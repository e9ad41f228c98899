//! The thread that builds scenes.

use hairline_scene::Loader;

use super::build::Workshop;
use super::request::Shared;
use super::{Event, pool};

pub(super) fn run(shared: &Shared) {
    let mut workshop = Workshop::default();
    while let Some(wanted) = shared.next_scene() {
        let cancelled = || shared.is_stopped();
        let built = pool::Crew::Builder.install(|| {
            let loader = Loader {
                cancelled: &cancelled,
                ..Loader::default()
            };
            workshop.build(
                &loader,
                wanted.revision,
                wanted.asked,
                wanted.description,
                &wanted.base_dir,
            )
        });
        match built {
            Ok(built) => shared.put_built(built),
            Err(error) if error.is_cancelled() => {}
            Err(error) => shared.put_event(Event::NotBuilt {
                revision: wanted.revision,
                message: error.to_string(),
            }),
        }
    }
}
