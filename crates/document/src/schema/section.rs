//! A table of the scene file, by its keys.

use super::key::Key;

/// What a table lists: a key, or the keys of a part of it.
pub enum Entry {
    /// A key.
    Key(&'static Key),
    /// Those of a part.
    All(&'static [Entry]),
}

/// All keys of a list.
pub(crate) fn keys(entries: &'static [Entry]) -> Vec<&'static Key> {
    let mut all = Vec::new();
    for entry in entries {
        match entry {
            Entry::Key(key) => all.push(*key),
            Entry::All(part) => all.extend(keys(part)),
        }
    }
    all
}

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
    entries: &'static [Entry],
    /// The key that tells the kind; empty where there are no kinds, or where each kind is a table of its own.
    pub tag: &'static str,
    /// Its kinds.
    pub choices: &'static [Choice],
}

/// A kind of a table, with the keys of its own.
#[derive(Clone, Copy)]
pub struct Choice {
    /// Value of the section's tag.
    pub name: &'static str,
    /// Description, in whole sentences.
    pub meaning: &'static str,
    pub(crate) entries: &'static [Entry],
}

impl Choice {
    pub(crate) const fn new(
        name: &'static str,
        meaning: &'static str,
        entries: &'static [Entry],
    ) -> Self {
        Self {
            name,
            meaning,
            entries,
        }
    }

    /// The keys of its own.
    pub fn keys(&self) -> Vec<&'static Key> {
        keys(self.entries)
    }
}

impl Section {
    /// A table that a file has at most once.
    pub(crate) const fn one(
        name: &'static str,
        class: &'static str,
        meaning: &'static str,
        entries: &'static [Entry],
    ) -> Self {
        Self {
            name,
            is_single: true,
            class,
            meaning,
            entries,
            tag: "",
            choices: &[],
        }
    }

    /// A table that there may be several of.
    pub(crate) const fn many(
        name: &'static str,
        class: &'static str,
        meaning: &'static str,
        entries: &'static [Entry],
    ) -> Self {
        Self {
            is_single: false,
            ..Self::one(name, class, meaning, entries)
        }
    }

    pub(crate) const fn kinds(self, tag: &'static str, choices: &'static [Choice]) -> Self {
        Self {
            tag,
            choices,
            ..self
        }
    }

    /// The keys that it has whatever its kind.
    pub fn keys(&self) -> Vec<&'static Key> {
        keys(self.entries)
    }

    /// All of its keys, each once: those of the table, then those of its kinds.
    pub fn all_keys(&self) -> Vec<&'static Key> {
        let of_kinds = self.choices.iter().flat_map(Choice::keys);
        let mut all: Vec<&'static Key> = Vec::new();
        for key in self.keys().into_iter().chain(of_kinds) {
            if !all.contains(&key) {
                all.push(key);
            }
        }
        all
    }
}
