// `cargo xtask package --test` runs this: what the package computes on the processor, and bad input. `node check.mjs FOLDER`.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const folder = join(process.argv[2], 'hairline-shaders');
const hairline = await import(pathToFileURL(join(folder, 'src/index.js')));
// What needs Hairline's own code says so.
assert.throws(() => hairline.layScratches({ positions: [0, 0, 0, 1, 0, 0, 0, 1, 0] }, { pattern: 'random', count: 1 }), /scratches: found no tables; must come after `await loadTables\(\)`/);
await hairline.loadTables(`data:application/wasm;base64,${readFileSync(join(folder, 'engine/engine_bg.wasm')).toString('base64')}`);

/** Milliseconds that a call takes, and what it returns. */
function timed(call) {
  const began = performance.now();
  const made = call();
  return [made, `${(performance.now() - began).toFixed(0)} ms`];
}

const [tables, tablesIn] = timed(() => new hairline.Tables());
assert.deepEqual([tables.shapes, tables.albedo, tables.curves].map(({ data, width, height }) => data.length / (4 * width * height)), [1, 1, 1]);
// Schlick's curve first: the fifth power of one less the cosine.
const atHalf = Math.round(Math.SQRT1_2 * 127);
assert.ok(Math.abs(tables.curves.data[4 * atHalf] - (1 - (atHalf / 127) ** 2) ** 5) < 1e-6);
// Fresnel's equations at 60 degrees: 0.0892 of an index of 1.5, which is 0.04 straight on.
const of15 = 4 * 128 * 9 * hairline.dielectricCurve(1.5) + 4 * Math.round(Math.SQRT1_2 * 127);
assert.ok(Math.abs(tables.curves.data[of15] + 0.04 * tables.curves.data[of15 + 3] - 0.0892) < 1e-3);
const [gold, goldIn] = timed(() => hairline.scratchTables('gold', { shapes: [{ profile: 'rectangle', widthClass: 0 }], tableRows: 64 }));
assert.equal(gold.texels.length, 4 * gold.columns * 64);
// A wider light sends more, and copper's red is more than its blue.
const [red, , blue] = hairline.metalColor('copper');
assert.ok(red > 0.9 && blue < 0.6, `copper: ${red} ${blue}`);
console.log(`tables of the base in ${tablesIn}, of gold in ${goldIn}`);

/** The pieces that scratch_tree.wgsl comes to, by their numbers, each with what it stands for. */
function walk(texels, position, reach, most = Infinity) {
  const numbers = new Float32Array(texels.buffer, texels.byteOffset, texels.length);
  const [nodeCount, pieceCount] = texels;
  const found = new Map();
  const firstOf = (node) => (node < nodeCount ? texels[4 * (2 + 2 * node) + 3] & 0xfffffff : pieceCount);
  for (let node = 0; node < nodeCount; ) {
    const [low, high] = [4 * (1 + 2 * node), 4 * (2 + 2 * node)];
    const skip = texels[low + 3];
    const count = texels[high + 3] >>> 28;
    const inside = (k) => numbers[low + k] >= position[k] - reach && numbers[high + k] <= position[k] + reach;
    const touches = [0, 1, 2].every((k) => numbers[low + k] <= position[k] + reach && numbers[high + k] >= position[k] - reach);
    const [first, end] = count > 0 ? [firstOf(node), firstOf(node) + count] : [firstOf(node), firstOf(skip)];
    const isMany = count === 0 && [0, 1, 2].every(inside) && end - first > most;
    if (touches && (count > 0 || isMany)) {
      const step = isMany ? Math.ceil((end - first) / most) : 1;
      const begin = first + (step >> 1);
      for (let i = begin; i < end; i += step) found.set(i, (end - first) / Math.ceil((end - begin) / step));
    }
    node = touches && !isMany ? node + 1 : skip;
  }
  return found;
}

/** Start and end of a piece. */
function pieceAt(texels, i) {
  const at = 4 * (1 + 2 * texels[0] + 2 * i);
  const numbers = new Float32Array(texels.buffer, texels.byteOffset, texels.length);
  return [Array.from(numbers.subarray(at, at + 3)), Array.from(numbers.subarray(at + 4, at + 7))];
}

