// Draws the scenes that `cargo xtask package --pictures` wrote, with scratches and without, and sends the pictures back.
import * as THREE from 'three/webgpu';
import { RectAreaLightTexturesLib } from 'three/addons/lights/RectAreaLightTexturesLib.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { hairlineScratches } from 'hairline-shaders/gltf';
import { Grating, ScratchedNodeMaterial, loadTables, prepareEnvironment, readScratches, scratchesOn } from 'hairline-shaders/three';

const send = (path, body) => fetch(path, { method: 'POST', body });
const fail = (reason) => send('/failure', String(reason?.stack ?? reason));
addEventListener('unhandledrejection', (event) => fail(event.reason));
// three.js goes on without what it cannot compile.
console.error = (...said) => fail(said.map((it) => it?.stack ?? it).join(' '));

/** Positions and normals of f32, then indices. */
function geometryOf(bytes, { vertices, triangles }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(bytes, 0, 3 * vertices), 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(bytes, 12 * vertices, 3 * vertices), 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes, 24 * vertices, 3 * triangles), 1));
  return geometry;
}

function colour(light, [r, g, b], factor) {
  const most = Math.max(r, g, b, 1e-9);
  light.color.setRGB(r / most, g / most, b / most);
  light.intensity = most * factor;
  return light;
}

/** Corners of the polygon that stands for a disk. */
const DISK_CORNERS = 24;
/** Beyond it a sphere is a sun. */
const FAR_M = 1e4;

const vectors = (places) => places.map((place) => new THREE.Vector3(...place));

function roundLight({ center, radius, radiance, cone }) {
  const place = new THREE.Vector3(...center);
  let light;
  if (place.length() > FAR_M) {
    const sine = radius / place.length();
    light = colour(new THREE.DirectionalLight(), radiance, Math.PI * sine * sine);
    light.userData.angle = Math.asin(sine);
    light.position.copy(place.normalize());
    return light;
  }
  // Candela of a sphere of that radiance.
  light = colour(cone ? new THREE.SpotLight(0xffffff, 1, 0, cone.outer, 1 - cone.inner / cone.outer) : new THREE.PointLight(), radiance, Math.PI * radius * radius);
  light.position.copy(place);
  light.userData.radius = radius;
  if (cone) light.add(light.target);
  light.target?.position.set(...cone.axis);
  return light;
}

function flatLight({ corners, radiance, cone }) {
  const places = vectors(corners);
  const middle = new THREE.Box3().setFromPoints(places).getCenter(new THREE.Vector3());
  const edge = (i) => places[(i + 1) % places.length].clone().sub(places[i]);
  const area = new THREE.Vector3();
  places.forEach((place, i) => area.addScaledVector(place.clone().sub(middle).cross(edge(i)), 0.5));
  // It shines to its own -z, from where its corners are seen counter-clockwise.
  const x = edge(0).normalize();
  const z = area.clone().normalize().negate();
  const y = z.clone().cross(x);
  const light = colour(new THREE.RectAreaLight(0xffffff, 1, edge(0).length(), edge(1).length()), radiance, 1);
  light.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, y, z));
  light.position.copy(middle);
  if (places.length === DISK_CORNERS) {
    light.userData.shape = 'disk';
    light.width = light.height = 2 * Math.sqrt(area.length() / Math.PI);
  } else if (places.length !== 4) {
    light.userData.shape = 'polygon';
    light.userData.corners = places.map((place) => [place.sub(middle).dot(x), place.dot(y)]);
  }
  if (cone) Object.assign(light.userData, { angle: cone.outer, penumbra: 1 - cone.inner / cone.outer });
  return light;
}

function tubeLight({ ends, radius, radiance }) {
  const [a, b] = vectors(ends);
  const light = colour(new THREE.RectAreaLight(0xffffff, 1, a.distanceTo(b), 0), radiance, 1);
  light.position.copy(a).add(b).multiplyScalar(0.5);
  light.quaternion.setFromUnitVectors(new THREE.Vector3(1, 0, 0), b.sub(a).normalize());
  Object.assign(light.userData, { shape: 'tube', radius });
  return light;
}

const lightOf = (light) => ({ sphere: roundLight, flat: flatLight, tube: tubeLight })[light.kind](light);

