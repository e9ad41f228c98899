//! A scene that is ready for all look-ups that are measured: each gets pieces of scratches as long as suit it, so that no method pays
//! for what another gains.

use hairline_index::Watch;
use hairline_optics::method::Lookup;
use hairline_reference::closed_form::Prepared;
use hairline_scene::Scene;

/// One for all look-ups that want pieces of the same length.
pub struct ByLookup<'a>(Vec<Prepared<'a>>);

impl<'a> ByLookup<'a> {
    /// Builds them.
    pub fn new(scene: &'a Scene, lookups: impl IntoIterator<Item = Lookup>) -> Self {
        let mut all: Vec<Prepared> = Vec::new();
        for lookup in lookups {
            if !all.iter().any(|one| one.scratches().suits(lookup)) {
                let prepared = Prepared::watched(scene, lookup, &Watch::default());
                all.push(prepared.unwrap_or_else(|| unreachable!("nobody cancels it")));
            }
        }
        Self(all)
    }

    /// As [`Prepared::with_scene`].
    pub fn with_scene<'b>(&self, scene: &'b Scene) -> ByLookup<'b> {
        ByLookup(self.0.iter().map(|one| one.with_scene(scene)).collect())
    }

    /// # Panics
    /// For a look-up that it was not built for.
    pub fn of(&self, lookup: Lookup) -> &Prepared<'a> {
        let suits = |one: &&Prepared| one.scratches().suits(lookup);
        let found = self.0.iter().find(suits);
        found.unwrap_or_else(|| panic!("{lookup:?} was not asked for"))
    }
}
