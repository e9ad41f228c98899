//! Pictures and turntables to files, in the background.

use std::path::Path;

use hairline_scene::Description;

use crate::app::Viewer;
use crate::files::Purpose;

/// What is being exported.
#[derive(Default)]
pub(crate) struct Export {}

impl Export {
    pub fn ask_still(&mut self, _description: &Description) {}

    pub fn ask_turntable(&mut self, _description: &Description) {}
}

impl Viewer {
    pub(crate) fn export_to(&mut self, _purpose: Purpose, _path: &Path) {}
}
