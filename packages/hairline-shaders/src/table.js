// The table T(u, d) of a metal, which scratch_table.wgsl looks up: by the processor, or by a pass on a GPU. Twin: crates/optics/src/table.rs.
import { checkMetal, phaseStepEnergy, reflectance, metalColor, samples } from './spectrum.js';
import { COLUMNS, ROWS } from './data.js';
import { grooveSpectrum } from './groove_spectrum.js';
import { checkProfile, isSameShape, narrowRectangle, partCount, widthsOfPart } from './section.js';
import { makeScratchTableWgsl } from './wgsl.js';

const DEPTH_MAX_NM = 2000;
const U_HALF_UM = 2;
const EXPONENT_BIAS = 36;

/** Size of the table: an rgba32uint texture of one layer a metal. */
export const tableSize = { columns: COLUMNS, rows: ROWS };

/** The integral of sin(x)/x from 0 to x, for x >= 0. */
function sineIntegral(x) {
  if (x < 20) {
    let term = x;
    let sum = x;
    for (let n = 1; Math.abs(term) > 1e-17 * Math.abs(sum) && n < 200; n += 1) {
      term *= (-x * x) / (2 * n * (2 * n + 1));
      sum += term / (2 * n + 1);
    }
    return sum;
  }
  // The asymptotic series; its smallest term is e^-20.
  let [f, g, term] = [0, 0, 1 / x];
  for (let n = 0; n < 18; n += 2) {
    f += term;
    g += (term * (n + 1)) / x;
    term *= (-(n + 1) * (n + 2)) / (x * x);
  }
  return Math.PI / 2 - f * Math.cos(x) - g * Math.sin(x);
}

/** The integral of sinc^2 over a chord from 0 to u at a wavelength, both in micrometres. */
export function sincSquaredIntegral(uUm, wavelengthUm) {
  if (!Number.isFinite(uUm)) return wavelengthUm / 2;
  const k = (2 * Math.PI) / wavelengthUm;
  const x = k * uUm;
  if (x < 1e-2) return uUm * (1 - (x * x) / 36);
  return (2 * sineIntegral(x)) / k - (4 * Math.sin(x / 2) ** 2) / (k * x);
}

/** The u of a column. */
export function columnUm(column) {
  const x = column / (COLUMNS - 1);
  return (U_HALF_UM * x) / (1 - x);
}

/** The depth of a row. */
export function rowNm(row) {
  return (row * DEPTH_MAX_NM) / (ROWS - 1);
}

let shared;

/** What tables of all metals share: for each wavelength and column the integral and its slope; for each row and wavelength |D|^2. */
function factors() {
  if (shared) return shared;
  const chords = new Float64Array(2 * samples.length * COLUMNS);
  const energies = new Float64Array(samples.length * ROWS);
  samples.forEach(({ nm }, s) => {
    const wavelength = nm * 1e-3;
    const k = (2 * Math.PI) / wavelength;
    for (let column = 0; column < COLUMNS; column += 1) {
      const u = columnUm(column);
      const at = 2 * (s * COLUMNS + column);
      chords[at] = sincSquaredIntegral(u, wavelength) / wavelength;
      const half = (k * u) / 2;
      const sinc = half < 1e-4 ? 1 - (half * half) / 6 : Math.sin(half) / half;
      chords[at + 1] = column === COLUMNS - 1
        // sinc^2 averages to 2 / (k u)^2 far out, which du/dx grows to meet.
        ? wavelength / (2 * Math.PI ** 2 * U_HALF_UM * (COLUMNS - 1))
        : (sinc ** 2 * (u + U_HALF_UM) ** 2) / (U_HALF_UM * (COLUMNS - 1)) / wavelength;
    }
    for (let row = 0; row < ROWS; row += 1) energies[row * samples.length + s] = phaseStepEnergy(rowNm(row), nm);
  });
  shared = { chords, energies };
  return shared;
}

/** For each wavelength its weight in the table of a metal, four numbers each. */
function weights(metal) {
  const f0 = metal === null ? [1, 1, 1] : metalColor(metal);
  return samples.flatMap(({ nm, weight }) => [...weight.map((w, c) => (w * reflectance(metal, nm)) / f0[c]), 0]);
}

function packSlopes(r, g, b) {
  const largest = Math.max(Math.abs(r), Math.abs(g), Math.abs(b));
  const wanted = Math.ceil(Math.log2(Math.max(largest / 255, 1e-300)));
  const exponent = Math.min(Math.max(wanted + EXPONENT_BIAS, 0), 31);
  const scale = 2 ** (EXPONENT_BIAS - exponent);
  const mantissa = (slope) => Math.min(Math.max(Math.round(slope * scale), -255), 255) & 0x1ff;
  return (mantissa(r) | (mantissa(g) << 9) | (mantissa(b) << 18) | (exponent << 27)) >>> 0;
}

/** Texels of rows, each of which `fill` adds up: six numbers a column, T in three channels and their slopes. */
function texelsOf(fill) {
  const texels = new Uint32Array(4 * COLUMNS * ROWS);
  const floats = new Float32Array(texels.buffer);
  const sums = new Float64Array(6 * COLUMNS);
  for (let row = 0; row < ROWS; row += 1) {
    sums.fill(0);
    fill(row, sums);
    for (let column = 0; column < COLUMNS; column += 1) {
      const texel = 4 * (row * COLUMNS + column);
      const sum = 6 * column;
      for (let c = 0; c < 3; c += 1) floats[texel + c] = sums[sum + c];
      texels[texel + 3] = packSlopes(sums[sum + 3], sums[sum + 4], sums[sum + 5]);
    }
  }
  return texels;
}