// Scratches around the axis stay at their distance from it; more scratches leave those there are; a list lies where it says.
const square = { positions: [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0].map((x) => 0.05 * x), index: [0, 1, 2, 0, 2, 3], uvs: [0, 1, 1, 1, 1, 0, 0, 0] };
const [few, more] = [20, 30].map((count) => hairline.layScratches(square, { pattern: 'circular', count, length_m: 0.01 }));
assert.deepEqual(more.starts.subarray(0, few.starts.length), few.starts);
for (let from = 0, to; from < few.count; from = to) {
  const radius = (k) => Math.hypot(few.starts[3 * k], few.starts[3 * k + 1]);
  for (to = from; to < few.count && few.scratch[to] === few.scratch[from]; to += 1) {
    assert.ok(Math.abs(radius(to) / radius(from) - 1) < 0.02, `${radius(to)} ${radius(from)}`);
  }
}
const files = { list: { endsM: [-0.01, 0, 0, 0.01, 0, 0], widthsUm: [4], depthsNm: [150] }, half: { width: 2, rgba: Uint8Array.from([255, 255, 255, 255, 0, 0, 0, 255]) } };
const listed = hairline.layScratches(square, { pattern: 'file', file: 'list' }, { files });
assert.ok(Math.abs(listed.starts[0] + 0.01) < 1e-6 && Math.abs(listed.ends[3 * listed.count - 3] - 0.01) < 1e-6);
// Pieces with one number are one scratch, else each is one.
const bent = { ...files.list, endsM: [-0.01, 0, 0, 0, 0.01, 0, 0, 0.01, 0, 0.01, 0, 0] };
for (const [scratches, count] of [[[7, 7], 1], [undefined, 2]]) {
  const { scratch } = hairline.layScratches(square, { pattern: 'file', file: 'bent' }, { files: { bent: { ...bent, scratches } } });
  assert.equal(new Set(scratch).size, count);
}
// The outline of a circle is one.
const svg = new TextEncoder().encode('<svg xmlns="http://www.w3.org/2000/svg"><circle cx="3" cy="3" r="2"/></svg>');
const drawn = hairline.layScratches(square, { pattern: 'svg', file: 'ring.svg', fit_m: 0.02 }, { files: { 'ring.svg': { svg } } });
assert.ok(drawn.count > 10);
for (let i = 0; i < drawn.count; i += 1) assert.ok(Math.abs(Math.hypot(drawn.starts[3 * i], drawn.starts[3 * i + 1]) - 0.01) < 1e-4);
// A mask leaves the left half.
const masked = hairline.layScratches(square, { pattern: 'random', count: 200, where: { mask: 'half' } }, { files });
assert.ok(masked.count > 50);
for (let i = 0; i < masked.count; i += 1) assert.ok(masked.ends[3 * i] < 1e-4 && masked.starts[3 * i] < 1e-4);
// In another unit the same scratches.
const inMillimetres = hairline.layScratches({ ...square, positions: square.positions.map((x) => 1000 * x) }, { pattern: 'circular', count: 20, length_m: 0.01 }, { metresPerUnit: 1e-3 });
assert.ok(inMillimetres.starts.every((x, i) => Math.abs(x / 1000 - few.starts[i]) < 1e-7));

// A walk through a tree misses no piece that comes near, and leaves out most.
const random = hairline.layScratches(square, [{ pattern: 'random', count: 800, seed: 1, length_m: 0.02, profile: 'v' }, { pattern: 'random', count: 200, seed: 1 }]);
const [tree, treeIn] = timed(() => hairline.scratchTree(random));
console.log(`tree of ${tree.texels[1]} pieces in ${treeIn}`);
assert.deepEqual(tree.shapes, [{ profile: 'rectangle', widthClass: 0 }, { profile: 'v', widthClass: 0 }]);
// Tables go as deep as the deepest scratch, in steps of 32 rows.
assert.equal(tree.tableRows, 32 * Math.ceil((Math.max(...random.depthsNm) / (2000 / 511) + 2) / 32));
const sum = (list) => list.reduce((a, b) => a + b, 0);
for (let n = 0; n < 50; n += 1) {
  const [position] = pieceAt(tree.texels, (n * 97) % tree.texels[1]);
  const reach = 2e-4 * 1.1 ** n;
  const found = walk(tree.texels, position, reach);
  let near = 0;
  for (let i = 0; i < tree.texels[1]; i += 1) {
    const [start, end] = pieceAt(tree.texels, i);
    const comes = [0, 1, 2].every((k) => Math.min(start[k], end[k]) <= position[k] + reach && Math.max(start[k], end[k]) >= position[k] - reach);
    if (comes) assert.ok(found.has(i), `piece ${i} is missed`);
    near += comes;
  }
  assert.ok(found.size <= 4 * near + 40, `${found.size} found for ${near}`);
  // A part of very many stands for all.
  const part = walk(tree.texels, position, reach, 64);
  assert.ok(Math.abs(sum([...part.values()]) - found.size) < 1e-6 * found.size);
}

// Joined, each keeps its numbers; with and without normals they do not go together.
const both = few.joined(more);
assert.deepEqual([both.count, both.starts.length], [few.count + more.count, few.starts.length + more.starts.length]);
assert.equal(new Set(both.scratch).size, 50);
assert.throws(() => few.joined(new hairline.Scratches({ ...more, normals: null })), /must be all or none/);

