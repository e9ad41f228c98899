// The element in a page: one that is seen is drawn, one far below is not loaded, a device that is lost is replaced, and without WebGPU the poster stays.
const send = (path, body) => fetch(path, { method: 'POST', body });
const fail = (reason) => send('/failure', String(reason?.stack ?? reason));
addEventListener('unhandledrejection', (event) => fail(event.reason));

const posterOf = (element) => element.shadowRoot.querySelector('img');
const canvasOf = (element) => element.shadowRoot.querySelector('canvas');
const check = (isRight, what) => {
  if (!isRight) throw new Error(what);
};

/** An event of an element, or the reason why it does not come. */
const event = (element, wanted, other) => new Promise((resolve, reject) => {
  element.addEventListener(wanted, resolve, { once: true });
  element.addEventListener(other, (is) => reject(is.detail ?? new Error(other)), { once: true });
});

/** Has the last device be lost, as a driver that hangs does. */
let lose = null;
const { requestDevice } = GPUAdapter.prototype;
GPUAdapter.prototype.requestDevice = async function (...wanted) {
  const device = await requestDevice.apply(this, wanted);
  Object.defineProperty(device, 'lost', { value: new Promise((resolve) => { lose = resolve; }) });
  return device;
};

try {
  const near = document.getElementById('near');
  const far = document.getElementById('far');
  const loaded = event(near, 'load', 'error');
  await import('/element/hairline-viewer.js');
  check(!posterOf(near).hidden && !canvasOf(near), 'found no poster at first');
  await loaded;
  check(posterOf(near).hidden && canvasOf(near), 'found the poster over the model');
  check(!canvasOf(far), 'found a model that is far below');
  // A canvas holds its picture until the end of the frame that drew it, and on a slow machine none in some frames. Another exposure draws anew.
  let pixels = null;
  for (let i = 0; i < 50 && !pixels?.some((value, k) => k % 4 < 3 && value > 0); i += 1) {
    near.setAttribute('exposure', String(1e-3 * i));
    const bitmap = await new Promise((resolve) => requestAnimationFrame(() => resolve(createImageBitmap(canvasOf(near)))));
    const picture = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    picture.drawImage(bitmap, 0, 0);
    pixels = picture.getImageData(0, 0, bitmap.width, bitmap.height).data;
  }
  await send('/result/element', pixels);

  const first = canvasOf(near);
  const again = event(near, 'load', 'error');
  lose({ reason: 'unknown', message: 'a test' });
  await again;
  check(canvasOf(near) && canvasOf(near) !== first && posterOf(near).hidden, 'found no new canvas after the loss of the device');

  // As in a browser without WebGPU.
  Object.defineProperty(navigator, 'gpu', { value: undefined });
  const refused = event(far, 'error', 'load');
  far.setAttribute('poster', posterOf(near).src);
  far.scrollIntoView();
  check((await refused).detail.message.includes('no WebGPU'), 'found another reason');
  check(!posterOf(far).hidden && !canvasOf(far), 'found no poster without WebGPU');
  await send('/done', '');
} catch (error) {
  fail(error);
}
