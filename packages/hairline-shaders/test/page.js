// Draws the scenes that `cargo xtask package --pictures` wrote, with scratches and without, and sends the pictures back.
import * as THREE from 'three/webgpu';
import { RectAreaLightTexturesLib } from 'three/addons/lights/RectAreaLightTexturesLib.js';
import { makeScratchTable, scratchTable, tableSize } from 'hairline-shaders';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { hairlineScratches } from 'hairline-shaders/gltf';
import { ScratchedNodeMaterial, loadTables, readScratches } from 'hairline-shaders/three';

const send = (path, body) => fetch(path, { method: 'POST', body });
const fail = (reason) => send('/failure', String(reason?.stack ?? reason));
addEventListener('unhandledrejection', (event) => fail(event.reason));

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

function lightOf({ kind, center, radius, corners, radiance }, asSpot) {
  if (kind === 'sphere') {
    // Candela of a sphere of that radiance. The cone of a spot is wide enough to hold the scene, and points to its origin.
    const light = colour(asSpot ? new THREE.SpotLight(0xffffff, 1, 0, 1.2, 0.1) : new THREE.PointLight(), radiance, Math.PI * radius * radius);
    light.position.set(...center);
    light.userData.radius = radius;
    return light;
  }
  const [a, b, c] = corners.map((corner) => new THREE.Vector3(...corner));
  const [width, height] = [b.clone().sub(a), c.clone().sub(b)];
  const light = colour(new THREE.RectAreaLight(0xffffff, 1, width.length(), height.length()), radiance, 1);
  // Corners run counter-clockwise as seen from where it shines to, which is its own -z.
  const [x, y] = [height.clone().normalize(), width.clone().normalize()];
  light.width = height.length();
  light.height = width.length();
  light.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, y, x.clone().cross(y)));
  light.position.copy(a).add(c).multiplyScalar(0.5);
  return light;
}

/** The mesh of a file of the same scene, as the plug-in makes it, or as GLTFLoader does without it; in the frame of the page. */
async function meshOfFile(name, tables, isPlain, told) {
  const loader = new GLTFLoader();
  if (!isPlain) loader.register(hairlineScratches({ tables, warn: (what) => told.push(what) }));
  const { scene } = await loader.loadAsync(`/pages/${name}/worn.glb`);
  const lights = [];
  scene.traverse((node) => {
    if (node.isLight) lights.push(node);
    if (node.isMesh && Boolean(node.material.isScratchedNodeMaterial) === isPlain) throw new Error(`${name}: found the material ${node.material.type}`);
  });
  if (!isPlain && lights.length === 0) throw new Error(`${name}: found no light in the file`);
  // The page's own lights and camera are those of all pictures.
  lights.forEach((light) => light.removeFromParent());
  scene.rotation.x = Math.PI / 2;
  return scene;
}

async function draw(renderer, name, tables) {
  const get = async (file, as) => (await fetch(`/pages/${name}/${file}`))[as]();
  const page = await get('scene.json', 'json');
  const geometry = geometryOf(await get('mesh.bin', 'arrayBuffer'), page);
  const scratches = readScratches(await get('scratches.csv', 'text'), 'scratches.csv', { profile: page.profile });
  // The picture is the same for an instance of a mesh that is turned back, under spots.
  const turn = new THREE.Matrix4().makeRotationZ(0.5).setPosition(0.01, 0.02, 0);
  const { position, target, up, fov } = page.camera;
  const [width, height] = page.size;
  const camera = new THREE.PerspectiveCamera(fov, width / height, 0.001, 10);
  camera.position.set(...position);
  camera.up.set(...up);
  camera.lookAt(...target);
  const picture = new THREE.RenderTarget(width, height, { type: THREE.FloatType });
  const { metal = null, color, metalness } = page.surface;
  const times = [];
  const told = [];
  for (const [what, list] of [['worn', scratches], ['bare', null], ['instanced', scratches], ['file', scratches], ['plain file', null]]) {
    const isFile = what.endsWith('file');
    const isInstanced = what === 'instanced';
    const scene = new THREE.Scene();
    for (const light of page.lights) scene.add(lightOf(light, isInstanced));
    const began = performance.now();
    const material = new ScratchedNodeMaterial({ tables, metal, scratches: list, roughness: page.roughness });
    if (color) {
      material.color.setRGB(...color);
      material.metalness = metalness;
    }
    const mesh = isFile ? await meshOfFile(name, tables, what === 'plain file', told) : isInstanced ? new THREE.InstancedMesh(geometry, material, 1) : new THREE.Mesh(geometry, material);
    if (isInstanced) {
      mesh.setMatrixAt(0, turn);
      mesh.applyMatrix4(turn.clone().invert());
    }
    scene.add(mesh);
    const made = performance.now();
    renderer.setRenderTarget(picture);
    await renderer.compileAsync(scene, camera);
    const compiled = performance.now();
    renderer.render(scene, camera);
    const pixels = await renderer.readRenderTargetPixelsAsync(picture, 0, 0, width, height);
    const drawn = performance.now();
    const seconds = (from, to) => `${((to - from) / 1000).toFixed(2)} s`;
    times.push(`${what}: made in ${seconds(began, made)}, compiled in ${seconds(made, compiled)}, drawn in ${seconds(compiled, drawn)}`);
    await send(`/result/${name}/${what.replace(' ', '-')}`, new Float32Array(pixels.buffer, pixels.byteOffset, 4 * width * height).slice());
  }
  await send(`/result/${name}/told`, told.join('\n'));
  await send(`/result/${name}/times`, times.join('; '));
}

/** How far the pass that makes a table is from the processor's, over the largest value; and how long it takes. */
async function tableByPass(device) {
  const { columns, rows } = tableSize;
  const buffer = device.createBuffer({ size: 16 * columns * rows, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
  scratchTable('copper');
  const began = performance.now();
  const texture = makeScratchTable(device, ['gold', 'steel']);
  await device.queue.onSubmittedWorkDone();
  const made = performance.now() - began;
  const encoder = device.createCommandEncoder();
  encoder.copyTextureToBuffer({ texture, origin: [0, 0, 1] }, { buffer, bytesPerRow: 16 * columns }, [columns, rows]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const [pass, own] = [new Float32Array(buffer.getMappedRange()), new Float32Array(scratchTable('steel').buffer)];
  let [off, most] = [0, 0];
  for (let i = 0; i < own.length; i += 1) {
    if (i % 4 === 3) continue;
    off = Math.max(off, Math.abs(own[i] - pass[i]));
    most = Math.max(most, Math.abs(own[i]));
  }
  if (!(off < 1e-5 * most)) throw new Error(`make_scratch_table: found values ${off / most} off; must be below 1e-5`);
  return `two tables by a pass in ${made.toFixed(0)} ms, ${(off / most).toExponential(1)} off the processor's`;
}

try {
  const renderer = new THREE.WebGPURenderer({ antialias: false });
  await renderer.init();
  if (!renderer.backend.isWebGPUBackend) throw new Error('no WebGPU in this browser');
  renderer.backend.device.addEventListener('uncapturederror', (event) => fail(event.error.message));
  renderer.toneMapping = THREE.NoToneMapping;
  THREE.RectAreaLightNode.setLTC(RectAreaLightTexturesLib.init());
  const tables = await loadTables('/package/tables.bin');
  for (const name of new URLSearchParams(location.search).get('scenes').split(',')) await draw(renderer, name, tables);
  await send('/result/table', await tableByPass(renderer.backend.device));
  await send('/done', '');
} catch (error) {
  fail(error);
}
