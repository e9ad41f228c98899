//! Cross sections of grooves by number, so that each of millions of scratches carries a number alone.

use hairline_optics::section::Section;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Number of a cross section in this process. Equal sections have equal numbers; 0 is the rectangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SectionId(u32);

/// All sections but the rectangle, in the order of their numbers.
static KNOWN: Mutex<Vec<Section>> = Mutex::new(Vec::new());

fn known() -> MutexGuard<'static, Vec<Section>> {
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

impl SectionId {
    /// Number of a section.
    pub fn new(section: &Section) -> Self {
        if *section == Section::Rectangle {
            return Self::default();
        }
        let mut known = known();
        let at = known.iter().position(|it| it == section);
        let at = at.unwrap_or_else(|| {
            known.push(section.clone());
            known.len() - 1
        });
        Self(at as u32 + 1)
    }

    /// Section of the number.
    pub fn section(self) -> Section {
        match self.0 {
            0 => Section::Rectangle,
            number => known()[number as usize - 1].clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_sections_have_equal_numbers() {
        let listed = |depth: f64| Section::Listed([1.0, depth].into());
        let sections = [Section::Rectangle, Section::V, listed(0.5), listed(0.25)];
        let numbers = sections.clone().map(|it| SectionId::new(&it));
        assert_eq!(numbers[0], SectionId::default());
        assert_ne!(numbers[2], numbers[3]);
        assert_eq!(SectionId::new(&listed(0.5)), numbers[2]);
        assert_eq!(numbers.map(SectionId::section), sections);
    }
}
