// Gratings: rows of grooves side by side, whose light interferes, with the table of what they send.
import { COHERENCE_UM } from './data.js';
import { tableSize } from './table.js';

const KINDS = ['along', 'circular', 'radial', 'spun'];
/** Rows of a table by the direction to the viewer, which fine gratings have. */
const FINE_ROWS = 512;
/** Gratings that the package has tables of. */
const PRESETS = ['cd', 'dvd'];

/** Grooves along a direction or about an axis, in a mesh's own frame. */
export class Grating {
  constructor({
    texels, kind = 'circular', axis = [0, 0, 1], center = [0, 0, 0], radiiM = [0, 1e9], curvaturePerM = 0, coverage = 1, angleStdRad = 0, coherenceUm = COHERENCE_UM,
  } = {}) {
    const sizes = [tableSize.rows, FINE_ROWS].map((rows) => 4 * tableSize.columns * rows);
    if (!(texels instanceof Uint32Array) || !sizes.includes(texels.length)) {
      throw new Error(`texels: found ${texels?.length ?? 'none'}; must be a Uint32Array of ${sizes.join(' or ')} numbers, of a file or of loadGrating()`);
    }
    if (!KINDS.includes(kind)) throw new Error(`kind: found ${JSON.stringify(kind)}; must be one of ${KINDS.join(', ')}`);
    const length = Math.hypot(...axis);
    if (!(length > 0)) throw new Error(`axis: found ${JSON.stringify(axis)}; must be three numbers that are not all 0`);
    Object.assign(this, { texels, kind, center, radiiM, curvaturePerM, coverage, angleStdRad, coherenceUm });
    this.axis = axis.map((x) => x / length);
  }

  /** Rows of its table. */
  get rows() {
    return this.texels.length / (4 * tableSize.columns);
  }

  /** What shaders are given: `Grooves` of grated_surface.wgsl, in 16 numbers. */
  get numbers() {
    const { axis, kind, center, curvaturePerM, radiiM, coverage, angleStdRad, coherenceUm, rows } = this;
    return [...axis, KINDS.indexOf(kind), ...center, curvaturePerM, ...radiiM, coverage, angleStdRad, coherenceUm, Number(rows === FINE_ROWS), 0, 0];
  }
}

/** Fetches the table of a grating that the package has, "cd" or "dvd" in aluminium; `options` are those of Grating. */
export async function loadGrating(name, options = {}, url = new URL(`../gratings/${name}.bin`, import.meta.url)) {
  if (!PRESETS.includes(name)) throw new Error(`grating: found ${JSON.stringify(name)}; must be one of ${PRESETS.join(', ')}`);
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return new Grating({ ...options, texels: new Uint32Array(await response.arrayBuffer()) });
}
