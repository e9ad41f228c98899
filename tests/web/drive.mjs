// Drives the viewer in headless Chromium, on its software driver for WebGPU: `node drive.mjs [--short] [--pictures PLACE] FOLDER PROGRAM`.
// FOLDER is what `cargo xtask web` made, PROGRAM is the command line, which renders what is compared; pictures of the page go to PLACE.
// Prints a line a step; ends with 1 at the first that fails. First the processor renders, as a page chooses on a software driver; then WebGPU.
// The short form has a smaller window, and leaves out fingers, most letters, and what files of models and environments become.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createReadStream, existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { parseArgs } from 'node:util';
import puppeteer from 'puppeteer-core';
import { fit } from './letters.mjs';

const { values: flags, positionals } = parseArgs({ allowPositionals: true, options: { short: { type: 'boolean' }, pictures: { type: 'string' } } });
const [folder, program] = positionals;
const viewport = flags.short ? { width: 900, height: 560 } : { width: 1200, height: 700 };
const here = import.meta.dirname;
const scratch = mkdtempSync(join(tmpdir(), 'hairline-web-'));
const CHROMES = ['chromium', 'google-chrome', 'chromium-browser'].map((name) => `/usr/bin/${name}`);
/** Of a step that waits for a picture: SwiftShader renders on the processor. */
const PATIENCE_MS = 120_000;
/** What the first picture may take, from the address on. */
const FIRST_PICTURE_MS = 60_000;

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.json': 'application/json' };
const server = createServer((request, response) => {
  const path = join(folder, decodeURIComponent(new URL(request.url, 'http://x').pathname).replace(/\/$/, '/index.html'));
  if (!existsSync(path) || !statSync(path).isFile()) return response.writeHead(404).end();
  response.writeHead(200, { 'content-type': TYPES[extname(path)] ?? 'application/octet-stream' });
  createReadStream(path).pipe(response);
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
const address = `http://127.0.0.1:${server.address().port}/`;

const browser = await puppeteer.launch({
  executablePath: process.env.CHROME ?? CHROMES.find(existsSync),
  // With Vulkan alone can headless Chromium show what WebGPU draws: else it takes the device away at the first frame.
  args: ['--no-sandbox', '--disable-dev-shm-usage', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader', '--use-angle=swiftshader'],
  defaultViewport: viewport,
});
await browser.defaultBrowserContext().overridePermissions(address, ['clipboard-read', 'clipboard-sanitized-write']);

const started = Date.now();
const told = (step, text = '') => console.log(`${((Date.now() - started) / 1000).toFixed(1).padStart(6)} s  ${step} ${text}`);
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

async function open(fragment = '') {
  const page = await browser.newPage();
  page.on('pageerror', (error) => told('page error:', error.message));
  page.on('console', (message) => message.type() === 'error' && told('console:', message.text()));
  await page.goto(address + fragment);
  return page;
}

const state = (page) => page.evaluate(() => window.hairline?.state());

/** The state, once it `is` as it should be. */
async function until(page, what, is, patience = PATIENCE_MS) {
  const end = Date.now() + patience;
  for (;;) {
    const now = await state(page);
    if (now && is(now)) return now;
    if (Date.now() > end) {
      await page.screenshot({ path: join(tmpdir(), 'hairline-web-failed.png') });
      const words = await page.evaluate(() => document.getElementById('words').textContent);
      throw new Error(`${what}: not within ${patience / 1000} s: ${JSON.stringify(now)}; the page says "${words}"`);
    }
    await pause(100);
  }
}

async function press(page, ...keys) {
  for (const key of keys) await page.keyboard.down(key);
  for (const key of keys.reverse()) await page.keyboard.up(key);
  // The keyboard moves on by one control in a pass.
  await drawn(page);
}

/** Until the window has been drawn with what it was told. */
const drawn = (page) =>
  page.evaluate(async () => {
    for (let i = 0; i < 3; i += 1) await new Promise(requestAnimationFrame);
  });

async function give(page, ...paths) {
  const chooser = await page.$('#chooser');
  await chooser.uploadFile(...paths);
}

/** A file that the page hands out. */
async function downloaded(name) {
  const path = join(scratch, name);
  for (const end = Date.now() + PATIENCE_MS; !existsSync(path); await pause(100)) assert(Date.now() < end, `no ${name} came`);
  return path;
}

async function allowDownloads(page) {
  const cdp = await page.createCDPSession();
  await cdp.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: scratch });
}

async function keep(page, name) {
  if (flags.pictures) await page.screenshot({ path: join(flags.pictures, `${name}.png`) });
}

/** Of the picture, beside the panels, which stand one above the other in a window as narrow as this. */
const MIDDLE = { x: viewport.width / 2 + 150, y: viewport.height / 2 };

/** Turns the view by a drag, about the target; returns the state with its picture. */
async function turn(page, before) {
  await page.mouse.move(MIDDLE.x, MIDDLE.y);
  await page.mouse.down();
  await page.mouse.move(MIDDLE.x + 60, MIDDLE.y - 20, { steps: 4 });
  await page.mouse.up();
  const turned = await until(page, 'orbit', (now) => now.pictures > before.pictures && now.camera[0] !== before.camera[0]);
  const ratio = distance(turned.camera, before.target) / distance(before.camera, before.target);
  assert(Math.abs(ratio - 1) < 1e-6, 'turned about the target');
  return turned;
}

const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

/** Fingers at points of the page, frame by frame: what each frame holds is where they are. */
async function fingers(page, frames) {
  const cdp = await page.createCDPSession();
  const send = (type, points) => cdp.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  // At once, before the page answers: fingers that rest are a long press.
  await Promise.all([send('touchStart', frames[0]), send('touchMove', frames[1])]);
  for (const points of frames.slice(2)) {
    await drawn(page);
    await send('touchMove', points);
  }
  await drawn(page);
  await send('touchEnd', []);
  await drawn(page);
  await cdp.detach();
}

/** One finger turns the view, two that spread bring it nearer. */
async function touch(page, before) {
  const { x, y } = MIDDLE;
  const steps = [0, 1, 2, 3];
  await fingers(page, steps.map((i) => [[x + 25 * i, y - 10 * i]]));
  const turned = await until(page, 'a turn by touch', (now) => now.pictures > before.pictures && distance(now.camera, before.camera) > 1e-4);
  assert(Math.abs(distance(turned.camera, turned.target) / distance(before.camera, before.target) - 1) < 1e-6, 'one finger does not zoom');
  await fingers(page, steps.map((i) => [[x - 50 - 25 * i, y], [x + 50 + 25 * i, y]]));
  const isNearer = (now) => distance(now.camera, now.target) < 0.8 * distance(turned.camera, turned.target);
  return until(page, 'two fingers that spread', isNearer);
}

/** A model and an environment join the scene, which is saved with their names. */
async function addFiles(page) {
  await give(page, join(folder, 'scenes/models/spoon.glb'));
  await until(page, 'a model', (now) => now.objects === 2);
  told('a model was added');
  await give(page, join(folder, 'scenes/maps/evening.hdr'));
  await until(page, 'an environment', (now) => now.environment);
  told('an environment was set');

  await press(page, 'Control', 's');
  await press(page, 'Enter');
  const text = readFileSync(await downloaded('scene.toml'), 'utf8');
  assert(text.includes('spoon.glb') && text.includes('evening.hdr'), text);
  told('the scene was saved');
}

try {
  const page = await open();
  await allowDownloads(page);
  const first = await until(page, 'first picture', (now) => now.pictures > 0, FIRST_PICTURE_MS);
  told('the first picture is there, by', first.backend);
  assert.deepEqual(first.messages, []);
  await keep(page, 'start');
  const shown = await page.screenshot({ encoding: 'base64' });
  for (const word of ['Tools', 'Objects', 'circular']) {
    const { correlation, off } = await fit(page, shown, word);
    assert(correlation > 0.9 && off < 0.5, `the word ${word} is not as the browser draws it: a pixel is ${off.toFixed(2)} off, correlation ${correlation.toFixed(3)}`);
  }
  told('words have all their letters');
  const turned = await turn(page, first);
  told('a drag turned the view');
  await keep(page, 'turned');
  if (!flags.short) {
    await touch(page, turned);
    told('one finger turned the view, two brought it nearer');
  }

  await give(page, join(here, 'scene.toml'));
  const opened = await until(page, 'a scene', (now) => now.objects === 1 && now.finished && !now.building);
  assert.deepEqual(opened.messages, []);
  told('a scene file was opened and rendered to its end');
  await keep(page, 'scene');

  await page.mouse.click(MIDDLE.x, MIDDLE.y);
  await until(page, 'a selection', (now) => now.selection.startsWith('Object'));
  await press(page, 'Control', 'd');
  await until(page, 'an edit', (now) => now.objects === 2);
  await press(page, 'Control', 'z');
  await until(page, 'undo', (now) => now.objects === 1);
  told('an edit was done and undone');

  await press(page, 'Shift', 'l');
  await until(page, 'a link', (now) => now.messages.some((text) => text.includes('in the clipboard')));
  let link = '';
  // The page is told of it before the browser has put it there.
  for (const end = Date.now() + PATIENCE_MS; !link && Date.now() < end; await pause(100)) link = await page.evaluate(() => navigator.clipboard.readText());
  const fragment = new URL(link).hash;
  const other = await open(fragment);
  const same = await until(other, 'the scene of a link', (now) => now.pictures > 0 && now.objects === 1);
  assert.deepEqual(same.camera, opened.camera);
  told('a link opened the same scene:', `${fragment.length} bytes`);
  await other.evaluate((cut) => (location.hash = cut), fragment.slice(0, -40));
  const warned = await until(other, 'a warning', (now) => now.messages.some((text) => text.includes('cut short')));
  assert.equal(warned.objects, 1, 'the scene that was open stays');
  told('a link that was cut short was refused');
  await other.close();

  const broken = join(scratch, 'broken.glb');
  writeFileSync(broken, readFileSync(join(folder, 'scenes/models/spoon.glb')).subarray(0, 5000));
  const huge = join(scratch, 'huge.hdr');
  writeFileSync(huge, '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 40000\n');
  for (const [path, words] of [[broken, 'broken.glb'], [huge, '16384 pixels']]) {
    await give(page, path);
    const now = await until(page, path, (now) => now.messages.some((text) => text.includes(words)));
    assert.equal(now.objects, 1, 'the scene that was open stays');
    told('refused:', now.messages.find((text) => text.includes(words)));
  }
  if (!flags.short) await addFiles(page);
  await page.close();

  const by_webgpu = await open(`?backend=gpu${fragment}`);
  await allowDownloads(by_webgpu);
  const by_gpu = await until(by_webgpu, 'first picture', (now) => now.pictures > 0 && now.objects === 1, FIRST_PICTURE_MS);
  assert(by_gpu.backend.includes('webgpu'), by_gpu.backend);
  told('the first picture is there, by', by_gpu.backend);
  await press(by_webgpu, 'Control', 'p');
  await press(by_webgpu, 'Shift', 'Tab');
  await press(by_webgpu, 'Shift', 'Tab');
  await press(by_webgpu, 'Enter');
  const picture = await downloaded('scene.png');
  const native = join(scratch, 'native.png');
  const as = ['--shadows', by_gpu.shadows ? 'on' : 'off', '--backend', 'cpu'];
  execFileSync(program, ['render', join(here, 'scene.toml'), '-o', native, ...as]);
  const figures = execFileSync(program, ['compare', picture, native, '--json', '--fail-above', 'flip=0.005', '--fail-above', 'relative-rms=0.01']);
  told('the exported picture is that of the command line:', figures.toString().replace(/\s+/g, ' ').slice(0, 200));
  await turn(by_webgpu, await state(by_webgpu));
  told('a drag turned the view');
  await keep(by_webgpu, 'gpu');
} finally {
  await browser.close();
  server.close();
  rmSync(scratch, { recursive: true });
}
