// `cargo xtask package --test` runs this: the package's shaders by Tint, the compiler of Chrome, as one file and linked from their WESL
// modules; outlines of lights. `node check_shaders.mjs FOLDER`.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { create, globals } from 'webgpu';
import { link } from 'wesl/core';

const folder = process.argv[2];
const read = (file) => readFileSync(join(folder, file));
const text = (file) => read(join('hairline-shaders', file)).toString('utf8');

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
const { hairlineWgsl } = await import(pathToFileURL(join(folder, 'hairline-shaders/src/wgsl.js')));
assert.equal(hairlineWgsl, whole);

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
console.log('the shaders are right');
process.exit(0);
