//! Dimension of a product of units.

/// Exponent of each kind of unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Dimension {
    pub length: i8,
    pub angle: i8,
    pub exposure: i8,
    pub pixel: i8,
    pub temperature: i8,
}

impl Dimension {
    pub(super) const NONE: Self = Self {
        length: 0,
        angle: 0,
        exposure: 0,
        pixel: 0,
        temperature: 0,
    };

    /// Dimension of a product, or with a `sign` of -1 of a quotient.
    pub(super) fn times(self, other: Self, sign: i8) -> Self {
        let sum = |a: i8, b: i8| a.saturating_add(b.saturating_mul(sign));
        Self {
            length: sum(self.length, other.length),
            angle: sum(self.angle, other.angle),
            exposure: sum(self.exposure, other.exposure),
            pixel: sum(self.pixel, other.pixel),
            temperature: sum(self.temperature, other.temperature),
        }
    }

    pub(super) fn power(self, n: i8) -> Self {
        Self::NONE.times(self, n)
    }

    /// Name in a message.
    pub(super) fn name(self) -> &'static str {
        let Self {
            length,
            angle,
            exposure,
            pixel,
            temperature,
        } = self;
        match [length, angle, exposure, pixel, temperature] {
            [0, 0, 0, 0, 0] => "a number without a unit",
            [1, 0, 0, 0, 0] => "a length",
            [2, 0, 0, 0, 0] => "an area",
            [-1, 0, 0, 0, 0] => "a number for each length",
            [-2, 0, 0, 0, 0] => "a number for each area",
            [0, 1, 0, 0, 0] => "an angle",
            [0, 0, 1, 0, 0] => "an exposure",
            [0, 0, 0, 1, 0] => "a number of pixels",
            [0, 0, 0, 0, 1] => "a temperature",
            _ => "a product of units",
        }
    }
}
