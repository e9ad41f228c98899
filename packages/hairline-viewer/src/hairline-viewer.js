// <hairline-viewer src="worn.glb">: a worn model that turns under the pointer, with its scratches in colour. It is loaded when it comes into view. Until
// then, and in browsers without WebGPU, it is its poster.
import {
  ACESFilmicToneMapping, Box3, NeutralToneMapping, NoToneMapping, AgXToneMapping, PMREMGenerator, PerspectiveCamera, Scene, Vector3, WebGPURenderer,
  RectAreaLightNode,
} from 'three/webgpu';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { RectAreaLightTexturesLib } from 'three/addons/lights/RectAreaLightTexturesLib.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { loadTables } from 'hairline-shaders/three';
import { hairlineScratches } from 'hairline-shaders/gltf';

const CURVES = { neutral: NeutralToneMapping, agx: AgXToneMapping, aces: ACESFilmicToneMapping, none: NoToneMapping };
/** Lumens of a watt: lights of files are in candela and nits. */
const LUMENS_PER_WATT = 683;
/** The room around, over the light of a lamp: metal is nowhere black. */
const ROOM = 0.15;

const STYLE = `
:host { display: block; position: relative; aspect-ratio: 16 / 9; overflow: hidden; touch-action: pan-y; background: #000; }
:host([hidden]) { display: none; }
canvas, img { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: cover; border: 0; }
img { transition: opacity 0.3s; }
img[hidden] { display: block; opacity: 0; pointer-events: none; }
@media (prefers-reduced-motion: reduce) { img { transition: none; } }
`;

/** Times that a graphics device may be lost before the element gives up. */
const LOSSES = 3;

/** The tables of all elements of a page. */
let tables = null;

export class HairlineViewer extends HTMLElement {
  static get observedAttributes() {
    return ['src', 'poster', 'alt', 'exposure'];
  }

  #poster = document.createElement('img');

  #watch = null;

  #shown = null;

  #losses = 0;

