// hairline-shaders: scratches that split light into colours, for engines on WebGPU. README.md shows how they are put together.
export { hairlineWgsl } from './wgsl.js';
export { Tables, loadTables } from './tables.js';
export { makeScratchTables, scratchTables } from './table.js';
export { Scratches, layScratches, readScratches, scratchTree } from './scratches.js';
export { Grating, layGratings, loadGrating } from './gratings.js';
export { curveOf, dielectricCurve, metalColor, metals } from './metals.js';
