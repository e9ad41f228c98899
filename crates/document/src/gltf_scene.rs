//! Scenes in glTF files: the extension HAIRLINE_scratches (docs/HAIRLINE_scratches.md). Its tables are those of a scene file.

mod extension;
pub(crate) mod packed_files;
pub(crate) mod reading;
mod scratch_lists;
pub(crate) mod writing;

pub use extension::VERSION;
pub use reading::is_in;
pub use writing::Exported;
