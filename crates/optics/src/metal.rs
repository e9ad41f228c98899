//! Metals by their measured complex refractive index.

/// A metal whose n and k were measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Metal {
    /// Iron; also stands for carbon steel.
    Iron,
    /// Austenitic stainless steel.
    StainlessSteel,
    /// Aluminium.
    Aluminium,
    /// Copper.
    Copper,
    /// Gold.
    Gold,
    /// Silver.
    Silver,
    /// Brass, 70 % copper and 30 % zinc.
    Brass,
    /// Chromium.
    Chromium,
    /// Titanium.
    Titanium,
    /// Nickel.
    Nickel,
}
