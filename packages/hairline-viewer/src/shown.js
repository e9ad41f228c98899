// A model on a canvas, which turns under the pointer and by keys.
import {
  ACESFilmicToneMapping, AgXToneMapping, Box3, NeutralToneMapping, NoToneMapping, PMREMGenerator, PerspectiveCamera, RectAreaLightNode, Scene, Vector3,
  WebGPURenderer,
} from 'three/webgpu';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { RectAreaLightTexturesLib } from 'three/addons/lights/RectAreaLightTexturesLib.js';
import { loadTables } from 'hairline-shaders/three';
import { hairlineScratches } from 'hairline-shaders/gltf';
import { fetchModel, readModel } from './model_file.js';

const CURVES = { neutral: NeutralToneMapping, agx: AgXToneMapping, aces: ACESFilmicToneMapping, none: NoToneMapping };
/** Lumens of a watt: lights of files are in candela and nits. */
const LUMENS_PER_WATT = 683;
/** The room around, over the light of a lamp: metal is nowhere black. */
const ROOM = 0.15;
/** What a press of a key turns by, and brings nearer by. */
const [TURN_RAD, NEARER] = [Math.PI / 18, 0.9];

const KEYS = {
  ArrowLeft: (controls) => controls.rotateLeft(TURN_RAD),
  ArrowRight: (controls) => controls.rotateLeft(-TURN_RAD),
  ArrowUp: (controls) => controls.rotateUp(TURN_RAD),
  ArrowDown: (controls) => controls.rotateUp(-TURN_RAD),
  '+': (controls) => controls.dollyIn(NEARER),
  '=': (controls) => controls.dollyIn(NEARER),
  '-': (controls) => controls.dollyOut(NEARER),
  Home: (controls) => controls.reset(),
};

/** The tables of all elements of a page. */
let tables = null;

/** The tables, once; after a failure anew. */
function tablesFrom(engine) {
  tables ??= loadTables(engine).catch((error) => {
    tables = null;
    throw new Error(`Hairline's own code cannot be loaded: ${error.message}`);
  });
  return tables;
}

/** A model on a canvas. `lost` is told why the graphics device is gone. */
export class Shown {
  constructor(element, lost) {
    this.element = element;
    this.lost = lost;
    this.isDrawn = false;
    this.isOver = false;
    this.gone = new AbortController();
  }

  /** `from`: `src` of the model, the addresses `engine` and `decoders`, `exposure` in stops, and the view that it was seen from before, if there is one. */
  async begin({ src, engine, decoders, exposure, view }) {
    if (!(await navigator.gpu?.requestAdapter())) throw new Error('this browser has no WebGPU, by which the model is drawn');
    const bytes = await fetchModel(src, this.gone.signal);
    const renderer = new WebGPURenderer({ antialias: true });
    this.renderer = renderer;
    renderer.onDeviceLost = ({ message }) => this.lost(message);
    await renderer.init();
    RectAreaLightNode.setLTC(RectAreaLightTexturesLib.init());
    const plugIn = hairlineScratches({ tables: await tablesFrom(engine) });
    const gltf = await readModel(bytes, { src, decoders, renderer, plugIn });
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
    this.lay(renderer.domElement);
    if (view) {
      this.camera.position.copy(view.position);
      this.controls.target.copy(view.target);
      this.controls.update();
    }
    this.expose(exposure);
    await this.draw();
    if (this.isOver) return;
    this.isDrawn = true;
    this.element.shadowRoot.prepend(renderer.domElement);
    this.ask();
  }

  /** Lays the canvas under the pointer and the keys. */
  lay(canvas) {
    canvas.setAttribute('part', 'canvas');
    canvas.tabIndex = 0;
    // Its keys are its own.
    canvas.setAttribute('role', 'application');
    canvas.setAttribute('aria-description', 'Arrow keys turn it, + and - bring it nearer and farther, Home turns it back.');
    // The wheel scrolls the page until the model was clicked; a pinch is always meant.
    const zooms = (does) => () => { this.controls.enableZoom = does; };
    canvas.addEventListener('pointerdown', zooms(true));
    for (const leaves of ['pointerleave', 'blur']) canvas.addEventListener(leaves, zooms(false));
    const controls = new OrbitControls(this.camera, canvas);
    this.controls = controls;
    controls.target.copy(this.target);
    Object.assign(controls, { enablePan: false, enableZoom: false });
    // A finger that moves up or down scrolls the page.
    canvas.style.touchAction = 'pan-y';
    controls.addEventListener('change', () => this.ask());
    controls.update();
    controls.saveState();
    canvas.addEventListener('keydown', (event) => {
      const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : KEYS[event.key];
      if (!act) return;
      event.preventDefault();
      const { enableZoom } = controls;
      controls.enableZoom = true;
      act(controls);
      controls.enableZoom = enableZoom;
    });
    this.sizes = new ResizeObserver(() => this.ask());
    this.sizes.observe(this.element);
  }

  /** The words that stand for the picture. */
  name(label) {
    this.renderer?.domElement?.setAttribute('aria-label', label);
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
    this.gone.abort();
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
