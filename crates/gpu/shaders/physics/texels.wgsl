// Places of the elements of an array in a texture, 16 bytes a texel, row after row. Twin: src/rows.rs writes them.

// Texels to a row.
const ROW_BITS: u32 = 12u;

// Place of texel `i`.
fn row_texel(i: u32) -> vec2u {
    return vec2u(i & ((1u << ROW_BITS) - 1u), i >> ROW_BITS);
}
