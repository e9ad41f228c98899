//! Features of WebAssembly that a program needs beyond its first version: browsers that lack one of them refuse it as a whole.

use std::fs;
use std::path::Path;

use anyhow::{Context, bail, ensure};

/// Features of all browsers with WebGPU, by the names of the compiler.
const OF_BROWSERS: [&str; 9] = [
    "bulk-memory",
    "bulk-memory-opt",
    "call-indirect-overlong",
    "multivalue",
    "mutable-globals",
    "nontrapping-fptoint",
    "reference-types",
    "sign-ext",
    "simd128",
];

/// Fails where the compiler was allowed a feature that some browsers lack. One function that asks for it, of any crate, is enough: link-time
/// optimisation then uses it in all.
pub(super) fn check(program: &Path) -> anyhow::Result<()> {
    let bytes = fs::read(program)?;
    let used = used(&bytes).with_context(|| program.display().to_string())?;
    for feature in used {
        ensure!(
            OF_BROWSERS.contains(&feature),
            "{} uses {feature} of WebAssembly, which some browsers with WebGPU lack; a crate has a function with this target feature \
             (hairline_optics::vectors tells what came of it)",
            program.display()
        );
    }
    Ok(())
}

/// The features in use, by the section `target_features` of the WebAssembly tool conventions.
fn used(bytes: &[u8]) -> anyhow::Result<Vec<&str>> {
    let mut rest = bytes
        .strip_prefix(b"\0asm\x01\0\0\0")
        .context("it is no WebAssembly program")?;
    while let Some((id, after)) = rest.split_first() {
        rest = after;
        let mut section = sized(&mut rest)?;
        let is_custom = *id == 0;
        if is_custom && sized(&mut section)? == b"target_features" {
            return features(section);
        }
    }
    bail!("it does not tell its features")
}

/// A count, then a sign and a name each; "+" are those in use.
fn features(mut section: &[u8]) -> anyhow::Result<Vec<&str>> {
    let mut names = Vec::new();
    for _ in 0..number(&mut section)? {
        let (sign, after) = section.split_first().context(CUT_SHORT)?;
        section = after;
        let name = std::str::from_utf8(sized(&mut section)?)?;
        if *sign == b'+' {
            names.push(name);
        }
    }
    Ok(names)
}

const CUT_SHORT: &str = "it is cut short";

/// Bytes with their count before them.
fn sized<'a>(bytes: &mut &'a [u8]) -> anyhow::Result<&'a [u8]> {
    let count = number(bytes)?;
    let (taken, after) = bytes.split_at_checked(count).context(CUT_SHORT)?;
    *bytes = after;
    Ok(taken)
}

/// A whole number of 32 bits, seven in a byte, the lowest first.
fn number(bytes: &mut &[u8]) -> anyhow::Result<usize> {
    let mut value = 0;
    for shift in (0..35).step_by(7) {
        let (byte, after) = bytes.split_first().context(CUT_SHORT)?;
        *bytes = after;
        value |= usize::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Ok(value);
        }
    }
    bail!("a number has more than 32 bits")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_in_use_are_found_behind_other_sections() {
        let mut program = b"\0asm\x01\0\0\0".to_vec();
        let code = [10_u8, 0x80, 0x01];
        program.extend(code);
        program.extend([0; 128]);
        let features = b"\x0ftarget_features\x02+\x07simd128-\x07atomics";
        program.extend([0, features.len() as u8]);
        program.extend(features);
        assert_eq!(used(&program).unwrap(), ["simd128"]);
        program.truncate(program.len() - 3);
        assert!(used(&program).is_err(), "cut short");
        assert!(used(b"\0asm\x01\0\0\0").is_err(), "no section");
    }
}
