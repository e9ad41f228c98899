// `cargo xtask package --test` runs this: the package's shaders by Tint, the compiler of Chrome, as one file and linked from their WESL
// modules; tables against the sums that they stand for, trees against all pieces; bad input. `node check.mjs FOLDER`.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { create, globals } from 'webgpu';
import { link } from 'wesl/core';

const folder = process.argv[2];
const read = (file) => readFileSync(join(folder, file));
const text = (file) => read(join('hairline-shaders', file)).toString('utf8');
const bytes = (file) => {
  const data = read(file);
  return data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength);
};
const hairline = await import(pathToFileURL(join(folder, 'hairline-shaders/src/index.js')));
const { columnUm, sincSquaredIntegral } = await import(pathToFileURL(join(folder, 'hairline-shaders/src/table.js')));
const { phaseStepEnergy, reflectance, samples } = await import(pathToFileURL(join(folder, 'hairline-shaders/src/spectrum.js')));

Object.assign(globalThis, globals);
globalThis.gpu = create(['backend=null']);
const device = await (await gpu.requestAdapter()).requestDevice();

/** Every error and every warning of Tint counts. */
async function compiles(name, code) {
  device.pushErrorScope('validation');
  const { messages } = await device.createShaderModule({ label: name, code }).getCompilationInfo();
  const error = await device.popErrorScope();
  const lines = code.split('\n');
  const said = messages.map(({ lineNum, message }) => `${name}:${lineNum}: ${message}: ${lines[lineNum - 1]}`);
  assert.equal([...said, ...(error ? [error.message] : [])].join('\n'), '');
}

const whole = text('wgsl/hairline.wgsl');
await compiles('hairline.wgsl', whole);
assert.equal(hairline.hairlineWgsl, whole);
await compiles('make_scratch_table.wgsl', text('wgsl/make_scratch_table.wgsl'));

// One module of each kind by itself, with what it imports.
const weslSrc = Object.fromEntries(readdirSync(join(folder, 'hairline-shaders/wesl')).map((file) => [file, text(join('wesl', file))]));
for (const name of ['scratch_light', 'scratched_surface', 'lit_base', 'brushed_base', 'grated_surface', 'outline_light', 'camera', 'environment_lobe']) {
  const functions = [...weslSrc[`${name}.wesl`].matchAll(/^fn (\w+)\(/gm)].map((match) => match[1]);
  // Code that no entry point reaches is left out, so each module is compiled as a root of its own.
  const { dest } = await link({ weslSrc, rootModuleName: name });
  for (const each of functions) assert.ok(dest.includes(`fn ${each}(`), `${name}: ${each} is missing`);
  await compiles(`${name}.wesl`, dest);
}

// Lights of one direction are in the sky, those at a place are not, and others are no spheres in silence. Outlines have the light's area, and shine to -z.
{
  const { isFar, outlineOf } = await import(pathToFileURL(join(folder, 'hairline-shaders/src/three_lights.js')));
  const { SunLight } = await import('three/addons/lights/SunLight.js');
  const { DirectionalLight, HemisphereLight, PointLight, SpotLight } = await import('three');
  assert.deepEqual([new DirectionalLight(), new SunLight(), new PointLight(), new SpotLight()].map(isFar), [true, true, false, false]);
  assert.throws(() => isFar(new HemisphereLight()), /found the light "" of type HemisphereLight; must be a PointLight/);
  const area = (vertices) => vertices.reduce((sum, [x, y], i) => sum + (x * vertices[(i + 1) % vertices.length][1] - y * vertices[(i + 1) % vertices.length][0]) / 2, 0);
  const square = [[0, 0], [2, 0], [2, 2], [0, 2]];
  const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-12, `${a} ${b}`);
  near(area(outlineOf({ width: 2, height: 2, userData: { shape: 'disk' } })), -Math.PI);
  for (const corners of [square, [...square].reverse()]) near(area(outlineOf({ userData: { shape: 'polygon', corners } })), -4);
  assert.throws(() => outlineOf({ name: 'lamp', userData: { shape: 'polygon', corners: [[0, 0]] } }), /corners of the light "lamp": found \[\[0,0\]\]; must be three/);
}

/** T(u, d) as scratch_table.wgsl looks it up. */
function lookUp(texels, u, depthNm) {
  const { columns, rows } = hairline.tableSize;
  const floats = new Float32Array(texels.buffer);
  const x = (u / (u + 2)) * (columns - 1);
  const column = Math.min(Math.floor(x + 0.5), columns - 1);
  const y = (depthNm / 2000) * (rows - 1);
  const row = Math.min(Math.floor(y), rows - 2);
  const near = (at) => {
    const word = texels[4 * at + 3];
    const scale = 2 ** ((word >>> 27) - 36) * (x - column);
    return [0, 1, 2].map((c) => floats[4 * at + c] + scale * ((word << (23 - 9 * c)) >> 23));
  };
  const [low, high] = [near(row * columns + column), near((row + 1) * columns + column)];
  return low.map((value, c) => value + (high[c] - value) * (y - row));
}

