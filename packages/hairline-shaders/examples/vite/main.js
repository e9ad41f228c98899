// A scratched steel plate under a small lamp: the program of docs/engines.md, bundled by Vite.
import * as THREE from 'three/webgpu';
import { ScratchedNodeMaterial, loadTables, scratchesOn } from 'hairline-shaders/three';

const renderer = new THREE.WebGPURenderer({ antialias: true });
renderer.setSize(innerWidth, innerHeight);
renderer.toneMapping = THREE.NeutralToneMapping;
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(30, innerWidth / innerHeight, 0.01, 10);
camera.position.set(0, -0.2, 0.25);
camera.lookAt(0, 0, 0);
const lamp = new THREE.PointLight(0xffffff, 0.08);    // candela
lamp.position.set(0.05, 0.2, 0.25);
lamp.userData.radius = 0.004;                         // metres
const plate = new THREE.CircleGeometry(0.08, 96);
const tables = await loadTables();
const scratches = scratchesOn(plate, { pattern: 'random', count: 6000, width_um: 4, depth_nm: { mean: 160, spread: 0.1 }, length_m: 0.05 });
const material = new ScratchedNodeMaterial({ tables, metal: 'steel', roughness: 0.08, scratches });
scene.add(lamp, new THREE.Mesh(plate, material));
renderer.setAnimationLoop(() => renderer.render(scene, camera));
