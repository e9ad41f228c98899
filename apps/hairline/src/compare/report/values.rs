//! Linear values for the report's read-out and its exposure slider, small enough for a web page.

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use hairline_image::{Display, ToneMap};
use half::f16;

/// Up to this size the linear values are embedded; beyond, a page would take tens of megabytes and long to open.
pub const LINEAR_MAX_PX: usize = 600_000;

/// Packs channels as planes of half floats, high bytes before low ones (equal exponents lie together and compress), zlib,
/// base64. The page's script unpacks them.
pub fn packed(values: &[[f32; 3]], channels: usize) -> std::io::Result<String> {
    let mut bytes = Vec::with_capacity(values.len() * channels * 2);
    for channel in 0..channels {
        let codes: Vec<u16> = values.iter().map(|rgb| half_code(rgb[channel])).collect();
        bytes.extend(codes.iter().map(|code| (code >> 8) as u8));
        bytes.extend(codes.iter().map(|code| *code as u8));
    }
    compressed(&bytes)
}

/// Eleven bits, which is more than the page prints. What is too large for half floats but finite stays finite.
fn half_code(value: f32) -> u16 {
    let bounded = if value.is_finite() {
        value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())
    } else {
        value
    };
    f16::from_f32(bounded).to_bits()
}

fn compressed(bytes: &[u8]) -> std::io::Result<String> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes)?;
    Ok(BASE64.encode(encoder.finish()?))
}

/// Bytes as they are.
pub fn plain(bytes: &[u8]) -> String {
    BASE64.encode(bytes)
}

/// Samples a tone curve with the display's encoding as a table of colours, by which the page's script can apply any of
/// Hairline's curves.
///
/// Node `i` of an axis stands for the exposed linear value `expm1(i ln(1 + GAIN MAX) / (NODES - 1)) / GAIN`: even steps
/// in darkness, even ratios in light. Between nodes the script interpolates linearly. Colours outside the display's gamut
/// are brought into it first, as the curves themselves do.
pub struct ToneTable {
    codes: Vec<u8>,
}

impl ToneTable {
    /// Nodes on each axis.
    pub const NODES: usize = 48;
    /// Reciprocal of the value where the steps turn from even steps to even ratios.
    pub const GAIN: f32 = 200.0;
    /// The largest value. All curves are close to white there.
    pub const MAX: f32 = 256.0;

    /// Table of one curve.
    pub fn new(tone_map: ToneMap) -> Self {
        let display = Display {
            exposure_ev: 0.0,
            tone_map,
        };
        let mut codes = Vec::with_capacity(Self::NODES.pow(3) * 3);
        for r in 0..Self::NODES {
            for g in 0..Self::NODES {
                for b in 0..Self::NODES {
                    let shown = display.apply([r, g, b].map(Self::value));
                    codes.extend(shown.map(|c| (c * 255.0).round() as u8));
                }
            }
        }
        Self { codes }
    }

    fn value(node: usize) -> f32 {
        let end = (Self::GAIN * Self::MAX).ln_1p();
        (node as f32 * end / (Self::NODES - 1) as f32).exp_m1() / Self::GAIN
    }

    /// The table as the page reads it.
    pub fn packed(&self) -> std::io::Result<String> {
        compressed(&self.codes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks up a colour whose components are in the table's range, as the page's script does.
    fn look_up(table: &ToneTable, rgb: [f32; 3]) -> [f32; 3] {
        let end = (ToneTable::GAIN * ToneTable::MAX).ln_1p();
        let last = ToneTable::NODES - 1;
        let at = rgb.map(|c| ((ToneTable::GAIN * c).ln_1p() / end).min(1.0) * last as f32);
        let cell = at.map(|a| (a as usize).min(last - 1));
        let mut shown = [0.0; 3];
        for corner in 0..8 {
            let mut weight = 1.0;
            let mut index = 0;
            for axis in 0..3 {
                let up = (corner >> axis) & 1;
                let share = at[axis] - cell[axis] as f32;
                weight *= if up == 1 { share } else { 1.0 - share };
                index = index * ToneTable::NODES + cell[axis] + up;
            }
            for (c, sum) in shown.iter_mut().enumerate() {
                *sum += weight * f32::from(table.codes[index * 3 + c]);
            }
        }
        shown
    }

    #[test]
    fn the_table_is_as_good_as_the_curve() {
        // Colours from a thousandth to the table's end, hues and purities of all kinds.
        for tone_map in ToneMap::ALL {
            let table = ToneTable::new(tone_map);
            let display = Display {
                exposure_ev: 0.0,
                tone_map,
            };
            let ladder = |i: u32| 1e-3 * (i as f32 * 0.37).exp2();
            let mut errors = Vec::new();
            for r in 0..48 {
                for g in 0..48 {
                    for b in 0..48 {
                        let rgb = [r, g, b].map(ladder);
                        let right = display.apply(rgb).map(|c| c * 255.0);
                        let found = look_up(&table, rgb);
                        errors.extend(found.iter().zip(right).map(|(f, r)| (f - r).abs()));
                    }
                }
            }
            errors.sort_by(f32::total_cmp);
            let share = |share: f32| errors[(share * (errors.len() - 1) as f32) as usize];
            let (median, most, worst) = (share(0.5), share(0.99), share(1.0));
            let name = tone_map.name();
            println!(
                "{name}: half below {median:.2}, 99 % below {most:.2}, all below {worst:.1} codes"
            );
            // Codes are whole: half a step is nothing. The worst are saturated colours at the edges where a curve clips.
            assert!(median < 0.5 && most < 1.5 && worst < 12.0, "{name}");
        }
    }

    #[test]
    fn halves_keep_three_digits_and_what_is_not_finite() {
        for value in [0.0, 1.0, 0.123_456, -3.75e-4, 812.5] {
            let found = f16::from_bits(half_code(value)).to_f32();
            assert!(
                (found - value).abs() <= value.abs() / 2048.0,
                "{value} {found}"
            );
        }
        assert_eq!(f16::from_bits(half_code(1e9)), f16::MAX);
        assert_eq!(
            f16::from_bits(half_code(f32::NEG_INFINITY)),
            f16::NEG_INFINITY
        );
        assert!(f16::from_bits(half_code(f32::NAN)).is_nan());
    }
}
