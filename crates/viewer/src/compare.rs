//! The reference of the view beside the picture.

/// The comparison, while it is open.
#[derive(Default)]
pub(crate) struct Compare {
    open: bool,
}

impl Compare {
    pub fn toggle(&mut self) {
        self.open = !self.open;
    }

    pub fn is_open(&self) -> bool {
        self.open
    }
}
