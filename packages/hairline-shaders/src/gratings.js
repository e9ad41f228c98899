// Gratings: rows of grooves side by side, whose light interferes, with the table of what they send.
import { layGratings as lay } from '../engine/engine.js';
import { using } from './scratches.js';
import { COHERENCE_UM, COLUMNS, FINE_ROWS, GRATING_ROWS, ROW_NM } from './data.js';

/** With the constants of groove_field.wgsl. Grooves by texture coordinates lie along a direction that differs from pixel to pixel. */
const KINDS = { along: 0, circular: 1, radial: 2, spun: 3, 'along-u': 0, 'along-v': 0 };

/** Whether grooves follow texture coordinates. */
export const isByUv = ({ kind }) => kind === 'along-u' || kind === 'along-v';

/** Grooves along a direction, about an axis or along texture coordinates, in a mesh's own frame. */
export class Grating {
  constructor({
    texels, kind = 'circular', axis = [0, 0, 1], center = [0, 0, 0], radiiM = [0, 1e9], curvaturePerM = 0, coverage = 1, angleStdRad = 0, coherenceUm = COHERENCE_UM,
    mask = null, directions = null,
  } = {}) {
    const found = texels instanceof Uint32Array ? texels.length / (4 * COLUMNS) : 0;
    const isRight = Number.isInteger(found) && (found === FINE_ROWS || (found >= 2 && found <= GRATING_ROWS));
    if (!isRight) {
      const right = `must be a Uint32Array of ${COLUMNS} columns and 2 to ${GRATING_ROWS} rows, of a fine grating ${FINE_ROWS}, four numbers each: of a file, of layGratings() or of loadGrating()`;
      throw new Error(`texels: found ${texels?.length ?? 'none'}; ${right}`);
    }
    if (!Object.hasOwn(KINDS, kind)) throw new Error(`kind: found ${JSON.stringify(kind)}; must be one of ${Object.keys(KINDS).join(', ')}`);
    for (const [name, picture] of Object.entries({ mask, directions })) {
      if (picture !== null && !picture?.isTexture) throw new Error(`${name}: found something else; must be a Texture of three.js, or null`);
    }
    if (directions !== null && !isByUv({ kind })) throw new Error(`directions: found a picture for grooves of kind ${JSON.stringify(kind)}; must be along-u or along-v`);
    const length = Math.hypot(...axis);
    if (!(length > 0)) throw new Error(`axis: found ${JSON.stringify(axis)}; must be three numbers that are not all 0`);
    Object.assign(this, { texels, kind, center, radiiM, curvaturePerM, coverage, angleStdRad, coherenceUm, mask, directions });
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
    return [...axis, KINDS[kind], ...center, curvaturePerM, ...radiiM, coverage, angleStdRad, coherenceUm, Number(rows === FINE_ROWS), 0, (rows - 1) * ROW_NM];
  }
}

/**
 * Rows of grooves by the keys of `[[grating]]` in docs/scene.md, but `object`: a Grating for each that is not hidden. `metal` null: one given by its colour.
 * `pictures`: Textures of three.js by the names that `mask` and `directions` of rows have. Brightness of orders is that of `theory = "scalar"`.
 */
export function layGratings(rows, { metal = null, coherenceUm = COHERENCE_UM, pictures = {} } = {}) {
  const shown = [rows].flat().filter(({ hidden }) => !hidden);
  const bare = shown.map(({ mask, directions, ...row }) => ({ object: 'mesh', ...row }));
  const pictureOf = (i, key) => {
    const name = shown[i][key];
    if (name !== undefined && !pictures[name]) throw new Error(`grating[${i}].${key}: found ${JSON.stringify(name)}; must be the name of one of \`pictures\``);
    return name === undefined ? null : pictures[name];
  };
  return lay(JSON.stringify(bare), metal ?? undefined, coherenceUm).map((grooves, i) => using(grooves, (held) => {
    const numbers = Array.from(held.numbers());
    const [curvaturePerM, coverage, angleStdRad] = numbers.slice(8);
    const kind = held.kind();
    return new Grating({
      texels: held.texels(), kind, axis: isByUv({ kind }) ? undefined : numbers.slice(0, 3), center: numbers.slice(3, 6), radiiM: numbers.slice(6, 8),
      curvaturePerM, coverage, angleStdRad, coherenceUm, mask: pictureOf(i, 'mask'), directions: pictureOf(i, 'directions'),
    });
  }));
}

/** Fetches the table of a grating, such as `cd` of hairline-shaders/cd; `options` are those of Grating. */
export async function loadGrating(url, options = {}) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return new Grating({ ...options, texels: new Uint32Array(await response.arrayBuffer()) });
}
