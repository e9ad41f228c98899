//! Metals by their measured complex refractive index (data/metals.csv names the paper of each).

use crate::fresnel::{self, FresnelCurve};
use crate::spectrum;
use std::fmt;
use std::sync::{Arc, LazyLock};

/// Declares the measured metals, each with its name in files and its title in menus, in the order of the columns of data/metals.csv.
macro_rules! metals {
    ($($(#[$doc:meta])* $Metal:ident = $name:literal, $title:literal;)*) => {
        /// A metal of measured n and k.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Metal {
            $($(#[$doc])* $Metal,)*
        }

        impl Metal {
            /// Every measured metal.
            pub const ALL: &'static [Self] = &[$(Self::$Metal),*];
            /// Their names in files.
            pub const NAMES: &'static [&'static str] = &[$($name),*];
            /// Each with its name.
            pub const NAMED: &'static [(&'static str, Self)] = &[$(($name, Self::$Metal)),*];

            /// Title in a menu.
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$Metal => $title,)*
                }
            }
        }
    };
}

metals! {
    /// Iron; also stands for carbon steel.
    Iron = "iron", "Iron";
    /// Austenitic stainless steel.
    StainlessSteel = "steel", "Steel";
    /// Aluminium.
    Aluminium = "aluminium", "Aluminium";
    /// Copper.
    Copper = "copper", "Copper";
    /// Gold.
    Gold = "gold", "Gold";
    /// Silver.
    Silver = "silver", "Silver";
    /// Brass, 70 % copper and 30 % zinc.
    Brass = "brass", "Brass";
    /// Chromium.
    Chromium = "chromium", "Chromium";
    /// Titanium.
    Titanium = "titanium", "Titanium";
    /// Nickel.
    Nickel = "nickel", "Nickel";
}

/// The complex refractive index of a metal over the wavelength.
#[derive(Clone, PartialEq)]
pub enum MetalIndex {
    /// That of a measured metal.
    Measured(Metal),
    /// Rows of a wavelength in nm, n and k, the wavelengths rising; linear between them, and constant beyond.
    Own(Arc<[[f64; 3]]>),
}

/// As the metal or the rows alone: a part of the keys of kept files.
impl fmt::Debug for MetalIndex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Measured(metal) => metal.fmt(f),
            Self::Own(rows) => f.debug_tuple("Own").field(rows).finish(),
        }
    }
}

impl From<Metal> for MetalIndex {
    fn from(metal: Metal) -> Self {
        Self::Measured(metal)
    }
}

impl MetalIndex {
    /// The index of rows of a wavelength in nm, n and k.
    ///
    /// # Panics
    /// Without a row.
    pub fn own(rows: &[[f64; 3]]) -> Self {
        assert!(!rows.is_empty(), "a metal has a refractive index");
        Self::Own(rows.into())
    }

    /// n and k at a wavelength.
    pub fn n_k(&self, wavelength_nm: f64) -> (f64, f64) {
        let rows = match self {
            Self::Measured(metal) => return metal.n_k(wavelength_nm),
            Self::Own(rows) => rows,
        };
        let above = rows.partition_point(|row| row[0] < wavelength_nm);
        let (low, high) = (rows[above.max(1) - 1], rows[above.min(rows.len() - 1)]);
        let span = high[0] - low[0];
        let share = if span > 0.0 {
            (wavelength_nm - low[0]) / span
        } else {
            0.0
        };
        let at = |column: usize| low[column] + share * (high[column] - low[column]);
        (at(1), at(2))
    }

    /// Unpolarised reflectance of the bare surface.
    pub fn reflectance(&self, cos_theta: f64, wavelength_nm: f64) -> f64 {
        let (n, k) = self.n_k(wavelength_nm);
        fresnel::conductor(cos_theta, n, k)
    }

    /// Reflectance in linear Rec.709 under D65.
    pub fn reflectance_rgb(&self, cos_theta: f64) -> [f64; 3] {
        spectrum::rgb_from_reflectance(|nm| self.reflectance(cos_theta, nm))
    }
}

