// A worn steel pan and brass coins on a table, under a small lamp, a tube and a soft box. `cargo xtask package --serve` shows it.
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
renderer.toneMappingExposure = 1.2;
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
scene.background = new THREE.Color(0x2a2724);
const camera = new THREE.PerspectiveCamera(27.5, 1, 0.01, 5);
camera.position.set(0, 0.22, 0.27);
const controls = new OrbitControls(camera, renderer.domElement);
controls.target.set(0, 0, 0.005);
controls.enableDamping = true;
controls.maxPolarAngle = 1.5;

/** A panel of that radiance, in metres, which shines at `target`. */
function panel(color, radiance, [width, height], place, target) {
  const light = new THREE.RectAreaLight(color, radiance, width, height);
  light.position.set(...place);
  light.lookAt(...target);
  scene.add(light);
}

// A lamp; its radiance as candela. Around its reflection lie circles of light.
const lamp = new THREE.PointLight(new THREE.Color(1, 0.95, 0.88), 220 * Math.PI * 0.004 ** 2);
lamp.position.set(-0.088, 0.197, -0.212);
lamp.userData.radius = 0.004;
scene.add(lamp);
// A tube behind the pan, whose reflection lies just outside the bottom: what reaches the bottom is diffracted light.
panel(new THREE.Color(1, 0.96, 0.92), 320, [0.9, 0.005], [0.06, 0.18, -0.4], [0.06, 0, 0]);
// A dim ceiling, so that the steel has something to mirror; and a soft box.
panel(new THREE.Color(0.85, 0.93, 1), 0.06, [6, 5.5], [0, 0.55, 0.25], [0, -0.45, 0.12]);
panel(new THREE.Color(1, 0.95, 0.9), 3.2, [0.5, 0.5], [-0.8, 0.5, 0], [0, 0, 0]);

// Profile from the middle across the bottom, up the wall, over the rim and down again outside: radius and height, metres.
const profile = [
  [0, 0], [0.03, 0], [0.06, 0], [0.082, 0], [0.0865, 0.0005], [0.0905, 0.002], [0.0932, 0.0045], [0.0955, 0.0078], [0.0975, 0.011],
  [0.099, 0.0128], [0.1006, 0.0139], [0.1026, 0.0144], [0.1042, 0.0142], [0.1053, 0.0132], [0.1056, 0.0118], [0.104, 0.008], [0.101, 0.001],
  [0.099, -0.002],
];
const cookware = new THREE.LatheGeometry(profile.map(([r, y]) => new THREE.Vector2(r, y)), 128);
// The lathe's marks; and wear, in every direction. Widths that hardly differ keep the orders of the rainbow apart.
const turned = scratchesOn(cookware, {
  pattern: 'circular', count: 3400, seed: 1, axis: [0, 1, 0], jitter_deg: 3, length_m: { mean: 0.12, spread: 0.6 },
  width_um: { mean: 5, spread: 0.1 }, depth_nm: { mean: 180, spread: 0.12 },
});
const worn = scratchesOn(cookware, {
  pattern: 'random', count: 3400, seed: 2, length_m: { mean: 0.04, spread: 0.6 }, curvature_per_m: { mean: 0, spread: 6 },
  width_um: { mean: 4, spread: 0.12 }, depth_nm: { mean: 195, spread: 0.12 },
});
const pan = new THREE.Mesh(cookware, new ScratchedNodeMaterial({ tables, metal: 'steel', roughness: 0.055, scratches: turned.joined(worn) }));
pan.material.side = THREE.DoubleSide;

const coin = new THREE.CylinderGeometry(0.0125, 0.0125, 0.002, 96, 1);
const brass = new ScratchedNodeMaterial({
  tables,
  metal: 'brass',
  roughness: 0.12,
  scratches: scratchesOn(coin, {
    pattern: 'random', count: 400, seed: 7, length_m: { mean: 0.01, spread: 0.4 }, curvature_per_m: { mean: 0, spread: 20 },
    width_um: { mean: 4, spread: 0.2 }, depth_nm: { mean: 170, spread: 0.1 },
  }),
});
const places = [[-0.118, 0.062, 0.3], [-0.097, 0.083, 1.4], [0.126, 0.05, 2.2]];
const coins = new THREE.InstancedMesh(coin, brass, places.length);
places.forEach(([x, z, turn], i) => coins.setMatrixAt(i, new THREE.Matrix4().makeRotationY(turn).setPosition(x, -0.002, z)));

const table = new THREE.Mesh(
  new THREE.PlaneGeometry(2, 2).rotateX(-Math.PI / 2),
  new ScratchedNodeMaterial({ tables, color: 0x6f6c69, metalness: 0, roughness: 0.6 }),
);
table.position.y = -0.003;
scene.add(pan, coins, table);

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
  lamp.position.x = -0.088 + 0.05 * Math.sin((now - began) / 2500);
  controls.update();
  renderer.render(scene, camera);
});