/** A mesh by the package's classes, in the frame of the page; its lights beside it. */
function byHand(page, { geometry, scratches }, tables, what) {
  const { metal = null, color, metalness } = page.surface;
  const material = new ScratchedNodeMaterial({ tables, metal, scratches: what === 'bare' ? null : scratches, roughness: page.roughness });
  if (color) {
    material.color.setRGB(...color);
    material.metalness = metalness;
  }
  const all = new THREE.Group();
  // The picture is the same for an instance, or a skin on a bone, of a mesh that is turned back.
  const turn = new THREE.Matrix4().makeRotationZ(0.5).setPosition(0.01, 0.02, 0);
  let mesh;
  if (what === 'instanced') {
    mesh = new THREE.InstancedMesh(geometry, material, 1);
    mesh.setMatrixAt(0, turn);
  } else if (what === 'skinned') {
    const { count } = geometry.attributes.position;
    geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(new Uint16Array(4 * count), 4));
    geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(Array.from({ length: 4 * count }, (_, i) => Number(i % 4 === 0)), 4));
    mesh = new THREE.SkinnedMesh(geometry, material);
    const bone = new THREE.Bone();
    mesh.add(bone);
    mesh.bind(new THREE.Skeleton([bone], [new THREE.Matrix4()]), new THREE.Matrix4());
    bone.applyMatrix4(turn);
  } else {
    mesh = new THREE.Mesh(geometry, material);
  }
  if (what === 'instanced' || what === 'skinned') mesh.applyMatrix4(turn.invert());
  return all.add(mesh, ...page.lights.map(lightOf));
}

/** Makes a plane as three.js's own are: v rises, and triangles have no tangents. */
function toUpwards(geometry) {
  const { uv } = geometry.attributes;
  for (let i = 0; i < uv.count; i += 1) uv.setY(i, 1 - uv.getY(i));
  geometry.deleteAttribute('tangent');
}

function flipped(picture) {
  return picture && Object.assign(picture.clone(), { source: new THREE.Source(picture.image), flipY: true, needsUpdate: true });
}

/** Gratings on such a plane, which give the same picture; without their masks, and along the other texture coordinate, which give others. */
const GRATINGS = {
  faceted: (grating) => new Grating({ ...grating, mask: flipped(grating.mask), directions: flipped(grating.directions) }),
  unmasked: (grating) => new Grating({ ...grating, mask: null }),
  swapped: (grating) => new Grating({ ...grating, kind: { 'along-u': 'along-v', 'along-v': 'along-u' }[grating.kind] ?? grating.kind }),
};

/** The same scene from a file, as the plug-in makes it; plain as GLTFLoader does without it, bare without scratches. */
async function byFile(name, tables, what, told) {
  const isPlain = what === 'plain';
  const loader = new GLTFLoader();
  if (!isPlain) loader.register(hairlineScratches({ tables, warn: (text) => told.push(text) }));
  const { scene } = await loader.loadAsync(`/pages/${name}/${what === 'seeds' ? 'seeds' : 'worn'}.glb`);
  let lights = 0;
  scene.traverse((node) => {
    if (node.isLight) {
      // The picture's unit is a watt, the file's a lumen.
      node.intensity /= 683;
      lights += 1;
    }
    // Meshes of their own stand for instances.
    if (node.isMesh && node.count !== 0 && Boolean(node.material.isScratchedNodeMaterial) === isPlain) throw new Error(`${name}: found the material ${node.material.type}`);
    if (node.isMesh && node.count !== 0 && what === 'bare') {
      node.material = node.material.clone();
      node.material.scratches = null;
      node.material.gratings = [];
    }
    if (node.isMesh && what === 'faceted') toUpwards(node.geometry);
    if (node.isMesh && GRATINGS[what]) {
      node.material = node.material.clone();
      node.material.gratings = node.material.gratings.map(GRATINGS[what]);
    }
  });
  if (!isPlain && lights === 0) throw new Error(`${name}: found no light in the file`);
  scene.rotation.x = Math.PI / 2;
  return scene;
}

/** From the axes of three.js's maps to those of Hairline's. */
const MAP_FROM_THREE = new THREE.Matrix4().set(0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1);

/** Maps by their contents: some seconds each. */
const maps = new Map();

/** An environment of f32, rows from the top, with Hairline's own maps. */
async function environmentOf(bytes, { size: [width, height] }) {
  const digest = new Uint32Array(await crypto.subtle.digest('SHA-256', bytes)).join();
  if (maps.has(digest)) return maps.get(digest);
  const [rgb, data] = [new Float32Array(bytes), new Float32Array(4 * width * height)];
  for (let i = 0; i < width * height; i += 1) data.set([...rgb.subarray(3 * i, 3 * i + 3), 1], 4 * i);
  const map = new THREE.DataTexture(data, width, height, THREE.RGBAFormat, THREE.FloatType);
  Object.assign(map, { flipY: true, mapping: THREE.EquirectangularReflectionMapping, needsUpdate: true });
  await prepareEnvironment(map);
  maps.set(digest, map);
  return map;
}

