// Gratings: rows of grooves side by side, whose light interferes, with the table of what they send.
import { COHERENCE_UM, COLUMNS, FINE_ROWS, GRATING_ROWS, ROW_NM } from './data.js';

const KINDS = ['along', 'circular', 'radial', 'spun'];
/** Gratings that the package has tables of. */
const PRESETS = ['cd', 'dvd'];

/** Grooves along a direction or about an axis, in a mesh's own frame. */
export class Grating {
  constructor({
    texels, kind = 'circular', axis = [0, 0, 1], center = [0, 0, 0], radiiM = [0, 1e9], curvaturePerM = 0, coverage = 1, angleStdRad = 0, coherenceUm = COHERENCE_UM,
  } = {}) {
    const found = texels instanceof Uint32Array ? texels.length / (4 * COLUMNS) : 0;
    const isRight = Number.isInteger(found) && (found === FINE_ROWS || (found >= 2 && found <= GRATING_ROWS));
    if (!isRight) {
      const right = `must be a Uint32Array of ${COLUMNS} columns and 2 to ${GRATING_ROWS} rows, of a fine grating ${FINE_ROWS}, four numbers each: of a file or of loadGrating()`;
      throw new Error(`texels: found ${texels?.length ?? 'none'}; ${right}`);
    }
    if (!KINDS.includes(kind)) throw new Error(`kind: found ${JSON.stringify(kind)}; must be one of ${KINDS.join(', ')}`);
    const length = Math.hypot(...axis);
    if (!(length > 0)) throw new Error(`axis: found ${JSON.stringify(axis)}; must be three numbers that are not all 0`);
    Object.assign(this, { texels, kind, center, radiiM, curvaturePerM, coverage, angleStdRad, coherenceUm });
    this.axis = axis.map((x) => x / length);
  }

  get columns() {
    return COLUMNS;
  }

  /** Rows of its table. */
  get rows() {
    return this.texels.length / (4 * COLUMNS);
  }

  get layers() {
    return 1;
  }

  /** What shaders are given: `Grooves` of grated_surface.wgsl, in 16 numbers. */
  get numbers() {
    const { axis, kind, center, curvaturePerM, radiiM, coverage, angleStdRad, coherenceUm, rows } = this;
    return [...axis, KINDS.indexOf(kind), ...center, curvaturePerM, ...radiiM, coverage, angleStdRad, coherenceUm, Number(rows === FINE_ROWS), 0, (rows - 1) * ROW_NM];
  }
}

/** Fetches the table of a grating that the package has, "cd" or "dvd" in aluminium; `options` are those of Grating. */
export async function loadGrating(name, options = {}, url = new URL(`../gratings/${name}.bin`, import.meta.url)) {
  if (!PRESETS.includes(name)) throw new Error(`grating: found ${JSON.stringify(name)}; must be one of ${PRESETS.join(', ')}`);
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return new Grating({ ...options, texels: new Uint32Array(await response.arrayBuffer()) });
}