// Chords of small and of large lights, against the sum over wavelengths.
const gold = hairline.scratchTable('gold');
const f0 = hairline.metalColor('gold');
for (const step of [5, 0.5, 0.05, 0.004]) {
  let [off, all] = [0, 0];
  for (let i = 0; i < 300; i += 1) {
    const u = 10 * ((0.618033988749895 * i) % 1);
    const depth = 1000 * ((0.414213562373095 * i) % 1);
    const [a, b] = [lookUp(gold, u, depth), lookUp(gold, u + step, depth)];
    for (let c = 0; c < 3; c += 1) {
      const exact = samples.reduce((sum, { nm, weight }) => {
        const chord = sincSquaredIntegral(u + step, nm * 1e-3) - sincSquaredIntegral(u, nm * 1e-3);
        return sum + (weight[c] * reflectance('gold', nm) * phaseStepEnergy(depth, nm) * chord) / (nm * 1e-3) / f0[c];
      }, 0);
      off += (b[c] - a[c] - exact) ** 2;
      all += exact ** 2;
    }
  }
  const error = Math.sqrt(off / all);
  console.log(`table of gold, 2 MiB: chords of ${step} um, relative rms error ${(100 * error).toFixed(2)} %`);
  assert.ok(error < 6e-3);
}
assert.equal(columnUm(0), 0);

// Tables of other shapes of grooves, against Rust's.
for (const { chords, ...shape } of JSON.parse(read('test/shapes.json').toString('utf8'))) {
  const began = performance.now();
  const table = hairline.scratchTable('gold', shape);
  const took = performance.now() - began;
  let [off, all] = [0, 0];
  for (const [u, depth, right] of chords) {
    const [a, b] = [lookUp(table, u, depth), lookUp(table, u + 0.5, depth)];
    for (let c = 0; c < 3; c += 1) {
      off += (b[c] - a[c] - right[c]) ** 2;
      all += right[c] ** 2;
    }
  }
  const error = Math.sqrt(off / all);
  console.log(`table of ${JSON.stringify(shape)}: ${took.toFixed(0)} ms, relative rms error ${(100 * error).toFixed(2)} %`);
  assert.ok(error < 6e-3);
}

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

// Trees of JavaScript and of Rust, over random scratches on a ball: a walk misses no piece that comes near, and leaves out most.
const ofRust = new Uint32Array(bytes('test/tree_texels.bin'));
const pieces = [];
for (let i = 0; i < ofRust[1]; i += 1) {
  const [start, end] = pieceAt(ofRust, i);
  pieces.push({ start, end, normal: [0, 0, 1], widthUm: 4.25, depthNm: 150, blurUm: 16 });
}
const began = performance.now();
const tree = hairline.scratchTree({ pieces, coherenceUm: 20, depthCoherence: 0.5 });
console.log(`tree of ${pieces.length} pieces: ${(performance.now() - began).toFixed(0)} ms, ${(tree.texels.byteLength / 2 ** 20).toFixed(1)} MiB`);
assert.equal(ofRust[1], tree.texels[1]);
const lengths = (texels) => Array.from({ length: texels[1] }, (_, i) => Math.hypot(...pieceAt(texels, i)[0].map((x, k) => x - pieceAt(texels, i)[1][k])));
const sum = (list) => list.reduce((a, b) => a + b, 0);
assert.ok(Math.abs(sum(lengths(ofRust)) / sum(lengths(tree.texels)) - 1) < 1e-6);
for (const [texels, name] of [[ofRust, 'Rust'], [tree.texels, 'JavaScript']]) {
  for (let n = 0; n < 50; n += 1) {
    const [position] = pieceAt(texels, (n * 97) % texels[1]);
    const reach = 2e-4 * 1.1 ** n;
    const found = walk(texels, position, reach);
    let near = 0;
    for (let i = 0; i < texels[1]; i += 1) {
      const [start, end] = pieceAt(texels, i);
      const comes = [0, 1, 2].every((k) => Math.min(start[k], end[k]) <= position[k] + reach && Math.max(start[k], end[k]) >= position[k] - reach);
      if (comes) assert.ok(found.has(i), `${name}: piece ${i} is missed`);
      near += comes;
    }
    assert.ok(found.size <= 4 * near + 40, `${name}: ${found.size} found for ${near}`);
    // A part of very many stands for all.
    const part = walk(texels, position, reach, 64);
    assert.ok(Math.abs(sum([...part.values()]) - found.size) < 1e-6 * found.size);
  }
}

