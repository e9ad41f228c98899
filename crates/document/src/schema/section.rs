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
    /// Its kinds.
    pub kinds: KindKeys,
}

/// The kinds of a table.
#[derive(Clone, Copy)]
pub struct KindKeys {
    /// The key that tells the kind; empty where there are no kinds, or where each kind is a table of its own.
    pub tag: &'static str,
    /// The kinds.
    pub choices: &'static [Choice],
    /// Keys of the table that some kinds alone have: of a kind its name and the keys.
    pub(crate) of_table: &'static [(&'static str, &'static [Entry])],
}

impl KindKeys {
    /// No kinds.
    const NONE: Self = Self {
        tag: "",
        choices: &[],
        of_table: &[],
    };

    /// The keys that a kind has, beside those of all kinds.
    pub fn keys_of(&self, choice: &Choice) -> Vec<&'static Key> {
        let of_table = self.of_table.iter();
        let of_table = of_table.filter(|(kind, _)| *kind == choice.name);
        let own = std::iter::once(choice.entries);
        own.chain(of_table.map(|(_, entries)| *entries))
            .flat_map(keys)
            .collect()
    }
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
            kinds: KindKeys::NONE,
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

    pub(crate) const fn of_kinds(self, kinds: KindKeys) -> Self {
        Self { kinds, ..self }
    }

    /// The keys that it has whatever its kind.
    pub fn keys(&self) -> Vec<&'static Key> {
        keys(self.entries)
    }

    /// All of its keys, each once: those of the table, then those of its kinds.
    pub fn all_keys(&self) -> Vec<&'static Key> {
        let choices = self.kinds.choices.iter();
        let of_kinds = choices.flat_map(|choice| self.kinds.keys_of(choice));
        let mut all: Vec<&'static Key> = Vec::new();
        for key in self.keys().into_iter().chain(of_kinds) {
            if !all.contains(&key) {
                all.push(key);
            }
        }
        all
    }
}
