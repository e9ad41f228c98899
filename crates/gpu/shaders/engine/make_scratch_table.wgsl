// Pass: the table T(u, d) of a metal, for scratch_table.wgsl. One invocation a texel, groups of 64 along a row. Twin: optics/src/table.rs;
// packages/hairline-shaders/src/table.js makes what it reads, in double precision.
//
// Needs: scratch_table (the size of the table). Bindings, group 0: see below.

struct SpectralWeights {
    samples: u32,
    layer: u32,                     // of the texture
    pad_a: u32,
    pad_b: u32,
    weights: array<vec4f, 81>,      // reflectance over F0 times the weight of each wavelength in each channel
}

@group(0) @binding(0) var<uniform> spectrum: SpectralWeights;
// Integral of sinc^2 over the wavelength, and its derivative by the column, for each wavelength and column.
@group(0) @binding(1) var<storage, read> chords: array<vec2f>;
// |D|^2 for each row and wavelength.
@group(0) @binding(2) var<storage, read> energies: array<f32>;
@group(0) @binding(3) var table: texture_storage_2d_array<rgba32uint, write>;

// Three numbers in one word: nine bits each, and the exponent that they share.
fn pack_slopes(slopes: vec3f) -> u32 {
    let largest = max(max(abs(slopes.x), abs(slopes.y)), abs(slopes.z));
    let wanted = ceil(log2(max(largest / 255.0, 1e-30)));
    let exponent = clamp(wanted + SCRATCH_TABLE_EXPONENT_BIAS, 0.0, 31.0);
    let mantissas = clamp(round(slopes * exp2(SCRATCH_TABLE_EXPONENT_BIAS - exponent)), vec3f(-255.0), vec3f(255.0));
    let bits = bitcast<vec3u>(vec3i(mantissas)) & vec3u(0x1ffu);
    return bits.x | (bits.y << 9u) | (bits.z << 18u) | (u32(exponent) << 27u);
}

@compute @workgroup_size(64)
fn make_scratch_table(@builtin(global_invocation_id) id: vec3u) {
    let columns = u32(SCRATCH_TABLE_COLUMNS);
    if id.x >= columns {
        return;
    }
    var values = vec3f(0.0);
    var slopes = vec3f(0.0);
    for (var s = 0u; s < spectrum.samples; s += 1u) {
        let chord = chords[s * columns + id.x];
        let weight = spectrum.weights[s].xyz * energies[id.y * spectrum.samples + s];
        values += weight * chord.x;
        slopes += weight * chord.y;
    }
    textureStore(table, id.xy, spectrum.layer, vec4u(bitcast<vec3u>(values), pack_slopes(slopes)));
}
