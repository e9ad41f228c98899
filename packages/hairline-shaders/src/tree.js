// Scratches in a tree of boxes: the texels that scratch_tree.wgsl walks through, which says where they lie. Twin: crates/gpu/src/scratch_tree.rs,
// which has the renderer's own tree.

const WIDTH = 1024;
const ROWS_MAX = 8192;
const LEAF = 4;
const FIRST_BITS = 28;
/** Longer pieces are cut: the box of a long slanting one is mostly empty. */
const LONGEST_M = 4e-3;
const NO_NORMAL = 0x8080;

const bits = new Uint32Array(1);
const floats = new Float32Array(bits.buffer);

function floatBits(value) {
  floats[0] = value;
  return bits[0];
}

/** The nearest half float, as 16 bits. */
function halfBits(value) {
  const x = floatBits(value);
  const sign = (x >>> 16) & 0x8000;
  const exponent = ((x >>> 23) & 0xff) - 112;
  const rounded = (word, shift) => {
    const [kept, rest, half] = [word >>> shift, word & ((1 << shift) - 1), 1 << (shift - 1)];
    return kept + (rest > half || (rest === half && kept & 1) ? 1 : 0);
  };
  if (exponent >= 31) return sign | 0x7c00;
  if (exponent <= 0) return exponent < -10 ? sign : sign | rounded((x & 0x7fffff) | 0x800000, 14 - exponent);
  return sign | ((exponent << 10) + rounded(x & 0x7fffff, 13));
}

/** A unit vector as two signed bytes. */
function octahedral(normal) {
  if (normal === null) return NO_NORMAL;
  const sum = Math.max(Math.abs(normal[0]) + Math.abs(normal[1]) + Math.abs(normal[2]), 1e-30);
  const v = normal.map((x) => x / sum);
  const folded = (x, other) => (v[2] >= 0 ? x : (1 - Math.abs(other)) * (x < 0 ? -1 : 1));
  const byte = (x) => Math.round(x * 127) & 0xff;
  return byte(folded(v[0], v[1])) | (byte(folded(v[1], v[0])) << 8);
}

function cut(pieces, longest) {
  const parts = [];
  for (const piece of pieces) {
    const way = piece.end.map((x, k) => x - piece.start[k]);
    const count = Math.max(Math.ceil(Math.hypot(...way) / longest), 1);
    const at = (share) => piece.start.map((x, k) => Math.fround(x + share * way[k]));
    for (let i = 0; i < count; i += 1) {
      const start = i === 0 ? piece.start : at(i / count);
      parts.push(count === 1 ? piece : { ...piece, start, end: i + 1 === count ? piece.end : at((i + 1) / count) });
    }
  }
  return parts;
}

/** Pieces in the order of a curve that fills space, so that neighbours in the list are neighbours. Morton, 1966. */
function sorted(pieces) {
  const least = [Infinity, Infinity, Infinity];
  const most = [-Infinity, -Infinity, -Infinity];
  const middle = (piece, k) => piece.start[k] + piece.end[k];
  for (const piece of pieces) {
    for (let k = 0; k < 3; k += 1) {
      least[k] = Math.min(least[k], middle(piece, k));
      most[k] = Math.max(most[k], middle(piece, k));
    }
  }
  const side = Math.max(...most.map((m, k) => m - least[k]), 1e-30);
  const spread = (x) => {
    let y = (x | (x << 16)) & 0x030000ff;
    y = (y | (y << 8)) & 0x0300f00f;
    y = (y | (y << 4)) & 0x030c30c3;
    return (y | (y << 2)) & 0x09249249;
  };
  const codes = Float64Array.from(pieces, (piece) => {
    const at = (k) => spread(Math.min(Math.floor(((middle(piece, k) - least[k]) / side) * 1024), 1023));
    return at(0) | (at(1) << 1) | (at(2) << 2);
  });
  return [...pieces.keys()].sort((i, j) => codes[i] - codes[j]).map((i) => pieces[i]);
}

/**
 * The texels of an rgba32uint texture, four numbers each: `width` and `height` in texels. Takes what preparedPieces() made.
 * `metresPerUnit`: how long a unit of the object's frame is.
 */
export function scratchTree({ pieces: given, coherenceUm, depthCoherence }, { metresPerUnit = 1 } = {}) {
  const pieces = sorted(cut(given, LONGEST_M / metresPerUnit));
  const leaves = Math.ceil(pieces.length / LEAF);
  const nodeCount = Math.max(2 * leaves - 1, 0);
  const piecesAt = 1 + 2 * nodeCount;
  const height = Math.ceil((piecesAt + 2 * pieces.length) / WIDTH);
  if (height > ROWS_MAX) {
    throw new Error(`scratches: found ${pieces.length} pieces, which need ${height} rows of a texture; must be at most ${ROWS_MAX} rows`);
  }
  const texels = new Uint32Array(4 * WIDTH * height);
  const numbers = new Float32Array(texels.buffer);
  texels.set([nodeCount, pieces.length, floatBits(depthCoherence), floatBits(coherenceUm)]);
  let next = 0;
  /** Over leaves from one to before another. */
  const grow = (from, to) => {
    const node = next;
    next += 1;
    const [low, high] = [4 * (1 + 2 * node), 4 * (2 + 2 * node)];
    if (to - from === 1) {
      const first = LEAF * from;
      const own = pieces.slice(first, first + LEAF);
      for (let k = 0; k < 3; k += 1) {
        numbers[low + k] = Math.min(...own.map((piece) => Math.min(piece.start[k], piece.end[k])));
        numbers[high + k] = Math.max(...own.map((piece) => Math.max(piece.start[k], piece.end[k])));
      }
      texels[high + 3] = (first | (own.length << FIRST_BITS)) >>> 0;
    } else {
      const half = from + ((to - from) >> 1);
      const [left, right] = [grow(from, half), grow(half, to)].map((below) => 4 * (1 + 2 * below));
      for (let k = 0; k < 3; k += 1) {
        numbers[low + k] = Math.min(numbers[left + k], numbers[right + k]);
        numbers[high + k] = Math.max(numbers[left + 4 + k], numbers[right + 4 + k]);
      }
      texels[high + 3] = LEAF * from;
    }
    texels[low + 3] = next;
    return node;
  };
  if (leaves > 0) grow(0, leaves);
  pieces.forEach((piece, i) => {
    const at = 4 * (piecesAt + 2 * i);
    numbers.set(piece.start, at);
    const widthClass = piece.widthClass ?? 0;
    texels[at + 3] = (halfBits(piece.widthUm) | (halfBits(piece.depthNm) << 16) | ((widthClass & 1) << 15) | ((widthClass & 2) << 30)) >>> 0;
    numbers.set(piece.end, at + 4);
    // The shape has the place of the last four digits of a half float's ten.
    const blur = (halfBits(piece.blurUm) + 8) & 0xfff0;
    texels[at + 7] = (octahedral(piece.normal) | ((blur | (piece.shape ?? 0)) << 16) | ((widthClass & 4) << 29)) >>> 0;
  });
  return { texels, width: WIDTH, height };
}
