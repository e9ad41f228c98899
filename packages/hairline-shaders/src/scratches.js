// Scratches as lists of straight pieces. Twin: crates/index/src/layer_runs.rs, crates/optics/src/footprint.rs.
import { erf } from './erf.js';
import { checkProfile, isSameShape, narrowRectangle, partsOf, stripDepths, widthClassOf } from './section.js';
import { depthCoherence } from './spectrum.js';

/** Shapes that a tree tells apart, in four bits. */
const MOST_SHAPES = 16;
/** Strips of a cross section, each of one depth, that tell how alike depths are. */
const STRIPS = 16;

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
    new Set(profiles).forEach(checkProfile);
    Object.assign(this, { starts, ends, widthsUm, depthsNm, scratch, normals, profiles });
  }

  /** Number of straight pieces. */
  get count() {
    return this.widthsUm.length;
  }

  /** Moves them by a matrix of 16 numbers, column by column (`Matrix4.elements` of three.js). */
  transformed(m) {
    const apply = (from, w) => {
      const to = new Float64Array(from.length);
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
    const join = (name) => Float64Array.from([...this[name], ...other[name]]);
    const profiles = (of) => of.profiles ?? new Array(of.count).fill(narrowRectangle.profile);
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

const COLUMNS = ['x0_m', 'y0_m', 'z0_m', 'x1_m', 'y1_m', 'z1_m', 'width_um', 'depth_nm'];
const MORE = ['scratch', 'nx', 'ny', 'nz'];

/**
 * Reads a list: the CSV of docs/scene.md, a straight scratch a row, or what `hairline scratches` writes, a straight piece a row with the
 * number of its scratch and the normal. A mistake is an Error with its line. `profile`: the cross section of all of them, as in scene files.
 */
export function readScratches(text, name = 'scratches.csv', { profile = narrowRectangle.profile } = {}) {
  const lines = text.replace(/^\ufeff/, '').split(/\r?\n/);
  const first = lines.findIndex((line) => line.trim() !== '');
  const header = (lines[first] ?? '').split(',').map((cell) => cell.trim()).join(',');
  const [short, long] = [COLUMNS.join(','), [...COLUMNS, ...MORE].join(',')];
  if (header !== short && header !== long) {
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
    for (const [c, least, most] of [[6, 0.05, 100], [7, 0, 2000]]) {
      if (!(row[c] >= least && row[c] <= most)) {
        throw new Error(`${name}:${i + 1}: ${columns[c]}: found ${row[c]}; must be from ${least} to ${most}`);
      }
    }
    rows.push(row);
  }
  const pick = (...at) => Float64Array.from(rows.flatMap((row) => at.map((c) => row[c])));
  const isLong = columns.length > COLUMNS.length;
  return new Scratches({
    starts: pick(0, 1, 2),
    ends: pick(3, 4, 5),
    widthsUm: pick(6),
    depthsNm: pick(7),
    scratch: isLong ? Uint32Array.from(rows, (row) => row[8]) : Uint32Array.from(rows.keys()),
    normals: isLong ? pick(9, 10, 11) : null,
    profiles: profilesOf(profile, rows.length),
  });
}

/** The profiles of pieces that share one. */
export function profilesOf(profile, count) {
  checkProfile(profile);
  return profile === narrowRectangle.profile ? null : new Array(count).fill(profile);
}

/** By how much the free ends of a scratch move inwards, and the deviation that smooths them: equation (21) of docs/model.md. */
export function scratchEnds(lengthUm, coherenceUm) {
  const [l, s] = [lengthUm, coherenceUm];
  if (l < 0.05 * s) {
    const m = (l * l) / (2 * Math.sqrt(Math.PI) * s);
    return { shrinkUm: 0.5 * (l - m), blurUm: s * Math.SQRT1_2 };
  }
  const v = 2 * s * s;
  const gauss = Math.exp((-l * l) / (2 * v));
  const density = gauss / Math.sqrt(2 * Math.PI * v);
  const i0 = 0.5 * erf(l / (2 * s));
  const i1 = (s / Math.sqrt(Math.PI)) * (1 - gauss);
  const i2 = v * (i0 - l * density);
  const i3 = v * (2 * i1 - l * l * density);
  const m = 2 * (l * i0 - i1);
  const third = 2 * (l ** 3 * i0 - 3 * l * l * i1 + 3 * l * i2 - i3);
  return { shrinkUm: 0.5 * (l - m), blurUm: Math.sqrt(Math.max(0.5 * s * s + third / (12 * m) - (m * m) / 12, 0)) };
}

/** The parts of a wide groove in the place of a piece. Where its normal is not known, they lie in its middle. */
function partsOfPiece(piece, shape, coherenceUm, umPerUnit) {
  const { offsetsUm, widthUm } = partsOf(shape, piece.widthUm, coherenceUm);
  const along = piece.end.map((x, k) => x - piece.start[k]);
  const n = piece.normal ?? [0, 0, 0];
  const across = [n[1] * along[2] - n[2] * along[1], n[2] * along[0] - n[0] * along[2], n[0] * along[1] - n[1] * along[0]];
  const length = Math.hypot(...across) || 1;
  return offsetsUm.map((offsetUm) => {
    const moved = (point) => point.map((x, k) => Math.fround(x + ((offsetUm / umPerUnit) * across[k]) / length));
    return { ...piece, start: moved(piece.start), end: moved(piece.end), widthUm, widthClass: shape.widthClass };
  });
}

/**
 * What a tree is made of: pieces with the free ends of their scratches moved inwards, the deviation that smooths these, and how alike
 * depths are; and the shapes of their grooves, each of which needs a table. `metresPerUnit`: how long a unit of the object's frame is in the world.
 */
export function preparedPieces(scratches, { coherenceUm = 20, metresPerUnit = 1 } = {}) {
  const { starts, ends, widthsUm, depthsNm, scratch, normals, profiles } = scratches;
  const umPerUnit = 1e6 * metresPerUnit;
  const lengths = new Float64Array(scratches.count);
  const areas = new Map();
  for (let i = 0; i < scratches.count; i += 1) {
    const d = [0, 1, 2].map((k) => ends[3 * i + k] - starts[3 * i + k]);
    lengths[i] = umPerUnit * Math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const profile = profiles ? profiles[i] : narrowRectangle.profile;
    if (!areas.has(profile)) areas.set(profile, []);
    areas.get(profile).push([depthsNm[i], widthsUm[i] * lengths[i]]);
  }
  const shapes = [narrowRectangle];
  const shapeOf = (shape) => {
    const known = shapes.findIndex((other) => isSameShape(shape, other));
    return known >= 0 ? known : shapes.push(shape) - 1;
  };
  const made = [];
  for (let from = 0, to; from < scratches.count; from = to) {
    let length = 0;
    for (to = from; to < scratches.count && scratch[to] === scratch[from]; to += 1) length += lengths[to];
    const closed = to - from > 2 && [0, 1, 2].every((k) => starts[3 * from + k] === ends[3 * (to - 1) + k]);
    const end = scratchEnds(length, coherenceUm);
    const shrink = closed ? 0 : end.shrinkUm;
    const profile = profiles ? profiles[from] : narrowRectangle.profile;
    let way = 0;
    for (let i = from; i < to; i += 1) {
      const s = Math.max(shrink - way, 0) / lengths[i];
      const e = Math.min(length - shrink - way, lengths[i]) / lengths[i];
      way += lengths[i];
      if (!(s < e)) continue;
      const at = (share) => [0, 1, 2].map((k) => Math.fround(starts[3 * i + k] + share * (ends[3 * i + k] - starts[3 * i + k])));
      const shape = { profile, widthClass: widthClassOf(widthsUm[i] / coherenceUm) };
      const piece = {
        start: at(s), end: at(e), normal: normals ? Array.from(normals.subarray(3 * i, 3 * i + 3)) : null,
        widthUm: widthsUm[i], depthNm: depthsNm[i], blurUm: end.blurUm, shape: shapeOf(shape),
      };
      made.push(...(shape.widthClass > 0 ? partsOfPiece(piece, shape, coherenceUm, umPerUnit) : [piece]));
    }
  }
  if (shapes.length > MOST_SHAPES) {
    throw new Error(`scratches: found grooves of ${shapes.length} shapes: profiles, each as narrow ones and in up to five classes of wide ones; must be at most ${MOST_SHAPES}: fewer profiles, or widths below 0.4 of coherenceUm`);
  }
  const depths = [...areas].flatMap(([profile, list]) => {
    const strips = stripDepths(profile, STRIPS);
    return binned(list).flatMap(([depth, area]) => strips.map((share) => [share * depth, area / strips.length]));
  });
  return { pieces: made, shapes, coherenceUm, depthCoherence: depthCoherence(depths) };
}

/** Depths that hardly differ, put together. */
function binned(areas) {
  const deepest = areas.reduce((most, [depth]) => Math.max(most, depth), 0);
  const bins = new Map();
  for (const [depth, area] of areas) {
    const bin = Math.min(Math.floor((depth / (deepest || 1)) * 4096), 4095);
    const [weight, moment] = bins.get(bin) ?? [0, 0];
    bins.set(bin, [weight + area, moment + area * depth]);
  }
  return [...bins.values()].filter(([weight]) => weight > 0).map(([weight, moment]) => [moment / weight, weight]);
}
