//! A hash of 32-bit words for numbers that all renderers must draw alike. Twin: `sobol_hash` of sobol.wgsl.

/// Mixes a word well. C. Wellons, "hash prospector", 2018.
pub fn word_hash(word: u32) -> u32 {
    let mut x = word;
    x ^= x >> 16;
    x = x.wrapping_mul(0x21f0_aaad);
    x ^= x >> 15;
    x = x.wrapping_mul(0x735a_2d97);
    x ^ (x >> 15)
}
