// Scratches of a mesh as lists of straight pieces. Hairline's own code lays them, and makes the texture that shaders find them by.
import { Files, Laid, Tree } from '../engine/engine.js';
import { COHERENCE_UM, SIZES, TREE_WIDTH } from './data.js';
import { needsTables } from './tables.js';

const RECTANGLE = 'rectangle';

/**
 * Scratches: one entry of each array for every straight piece. Pieces of one scratch follow one another and have its number in `scratch`.
 * Positions are in the object's own frame. `normals` is null where they are not known: such scratches show on both sides of a sheet.
 * `profiles` has the cross section of each piece, alike for all pieces of a scratch: a name, or depths from the middle to the rim; null: all
 * are rectangles.
 */
export class Scratches {
  constructor({ starts, ends, widthsUm, depthsNm, scratch, normals = null, profiles = null }) {
    const count = widthsUm.length;
    const fits = starts.length === 3 * count && ends.length === 3 * count && depthsNm.length === count && scratch.length === count
      && (normals === null || normals.length === 3 * count) && (profiles === null || profiles.length === count);
    if (!fits) throw new Error(`scratches: found arrays of different lengths; must be three numbers for each of ${count} pieces, or one`);
    Object.assign(this, { starts, ends, widthsUm, depthsNm, scratch, normals, profiles });
  }

  /** Number of straight pieces. */
  get count() {
    return this.widthsUm.length;
  }

  /** Moves them by a matrix of 16 numbers, column by column (`Matrix4.elements` of three.js). */
  transformed(m) {
    const apply = (from, w) => {
      const to = new Float32Array(from.length);
      for (let i = 0; i < from.length; i += 3) {
        for (let k = 0; k < 3; k += 1) to[i + k] = m[k] * from[i] + m[4 + k] * from[i + 1] + m[8 + k] * from[i + 2] + w * m[12 + k];
      }
      return to;
    };
    return new Scratches({
      ...this, starts: apply(this.starts, 1), ends: apply(this.ends, 1), normals: this.normals && apply(this.normals, 0),
    });
  }

  /** These and `other`, which lie on the same mesh. */
  joined(other) {
    if (!this.normals !== !other.normals) throw new Error('scratches: found some with normals and some without; must be all or none');
    const join = (name) => Float32Array.from([...this[name], ...other[name]]);
    const profiles = (of) => of.profiles ?? new Array(of.count).fill(RECTANGLE);
    const first = this.scratch.reduce((most, number) => Math.max(most, number + 1), 0);
    return new Scratches({
      starts: join('starts'),
      ends: join('ends'),
      widthsUm: join('widthsUm'),
      depthsNm: join('depthsNm'),
      scratch: Uint32Array.from([...this.scratch, ...other.scratch.map((number) => number + first)]),
      normals: this.normals && join('normals'),
      profiles: this.profiles || other.profiles ? [...profiles(this), ...profiles(other)] : null,
    });
  }
}

const ENDS = ['x0_m', 'y0_m', 'z0_m', 'x1_m', 'y1_m', 'z1_m'];
const COLUMNS = [...ENDS, ...SIZES.map(([name]) => name)];
const MORE = ['scratch', 'nx', 'ny', 'nz'];

/**
 * Reads a list: the CSV of docs/scene.md, a straight scratch a row, or what `hairline scratches` writes, a straight piece a row with the
 * number of its scratch, and the normal or not. A mistake is an Error with its line. `profile`: the cross section of all of them, as in scene files.
 */
export function readScratches(text, name = 'scratches.csv', { profile = RECTANGLE } = {}) {
  const lines = text.replace(/^\ufeff/, '').split(/\r?\n/);
  const first = lines.findIndex((line) => line.trim() !== '');
  const header = (lines[first] ?? '').split(',').map((cell) => cell.trim()).join(',');
  const [short, long] = [COLUMNS.join(','), [...COLUMNS, ...MORE].join(',')];
  if (![short, `${short},${MORE[0]}`, long].includes(header)) {
    throw new Error(`${name}:${first + 1}: found \`${header.slice(0, 80)}\`; must be the header \`${short}\` or \`${long}\``);
  }
  const columns = header.split(',');
  const rows = [];
  for (let i = first + 1; i < lines.length; i += 1) {
    if (lines[i].trim() === '') continue;
    const cells = lines[i].split(',');
    if (cells.length !== columns.length) {
      throw new Error(`${name}:${i + 1}: found ${cells.length} cells; must be ${columns.length}, as in the header`);
    }
    const row = cells.map((cell, c) => {
      const value = cell.trim() === '' ? NaN : Number(cell);
      if (!Number.isFinite(value)) throw new Error(`${name}:${i + 1}: ${columns[c]}: found "${cell.trim().slice(0, 40)}"; must be a number`);
      return value;
    });
    SIZES.forEach(([column, least, most], k) => {
      const value = row[ENDS.length + k];
      if (!(value >= least && value <= most)) throw new Error(`${name}:${i + 1}: ${column}: found ${value}; must be from ${least} to ${most}`);
    });
    rows.push(row);
  }
  const pick = (...at) => Float32Array.from(rows.flatMap((row) => at.map((c) => row[c])));
  return new Scratches({
    starts: pick(0, 1, 2),
    ends: pick(3, 4, 5),
    widthsUm: pick(6),
    depthsNm: pick(7),
    scratch: columns.length > COLUMNS.length ? Uint32Array.from(rows, (row) => row[8]) : Uint32Array.from(rows.keys()),
    normals: header === long ? pick(9, 10, 11) : null,
    profiles: profilesOf(profile, rows.length),
  });
}