const spectra = new WeakMap();

/** The spectrum of a shape, made once for all metals. */
function spectrumOf(shape) {
  if (!spectra.has(shape)) spectra.set(shape, grooveSpectrum(shape));
  return spectra.get(shape);
}

/** The table of grooves of a shape: sums over wavelengths of their spectrum. */
function shapedTable(metal, shape) {
  const widths = widthsOfPart(shape);
  const parts = partCount(shape);
  const weight = weights(metal).map((w) => (w * widths) / parts);
  const spectrum = spectrumOf(shape);
  const columns = Float64Array.from({ length: COLUMNS }, (_, column) => columnUm(column));
  const lit = new Float64Array(2);
  return texelsOf((row, sums) => {
    samples.forEach(({ nm }, s) => {
      const perUm = (widths * 1e3) / nm;
      const ofRow = spectrum(rowNm(row) / nm);
      for (let column = 0; column < COLUMNS; column += 1) {
        const u = columns[column];
        ofRow.at(perUm * u, lit);
        const slope = column === COLUMNS - 1
          ? ofRow.tail / (perUm * U_HALF_UM * (COLUMNS - 1))
          : (lit[0] * perUm * (u + U_HALF_UM) ** 2) / (U_HALF_UM * (COLUMNS - 1));
        for (let c = 0; c < 3; c += 1) {
          sums[6 * column + c] += weight[4 * s + c] * lit[1];
          sums[6 * column + 3 + c] += weight[4 * s + c] * slope;
        }
      }
    });
  });
}

/**
 * The texels of a metal's table, by the processor (about 0.1 s; 0.8 s for grooves of another shape, one of those that preparedPieces() returns).
 * `metal` null: a metal given by its colour. Four numbers a texel: T in three channels as bits of f32, and their slopes, packed.
 */
export function scratchTable(metal, shape = narrowRectangle) {
  checkMetal(metal);
  checkProfile(shape.profile);
  if (!isSameShape(shape, narrowRectangle)) return shapedTable(metal, shape);
  const { chords, energies } = factors();
  const weight = weights(metal);
  const count = samples.length;
  return texelsOf((row, sums) => {
    for (let s = 0; s < count; s += 1) {
      const energy = energies[row * count + s];
      const [r, g, b] = [weight[4 * s] * energy, weight[4 * s + 1] * energy, weight[4 * s + 2] * energy];
      for (let column = 0, at = 2 * s * COLUMNS; column < COLUMNS; column += 1, at += 2) {
        const value = chords[at];
        const slope = chords[at + 1];
        const sum = 6 * column;
        sums[sum] += r * value;
        sums[sum + 1] += g * value;
        sums[sum + 2] += b * value;
        sums[sum + 3] += r * slope;
        sums[sum + 4] += g * slope;
        sums[sum + 5] += b * slope;
      }
    }
  });
}

/**
 * The same by a pass on a GPU: a texture_2d_array<u32> with a layer for each metal, or for each shape of its grooves one after the other, which
 * the processor makes but for narrow rectangles. The pass has been submitted when it returns.
 */
export function makeScratchTable(device, metal, shapes = [narrowRectangle]) {
  const list = Array.isArray(metal) ? metal : [metal];
  list.forEach(checkMetal);
  const layers = list.flatMap((each) => shapes.map((shape) => ({ metal: each, shape })));
  const texture = device.createTexture({
    label: 'scratch tables',
    size: [COLUMNS, ROWS, layers.length],
    format: 'rgba32uint',
    usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.STORAGE_BINDING | GPUTextureUsage.COPY_SRC | GPUTextureUsage.COPY_DST,
  });
  const { chords, energies } = factors();
  const buffer = (data, usage) => {
    const made = device.createBuffer({ size: data.byteLength, usage, mappedAtCreation: true });
    new Uint8Array(made.getMappedRange()).set(new Uint8Array(data.buffer));
    made.unmap();
    return made;
  };
  const chordBuffer = buffer(Float32Array.from(chords), GPUBufferUsage.STORAGE);
  const energyBuffer = buffer(Float32Array.from(energies), GPUBufferUsage.STORAGE);
  const module = device.createShaderModule({ label: 'make_scratch_table', code: makeScratchTableWgsl });
  const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module, entryPoint: 'make_scratch_table' } });
  const encoder = device.createCommandEncoder();
  const view = texture.createView({ dimension: '2d-array' });
  layers.forEach(({ metal: each, shape }, layer) => {
    if (!isSameShape(shape, narrowRectangle)) {
      const to = { texture, origin: [0, 0, layer] };
      device.queue.writeTexture(to, scratchTable(each, shape), { bytesPerRow: 16 * COLUMNS }, [COLUMNS, ROWS, 1]);
      return;
    }
    const spectrum = new ArrayBuffer(16 + 16 * samples.length);
    new Uint32Array(spectrum, 0, 2).set([samples.length, layer]);
    new Float32Array(spectrum, 16).set(weights(each));
    const uniform = buffer({ byteLength: spectrum.byteLength, buffer: spectrum }, GPUBufferUsage.UNIFORM);
    const resources = [{ buffer: uniform }, { buffer: chordBuffer }, { buffer: energyBuffer }, view];
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({
      layout: pipeline.getBindGroupLayout(0),
      entries: resources.map((resource, binding) => ({ binding, resource })),
    }));
    pass.dispatchWorkgroups(Math.ceil(COLUMNS / 64), ROWS);
    pass.end();
  });
  device.queue.submit([encoder.finish()]);
  return texture;
}
