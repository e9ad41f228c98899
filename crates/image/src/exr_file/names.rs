//! Names of channels and attributes in a file.

use std::collections::BTreeMap;

/// Notes on the making of a render (scene, model, seed), by name. Any text; names of 246 bytes at most.
pub type Notes = BTreeMap<String, String>;

/// Prefix of the names of notes in a file, so that they do not meet the attributes of other software.
pub(super) const NOTE_PREFIX: &str = "hairline.";

/// Samples in a batch, an integer attribute. Outside the notes' prefix: no note can have its name.
pub(super) const BATCH_ATTRIBUTE: &str = "hairlineBatch";

/// Number of samples of each pixel.
pub(super) const SAMPLES: &str = "samples";
/// The channel of [`alpha`](crate::Image::alpha).
pub(super) const ALPHA: &str = "A";

/// The three channels of a layer of the render.
pub(crate) fn channel_names(layer: crate::Layer) -> [&'static str; 3] {
    match layer {
        crate::Layer::Beauty => ["R", "G", "B"],
        crate::Layer::Base => ["base.R", "base.G", "base.B"],
        crate::Layer::Scratches => ["scratches.R", "scratches.G", "scratches.B"],
        crate::Layer::Density => ["density.R", "density.G", "density.B"],
        crate::Layer::Depth => ["depth.Z"; 3],
        crate::Layer::Normal => ["normal.X", "normal.Y", "normal.Z"],
        crate::Layer::Alpha => [ALPHA; 3],
    }
}

/// The three channels of a layer's variance, if it has one.
pub(crate) fn variance_channel_names(layer: crate::Layer) -> Option<[String; 3]> {
    use crate::Layer as L;
    let has_variance = matches!(layer, L::Beauty | L::Base | L::Scratches | L::Density);
    has_variance.then(|| channel_names(layer).map(|name| format!("variance.{name}")))
}

/// Names for a message, each once: depth has one channel.
pub(super) fn listed(names: [impl AsRef<str>; 3]) -> String {
    match names.each_ref().map(AsRef::as_ref) {
        [name, other, _] if name == other => name.to_owned(),
        names => names.join(", "),
    }
}