/** The profiles of pieces that share one. */
export function profilesOf(profile, count) {
  return profile === RECTANGLE ? null : new Array(count).fill(profile);
}

/** Calls with what WebAssembly holds, and lets it go; after an error the browser does. */
export function using(held, call) {
  const made = call(held);
  held.free();
  return made;
}

/**
 * Lays one layer or several on a mesh, as Hairline does: a seed means the same scratches. A layer has the keys of `[[scratches]]` in docs/scene.md, but
 * `object`. A mesh is `{ positions, index, normals, uvs }`, arrays of numbers in the object's own frame; without `index` it is a soup of triangles, without
 * `normals` each is flat, `uvs` are for pictures. `files`: what the layers name, pictures `{ width, rgba }`, drawings `{ svg }` as bytes, and lists of straight scratches in metres `{ endsM, widthsUm, depthsNm }`;
 * with `scratches` of their pieces, of which those side by side with one number are one scratch.
 */
export function layScratches({ positions, index = null, normals = null, uvs = null }, layers, { metresPerUnit = 1, files = {} } = {}) {
  const rows = [layers].flat().map((layer) => ({ object: 'mesh', ...layer }));
  const numbers = (array) => (array === null ? undefined : Float64Array.from(array));
  const corners = index === null ? Uint32Array.from({ length: positions.length / 3 }, (_, i) => i) : Uint32Array.from(index);
  needsTables('scratches');
  return using(new Files(), (held) => {
    for (const [name, { width, rgba, svg, endsM, widthsUm, depthsNm, scratches }] of Object.entries(files)) {
      if (rgba) held.picture(name, width, rgba);
      else if (svg) held.drawing(name, svg);
      else held.list(name, ...[endsM, widthsUm, depthsNm].map(numbers), scratches && Uint32Array.from(scratches));
    }
    return using(new Laid(numbers(positions), numbers(normals), numbers(uvs), corners, JSON.stringify(rows), held, metresPerUnit), (laid) => {
      const profiles = Array.from(laid.layers(), (i) => rows[i].profile ?? RECTANGLE);
      return new Scratches({
        starts: laid.starts(), ends: laid.ends(), normals: laid.normals(), widthsUm: laid.widthsUm(), depthsNm: laid.depthsNm(), scratch: laid.scratch(),
        profiles: profiles.every((profile) => profile === RECTANGLE) ? null : profiles,
      });
    });
  });
}

/**
 * The texture that shaders find scratches by: texels of rgba32uint, four numbers each, `width` and `height` in texels; the shapes of the grooves, each of
 * which needs a table; and the rows that these need for the deepest one. `metresPerUnit`: how long a unit of the object's frame is in the world.
 */
export function scratchTree({ starts, ends, normals, widthsUm, depthsNm, scratch, profiles }, { coherenceUm = COHERENCE_UM, metresPerUnit = 1 } = {}) {
  const known = new Map([[JSON.stringify(RECTANGLE), 0]]);
  const numberOf = (profile) => {
    const key = JSON.stringify(profile);
    if (!known.has(key)) known.set(key, known.size);
    return known.get(key);
  };
  const profileOf = profiles ? Uint32Array.from(profiles, numberOf) : new Uint32Array(widthsUm.length);
  const floats = (array) => (array === null ? undefined : Float32Array.from(array));
  const lists = [floats(starts), floats(ends), floats(normals), floats(widthsUm), floats(depthsNm), Uint32Array.from(scratch), profileOf];
  const names = [...known.keys()].map((key) => JSON.parse(key));
  needsTables('scratches');
  return using(new Tree(...lists, JSON.stringify(names), coherenceUm, metresPerUnit), (tree) => {
    const [texels, pairs] = [tree.texels(), tree.shapes()];
    const shapes = Array.from({ length: pairs.length / 2 }, (_, i) => ({ profile: names[pairs[2 * i]], widthClass: pairs[2 * i + 1] }));
    return { texels, width: TREE_WIDTH, height: texels.length / (4 * TREE_WIDTH), shapes, tableRows: tree.tableRows() };
  });
}
