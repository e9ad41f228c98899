// The table T(u, d) of a metal, which scratch_table.wgsl looks up.
import { scratchTable as table } from '../engine/engine.js';
import { COLUMNS } from './data.js';

/** What a surface without scratches has in the place of a tree's: the first shape of every list, and the fewest rows. */
export const noScratches = Object.freeze({ shapes: Object.freeze([Object.freeze({ profile: 'rectangle', widthClass: 0 })]), tableRows: 2 });

/**
 * The tables of a metal's scratches: `{ texels, columns, rows, layers }`, four numbers a texel, a layer for each of the `shapes` that scratchTree() returned, as deep
 * as its deepest scratch. `metal` null: a metal given by its colour. An array of metals: the layers of one after those of the other.
 */
export function scratchTables(metal, { shapes, tableRows }) {
  const layers = [metal].flat().flatMap((each) => shapes.map(({ profile, widthClass }) => table(each ?? undefined, JSON.stringify(profile), widthClass, tableRows)));
  const texels = new Uint32Array(layers.length * layers[0].length);
  layers.forEach((layer, i) => texels.set(layer, i * layer.length));
  return { texels, columns: COLUMNS, rows: tableRows, layers: layers.length };
}

/** The same as a texture_2d_array<u32>. */
export function makeScratchTables(device, metal, scratches) {
  const { texels, columns, rows, layers } = scratchTables(metal, scratches);
  const size = [columns, rows, layers];
  const texture = device.createTexture({
    label: 'scratch tables', size, format: 'rgba32uint', usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
  });
  device.queue.writeTexture({ texture }, texels, { bytesPerRow: 16 * columns, rowsPerImage: rows }, size);
  return texture;
}
