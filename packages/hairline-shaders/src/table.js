// The table T(u, d) of a metal, which scratch_table.wgsl looks up.
import { scratchTable as table } from '../engine/engine.js';
import { COLUMNS, ROWS } from './data.js';
import { checkMetal } from './metals.js';

/** Size of the table: an rgba32uint texture of one layer a metal. */
export const tableSize = { columns: COLUMNS, rows: ROWS };

/** Grooves that need no other shape: their table is the first one of every metal. */
export const narrowRectangle = Object.freeze({ profile: 'rectangle', widthClass: 0 });

/**
 * The texels of a metal's table, four numbers each (some tenths of a second). `metal` null: a metal given by its colour. `shape`: one of those that
 * scratchTree() returns.
 */
export function scratchTable(metal, { profile, widthClass } = narrowRectangle) {
  checkMetal(metal);
  return table(metal ?? undefined, JSON.stringify(profile), widthClass);
}

/** The same as a texture_2d_array<u32>: a layer for each metal, or for each shape of its grooves one after the other. */
export function makeScratchTable(device, metal, shapes = [narrowRectangle]) {
  const layers = [metal].flat().flatMap((each) => shapes.map((shape) => scratchTable(each, shape)));
  const texture = device.createTexture({
    label: 'scratch tables', size: [COLUMNS, ROWS, layers.length], format: 'rgba32uint', usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
  });
  layers.forEach((texels, layer) => {
    device.queue.writeTexture({ texture, origin: [0, 0, layer] }, texels, { bytesPerRow: 16 * COLUMNS }, [COLUMNS, ROWS, 1]);
  });
  return texture;
}