impl Metal {
    /// n and k at a wavelength, linear between the tabulated ones (every 10 nm from 380 to 780 nm, constant beyond).
    pub fn n_k(self, wavelength_nm: f64) -> (f64, f64) {
        let column = 2 * Self::ALL.iter().position(|it| *it == self).unwrap_or(0);
        let rows = &*ROWS;
        let position = ((wavelength_nm - 380.0) / 10.0).clamp(0.0, (rows.len() - 1) as f64);
        let i = (position as usize).min(rows.len() - 2);
        let f = position - i as f64;
        let at = |column: usize| rows[i][column] + f * (rows[i + 1][column] - rows[i][column]);
        (at(column), at(column + 1))
    }

    /// Unpolarised reflectance of the bare surface.
    pub fn reflectance(self, cos_theta: f64, wavelength_nm: f64) -> f64 {
        MetalIndex::from(self).reflectance(cos_theta, wavelength_nm)
    }

    /// Reflectance in linear Rec.709 under D65.
    pub fn reflectance_rgb(self, cos_theta: f64) -> [f64; 3] {
        MetalIndex::from(self).reflectance_rgb(cos_theta)
    }

    /// [`Metal::reflectance_rgb`] over the angle.
    pub fn fresnel_curve(self) -> FresnelCurve {
        FresnelCurve::new(|cos_theta| self.reflectance_rgb(cos_theta))
    }
}

static ROWS: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
    include_str!("../data/metals.csv")
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        .map(|line| {
            line.split(',')
                .skip(1)
                .map(|cell| cell.parse().expect("data/metals.csv holds numbers"))
                .collect()
        })
        .collect()
});

#[cfg(test)]
mod tests {
    use super::*;

    /// A metal that is brought by the rows of a measured one is that one.
    #[test]
    fn own_metals_are_their_rows() {
        let row = |i: u32| {
            let nm = 380.0 + 10.0 * f64::from(i);
            let (n, k) = Metal::Gold.n_k(nm);
            [nm, n, k]
        };
        let rows: Vec<_> = (0..41).map(row).collect();
        let own = MetalIndex::own(&rows);
        assert_eq!(own, MetalIndex::own(&rows.clone()));
        assert_ne!(own, MetalIndex::own(&rows[1..]));
        for nm in [300.0, 380.0, 497.3, 555.0, 780.0, 900.0] {
            let (a, b) = (own.n_k(nm), Metal::Gold.n_k(nm));
            assert!(
                (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).abs() < 1e-12,
                "{nm}"
            );
        }
        assert_eq!(MetalIndex::own(&[[500.0, 1.5, 2.0]]).n_k(600.0), (1.5, 2.0));
    }

    #[test]
    fn metals_have_their_colours() {
        let rgb = |m: Metal| m.reflectance_rgb(1.0);
        for &metal in Metal::ALL {
            for c in rgb(metal) {
                // Saturated metals leave the gamut: gold reflects more red than Rec.709 white holds.
                assert!((0.2..1.06).contains(&c), "{metal:?} {c}");
            }
        }
        let [r, g, b] = rgb(Metal::Gold);
        assert!(r > g && g > b && b < 0.5, "gold is yellow: {r} {g} {b}");
        let [r, g, b] = rgb(Metal::Copper);
        assert!(r > 1.25 * g && g > b, "copper is red: {r} {g} {b}");
        let [r, _, b] = rgb(Metal::Silver);
        assert!(r > 0.95 && b > 0.9, "silver is white: {r} {b}");
        let [r, g, b] = rgb(Metal::Aluminium);
        assert!(
            r > 0.88 && (r - b).abs() < 0.05 && g > 0.88,
            "aluminium is bright and grey: {r} {g} {b}"
        );
    }

    #[test]
    fn the_columns_are_the_metals() {
        let header = include_str!("../data/metals.csv")
            .lines()
            .find(|l| l.starts_with("wavelength"))
            .unwrap();
        let names: Vec<&str> = header.split(',').skip(1).step_by(2).collect();
        assert_eq!(names.len(), Metal::ALL.len());
        for (metal, name) in Metal::ALL.iter().zip(names) {
            let spelled = format!("{metal:?}").to_lowercase();
            assert_eq!(
                format!("{spelled}_n"),
                name.replace("stainless_steel", "stainlesssteel")
            );
        }
    }
}