// Free ends move inwards by 0.564 of the window, and smooth by 0.826 of it: docs/model.md, section 6.
const ends = hairline.scratchEnds(1e4, 20);
assert.ok(Math.abs(ends.shrinkUm - 20 / Math.sqrt(Math.PI)) < 1e-3 && Math.abs(ends.blurUm / 20 - 0.8256) < 1e-3);

// Scratches around the axis stay at their distance from it; more scratches leave those there are.
const square = { positions: [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0].map((x) => 0.05 * x), index: [0, 1, 2, 0, 2, 3] };
const [few, more] = [20, 30].map((count) => hairline.layScratches(square, { pattern: 'circular', count, lengthM: 0.01 }));
assert.deepEqual(more.starts.subarray(0, few.starts.length), few.starts);
for (let from = 0, to; from < few.count; from = to) {
  const radius = (k) => Math.hypot(few.starts[3 * k], few.starts[3 * k + 1]);
  for (to = from; to < few.count && few.scratch[to] === few.scratch[from]; to += 1) {
    assert.ok(Math.abs(radius(to) / radius(from) - 1) < 0.02, `${radius(to)} ${radius(from)}`);
  }
}

// Joined, each keeps its numbers; with and without normals they do not go together.
const both = few.joined(more);
assert.deepEqual([both.count, both.starts.length], [few.count + more.count, few.starts.length + more.starts.length]);
assert.equal(new Set(both.scratch).size, 50);
assert.throws(() => few.joined(new hairline.Scratches({ ...more, normals: null })), /must be all or none/);

// Wide grooves are parts side by side, each of half of what is lit; narrow ones are as they were.
{
  const piece = (widthUm, normals) => new hairline.Scratches({
    starts: [0, 0, 0], ends: [1e-3, 0, 0], widthsUm: [widthUm], depthsNm: [150], scratch: [0], normals: normals && Float64Array.from(normals), profiles: ['v'],
  });
  const narrow = hairline.preparedPieces(piece(4, null));
  assert.deepEqual([narrow.pieces.length, narrow.pieces[0].shape, narrow.pieces[0].widthClass, narrow.shapes.length], [1, 1, undefined, 2]);
  const wide = hairline.preparedPieces(piece(12, [0, 0, 1]));
  assert.deepEqual(wide.pieces.map(({ start, widthClass }) => [start[1], widthClass]), [[Math.fround(-3e-6), 1], [Math.fround(3e-6), 1]]);
  const unknown = hairline.preparedPieces(piece(12, null));
  assert.deepEqual(unknown.pieces.map(({ start, widthUm }) => [start[1], widthUm]), [0, 0].map((y) => [y, wide.pieces[0].widthUm]));
  const { texels } = hairline.scratchTree(wide);
  const word = texels[4 * (1 + 2 * texels[0]) + 7];
  const sizes = texels[4 * (1 + 2 * texels[0]) + 3];
  assert.deepEqual([(word >>> 16) & 15, word >>> 31, (sizes >>> 15) & 1, sizes >>> 31], [1, 0, 1, 0]);
}
assert.throws(() => hairline.layScratches(square, { count: 1, profile: 'w' }), /profile: found "w"; must be one of rectangle, v, round/);

const header = 'x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm';
for (const [list, message] of [
  ['a,b\n', /list.csv:1: found `a,b`; must be the header/],
  [`${header}\n0,0,0,1,0,0,4\n`, /list.csv:2: found 7 cells; must be 8/],
  [`${header}\n\n0,0,0,1,0,0,4,x\n`, /list.csv:3: depth_nm: found "x"; must be a number/],
  [`${header}\n0,0,0,1,0,0,400,100\n`, /list.csv:2: width_um: found 400; must be from 0.05 to 100/],
]) {
  assert.throws(() => hairline.readScratches(list, 'list.csv'), message);
}
assert.throws(() => new hairline.Grating({ texels: new Uint32Array(4) }), /texels: found 4; must be a Uint32Array of 524288 or 1048576 numbers/);
assert.throws(() => new hairline.Grating({ texels: new Uint32Array(524288), kind: 'uv' }), /kind: found "uv"; must be one of along, circular/);
assert.throws(() => hairline.scratchTable('tin'), /metal: found "tin"; must be one of iron, steel/);
console.log('the package is right');
process.exit(0);
