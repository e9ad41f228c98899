//! Properties of laid scratches.
