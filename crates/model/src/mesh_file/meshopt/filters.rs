//! The filters of attributes, which give unpacked bytes their meaning; appendix B of KHR_meshopt_compression. The crate meshopt-rs has no
//! filter of colours.

/// Applies the filter of a name to elements of `stride` bytes.
pub(super) fn apply(name: &str, stride: usize, bytes: &mut [u8]) -> Result<(), String> {
    match (name, stride) {
        ("NONE", _) => {}
        ("OCTAHEDRAL", 4) => each_i8(bytes, |it| octahedral(it, 127.0)),
        ("OCTAHEDRAL", 8) => each_i16(bytes, |it| octahedral(it, 32767.0)),
        ("QUATERNION", 8) => each_i16(bytes, quaternion),
        ("EXPONENTIAL", _) => {
            for word in bytes.as_chunks_mut().0 {
                *word = exponential(i32::from_le_bytes(*word)).to_le_bytes();
            }
        }
        ("COLOR", 4) => each_i8(bytes, |[y, co, cg, a]| {
            color([y & 0xff, co, cg, a & 0xff], 255.0)
        }),
        ("COLOR", 8) => each_i16(bytes, |[y, co, cg, a]| {
            color([y & 0xffff, co, cg, a & 0xffff], 65535.0)
        }),
        (name, stride) => return Err(format!("{name:?} of {stride} bytes")),
    }
    Ok(())
}

/// Four numbers of a byte each. Of the results the lowest eight bits are kept.
fn each_i8(bytes: &mut [u8], filter: impl Fn([i32; 4]) -> [i32; 4]) {
    for element in bytes.as_chunks_mut::<4>().0 {
        *element = filter(element.map(|byte| i32::from(byte as i8))).map(|it| it as u8);
    }
}

/// Four numbers of two bytes each.
fn each_i16(bytes: &mut [u8], filter: impl Fn([i32; 4]) -> [i32; 4]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let pairs = element.as_chunks_mut::<2>().0;
        let numbers = [0, 1, 2, 3].map(|i| i32::from(i16::from_le_bytes(pairs[i])));
        for (pair, number) in pairs.iter_mut().zip(filter(numbers)) {
            *pair = (number as i16).to_le_bytes();
        }
    }
}

/// A unit vector from two coordinates on an octahedron, and the number that means 1 among them. The fourth number stays.
fn octahedral([x, y, one, w]: [i32; 4], largest: f64) -> [i32; 4] {
    let [x, y] = [x, y].map(|it| f64::from(it) / f64::from(one));
    let z = 1.0 - x.abs() - y.abs();
    let below = z.min(0.0);
    let [x, y] = [x, y].map(|it| it - below.copysign(it));
    let length = (x * x + y * y + z * z).sqrt();
    let [x, y, z] = [x, y, z].map(|it| (it / length * largest).round() as i32);
    [x, y, z, w]
}

/// A unit quaternion from its three smaller components, each times the square root of 2, the number that means 1 among them, and, in the
/// lowest two bits of that, the index of the largest one.
fn quaternion([x, y, z, last]: [i32; 4]) -> [i32; 4] {
    let one = f64::from(last | 3) * std::f64::consts::SQRT_2;
    let smaller = [x, y, z].map(|it| f64::from(it) / one);
    let rest = smaller.iter().fold(1.0, |rest, it| rest - it * it);
    let mut filtered = [0; 4];
    let values = [rest.max(0.0).sqrt(), smaller[0], smaller[1], smaller[2]];
    for (i, value) in values.into_iter().enumerate() {
        filtered[((last & 3) as usize + i) % 4] = (value * 32767.0).round() as i32;
    }
    filtered
}

/// A whole number of 24 bits times a power of two, of 8 bits.
fn exponential(word: i32) -> f32 {
    let whole = word << 8 >> 8;
    libm::ldexp(f64::from(whole), word >> 24) as f32
}

