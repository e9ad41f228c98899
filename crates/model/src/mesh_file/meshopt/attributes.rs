//! The mode ATTRIBUTES: each byte of an element as its difference to that of the element before, in groups of 16; appendix A of
//! KHR_meshopt_compression, whose version 0 is all of EXT_meshopt_compression. The crate meshopt-rs has no version 1, and of
//! version 0 only elements whose length is a constant.

/// First bytes of a stream of either version.
const VERSIONS: [u8; 2] = [0xa0, 0xa1];
/// The elements of a group.
const GROUP: usize = 16;
/// The most elements of a block, and the most bytes.
const MOST_ELEMENTS: usize = 256;
const MOST_BYTES: usize = 8192;
/// Numbers of bits of a difference in a group, by the two bits of the group's header.
const VERSION_0: [u32; 4] = [0, 2, 4, 8];
const NARROW: [u32; 4] = [0, 1, 2, 4];
const WIDE: [u32; 4] = [1, 2, 4, 8];

/// The bytes of `count` elements.
pub(super) fn unpacked(packed: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, String> {
    if stride == 0 || !stride.is_multiple_of(4) || stride > 256 {
        return Err(format!("elements of {stride} bytes"));
    }
    let first = packed.first();
    let version = VERSIONS.iter().position(|it| Some(it) == first);
    let version = version.ok_or("it begins with another byte than its mode has")?;
    let is_newer = version == 1;
    // The end holds the element before the first one, and the coding of the differences of each four bytes.
    let (tail, padded) = match is_newer {
        true => (stride + stride / 4, 24),
        false => (stride, 32),
    };
    let end = packed.len().checked_sub(tail.max(padded));
    let end = end.filter(|end| *end >= 1).ok_or("it is cut off")?;
    let (mut last, codings) = packed[packed.len() - tail..].split_at(stride);
    let codings = match is_newer {
        true => codings
            .iter()
            .map(|coding| DeltaCoding::from_byte(*coding))
            .collect(),
        false => Some(vec![DeltaCoding::Bytes; stride / 4]),
    };
    let codings = codings.ok_or("its differences are of an unknown kind")?;
    let mut stream = Stream(&packed[1..end]);
    let mut bytes = vec![0; count * stride];
    let most = ((MOST_BYTES / stride) & !(GROUP - 1)).min(MOST_ELEMENTS);
    for block in bytes.chunks_mut(most * stride) {
        let controls = match is_newer {
            true => stream.take(stride / 4)?,
            false => &[],
        };
        for (channel, coding) in codings.iter().enumerate() {
            let mut deltas = [[0; MOST_ELEMENTS]; 4];
            for (i, deltas) in deltas.iter_mut().enumerate() {
                let deltas = &mut deltas[..block.len() / stride];
                match controls.get(channel).map(|it| it >> (2 * i) & 3) {
                    None => stream.differences(&VERSION_0, deltas)?,
                    Some(0) => stream.differences(&NARROW, deltas)?,
                    Some(1) => stream.differences(&WIDE, deltas)?,
                    Some(2) => {}
                    Some(_) => deltas.copy_from_slice(stream.take(deltas.len())?),
                }
            }
            let of = |element: &[u8]| std::array::from_fn(|i| element[4 * channel + i]);
            let mut value = of(last);
            for (i, element) in block.chunks_mut(stride).enumerate() {
                value = coding.next(value, deltas.map(|it| it[i]));
                element[4 * channel..][..4].copy_from_slice(&value);
            }
        }
        last = &block[block.len() - stride..];
    }
    match stream.0 {
        [] => Ok(bytes),
        more => Err(format!("it has {} bytes too many", more.len())),
    }
}

/// Coding of the difference between four bytes and those of the element before.
#[derive(Clone, Copy)]
enum DeltaCoding {
    Bytes,
    Pairs,
    /// Bits, rotated by this count.
    Bits(u32),
}

impl DeltaCoding {
    fn from_byte(byte: u8) -> Option<Self> {
        match (byte & 15, u32::from(byte >> 4)) {
            (0, 0) => Some(Self::Bytes),
            (1, 0) => Some(Self::Pairs),
            (2, turn) => Some(Self::Bits(turn)),
            _ => None,
        }
    }

    fn next(self, last: [u8; 4], delta: [u8; 4]) -> [u8; 4] {
        match self {
            Self::Bytes => std::array::from_fn(|i| {
                let difference = (delta[i] >> 1) ^ (delta[i] & 1).wrapping_neg();
                last[i].wrapping_add(difference)
            }),
            Self::Pairs => {
                let pair = |of: [u8; 4], i: usize| u16::from_le_bytes([of[2 * i], of[2 * i + 1]]);
                let next = |i: usize| {
                    let delta = pair(delta, i);
                    let difference = (delta >> 1) ^ (delta & 1).wrapping_neg();
                    pair(last, i).wrapping_add(difference).to_le_bytes()
                };
                let [[a, b], [c, d]] = [next(0), next(1)];
                [a, b, c, d]
            }
            Self::Bits(turn) => {
                let changed = u32::from_le_bytes(delta).rotate_right(turn);
                (u32::from_le_bytes(last) ^ changed).to_le_bytes()
            }
        }
    }
}

/// Packed bytes that are not read yet.
struct Stream<'p>(&'p [u8]);

