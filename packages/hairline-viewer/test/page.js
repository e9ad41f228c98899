// The element in a page: one that is seen is drawn, one far below is not loaded, a device that is lost is replaced; what cannot be shown is told in words.
const send = (path, body) => fetch(path, { method: 'POST', body });
const fail = (reason) => send('/failure', String(reason?.stack ?? reason));
addEventListener('unhandledrejection', (event) => fail(event.reason));

const within = (element, what) => element.shadowRoot.querySelector(what);
const posterOf = (element) => within(element, 'img');
const canvasOf = (element) => within(element, 'canvas');
const wordsOf = (element) => within(element, 'p').textContent;
const check = (isRight, what) => {
  if (!isRight) throw new Error(what);
};
const frame = () => new Promise((resolve) => { requestAnimationFrame(resolve); });

/** An event of an element, or the reason why it does not come. */
const event = (element, wanted, other) => new Promise((resolve, reject) => {
  element.addEventListener(wanted, resolve, { once: true });
  element.addEventListener(other, (is) => reject(is.detail ?? new Error(other)), { once: true });
});

/** Has the last device be lost, as a driver that hangs does. */
let lose = null;
/** Programs of scratches that were compiled. */
let programs = 0;
const { requestDevice } = GPUAdapter.prototype;
GPUAdapter.prototype.requestDevice = async function (...wanted) {
  const device = await requestDevice.apply(this, wanted);
  Object.defineProperty(device, 'lost', { value: new Promise((resolve) => { lose = resolve; }) });
  return device;
};
/** Workers of Hairline's own code that were started. */
let workers = 0;
const { Worker } = globalThis;
globalThis.Worker = class extends Worker {
  constructor(url, options) {
    super(url, options);
    workers += String(url).endsWith('/engine_worker.js') ? 1 : 0;
  }
};
const { createShaderModule } = GPUDevice.prototype;
GPUDevice.prototype.createShaderModule = function (described) {
  programs += described.code.includes('fn hairline_mask') ? 1 : 0;
  return createShaderModule.call(this, described);
};

/** The one name in the accessibility tree of what an element shows. */
function nameOf(element) {
  const named = [...element.shadowRoot.querySelectorAll('*')].filter((part) => part.checkVisibility() && part.ariaHidden !== 'true');
  const names = named.map((part) => part.getAttribute('aria-label') || part.alt || part.textContent.split('\n')[0]).filter((name) => name && !name.includes(':host'));
  check(names.length === 1, `found the names ${JSON.stringify(names)}; must be one`);
  return names[0];
}

/** A new element, at the top of the page. */
function add(given) {
  const element = document.createElement('hairline-viewer');
  for (const [name, value] of Object.entries(given)) element.setAttribute(name, value);
  document.body.prepend(element);
  return element;
}

/** What comes of a model: the element, drawn. */
async function shown(src) {
  const element = add({ src, alt: src });
  await event(element, 'load', 'error');
  return element;
}

/** Codes of what a canvas shows, once it is not black. It holds its picture until the end of the frame that drew it, and on a slow machine none in some frames. */
async function pixelsOf(element) {
  for (let i = 0; i < 50; i += 1) {
    // Another exposure draws anew.
    element.setAttribute('exposure', String(1 + 1e-3 * i));
    const bitmap = await frame().then(() => createImageBitmap(canvasOf(element)));
    const picture = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    picture.drawImage(bitmap, 0, 0);
    const { data } = picture.getImageData(0, 0, bitmap.width, bitmap.height);
    if (data.some((value, k) => k % 4 < 3 && value > 0)) return data;
  }
  throw new Error(`${element.src}: found a black picture`);
}

const pressed = (canvas, key) => canvas.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
const wheeled = (canvas) => canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: 100, bubbles: true, cancelable: true }));
const pointed = (canvas, type) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, pointerType: 'mouse', bubbles: true, composed: true, clientX: 9, clientY: 9 }));