/// Red, green, blue and alpha from luma, two chromas and alpha, whose highest bit says how many bits there are.
fn color([y, co, cg, alpha]: [i32; 4], largest: f64) -> [i32; 4] {
    let most = (alpha as u32 + 1).next_power_of_two() as i32 - 1;
    let a = alpha & most >> 1;
    let a = a << 1 | a & 1;
    [y + co - cg, y + cg, y - co - cg, a]
        .map(|it| (f64::from(it) / f64::from(most) * largest).round() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn halves(numbers: [i32; 4]) -> Vec<u8> {
        let bytes = numbers.iter().flat_map(|it| (*it as u16).to_le_bytes());
        bytes.collect()
    }

    /// Elements and their meaning, worked out by hand from the text of the specification.
    #[test]
    fn elements_stand_for_what_the_specification_says() {
        let bytes = |numbers: [i32; 4]| numbers.map(|it| it as u8).to_vec();
        let words = |numbers: [i32; 2]| numbers.map(i32::to_le_bytes).concat();
        let floats = |numbers: [f32; 2]| numbers.map(f32::to_le_bytes).concat();
        for (name, element, expected) in [
            // Axes; (1, -2, 2) / 3; and below the equator (1, 2, -2) / 3 and (3, -2, -2) / sqrt 17. The fourth number is kept.
            ("OCTAHEDRAL", bytes([127, 0, 127, 5]), bytes([127, 0, 0, 5])),
            ("OCTAHEDRAL", bytes([7, -7, 7, -1]), bytes([0, 0, -127, -1])),
            ("OCTAHEDRAL", bytes([3, -6, 15, 1]), bytes([42, -85, 85, 1])),
            ("OCTAHEDRAL", bytes([9, 12, 15, 1]), bytes([42, 85, -85, 1])),
            ("OCTAHEDRAL", bytes([5, -4, 7, 0]), bytes([92, -62, -62, 0])),
            (
                "OCTAHEDRAL",
                halves([9, 12, 15, -9]),
                halves([10922, 21845, -21845, -9]),
            ),
            // (0, 0, -0.6, 0.8), whose last is the largest, by 16 bits; others by 16 and by 8 bits.
            (
                "QUATERNION",
                halves([0, 0, -27804, 32767]),
                halves([0, 0, -19660, 26213]),
            ),
            (
                "QUATERNION",
                halves([1000, -2000, 3000, 32765]),
                halves([2121, 32660, 707, -1414]),
            ),
            (
                "QUATERNION",
                halves([90, -90, 90, 124]),
                halves([16275, 16420, -16420, 16420]),
            ),
            (
                "EXPONENTIAL",
                words([(-2 << 24) | 3, (3 << 24) | (-5 & 0xff_ffff)]),
                floats([0.75, -40.0]),
            ),
            (
                "EXPONENTIAL",
                words([0, (-100 << 24) | 0x7f_ffff]),
                floats([0.0, 8_388_607.0 / 2_f32.powi(100)]),
            ),
            // Colours of 8 bits, and of 4 bits, with steps of 17.
            (
                "COLOR",
                bytes([100, 100, 0, 0xc0]),
                bytes([200, 100, 0, 128]),
            ),
            (
                "COLOR",
                bytes([7, -2, 1, 0b1101]),
                bytes([68, 136, 136, 187]),
            ),
            (
                "COLOR",
                halves([40_000, -20_000, 5000, 0x9234]),
                halves([15_000, 45_000, 55_000, 0x2468]),
            ),
        ] {
            let mut filtered = element.clone();
            apply(name, element.len(), &mut filtered).unwrap();
            assert_eq!(filtered, expected, "{name} of {element:?}");
        }
        for (name, stride) in [
            ("OCTAHEDRAL", 12),
            ("QUATERNION", 4),
            ("COLOR", 16),
            ("X", 4),
        ] {
            let found = apply(name, stride, &mut [0; 48]).unwrap_err();
            assert_eq!(found, format!("{name:?} of {stride} bytes"));
        }
    }
}