/** Puts a scene under it; turned about the map's axis. */
function surround(scene, map, { intensity, mapFromWorld }, turn) {
  const worldFromMap = new THREE.Matrix4().setFromMatrix3(new THREE.Matrix3().fromArray(mapFromWorld)).transpose();
  scene.environment = map;
  scene.environmentIntensity = intensity;
  scene.environmentRotation.setFromRotationMatrix(worldFromMap.multiply(new THREE.Matrix4().makeRotationY(turn)).multiply(MAP_FROM_THREE));
}

/** Pictures of a scene of shapes, and of one whose mesh is a file. */
const BY_HAND = ['worn', 'bare'];
const PICTURES = {
  plate: ['instanced', 'file', 'seeds', 'plain'], grooves: ['file', 'skinned'], tiles: ['file', 'seeds'], layers: ['file', 'seeds'], sky: ['turned'],
  foil: ['file', 'seeds', 'faceted', 'unmasked', 'swapped'], bauble: ['faceted', 'swapped'],
};

async function draw(renderer, name, tables) {
  const get = async (file, as) => (await fetch(`/pages/${name}/${file}`))[as]();
  const page = await get('scene.json', 'json');
  const object = {
    geometry: geometryOf(await get('mesh.bin', 'arrayBuffer'), page),
    scratches: readScratches(await get('scratches.csv', 'text'), 'scratches.csv', { profile: page.profile }),
  };
  const { position, target, up, fov } = page.camera;
  const [width, height] = page.size;
  const camera = new THREE.PerspectiveCamera(fov, width / height, 0.001, 10);
  camera.position.set(...position);
  camera.up.set(...up);
  camera.lookAt(...target);
  const picture = new THREE.RenderTarget(width, height, { type: THREE.FloatType });
  const times = [];
  const start = performance.now();
  const map = page.environment && await environmentOf(await get('environment.bin', 'arrayBuffer'), page.environment);
  if (map) times.push(`maps of the environment in ${((performance.now() - start) / 1000).toFixed(1)} s`);
  const told = [];
  for (const what of [...BY_HAND, ...(PICTURES[name] ?? [])]) {
    const began = performance.now();
    const isByHand = page.surface && !['file', 'seeds', 'plain'].includes(what);
    const scene = new THREE.Scene().add(isByHand ? byHand(page, object, tables, what) : await byFile(name, tables, what, told));
    if (map) surround(scene, map, page.environment, what === 'turned' ? Math.PI / 36 : 0);
    const made = performance.now();
    renderer.setRenderTarget(picture);
    await renderer.compileAsync(scene, camera);
    const compiled = performance.now();
    renderer.render(scene, camera);
    const pixels = await renderer.readRenderTargetPixelsAsync(picture, 0, 0, width, height);
    const drawn = performance.now();
    const seconds = (from, to) => `${((to - from) / 1000).toFixed(2)} s`;
    times.push(`${what}: made in ${seconds(began, made)}, compiled in ${seconds(made, compiled)}, drawn in ${seconds(compiled, drawn)}`);
    await send(`/result/${name}/${what}`, new Float32Array(pixels.buffer, pixels.byteOffset, 4 * width * height).slice());
  }
  await send(`/result/${name}/told`, told.join('\n'));
  await send(`/result/${name}/times`, times.join('; '));
}

async function rendererOf(options) {
  const renderer = new THREE.WebGPURenderer({ antialias: false, ...options });
  await renderer.init();
  renderer.toneMapping = THREE.NoToneMapping;
  return renderer;
}

/** A picture in another size and back is the same, so is that of a second renderer, as after the loss of a device; on WebGL a message tells what is missing. */
async function outlives(renderer, tables) {
  const geometry = new THREE.PlaneGeometry(0.1, 0.1);
  const scratches = scratchesOn(geometry, { pattern: 'random', count: 200, depth_nm: 160, length_m: 0.05 });
  const lamp = lightOf({ kind: 'sphere', center: [0, 0.1, 0.1], radius: 0.004, radiance: [300, 300, 300] });
  const scene = new THREE.Scene().add(lamp, new THREE.Mesh(geometry, new ScratchedNodeMaterial({ tables, metal: 'steel', scratches })));
  const camera = new THREE.PerspectiveCamera(20, 1, 0.01, 1);
  camera.position.set(0, -0.1, 0.1);
  camera.lookAt(0, 0, 0);
  const pictureOf = async (by, [width, height]) => {
    const target = new THREE.RenderTarget(width, height, { type: THREE.FloatType });
    by.setRenderTarget(target);
    by.render(scene, camera);
    return (await by.readRenderTargetPixelsAsync(target, 0, 0, width, height)).join();
  };
  const [small, large] = [[16, 12], [32, 24]];
  const [first, other, again] = [await pictureOf(renderer, small), await pictureOf(renderer, large), await pictureOf(renderer, small)];
  if (again !== first) throw new Error('found another picture after one of another size');
  renderer.backend.device.destroy();
  if (await pictureOf(await rendererOf(), large) !== other) throw new Error('found another picture by a second renderer');
  const told = [];
  const { warn } = console;
  console.warn = (text) => told.push(text);
  const plain = await pictureOf(await rendererOf({ forceWebGL: true }), large);
  console.warn = warn;
  if (!told.some((text) => /^ScratchedNodeMaterial: found the backend for WebGL/.test(text))) throw new Error(`WebGL: found the messages ${told}`);
  if (!plain.split(',').some((value, i) => i % 4 < 3 && value > 0)) throw new Error('WebGL: found a black picture');
}