  constructor() {
    super();
    const style = document.createElement('style');
    style.textContent = STYLE;
    this.attachShadow({ mode: 'open' }).append(style, this.#poster);
    this.#poster.setAttribute('part', 'poster');
  }

  connectedCallback() {
    this.#showPoster();
    // Ahead of the scroll, so that most are there when they are seen.
    this.#watch = new IntersectionObserver((entries) => {
      if (entries.some((entry) => entry.isIntersecting)) this.#load();
    }, { rootMargin: '200px' });
    this.#watch.observe(this);
  }

  disconnectedCallback() {
    this.#watch?.disconnect();
    this.#watch = null;
    this.#forget();
  }

  attributeChangedCallback(name, before, after) {
    if (before === after || !this.#watch) return;
    if (name === 'exposure') this.#shown?.expose(this.#exposure);
    else if (name === 'src') {
      this.#forget();
      this.#losses = 0;
      this.#watch.unobserve(this);
      this.#watch.observe(this);
    }
    this.#showPoster();
  }

  get src() {
    return this.getAttribute('src');
  }

  set src(value) {
    this.setAttribute('src', value);
  }

  get #exposure() {
    const given = Number(this.getAttribute('exposure') ?? 0);
    return Number.isFinite(given) ? given : 0;
  }

  #showPoster() {
    const poster = this.getAttribute('poster');
    if (poster) this.#poster.src = poster;
    else this.#poster.removeAttribute('src');
    this.#poster.alt = this.getAttribute('alt') ?? '';
    this.#poster.hidden = !poster || this.#shown?.isDrawn === true;
  }

  #forget() {
    this.#shown?.end();
    this.#shown = null;
    this.#poster.hidden = !this.getAttribute('poster');
  }

  /** From a view that it was seen from before, if there is one. */
  async #load(view = null) {
    if (this.#shown || !this.src) return;
    const shown = new Shown(this, (message) => this.#lost(shown, message));
    this.#shown = shown;
    try {
      await shown.begin(this.src, this.#exposure, view);
      if (this.#shown !== shown) return;
      this.#poster.hidden = true;
      this.dispatchEvent(new CustomEvent('load'));
    } catch (error) {
      if (this.#shown !== shown) return;
      shown.end();
      // The poster stays.
      this.dispatchEvent(new CustomEvent('error', { detail: error }));
    }
  }

  /** The graphics device is gone: all is made anew on another one. */
  #lost(shown, message) {
    if (this.#shown !== shown) return;
    this.#forget();
    this.#losses += 1;
    if (this.#losses < LOSSES) this.#load(shown.view());
    else this.dispatchEvent(new CustomEvent('error', { detail: new Error(`the graphics device was lost ${LOSSES} times: ${message}`) }));
  }
}

/** A model on a canvas. `lost` is told why the graphics device is gone. */
class Shown {
  constructor(element, lost) {
    this.element = element;
    this.lost = lost;
    this.isDrawn = false;
    this.isOver = false;
  }

  async begin(src, exposure, view) {
    if (!(await navigator.gpu?.requestAdapter())) throw new Error('this browser has no WebGPU');
    const renderer = new WebGPURenderer({ antialias: true });
    this.renderer = renderer;
    renderer.onDeviceLost = ({ message }) => this.lost(message);
    await renderer.init();
    RectAreaLightNode.setLTC(RectAreaLightTexturesLib.init());
    tables ??= loadTables(this.element.getAttribute('engine') ?? new URL('engine_bg.wasm', import.meta.url));
    const loader = new GLTFLoader().register(hairlineScratches({ tables: await tables }));
    const gltf = await loader.loadAsync(src);
    if (this.isOver) return;
    const scene = new Scene();
    scene.add(gltf.scene);
    const room = new RoomEnvironment();
    scene.environment = await environmentOf(renderer, room);
    const extension = gltf.parser.json.extensions?.HAIRLINE_scratches;
    this.stops = extension?.camera?.exposure_ev ?? 0;
    // In watts: a lamp's mirror image in candela exceeds the half floats of the canvas. Emission of files is in watts already.
    gltf.scene.traverse((node) => {
      if (node.isLight) node.intensity /= LUMENS_PER_WATT;
    });
    // What is no file of Hairline's has no lamps: the room lights it.
    scene.environmentIntensity = extension === undefined ? 1 : ROOM;
    renderer.toneMapping = CURVES[extension?.render?.tone_map ?? 'neutral'] ?? NeutralToneMapping;
    Object.assign(this, { scene, ...viewOf(gltf, extension) });
    if (view) {
      this.camera.position.copy(view.position);
      this.target.copy(view.target);
    }
    const canvas = renderer.domElement;
    canvas.setAttribute('part', 'canvas');
    canvas.tabIndex = 0;
    canvas.setAttribute('aria-label', this.element.getAttribute('alt') ?? 'a model that can be turned');
    this.element.shadowRoot.insertBefore(canvas, this.element.shadowRoot.querySelector('img'));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.copy(this.target);
    this.controls.enablePan = false;
    this.controls.addEventListener('change', () => this.ask());
    this.controls.update();
    this.sizes = new ResizeObserver(() => this.ask());
    this.sizes.observe(this.element);
    this.expose(exposure);
    await this.draw();
    this.isDrawn = true;
  }

  /** Where it is seen from and what is in the middle; null before it is there. */
  view() {
    return this.controls ? { position: this.camera.position, target: this.controls.target } : null;
  }

  expose(stops) {
    if (!this.renderer) return;
    this.renderer.toneMappingExposure = 2 ** (this.stops + stops);
    this.ask();
  }

  /** A picture with the next frame: none is drawn while nothing moves. */
  ask() {
    if (this.isOver || this.isAsked || !this.camera) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      if (!this.isOver) this.draw();
    });
  }

  async draw() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    const { renderer, camera, scene } = this;
    renderer.setPixelRatio(Math.min(globalThis.devicePixelRatio ?? 1, 2));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (!this.isDrawn) await renderer.compileAsync(scene, camera);
    renderer.render(scene, camera);
  }

  end() {
    this.isOver = true;
    this.sizes?.disconnect();
    this.controls?.dispose();
    this.renderer?.domElement?.remove();
    this.renderer?.dispose();
  }
}

async function environmentOf(renderer, room) {
  const generator = new PMREMGenerator(renderer);
  const { texture } = await generator.fromScene(room, 0.04);
  generator.dispose();
  return texture;
}

/** The file's camera and what it looks at; without one a view of all. */
function viewOf(gltf, extension) {
  gltf.scene.updateMatrixWorld(true);
  const own = gltf.cameras.find((camera) => camera.isPerspectiveCamera);
  if (own) {
    const camera = own.clone(false);
    own.matrixWorld.decompose(camera.position, camera.quaternion, camera.scale);
    const { position_m: eye, target_m: aim } = extension?.camera ?? {};
    const distance = eye && aim ? Math.hypot(...eye.map((x, k) => x - aim[k])) : 1;
    const target = new Vector3(0, 0, -distance).applyQuaternion(camera.quaternion).add(camera.position);
    return { camera, target };
  }
  const box = new Box3().setFromObject(gltf.scene);
  const radius = box.getSize(new Vector3()).length() / 2 || 1;
  const target = box.getCenter(new Vector3());
  const camera = new PerspectiveCamera(30, 1, radius / 100, radius * 100);
  camera.position.set(-0.4, 0.5, 1).setLength(radius / Math.sin(Math.PI / 12)).add(target);
  camera.lookAt(target);
  return { camera, target };
}

if (!customElements.get('hairline-viewer')) customElements.define('hairline-viewer', HairlineViewer);
