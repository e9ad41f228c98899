// A worn copper pan and steel coins on a dark table, under one small lamp and a soft box. `cargo xtask package --serve` shows it.
import * as THREE from 'three/webgpu';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RectAreaLightTexturesLib } from 'three/addons/lights/RectAreaLightTexturesLib.js';
import { ScratchedNodeMaterial, loadTables, scratchesOn } from 'hairline-shaders/three';

const said = document.getElementById('said');
const tables = await loadTables();
THREE.RectAreaLightNode.setLTC(RectAreaLightTexturesLib.init());

const renderer = new THREE.WebGPURenderer({ antialias: true });
await renderer.init();
if (!renderer.backend.isWebGPUBackend) throw new Error((said.textContent = 'This page needs WebGPU: a recent Chrome, Edge, Safari or Firefox.'));
renderer.toneMapping = THREE.NeutralToneMapping;
renderer.shadowMap.enabled = true;
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
scene.background = new THREE.Color(0x050608);
const camera = new THREE.PerspectiveCamera(26, 1, 0.01, 5);
camera.position.set(0.02, 0.26, 0.34);
const controls = new OrbitControls(camera, renderer.domElement);
controls.target.set(0, 0.004, 0);
controls.enableDamping = true;

/** Candela of a lamp of that radiance. */
const lamp = new THREE.PointLight(new THREE.Color(1, 0.94, 0.86), 1400 * Math.PI * 0.005 ** 2);
lamp.position.set(-0.1, 0.3, -0.24);
lamp.userData.radius = 0.005;
lamp.castShadow = true;
lamp.shadow.mapSize.set(1024, 1024);
lamp.shadow.camera.near = 0.05;
lamp.shadow.camera.far = 1;
lamp.shadow.radius = 3;
lamp.shadow.normalBias = 0.0005;
const box = new THREE.RectAreaLight(new THREE.Color(0.75, 0.87, 1), 1.1, 0.5, 0.28);
box.position.set(0.3, 0.35, -0.3);
box.lookAt(0, 0, 0);
scene.add(lamp, box);

/** The upper side of a pan, from its axis outwards. */
function pan() {
  const profile = [[0, 0], [0.03, 0], [0.06, 0.0002], [0.078, 0.0012], [0.086, 0.006], [0.093, 0.018], [0.096, 0.0195], [0.098, 0.0185], [0.092, 0.004], [0.085, -0.001], [0, -0.001]];
  return new THREE.LatheGeometry(profile.map(([r, z]) => new THREE.Vector2(r, z)), 128);
}

const cookware = pan();
const copper = new ScratchedNodeMaterial({
  tables,
  metal: 'copper',
  roughness: 0.16,
  scratches: scratchesOn(cookware, {
    pattern: 'circular', count: 1500, axis: [0, 1, 0], jitterDeg: 5, lengthM: { mean: 0.035, spread: 0.5 },
    widthUm: { mean: 4.5, spread: 0.15 }, depthNm: { mean: 140, spread: 0.12 },
  }),
});
const body = new THREE.Mesh(cookware, copper);
scene.add(body);

const coin = new THREE.CylinderGeometry(0.0125, 0.0125, 0.002, 96, 1);
const steel = new ScratchedNodeMaterial({
  tables,
  metal: 'steel',
  roughness: 0.1,
  scratches: scratchesOn(coin, {
    pattern: 'random', count: 400, seed: 7, lengthM: { mean: 0.01, spread: 0.4 }, curvaturePerM: { mean: 0, spread: 20 },
    widthUm: { mean: 4, spread: 0.2 }, depthNm: { mean: 170, spread: 0.1 },
  }),
});
const places = [[0.118, 0.045, 0.3], [0.132, 0.012, 1.4], [-0.125, 0.055, 2.2]];
const coins = new THREE.InstancedMesh(coin, steel, places.length);
places.forEach(([x, z, turn], i) => coins.setMatrixAt(i, new THREE.Matrix4().makeRotationY(turn).setPosition(x, 0, z)));
scene.add(coins);

const table = new THREE.Mesh(
  new THREE.PlaneGeometry(2, 2).rotateX(-Math.PI / 2),
  new ScratchedNodeMaterial({ tables, color: 0x14110f, metalness: 0, roughness: 0.55 }),
);
table.position.y = -0.0012;
scene.add(table);
// At this scale the map of shadows would darken what throws them.
for (const mesh of [body, coins, table]) {
  mesh.castShadow = mesh !== table;
  mesh.receiveShadow = mesh === table;
}

function resize() {
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.setSize(innerWidth, innerHeight);
}
addEventListener('resize', resize);
resize();
said.textContent = 'Compiling shaders …';
await renderer.compileAsync(scene, camera);
said.textContent = 'Drag to turn, scroll to come nearer.';
const began = performance.now();
renderer.setAnimationLoop((now) => {
  // The lamp sways, and colours run along the scratches.
  lamp.position.x = -0.1 + 0.05 * Math.sin((now - began) / 2500);
  controls.update();
  renderer.render(scene, camera);
});
