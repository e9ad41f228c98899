//! Linear RGB of other primaries, and XYZ, as that of Rec.709.
//!
//! White is taken to white by Bradford's adaptation (K. M. Lam, 1985; B. Lindbloom, *Chromatic Adaptation*). XYZ is no RGB with a white of its
//! own: its values are colours as they were measured, and stay these.

use crate::tone_map::tone_luminance;

/// CIE 1931 xy of the primaries and of white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    /// x and y.
    pub red: [f64; 2],
    /// x and y.
    pub green: [f64; 2],
    /// x and y.
    pub blue: [f64; 2],
    /// x and y.
    pub white: [f64; 2],
}

pub(crate) type Matrix = [[f64; 3]; 3];

/// Conversion from another linear space to Rec.709.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToRec709(Matrix);

impl Primaries {
    /// ITU-R BT.709, white D65.
    pub(crate) const REC_709: Self = Self {
        red: [0.64, 0.33],
        green: [0.30, 0.60],
        blue: [0.15, 0.06],
        white: [0.3127, 0.3290],
    };
    /// XYZ itself, as files that hold it in channels R, G and B say it.
    pub const XYZ: Self = Self {
        red: [1.0, 0.0],
        green: [0.0, 1.0],
        blue: [0.0, 0.0],
        white: [1.0 / 3.0, 1.0 / 3.0],
    };

    /// Primaries of the eight numbers of a file: red, green, blue, white.
    pub fn of_numbers([rx, ry, gx, gy, bx, by, wx, wy]: [f64; 8]) -> Self {
        Self {
            red: [rx, ry],
            green: [gx, gy],
            blue: [bx, by],
            white: [wx, wy],
        }
    }

    /// Conversion of colours of these primaries to Rec.709. None where they are those of Rec.709, or all numbers are 0: programs write zeros where they
    /// know no primaries.
    ///
    /// # Errors
    /// Primaries that span no colours, in words.
    pub fn to_rec_709(self) -> Result<Option<ToRec709>, String> {
        let is_unknown = self == Self::of_numbers([0.0; 8]);
        if is_unknown || self.is_about(&Self::REC_709) {
            return Ok(None);
        }
        let to_xyz = self.to_xyz().ok_or_else(|| {
            let [red, green, blue, white] = [self.red, self.green, self.blue, self.white];
            format!(
                "primaries that span no colours: red {red:?}, green {green:?}, blue {blue:?}, white {white:?}"
            )
        })?;
        let adapted = match self.is_about(&Self::XYZ) {
            true => to_xyz,
            false => product(&adaptation(self.white, Self::REC_709.white), &to_xyz),
        };
        let to_709 = Self::REC_709.to_xyz().and_then(|it| inverse(&it));
        let to_709 = to_709.expect("the primaries of Rec.709 span colours");
        Ok(Some(ToRec709(product(&to_709, &adapted))))
    }

    fn is_about(&self, other: &Self) -> bool {
        // Files write four digits.
        let near = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 6e-4);
        near(self.red, other.red)
            && near(self.green, other.green)
            && near(self.blue, other.blue)
            && near(self.white, other.white)
    }

    /// Matrix from RGB whose white has luminance 1 to XYZ.
    pub(crate) fn to_xyz(self) -> Option<Matrix> {
        let column = |[x, y]: [f64; 2]| [x, y, 1.0 - x - y];
        let columns = [self.red, self.green, self.blue].map(column);
        let primaries: Matrix = std::array::from_fn(|row| columns.map(|column| column[row]));
        let shares = times(&inverse(&primaries)?, white(self.white)?);
        Some(primaries.map(|row| std::array::from_fn(|i| row[i] * shares[i])))
    }
}

impl ToRec709 {
    /// Converts a colour; the result is below zero in channels where Rec.709 has no such colour.
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        times(&self.0, rgb.map(f64::from)).map(|c| c as f32)
    }
}

/// A colour of the same luminance with no channel below zero, as a light needs it.
pub fn in_gamut(rgb: [f32; 3]) -> [f32; 3] {
    let [r, g, b] = rgb;
    let least = r.min(g).min(b);
    let luminance = tone_luminance(rgb);
    if !(least < 0.0 && luminance > 0.0) {
        return rgb;
    }
    let share = luminance / (luminance - least);
    rgb.map(|c| luminance + (c - luminance) * share)
}