/** Keys, the wheel and fingers: the page keeps what is its own. */
async function handles(element) {
  const canvas = canvasOf(element);
  check(canvas.tabIndex === 0 && canvas.getAttribute('role') === 'application', 'found a canvas without keys or role');
  check(getComputedStyle(canvas).touchAction === 'pan-y', `found touch-action ${getComputedStyle(canvas).touchAction}`);
  const before = (await pixelsOf(element)).join();
  check(!pressed(canvas, 'ArrowLeft'), 'found that the page takes the keys of the model');
  check(pressed(canvas, 'Tab'), 'found that the model takes the keys of the page');
  check((await pixelsOf(element)).join() !== before, 'found the same picture after a key');
  check(wheeled(canvas), 'found that the wheel turns the model before a click');
  // Of an event that no pointer sent there is none to capture.
  canvas.setPointerCapture = () => {};
  canvas.releasePointerCapture = () => {};
  pointed(canvas, 'pointerdown');
  pointed(canvas, 'pointerup');
  check(!wheeled(canvas), 'found that the wheel scrolls the page after a click');
  pointed(canvas, 'pointerleave');
  check(wheeled(canvas), 'found that the wheel turns the model after the pointer left');
}

/** What cannot be shown is told in words, beside `alt`. */
async function refuses(given, message) {
  const element = add({ alt: 'a steel pan', ...given });
  const { detail } = await event(element, 'error', 'load');
  check(message.test(detail.message), `found the reason "${detail.message}"; must be ${message}`);
  check(wordsOf(element) === `a steel pan\nThe model cannot be shown: ${detail.message}.`, `found the words "${wordsOf(element)}"`);
  check(within(element, 'p').checkVisibility() && within(element, 'p').clientHeight > 20, 'found no words in sight');
  check(nameOf(element) === 'a steel pan', `found the name "${nameOf(element)}"`);
  element.remove();
}

try {
  const near = document.getElementById('near');
  const far = document.getElementById('far');
  const loaded = event(near, 'load', 'error');
  await import('/element/hairline-viewer.js');
  check(!posterOf(near).hidden && !canvasOf(near), 'found no poster at first');
  check(nameOf(near) === 'a steel plate', 'found another name of the poster');
  await loaded;
  check(posterOf(near).hidden && canvasOf(near), 'found the poster over the model');
  check(!canvasOf(far), 'found a model that is far below');
  check(workers === 1, `found ${workers} workers; must be one`);
  near.setAttribute('alt', 'a worn plate');
  check(nameOf(near) === 'a worn plate', `found the name "${nameOf(near)}" after another alt`);
  await send('/result/element', await pixelsOf(near));
  await handles(near);

  const first = canvasOf(near);
  const again = event(near, 'load', 'error');
  lose({ reason: 'unknown', message: 'a test' });
  await again;
  check(canvasOf(near) && canvasOf(near) !== first && posterOf(near).hidden, 'found no new canvas after the loss of the device');

  // What packs meshes and pictures.
  for (const name of ['draco', 'meshopt']) {
    const element = await shown(`/pages/${name}.glb`);
    await send(`/result/${name}`, await pixelsOf(element));
    element.remove();
  }
  programs = 0;
  const tiles = await shown('/pages/tiles.glb');
  // three.js gives the first material another key than the others, as its maps of the room are not made before.
  check(programs <= 2, `found ${programs} programs for six materials`);
  await send('/result/tiles', await pixelsOf(tiles));
  tiles.remove();

  const bytes = await (await fetch('/pages/plate.glb')).arrayBuffer();
  const addressOf = (...parts) => URL.createObjectURL(new Blob(parts));
  await refuses({ src: '/pages/none.glb' }, /^\/pages\/none\.glb cannot be fetched: 404 Not Found$/);
  await refuses({ src: addressOf('<!doctype html>') }, /is no model: found a page of HTML; must be a \.glb or \.gltf$/);
  await refuses({ src: addressOf(bytes.slice(0, bytes.byteLength / 2)) }, /is cut off: found \d+ bytes; must be \d+$/);
  // A poster that is none, too.
  await refuses({ src: '/pages/none.glb', poster: '/pages/none.png' }, /404/);

  // As where a page's rules forbid workers: it computes by itself.
  globalThis.Worker = class {
    constructor() {
      throw new Error('a test');
    }
  };
  (await shown('/pages/plate.glb')).remove();

  // As in a browser without WebGPU.
  Object.defineProperty(navigator, 'gpu', { value: undefined });
  await refuses({ src: '/pages/plate.glb' }, /^this browser has no WebGPU/);
  const refused = event(far, 'error', 'load');
  far.setAttribute('poster', posterOf(near).src);
  far.scrollIntoView();
  await refused;
  check(!posterOf(far).hidden && !canvasOf(far), 'found no poster without WebGPU');
  check(wordsOf(far).includes('no WebGPU'), `found the words "${wordsOf(far)}"`);
  await send('/done', '');
} catch (error) {
  fail(error);
}
