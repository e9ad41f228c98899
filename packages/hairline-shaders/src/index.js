// hairline-shaders: scratches that split light into colours, for engines on WebGPU. README.md shows how they are put together.
export { hairlineWgsl, makeScratchTableWgsl } from './wgsl.js';
export { Tables, curveOf, loadTables } from './tables.js';
export { makeScratchTable, scratchTable, tableSize } from './table.js';
export { Scratches, preparedPieces, readScratches, scratchEnds } from './scratches.js';
export { scratchTree } from './tree.js';
export { Grating, loadGrating } from './gratings.js';
export { layScratches } from './pattern.js';
export { depthCoherence, metalColor, metals } from './spectrum.js';