/// XYZ of luminance 1.
fn white([x, y]: [f64; 2]) -> Option<[f64; 3]> {
    let white = [x / y, 1.0, (1.0 - x - y) / y];
    white.iter().all(|c| c.is_finite()).then_some(white)
}

/// Matrix from XYZ under one white to XYZ under another one.
fn adaptation(from: [f64; 2], to: [f64; 2]) -> Matrix {
    const BRADFORD: Matrix = [
        [0.8951, 0.2664, -0.1614],
        [-0.7502, 1.7135, 0.0367],
        [0.0389, -0.0685, 1.0296],
    ];
    let back = inverse(&BRADFORD).expect("Bradford's matrix has an inverse");
    let cones = |at| white(at).map(|white| times(&BRADFORD, white));
    let (Some(from), Some(to)) = (cones(from), cones(to)) else {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    };
    let scaled: Matrix = std::array::from_fn(|i| BRADFORD[i].map(|c| c * to[i] / from[i]));
    product(&back, &scaled)
}

pub(crate) fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| std::array::from_fn(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
}

pub(crate) fn inverse(m: &Matrix) -> Option<Matrix> {
    let cofactor = |i: usize, j: usize| {
        let [a, b] = [(i + 1) % 3, (i + 2) % 3];
        let [c, d] = [(j + 1) % 3, (j + 2) % 3];
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    let inverse: Matrix =
        std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant));
    let is_one = determinant.abs() > 1e-9 && inverse.as_flattened().iter().all(|c| c.is_finite());
    is_one.then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_rows(of: Primaries, expected: Matrix, tolerance: f64) {
        let ToRec709(matrix) = of.to_rec_709().unwrap().unwrap();
        for (got, expected) in matrix.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((got - expected).abs() < tolerance, "{matrix:?}");
        }
    }

    #[test]
    fn numbers_that_are_all_zero_name_no_primaries() {
        assert_eq!(Primaries::of_numbers([0.0; 8]).to_rec_709(), Ok(None));
        let mut on_a_line = Primaries::REC_709;
        on_a_line.blue = on_a_line.red;
        assert!(on_a_line.to_rec_709().is_err());
    }

    /// ITU-R BT.2087-0, section 2; the ACES project's AP0 (white about D60) to Rec.709; IEC 61966-2-1 for XYZ.
    #[test]
    fn matrices_are_those_of_the_standards() {
        let rec_2020 =
            Primaries::of_numbers([0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290]);
        let expected = [
            [1.6605, -0.5876, -0.0728],
            [-0.1246, 1.1329, -0.0083],
            [-0.0182, -0.1006, 1.1187],
        ];
        assert_rows(rec_2020, expected, 2e-4);
        let ap0 =
            Primaries::of_numbers([0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, 0.32168, 0.33767]);
        let expected = [
            [2.5217, -1.1341, -0.3876],
            [-0.2765, 1.3727, -0.0962],
            [-0.0154, -0.1530, 1.1684],
        ];
        assert_rows(ap0, expected, 5e-4);
        let expected = [
            [3.2406, -1.5372, -0.4986],
            [-0.9689, 1.8758, 0.0415],
            [0.0557, -0.2040, 1.0570],
        ];
        assert_rows(Primaries::XYZ, expected, 1e-3);
    }

    #[test]
    fn white_stays_white_and_rec_709_stays_what_it_is() {
        assert_eq!(Primaries::REC_709.to_rec_709(), Ok(None));
        // Radiance's default primaries, with the white of equal energy.
        let radiance =
            Primaries::of_numbers([0.640, 0.330, 0.290, 0.600, 0.150, 0.060, 0.333, 0.333]);
        let white = radiance.to_rec_709().unwrap().unwrap().color([2.0; 3]);
        assert!(white.iter().all(|c| (c - 2.0).abs() < 1e-5), "{white:?}");
        let flat = Primaries {
            green: [0.64, 0.33],
            ..Primaries::REC_709
        };
        assert!(flat.to_rec_709().unwrap_err().contains("span no colours"));
    }
}
