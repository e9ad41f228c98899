//! A scene with some of its scratches, which is laid while a slider moves, before the whole scene.

use hairline_document::Description;
use hairline_document::description::{Amount, Layer};

/// Approximate number of random scratches in a sketch.
const SCRATCHES: u64 = 700;
/// A layer keeps at least so many.
const FEWEST: u64 = 48;
/// Largest number of scratches that one of a sketch stands for.
const THIN_MOST: u64 = 64;

/// Weights of the scratches of a sketch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sketch {
    thin: f64,
    /// Layer by layer.
    weights: Vec<f64>,
}

impl Sketch {
    /// Description of a sketch of a whole scene; none where that would save little.
    pub fn from_description(description: &Description) -> Option<(Description, Self)> {
        let counts = description
            .scratches
            .iter()
            .map(|table| match &table.layer {
                Layer::Laid(laid) if !table.hidden => match laid.amount {
                    Amount::Count(count) => count,
                    // Only the builder knows the area: some thousands of scratches.
                    Amount::DensityPerM2(_) => 4 * SCRATCHES,
                },
                _ => 0,
            });
        let thin = (counts.sum::<u64>() / SCRATCHES).min(THIN_MOST);
        if thin < 2 {
            return None;
        }
        let mut few = description.clone();
        let weights = few
            .scratches
            .iter_mut()
            .map(|table| match &mut table.layer {
                Layer::Laid(laid) => match &mut laid.amount {
                    Amount::Count(count) => {
                        let all = *count;
                        *count = (all / thin).max(FEWEST).min(all);
                        all as f64 / (*count).max(1) as f64
                    }
                    Amount::DensityPerM2(density) => {
                        *density /= thin as f64;
                        thin as f64
                    }
                },
                _ => 1.0,
            });
        let weights = weights.collect();
        let sketch = Self {
            thin: thin as f64,
            weights,
        };
        Some((few, sketch))
    }

    /// One scratch of so many is there, of most layers.
    pub fn thin(&self) -> f64 {
        self.thin
    }

    /// Number of scratches that one of a layer stands for.
    pub fn weight(&self, layer: usize) -> f64 {
        self.weights.get(layer).copied().unwrap_or(1.0)
    }
}