impl<'p> Stream<'p> {
    fn take(&mut self, count: usize) -> Result<&'p [u8], String> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or("it is cut off")?;
        self.0 = rest;
        Ok(taken)
    }

    /// One byte of each element of a block. `widths` are what the headers of groups mean.
    fn differences(&mut self, widths: &[u32; 4], deltas: &mut [u8]) -> Result<(), String> {
        let headers = self.take(deltas.len().div_ceil(GROUP).div_ceil(4))?;
        for (i, deltas) in deltas.chunks_mut(GROUP).enumerate() {
            let width = widths[usize::from(headers[i / 4] >> (2 * (i % 4)) & 3)];
            self.group(width, deltas)?;
        }
        Ok(())
    }

    /// Up to 16 numbers; those that do not fit in `width` bits are behind them, where the bits are all one.
    fn group(&mut self, width: u32, deltas: &mut [u8]) -> Result<(), String> {
        if width == 0 {
            return Ok(());
        }
        let packed = self.take(GROUP * width as usize / 8)?;
        if width == 8 {
            deltas.copy_from_slice(&packed[..deltas.len()]);
            return Ok(());
        }
        let most = (1_u8 << width) - 1;
        for i in 0..GROUP {
            let bit = i as u32 * width % 8;
            let shift = if width == 1 { bit } else { 8 - width - bit };
            let mut delta = packed[i * width as usize / 8] >> shift & most;
            if delta == most {
                delta = self.take(1)?[0];
            }
            if let Some(it) = deltas.get_mut(i) {
                *it = delta;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshopt_rs::vertex::VertexEncodingVersion::V0;
    use meshopt_rs::vertex::buffer::encode_vertex_buffer;

    /// Test of elements of a size for which the decoder has no array, and of more of them than a block holds.
    fn check<const N: usize>() {
        let element = |i: usize| std::array::from_fn(|k| ((i * i * (k % 5)) / 7 + 31 * k) as u8);
        for count in [0, 1, 16, 31, 300] {
            let elements: Vec<[u8; N]> = (0..count).map(element).collect();
            let mut packed = vec![0; 1 << 18];
            let used = encode_vertex_buffer(&mut packed, &elements, V0).unwrap();
            let unpacked = unpacked(&packed[..used], count, N);
            assert_eq!(
                unpacked.as_deref(),
                Ok(elements.as_flattened()),
                "{count} of {N}"
            );
        }
    }

    #[test]
    fn elements_may_have_any_length_of_fours() {
        check::<4>();
        check::<12>();
        check::<36>();
        check::<100>();
        check::<252>();
        check::<256>();
        for stride in [0, 6, 260] {
            let message = format!("elements of {stride} bytes");
            assert_eq!(unpacked(&[0xa0; 600], 1, stride), Err(message));
        }
    }

    /// 20 elements with all ways and all controls, packed by the package meshoptimizer 1.3.0 for Node.
    const VERSION_1: &str = "a1576755ff0058585858585858585858585858585858585858052aaaaaaaaa0000000205555555555555550f0005050505052aaaaaaaaa\
        000000000e2a46627e9ab6d2eef5d9bda185694d3115060206666666666666660f000606060600628ca5a6a5a6a5a60100a50201317131\
        f13171310f0f001f0103010201317131f13171310f0f001f0103010201317131f13171310f0f001f0103010201317131f13171310f0f00\
        1f010301009d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d9d00f2f4f4f2f4f4f2f4f4f2f4f4f2f4f4f4f2f4f4006e6e706e706e706e706e\
        706e706e706e706e7000c3c3c3c3c1c3c3c3c3c1c3c3c3c1c3c3c3c3c100000000070000000000095a000000000000000001005200";

    #[test]
    fn the_newer_version_is_unpacked() {
        let byte = |at: usize| u8::from_str_radix(&VERSION_1[at..at + 2], 16).unwrap();
        let packed: Vec<u8> = (0..VERSION_1.len()).step_by(2).map(byte).collect();
        let element = |i: u32| {
            let pairs = [300 * i + 7, 65536 - 259 * i].map(|it| it as u16);
            let bytes = [
                (7 * i * i) as u8,
                3 * i as u8,
                9,
                if i.is_multiple_of(5) { 90 } else { 7 },
            ];
            let words = [(i * 0x0101_0101) << 3, i.wrapping_mul(0x9e37_79b1)];
            let [[a, b], [c, d]] = pairs.map(u16::to_le_bytes);
            let [e, f] = words.map(u32::to_le_bytes);
            [[a, b, c, d], bytes, e, f].concat()
        };
        let expected = (0..20).flat_map(element).collect();
        assert_eq!(unpacked(&packed, 20, 16), Ok(expected));
        // A way that there is not, a byte more, and one less.
        let mut unknown = packed.clone();
        *unknown.last_mut().unwrap() = 3;
        let found = unpacked(&unknown, 20, 16).unwrap_err();
        assert_eq!(found, "its differences are of an unknown kind");
        let mut longer = packed.clone();
        longer.insert(200, 0);
        let found = unpacked(&longer, 20, 16).unwrap_err();
        assert_eq!(found, "it has 1 bytes too many");
        assert!(unpacked(&packed[1..], 20, 16).is_err());
    }
}
