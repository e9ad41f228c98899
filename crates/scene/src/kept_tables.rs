//! Tables that take long to compute, kept by who makes scenes for the next one.

use hairline_optics::metal::MetalIndex;
use hairline_optics::rigorous::{Efficiencies, FineGrooves};
use hairline_optics::section::GrooveShape;
use hairline_optics::table::ScratchTable;
use std::collections::VecDeque;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Tables of scenes that one builder makes: they share them.
#[derive(Default)]
pub struct KeptTables {
    /// By the metal, white's without one, and the shape: 8 MB each.
    pub(crate) scratches: Last<(Option<MetalIndex>, GrooveShape), ScratchTable, 24>,
    pub(crate) efficiencies: Last<FineGrooves, Efficiencies, 32>,
}

impl fmt::Debug for KeptTables {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("KeptTables").finish_non_exhaustive()
    }
}

/// The values that were made last, at most so many.
pub(crate) struct Last<K, V, const MOST: usize>(Mutex<VecDeque<(K, Arc<V>)>>);

impl<K, V, const MOST: usize> Default for Last<K, V, MOST> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: PartialEq, V, const MOST: usize> Last<K, V, MOST> {
    /// The value of a key, made unless it is kept.
    pub(crate) fn value(&self, key: K, make: impl FnOnce() -> Option<V>) -> Option<Arc<V>> {
        // Not locked while a value is made: a thread that waits for its parts may take up another scene, which would wait for it for ever.
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, value)) = kept().iter().find(|(of, _)| *of == key) {
            return Some(Arc::clone(value));
        }
        let value = Arc::new(make()?);
        let mut kept = kept();
        if kept.len() == MOST {
            kept.pop_front();
        }
        kept.push_back((key, Arc::clone(&value)));
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_values_are_kept() {
        let last = Last::<u32, u32, 2>::default();
        let value = |key, new| last.value(key, || new).map(|it| *it);
        assert_eq!(value(1, None), None);
        assert_eq!(
            (value(1, Some(10)), value(2, Some(20))),
            (Some(10), Some(20))
        );
        assert_eq!((value(1, None), value(3, Some(30))), (Some(10), Some(30)));
        assert_eq!((value(1, None), value(2, None)), (None, Some(20)));
    }
}
