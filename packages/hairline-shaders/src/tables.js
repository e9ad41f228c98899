// The tables of the base: shapes and albedo of rough lobes, and how reflectance goes with the angle.
import { checkMetal, metals } from './spectrum.js';

const SIZE = 32;
const SHAPE_ROWS = 224;
const CURVE_WIDTH = 128;
const CURVE_ROWS = 9;

/** Three textures, rgba32float: `{ data, width, height }` each. */
export class Tables {
  /** Of the bytes of tables.bin. */
  constructor(bytes) {
    const texels = [SIZE * SHAPE_ROWS, SIZE * SIZE, CURVE_WIDTH * CURVE_ROWS * (metals.length + 2)];
    const wanted = 16 * texels.reduce((a, b) => a + b);
    if (bytes.byteLength !== wanted) throw new Error(`tables.bin: found ${bytes.byteLength} bytes; must be ${wanted}, of the same version as the scripts`);
    let at = 0;
    const [shapes, albedo, curves] = texels.map((count) => {
      const data = new Float32Array(bytes, at, 4 * count);
      at += 16 * count;
      return data;
    });
    this.shapes = { data: shapes, width: SIZE, height: SHAPE_ROWS };
    this.albedo = { data: albedo, width: SIZE, height: SIZE };
    this.curves = { data: curves, width: CURVE_WIDTH, height: curves.length / 4 / CURVE_WIDTH };
  }
}

/** The curve of a metal, for FresnelRgb; null: Schlick's, for colours. */
export function curveOf(metal) {
  checkMetal(metal);
  return metal === null ? 0 : 1 + metals.indexOf(metal);
}

/** The curve of a dielectric of refractive index 1.5, of which clear coats are. */
export const dielectricCurve = 1 + metals.length;

/** Fetches tables.bin from beside the package's folder `src`, or from an address. */
export async function loadTables(url = new URL('../tables.bin', import.meta.url)) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return new Tables(await response.arrayBuffer());
}