/** A file with a mistake in a layer or a grating has a message, and is shown plain. */
async function refusesMistakes(tables) {
  const mistakes = {
    'layers/seeds.glb': [
      ['"count":300', '"count":-30', /scratches\[1\]\.count: found .*-30.*: "tiles" is shown plain/],
      ['"mask":0', '"mask":9', /scratches\[1\]\.where\.mask: found 9; must be the number of one of `files`: "tiles" is shown plain/],
      ['"start_m":', '"start_n":', /scratches\[3\]\.file\.start_m: found undefined; must be the number of an accessor: "tiles" is shown plain/],
    ],
    'foil/worn.glb': [
      ['"mask":0', '"mask":9', /grating\[0\]\.mask: found 9; must be the number of one of `files`: "plate" is shown plain/],
      ['"kind":"along-v"', '"kind":"along-w"', /kind: found "along-w"; must be one of along, .*: "plate" is shown plain/],
    ],
  };
  for (const [file, rows] of Object.entries(mistakes)) {
    const bytes = new Uint8Array(await (await fetch(`/pages/${file}`)).arrayBuffer());
    const text = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
    for (const [right, wrong, message] of rows) {
      if (!text.includes(right)) throw new Error(`${file}: found no ${right}`);
      const told = [];
      const loader = new GLTFLoader().register(hairlineScratches({ tables, warn: (said) => told.push(said) }));
      const { scene } = await loader.parseAsync(Uint8Array.from(text.replace(right, wrong), (char) => char.charCodeAt(0)).buffer, '');
      if (told.length !== 1 || !message.test(told[0])) throw new Error(`${file}: found the messages ${told}; must be ${message}`);
      scene.traverse(({ material }) => {
        if (material?.isScratchedNodeMaterial) throw new Error(`${file}: found scratches after ${told}`);
      });
    }
  }
}

/** A file that is cut off is refused, wherever it ends. */
async function refusesWhatIsCutOff(tables) {
  const bytes = await (await fetch('/pages/plate/worn.glb')).arrayBuffer();
  for (const share of [0.3, 0.6, 0.9]) {
    const loader = new GLTFLoader().register(hairlineScratches({ tables }));
    const said = await loader.parseAsync(bytes.slice(0, Math.floor(share * bytes.byteLength)), '').then(() => 'nothing', (error) => error.message);
    if (!/found \d+ bytes in buffer 0; must be \d+: the file is cut off$/.test(said)) throw new Error(`a file cut off at ${share}: found the message "${said}"`);
  }
}

/** Maps that are none have a message. */
async function refusesMaps() {
  const square = new THREE.DataTexture(new Float32Array(4 * 16), 4, 4, THREE.RGBAFormat, THREE.FloatType);
  for (const [map, message] of [[square, /found a map of 4 x 4; must be twice as wide as high/], [new THREE.CubeTexture(), /must be an equirectangular DataTexture/]]) {
    const said = await prepareEnvironment(map).then(() => 'nothing', (error) => error.message);
    if (!message.test(said)) throw new Error(`prepareEnvironment: found the message "${said}"`);
  }
}

try {
  const renderer = await rendererOf();
  if (!renderer.backend.isWebGPUBackend) throw new Error('no WebGPU in this browser');
  renderer.backend.device.addEventListener('uncapturederror', (event) => fail(event.error.message));
  THREE.RectAreaLightNode.setLTC(RectAreaLightTexturesLib.init());
  const tables = await loadTables();
  for (const name of new URLSearchParams(location.search).get('scenes').split(',')) await draw(renderer, name, tables);
  await refusesMaps();
  await refusesMistakes(tables);
  await refusesWhatIsCutOff(tables);
  await outlives(renderer, tables);
  await send('/done', '');
} catch (error) {
  fail(error);
}
