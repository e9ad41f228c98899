//! Light from all around: an equirectangular radiance map, prefiltered for rough reflection.

/// Placeholder until the loader lands.
#[derive(Clone, Debug)]
pub struct Environment {}