// Without normals a piece shows on both sides; a wide groove is parts side by side.
{
  const piece = (widthUm, normals) => new hairline.Scratches({
    starts: [0, 0, 0], ends: [1e-3, 0, 0], widthsUm: [widthUm], depthsNm: [150], scratch: [0], normals, profiles: ['v'],
  });
  const words = ({ texels }, i) => texels.subarray(4 * (1 + 2 * texels[0] + 2 * i));
  assert.equal(words(hairline.scratchTree(piece(4, null)), 0)[7] & 0xffff, 0x8080);
  const wide = hairline.scratchTree(piece(12, [0, 0, 1]));
  assert.deepEqual(wide.shapes, [{ profile: 'rectangle', widthClass: 0 }, { profile: 'v', widthClass: 1 }]);
  assert.deepEqual([0, 1].map((i) => pieceAt(wide.texels, i)[0][1]).sort(), [-3e-6, 3e-6].map(Math.fround));
  assert.ok(hairline.scratchTables('gold', { ...wide, shapes: [wide.shapes[1]] }).texels.some((word) => word !== 0));
}

const layer = { pattern: 'random', count: 1 };
for (const [wrong, message] of [
  [{ ...layer, profile: 'w' }, /scratches\[0\]\.profile: found the text "w"; must be one of/],
  [{ ...layer, seeds: 1 }, /scratches\[0\]\.seeds: unknown key; did you mean `seed`/],
  [{ ...layer, seed: -1 }, /scratches\[0\]\.seed: found the whole number -1/],
  [{ ...layer, width_um: 400 }, /scratches\[0\]\.width_um: found 400/],
  [{ ...layer, where: { mask: 'none' } }, /scratches\[0\]\.where\.mask: found the file "none"; must be the name of a picture in memory/],
  [{ ...layer, node: 'lid' }, /scratches\[0\]\.node: found a part of a model/],
]) {
  assert.throws(() => hairline.layScratches(square, wrong, { files }), message);
}
assert.throws(() => hairline.layScratches({ positions: [0, 0, 0, 1, 0, 0, 2, 0, 0] }, layer), /mesh: found no surface/);
const header = 'x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm';
for (const [list, message] of [
  ['a,b\n', /list.csv:1: found `a,b`; must be the header/],
  [`${header}\n0,0,0,1,0,0,4\n`, /list.csv:2: found 7 cells; must be 8/],
  [`${header}\n\n0,0,0,1,0,0,4,x\n`, /list.csv:3: depth_nm: found "x"; must be a number/],
  [`${header}\n0,0,0,1,0,0,400,100\n`, /list.csv:2: width_um: found 400; must be from 0.05 to 100/],
]) {
  assert.throws(() => hairline.readScratches(list, 'list.csv'), message);
}
assert.throws(() => new hairline.Grating({ texels: new Uint32Array(4) }), /texels: found 4; must be a Uint32Array of 512 columns and 2 to 256 rows, of a fine grating 512/);
assert.throws(() => new hairline.Grating({ texels: new Uint32Array(524288), kind: 'uv' }), /kind: found "uv"; must be one of along, circular.*along-v/);
{
  const texels = new Uint32Array(524288);
  // Grooves by texture coordinates are of the first kind in WGSL, along a direction.
  assert.equal(new hairline.Grating({ texels, kind: 'along-v' }).numbers[3], 0);
  // Rows in the words of scene files; of hidden ones none.
  const row = { pattern: 'circular', pitch_um: 30, depth_nm: 140, axis: [0, 0, 2], center_m: [0.01, 0, 0], radius_m: [0.02, 0.05], coverage: 0.5 };
  const mask = { isTexture: true };
  const [laid, ...others] = hairline.layGratings([{ ...row, mask: 'motif' }, { ...row, hidden: true }], { metal: 'steel', pictures: { motif: mask } });
  assert.deepEqual([laid.kind, laid.axis, laid.center, laid.radiiM, laid.coverage, laid.mask, others.length], ['circular', [0, 0, 1], [0.01, 0, 0], [0.02, 0.05], 0.5, mask, 0]);
  assert.ok(laid.rows > 30 && laid.rows < 40, `${laid.rows} rows`);
  assert.throws(() => hairline.layGratings({ ...row, pitch: 30 }), /grating\[0\]\.pitch: unknown key/);
  assert.throws(() => hairline.layGratings({ ...row, pitch_um: 300 }), /grating\[0\]\.pitch_um: found 300/);
  assert.throws(() => hairline.layGratings({ ...row, mask: 'motif' }), /grating\[0\]\.mask: found "motif"; must be the name of one of `pictures`/);
  assert.throws(() => hairline.layGratings({ pattern: 'swirl', pitch_um: 30, spacing_m: 0.004 }), /grating\[0\]\.pattern: found spots; must lie along/);
  assert.throws(() => new hairline.Grating({ texels, mask: 'mask.png' }), /mask: found something else; must be a Texture/);
  assert.throws(() => new hairline.Grating({ texels, kind: 'along', directions: { isTexture: true } }), /directions: found a picture for grooves of kind "along"; must be along-u or along-v/);
}
assert.throws(() => hairline.scratchTables('tin', tree), /metal: found "tin"; must be one of iron, steel/);
console.log('the package is right');
process.exit(0);
