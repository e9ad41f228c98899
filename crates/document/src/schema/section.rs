//! A table of the scene file, by its keys.

use super::key::Key;

/// A table of the scene file.
pub struct Section {
    /// Name in the file.
    pub name: &'static str,
    /// Whether a file has it at most once.
    pub is_single: bool,
    /// Its class in Python; none where Python has it as a plain table.
    pub class: &'static str,
    /// Description that follows its name.
    pub meaning: &'static str,
    /// The keys that it has whatever its kind.
    pub keys: &'static [&'static Key],
    /// The key that tells the kind; empty where there are no kinds, or where each kind is a table of its own.
    pub tag: &'static str,
    /// Its kinds.
    pub choices: &'static [Choice],
}

/// A kind of a table, with the keys of its own.
pub struct Choice {
    /// Value of the section's tag.
    pub name: &'static str,
    /// Description, in whole sentences.
    pub meaning: &'static str,
    /// The keys of its own.
    pub keys: &'static [&'static Key],
}

impl Choice {
    pub(super) const fn new(
        name: &'static str,
        meaning: &'static str,
        keys: &'static [&'static Key],
    ) -> Self {
        Self {
            name,
            meaning,
            keys,
        }
    }
}

impl Section {
    /// A table that a file has at most once.
    pub(super) const fn one(
        name: &'static str,
        class: &'static str,
        meaning: &'static str,
        keys: &'static [&'static Key],
    ) -> Self {
        Self {
            name,
            is_single: true,
            class,
            meaning,
            keys,
            tag: "",
            choices: &[],
        }
    }

    /// A table that there may be several of.
    pub(super) const fn many(
        name: &'static str,
        class: &'static str,
        meaning: &'static str,
        keys: &'static [&'static Key],
    ) -> Self {
        Self {
            is_single: false,
            ..Self::one(name, class, meaning, keys)
        }
    }

    pub(super) const fn kinds(self, tag: &'static str, choices: &'static [Choice]) -> Self {
        Self {
            tag,
            choices,
            ..self
        }
    }

    /// All of its keys, each once: those of the table, then those of its kinds.
    pub fn all_keys(&self) -> Vec<&'static Key> {
        let of_kinds = self.choices.iter().flat_map(|choice| choice.keys);
        let mut keys: Vec<&'static Key> = Vec::new();
        for key in self.keys.iter().chain(of_kinds) {
            if !keys.iter().any(|known| std::ptr::eq(*known, *key)) {
                keys.push(key);
            }
        }
        keys
    }
}
